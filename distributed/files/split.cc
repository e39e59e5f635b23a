// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/files/split.h"

#include <algorithm>

#include "distributed/files/pieces.h"
#include "distributed/partition.h"
#include "meshes/io/all_elements.h"
#include "meshes/io/mesh_file.h"

namespace smoothfem {

namespace {

/// Returns some rows of a field.
MeshField rows_of(const MeshField& field, const std::vector<std::size_t>& rows) {
  MeshField result = field;
  std::visit(
      [&](const auto& all) {
        std::decay_t<decltype(all)> values;
        for (const std::size_t row : rows)
          for (std::size_t k = 0; k < field.n_components; ++k)
            values.push_back(all[row * field.n_components + k]);
        result.values = std::move(values);
      },
      field.values);
  return result;
}

/// Makes the pieces of a mesh.
template <int dim>
class Splitter {
 public:
  Splitter(const Mesh<dim>& mesh, std::vector<int> piece_of_cell)
      : mesh_(mesh), topology_(mesh.topology()), elements_(mesh), piece_(std::move(piece_of_cell)) {
    for (std::size_t e = 0; e < elements_.size(); ++e) has_tags_ |= elements_.tag(e) != 0;
    for (std::size_t e = elements_.n_cells(); e < elements_.size(); ++e)
      piece_.push_back(piece_around(elements_.nodes(e)));
  }

  Mesh<dim> piece(int number) const {
    std::vector<std::size_t> nodes, elements;
    std::vector<NodeIndex> local(topology_.n_nodes(), 0);
    for (std::size_t e = 0; e < elements_.size(); ++e)
      if (piece_[e] == number) elements.push_back(e);
    for (const std::size_t e : elements)
      for (const NodeIndex node : elements_.nodes(e)) local[node] = 1;
    std::vector<Point<dim>> points;
    std::vector<FixedReasons> reasons;
    for (NodeIndex i = 0; i < local.size(); ++i) {
      if (local[i] == 0) continue;
      local[i] = static_cast<NodeIndex>(nodes.size());
      nodes.push_back(i);
      points.push_back(mesh_.coordinates()[i]);
      reasons.push_back(topology_.fixed_reasons(i));
    }
    CompressedRows<NodeIndex> cells;
    MeshLabels labels;
    labels.names = topology_.labels().names;
    FileContent content = content_of_piece(nodes, elements);
    std::vector<NodeIndex> row;
    for (const std::size_t e : elements) {
      row.clear();
      for (const NodeIndex node : elements_.nodes(e)) row.push_back(local[node]);
      const int tag = elements_.tag(e), dimension = elements_.dimension(e);
      if (e < elements_.n_cells()) {
        cells.append(row);
        if (has_tags_) labels.cell_tags.push_back(tag);  // the same arrays in all pieces
      } else if (e < elements_.n_cells() + topology_.labels().facets.size()) {
        labels.facets.append(row);
        labels.facet_tags.push_back(tag);
      } else {
        auto& others = content.others[static_cast<std::size_t>(dimension)];
        others.nodes.append(row);
        others.tags.push_back(tag);
      }
    }
    labels.content = std::make_shared<const FileContent>(std::move(content));
    const std::size_t n_nodes = points.size();
    return Mesh<dim>(std::make_shared<const Topology>(dim, n_nodes, std::move(cells),
                                                      std::move(reasons), std::move(labels)),
                     std::move(points));
  }

 private:
  /// Returns the piece of the first cell that has all these nodes.
  int piece_around(std::span<const NodeIndex> nodes) const {
    for (const CellIndex c : topology_.node_cells(nodes[0])) {
      const auto corners = topology_.cell_nodes(c);
      if (std::all_of(nodes.begin(), nodes.end(), [&](NodeIndex node) {
            return std::find(corners.begin(), corners.end(), node) != corners.end();
          }))
        return piece_[c];
    }
    return 0;
  }

  /// The fields of a piece. Other labelled elements follow.
  FileContent content_of_piece(const std::vector<std::size_t>& nodes,
                               const std::vector<std::size_t>& elements) const {
    FileContent result;
    if (const FileContent* content = topology_.labels().content.get()) {
      result.plane = content->plane;
      result.tag_field = content->tag_field;
      for (const MeshField& field : content->node_fields)
        result.node_fields.push_back(rows_of(field, nodes));
      const auto order = elements_.in_file_order(content);  // of the rows of element fields
      std::vector<std::size_t> row_of(elements_.size()), rows;
      for (std::size_t row = 0; row < order.size(); ++row) row_of[order[row]] = row;
      for (const std::size_t e : elements) rows.push_back(row_of[e]);
      for (const MeshField& field : content->element_fields)
        result.element_fields.push_back(rows_of(field, rows));
    }
    add_global_ids("GlobalNodeId", {nodes.begin(), nodes.end()}, result.node_fields,
                   result.node_roles);
    add_global_ids("GlobalCellId", {elements.begin(), elements.end()}, result.element_fields,
                   result.element_roles);
    return result;
  }

  const Mesh<dim>& mesh_;
  const Topology& topology_;
  AllElements elements_;
  std::vector<int> piece_;  ///< of all elements
  bool has_tags_ = false;   ///< whether any element has one
};

}  // namespace

template <int dim>
void write_in_pieces(const Mesh<dim>& mesh, std::size_t n_pieces,
                     const std::filesystem::path& out) {
  require_linear(mesh.topology(), "writing a mesh in pieces");
  const std::size_t n = std::min(n_pieces, mesh.n_cells());
  const Splitter<dim> splitter(mesh, bisected_cells(mesh, static_cast<int>(n)));
  const NewPieces new_pieces(out);
  for (std::size_t p = 0; p < n; ++p)
    write_mesh(new_pieces.file(p), splitter.piece(static_cast<int>(p)));
  new_pieces.finish(n);
}

template void write_in_pieces(const Mesh<2>&, std::size_t, const std::filesystem::path&);
template void write_in_pieces(const Mesh<3>&, std::size_t, const std::filesystem::path&);

}  // namespace smoothfem
