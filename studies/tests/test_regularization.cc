// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "meshes/distortion/counter_random.h"
#include "smoothing/base/parallel.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/transformations/dual_element.h"
#include "studies/kinds/regularization/regularization_study.h"
#include "studies/tests/documented_columns.h"

namespace smoothfem {
namespace {

using Vector = Vector3<double>;

/// Returns the same count for one element alone: without lanes, and with place and size kept by its
/// first node and largest extent.
template <std::size_t n>
int count_alone(std::array<Vector, n> element, double sigma) {
  for (int count = 0; count < 1000; ++count) {
    if (mean_ratio(std::span<const Vector, n>(element)) >= 1.0 - 1e-6) return count;
    std::array<Vector, n> next;
    DualElement::apply(sigma, std::span<const Vector, n>(element), std::span<Vector, n>(next));
    double largest = 0.0;
    for (const auto& node : next) largest = std::max(largest, std::abs((node - next[0]).x));
    for (std::size_t k = 0; k < n; ++k) element[k] = (1.0 / largest) * (next[k] - next[0]);
  }
  return 1000;
}

template <std::size_t n>
void expect_same_as_alone(ElementType type) {
  const RegularizationSeries series{
      .element_type = type, .n_elements = 30, .sigmas = {0.4}, .seed = 7};
  double sum = 0.0;
  int most = 0;
  for (std::uint64_t number = 0; number < series.n_elements; ++number) {
    SplitMix64 random = counter_random(series.seed, number, 0);
    std::array<Vector, n> element;
    for (auto& node : element)
      for (double* coordinate : {&node.x, &node.y, &node.z})
        *coordinate = 2.0 * random.uniform() - 1.0;
    const int count = count_alone(element, 0.4);
    sum += count;
    most = std::max(most, count);
  }
  const auto counts = count_transformations(series);
  ASSERT_EQ(counts.size(), 1u);
  EXPECT_EQ(counts[0].n_regularized, series.n_elements);
  EXPECT_DOUBLE_EQ(counts[0].mean, sum / 30.0) << name_of(type);
  EXPECT_EQ(counts[0].most, most);
}

TEST(Regularization, CountsAsElementsByThemselves) {
  expect_same_as_alone<4>(ElementType::tetrahedron);
  expect_same_as_alone<5>(ElementType::pyramid);
  expect_same_as_alone<6>(ElementType::prism);
  expect_same_as_alone<8>(ElementType::hexahedron);
}

TEST(Regularization, TheFastestSigmaOfTetrahedraIsThatOfTheThesis) {
  RegularizationSeries series{
      .transformation = "opposite-face-normals", .start = StartElements::valid, .n_elements = 4000};
  for (int i = 1; i <= 100; ++i) series.sigmas.push_back(0.02 * i);
  const auto counts = count_transformations(series);
  const auto least = std::min_element(counts.begin(), counts.end(),
                                      [](const auto& a, const auto& b) { return a.mean < b.mean; });
  EXPECT_NEAR(least->sigma, 0.78, 0.03);
  // Four standard deviations of a mean of 4,000 counts.
  EXPECT_NEAR(least->mean, 3.69, 0.005 + 4.0 * least->deviation / std::sqrt(4000.0));
}

TEST(Regularization, SharesOfValidElementsAreThoseOfTheThesis) {
  constexpr std::size_t n = 40000;
  for (const auto& [type, printed] : {std::pair(ElementType::tetrahedron, 0.5015),
                                      {ElementType::hexahedron, 0.0037},
                                      {ElementType::pyramid, 0.0936},
                                      {ElementType::prism, 0.0533}}) {
    const double share = static_cast<double>(count_valid_elements(type, n, 1)) / n;
    // Both are samples, the printed one of 100,000 elements. The tolerance is four standard
    // deviations of the difference.
    const double deviation = std::sqrt(printed * (1.0 - printed) * (1.0 / n + 1e-5));
    EXPECT_NEAR(share, printed, 4.0 * deviation) << name_of(type);
  }
}

TEST(Regularization, DoesNotDependOnThreads) {
  const RegularizationSeries series{
      .start = StartElements::valid, .n_elements = 1001, .sigmas = {0.3}};
  std::vector<double> means;
  for (const int threads : {1, 2, 3}) {
    set_n_threads(threads);
    means.push_back(count_transformations(series)[0].mean);
  }
  EXPECT_EQ(means[0], means[1]);
  EXPECT_EQ(means[0], means[2]);
}

TEST(Regularization, WithoutNormalsNothingGetsRegular) {
  const auto counts =
      count_transformations({.n_elements = 5, .sigmas = {0.0}, .max_transformations = 50});
  EXPECT_EQ(counts[0].n_regularized, 0u);
}

TEST(Regularization, RefusesUnknownTypesAndValuesOutOfRange) {
  EXPECT_THROW(count_transformations({.element_type = ElementType::triangle, .sigmas = {1.0}}),
               InputError);
  EXPECT_THROW(count_transformations({.element_type = ElementType::prism,
                                      .transformation = "opposite-face-normals",
                                      .sigmas = {1.0}}),
               InputError);
  EXPECT_THROW(count_transformations({.sigmas = {-1.0}}), InputError);
  EXPECT_THROW(count_transformations({.sigmas = {}}), InputError);
}

class RegularizationStudies : public FileTest {};

TEST_F(RegularizationStudies, ColumnsAreTheDocumentedOnes) {
  const auto study = read_regularization_study(
      file_with("tiny.prm", "set kind = regularization\nset elements = 8\nset sigmas = 3\n"));
  for (const auto& entry : regularization_tables(study)) {
    ASSERT_FALSE(documented_columns(entry.file).empty()) << entry.file;
    expect_documented(entry.file, entry.compute());
  }
}

}  // namespace
}  // namespace smoothfem
