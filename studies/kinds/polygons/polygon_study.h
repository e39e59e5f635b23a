// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "studies/framework/run/table_study.h"

namespace smoothfem {

/// Parameters of a sequence of Fig. 2.12: theta and lambda, or the line S_k at theta.
struct SequenceParameters {
  double theta = 0.0;
  double lambda = 0.0;  ///< of the line, if the study file names a line
};

/// A study of Chapter 2 of the thesis: polygon transformations, their limits and its theorems.
struct PolygonStudy {
  StudyHeader header;
  std::uint64_t seed = 1;
  std::vector<std::size_t> nodes;  ///< of polygons in theorems and classification
  std::size_t cases = 1;           ///< random polygons of each theorem and number of nodes
  std::size_t steps = 4000;        ///< number after which limits count as reached
  std::size_t theta_points = 1;    ///< of the classification, over (0, pi/2)
  std::size_t lambda_points = 1;   ///< the same over (0, 1)
  std::size_t domain_points = 1;   ///< of both directions of the grid in domains.csv
  int doublings = 26;              ///< the classification's polygons are iterated 2^doublings times
  std::vector<std::size_t> decomposition_nodes, domain_nodes, limit_nodes;
  std::size_t sequence_nodes = 6;                            ///< of the polygon of Fig. 2.12
  std::vector<SequenceParameters> sequences;                 ///< of Fig. 2.12
  std::vector<std::size_t> isosceles_steps, combined_steps;  ///< shown of Figs. 2.5 and 2.12
};

/// Reads a study file of kind `polygons`. Throws InputError as read_study does.
PolygonStudy read_polygon_study(const std::filesystem::path& file, const std::string& scale = {});

/// Returns a commented study file with every key and its default.
std::string polygon_study_template();

/// Returns the study's tables for run_table_study: theorems.csv, classification.csv,
/// decomposition.csv, domains.csv, limits.csv, sequences.csv and side_ratios.csv (columns:
/// studies/columns.json).
std::vector<StudyTable> polygon_tables(const PolygonStudy& study);

}  // namespace smoothfem
