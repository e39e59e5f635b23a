// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numbers>
#include <sstream>

#include "smoothing/polygons/limit_polygons.h"
#include "studies/framework/definition/study_file.h"
#include "studies/kinds/polygons/polygon_study.h"

namespace smoothfem {

namespace {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

Patterns::List node_numbers(int most) {
  return {Patterns::Integer(3, most), 1};
}

Patterns::List step_numbers() {
  return {Patterns::Integer(0, 1000000), 1};
}

void declare_keys(ParameterHandler& p) {
  declare_table_study(p, "polygons");
  p.declare_entry("seed", "1", Patterns::Integer(0), "Seed of the random polygons.");
  p.declare_entry("nodes", "3, 4, 5, 6, 7, 8, 9, 10, 11, 12", node_numbers(16),
                  "Numbers of nodes in the checks of theorems and in the classification, up to 16: "
                  "with more nodes, limits are reached more slowly.");
  p.declare_entry("cases", "40", Patterns::Integer(1),
                  "Random polygons of each theorem and number of nodes.");
  p.declare_entry("steps", "4000", Patterns::Integer(1),
                  "Steps after which the limits of theorems count as reached.");
  p.declare_entry("theta points", "60", Patterns::Integer(1),
                  "Points of the classification's grid over (0, pi/2).");
  p.declare_entry("lambda points", "60", Patterns::Integer(1), "Points of this grid over (0, 1).");
  p.declare_entry("domain points", "150", Patterns::Integer(2),
                  "Points in both directions of the grid of Fig. 2.11.");
  p.declare_entry("doublings", "26", Patterns::Integer(1, 40),
                  "The classification iterates polygons 2^k times.");
  p.declare_entry("decomposition nodes", "5, 6", node_numbers(99), "Polygons of Fig. 2.10.");
  p.declare_entry("domain nodes", "5, 6", node_numbers(99), "Polygons of Fig. 2.11.");
  p.declare_entry("limit nodes", "10, 11", node_numbers(99),
                  "Polygons of Fig. 2.3; the first one is also in Fig. 2.5.");
  p.declare_entry("isosceles steps", "0, 1, 2, 3, 5, 10, 20, 100", step_numbers(),
                  "Steps that Fig. 2.5 shows.");
  p.declare_entry("combined steps", "0, 1, 2, 3, 5, 100", step_numbers(),
                  "Steps that Fig. 2.12 shows.");
  p.declare_entry("sequence nodes", "6", Patterns::Integer(3, 99),
                  "Nodes of the polygon of Fig. 2.12.");
  p.declare_entry("sequences",
                  "1/16: 0.75, 1/16: S0, 1/6: 0.6, 1/16: S1, 1/3: 0.4, 7/16: S2, 7/16: 0.25",
                  Patterns::Anything(),
                  "Parameters of Fig. 2.12: theta / pi as a fraction, then lambda, or Sk for the "
                  "line where eigenvalues k and k + 1 are equal.");
}

const std::vector<std::string> scaled_numbers{"cases", "theta points", "lambda points",
                                              "domain points"};

std::vector<std::size_t> numbers(const std::string& list) {
  std::vector<std::size_t> values;
  for (const auto& item : split_list(list)) values.push_back(std::stoul(item));
  return values;
}

std::size_t count(ParameterHandler& p, const std::string& key) {
  return static_cast<std::size_t>(p.get_integer(key));
}

/// Reads "1/16: 0.75" or "1/16: S0".
SequenceParameters sequence(const std::string& text, std::size_t n) {
  double above = 0.0, below = 0.0, lambda = 0.0;
  char bar = ' ', colon = ' ';
  std::istringstream words(text);
  words >> above >> bar >> below >> colon >> std::ws;
  const double theta = std::numbers::pi * above / below;
  bool whole = words && bar == '/' && colon == ':';
  if (whole && words.peek() == 'S') {
    std::size_t k = 0;
    words.get();
    words >> k;
    whole = words && k < n / 2;
    if (whole) lambda = intersection_line(n, 2 * k + 1, theta);
  } else {
    words >> lambda;
    whole = whole && words;
  }
  if (!whole || !(words >> std::ws).eof())
    throw InputError("the sequence '" + text +
                     "' cannot be read; write theta / pi as a fraction, a colon, and lambda or S0 "
                     "to S" +
                     std::to_string(n / 2 - 1) + ", as in '1/16: S0'");
  try {
    (void)classify(lambda, theta, n);
  } catch (const InputError& error) {
    throw InputError("the sequence '" + text + "' is out of range: " + error.what());
  }
  return {theta, lambda};
}

}  // namespace

PolygonStudy read_polygon_study(const std::filesystem::path& file, const std::string& scale) {
  ParameterHandler p;
  declare_keys(p);
  PolygonStudy study;
  study.header = read_table_study(p, file, scale, scaled_numbers);
  study.seed = static_cast<std::uint64_t>(p.get_integer("seed"));
  study.nodes = numbers(p.get("nodes"));
  study.steps = count(p, "steps");
  study.doublings = static_cast<int>(p.get_integer("doublings"));
  study.decomposition_nodes = numbers(p.get("decomposition nodes"));
  study.domain_nodes = numbers(p.get("domain nodes"));
  study.limit_nodes = numbers(p.get("limit nodes"));
  study.isosceles_steps = numbers(p.get("isosceles steps"));
  study.combined_steps = numbers(p.get("combined steps"));
  study.sequence_nodes = count(p, "sequence nodes");
  for (const auto& item : split_list(p.get("sequences")))
    study.sequences.push_back(in_file(file, [&] { return sequence(item, study.sequence_nodes); }));
  study.cases = count(p, "cases");
  study.theta_points = count(p, "theta points");
  study.lambda_points = count(p, "lambda points");
  study.domain_points = count(p, "domain points");
  return study;
}

std::string polygon_study_template() {
  ParameterHandler p;
  declare_keys(p);
  declare_table_scale(p, "NAME", scaled_numbers);
  return commented_keys(p);
}

}  // namespace smoothfem
