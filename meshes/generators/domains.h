#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// What every domain understands.
struct DomainParameters {
  ElementType element_type = ElementType::triangle;  ///< one of the domain's
  double edge_scale = 1.0;  ///< edges this much longer than in the domain's own mesh: 3 gives a
                            ///< ninth of the planar cells, 2.1544 a tenth of the volume cells
  std::uint64_t seed = 1;   ///< of what is random in the domain's mesh, if anything is
};

/// A domain that `smoothfem` can mesh by itself; studies and the command line name it.
struct Domain {
  std::string name;
  std::string description;
  std::vector<ElementType> element_types;  ///< that it can be meshed with; the usual one first
  AnyMesh (*make)(const DomainParameters&);

  /// A valid mesh of the domain: planar or volume as the element type. Throws InputError that names
  /// the domain's element types for another one, and for an edge scale out of its range.
  AnyMesh generate(const DomainParameters& parameters) const;
};

const std::vector<Domain>& domains();

/// The domain of a name. Throws InputError that lists the names.
const Domain& find_domain(const std::string& name);

}  // namespace smoothfem
