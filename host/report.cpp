#include "host/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "geom/uv_grid.h"

namespace wale {
namespace {

using Json = nlohmann::ordered_json;

Json fabric_json(const Fabric& f, const MeshReport& mesh) {
  Json repeats = Json::array();
  for (const auto& r : f.report.snapped_repeats) repeats.push_back({r.x, r.y});
  return {
      {"name", f.name},
      {"mesh",
       {{"vertices", mesh.vertices},
        {"triangles", mesh.triangles},
        {"polygons_split", mesh.polygons_split},
        {"non_manifold_edges", mesh.non_manifold_edges},
        {"boundary_edges", mesh.boundary_edges},
        {"seam_edges", mesh.seam_edges},
        {"degenerate_triangles", mesh.degenerate_triangles},
        {"zero_area_uv", mesh.zero_area_uv},
        {"flipped_uv", mesh.flipped_uv},
        {"uv_overlap", mesh.overlap},
        {"uv_overlap_in_charts", mesh.chart_overlap},
        {"stretch_median", {mesh.stretch_median.x, mesh.stretch_median.y}}}},
      {"charts", f.charts.size()},
      {"full_yarns", f.report.full_yarns},
      {"runs", f.report.runs},
      {"plies", f.report.plies},
      {"fibres", f.report.fibres},
      {"flyaways", f.report.flyaways},
      {"segments", f.report.segments},
      {"storage", f.procedural ? "procedural" : "stored"},
      {"vertices", f.report.vertices},
      {"samples_outside", f.report.samples_outside},
      {"samples_extrapolated", f.report.samples_extrapolated},
      {"worst_partner_distance_m", f.report.worst_partner_distance},
      {"snapped_repeats", repeats},
      {"tile_m", {f.report.tile_metres.x, f.report.tile_metres.y}},
      {"stitch_m", {f.report.stitch_metres.x, f.report.stitch_metres.y}},
      {"yarn_radius_m", f.yarn_radius},
      {"ply_radius_m", f.ply_radius},
      {"fibre_radius_m", f.fibre_radius},
      {"flyaway_radius_m", f.flyaway_radius},
      {"mirrored", f.report.mirrored},
      {"patches", f.patches.size()},
      {"cells", cell_count(f)},
      {"vertex_bytes", f.report.vertices * W_FRAME_WORDS * 4},
  };
}

Json strain_json(const StrainReport& strain) {
  return {{"samples", strain.samples},
          {"clamped", strain.clamped},
          {"course", {strain.least.x, strain.most.x}},
          {"wale", {strain.least.y, strain.most.y}}};
}

Json textile_json(const TextileMeasures& m) {
  return {{"area_mass_kg_m2", m.area_mass},
          {"loop_length_m", m.yarn_per_stitch},
          {"yarn_tex", m.tex()},
          {"tightness_factor", m.tightness()},
          {"cover_factor", m.cover},
          {"openness", 1 - m.cover},
          {"ply_take_up", m.ply_per_yarn}};
}

}  // namespace

std::string build_report_json(const World& world, const std::vector<TextileMeasures>& textile) {
  Json json{{"fabrics", Json::array()},
            {"triangles", world.triangle_count()},
            {"spheres", world.spheres.size()},
            {"notes", world.notes},
            {"seconds", world.seconds}};
  for (size_t i = 0; i < world.fabrics.size(); ++i) {
    json["fabrics"].push_back(fabric_json(world.fabrics[i], world.fabric_mesh_reports[i]));
    if (const StrainReport& strain = world.fabrics[i].report.strain; strain.samples > 0)
      json["fabrics"].back()["strain"] = strain_json(strain);
    if (i < textile.size()) json["fabrics"].back()["textile"] = textile_json(textile[i]);
  }
  return json.dump(2) + "\n";
}

std::string build_report_text(const World& world, const std::vector<TextileMeasures>& textile) {
  std::string out;
  for (size_t i = 0; i < world.fabrics.size(); ++i) {
    const Fabric& f = world.fabrics[i];
    const MeshReport& m = world.fabric_mesh_reports[i];
    const auto& r = f.report;
    out += fmt::format("fabric \"{}\"\n", f.name);
    out += fmt::format("  base mesh  {} vertices, {} triangles, {} charts, {} seam edges, {} boundary edges\n",
                       m.vertices, m.triangles, f.charts.size(), m.seam_edges, m.boundary_edges);
    out += fmt::format(
        "  UV         stretch {:.3g} x {:.3g} (median), {} flipped, {} without area, {:.1f} % covered twice\n",
        m.stretch_median.x, m.stretch_median.y, m.flipped_uv, m.zero_area_uv, 100 * m.overlap);
    if (m.non_manifold_edges || m.degenerate_triangles)
      out += fmt::format("  warning    {} non-manifold edges, {} triangles without area\n", m.non_manifold_edges,
                         m.degenerate_triangles);
    if (m.chart_overlap > 0.01)
      out += "  warning    overlapping UVs: where two triangles share a UV, one of them stays bare\n";
    out += fmt::format(
        "  stitch     {:.3f} x {:.3f} mm ({:.2f} wales and {:.2f} courses per cm), tile {:.3f} x {:.3f} mm\n",
        1e3 * r.stitch_metres.x, 1e3 * r.stitch_metres.y, 0.01 / r.stitch_metres.x, 0.01 / r.stitch_metres.y,
        1e3 * r.tile_metres.x, 1e3 * r.tile_metres.y);
    out += fmt::format("  yarn       {} plies, yarn radius {:.4f} mm, ply radius {:.4f} mm\n", f.plies,
                       1e3 * f.yarn_radius, 1e3 * f.ply_radius);
    if (i < textile.size()) {
      const TextileMeasures& t = textile[i];
      out +=
          fmt::format("  textile    {:.0f} g/m^2, yarn of {:.0f} tex, loop length {:.2f} mm, tightness factor {:.1f}\n",
                      1e3 * t.area_mass, t.tex(), 1e3 * t.yarn_per_stitch, t.tightness());
      out += fmt::format("  cover      {:.1f} % of the flat cloth, openness {:.1f} %\n", 100 * t.cover,
                         100 * (1 - t.cover));
    }
    out += fmt::format("  knitted    {} full yarns, {} runs, {} segments, ", r.full_yarns, r.runs, r.segments);
    out += f.procedural ? "warped from a lattice wherever rays meet them\n"
                        : fmt::format("{} vertices ({} bytes each)\n", r.vertices, W_FRAME_WORDS * 4);
    if (r.fibres > r.flyaways)
      out += fmt::format("  fibres     {} curves of radius {:.4f} mm\n", r.fibres - r.flyaways, 1e3 * f.fibre_radius);
    if (r.flyaways)
      out += fmt::format("  flyaways   {} curves of radius {:.4f} mm\n", r.flyaways, 1e3 * f.flyaway_radius);
    out += fmt::format("  cut        {} samples outside the cloth, {} in the half stitch past its borders\n",
                       r.samples_outside, r.samples_extrapolated);
    if (r.strain.samples > 0) {
      out += fmt::format("  strain     {:.3g} to {:.3g} along courses, {:.3g} to {:.3g} along wales\n", r.strain.least.x,
                         r.strain.most.x, r.strain.least.y, r.strain.most.y);
      if (r.strain.clamped > 0)
        out += fmt::format("  warning    {} of {} samples strained beyond the tile's table, held at its border\n",
                           r.strain.clamped, r.strain.samples);
    }
    for (const auto& s : r.snapped_repeats)
      out += fmt::format("  joined     repeats snapped to {} x {} tiles\n", s.x, s.y);
    out += fmt::format("  partners   worst distance {:.3g} mm\n", 1e3 * r.worst_partner_distance);
    if (r.mirrored) out += "  mirrored   a UV chart is mirrored, and so is its cloth, twist included\n";
  }
  if (world.triangle_count() || !world.spheres.empty())
    out += fmt::format("props        {} triangles, {} spheres\n", world.triangle_count(), world.spheres.size());
  for (const auto& note : world.notes) out += fmt::format("note         {}\n", note);
  for (const auto& [step, seconds] : world.seconds) out += fmt::format("time         {}: {:.3f} s\n", step, seconds);
  return out;
}

}  // namespace wale
