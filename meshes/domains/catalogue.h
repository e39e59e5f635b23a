// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meshes/tools/curved_boundary.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Parameters of every domain.
struct DomainParameters {
  std::string elements{};       ///< an element name of the domain; empty: its first one
  double edge_scale = 1.0;      ///< factor on the edge lengths of the domain's own mesh: 3 gives a
                                ///< ninth of the planar cells, 2.1544 a tenth of the volume cells
  std::uint64_t seed = 1;       ///< seed of random parts of the domain's mesh, if there are any
  std::string algorithm{};      ///< of the domain's list for these elements; empty: the first one
  std::optional<double> eps{};  ///< in (0, 1], for domains that have it; nothing: their own
};

/// A mesh of second order, and what was done to make its curved cells valid.
struct SecondOrderMesh {
  AnyMesh mesh;
  MidsideReport report;
};

/// A domain that `smoothfem` can mesh; studies and the command line name it.
struct Domain {
  std::string name;
  std::string description;
  int dimension;                      ///< of its meshes' cells: 2 or 3
  std::vector<std::string> elements;  ///< supported names of element_names(); the default first
  std::vector<std::string> random_elements{};  ///< elements whose meshes depend on the seed
  /// Algorithms of the mesh generator, by elements, the default first. Elements that are not named
  /// have one algorithm, without a name.
  std::map<std::string, std::vector<std::string>> algorithms{};
  bool is_surface = false;      ///< its meshes are surfaces in space
  bool has_groups = false;      ///< its cells or its boundary have groups
  std::optional<double> eps{};  ///< default of DomainParameters::eps; nothing: it has none
  /// Its parameters `elements` and `algorithm` are names of the domain's lists; `eps` has a value
  /// if the domain has it.
  std::function<AnyMesh(const DomainParameters&)> make;
  /// The boundary of the domain, for the mesh that `make` returns; empty: it has no meshes of
  /// second order.
  std::function<AnyOntoBoundary(const DomainParameters&)> boundary{};

  /// Makes a valid mesh of the domain with fixed boundary nodes (on surfaces: constrained ones).
  /// Throws InputError for unsupported elements, and for an edge scale or eps out of range.
  AnyMesh generate(const DomainParameters& parameters) const;

  /// Adds midside nodes on the true boundary to a mesh from generate() with the same parameters.
  /// Inner nodes may have been moved. Cells that become invalid are repaired. Throws InputError if
  /// the domain has no meshes of second order.
  SecondOrderMesh of_second_order(const AnyMesh& mesh, const DomainParameters& parameters) const;

  /// Throws InputError that names other domains if this one has no meshes of second order.
  void require_second_order() const;

  /// Returns the elements of a name; for an empty name the default ones. Throws InputError that
  /// lists the domain's elements.
  const std::string& elements_named(const std::string& wanted) const;

  /// Returns the elements and their algorithms for users: "triangles by frontal, delaunay; quads".
  std::string offers() const;

  /// Returns the algorithm of a name; for an empty name the default one. elements: of the domain's
  /// list. Throws InputError that lists the algorithms.
  std::string algorithm_named(const std::string& wanted, const std::string& elements) const;

  /// Returns eps, or the domain's default. Throws InputError if it is out of range, or if the
  /// domain has none.
  std::optional<double> eps_of(std::optional<double> wanted) const;

  /// True if meshes of these elements (a name, or empty) depend on the seed.
  bool is_random(const std::string& wanted) const;

 private:
  DomainParameters known(const DomainParameters& parameters) const;
};

/// Registers a domain when its file is loaded: one namespace-scope object at the end of each file
/// in meshes/domains/. A duplicate name is an InputError at the first look-up.
struct RegisteredDomain {
  explicit RegisteredDomain(Domain domain);
};

/// Returns the users' names: "triangles", "quadrilaterals", "mixed" (planar or volume cells of
/// several types), "tetrahedra", "hexahedra".
const std::vector<std::string>& element_names();

/// Returns all registered domains, sorted by name.
const std::vector<Domain>& domains();

/// Returns the domain of a name. Throws InputError that lists the names.
const Domain& find_domain(const std::string& name);

}  // namespace smoothfem
