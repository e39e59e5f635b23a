// SPDX-License-Identifier: GPL-3.0-or-later
// Run by mpirun: a study on meshes in parts gives the results of one process. Each rank runs every
// test, the root alone reports.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "distributed/files/box.h"
#include "distributed/files/pieces.h"
#include "distributed/tests/folder.h"
#include "studies/framework/run/run_study.h"
#include "studies/tests/study_tests.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;
using test::all_ranks;
using test::Folder;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr const char* finite_elements =
    "set timing runs = 1\nset degrees = 1\nset in parts = true\nset count cells below = 0.5, 0.7\n"
    "subsection solution\n set name = sine\nend\n"
    "subsection finite elements\n set condition number = none\n set cg tolerance = 1e-12\nend\n"
    "subsection thresholds\n set reference = smooth\nend\n";

Study study_of(const Folder& folder, const std::string& name, const std::string& text) {
  const fs::path file = folder / (name + ".prm");
  all_ranks().on_root([&] { std::ofstream(file) << finite_elements << text; });
  return read_study(file);
}

/// A study of a distorted box in three pieces.
template <int dim>
Study box_study(const Folder& folder) {
  const std::string name = "box" + std::to_string(dim);
  write_box<dim>(all_ranks(), {.n = {6, 5, 4}, .splits = true, .displacement = 0.16}, 3,
                 folder / (name + ".pvtu"));
  return study_of(folder, name,
                  "set meshes = box\nset methods = smooth, getme\nset record every = 2\n"
                  "set record stages every = sequential: 20\n"
                  "subsection method smooth\n set type = smart-laplace\nend\n"
                  "subsection method getme\n set sequential.max_cycles = 40\nend\n"
                  "subsection mesh box\n set file = " +
                      name + ".pvtu\nend\n");
}

StudyOptions options_for(const fs::path& out, const Ranks& ranks) {
  StudyOptions options;
  options.out = out;
  options.quiet = true;
  options.ranks = ranks;
  return options;
}

bool is_of_errors(const std::string& column) {
  return column.starts_with("l2_") || column.starts_with("h1_") || column.starts_with("e_");
}

/// Expects the same rows, up to what conjugate gradients leave, and the same meshes.
void expect_same_results(const fs::path& one, const fs::path& other) {
  for (const std::string name : {"iterations.csv", "summary.csv"}) {
    const auto rows = rows_without_times(one / name), others = rows_without_times(other / name);
    ASSERT_EQ(rows.size(), others.size()) << name;
    EXPECT_GT(rows.size(), 2u);
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (const auto& [column, field] : rows[r]) {
        if (column.starts_with("cg_") || column.starts_with("jacobi_")) continue;
        const std::string& expected = others[r].at(column);
        if (is_of_errors(column) && !field.empty()) {
          EXPECT_NEAR(std::stod(field), std::stod(expected), 1e-7 * std::stod(field)) << column;
        }
        EXPECT_TRUE(is_of_errors(column) || field == expected) << name << ", " << column;
      }
  }
  const auto meshes = files_in(one / "meshes");
  EXPECT_EQ(meshes, files_in(other / "meshes"));
  EXPECT_GT(meshes.size(), 3u);
  for (const auto& mesh : meshes)
    EXPECT_EQ(content_of(one / "meshes" / mesh), content_of(other / "meshes" / mesh)) << mesh;
}

TEST(StudyInParts, IsTheSameOnAllRanks) {
  const Folder folder;
  const Study planar = box_study<2>(folder), solid = box_study<3>(folder);
  run_study(planar, options_for(folder / "together2", all_ranks()));
  run_study(solid, options_for(folder / "together3", all_ranks()));
  if (!all_ranks().is_root()) return;
  run_study(planar, options_for(folder / "alone2", Ranks()));
  run_study(solid, options_for(folder / "alone3", Ranks()));
  const auto rows = rows_without_times(folder / "alone3/summary.csv");
  expect_same_results(folder / "alone2", folder / "together2");
  expect_same_results(folder / "alone3", folder / "together3");
  // The counts are those of the whole mesh.
  const auto whole = std::get<VolumeMesh>(read_mesh(folder / "box3.pvtu").mesh);
  const std::vector<double> thresholds{0.5, 0.7};
  const auto below = count_cells_below(whole, thresholds);
  EXPECT_EQ(rows[0].at("n_below_0.7"), std::to_string(below[1].n));
  EXPECT_GT(below[1].n, 20u);
  EXPECT_LT(below[1].n, whole.n_cells());
  EXPECT_EQ(rows[0].at("n_dofs"), "210");  // 7 x 6 x 5
}

