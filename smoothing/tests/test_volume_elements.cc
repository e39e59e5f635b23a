// SPDX-License-Identifier: GPL-3.0-or-later
/// Tests quality and transformations of volume elements against second formulas: the printed tables
/// of the thesis, dense matrices and printed numbers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <map>
#include <set>

#include "smoothing/getme/regularize.h"
#include "smoothing/quality/hexahedron_mapping.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using SpacePoints = std::vector<Point<3>>;

/// The tables N, F and F with a bar of Sections 3.1 and 3.3, as printed (from 1).
struct PrintedElement {
  std::vector<std::array<int, 4>> simplices;
  std::vector<std::vector<int>> faces, dual_faces;
};

const std::map<std::size_t, PrintedElement>& printed() {
  static const std::map<std::size_t, PrintedElement> tables{
      {4,
       {{{1, 2, 3, 4}},
        {{1, 2, 3}, {1, 2, 4}, {2, 3, 4}, {3, 1, 4}},
        {{1, 2, 4}, {1, 3, 2}, {1, 4, 3}, {2, 3, 4}}}},
      {8,
       {{{1, 4, 5, 2},
         {2, 1, 6, 3},
         {3, 2, 7, 4},
         {4, 3, 8, 1},
         {5, 8, 6, 1},
         {6, 5, 7, 2},
         {7, 6, 8, 3},
         {8, 7, 5, 4}},
        {{1, 2, 3, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}, {5, 8, 7, 6}},
        {{1, 2, 5}, {1, 3, 2}, {1, 4, 3}, {1, 5, 4}, {6, 5, 2}, {6, 2, 3}, {6, 3, 4}, {6, 4, 5}}}},
      {5,
       {{{1, 2, 4, 5}, {2, 3, 1, 5}, {3, 4, 2, 5}, {4, 1, 3, 5}},
        {{1, 2, 3, 4}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {4, 1, 5}},
        {{1, 2, 5}, {1, 3, 2}, {1, 4, 3}, {1, 5, 4}, {2, 3, 4, 5}}}},
      {6,
       {{{1, 2, 3, 4}, {2, 3, 1, 5}, {3, 1, 2, 6}, {4, 6, 5, 1}, {5, 4, 6, 2}, {6, 5, 4, 3}},
        {{1, 2, 3}, {1, 2, 5, 4}, {2, 3, 6, 5}, {3, 1, 4, 6}, {4, 6, 5}},
        {{1, 2, 4}, {1, 3, 2}, {1, 4, 3}, {5, 4, 2}, {5, 2, 3}, {5, 3, 4}}}}};
  return tables;
}

/// Regular elements with edges of length one.
SpacePoints regular_element(std::size_t n) {
  const double s3 = std::sqrt(3.0);
  if (n == 4) return {{0, 0, 0}, {1, 0, 0}, {0.5, s3 / 2, 0}, {0.5, s3 / 6, std::sqrt(2.0 / 3.0)}};
  if (n == 5) return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, std::sqrt(0.5)}};
  if (n == 6)
    return {{0, 0, 0}, {1, 0, 0}, {0.5, s3 / 2, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, s3 / 2, 1}};
  return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
}

SpacePoints random_element(std::size_t n, test::Random& random) {
  SpacePoints x(n);
  for (auto& p : x)
    for (int d = 0; d < 3; ++d) p[d] = random();
  return x;
}

/// Calls act with the points as a span of fixed extent. Returns the points that it writes to a
/// second span.
template <class Act>
SpacePoints with_span(const SpacePoints& in, const Act& act) {
  SpacePoints out(in.size());
  const auto run = [&]<std::size_t n>() {
    std::array<Vector3<double>, n> x, y;
    for (std::size_t k = 0; k < n; ++k) x[k] = y[k] = vector_of(in[k]);
    act(std::span<const Vector3<double>, n>(x), std::span<Vector3<double>, n>(y));
    for (std::size_t k = 0; k < n; ++k) out[k] = point_of(y[k]);
  };
  if (in.size() == 4) run.template operator()<4>();
  if (in.size() == 5) run.template operator()<5>();
  if (in.size() == 6) run.template operator()<6>();
  if (in.size() == 8) run.template operator()<8>();
  return out;
}

