// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/space/numbered_dofs.h"

#include <algorithm>
#include <numeric>

#include "fem/space/distributed_dofs.h"
#include "fem/space/distributed_mesh.h"
#include "fem/space/nodal_dofs.h"

namespace smoothfem {

namespace {

constexpr auto absent = FiniteElementSpace<2>::absent;

/// Copies deal.II's numbering to a space.
template <int dim>
class SpaceReader {
 public:
  SpaceReader(const dealii::DoFHandler<dim>& dofs, const NaturalBoundary& natural,
              bool vertices_hold_numbers, FiniteElementSpace<dim>& space)
      : dofs_(dofs),
        natural_(natural),
        vertices_hold_numbers_(vertices_hold_numbers),
        space_(space) {
    const auto& own = dofs.locally_owned_dofs();  // contiguous
    n_own_dofs_ = own.n_elements();
    first_ = n_own_dofs_ > 0 ? own.nth_index_in_set(0) : 0;
  }

  void read() {
    space_.n_dofs = dofs_.n_dofs();
    find_others();
    number_free_dofs();
    number_local_dofs();
    read_cells();
    std::erase_if(space_.groups, [](const auto& group) { return group.n_cells() == 0; });
  }

 private:
  using Index = dealii::types::global_dof_index;
  using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;
  static constexpr double boundary = -1.0;

  bool is_own(Index dof) const { return dof >= first_ && dof - first_ < n_own_dofs_; }

  ElementCells& group_of(const Cell& cell) const {
    return space_.groups[cell->reference_cell().is_simplex() ? simplex_index : tensor_index];
  }

  /// Calls visit(cell, its dofs) for this rank's own cells, or for those around them.
  template <class Visit>
  void for_each_cell(bool own, const Visit& visit) const {
    std::vector<Index> indices;
    for (const auto& cell : dofs_.active_cell_iterators()) {
      if (cell->is_artificial() || cell->is_ghost() == own) continue;
      indices.resize(cell->get_fe().n_dofs_per_cell());
      cell->get_dof_indices(indices);
      visit(cell, indices);
    }
  }

  /// True if a surrounding cell contributes to an equation here. (A boundary dof is enough; it only
  /// makes the parts overlap a little more.)
  bool contributes(const std::vector<Index>& indices) const {
    return std::any_of(indices.begin(), indices.end(), [&](Index dof) { return is_own(dof); });
  }

  /// Finds the dofs of other ranks on the cells here, ascending.
  void find_others() {
    const auto collect = [&](const Cell&, const std::vector<Index>& indices) {
      std::copy_if(indices.begin(), indices.end(), std::back_inserter(others_),
                   [&](Index dof) { return !is_own(dof); });
    };
    for_each_cell(true, collect);
    for_each_cell(false, [&](const Cell& cell, const std::vector<Index>& indices) {
      if (contributes(indices)) collect(cell, indices);
    });
    std::sort(others_.begin(), others_.end());
    others_.erase(std::unique(others_.begin(), others_.end()), others_.end());
  }

  /// Returns the position of a dof: own dofs first, then the others.
  std::size_t position(Index dof) const {
    if (is_own(dof)) return dof - first_;
    return n_own_dofs_ +
           static_cast<std::size_t>(std::lower_bound(others_.begin(), others_.end(), dof) -
                                    others_.begin());
  }

  /// Returns the cell's dofs on one of its faces: those whose position is a mean of the face's
  /// vertices.
  static std::vector<unsigned int> face_dofs(const ReferenceElement& element, const Cell& cell,
                                             unsigned int face) {
    std::vector<bool> in_face(element.n_vertices, false);
    const auto reference = cell->reference_cell();
    for (const unsigned int k : cell->face(face)->vertex_indices())
      in_face[reference.face_to_cell_vertices(face, k, 1)] = true;
    std::vector<unsigned int> dofs;
    for (unsigned int i = 0; i < element.n_dofs; ++i) {
      double support = 0.0;  // weight of the face; the total is 1
      for (std::size_t v = 0; v < element.n_vertices; ++v)
        if (in_face[v]) support += element.support[i * element.n_vertices + v];
      if (support > 1.0 - 1e-12) dofs.push_back(i);
    }
    return dofs;
  }

  /// Returns the mesh's number of a cell's node.
  NodeIndex mesh_node(const Cell& cell, unsigned int v) const {
    return vertices_hold_numbers_ ? static_cast<NodeIndex>(cell->vertex(v)[0])
                                  : static_cast<NodeIndex>(cell->vertex_index(v));
  }

