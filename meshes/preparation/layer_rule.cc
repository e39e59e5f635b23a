// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/preparation/layer_rule.h"

#include <algorithm>
#include <sstream>

#include "smoothing/base/option_text.h"
#include "smoothing/base/text.h"
#include "smoothing/mesh/boundary_tags.h"
#include "smoothing/quality/layers.h"

namespace smoothfem {

namespace {

/// Returns the tags of a group of boundary facets. Throws InputError if there is no such group.
std::set<int> tags_of_group(const Topology& topology, const std::string& rule) {
  const std::string prefix = "group=", name = rule.substr(std::min(rule.size(), prefix.size()));
  if (!rule.starts_with(prefix) || name.empty())
    throw InputError(option_text("keep-layers") + " is '" + rule + "'; give nothing or group=NAME");
  (void)fixed_nodes(topology, {FixedNodesRule::Kind::groups, {name}});  // refuses unknown ones
  std::set<int> tags;
  const MeshLabels& labels = topology.labels();
  for (const int tag : labels.facet_tags)
    if (is_group(labels, topology.dimension() - 1, tag, name)) tags.insert(tag);
  return tags;
}

/// "along the groups wall, 7", or "along the boundary".
std::string place_of(const Layers& layers, const MeshLabels& labels, int dim) {
  std::vector<std::string> names;
  for (const int tag : layers.tags) {
    const auto found = labels.names.find({dim - 1, tag});
    if (tag != 0)
      names.push_back(found == labels.names.end() ? std::to_string(tag) : found->second);
  }
  if (names.empty()) return "along the boundary";
  return (names.size() == 1 ? "along the group " : "along the groups ") + joined(names);
}

}  // namespace

template <int dim>
Mesh<dim> with_layer_rule(Mesh<dim> mesh, const MeshOptions& options, const NoteTaker& notes) {
  if (!options.keep_layers && !options.examines) return mesh;
  const Topology& topology = mesh.topology();
  const bool keeps = options.keep_layers.has_value();
  const Layers layers = find_layers(mesh, keeps && !options.keep_layers->empty()
                                              ? tags_of_group(topology, *options.keep_layers)
                                              : std::set<int>());
  auto reasons = topology.fixed_reasons();
  std::size_t n_free = 0;
  for (const CellIndex c : layers.cells) {
    n_free += topology.has_free_node(c);
    for (const NodeIndex i : topology.cell_nodes(c)) reasons[i] |= bit(FixedReason::layer);
  }
  if (keeps && layers.cells.empty())
    notes.note(option_text("keep-layers") + " holds no cell: the mesh has no layers of thin cells");
  if (keeps) return with_fixed_nodes(std::move(mesh), std::move(reasons));
  if (n_free > 0 && !options.has_target) {
    std::ostringstream text;
    const bool is_one = layers.cells.size() == 1;
    text << layers.cells.size()
         << (is_one ? " cell with an aspect ratio above " : " cells with aspect ratios above ")
         << min_layer_aspect << (is_one ? " lies in layers " : " lie in layers ")
         << place_of(layers, topology.labels(), dim) << "; most methods make "
         << (is_one ? "it" : "them") << " isotropic; keep " << (is_one ? "it" : "them") << " by "
         << option_text("keep-layers");
    notes.warn(text.str());
  }
  return mesh;
}

template Mesh<2> with_layer_rule(Mesh<2>, const MeshOptions&, const NoteTaker&);
template Mesh<3> with_layer_rule(Mesh<3>, const MeshOptions&, const NoteTaker&);

}  // namespace smoothfem