double quality(const SpacePoints& x) {
  double q = -1.0;
  with_span(x, [&](auto in, auto) { q = mean_ratio(in); });
  return q;
}
SpacePoints dual(const SpacePoints& x, double sigma) {
  return with_span(x, [&](auto in, auto out) { DualElement::apply(sigma, in, out); });
}
SpacePoints opposite(const SpacePoints& x, double sigma) {
  std::array<Vector3<double>, 4> in, out;
  for (std::size_t k = 0; k < 4; ++k) in[k] = vector_of(x[k]);
  OppositeFaceNormals::apply(sigma, std::span<const Vector3<double>, 4>(in),
                             std::span<Vector3<double>, 4>(out));
  return {point_of(out[0]), point_of(out[1]), point_of(out[2]), point_of(out[3])};
}
Point<3> mean(const SpacePoints& x) {
  Point<3> sum = Point<3>::Zero();
  for (const auto& p : x) sum += p;
  return sum / static_cast<double>(x.size());
}

/// Definition 3.2 with matrices; W from the regular element.
double mean_ratio_by_matrices(const SpacePoints& x) {
  const auto& simplices = printed().at(x.size()).simplices;
  const SpacePoints regular = regular_element(x.size());
  const auto edges = [](const SpacePoints& p, const std::array<int, 4>& s) {
    Eigen::Matrix3d d;
    for (int i = 0; i < 3; ++i) d.col(i) = p[s[i + 1] - 1] - p[s[0] - 1];
    return d;
  };
  double sum = 0.0;
  for (const auto& simplex : simplices) {
    const Eigen::Matrix3d s = edges(x, simplex) * edges(regular, simplex).inverse();
    if (!(s.determinant() > 0.0)) return 0.0;
    sum += 3.0 * std::pow(s.determinant(), 2.0 / 3.0) / (s.transpose() * s).trace();
  }
  return sum / static_cast<double>(simplices.size());
}

/// Definition 3.4, with the printed tables.
SpacePoints dual_by_definition(const SpacePoints& x, double sigma, bool with_normals = true) {
  const PrintedElement& element = printed().at(x.size());
  SpacePoints d;
  for (const auto& face : element.faces) {
    SpacePoints nodes;
    for (const int k : face) nodes.push_back(x[k - 1]);
    d.push_back(mean(nodes));
  }
  SpacePoints result;
  for (const auto& face : element.dual_faces) {
    const auto at = [&](int i) { return d[face[i] - 1]; };
    const bool quad = face.size() == 4;
    const Point<3> normal = quad ? Point<3>(0.5 * (at(2) - at(0)).cross(at(3) - at(1)))
                                 : Point<3>((at(1) - at(0)).cross(at(2) - at(0)));
    double tau = 2.0 / 3.0;  // the centroid
    if (x.size() == 5) tau = 0.5 + sigma;
    if (x.size() == 6) tau = 0.8 * (1.0 - std::sqrt(2.0) * sigma / std::pow(39.0, 0.25));
    const Point<3> base = quad ? Point<3>((at(0) + at(1) + at(2) + at(3)) / 4.0)
                               : Point<3>((1.0 - tau) * at(0) + tau * 0.5 * (at(1) + at(2)));
    result.push_back(with_normals ? base + sigma / std::sqrt(normal.norm()) * normal : base);
  }
  return result;
}

double largest_distance(const SpacePoints& a, const SpacePoints& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, (a[k] - b[k]).norm());
  return largest;
}

class VolumeElements : public testing::TestWithParam<std::size_t> {};

