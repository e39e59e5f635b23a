#include "smoothing/quality/mesh_quality.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include "smoothing/mesh/cell_blocks.h"
#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {

std::vector<double> cell_mean_ratios(const PlanarMesh& mesh) {
  std::vector<double> quality;
  compute_cell_mean_ratios(mesh, quality);
  return quality;
}

SMOOTHFEM_VECTOR_CLONES
void compute_cell_mean_ratios(const PlanarMesh& mesh, std::vector<double>& cell_quality) {
  cell_quality.resize(mesh.n_cells());
  for_each_block(
      mesh.topology(), mesh.coordinates(),
      [&]<std::size_t n>(CellIndex c, const std::array<Vector2<Lanes>, n>& corners)
          SMOOTHFEM_INLINE_LAMBDA {
            const Lanes q = mean_ratio(std::span(corners));
            for (std::size_t l = 0; l < n_lanes; ++l) cell_quality[c + l] = q[l];
          },
      [&](CellIndex c, auto corners)
          SMOOTHFEM_INLINE_LAMBDA { cell_quality[c] = mean_ratio(corners); });
}

MeshQuality mesh_quality(const Topology& topology, std::span<const double> cell_quality) {
  constexpr double none = std::numeric_limits<double>::infinity();
  double q_min = none, q_star_min = none, sum = 0.0;
  std::size_t n_invalid = 0;
  for (CellIndex c = 0; c < cell_quality.size(); ++c) {
    const double q = cell_quality[c];
    q_min = q < q_min ? q : q_min;
    const double free_q = topology.has_free_node(c) ? q : none;
    q_star_min = free_q < q_star_min ? free_q : q_star_min;
    sum += q;
    n_invalid += q > 0.0 ? 0 : 1;
  }
  return {.q_min = q_min,
          .q_star_min = q_star_min == none ? q_min : q_star_min,
          .q_mean = sum / static_cast<double>(cell_quality.size()),
          .n_invalid = n_invalid};
}

MeshQuality mesh_quality(const PlanarMesh& mesh) {
  return mesh_quality(mesh.topology(), cell_mean_ratios(mesh));
}

std::vector<std::size_t> quality_histogram(std::span<const double> cell_quality,
                                           std::size_t n_bins) {
  std::vector<std::size_t> counts(n_bins, 0);
  for (const double q : cell_quality) {
    const double bin = std::clamp(q, 0.0, 1.0) * static_cast<double>(n_bins);
    ++counts[std::min(static_cast<std::size_t>(bin), n_bins - 1)];
  }
  return counts;
}

namespace {

double signed_area(const PlanarMesh& mesh, CellIndex cell) {
  const auto nodes = mesh.topology().cell_nodes(cell);
  const auto& x = mesh.coordinates();
  double twice = 0.0;
  for (std::size_t k = 1; k + 1 < nodes.size(); ++k)
    twice += cross(x[nodes[k]] - x[nodes[0]], x[nodes[k + 1]] - x[nodes[0]]);
  return 0.5 * twice;
}

/// A whole mesh seen from behind is one mistake, not n_cells of them.
std::string advice(std::size_t n_clockwise, std::size_t n_cells) {
  if (n_clockwise == n_cells)
    return "all cells run clockwise; list the nodes of every cell counterclockwise";
  if (n_clockwise > 0)
    return "reverse the clockwise cells' nodes, or untangle the mesh first if they are inverted";
  return "untangle the mesh first";
}

}  // namespace

void require_valid(const PlanarMesh& mesh, const std::string& path,
                   std::span<const std::size_t> cell_lines) {
  constexpr std::size_t n_named = 3;
  std::vector<CellIndex> invalid;
  std::size_t n_clockwise = 0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    if (!(cell_mean_ratio(mesh, c) > 0.0)) {
      invalid.push_back(c);
      if (signed_area(mesh, c) < 0.0) ++n_clockwise;
    }
  if (invalid.empty()) return;

  std::ostringstream message;
  if (!path.empty()) {
    message << path;
    if (!cell_lines.empty()) message << ':' << cell_lines[invalid.front()];
    message << ": ";
  }
  message << invalid.size() << " of " << mesh.n_cells()
          << (invalid.size() == 1 ? " cells is invalid: " : " cells are invalid: ");
  for (std::size_t i = 0; i < std::min(n_named, invalid.size()); ++i) {
    const CellIndex c = invalid[i];
    const auto& corner = mesh.coordinates()[mesh.topology().cell_nodes(c)[0]];
    message << (i > 0 ? ", " : "") << "cell " << c << " at (" << corner.x() << ", " << corner.y()
            << ')'
            << (signed_area(mesh, c) < 0.0 ? " is clockwise" : " is not convex or degenerate");
  }
  if (invalid.size() > n_named) message << ", ...";
  message << "; " << advice(n_clockwise, mesh.n_cells());
  throw InputError(message.str());
}

}  // namespace smoothfem
