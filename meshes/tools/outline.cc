// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "smoothing/base/input_error.h"

namespace smoothfem {

Point<2> on_circle(const Point<2>& centre, double radius, double angle) {
  return centre + radius * Point<2>(std::cos(angle), std::sin(angle));
}

Curve segment(const Point<2>& from, const Point<2>& to) {
  return {(to - from).norm(), [=](double t) -> Point<2> { return (1.0 - t) * from + t * to; }};
}

Curve arc(const Point<2>& centre, double radius, double from, double to) {
  return {radius * std::abs(to - from),
          [=](double t) { return on_circle(centre, radius, (1.0 - t) * from + t * to); }};
}

Curve polyline(std::vector<Point<2>> points) {
  std::vector<double> lengths{0.0};
  for (std::size_t i = 1; i < points.size(); ++i)
    lengths.push_back(lengths.back() + (points[i] - points[i - 1]).norm());
  const double total = lengths.back();
  return {total, [points = std::move(points), lengths = std::move(lengths)](double t) -> Point<2> {
            const double wanted = t * lengths.back();
            const auto next = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, wanted);
            const auto i = static_cast<std::size_t>(next - lengths.begin());
            const double fraction = (wanted - lengths[i - 1]) / (lengths[i] - lengths[i - 1]);
            return (1.0 - fraction) * points[i - 1] + fraction * points[i];
          }};
}

Outline closed(const std::vector<Point<2>>& corners) {
  Outline outline;
  for (std::size_t i = 0; i < corners.size(); ++i)
    outline.push_back(segment(corners[i], corners[(i + 1) % corners.size()]));
  return outline;
}

Outline circle(const Point<2>& centre, double radius) {
  return {arc(centre, radius, 0.0, 2.0 * std::numbers::pi)};
}

namespace {

/// Gives each further portion to the curve with the longest edges. Equal lengths differ by rounding
/// only; then the first curve wins, on every machine.
std::vector<std::size_t> portions(const std::vector<double>& lengths, std::size_t n_portions) {
  std::vector<std::size_t> counts(lengths.size(), 1);
  constexpr double clearly = 1.0 + 1e-9;
  for (std::size_t given = counts.size(); given < n_portions; ++given) {
    std::size_t longest = 0;
    for (std::size_t c = 1; c < counts.size(); ++c)
      if (lengths[c] / static_cast<double>(counts[c]) >
          clearly * lengths[longest] / static_cast<double>(counts[longest]))
        longest = c;
    ++counts[longest];
  }
  return counts;
}

}  // namespace

Polygons divide(const std::vector<Outline>& outlines, std::size_t n_edges, std::size_t multiple_of,
                double at) {
  std::vector<double> lengths;
  for (const auto& outline : outlines)
    for (const auto& curve : outline) lengths.push_back(curve.length);
  const std::size_t n_least = multiple_of * lengths.size();
  if (n_edges % multiple_of != 0 || n_edges < n_least) {
    const std::string message = "the boundary consists of " + std::to_string(lengths.size()) +
                                " curves and cannot have " + std::to_string(n_edges) +
                                " edges; give a multiple of " + std::to_string(multiple_of) +
                                " from " + std::to_string(n_least) + " on";
    if (n_edges < n_least) throw TooFewEdges(message, n_edges, n_least, multiple_of);
    throw InputError(message);
  }
  const std::vector<std::size_t> counts = portions(lengths, n_edges / multiple_of);
  Polygons polygons;
  std::size_t index = 0;
  for (const auto& outline : outlines) {
    std::vector<Point<2>> polygon;
    for (const auto& curve : outline) {
      const std::size_t n = multiple_of * counts[index++];
      for (std::size_t i = 0; i < n; ++i)
        polygon.push_back(curve.point((static_cast<double>(i) + at) / static_cast<double>(n)));
    }
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

double area(const Polygons& polygons) {
  double total = 0.0;
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    double twice = 0.0;
    for (std::size_t i = 0; i < polygons[p].size(); ++i) {
      const auto &a = polygons[p][i], &b = polygons[p][(i + 1) % polygons[p].size()];
      twice += a.x() * b.y() - a.y() * b.x();
    }
    total += (p == 0 ? 0.5 : -0.5) * twice;
  }
  return total;
}

}  // namespace smoothfem
