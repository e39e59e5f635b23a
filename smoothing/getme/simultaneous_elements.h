// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/getme/element_parameters.h"

namespace smoothfem {

/// Default element parameters of GETMe simultaneous. Sections are those of the thesis: D.
/// Vartziotis, J. Wipper: The GETMe Mesh Smoothing Framework. CRC Press, 2018.
/// doi:10.1201/9780429399626
template <int dim>
ElementParameters<dim> simultaneous_elements() {
  if constexpr (dim == 2)
    return {.lambda = 7.0 / 20.0, .theta_degrees = 15.0, .rho = 1.0};
  else  // Tetrahedra and hexahedra: Section 6.3. Pyramids and prisms do not converge for large
        // sigma: Section 5.4.
    return {.tetrahedron = {0.7, 50.7},
            .pyramid = {1.86, 1.86},
            .prism = {1.59, 1.59},
            .hexahedron = {0.7, 50.7},
            .rho = 1.0};
}

}  // namespace smoothfem
