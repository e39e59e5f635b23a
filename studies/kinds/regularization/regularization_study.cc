// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/regularization/regularization_study.h"

#include "studies/framework/definition/study_file.h"
#include "studies/framework/results/csv_text.h"
#include "studies/kinds/study_kinds.h"

namespace smoothfem {

namespace {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

/// An element type and its transformation. Fig. 3.4 shows the first, Fig. 3.8 the others.
struct Subject {
  ElementType element_type;
  const char* transformation;
};
constexpr Subject subjects[] = {{ElementType::tetrahedron, "opposite-face-normals"},
                                {ElementType::tetrahedron, "dual-element"},
                                {ElementType::hexahedron, "dual-element"},
                                {ElementType::pyramid, "dual-element"},
                                {ElementType::prism, "dual-element"}};

const char* name_of(StartElements start) {
  return start == StartElements::valid ? "valid" : "arbitrary";
}

void declare_keys(ParameterHandler& p) {
  declare_table_study(p, "regularization");
  p.declare_entry("seed", "1", Patterns::Integer(0), "Seed of the random elements.");
  p.declare_entry("elements", "100000", Patterns::Integer(1), "Random elements of each type.");
  p.declare_entry("largest sigma", "2", Patterns::Double(1e-3),
                  "Scaling factors of the normals are equally spaced from 0 to this one.");
  p.declare_entry("sigmas", "101", Patterns::Integer(2),
                  "Number of these factors, both ends included.");
  p.declare_entry("tolerance", "1e-6", Patterns::Double(1e-12, 0.5),
                  "Elements are regular if their mean ratio is at least 1 - tolerance.");
  p.declare_entry("most transformations", "1000", Patterns::Integer(1, 1000000),
                  "Of one element; an element that needs more counts as not regularized.");
}

const std::vector<std::string> scaled_numbers{"elements"};

std::vector<double> equal_distances(double largest, std::size_t n) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i)
    values.push_back(largest * static_cast<double>(i) / static_cast<double>(n - 1));
  return values;
}

std::string regularization_csv(const RegularizationStudy& study) {
  CsvText csv(
      "element,transformation,start,sigma,n_elements,n_regularized,mean,deviation,least,most");
  for (const auto& series : study.series)
    for (const auto& counts : count_transformations(series)) {
      csv.field(std::string(name_of(series.element_type))).field(series.transformation);
      csv.field(name_of(series.start)).number(counts.sigma);
      csv.integer(series.n_elements).integer(counts.n_regularized);
      if (counts.n_regularized > 0)
        csv.number(counts.mean)
            .number(counts.deviation)
            .field(std::to_string(counts.least))
            .field(std::to_string(counts.most));
      else
        csv.field("").field("").field("").field("");
      csv.end_line();
    }
  return csv.text();
}

std::string validity_csv(const RegularizationStudy& study) {
  CsvText csv("element,n_elements,n_valid,share");
  for (const auto& series : study.series) {
    if (series.start != StartElements::arbitrary || series.transformation != "dual-element")
      continue;
    const std::size_t n_valid =
        count_valid_elements(series.element_type, series.n_elements, series.seed);
    csv.field(std::string(name_of(series.element_type))).integer(series.n_elements);
    csv.integer(n_valid);
    csv.number(static_cast<double>(n_valid) / static_cast<double>(series.n_elements)).end_line();
  }
  return csv.text();
}

}  // namespace

RegularizationStudy read_regularization_study(const std::filesystem::path& file,
                                              const std::string& scale) {
  ParameterHandler p;
  declare_keys(p);
  RegularizationStudy study;
  study.header = read_table_study(p, file, scale, scaled_numbers);
  const auto n_elements = static_cast<std::size_t>(p.get_integer("elements"));
  for (const Subject& subject : subjects)
    for (const auto start : {StartElements::arbitrary, StartElements::valid})
      study.series.push_back(
          {.element_type = subject.element_type,
           .transformation = subject.transformation,
           .start = start,
           .n_elements = n_elements,
           .sigmas = equal_distances(p.get_double("largest sigma"),
                                     static_cast<std::size_t>(p.get_integer("sigmas"))),
           .tolerance = p.get_double("tolerance"),
           .max_transformations = static_cast<int>(p.get_integer("most transformations")),
           .seed = static_cast<std::uint64_t>(p.get_integer("seed"))});
  return study;
}

std::string regularization_study_template() {
  ParameterHandler p;
  declare_keys(p);
  declare_table_scale(p, "NAME", scaled_numbers);
  return commented_keys(p);
}

std::vector<StudyTable> regularization_tables(const RegularizationStudy& study) {
  return {{"regularization.csv", [study] { return regularization_csv(study); }},
          {"validity.csv", [study] { return validity_csv(study); }}};
}

namespace {

ReadyStudy read(const std::filesystem::path& file, const std::string& scale) {
  const RegularizationStudy study = read_regularization_study(file, scale);
  return table_study(study.header, regularization_tables(study));
}

const RegisteredStudyKind regularization_kind({"regularization", read,
                                               regularization_study_template});

}  // namespace

}  // namespace smoothfem