TEST(StudyInParts, GoesOnWithAnotherNumberOfRanks) {
  const Folder folder;
  const Study study = box_study<3>(folder);
  auto options = options_for(folder / "results", all_ranks());
  options.until = RunUntil::smoothing;
  run_study(study, options);
  if (!all_ranks().is_root()) return;
  std::map<std::string, fs::file_time_type> smoothed;
  for (const auto& file : files_in(folder / "results/kept"))
    smoothed[file] = fs::last_write_time(folder / "results/kept" / file);
  EXPECT_GT(smoothed.size(), 4u);
  run_study(study, options_for(folder / "results", Ranks()));
  for (const auto& [file, time] : smoothed)
    EXPECT_EQ(fs::last_write_time(folder / "results/kept" / file), time) << file;
  run_study(study, options_for(folder / "alone", Ranks()));
  expect_same_results(folder / "alone", folder / "results");
}

TEST(StudyInParts, TakesMeshesThatAreMade) {
  const Folder folder;
  const std::string text =
      "set meshes = grid\nset methods = smooth\nset record every = 20\n"
      "subsection method smooth\n set type = getme-simultaneous\nend\n"
      "subsection mesh grid\n set domain = l-shape\n set edge scale = 12\n set distort within = "
      "0.3\nend\n";
  const Study study = study_of(folder, "made", text);
  run_study(study, options_for(folder / "results", all_ranks()));
  const auto rows = rows_without_times(folder / "results/summary.csv");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_LT(std::stod(rows[0].at("q_mean")), std::stod(rows[1].at("q_mean")));
  const auto mesh = read_mesh(folder / "results/meshes/grid_initial.pvtu");
  EXPECT_EQ(std::to_string(std::get<PlanarMesh>(mesh.mesh).n_nodes()), rows[0].at("n_dofs"));
}

TEST(StudyInParts, RefusesFilesThatDoNotFit) {
  const Folder folder;
  Study study = box_study<3>(folder);
  study.dimensions = {2, 2};
  EXPECT_THAT([&] { run_study(study, options_for(folder / "no", all_ranks())); },
              ThrowsMessage<InputError>(HasSubstr("set it to 3")));
  study.dimensions = {3, 3};
  all_ranks().on_root([&] { fs::remove(piece_file(folder / "box3.pvtu", 1)); });
  EXPECT_THAT([&] { run_study(study, options_for(folder / "no", all_ranks())); },
              ThrowsMessage<InputError>(HasSubstr("box3_0001.vtu")));
  all_ranks().on_root([&] {  // a square next to two smaller ones
    std::ofstream(folder / "hanging.mesh")
        << "MeshVersionFormatted 2\nDimension 2\nVertices\n8\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
           "1.5 0 0\n1 0.5 0\n1.5 0.5 0\n1.5 1 0\nQuadrilaterals\n3\n1 2 3 4 0\n2 5 7 6 0\n"
           "6 7 8 3 0\nEnd\n";
  });
  const Study hanging = study_of(folder, "hanging",
                                 "set meshes = grid\nset methods = smooth\n"
                                 "subsection method smooth\n set type = getme-adaptive\nend\n"
                                 "subsection mesh grid\n set file = hanging.mesh\nend\n");
  EXPECT_THAT([&] { run_study(hanging, options_for(folder / "no", all_ranks())); },
              ThrowsMessage<InputError>(HasSubstr("hanging")));
  if (!all_ranks().is_root()) return;
  EXPECT_FALSE(fs::exists(folder / "no"));
}

}  // namespace
}  // namespace smoothfem

int main(int argc, char** argv) {
  return smoothfem::test::run_on_all_ranks(argc, argv);
}
