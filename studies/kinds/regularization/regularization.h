// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "smoothing/mesh/element_type.h"

namespace smoothfem {

/// The elements that the transformations of a series start from.
enum class StartElements {
  arbitrary,  ///< nodes uniform in [-1, 1]^3
  valid       ///< of these, the valid ones
};

/// A series of one element type: how many transformations make random volume elements regular
/// (thesis, Sections 3.2 and 3.3).
struct RegularizationSeries {
  ElementType element_type = ElementType::tetrahedron;  ///< a volume element
  /// "dual-element" (Definition 3.4); tetrahedra also have "opposite-face-normals" (Definition
  /// 3.3).
  std::string transformation = "dual-element";
  StartElements start = StartElements::arbitrary;
  std::size_t n_elements = 100000;
  std::vector<double> sigmas{};   ///< scaling factors of the normals, at least 0
  double tolerance = 1e-6;        ///< regular: mean ratio of at least 1 - tolerance
  int max_transformations = 200;  ///< of one element; an element that needs more is not regularized
  std::uint64_t seed = 1;         ///< the same for all series, so that they have the same elements
};

/// Numbers of transformations for one sigma, over the elements that became regular.
struct TransformationCounts {
  double sigma = 0.0;
  std::size_t n_regularized = 0;
  double mean = 0.0;
  double deviation = 0.0;  ///< standard deviation
  int least = 0, most = 0;
};

/// Returns one entry per sigma. Runs in parallel. The numbers depend only on the series, not on
/// threads or machine. Throws InputError for an unknown element type or transformation, for an
/// empty series, and for numbers out of range.
std::vector<TransformationCounts> count_transformations(const RegularizationSeries& series);

/// Returns how many of the first n random elements of a type are valid (thesis, Section 3.3).
std::size_t count_valid_elements(ElementType element_type, std::size_t n, std::uint64_t seed);

}  // namespace smoothfem
