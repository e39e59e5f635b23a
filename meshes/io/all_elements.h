// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "meshes/io/mesh_view.h"
#include "meshes/io/node_order.h"

namespace smoothfem {

/// All elements of a mesh in the order of FileContent: cells, labelled facets, other elements from
/// the highest dimension to points. For writers. Refers to the mesh.
class AllElements {
 public:
  explicit AllElements(const MeshView& mesh)
      : AllElements(mesh.dimension(), mesh.topology().cells(), mesh.topology().labels()) {}

  /// dim: of the cells.
  AllElements(int dim, const CompressedRows<NodeIndex>& cells, const MeshLabels& labels) {
    const FileContent* content = labels.content.get();
    const MidsideNodes* midside = labels.midside.get();
    add({dim, &cells, midside ? &midside->of_cells : nullptr, &labels.cell_tags,
         content ? &content->cell_entities : nullptr, &labels.cell_ids});
    add({dim - 1, &labels.facets, midside ? &midside->of_facets : nullptr, &labels.facet_tags,
         content ? &content->facet_entities : nullptr, content ? &content->facet_ids : nullptr});
    for (int d = dim - 1; content && d >= 0; --d) {
      const OtherElements& others = content->others[static_cast<std::size_t>(d)];
      add({d, &others.nodes, midside ? &midside->of_others[static_cast<std::size_t>(d)] : nullptr,
           &others.tags, &others.entities, &others.ids});
    }
  }

  std::size_t size() const { return ends_.back(); }
  std::size_t n_cells() const { return ends_.front(); }

  /// Returns all elements in the order of the file that the mesh comes from.
  std::vector<std::uint32_t> in_file_order(const FileContent* content) const {
    if (content && content->file_order.size() == size()) return content->file_order;
    std::vector<std::uint32_t> order(size());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    return order;
  }

  int dimension(std::size_t e) const { return part_of(e).dimension; }
  /// Returns the corners.
  std::span<const NodeIndex> nodes(std::size_t e) const {
    return (*part_of(e).rows)[e - first_of(e)];
  }
  /// Returns the other nodes in the order of midside_nodes.h; none for linear elements.
  std::span<const NodeIndex> midside(std::size_t e) const {
    const auto* rows = part_of(e).midside;
    return rows ? (*rows)[e - first_of(e)] : std::span<const NodeIndex>();
  }
  /// Returns all nodes in the order of a format, or that of midside_nodes.h. Valid until the next
  /// call.
  std::span<const NodeIndex> row(std::size_t e, const NodeOrder* order = nullptr) const {
    const auto corners = nodes(e), others = midside(e);
    if (others.empty()) return corners;
    row_.assign(corners.begin(), corners.end());
    row_.insert(row_.end(), others.begin(), others.end());
    if (order) order->to_file(row_);
    return row_;
  }
  /// Returns the physical tag; 0: none.
  int tag(std::size_t e) const { return value(part_of(e).tags, e); }
  /// Returns the number of the model's entity; 0 if it is not known.
  int entity(std::size_t e) const { return value(part_of(e).entities, e); }
  /// Returns the file's number; 0 if it is not known.
  std::size_t id(std::size_t e) const { return value(part_of(e).ids, e); }

 private:
  struct Part {
    int dimension;
    const CompressedRows<NodeIndex>* rows;
    const CompressedRows<NodeIndex>* midside;  ///< null: all are linear
    const std::vector<int>* tags;
    const std::vector<int>* entities;
    const std::vector<std::size_t>* ids;
  };

  void add(const Part& part) {
    parts_.push_back(part);
    ends_.push_back((ends_.empty() ? 0 : ends_.back()) + part.rows->size());
  }
  std::size_t number_of_part(std::size_t e) const {
    std::size_t p = 0;
    while (e >= ends_[p]) ++p;
    return p;
  }
  const Part& part_of(std::size_t e) const { return parts_[number_of_part(e)]; }
  std::size_t first_of(std::size_t e) const {
    const std::size_t p = number_of_part(e);
    return p == 0 ? 0 : ends_[p - 1];
  }
  template <class T>
  T value(const std::vector<T>* values, std::size_t e) const {
    return values && !values->empty() ? (*values)[e - first_of(e)] : T{0};
  }

  std::vector<Part> parts_;
  std::vector<std::size_t> ends_;
  mutable std::vector<NodeIndex> row_;
};

/// The numbers that all elements get in a file: those of the file that the mesh comes from if it
/// numbers all. Otherwise cells keep theirs, and the other elements follow.
class ElementNumbers {
 public:
  ElementNumbers(const AllElements& elements, const MeshLabels& labels)
      : elements_(elements),
        cell_ids_(labels.cell_ids),
        all_have_one_(labels.has_plain_cell_ids || !labels.cell_ids.empty()) {
    for (std::size_t e = 0; e < elements.n_cells(); ++e) last_cell_ = std::max(last_cell_, of(e));
    for (std::size_t e = elements.n_cells(); e < elements.size(); ++e)
      all_have_one_ = all_have_one_ && elements.id(e) != 0;
  }

  std::size_t of(std::size_t e) const {
    if (e < elements_.n_cells()) return cell_ids_.empty() ? e + 1 : cell_ids_[e];
    return all_have_one_ ? elements_.id(e) : last_cell_ + 1 + e - elements_.n_cells();
  }

 private:
  const AllElements& elements_;
  const std::vector<std::size_t>& cell_ids_;
  std::size_t last_cell_ = 0;
  bool all_have_one_;
};

}  // namespace smoothfem
