#pragma once
// Base meshes that are traps, millimetres in size. UVs are metres along the cloth, as in `uv_metres` scenes.
#include "geom/base_mesh.h"

namespace wale::test {

constexpr double kSheet = 0.006;  ///< metres, side of the flat fixtures: three stitches of 2 mm

/// A flat sheet with rows and columns a nanometre wide, one of them along its border: triangles a million times as long
/// as wide.
BaseMesh needle_sheet();
/// A flat sheet whose diagonals carry a vertex a nanometre beside them: triangles with an angle of 180 degrees less
/// 1e-6.
BaseMesh pancake_sheet();
/// A sheet of 4 x 4 quads; the UVs of one in the middle are a single point.
BaseMesh sheet_with_uv_point();
/// A sheet of 4 x 4 quads; one vertex is dragged across its neighbours in UV, which turns triangles over there.
BaseMesh sheet_with_flipped_uv();
/// A sheet wound clockwise in UV and in space by turns, quad by quad: the same cloth as the plain one.
BaseMesh sheet_wound_both_ways();
/// A sheet whose UVs lie 12 km away from 0.
BaseMesh sheet_with_far_uv();
/// The tube of radius 3 mm whose seam meets in the middle of a stitch: 9.42 stitches round.
BaseMesh tube_with_seam_in_a_stitch();
/// Two sheets side by side that share one UV square: two charts.
BaseMesh two_charts_in_one_place();
/// A sheet folded on itself in UV along its middle: one chart that covers half its UVs twice.
BaseMesh chart_over_itself();
/// A ball of radius 4 mm by longitude and latitude: all meridians meet in two points.
BaseMesh ball_with_poles();
/// A Moebius strip, 5 mm wide and 50 mm long; its two ends share their vertices.
BaseMesh moebius_strip();
/// Two sheets in exactly the same place with charts of their own, facing opposite ways.
BaseMesh double_sheet();
/// Three sheets that share one edge, each with a chart of its own.
BaseMesh three_sheets_on_an_edge();
/// A sheet whose triangles share no vertex: every corner is a vertex of its own.
BaseMesh sheet_of_loose_triangles();
/// A sheet and a vertex a million kilometres away that no triangle uses.
BaseMesh sheet_with_stray_vertex();
/// One right triangle with legs of `leg` metres.
BaseMesh one_triangle(double leg);
/// A sheet with one corner drawn in to its opposite one in space: a triangle without area in space but with UVs.
BaseMesh sheet_with_spatial_point();
/// Triangles with UVs but all vertices on one line.
BaseMesh line_of_triangles();

}  // namespace wale::test
