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
#include "smoothing/second_order/curved_quality.h"

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
  print_losses(path, losses(path, mesh, options));
}

void print_losses(const std::filesystem::path& path, const std::vector<std::string>& lost) {
  if (!lost.empty())
    print_notes(path.string(), {"the file cannot hold, and leaves out: " + joined(lost)});
}

void print_left_out(const std::filesystem::path& path, const std::vector<std::string>& losses) {
  if (!losses.empty()) print_notes(path.string(), {"refinement leaves out: " + joined(losses)});
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
  if constexpr (dim == spacedim)
    sizes = curved_cell_sizes(mesh);
  else
    for (CellIndex c = 0; c < mesh.n_cells(); ++c) sizes[c] = signed_cell_size(mesh, c);
  for (double& size : sizes) size = std::abs(size);
  return sizes;
}

template std::vector<double> cell_sizes(const Mesh<2>&);
template std::vector<double> cell_sizes(const Mesh<3>&);
template std::vector<double> cell_sizes(const Mesh<2, 3>&);

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
