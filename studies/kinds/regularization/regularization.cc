// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/regularization/regularization.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "meshes/distortion/counter_random.h"
#include "smoothing/base/parallel.h"
#include "smoothing/getme/regularize.h"

namespace smoothfem {

namespace {

/// Coordinates of n_lanes elements, node by node, while they are drawn.
template <std::size_t n>
using ElementLanes = std::array<Vector3<Lanes>, n>;

template <std::size_t n>
using Element = std::array<Vector3<double>, n>;

/// Returns the `attempt`-th random element of a number.
template <std::size_t n>
Element<n> random_element(std::uint64_t seed, std::uint64_t number, std::uint64_t attempt) {
  SplitMix64 random = counter_random(seed, number, attempt);
  Element<n> element;
  for (auto& node : element)
    for (double* coordinate : {&node.x, &node.y, &node.z})
      *coordinate = 2.0 * random.uniform() - 1.0;
  return element;
}

template <std::size_t n>
bool is_valid(const Element<n>& element) {
  return mean_ratio(std::span<const Vector3<double>, n>(element)) > 0.0;
}

template <std::size_t n>
Element<n> start_element(const RegularizationSeries& series, std::uint64_t number) {
  std::uint64_t attempt = 0;
  Element<n> element = random_element<n>(series.seed, number, attempt);
  while (series.start == StartElements::valid && !is_valid(element))
    element = random_element<n>(series.seed, number, ++attempt);
  return element;
}

/// Exact sums, so that their order does not matter.
struct Tally {
  std::uint64_t n = 0, sum = 0, sum_of_squares = 0;
  int least = std::numeric_limits<int>::max(), most = 0;