TEST_P(VolumeElements, TablesAreThePrintedOnes) {
  const std::size_t n = GetParam();
  const VolumeElementTables& tables = volume_element(n);
  const PrintedElement& text = printed().at(n);
  ASSERT_EQ(tables.corners.size(), text.simplices.size());
  for (std::size_t k = 0; k < tables.corners.size(); ++k)
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(tables.corners[k][i] + 1, text.simplices[k][i]) << k;
  ASSERT_EQ(tables.faces.size(), text.faces.size());
  for (std::size_t f = 0; f < tables.faces.size(); ++f) {
    std::vector<int> nodes;
    for (const LocalIndex k : tables.faces[f].indices()) nodes.push_back(k + 1);
    EXPECT_THAT(nodes, testing::UnorderedElementsAreArray(text.faces[f]));
  }
}

TEST_P(VolumeElements, FacesOfTheRegularElementPointOutwards) {
  const SpacePoints x = regular_element(GetParam());
  for (const LocalFace& face : volume_element(GetParam()).faces) {
    const auto& k = face.nodes;
    const Point<3> normal = (x[k[1]] - x[k[0]]).cross(x[k[2]] - x[k[0]]);
    EXPECT_GT(normal.dot(x[k[0]] - mean(x)), 0.0);
  }
}

TEST_P(VolumeElements, EdgesOfTheRegularElementHaveLengthOne) {
  const SpacePoints x = regular_element(GetParam());
  std::set<std::pair<int, int>> seen;
  for (const auto& [a, b] : volume_element(GetParam()).edges) {
    EXPECT_NEAR((x[a] - x[b]).norm(), 1.0, 1e-15);
    EXPECT_TRUE(seen.insert(std::minmax<int>(a, b)).second);
  }
}

TEST_P(VolumeElements, MeanRatioIsThatOfTheMatrices) {
  test::Random random(GetParam());
  EXPECT_NEAR(quality(regular_element(GetParam())), 1.0, 4e-16);
  int n_valid = 0;
  for (int i = 0; i < 20000; ++i) {
    SpacePoints x = regular_element(GetParam());
    const SpacePoints shift = random_element(GetParam(), random);
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += 0.6 * shift[k];
    const double expected = mean_ratio_by_matrices(x);
    n_valid += expected > 0.0 ? 1 : 0;
    ASSERT_NEAR(quality(x), expected, 1e-13);
  }
  EXPECT_GT(n_valid, 100);
}

TEST_P(VolumeElements, SharesOfValidRandomElementsAreThePrintedOnes) {
  const std::map<std::size_t, double> percent{{4, 50.15}, {8, 0.37}, {5, 9.36}, {6, 5.33}};
  constexpr int n = 200000;
  test::Random random(7);
  int n_valid = 0;
  for (int i = 0; i < n; ++i) n_valid += quality(random_element(GetParam(), random)) > 0.0 ? 1 : 0;
  const double expected = percent.at(GetParam()) / 100.0;
  const double deviation = std::sqrt(expected * (1.0 - expected) * (1.0 / n + 1.0 / 100000.0));
  EXPECT_NEAR(static_cast<double>(n_valid) / n, expected, 4.0 * deviation + 5e-5);
}

TEST_P(VolumeElements, DualElementIsThatOfTheDefinition) {
  test::Random random(3 * GetParam());
  for (int i = 0; i < 500; ++i) {
    const SpacePoints x = random_element(GetParam(), random);
    for (const double sigma : {0.1, 0.7, 1.5, 17.0})
      ASSERT_LT(largest_distance(dual(x, sigma), dual_by_definition(x, sigma)),
                1e-13 * (1.0 + sigma));
  }
}

TEST_P(VolumeElements, RegularElementsStayRegular) {
  const SpacePoints x = regular_element(GetParam());
  const auto expect_regular = [&](const SpacePoints& y) {
    const auto& edges = volume_element(GetParam()).edges;
    const double first = (y[edges[0][0]] - y[edges[0][1]]).norm();
    for (const auto& [a, b] : edges)
      EXPECT_NEAR((y[a] - y[b]).norm() / first, 1.0, 2e-15) << int{a} << ' ' << int{b};
    EXPECT_NEAR(quality(y), 1.0, 2e-15);
  };
  for (const double sigma : {0.01, 0.5, 0.78, 1.0, 1.5, 2.0}) {
    expect_regular(dual(x, sigma));
    if (GetParam() == 4) expect_regular(opposite(x, sigma));
  }
}

