// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/files/box.h"

#include <algorithm>

#include "distributed/files/pieces.h"
#include "meshes/distortion/counter_random.h"
#include "meshes/io/mesh_file.h"

namespace smoothfem {

namespace {

/// Corners of a cube by bits: x, y, z. Kuhn's tetrahedra go from corner 0 to corner 7 along the
/// axes in every order; those of odd orders are turned over.
constexpr std::array<std::array<unsigned, 4>, 6> kuhn{
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}}};
constexpr std::array<std::array<unsigned, 3>, 2> triangles{{{0, 1, 3}, {0, 3, 2}}};
constexpr std::array<unsigned, 8> hexahedron{0, 1, 3, 2, 4, 5, 7, 6};
constexpr std::array<unsigned, 4> quadrilateral{0, 1, 3, 2};

/// The nodes of the whole box.
template <int dim>
class Grid {
 public:
  explicit Grid(const BoxParameters& parameters)
      : parameters_(parameters),
        h_(1.0 / static_cast<double>(
                     *std::max_element(parameters.n.begin(), parameters.n.begin() + dim))) {}

  using Position = std::array<std::size_t, static_cast<std::size_t>(dim)>;

  std::size_t number(const Position& at) const {
    std::size_t number = 0;
    for (std::size_t d = dim; d-- > 0;) number = number * (parameters_.n[d] + 1) + at[d];
    return number;
  }
  bool is_on_boundary(const Position& at) const {
    for (std::size_t d = 0; d < dim; ++d)
      if (at[d] == 0 || at[d] == parameters_.n[d]) return true;
    return false;
  }
  Point<dim> point(const Position& at) const {
    auto random = counter_random(parameters_.seed, 0, number(at));
    const double scale = is_on_boundary(at) ? 0.0 : parameters_.displacement;
    Point<dim> x;
    for (std::size_t d = 0; d < dim; ++d)
      x[static_cast<Eigen::Index>(d)] =
          h_ * (static_cast<double>(at[d]) + scale * (2.0 * random.uniform() - 1.0));
    return x;
  }
  /// Calls visit(position) in the order of the numbers, from first to last along the last axis.
  template <class Visit>
  void for_each(std::size_t first, std::size_t last, std::size_t inside, const Visit& visit) const {
    Position at{};
    const std::size_t nz = dim == 3 ? last - first : 1,
                      ny = dim == 3 ? parameters_.n[1] + inside : last - first;
    for (std::size_t k = 0; k < nz; ++k)
      for (std::size_t j = 0; j < ny; ++j)
        for (std::size_t i = 0; i < parameters_.n[0] + inside; ++i) {
          at[0] = i;
          at[1] = dim == 3 ? j : first + j;
          if constexpr (dim == 3) at[2] = first + k;
          visit(at);
        }
  }

 private:
  const BoxParameters& parameters_;
  double h_;
};

}  // namespace

template <int dim>
Mesh<dim> box_layers(const BoxParameters& parameters, std::size_t first, std::size_t last) {
  const Grid<dim> grid(parameters);
  std::vector<Point<dim>> points;
  std::vector<FixedReasons> reasons;
  std::vector<std::int64_t> numbers;
  grid.for_each(first, last + 1, 1, [&](const auto& at) {
    points.push_back(grid.point(at));
    reasons.push_back(grid.is_on_boundary(at) ? bit(FixedReason::boundary) : FixedReasons{0});
    numbers.push_back(static_cast<std::int64_t>(grid.number(at)));
  });
  const auto offset = static_cast<std::size_t>(numbers.front());
  CompressedRows<NodeIndex> cells;
  grid.for_each(first, last, 0, [&](const auto& at) {
    const auto add = [&](const auto& corners) {
      std::array<NodeIndex, std::tuple_size_v<std::decay_t<decltype(corners)>>> row;
      for (std::size_t k = 0; k < row.size(); ++k) {
        auto corner = at;
        for (std::size_t d = 0; d < dim; ++d) corner[d] += corners[k] >> d & 1u;
        row[k] = static_cast<NodeIndex>(grid.number(corner) - offset);
      }
      cells.append(row);
    };
    if constexpr (dim == 2) {
      if (!parameters.splits) return add(quadrilateral);
      for (const auto& corners : triangles) add(corners);
    } else {
      if (!parameters.splits) return add(hexahedron);
      for (const auto& corners : kuhn) add(corners);
    }
  });
  FileContent content;
  add_global_ids("GlobalNodeId", std::move(numbers), content.node_fields, content.node_roles);
  MeshLabels labels;
  labels.content = std::make_shared<const FileContent>(std::move(content));
  const std::size_t n_nodes = points.size();
  return Mesh<dim>(std::make_shared<const Topology>(dim, n_nodes, std::move(cells),
                                                    std::move(reasons), std::move(labels)),
                   std::move(points));
}

template <int dim>
std::size_t write_box(const Ranks& ranks, const BoxParameters& parameters, std::size_t n_pieces,
                      const std::filesystem::path& out) {
  const std::size_t n_layers = parameters.n[dim - 1];
  n_pieces = std::min(n_pieces, n_layers);
  const auto first_layer = [&](std::size_t piece) { return n_layers * piece / n_pieces; };
  std::size_t n_cells = 0;
  const NewPieces new_pieces(out, ranks.is_root());
  ranks.together([&] {
    const std::size_t end = first_piece_of(ranks, ranks.rank() + 1, n_pieces);
    for (std::size_t p = first_piece_of(ranks, ranks.rank(), n_pieces); p < end; ++p) {
      const auto mesh = box_layers<dim>(parameters, first_layer(p), first_layer(p + 1));
      n_cells += mesh.n_cells();
      write_mesh(new_pieces.file(p), mesh);
    }
  });
  ranks.together([&] {
    if (ranks.is_root()) new_pieces.finish(n_pieces);
  });
  return ranks.sum(n_cells);
}

template Mesh<2> box_layers(const BoxParameters&, std::size_t, std::size_t);
template Mesh<3> box_layers(const BoxParameters&, std::size_t, std::size_t);
template std::size_t write_box<2>(const Ranks&, const BoxParameters&, std::size_t,
                                  const std::filesystem::path&);
template std::size_t write_box<3>(const Ranks&, const BoxParameters&, std::size_t,
                                  const std::filesystem::path&);

}  // namespace smoothfem