  bool is_natural(const Cell& cell, unsigned int face) const {
    if (natural_.empty()) return false;
    std::vector<NodeIndex> nodes;
    for (const unsigned int k : cell->face(face)->vertex_indices())
      nodes.push_back(mesh_node(cell, cell->reference_cell().face_to_cell_vertices(face, k, 1)));
    return natural_.contains(std::move(nodes));
  }

  /// Flags the own boundary dofs. A cell of another rank may have faces that only appear to be on
  /// the boundary, because their neighbours are unknown here. Those faces have no own dofs.
  std::vector<bool> own_boundary_dofs() const {
    std::vector<bool> on_boundary(n_own_dofs_, false);
    const auto mark = [&](const Cell& cell, const std::vector<Index>& indices) {
      for (const unsigned int f : cell->face_indices()) {
        if (!cell->face(f)->at_boundary() || is_natural(cell, f)) continue;
        for (const unsigned int i : face_dofs(group_of(cell).element, cell, f))
          if (is_own(indices[i])) on_boundary[indices[i] - first_] = true;
      }
    };
    for_each_cell(true, mark);
    for_each_cell(false, mark);
    return on_boundary;
  }

  /// Numbers free dofs rank by rank; every rank gets the numbers of its dofs.
  void number_free_dofs() {
    const auto on_boundary = own_boundary_dofs();
    space_.n_own =
        static_cast<std::size_t>(std::count(on_boundary.begin(), on_boundary.end(), false));
    space_.n_own_boundary = n_own_dofs_ - space_.n_own;
    space_.n_free = space_.ranks.sum(space_.n_own);
    first_number_ = space_.ranks.exclusive_scan(space_.n_own);
    std::size_t next = first_number_;
    numbers_.resize(static_cast<Eigen::Index>(n_own_dofs_ + others_.size()));
    for (std::size_t dof = 0; dof < n_own_dofs_; ++dof)
      numbers_[static_cast<Eigen::Index>(dof)] =
          on_boundary[dof] ? boundary : static_cast<double>(next++);
    Halo(space_.ranks, dofs_.n_dofs(), first_, n_own_dofs_, {others_.begin(), others_.end()})
        .update(numbers_);
  }

  /// Numbers own free dofs, free dofs of others (ascending numbers), and boundary dofs.
  void number_local_dofs() {
    auto& columns = space_.column_numbers;
    for (std::size_t i = 0; i < space_.n_own; ++i) columns.push_back(first_number_ + i);
    const double first = static_cast<double>(first_number_);
    const double last = static_cast<double>(first_number_ + space_.n_own);
    for (const double number : numbers_)
      if (number != boundary && (number < first || number >= last))
        columns.push_back(static_cast<std::size_t>(number));
    const auto ghosts = columns.begin() + static_cast<std::ptrdiff_t>(space_.n_own);
    std::sort(ghosts, columns.end());
    space_.n_columns = space_.n_local = columns.size();
    for (const double number : numbers_) {
      if (number == boundary) {
        local_.push_back(static_cast<std::uint32_t>(space_.n_local++));
        continue;
      }
      const auto n = static_cast<std::size_t>(number);
      if (number >= first && number < last)
        local_.push_back(static_cast<std::uint32_t>(n - first_number_));
      else
        local_.push_back(static_cast<std::uint32_t>(std::lower_bound(ghosts, columns.end(), n) -
                                                    columns.begin()));
    }
    space_.halo =
        Halo(space_.ranks, space_.n_free, first_number_, space_.n_own, {ghosts, columns.end()});
  }

  /// Returns the local number of a cell's node. One process keeps the mesh's numbers; several
  /// number nodes in the order of cells.
  std::uint32_t local_node(const Cell& cell, unsigned int v) {
    if (!vertices_hold_numbers_) return static_cast<std::uint32_t>(cell->vertex_index(v));
    auto& local = local_nodes_[cell->vertex_index(v)];
    if (local == absent) {
      local = static_cast<std::uint32_t>(space_.nodes.size());
      space_.nodes.push_back(mesh_node(cell, v));
    }
    return local;
  }