/// Lemma 3.1.
TEST_P(VolumeElements, TransformationsCommuteWithSimilarities) {
  test::Random random(11);
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(1.1, Point<3>(1, 2, -1).normalized()).toRotationMatrix();
  const Point<3> shift(3.0, -1.0, 2.0);
  for (const double scale : {1e-9, 0.3, 1e9}) {
    const auto similar = [&](SpacePoints x) {
      for (auto& p : x) p = scale * (turned * p + shift);
      return x;
    };
    for (int i = 0; i < 50; ++i) {
      const SpacePoints x = random_element(GetParam(), random);
      EXPECT_LT(largest_distance(dual(similar(x), 1.3), similar(dual(x, 1.3))), 1e-14 * 20 * scale);
      if (GetParam() == 4) {
        EXPECT_LT(largest_distance(opposite(similar(x), 1.3), similar(opposite(x, 1.3))),
                  1e-14 * 20 * scale);
      }
    }
  }
}

/// Lemma 3.2: the base points keep the centroid, except for pyramids; the whole transformation
/// keeps that of hexahedra.
TEST_P(VolumeElements, CentroidsAreAsInTheLemma) {
  test::Random random(13);
  double base_moves = 0.0, all_moves = 0.0;
  for (int i = 0; i < 50; ++i) {
    const SpacePoints x = random_element(GetParam(), random);
    base_moves = std::max(base_moves, (mean(dual_by_definition(x, 1.2, false)) - mean(x)).norm());
    all_moves = std::max(all_moves, (mean(dual(x, 1.2)) - mean(x)).norm());
  }
  EXPECT_EQ(base_moves < 1e-14, GetParam() != 5) << base_moves;
  EXPECT_EQ(all_moves < 1e-14, GetParam() == 8) << all_moves;
}

ElementParameters<3> regularization(double sigma) {
  return {.tetrahedron = {sigma, sigma},
          .pyramid = {sigma, sigma},
          .prism = {sigma, sigma},
          .hexahedron = {sigma, sigma},
          .rho = 1.0};
}
SpacePoints regularized(const ElementParameters<3>& parameters, const SpacePoints& x) {
  const ElementRegularization<3> element(parameters);
  return with_span(x, [&](auto in, auto out) { element.regularize(in, out); });
}

TEST_P(VolumeElements, AreRegularizedFromValidAndInvalidStarts) {
  for (const int transformation : {0, 1}) {
    if (transformation == 0 && GetParam() != 4) continue;
    for (const double sigma : {0.3, 1.0, 2.0}) {
      auto element = regularization(sigma);
      element.tetrahedron_transformation = transformation;
      test::Random random(17);
      for (int start = 0; start < 200; ++start) {
        SpacePoints x = random_element(GetParam(), random);
        int n = 0;
        for (; n < 1000 && quality(x) < 1.0 - 1e-6; ++n) x = regularized(element, x);
        ASSERT_LT(n, 1000) << sigma << ' ' << start;
      }
    }
  }
}

