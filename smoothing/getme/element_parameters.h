// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "smoothing/loop/parameter.h"

namespace smoothfem {

/// Parameters of the element step of GETMe: transform, keep centroid and size, relax. Cells of
/// surface meshes take those of the plane.
template <int dim>
struct ElementParameters;

template <>
struct ElementParameters<2> {
  double lambda;         ///< subdivision ratio, in (0, 1)
  double theta_degrees;  ///< base angle, in (0, 90)
  double rho;            ///< relaxation, in (0, 1]
  int scaling = mean_edge_length;

  enum Scaling { mean_edge_length, neighbour_mean_size };
  bool fits_neighbours() const { return scaling == neighbour_mean_size; }

  Parameters parameters() {
    return {{"lambda", "subdivision ratio of the polygon sides (Section 2.3)", &lambda, 0.0, 1.0,
             true, true},
            {"theta", "base angle of the similar triangles in degrees (Section 2.3)",
             &theta_degrees, 0.0, 90.0, true, true},
            {"rho", "relaxation; 1 takes the transformed element as it is (Eq. 3.12)", &rho, 0.0,
             1.0, true},
            {"scaling",
             "size of a transformed element: its original size (Eq. 3.11), or the mean of the "
             "elements around its nodes",
             Choice{&scaling, {"mean-edge-length", "neighbour-mean-size"}}}};
  }
};

/// The scaling factor sigma of the normals, from `low` for regular elements to `high` for elements
/// of quality zero (thesis, Section 4.2).
struct SigmaRange {
  double low, high;
};

template <>
struct ElementParameters<3> {
  enum TetrahedronTransformation { opposite_face_normals, dual_element };
  enum Scaling { mean_edge_length, mean_volume, neighbour_mean_size };
  bool fits_neighbours() const { return scaling == neighbour_mean_size; }

  SigmaRange tetrahedron, pyramid, prism, hexahedron;
  double rho;  ///< relaxation, in (0, 1]
  int tetrahedron_transformation = opposite_face_normals;
  int scaling = mean_edge_length;

  const SigmaRange& sigma(std::size_t n_nodes) const {
    return n_nodes == 4 ? tetrahedron : n_nodes == 5 ? pyramid : n_nodes == 6 ? prism : hexahedron;
  }

  Parameters parameters() {
    Parameters all;
    const auto add_sigma = [&all](const std::string& type, SigmaRange& sigma) {
      constexpr double largest = 1e4;
      all.push_back({"sigma_" + type + "_min",
                     "scaling factor of the normals for a " + type + " of quality 1 (Section 4.2)",
                     &sigma.low, 0.0, largest});
      all.push_back({"sigma_" + type + "_max", "scaling factor for quality 0; linear in between",
                     &sigma.high, 0.0, largest});
    };
    add_sigma("tetrahedron", tetrahedron);
    add_sigma("pyramid", pyramid);
    add_sigma("prism", prism);
    add_sigma("hexahedron", hexahedron);
    all.push_back({"rho", "relaxation; 1 takes the transformed element as it is (Eq. 3.12)", &rho,
                   0.0, 1.0, true});
    all.push_back({"tetrahedron_transformation", "transformation of tetrahedra (Sections 3.2, 3.3)",
                   Choice{&tetrahedron_transformation, {"opposite-face-normals", "dual-element"}}});
    all.push_back(
        {"scaling",
         "size of a transformed element: its original size (Section 3.3), or the mean of the "
         "elements around its nodes",
         Choice{&scaling, {"mean-edge-length", "mean-volume", "neighbour-mean-size"}}});
    return all;
  }
};

/// Returns the parameters for element steps that take a size.
template <int dim>
ElementParameters<dim> with_given_sizes(ElementParameters<dim> parameters) {
  parameters.scaling = ElementParameters<dim>::neighbour_mean_size;
  return parameters;
}

}  // namespace smoothfem
