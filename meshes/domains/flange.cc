// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/domains/flange.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/gmsh_planar.h"
#include "meshes/tools/gmsh_volume.h"
#include "meshes/tools/quad_split.h"
#include "meshes/tools/sweep.h"
#include "smoothing/optimization/untangle.h"

namespace smoothfem {

namespace {

using Shape = FlangeShape;

struct Circle {
  Point<2> centre;
  double radius;
};

/// Returns the i-th of n points at equal distances, counterclockwise from the direction of x.
Point<2> point_on(const Circle& circle, int i, int n) {
  const double angle = 2.0 * std::numbers::pi * i / n;
  return circle.centre + circle.radius * Point<2>(std::cos(angle), std::sin(angle));
}

std::vector<Circle> bolt_holes() {
  std::vector<Circle> holes;
  holes.reserve(Shape::n_bolts);
  const Circle bolt_circle{Point<2>::Zero(), Shape::bolt_circle_radius};
  for (int i = 0; i < Shape::n_bolts; ++i)
    holes.push_back({point_on(bolt_circle, i, Shape::n_bolts), Shape::bolt_radius});
  return holes;
}

/// Takes points of facets on the cylinders to the cylinders. Other facets are on planes.
Point<3> onto_flange(std::span<const Point<3>> corners, const Point<3>& point) {
  const auto is_level = [&](const Point<3>& p) { return p.z() == corners[0].z(); };
  if (std::all_of(corners.begin(), corners.end(), is_level)) return point;
  std::vector<Circle> circles = bolt_holes();
  for (const double radius : {Shape::radius, Shape::hub_radius, Shape::bore_radius})
    circles.push_back({Point<2>::Zero(), radius});
  for (const Circle& circle : circles) {
    const auto is_on = [&](const Point<3>& p) {
      return std::abs((p.head<2>() - circle.centre).norm() - circle.radius) < 1e-9 * circle.radius;
    };
    if (!std::all_of(corners.begin(), corners.end(), is_on)) continue;
    const Point<2> across =
        circle.centre + circle.radius * (point.head<2>() - circle.centre).normalized();
    return {across.x(), across.y(), point.z()};
  }
  return point;
}

// --- Hexahedra -----------------------------------------------------------------------------------

/// Makes quadrilaterals between the first circle and the others, with edges of about edge_length.
PlanarCells quadrilaterals(const std::vector<Circle>& circles, double edge_length) {
  constexpr int fewest = 6;  // edges before halving; with fewer, the sides of small cells bend over
  std::vector<std::vector<Point<2>>> polygons;
  std::vector<std::size_t> circle_of_node;
  for (const Circle& circle : circles) {
    // Twice an even number: the extremes in x and y become nodes.
    const double n_pairs = 0.5 * std::numbers::pi * circle.radius / edge_length;
    const int n = std::max(fewest, 2 * static_cast<int>(std::lround(n_pairs)));
    circle_of_node.insert(circle_of_node.end(), static_cast<std::size_t>(n), polygons.size());
    polygons.emplace_back();
    for (int i = 0; i < n; ++i) polygons.back().push_back(point_on(circle, i, n));
  }
  const PlanarCells coarse =
      mesh_region(polygons, 2.0 * edge_length, PlanarPattern::quadrilaterals);
  const PlanarCells cells =
      split_to_quadrilaterals(coarse, [&](NodeIndex a, NodeIndex b) -> Point<2> {
        const Circle& circle = circles[circle_of_node[a]];
        const Point<2> chord = 0.5 * (coarse.coordinates[a] + coarse.coordinates[b]);
        return circle.centre + circle.radius * (chord - circle.centre).normalized();
      });
  // If edges are long compared with a hole, its arcs reach into the cells at their chords.
  PlanarMesh mesh(std::make_shared<const Topology>(2, cells.coordinates.size(), cells.cells),
                  cells.coordinates);
  untangle(mesh);
  return cells_of(mesh);
}

/// Returns the first mesh's cells, then the second's; nodes that lie on the circle in both are
/// merged.
PlanarCells joined_at(const Circle& circle, const PlanarCells& first, const PlanarCells& second) {
  const auto is_on = [&](const Point<2>& p) {
    return std::abs((p - circle.centre).norm() - circle.radius) < 1e-9 * circle.radius;
  };
  std::vector<NodeIndex> seam;
  for (NodeIndex i = 0; i < first.coordinates.size(); ++i)
    if (is_on(first.coordinates[i])) seam.push_back(i);
  PlanarCells whole = first;
  std::vector<NodeIndex> number(second.coordinates.size());
  for (std::size_t i = 0; i < number.size(); ++i) {
    const Point<2>& p = second.coordinates[i];
    const auto same = std::find_if(
        seam.begin(), is_on(p) ? seam.end() : seam.begin(),
        [&](NodeIndex s) { return (whole.coordinates[s] - p).norm() < 1e-9 * circle.radius; });
    number[i] = static_cast<NodeIndex>(whole.coordinates.size());
    if (is_on(p) && same != seam.end())
      number[i] = *same;
    else
      whole.coordinates.push_back(p);
  }
  for (std::size_t c = 0; c < second.cells.size(); ++c) {
    std::vector<NodeIndex> row;
    for (const NodeIndex node : second.cells[c]) row.push_back(number[node]);
    whole.cells.append(row);
  }
  return whole;
}

/// Quadrilaterals of the hub's annulus, followed by those of the ring around it. The seam is at the
/// hub.
struct Footprint {
  PlanarCells cells;
  std::size_t n_in_hub;
};

Footprint footprint(double edge_length) {
  const Circle hub{Point<2>::Zero(), Shape::hub_radius};
  std::vector<Circle> ring{{Point<2>::Zero(), Shape::radius}, hub};
  for (const Circle& hole : bolt_holes()) ring.push_back(hole);
  const PlanarCells inner =
      quadrilaterals({hub, {Point<2>::Zero(), Shape::bore_radius}}, edge_length);
  return {joined_at(hub, inner, quadrilaterals(ring, edge_length)), inner.cells.size()};
}

void append_layers(std::vector<double>& heights, double top, std::size_t n) {
  const double bottom = heights.back();
  for (std::size_t k = 1; k <= n; ++k)
    heights.push_back(bottom + (top - bottom) * static_cast<double>(k) / static_cast<double>(n));
}

/// Sweeps the footprint to reach a number of cells. The layers of the disc get the wanted
/// thickness; the hub, which has fewer cells, gets as many layers as are then missing.
VolumeCells swept(const Footprint& base, double n_wanted) {
  const auto n_all = static_cast<double>(base.cells.cells.size());
  const auto n_hub = static_cast<double>(base.n_in_hub);
  const double n_by_thickness =
      Shape::disc_height * n_all + (Shape::height - Shape::disc_height) * n_hub;
  const auto n_layers = [](double n) {
    return static_cast<std::size_t>(std::max(1L, std::lround(n)));
  };
  const std::size_t n_in_disc = n_layers(Shape::disc_height * n_wanted / n_by_thickness);
  const std::size_t n_above = n_layers((n_wanted - static_cast<double>(n_in_disc) * n_all) / n_hub);
  std::vector<double> heights{0.0};
  append_layers(heights, Shape::disc_height, n_in_disc);
  append_layers(heights, Shape::height, n_above);
  return sweep(base.cells, heights, [&](CellIndex cell) {
    return cell < base.n_in_hub ? n_in_disc + n_above : n_in_disc;
  });
}

/// Keeps the mesh whose number of cells is nearest to a wanted one.
class NearestCount {
 public:
  explicit NearestCount(double n_wanted) : n_wanted_(n_wanted) {}

