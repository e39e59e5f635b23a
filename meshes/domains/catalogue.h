// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// What every domain understands.
struct DomainParameters {
  std::string elements{};   ///< one of the domain's; empty: the first of them
  double edge_scale = 1.0;  ///< edges this much longer than in the domain's own mesh: 3 gives a
                            ///< ninth of the planar cells, 2.1544 a tenth of the volume cells
  std::uint64_t seed = 1;   ///< of what is random in the domain's mesh, if anything is
};

/// A domain that `smoothfem` can mesh by itself; studies and the command line name it.
struct Domain {
  std::string name;
  std::string description;
  int dimension;                      ///< of its meshes' cells: 2 or 3
  std::vector<std::string> elements;  ///< of element_names(), that it can be meshed with; the
                                      ///< default ones first
  std::vector<std::string> random_elements{};  ///< those of them whose meshes the seed changes
  bool is_surface = false;                     ///< its meshes are surfaces in space
  AnyMesh (*make)(const DomainParameters&);    ///< its `elements` are one of the domain's

  /// A valid mesh of the domain, whose boundary nodes are fixed (on surfaces: kept by constraints).
  /// Throws InputError for elements that the domain cannot be meshed with, and for an edge scale
  /// out of its range.
  AnyMesh generate(const DomainParameters& parameters) const;

  /// The elements of a name, or, if it is empty, the default ones. Throws InputError that lists the
  /// domain's.
  const std::string& elements_named(const std::string& wanted) const;

  /// Whether the seed changes meshes of these elements (a name, or empty).
  bool is_random(const std::string& wanted) const;
};

/// Registers a domain when its file is loaded: one namespace-scope object at the end of each file
/// in meshes/domains/. A name that is taken is an InputError at the first look-up.
struct RegisteredDomain {
  explicit RegisteredDomain(Domain domain);
};

/// As users write them: "triangles", "quadrilaterals", "mixed" (planar or volume cells of several
/// types), "tetrahedra", "hexahedra".
const std::vector<std::string>& element_names();

/// All registered domains, sorted by name.
const std::vector<Domain>& domains();

/// The domain of a name. Throws InputError that lists the names.
const Domain& find_domain(const std::string& name);

}  // namespace smoothfem
