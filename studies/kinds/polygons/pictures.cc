// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/polygons/pictures.h"

#include <algorithm>
#include <cmath>

#include "smoothing/polygons/isosceles_transformation.h"
#include "smoothing/polygons/triangle_transformations.h"
#include "studies/framework/results/csv_text.h"
#include "studies/kinds/polygons/random_polygons.h"

namespace smoothfem {

namespace {

/// Adds rows that begin with `keys` and end with a node's number and coordinates.
template <class Keys>
void add_nodes(CsvText& csv, const Polygon& polygon, const Keys& keys) {
  for (std::size_t m = 0; m < polygon.size(); ++m) {
    keys();
    csv.integer(m).number(polygon[m].real()).number(polygon[m].imag()).end_line();
  }
}

double angle(double part, std::size_t n) {
  return 0.5 * pi * part / static_cast<double>(n);
}

/// Returns base angles in the middle of each interval of Lemma 2.10, and its characteristic angles.
/// The first characteristic angle is left out, because its limit is that of an interval
/// next to it.
std::vector<double> pictured_angles(std::size_t n) {
  std::vector<double> angles;
  for (std::size_t k = 0; k <= n / 2; ++k) {
    const double from = k == 0 ? 0.0 : 2.0 * static_cast<double>(k) - 1.0;
    const double to = std::min(2.0 * static_cast<double>(k) + 1.0, static_cast<double>(n));
    angles.push_back(angle(0.5 * (from + to), n));
    if (k > 0 && k < n / 2) angles.push_back(angle(to, n));
  }
  return angles;
}

}  // namespace

std::string decomposition_csv(const PolygonStudy& study) {
  CsvText csv("n,eigenpolygon,vertices,multiplicity,density,direction,node,x,y");
  for (const std::size_t n : study.decomposition_nodes) {
    const Polygon polygon = picture_polygon(n, study.seed);
    add_nodes(csv, polygon, [&] {
      csv.integer(n);
      for (int i = 0; i < 5; ++i) csv.field("");
    });
    const auto coefficients = eigenpolygon_coefficients(polygon);
    for (std::size_t k = 0; k < n; ++k) {
      const StarPolygon star = star_polygon(n, k);
      add_nodes(csv, eigenpolygon(n, k, coefficients[k]), [&] {
        csv.integer(n).integer(k).integer(star.vertices).integer(star.multiplicity);
        csv.integer(star.density).field(std::to_string(star.direction));
      });
    }
  }
  return csv.text();
}

std::string domains_csv(const PolygonStudy& study) {
  CsvText csv("n,line,theta,lambda,domain,growth,convergence");
  const auto add = [&](std::size_t n, const std::string& line, double theta, double lambda) {
    const PolygonLimit limit = classify(lambda, theta, n);
    csv.integer(n).field(line).number(theta).number(lambda).field(domain_name(limit));
    csv.number(limit.growth).number(limit.convergence).end_line();
  };
  constexpr std::size_t finer = 8;  // for lines, compared with the grid
  const std::size_t points = study.domain_points;
  for (const std::size_t n : study.domain_nodes) {
    for (std::size_t i = 0; i < points; ++i)
      for (std::size_t j = 0; j < points; ++j)
        add(n, "", grid_point(i, points, 0.5 * pi), grid_point(j, points, 1.0));
    for (std::size_t sum = 1; sum < n; ++sum)
      for (std::size_t i = 0; i < finer * points; ++i) {
        const double theta = grid_point(i, finer * points, 0.5 * pi);
        const double lambda = intersection_line(n, sum, theta);
        if (lambda > 0.0 && lambda < 1.0) add(n, std::to_string(sum), theta, lambda);
      }
  }
  return csv.text();
}

std::string limits_csv(const PolygonStudy& study) {
  CsvText csv("n,theta,domain,shape,growth,steps,node,x,y");
  const std::size_t steps = 2 * ((study.steps + 1) / 2);  // even and odd steps differ by a turn
  for (const std::size_t n : study.limit_nodes) {
    const Polygon initial = picture_polygon(n, study.seed);
    add_nodes(csv, initial,
              [&] { csv.integer(n).number(0.0).field("").field("").field("").integer(0); });
    for (const double theta : pictured_angles(n)) {
      const PolygonLimit limit = classify_isosceles(theta, n);
      Polygon z = initial;
      for (std::size_t i = 0; i < steps; ++i)
        z = scaled_about(centroid(initial), isosceles_step(z, theta), 1.0 / limit.growth);
      add_nodes(csv, z, [&] {
        csv.integer(n).number(theta).field(domain_name(limit)).field(shape_name(limit.shape));
        csv.number(limit.growth).integer(steps);
      });
    }
  }
  return csv.text();
}

std::string sequences_csv(const PolygonStudy& study) {
  CsvText csv("transformation,n,theta,lambda,domain,step,node,x,y");
  const auto add = [&](const std::string& name, Polygon z, double theta, double lambda,
                       const PolygonLimit& limit, const std::vector<std::size_t>& shown,
                       const auto& step) {
    const Complex middle = centroid(z);
    const std::size_t last = *std::max_element(shown.begin(), shown.end());
    for (std::size_t i = 0; i <= last; ++i) {
      if (std::find(shown.begin(), shown.end(), i) != shown.end())
        add_nodes(csv, z, [&] {
          csv.field(name).integer(z.size()).number(theta).number(lambda);
          csv.field(domain_name(limit)).integer(i);
        });
      z = scaled_about(middle, step(z), 1.0 / limit.growth);
    }
  };
  const std::size_t n = study.limit_nodes.front();
  for (const double theta : pictured_angles(n))
    add("isosceles", picture_polygon(n, study.seed), theta, 0.5, classify_isosceles(theta, n),
        study.isosceles_steps, [&](const Polygon& z) { return isosceles_step(z, theta); });
  for (const SequenceParameters& p : study.sequences)
    add("combined", picture_polygon(study.sequence_nodes, study.seed), p.theta, p.lambda,
        classify(p.lambda, p.theta, study.sequence_nodes), study.combined_steps,
        [&](const Polygon& z) { return transformed(z, p.lambda, p.theta); });
  return csv.text();
}

std::string side_ratios_csv(const PolygonStudy& study) {
  CsvText csv("transformation,theta,step,defect,bound,growth");
  constexpr std::size_t n_steps = 30;
  const auto add = [&](const std::string& name, double theta, const auto& step, double factor,
                       const auto& defect_of) {
    Polygon triangle = picture_polygon(3, study.seed);
    if (signed_area(triangle) < 0.0) std::swap(triangle[1], triangle[2]);
    double first[2] = {0.0, 0.0};  // bounds apply to every second step
    for (std::size_t i = 0; i <= n_steps; ++i) {
      const double defect = defect_of(sides_of(triangle));
      if (i < 2) first[i] = defect;
      const Polygon next = step(triangle, theta);
      const double growth = radius(next) / radius(triangle);
      csv.field(name).number(theta).integer(i).number(defect);
      const std::size_t n_pairs = i / 2;
      csv.number(first[i % 2] * std::pow(factor, static_cast<double>(n_pairs))).number(growth);
      csv.end_line();
      triangle = scaled_about_centroid(next, 1.0 / growth);
    }
  };
  for (const double degrees : {10.0, 20.0, 30.0, 45.0, 60.0, 75.0}) {
    const double theta = degrees / 180.0 * pi;
    add("equilateral", theta, equilateral_step, equilateral_convergence_factor(theta),
        [](const TriangleSides& s) { return 1.0 - std::min(s.x, s.y) / std::max(s.x, s.y); });
    add("right-isosceles", theta, right_isosceles_step, right_isosceles_convergence_factor(theta),
        [](const TriangleSides& s) { return 1.0 - std::min(s.y, s.z) / std::max(s.y, s.z); });
  }
  return csv.text();
}

}  // namespace smoothfem