  bool is_close() const { return deviation_ <= 0.012; }
  double n_wanted() const { return n_wanted_; }

  /// Offers a mesh. Returns its number of cells as a fraction of the wanted one.
  double offer(VolumeCells mesh) {
    const double fraction = static_cast<double>(mesh.cells.size()) / n_wanted_;
    if (std::abs(fraction - 1.0) < deviation_) {
      deviation_ = std::abs(fraction - 1.0);
      mesh_ = std::move(mesh);
    }
    return fraction;
  }

  VolumeCells take() {
    constexpr double acceptable = 0.1;
    if (deviation_ > acceptable)
      throw InputError("the flange cannot be meshed with " +
                       std::to_string(std::lround(n_wanted_)) +
                       " cells, the nearest count found is " + std::to_string(mesh_.cells.size()) +
                       "; choose another edge scale");
    return std::move(mesh_);
  }

 private:
  double n_wanted_, deviation_ = std::numeric_limits<double>::infinity();
  VolumeCells mesh_;
};

constexpr int max_tries = 10;

VolumeCells hexahedra(double edge_scale) {
  constexpr double n_cells = 67055.0, edge_length = 0.27;
  // Longer edges do not fit between the holes and the rims; beyond that only the layers get
  // thicker.
  constexpr double longest = 0.7;
  const double length = std::min(edge_scale * edge_length, longest);
  NearestCount nearest(n_cells / (edge_scale * edge_scale * edge_scale));
  for (int i = 0; i < max_tries && !nearest.is_close(); ++i) {
    const double change = 0.01 * static_cast<double>((i + 1) / 2) * (i % 2 == 0 ? 1.0 : -1.0);
    nearest.offer(swept(footprint((1.0 + change) * length), nearest.n_wanted()));
  }
  return nearest.take();
}

// --- Tetrahedra ----------------------------------------------------------------------------------

VolumeCells tetrahedra(const EdgeLengths& lengths) {
  const Point<2> axis = Point<2>::Zero();
  // The removed part sticks out, so that no planes coincide.
  const double below = -1.0, above = Shape::height + 1.0;
  std::vector<Cylinder> removed{{axis, Shape::bore_radius, below, above}};
  for (const Circle& hole : bolt_holes())
    removed.push_back({hole.centre, hole.radius, below, above});
  return mesh_solid({{axis, Shape::radius, 0.0, Shape::disc_height},
                     {axis, Shape::hub_radius, Shape::disc_height, Shape::height}},
                    removed, lengths);
}

/// Searches both edge lengths: the boundary length determines the ratio of nodes to cells, the
/// inner length the number of cells.
VolumeCells tetrahedra(double edge_scale) {
  constexpr double n_cells = 566004.0;
  constexpr EdgeLengths first_try{0.215, 0.193};
  NearestCount nearest(n_cells / (edge_scale * edge_scale * edge_scale));
  EdgeLengths lengths{edge_scale * first_try.boundary, edge_scale * first_try.inside};
  for (int i = 0; i < max_tries && !nearest.is_close(); ++i)
    lengths.inside *= std::cbrt(nearest.offer(tetrahedra(lengths)));
  return nearest.take();
}

// --- Both ----------------------------------------------------------------------------------------

void require_genus(const VolumeMesh& mesh) {
  const Topology& topology = mesh.topology();
  const auto& faces = topology.boundary_facets();
  const auto& on_boundary = topology.on_boundary();
  const auto n = [](std::size_t count) { return static_cast<long>(count); };
  const long volume =
      n(mesh.n_nodes()) - n(topology.n_edges()) + n(topology.n_facets()) - n(mesh.n_cells());
  const long surface =
      n(static_cast<std::size_t>(std::count(on_boundary.begin(), on_boundary.end(), true))) -
      n(faces.n_entries() / 2) + n(faces.size());
  if (volume != 1 - Shape::genus || surface != 2 - 2 * Shape::genus)
    throw InputError("the generated flange has the Euler characteristics " +
                     std::to_string(volume) + " and, on its surface, " + std::to_string(surface) +
                     " instead of " + std::to_string(1 - Shape::genus) + " and " +
                     std::to_string(2 - 2 * Shape::genus) + "; choose another edge scale");
}

}  // namespace

VolumeMesh generate_flange(const FlangeParameters& p) {
  if (p.element_type != ElementType::tetrahedron && p.element_type != ElementType::hexahedron)
    throw InputError("the flange can be meshed with tetrahedra or hexahedra only");
  require_edge_scale("flange", p.edge_scale, 4);
  const bool tet = p.element_type == ElementType::tetrahedron;
  VolumeMesh mesh =
      mesh_of(tet ? tetrahedra(p.edge_scale) : hexahedra(p.edge_scale), "generated flange");
  require_genus(mesh);
  return mesh;
}

namespace {

AnyMesh generate(const DomainParameters& p) {
  const bool tet = p.elements == "tetrahedra";
  return generate_flange({tet ? ElementType::tetrahedron : ElementType::hexahedron, p.edge_scale});
}

const RegisteredDomain registered(
    {.name = "flange",
     .description =
         "round flange with hub, bore and eight bolt holes, of the size of Section 6.3's model",
     .dimension = 3,
     .elements = {"tetrahedra", "hexahedra"},
     .make = generate,
     .boundary = [](const DomainParameters&) { return OntoBoundary<3>(onto_flange); }});

}  // namespace
}  // namespace smoothfem
