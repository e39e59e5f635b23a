// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/periodic/halo.h"

#include <algorithm>
#include <map>

namespace smoothfem {

namespace {

using Pair = std::array<NodeIndex, 2>;

/// Returns the cells with one of these nodes, and n_layers - 1 layers of cells around them.
std::vector<CellIndex> layers_at(const CompressedRows<NodeIndex>& cells, std::size_t n_nodes,
                                 const std::map<NodeIndex, NodeIndex>& at, int n_layers) {
  std::vector<std::uint8_t> is_near(n_nodes, 0), is_taken(cells.size(), 0);
  for (const auto& [node, image] : at) is_near[node] = 1;
  for (int layer = 0; layer < n_layers; ++layer) {
    const auto before = is_near;
    for (CellIndex c = 0; c < cells.size(); ++c) {
      const auto nodes = cells[c];
      if (std::none_of(nodes.begin(), nodes.end(), [&](NodeIndex i) { return before[i] != 0; }))
        continue;
      is_taken[c] = 1;
      for (const NodeIndex i : nodes) is_near[i] = 1;
    }
  }
  std::vector<CellIndex> taken;
  for (CellIndex c = 0; c < cells.size(); ++c)
    if (is_taken[c]) taken.push_back(c);
  return taken;
}

template <int dim>
class HaloBuilder {
 public:
  HaloBuilder(const Mesh<dim>& mesh, int n_layers) : n_nodes_(mesh.n_nodes()), n_layers_(n_layers) {
    halo_.cells = mesh.topology().cells();
    for (CellIndex c = 0; c < mesh.n_cells(); ++c) halo_.originals.push_back(c);
  }

  /// Adds copies on both sides of a map. later: maps whose copies are still to come; they get the
  /// pairs of copied nodes, so that edges and corners of the domain are surrounded, too.
  void add(const PeriodicMap<dim>& map, std::span<PeriodicMap<dim>> later) {
    const CompressedRows<NodeIndex> present = halo_.cells;
    const std::size_t n_present = n_nodes_ + halo_.copies.size();
    for (const bool forward : {true, false}) {
      const RigidMotion<dim> motion = forward ? map.motion : map.motion.inverse();
      std::map<NodeIndex, NodeIndex> images;
      for (const auto& [node, partner] : map.nodes)
        forward ? images.emplace(partner, node) : images.emplace(node, partner);
      const auto taken = layers_at(present, n_present, images, n_layers_);
      std::vector<NodeIndex> row;
      for (const CellIndex c : taken) {
        row.clear();
        for (const NodeIndex i : present[c]) {
          const auto [image, is_new] =
              images.try_emplace(i, static_cast<NodeIndex>(n_nodes_ + halo_.copies.size()));
          if (is_new) halo_.copies.push_back(copy_of(i, motion));
          row.push_back(image->second);
        }
        halo_.cells.append(row);
        halo_.originals.push_back(halo_.originals[c]);
      }
      for (PeriodicMap<dim>& other : later) add_images(images, other.nodes);
    }
  }

  Halo<dim> take() && { return std::move(halo_); }

 private:
  typename Halo<dim>::Copy copy_of(NodeIndex node, const RigidMotion<dim>& motion) const {
    if (node < n_nodes_) return {node, motion};
    const auto& copied = halo_.copies[node - n_nodes_];
    return {copied.node, motion.after(copied.motion)};
  }
  static void add_images(const std::map<NodeIndex, NodeIndex>& images, std::vector<Pair>& pairs) {
    const std::size_t n = pairs.size();
    for (std::size_t k = 0; k < n; ++k) {
      const auto node = images.find(pairs[k][0]), partner = images.find(pairs[k][1]);
      if (node == images.end() || partner == images.end()) continue;
      const Pair pair{node->second, partner->second};
      if (std::find(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(n), pair) ==
          pairs.begin() + static_cast<std::ptrdiff_t>(n))
        pairs.push_back(pair);
    }
  }

  std::size_t n_nodes_;
  int n_layers_;
  Halo<dim> halo_;
};

}  // namespace

template <int dim>
std::vector<Point<dim>> Halo<dim>::coordinates(std::span<const Point<dim>> x) const {
  std::vector<Point<dim>> all(x.begin(), x.end());
  for (const Copy& copy : copies) all.push_back(copy.motion(x[copy.node]));
  return all;
}

template <int dim>
Halo<dim> make_halo(const Mesh<dim>& mesh, const std::vector<PeriodicMap<dim>>& maps,
                    int n_layers) {
  HaloBuilder<dim> builder(mesh, n_layers);
  auto extended = maps;
  for (std::size_t m = 0; m < extended.size(); ++m)
    builder.add(extended[m], std::span(extended).subspan(m + 1));
  return std::move(builder).take();
}

template struct Halo<2>;
template struct Halo<3>;
template Halo<2> make_halo(const Mesh<2>&, const std::vector<PeriodicMap<2>>&, int);
template Halo<3> make_halo(const Mesh<3>&, const std::vector<PeriodicMap<3>>&, int);

}  // namespace smoothfem
