// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

namespace py = pybind11;

bool has_whole_numbers(const py::array& array);

/// Converts flags or numbers of nodes to one flag for each node; no flags for None. name: of the
/// argument in messages. Throws InputError for other objects.
std::optional<std::vector<bool>> node_flags(const std::string& name, const py::object& given,
                                            std::size_t n_nodes);

/// Returns meshio's name of a linear element, for example "tetra"; dim: 1 to 3.
std::string meshio_name(int dim, std::size_t n_nodes);

/// What Python sees of a topology: read-only arrays of node numbers, made when they are first asked
/// for. None is a copy where the topology has the same numbers one after the other.
class TopologyArrays {
 public:
  explicit TopologyArrays(std::shared_ptr<const Topology> topology)
      : topology_(std::move(topology)) {}

  const Topology& topology() const { return *topology_; }

  /// Node numbers of each cell: (n_cells, k) where all cells have k nodes, otherwise a tuple of
  /// arrays.
  const py::object& cells();
  /// "tetrahedron" -> (n, 4) and so on; of polygons "5-gon" and so on. In the order of the cells.
  const py::dict& blocks();
  /// As blocks, with meshio's names.
  const py::dict& cells_dict();
  /// By the types of cells_dict(): midside nodes in the order of meshio and VTK, (n, k), or a tuple
  /// of arrays if k differs. Empty for linear meshes.
  const py::dict& midside_nodes();
  const py::array& edges();            ///< (n, 2)
  const py::tuple& node_neighbours();  ///< offsets and nodes
  const py::dict& boundary_facets();   ///< by type, with meshio's names
  const py::array& free_nodes();
  const py::array& fixed_nodes();

 private:
  py::dict cells_by_type(std::string (*name)(int dim, std::size_t n_nodes));

  std::shared_ptr<const Topology> topology_;
  py::object cells_;
  py::dict blocks_, cells_dict_, midside_nodes_, boundary_facets_;
  std::optional<py::array> edges_;
  std::optional<py::tuple> node_neighbours_;
  py::array free_, fixed_;
};

/// The mesh that a Python object stands for: one of its own, or one that the smoothing loop lends
/// for the time of a call.
class PythonMesh {
 public:
  using Reference = std::variant<PlanarMesh*, VolumeMesh*, SurfaceMesh*>;

  explicit PythonMesh(AnyMesh mesh);
  /// writable: otherwise Python gets a copy of the points.
  PythonMesh(Reference lent, std::shared_ptr<TopologyArrays> arrays, bool writable);

  /// visit(mesh), whatever its kind. Throws InputError if a lent mesh is not there any more.
  template <class Visit>
  decltype(auto) visit(const Visit& visit) const {
    return std::visit(
        [&](auto* mesh) -> decltype(auto) {
          if (mesh == nullptr)
            throw InputError(
                "this mesh is one that a smoother was given for one call, which is over; take what "
                "is needed of it during the call");
          return visit(*mesh);
        },
        mesh_);
  }

  TopologyArrays& arrays() const { return *arrays_; }

  /// (n_nodes, spacedim): the memory of the mesh itself. self: this mesh as Python's object.
  py::array points(const py::object& self);
  /// Copies into that memory. Throws InputError for another shape or non-finite numbers.
  void set_points(const py::object& points);

  /// A lent mesh goes back to the loop. Arrays of its points that Python still has keep the memory,
  /// and the mesh gets another one. Returns whether there were such arrays.
  bool give_back();

 private:
  struct Kept;

  std::unique_ptr<AnyMesh> own_;
  Reference mesh_;
  std::shared_ptr<TopologyArrays> arrays_;
  bool writable_ = true;
  py::array lent_points_;  ///< of a lent mesh, once asked for
  Kept* kept_ = nullptr;   ///< belongs to lent_points_: the memory, if that outlives the loan
};

}  // namespace smoothfem