TEST_P(VolumeElements, KeepTheScaledQuantityAndRelax) {
  test::Random random(19);
  for (int i = 0; i < 100; ++i) {
    SpacePoints x = regular_element(GetParam());
    const SpacePoints noise = random_element(GetParam(), random);
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += 0.2 * noise[k];
    if (!(quality(x) > 0.0)) continue;
    const auto edge_sum = [&](const SpacePoints& y) {
      double sum = 0.0;
      for (const auto& [a, b] : volume_element(GetParam()).edges) sum += (y[a] - y[b]).norm();
      return sum;
    };
    const auto volume_sum = [&](const SpacePoints& y) {
      double sum = 0.0;
      for (const auto& s : printed().at(GetParam()).simplices)
        sum += (y[s[1] - 1] - y[s[0] - 1])
                   .cross(y[s[2] - 1] - y[s[0] - 1])
                   .dot(y[s[3] - 1] - y[s[0] - 1]);
      return sum;
    };
    auto element = regularization(0.9);
    const SpacePoints full = regularized(element, x);
    EXPECT_LT((mean(full) - mean(x)).norm(), 1e-15);
    EXPECT_NEAR(edge_sum(full), edge_sum(x), 1e-14 * edge_sum(x));
    element.scaling = ElementParameters<3>::mean_volume;
    const SpacePoints same_volume = regularized(element, x);
    EXPECT_LT((mean(same_volume) - mean(x)).norm(), 1e-15);
    EXPECT_NEAR(volume_sum(same_volume), volume_sum(x), 1e-13 * volume_sum(x));
    element.scaling = ElementParameters<3>::mean_edge_length;
    element.rho = 0.1;
    const SpacePoints tenth = regularized(element, x);
    for (std::size_t k = 0; k < x.size(); ++k)
      EXPECT_LT((10.0 * (tenth[k] - x[k]) - (full[k] - x[k])).norm(), 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Types, VolumeElements, testing::Values(4, 5, 6, 8));

/// Section 3.2: on average 3.69 transformations with sigma = 0.78 make a random valid tetrahedron
/// regular (4.11 if invalid ones count, too).
TEST(OppositeFaceNormals, NeedThePrintedNumberOfTransformations) {
  test::Random random(23);
  int n_starts = 0;
  double sum = 0.0;
  for (int start = 0; start < 100000; ++start) {
    SpacePoints x = random_element(4, random);
    if (!(quality(x) > 0.0)) continue;
    ++n_starts;
    for (; quality(x) < 1.0 - 1e-6; ++sum) x = opposite(x, 0.78);
  }
  EXPECT_NEAR(sum / n_starts, 3.69, 0.01);
}

/// Section 3.2: the tetrahedron that no sigma makes regular at once.
TEST(OppositeFaceNormals, TransformThePrintedCounterexample) {
  const SpacePoints x{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  for (const double sigma : {0.1, 0.78, 1.0, std::sqrt(2.0) + std::sqrt(3.0),
                             0.5 * (std::sqrt(2.0) + std::sqrt(6.0)), 5.0}) {
    const SpacePoints y = opposite(x, sigma);
    const SpacePoints expected{-sigma / std::sqrt(7.0) * Point<3>(6, 3, 2),
                               {1 + std::sqrt(6.0) * sigma, 0, 0},
                               {0, 2 + std::sqrt(3.0) * sigma, 0},
                               {0, 0, 3 + std::sqrt(2.0) * sigma}};
    EXPECT_LT(largest_distance(y, expected), 1e-14 * (1.0 + sigma));
    EXPECT_LT(quality(y), 1.0 - 1e-4) << sigma;
  }
}

TEST(OppositeFaceNormals, DoNotMoveNodesOppositeToFacesWithoutArea) {
  const SpacePoints x{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  for (const auto& p : opposite(x, 1.0)) EXPECT_TRUE(p.allFinite());
  EXPECT_EQ(opposite(x, 1.0)[3], x[3]);
}

TEST(InverseRoot, AgreesWithTheMathematicalLibrary) {
  test::Random random(29);
  for (int i = 0; i < 200000; ++i) {
    const double x = std::exp(690.0 * random());
    const auto expect_close = [&](double root, double p) {
      EXPECT_NEAR(root * static_cast<double>(std::pow(static_cast<long double>(x), 1.0L / p)), 1.0,
                  5e-16)
          << x;
    };
    expect_close(inverse_root<2>(x), 2.0);
    expect_close(inverse_root<3>(x), 3.0);
    expect_close(inverse_root<4>(x), 4.0);
    const Lanes lanes = inverse_root<3>(Lanes{x, 1.0, 2.0 * x, 0.5 * x});
    EXPECT_EQ(lanes[0], inverse_root<3>(x));
    EXPECT_EQ(lanes[2], inverse_root<3>(2.0 * x));
  }
}

/// Compares lanes with single cells, bit for bit.
TEST(VolumeLanes, AreTheSameAsSingleCells) {
  test::Random random(31);
  const auto check = [&]<std::size_t n>() {
    std::array<Vector3<Lanes>, n> lanes, result;
    std::array<SpacePoints, n_lanes> cells;
    for (std::size_t l = 0; l < n_lanes; ++l) {
      cells[l] = regular_element(n);
      const SpacePoints noise = random_element(n, random);
      for (std::size_t k = 0; k < n; ++k) {
        cells[l][k] += 0.25 * noise[k];
        lanes[k].x[l] = cells[l][k].x();
        lanes[k].y[l] = cells[l][k].y();
        lanes[k].z[l] = cells[l][k].z();
      }
    }
    const auto parameters = regularization(1.1);
    const ElementRegularization<3> element(parameters);
    const Lanes q = element.regularize(std::span<const Vector3<Lanes>, n>(lanes),
                                       std::span<Vector3<Lanes>, n>(result));
    for (std::size_t l = 0; l < n_lanes; ++l) {
      EXPECT_EQ(q[l], quality(cells[l])) << n;
      const SpacePoints single = regularized(parameters, cells[l]);
      for (std::size_t k = 0; k < n; ++k)
        EXPECT_EQ(single[k], Point<3>(result[k].x[l], result[k].y[l], result[k].z[l])) << n;
    }
  };
  for (int i = 0; i < 20; ++i) {
    check.operator()<4>();
    check.operator()<5>();
    check.operator()<6>();
    check.operator()<8>();
  }
}

const std::array<Point<3>, 8> unit_cube{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

TEST(HexahedronMapping, IsPositiveForACubeAndNotForItsMirrorImage) {
  EXPECT_TRUE(has_positive_mapping(unit_cube));
  auto mirrored = unit_cube;
  for (auto& p : mirrored) p.x() = -p.x();
  EXPECT_FALSE(has_positive_mapping(mirrored));
}

/// The trilinear mapping as a product of linear factors, differentiated by differences (exact for
/// linear functions of each coordinate).
double jacobian_at(const std::array<Point<3>, 8>& corners, const Point<3>& at) {
  const auto map = [&](const Point<3>& xi) {
    Point<3> sum = Point<3>::Zero();
    for (int v = 0; v < 8; ++v) {
      double weight = 1.0;
      for (int d = 0; d < 3; ++d) weight *= unit_cube[v][d] > 0.5 ? xi[d] : 1.0 - xi[d];
      sum += weight * corners[v];
    }
    return sum;
  };
  Eigen::Matrix3d jacobian;
  for (int d = 0; d < 3; ++d) jacobian.col(d) = map(at + Point<3>::Unit(d)) - map(at);
  return jacobian.determinant();
}

TEST(HexahedronMapping, PositiveMeansPositiveAtEveryPoint) {
  test::Random random(5);
  int n_positive = 0, n_folded_inside = 0;
  for (int i = 0; i < 600; ++i) {
    auto corners = unit_cube;
    for (auto& p : corners)
      for (int d = 0; d < 3; ++d) p[d] += 0.6 * random();
    double smallest = 1.0, smallest_at_corners = 1.0;
    constexpr int n = 6;
    for (int a = 0; a <= n; ++a)
      for (int b = 0; b <= n; ++b)
        for (int c = 0; c <= n; ++c) {
          const double value = jacobian_at(corners, Point<3>(a, b, c) / n);
          smallest = std::min(smallest, value);
          if (a % n == 0 && b % n == 0 && c % n == 0)
            smallest_at_corners = std::min(smallest_at_corners, value);
        }
    if (has_positive_mapping(corners)) {
      ++n_positive;
      EXPECT_GT(smallest, 0.0);
    }
    n_folded_inside += smallest_at_corners > 0.0 && smallest <= 0.0;
  }
  EXPECT_GT(n_positive, 50);
  EXPECT_GT(n_folded_inside, 0);  // the case that this test is for
}

}  // namespace
}  // namespace smoothfem
