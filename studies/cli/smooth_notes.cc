// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/cli/smooth_notes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "meshes/io/losses.h"
#include "smoothing/base/text.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/quality/layers.h"

namespace smoothfem {

namespace {

std::string rounded(double value, int digits) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

}  // namespace

void print_losses(const std::filesystem::path& path, const MeshView& mesh,
                  const MeshWriteOptions& options) {
  const auto lost = losses(path, mesh, options);
  if (!lost.empty())
    print_notes(path.string(), {"the file cannot hold, and leaves out: " + joined(lost)});
}

std::string fields_text(const FileContent* content) {
  std::vector<std::string> names;
  for (const auto* fields :
       {content ? &content->node_fields : nullptr, content ? &content->element_fields : nullptr})
    for (std::size_t f = 0; fields && f < fields->size(); ++f)
      if (!is_own_field((*fields)[f])) names.push_back((*fields)[f].name);
  if (names.empty()) return {};
  return "passed on unchanged, also if they depend on positions: " + joined(names);
}

template <int dim, int spacedim>
std::vector<double> cell_sizes(const Mesh<dim, spacedim>& mesh) {
  std::vector<double> sizes(mesh.n_cells());
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) sizes[c] = std::abs(signed_cell_size(mesh, c));
  return sizes;
}

template std::vector<double> cell_sizes(const Mesh<2>&);
template std::vector<double> cell_sizes(const Mesh<3>&);
template std::vector<double> cell_sizes(const Mesh<2, 3>&);

namespace {

/// Returns the tags of a group of boundary facets. Throws InputError if there is no such group.
std::set<int> tags_of_group(const Topology& topology, const std::string& rule) {
  const std::string prefix = "group=", name = rule.substr(std::min(rule.size(), prefix.size()));
  if (!rule.starts_with(prefix) || name.empty())
    throw InputError("--keep-layers is '" + rule + "'; give nothing or group=NAME");
  (void)fixed_nodes(topology, {FixedNodesRule::Kind::groups, {name}});  // refuses unknown ones
  std::set<int> tags;
  const MeshLabels& labels = topology.labels();
  for (const int tag : labels.facet_tags) {
    const auto found = labels.names.find({topology.dimension() - 1, tag});
    if (std::to_string(tag) == name || (found != labels.names.end() && found->second == name))
      tags.insert(tag);
  }
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
Mesh<dim> with_layer_rule(Mesh<dim> mesh, const SmoothArguments& arguments) {
  const Topology& topology = mesh.topology();
  const bool keeps = arguments.keep_layers.has_value();
  const Layers layers = find_layers(mesh, keeps && !arguments.keep_layers->empty()
                                              ? tags_of_group(topology, *arguments.keep_layers)
                                              : std::set<int>());
  auto reasons = topology.fixed_reasons();
  std::size_t n_free = 0;
  for (const CellIndex c : layers.cells) {
    n_free += topology.has_free_node(c);
    for (const NodeIndex i : topology.cell_nodes(c)) reasons[i] |= bit(FixedReason::layer);
  }
  if (keeps && layers.cells.empty())
    print_notes(arguments.in,
                {"--keep-layers holds no cell: the mesh has no layers of thin cells"});
  if (keeps) return with_fixed_nodes(std::move(mesh), std::move(reasons));
  if (n_free > 0 && arguments.target.empty())
    std::fprintf(stderr,
                 "smoothfem: warning: %zu cells with aspect ratios above %g lie in layers %s; most "
                 "methods make them isotropic; keep them by --keep-layers\n",
                 layers.cells.size(), min_layer_aspect,
                 place_of(layers, topology.labels(), dim).c_str());
  return mesh;
}

template Mesh<2> with_layer_rule(Mesh<2>, const SmoothArguments&);
template Mesh<3> with_layer_rule(Mesh<3>, const SmoothArguments&);

std::string size_changes(const std::vector<double>& before, const std::vector<double>& after) {
  std::vector<double> factors;
  for (std::size_t c = 0; c < before.size(); ++c)
    if (before[c] > 0.0) factors.push_back(after[c] / before[c]);
  if (factors.empty() || before == after) return {};
  std::sort(factors.begin(), factors.end());
  const auto at = [&](double part) {
    return rounded(
        factors[static_cast<std::size_t>(part * static_cast<double>(factors.size() - 1))], 3);
  };
  return "cell sizes: " + at(0.0) + " to " + at(1.0) + " times the initial ones; half of them " +
         at(0.25) + " to " + at(0.75) + ", median " + at(0.5);
}

std::string domain_change(const std::string& kind, const std::vector<double>& before,
                          const std::vector<double>& after) {
  constexpr double least = 1e-9;  // rounding of sums stays below
  const double old_size = std::accumulate(before.begin(), before.end(), 0.0),
               new_size = std::accumulate(after.begin(), after.end(), 0.0);
  const double change = new_size / old_size - 1.0;
  if (!(std::abs(change) > least)) return {};
  return "the " + kind + " of the domain has changed from " + rounded(old_size, 6) + " to " +
         rounded(new_size, 6) + " (by " + rounded(100.0 * change, 3) + " %)";
}

}  // namespace smoothfem
