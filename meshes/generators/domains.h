#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// What every domain understands.
struct DomainParameters {
  ElementType element_type = ElementType::triangle;  ///< triangle or quadrilateral
  double edge_scale = 1.0;  ///< edges this much longer than in the domain's own mesh: 3 gives a
                            ///< ninth of the cells
  std::uint64_t seed = 1;
};

/// A domain that `smoothfem` can mesh by itself; studies and the command line name it.
struct Domain {
  std::string name;
  std::string description;
  PlanarMesh (*generate)(const DomainParameters&);
};

const std::vector<Domain>& domains();

/// The domain of a name. Throws InputError that lists the names.
const Domain& find_domain(const std::string& name);

}  // namespace smoothfem