  void add(int count) {
    ++n;
    const auto value = static_cast<std::uint64_t>(count);
    sum += value;
    sum_of_squares += value * value;
    least = std::min(least, count);
    most = std::max(most, count);
  }
  void add(const Tally& other) {
    n += other.n;
    sum += other.sum;
    sum_of_squares += other.sum_of_squares;
    least = std::min(least, other.least);
    most = std::max(most, other.most);
  }
};

/// Returns the transformations until each of n_lanes elements is regular; max + 1 if it is not
/// regular by then.
template <std::size_t n>
[[gnu::flatten]] void count_lanes(const ElementRegularization<3>& transformation,
                                  ElementLanes<n> elements, double regular, int max,
                                  std::array<int, n_lanes>& counts) {
  counts.fill(max + 1);
  std::size_t n_left = n_lanes;
  for (int count = 0; count <= max && n_left > 0; ++count) {
    ElementLanes<n> next;
    const Lanes quality = transformation.regularize(std::span<const Vector3<Lanes>, n>(elements),
                                                    std::span<Vector3<Lanes>, n>(next));
    for (std::size_t l = 0; l < n_lanes; ++l) {
      if (counts[l] <= max || !(quality[l] >= regular)) continue;
      counts[l] = count;
      --n_left;
    }
    elements = next;
  }
}

ElementParameters<3> parameters_of(const RegularizationSeries& series, double sigma) {
  using Parameters = ElementParameters<3>;
  return {.tetrahedron = {sigma, sigma},
          .pyramid = {sigma, sigma},
          .prism = {sigma, sigma},
          .hexahedron = {sigma, sigma},
          .rho = 1.0,
          .tetrahedron_transformation = series.transformation == "opposite-face-normals"
                                            ? Parameters::opposite_face_normals
                                            : Parameters::dual_element,
          .scaling = Parameters::mean_edge_length};
}

template <std::size_t n>
std::vector<Tally> tallies(const RegularizationSeries& series, std::size_t first,
                           std::size_t last) {
  std::vector<Tally> result(series.sigmas.size());
  for (std::size_t number = first; number < last; number += n_lanes) {
    ElementLanes<n> elements{};
    const std::size_t n_used = std::min(n_lanes, last - number);
    for (std::size_t l = 0; l < n_lanes; ++l) {
      const Element<n> element = start_element<n>(series, number + std::min(l, n_used - 1));
      for (std::size_t k = 0; k < n; ++k) {
        elements[k].x[l] = element[k].x;
        elements[k].y[l] = element[k].y;
        elements[k].z[l] = element[k].z;
      }
    }
    for (std::size_t s = 0; s < series.sigmas.size(); ++s) {
      const double sigma = series.sigmas[s];
      const ElementRegularization<3> transformation(parameters_of(series, sigma));
      std::array<int, n_lanes> counts;
      count_lanes<n>(transformation, elements, 1.0 - series.tolerance, series.max_transformations,
                     counts);
      for (std::size_t l = 0; l < n_used; ++l)
        if (counts[l] <= series.max_transformations) result[s].add(counts[l]);
    }
  }
  return result;
}

/// Calls work.operator()<n>() with the number of nodes of a volume element.
template <class Work>
auto with_node_count(ElementType type, const Work& work) {
  switch (type) {
    case ElementType::tetrahedron:
      return work.template operator()<4>();
    case ElementType::pyramid:
      return work.template operator()<5>();
    case ElementType::prism:
      return work.template operator()<6>();
    case ElementType::hexahedron:
      return work.template operator()<8>();
    default:
      throw InputError("there is no transformation by normals of a " + std::string(name_of(type)) +
                       "; " + choose_one_of({"tetrahedron", "pyramid", "prism", "hexahedron"}));
  }
}

constexpr std::size_t grain = 256;  // elements that a thread takes at a time

void require_in_range(const RegularizationSeries& series) {
  const bool for_tetrahedra = series.transformation == "opposite-face-normals" &&
                              series.element_type == ElementType::tetrahedron;
  if (series.transformation != "dual-element" && !for_tetrahedra)
    throw InputError("there is no transformation '" + series.transformation + "' of a " +
                     std::string(name_of(series.element_type)) +
                     "; use dual-element, or opposite-face-normals for tetrahedra");
  if (series.n_elements < 1 || series.sigmas.empty())
    throw InputError("a regularization series needs at least one element and one sigma");
  for (const double sigma : series.sigmas)
    if (!(sigma >= 0.0))
      throw InputError("the sigma " + std::to_string(sigma) + " is not at least 0");
  if (!(series.tolerance > 0.0 && series.tolerance < 1.0))
    throw InputError("the regularization's tolerance must lie between 0 and 1");
  if (series.max_transformations < 1)
    throw InputError("the largest number of transformations must be at least 1");
}

TransformationCounts counts_of(double sigma, const Tally& tally) {
  TransformationCounts counts{.sigma = sigma, .n_regularized = tally.n};
  if (tally.n == 0) return counts;
  const auto n = static_cast<double>(tally.n);
  counts.mean = static_cast<double>(tally.sum) / n;
  const double mean_square = static_cast<double>(tally.sum_of_squares) / n;
  counts.deviation = std::sqrt(std::max(0.0, mean_square - counts.mean * counts.mean));
  counts.least = tally.least;
  counts.most = tally.most;
  return counts;
}

}  // namespace

std::vector<TransformationCounts> count_transformations(const RegularizationSeries& series) {
  require_in_range(series);
  std::vector<Tally> total(series.sigmas.size());
  with_node_count(series.element_type, [&]<std::size_t n>() {
    std::mutex mutex;
    parallel_for_ranges(series.n_elements, grain, [&](std::size_t first, std::size_t last) {
      const auto part = tallies<n>(series, first, last);
      const std::lock_guard lock(mutex);
      for (std::size_t s = 0; s < total.size(); ++s) total[s].add(part[s]);
    });
  });
  std::vector<TransformationCounts> result;
  for (std::size_t s = 0; s < total.size(); ++s)
    result.push_back(counts_of(series.sigmas[s], total[s]));
  return result;
}

std::size_t count_valid_elements(ElementType element_type, std::size_t n, std::uint64_t seed) {
  return with_node_count(element_type, [&]<std::size_t n_nodes>() {
    std::vector<std::size_t> valid((n + grain - 1) / grain, 0);
    parallel_for_ranges(n, grain, [&](std::size_t first, std::size_t last) {
      for (std::size_t number = first; number < last; ++number)
        if (is_valid(random_element<n_nodes>(seed, number, 0))) ++valid[first / grain];
    });
    std::size_t sum = 0;
    for (const std::size_t count : valid) sum += count;
    return sum;
  });
}

}  // namespace smoothfem