  void read_cells() {
    const std::size_t n_vertices = dofs_.get_triangulation().n_vertices();
    if (vertices_hold_numbers_) {
      local_nodes_.assign(n_vertices, absent);
    } else {
      space_.nodes.resize(n_vertices);
      std::iota(space_.nodes.begin(), space_.nodes.end(), NodeIndex{0});
    }
    const auto append = [&](const Cell& cell, const std::vector<Index>& indices) {
      auto& group = group_of(cell);
      for (const unsigned int v : cell->vertex_indices())
        group.vertices.push_back(local_node(cell, v));
      for (const Index dof : indices) group.dofs.push_back(local_[position(dof)]);
      group.kinds.push_back(cell->material_id());
      group.numbers.push_back(static_cast<CellIndex>(cell->id().get_coarse_cell_id()));
    };
    for_each_cell(true, append);
    for (auto& group : space_.groups) group.n_own = group.n_cells();
    for_each_cell(false, [&](const Cell& cell, const std::vector<Index>& indices) {
      if (contributes(indices)) append(cell, indices);
    });
  }

  const dealii::DoFHandler<dim>& dofs_;
  const NaturalBoundary& natural_;
  bool vertices_hold_numbers_;
  FiniteElementSpace<dim>& space_;
  Index first_ = 0;
  std::size_t n_own_dofs_ = 0, first_number_ = 0;
  std::vector<Index> others_;
  Eigen::VectorXd numbers_;           ///< among all free dofs, or `boundary`; at `position`
  std::vector<std::uint32_t> local_;  ///< at `position`
  std::vector<std::uint32_t> local_nodes_;
};

}  // namespace

namespace {

/// True if deal.II can number the dofs: it crashes on volume meshes of several types of cells.
template <int dim>
bool is_for_deal_ii(const Mesh<dim>* mesh, const Ranks& ranks) {
  bool is = true;
  if (dim == 3 && mesh != nullptr) {
    const Topology& topology = mesh->topology();
    const ElementType first = topology.cell_type(0);
    is = first == ElementType::tetrahedron || first == ElementType::hexahedron;
    for (CellIndex c = 1; is && c < topology.n_cells(); ++c) is = topology.cell_type(c) == first;
  }
  ranks.broadcast(is);
  return is;
}

}  // namespace

template <int dim>
NaturalBoundary number_dofs(const Mesh<dim>* mesh, const TensorPoints& tensor_points,
                            const std::vector<std::string>& natural_groups, const NodeTies* ties,
                            FiniteElementSpace<dim>& space) {
  const Topology* const topology = mesh == nullptr ? nullptr : &mesh->topology();
  space.in_parts = topology != nullptr && topology->part() != nullptr;
  if (space.in_parts && (space.degree > 1 || !natural_groups.empty() || ties != nullptr))
    throw InputError(
        "finite elements on a mesh in parts have degree 1, and u is given on the whole boundary: "
        "for all others use one process that has the whole mesh");
  require_on_all_ranks<dim>(topology, space.degree, natural_groups, space.ranks);
  NaturalBoundary natural(topology, natural_groups, space.ranks);
  bool has_ties = ties != nullptr && !ties->empty();
  space.ranks.broadcast(has_ties);
  if (has_ties && space.degree > 1)
    throw InputError(
        "finite elements of degree 2 have no constraints for hanging nodes and periodic partners: "
        "use degree 1");
  if (has_ties && space.is_curved)
    throw InputError(
        "curved cells have no constraints for hanging nodes and periodic partners: write 'set "
        "geometry = straight'");
  if (space.in_parts || has_ties || !is_for_deal_ii(mesh, space.ranks)) {
    number_nodal_dofs(topology, tensor_points, natural, ties, space);
    return natural;
  }
  const int n_points = dim == 2 ? tensor_points.quadrilateral : tensor_points.hexahedron;
  // In space all cells have one type. Tables of curved cells of the other one would take longer
  // than all else.
  ElementType of_cells = mesh == nullptr ? ElementType::polygon : mesh->topology().cell_type(0);
  space.ranks.broadcast(of_cells);
  for (const ElementType type : element_types<dim>)
    space.groups.emplace_back().element = make_reference_element(
        type, space.degree, n_points, space.is_curved && (dim == 2 || type == of_cells));
  const auto triangulation = make_triangulation(mesh, space.ranks);
  dealii::DoFHandler<dim> dofs(*triangulation);
  distribute_dofs(dofs, space.degree);
  SpaceReader<dim>(dofs, natural, space.ranks.size() > 1, space).read();
  return natural;
}

template NaturalBoundary number_dofs(const Mesh<2>*, const TensorPoints&,
                                     const std::vector<std::string>&, const NodeTies*,
                                     FiniteElementSpace<2>&);
template NaturalBoundary number_dofs(const Mesh<3>*, const TensorPoints&,
                                     const std::vector<std::string>&, const NodeTies*,
                                     FiniteElementSpace<3>&);

}  // namespace smoothfem
