// The only file that knows OpenMesh.
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cctype>
#include <sstream>

#include "geom/base_mesh.h"
#include "geom/error.h"
#include "geom/mesh_text_check.h"
#include "geom/polygon_soup.h"
#include "geom/text_lines.h"

namespace wale {
namespace {

namespace om = OpenMesh;

/// Takes faces from OpenMesh's file readers without its half-edges: those duplicate the vertices of non-manifold faces
/// and report it on stderr alone (measured with OpenMesh 9.0). Everything that Wale does not use is ignored.
class SoupImporter : public om::IO::BaseImporter {
 public:
  PolygonSoup soup;
  bool bad_index = false, has_uv = false;

  om::VertexHandle add_vertex(const om::Vec3f& p) override { return add_vertex(om::Vec3d(p[0], p[1], p[2])); }
  om::VertexHandle add_vertex(const om::Vec3d& p) override {
    soup.position.emplace_back(p[0], p[1], p[2]);
    soup.uv.emplace_back(0, 0);
    return om::VertexHandle(static_cast<int>(soup.position.size()) - 1);
  }
  om::VertexHandle add_vertex() override { return add_vertex(om::Vec3d(0, 0, 0)); }
  void set_point(om::VertexHandle v, const om::Vec3f& p) override {
    if (valid(v)) soup.position[static_cast<size_t>(v.idx())] = dvec3(p[0], p[1], p[2]);
  }
  void set_texcoord(om::VertexHandle v, const om::Vec2f& t) override {
    has_uv = true;
    if (valid(v)) soup.uv[static_cast<size_t>(v.idx())] = dvec2(t[0], t[1]);
  }
  void set_texcoord(om::VertexHandle v, const om::Vec3f& t) override { set_texcoord(v, om::Vec2f(t[0], t[1])); }
  om::FaceHandle add_face(const VHandles& corners) override {
    if (corners.size() < 3) return om::FaceHandle();
    for (const om::VertexHandle v : corners)
      if (!valid(v)) bad_index = true;
    soup.face_begin.push_back(static_cast<uint32_t>(soup.vertex.size()));
    for (const om::VertexHandle v : corners) soup.vertex.push_back(static_cast<uint32_t>(v.idx()));
    return om::FaceHandle(static_cast<int>(soup.face_begin.size()) - 1);
  }
  size_t n_vertices() const override { return soup.position.size(); }
  size_t n_faces() const override { return soup.face_begin.size(); }
  size_t n_edges() const override { return 0; }
  om::BaseKernel* kernel() override { return &unused_; }

  om::HalfedgeHandle add_edge(om::VertexHandle, om::VertexHandle) override { return om::HalfedgeHandle(); }
  om::FaceHandle add_face(om::HalfedgeHandle) override { return om::FaceHandle(); }
  void add_face_texcoords(om::FaceHandle, om::VertexHandle, const std::vector<om::Vec2f>&) override {}
  void add_face_texcoords(om::FaceHandle, om::VertexHandle, const std::vector<om::Vec3f>&) override {}
  void set_face_texindex(om::FaceHandle, int) override {}
  void set_halfedge(om::VertexHandle, om::HalfedgeHandle) override {}
  void set_normal(om::VertexHandle, const om::Vec3f&) override {}
  void set_normal(om::VertexHandle, const om::Vec3d&) override {}
  void set_normal(om::FaceHandle, const om::Vec3f&) override {}
  void set_normal(om::FaceHandle, const om::Vec3d&) override {}
  void set_color(om::VertexHandle, const om::Vec3uc&) override {}
  void set_color(om::VertexHandle, const om::Vec4uc&) override {}
  void set_color(om::VertexHandle, const om::Vec3f&) override {}
  void set_color(om::VertexHandle, const om::Vec4f&) override {}
  void set_color(om::EdgeHandle, const om::Vec3uc&) override {}
  void set_color(om::EdgeHandle, const om::Vec4uc&) override {}
  void set_color(om::EdgeHandle, const om::Vec3f&) override {}
  void set_color(om::EdgeHandle, const om::Vec4f&) override {}
  void set_color(om::FaceHandle, const om::Vec3uc&) override {}
  void set_color(om::FaceHandle, const om::Vec4uc&) override {}
  void set_color(om::FaceHandle, const om::Vec3f&) override {}
  void set_color(om::FaceHandle, const om::Vec4f&) override {}
  void set_status(om::VertexHandle, const om::Attributes::StatusInfo&) override {}
  void set_status(om::HalfedgeHandle, const om::Attributes::StatusInfo&) override {}
  void set_status(om::EdgeHandle, const om::Attributes::StatusInfo&) override {}
  void set_status(om::FaceHandle, const om::Attributes::StatusInfo&) override {}
  void set_next(om::HalfedgeHandle, om::HalfedgeHandle) override {}
  void set_face(om::HalfedgeHandle, om::FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(om::HalfedgeHandle, const om::Vec2f&) override {}
  void set_texcoord(om::HalfedgeHandle, const om::Vec3f&) override {}
  void add_texture_information(int, std::string) override {}

 private:
  bool valid(om::VertexHandle v) const { return v.idx() >= 0 && static_cast<size_t>(v.idx()) < soup.position.size(); }
  om::PolyMesh_ArrayKernelT<> unused_;
};

PolygonSoup read_with_openmesh(std::string_view bytes, const std::string& suffix, const std::string& file) {
  ::omerr().disable();
  ::omlog().disable();
  SoupImporter importer;
  om::IO::Options options = om::IO::Options::VertexTexCoord;
  std::istringstream stream{std::string(bytes), std::ios::in | std::ios::binary};
  if (!om::IO::IOManager().read(stream, suffix, importer, options))
    user_error("{}: not a mesh that can be read; give a complete OBJ, PLY or OFF file", file);
  if (importer.bad_index)
    user_error("{}: a face names a vertex that is not there; valid are 0 to {}", file, importer.n_vertices() - 1);
  PolygonSoup& soup = importer.soup;
  if (importer.has_uv && options.vertex_has_texcoord())
    soup.uv_index.assign(soup.vertex.begin(), soup.vertex.end());
  else
    soup.uv.clear();
  return std::move(soup);
}

}  // namespace

BaseMesh read_mesh(const std::filesystem::path& file) {
  std::error_code status;
  if (!std::filesystem::is_regular_file(file, status))
    user_error("{}: no such file; give the path of an OBJ, PLY or OFF mesh", file.string());
  return parse_mesh(read_bytes(file), file);
}

BaseMesh parse_mesh(std::string_view bytes, const std::filesystem::path& path) {
  const std::string file = path.string();
  std::string suffix = path.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return std::tolower(c); });

  PolygonSoup soup;
  if (suffix == ".obj") {
    soup = parse_obj(bytes, file);
  } else if (suffix == ".off") {
    soup = parse_off(bytes, file);
  } else if (suffix == ".ply") {
    require_whole_ply(bytes, file);
    soup = read_with_openmesh(bytes, suffix, file);
  } else {
    user_error("{}: unknown mesh format '{}'; use .obj, .ply or .off", file, suffix);
  }
  BaseMesh mesh = triangulate(soup, file);
  mesh.name = file;
  return mesh;
}

}  // namespace wale
