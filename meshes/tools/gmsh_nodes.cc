// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/gmsh_nodes.h"

#include <gmsh.h>

#include <algorithm>
#include <numeric>

namespace smoothfem {

GmshNodes nodes_of_model() {
  std::vector<std::size_t> tags;
  std::vector<double> xyz, parameters;
  gmsh::model::mesh::getNodes(tags, xyz, parameters);
  std::vector<std::size_t> order(tags.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
  GmshNodes nodes;
  for (const std::size_t i : order) {
    nodes.numbers.emplace(tags[i], static_cast<NodeIndex>(nodes.points.size()));
    nodes.points.emplace_back(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
  }
  return nodes;
}

}  // namespace smoothfem
