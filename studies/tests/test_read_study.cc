// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/stat.h>

#include <algorithm>
#include <regex>

#include "smoothing/tests/volume_meshes.h"
#include "studies/framework/definition/find_study.h"
#include "studies/framework/definition/study.h"
#include "studies/tests/study_tests.h"

namespace smoothfem {
namespace {

const std::filesystem::path gear_file =
    std::filesystem::path(SMOOTHFEM_SOURCE_DIR) / "studies" / "catalogue" / "thesis" / "gear.prm";

std::vector<std::string> names_of(const std::vector<StudyMethod>& methods) {
  std::vector<std::string> names;
  for (const auto& method : methods) names.push_back(method.name);
  return names;
}

/// Returns the second study's parameters in force that differ from the first study's, sorted.
StudyParameters changes(const StudyHeader& from, const StudyHeader& to) {
  StudyParameters result;
  EXPECT_EQ(from.parameters.size(), to.parameters.size());
  for (const auto& entry : to.parameters)
    if (std::find(from.parameters.begin(), from.parameters.end(), entry) == from.parameters.end())
      result.push_back(entry);
  std::sort(result.begin(), result.end());
  return result;
}

TEST(GearStudy, IsTheExampleOfTheThesis) {
  const Study study = read_study(gear_file);
  EXPECT_EQ(study.header.name, "gear");
  EXPECT_EQ(study.header.title, "Involute gear");
  ASSERT_EQ(study.meshes.size(), 2u);
  EXPECT_EQ(study.meshes[0].name, "tri");
  EXPECT_EQ(study.meshes[0].domain, "gear");
  EXPECT_EQ(study.meshes[0].elements, "triangles");
  EXPECT_EQ(study.meshes[0].published_file, "gear_tri_initial.mesh");
  EXPECT_EQ(study.meshes[0].distort_to_q_mean, 0.3699);
  EXPECT_EQ(study.meshes[1].name, "quad");
  EXPECT_EQ(study.meshes[1].elements, "quadrilaterals");
  EXPECT_EQ(study.meshes[1].distort_to_q_mean, 0.4180);
  EXPECT_EQ(names_of(study.methods), (std::vector<std::string>{"weighted-laplace", "smart-laplace",
                                                               "global-optimization", "getme"}));
  for (const auto& method : study.methods) {
    EXPECT_EQ(method.type, method.name);
    EXPECT_TRUE(method.settings.empty()) << method.name;
  }
  EXPECT_EQ(study.degrees, (std::vector<int>{1, 2}));
  EXPECT_EQ(study.solution.name, "gear");
  EXPECT_EQ(study.finite_elements.load, Load::nodal);  // the protocol
  EXPECT_EQ(study.finite_elements.best_approximation, Recorded::results);
  EXPECT_EQ(study.finite_elements.tensor_points.quadrilateral, 8);
  EXPECT_EQ(study.finite_elements.tensor_points.hexahedron, 0) << "chosen for each cell";
  EXPECT_EQ(study.finite_elements.cg_tolerance, 1e-8);
  EXPECT_TRUE(study.finite_elements.boundary_in_norm);
  EXPECT_EQ(study.finite_elements.condition_number, ConditionNumberMethod::verified);
  EXPECT_EQ(study.finite_elements.jacobi_cg, Recorded::always);
  EXPECT_EQ(study.thresholds.reference, "global-optimization");
  EXPECT_EQ(study.thresholds.margin, 0.05);
  EXPECT_EQ(study.record_every.default_interval, 1);
  EXPECT_EQ(study.edge_scale, 1.0);
}

TEST(GearStudy, QuickChangesTheKeysOfItsSubsectionOnly) {
  Study quick = read_study(gear_file, "quick");
  EXPECT_EQ(quick.record_every.default_interval, 10);
  EXPECT_EQ(quick.edge_scale, 2.5);
  const Study full = read_study(gear_file);
  // The parameters contain every key of the file, so they represent all other fields.
  EXPECT_EQ(quick.header.file_parameters, full.header.file_parameters);
  EXPECT_EQ(full.header.parameters, full.header.file_parameters);
  EXPECT_EQ(changes(full.header, quick.header),
            (StudyParameters{{"edge scale", "2.5"}, {"record every", "10"}}));
  EXPECT_EQ(names_of(quick.methods), names_of(full.methods));
  EXPECT_EQ(quick.degrees, full.degrees);
  EXPECT_EQ(quick.timing_runs, full.timing_runs);
  EXPECT_EQ(quick.meshes.size(), full.meshes.size());
}

TEST(VolumeStudy, IsThatOfSection63) {
  const auto file = find_study("volume");
  const Study study = read_study(file);
  EXPECT_EQ(study.dimensions.cells, 3);
  ASSERT_EQ(study.meshes.size(), 2u);
  EXPECT_EQ(study.meshes[0].elements, "tetrahedra");
  EXPECT_EQ(study.meshes[0].distort_to_q_mean, 0.4178);
  EXPECT_EQ(study.meshes[1].elements, "hexahedra");
  EXPECT_EQ(study.meshes[1].distort_to_q_mean, 0.4631);
  EXPECT_EQ(study.solution.name, "volume");
  EXPECT_EQ(study.finite_elements.condition_number, ConditionNumberMethod::lanczos);
  EXPECT_EQ(study.finite_elements.multigrid_cg, Recorded::results);
  EXPECT_EQ(study.record_every.default_interval, 1);
  EXPECT_EQ(study.record_every.stages.at("sequential"), 10);
  EXPECT_GT(study.edge_scale, 2.0);
  const Study paper = read_study(file, "paper");
  EXPECT_EQ(paper.header.scale, "paper");
  EXPECT_EQ(paper.edge_scale, 1.0);
  const auto changed = changes(study.header, paper.header);
  EXPECT_NE(std::find(changed.begin(), changed.end(),
                      std::pair<std::string, std::string>{"edge scale", "1"}),
            changed.end());
}

TEST(SurfaceStudy, IsThatOfSection512) {
  const Study study = read_study(find_study("surface"));
  EXPECT_EQ(study.dimensions.cells, 2);
  EXPECT_EQ(study.dimensions.space, 3);
  ASSERT_EQ(study.meshes.size(), 2u);
  EXPECT_EQ(study.meshes[0].domain, "roof");
  EXPECT_EQ(study.meshes[0].distort_to_q_mean, 0.0);
  EXPECT_EQ(study.meshes[1].distort_to_q_mean, 0.4983);
  EXPECT_EQ(names_of(study.methods), (std::vector<std::string>{"smart-laplace", "getme"}));
  EXPECT_TRUE(study.degrees.empty());
}

class StudyFile : public FileTest {
 protected:
  Study read(const std::string& content) const { return read_study(file_with("own.prm", content)); }

  /// Returns the message about a bad file. Every message must begin with the file, have one line,
  /// and show no internals of the program.
  std::string error_of(const std::string& content) const {
    return checked(input_error_of([&] { read(content); }), file("own.prm"));
  }

  static std::string checked(const std::string& message, const std::filesystem::path& path) {
    EXPECT_TRUE(message.starts_with(path.string() + ":")) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string word : {"Stacktrace", "dealii", "Exc", "violated", "----", "  "})
      EXPECT_EQ(message.find(word), std::string::npos) << word << " in: " << message;
    return message;
  }

  /// Expects a message with this line.
  void expect_error_at(int line, const std::string& content, const std::string& word) const {
    const std::string message = error_of(content);
    const std::string position = file("own.prm").string() + ":" + std::to_string(line) + ": ";
    EXPECT_TRUE(message.starts_with(position)) << message;
    EXPECT_NE(message.find(word), std::string::npos) << message;
  }

  void expect_error(const std::string& content, const std::string& word) const {
    const std::string message = error_of(content);
    EXPECT_NE(message.find(word), std::string::npos) << message;
  }
};

TEST_F(StudyFile, HasTheDimensionsOfItsFirstMeshByDefault) {
  write_mesh(file("box.vtu"), test::box_mesh(1, 1, 1, test::BoxCells::hexahedra));
  const std::string own =
      "set meshes = m\nset degrees =\nset methods = getme\nsubsection mesh m\n set ";
  const auto cells_and_space = [&](const std::string& text) {
    const MeshDimensions found = read(text).dimensions;
    return std::pair(found.cells, found.space);
  };
  EXPECT_EQ(cells_and_space(own + "file = box.vtu\nend\n"), std::pair(3, 3));
  EXPECT_EQ(cells_and_space(own + "domain = sphere\nend\n"), std::pair(3, 3));
  EXPECT_EQ(cells_and_space(own + "domain = gear\nend\n"), std::pair(2, 2));
  EXPECT_EQ(cells_and_space(own + "domain = roof\nend\n"), std::pair(2, 3));
  EXPECT_EQ(cells_and_space(own + "domain = roof\nend\nset surface = false\n"), std::pair(2, 2));
  EXPECT_EQ(cells_and_space(own + "file = box.vtu\nend\nset dimension = 2\n"), std::pair(2, 2));
  EXPECT_EQ(cells_and_space(own + "file = missing.vtu\nend\n"), std::pair(2, 2));
}

const std::string one_mesh = "set meshes = a\nsubsection mesh a\n set file = a.mesh\nend\n";

TEST_F(StudyFile, OfSurfacesHasMethodsForThemAndNoFiniteElements) {
  const std::string head = "set meshes = a\nset surface = true\n";
  EXPECT_EQ(names_of(read(head + "set degrees =\nset methods = all\n").methods),
            (std::vector<std::string>{"getme", "getme-sequential", "getme-simultaneous", "laplace",
                                      "smart-laplace"}));
  expect_error(head + "set methods = getme\nset degrees = 1\n", "finite elements are not solved");
  expect_error(head + "set dimension = 3\nset degrees =\n", "'dimension = 2'");
  expect_error(head + "set methods = getme-adaptive\nset degrees =\n",
               "does not support surface meshes; choose one of getme");
}

TEST_F(StudyFile, NamesItsMeshFileRelativeToItself) {
  const Study study = read(one_mesh + "set methods = laplace\n");
  EXPECT_EQ(study.header.name, "own");
  EXPECT_EQ(study.header.title, "own");
  EXPECT_EQ(study.meshes.at(0).file, file("a.mesh"));
  EXPECT_TRUE(study.thresholds.reference.empty());
}

TEST_F(StudyFile, AllMeansEveryRegisteredMethod) {
  std::vector<std::string> registered;
  for (const auto& info : method_catalogue())
    if (supports_mesh_kind<2>(info.name)) registered.push_back(info.name);
  ASSERT_GE(registered.size(), 4u);
  EXPECT_EQ(names_of(read(one_mesh + "set methods = all\n").methods), registered);
  EXPECT_EQ(names_of(read(one_mesh).methods), registered) << "'all' is the default";
}

TEST_F(StudyFile, MethodsThatNeedAProblemAreForStudiesThatSolveOne) {
  const std::string energy = one_mesh + "set methods = energy-descent\n";
  EXPECT_EQ(names_of(read(energy).methods), std::vector<std::string>{"energy-descent"});
  expect_error(energy + "set degrees =\n", "solves none");
}

TEST_F(StudyFile, DegreesMayBeEmptyForSmoothingOnly) {
  EXPECT_TRUE(read(one_mesh + "set degrees =\n").degrees.empty());
  EXPECT_EQ(read(one_mesh + "set degrees = 2\n").degrees, std::vector<int>{2});
}

TEST_F(StudyFile, LabelsOfOneTypeHaveTheirOwnSettings) {
  const Study study = read(one_mesh + R"(
set methods = getme, my-getme
subsection method my-getme
  set type                = getme
  set simultaneous.lambda = 0.4
end
)");
  ASSERT_EQ(names_of(study.methods), (std::vector<std::string>{"getme", "my-getme"}));
  EXPECT_TRUE(study.methods[0].settings.empty());
  EXPECT_EQ(study.methods[1].type, "getme");
  using Setting = std::pair<std::string, std::string>;
  EXPECT_EQ(study.methods[1].settings, (std::vector<Setting>{{"simultaneous.lambda", "0.4"}}));
  EXPECT_NE(study.methods[0].title, study.methods[1].title);
  Method<2> standard = study.methods[0].make<2>(), own = study.methods[1].make<2>();
  const auto lambda = [](Method<2>& method) {
    return value_text(find_parameter(method.parameters(), "simultaneous.lambda", "getme"));
  };
  EXPECT_EQ(lambda(own), "0.4");
  EXPECT_NE(lambda(standard), "0.4");
}

TEST_F(StudyFile, UnknownKeysAndSubsectionsAreFoundWithTheirLine) {
  expect_error_at(5, one_mesh + "set degreesx = 1\n", "degreesx");
  expect_error_at(4, "set meshes = a\nsubsection mesh a\n set file = a.mesh\n set fil = b\nend\n",
                  "fil");
  expect_error_at(5, one_mesh + "subsection solutions\n set name = gear\nend\n", "solutions");
  expect_error_at(5, one_mesh + "subsection mesh b\n set file = b.mesh\nend\n",
                  "'set meshes' does not name 'b'");
  expect_error_at(7,
                  one_mesh +
                      "set methods = laplace\nsubsection method laplace\n"
                      " set lambda = 1\nend\n",
                  "lambda");
}

TEST_F(StudyFile, GeometryOfCellsOfSecondOrder) {
  const std::string in_finite_elements = one_mesh + "subsection finite elements\n set geometry = ";
  EXPECT_EQ(read(one_mesh).finite_elements.geometry, Geometry::curved);
  EXPECT_EQ(read(in_finite_elements + "straight\nend\n").finite_elements.geometry,
            Geometry::straight);
  expect_error_at(6, in_finite_elements + "bent\nend\n", "it has to be one of curved, straight");
}

TEST_F(StudyFile, BadValuesAreFoundWithTheirLine) {
  expect_error_at(5, one_mesh + "set record every = often\n", "often");
  expect_error_at(5, one_mesh + "set record every = 0\n", "record every");
  expect_error_at(5, one_mesh + "set edge scale = 0.5\n", "0.5");
  expect_error_at(5, one_mesh + "set write series = maybe\n", "maybe");
  EXPECT_THAT(error_of(one_mesh + "set degrees = 1\nset refined degrees = 2\n"),
              ::testing::HasSubstr("'refined degrees' has 2"));
  EXPECT_THAT(error_of(one_mesh + "set metrics = shap\n"),
              ::testing::HasSubstr("did you mean 'shape'?"));
  expect_error_at(6, one_mesh + "subsection finite elements\n set cg tolerance = 1e-8x\nend\n",
                  "1e-8x");
  expect_error_at(4,
                  "set meshes = a\nsubsection mesh a\n set file = a.mesh\n"
                  " set elements = hexagons\nend\n",
                  "hexagons");
}

TEST_F(StudyFile, MessagesShowTheCorrectForm) {
  expect_error_at(5, one_mesh + "set degree = 1\n",
                  "there is no key 'degree' here; did you mean 'degrees'?");
  expect_error_at(
      7, one_mesh + "set scales = quick\nsubsection scale quick\n set metrics = all\nend\n",
      "there is no key 'metrics' here; it is for another part of the file;");
  expect_error_at(5, one_mesh + "subsection solutions\nend\n", "did you mean 'solution'?");
  expect_error_at(5, one_mesh + "subsection mesh gear-of-mine\nend\n",
                  "'set meshes' does not name 'gear-of-mine', which has a subsection here; add it");
  expect_error_at(5, one_mesh + "subsection method getme-of-mine\nend\n",
                  "'set methods' does not name 'getme-of-mine'");
  expect_error_at(5, one_mesh + "set record every = 0\n",
                  "record every = 0 is not allowed; it has to be a whole number of at least 1");
  expect_error_at(6, one_mesh + "subsection finite elements\n set cg tolerance = 2\nend\n",
                  "cg tolerance = 2 is not allowed; it has to be a number from 0 to 1");
  expect_error_at(5, one_mesh + "set write series = maybe\n", "it has to be true or false");
  expect_error_at(6, one_mesh + "subsection finite elements\n set load = nodall\nend\n",
                  "it has to be one of quadrature, nodal; did you mean 'nodal'?");
  expect_error_at(5, one_mesh + "set record stages every = sequential 10\n",
                  "a list like 'sequential: 10, simultaneous: 2'");
  expect_error_at(5, one_mesh + "degrees = 1\n", "'degrees = 1' is not a line of a study file");
  expect_error_at(5, one_mesh + "end\n", "this 'end' ends no subsection");
  expect_error_at(5, one_mesh + "include nothing.prm\n",
                  "cannot read the file '" + file("nothing.prm").string() + "'");
  expect_error(one_mesh + "subsection solution\n", "a subsection has no end");
}

TEST_F(StudyFile, MeshesInPartsRefuseWhatNeedsTheWhole) {
  const std::string in_parts = one_mesh + "set in parts = true\n";
  expect_error(in_parts, "'degrees' has 2, which does not work with 'set in parts = true'");
  const std::string linear = in_parts + "set degrees = 1\n";
  EXPECT_TRUE(read(linear).in_parts);
  expect_error(linear + "set metrics = all\n", "the study has 'metrics'");
  expect_error(linear + "set methods = energy-descent\n",
               "the study has the method energy-descent");
  expect_error(linear + "set methods = energy-descent\n", "take one of getme, ");
  expect_error(linear + "subsection solution\n set natural = group left\nend\n", "'natural'");
  expect_error(one_mesh + "set refine = 1\n", "'refine' works on a mesh in parts");
  const Study huge = read_study(find_study("volume"), "huge");
  EXPECT_TRUE(huge.in_parts);
  EXPECT_EQ(huge.refine, 1);
  EXPECT_EQ(huge.degrees, std::vector{1});
  EXPECT_EQ(huge.finite_elements.condition_number, ConditionNumberMethod::none);
  EXPECT_FALSE(read_study(find_study("volume")).in_parts);
}

TEST_F(StudyFile, IncludesFilesNextToIt) {
  std::ofstream(file("base.prm")) << one_mesh << "set degrees = 1\nset record every = 3\n";
  const Study study = read("include base.prm  # all but one key\nset record every = 7\n");
  EXPECT_EQ(study.meshes.size(), 1u);
  EXPECT_EQ(study.degrees, std::vector<int>{1});
  EXPECT_EQ(study.record_every.default_interval, 7);
}

TEST_F(StudyFile, IncludedFilesIncludeOthersNextToThem) {
  std::filesystem::create_directory(file("below"));
  std::ofstream(file("below/mesh.prm")) << one_mesh;
  std::ofstream(file("below/base.prm")) << "include mesh.prm\nset degrees = 1\n";
  EXPECT_EQ(read("include below/base.prm\n").meshes.size(), 1u);
}

TEST_F(StudyFile, MistakesInIncludedFilesAreFoundThere) {
  std::ofstream(file("base.prm")) << one_mesh << "set degreesx = 1\n";
  const std::string message =
      checked(input_error_of([&] { read("set title = a\ninclude base.prm\n"); }), file("base.prm"));
  EXPECT_THAT(message, ::testing::HasSubstr("base.prm:5: there is no key 'degreesx'"));
}

TEST_F(StudyFile, MayNotIncludeItself) {
  expect_error_at(1, "include own.prm\n", "includes this file itself");
  std::ofstream(file("base.prm")) << "\ninclude own.prm\n";
  const std::string message =
      checked(input_error_of([&] { read("include base.prm\n"); }), file("base.prm"));
  EXPECT_THAT(message, ::testing::HasSubstr("base.prm:2: "));
}

TEST_F(StudyFile, MayHaveTextOfAnyLength) {
  const std::string text(100'000, 'a');
  EXPECT_EQ(read("set title = " + text + "\nset note = " + text + "\n" + one_mesh).header.note,
            text);
  std::string seeds;
  for (int i = 1; i <= 10'000; ++i) seeds += (i > 1 ? "," : "") + std::to_string(i);
  EXPECT_EQ(read(one_mesh + "set seeds = " + seeds + "\n").meshes.size(), 1u);
  expect_error_at(5, one_mesh + "set record every = " + text + "\n", "whole number");
  expect_error_at(5, one_mesh + "set " + text + " = 1\n", "there is no key");
  expect_error_at(5, one_mesh + text + "\n", "is not a line of a study file");
}

TEST_F(StudyFile, MayBeginWithAByteOrderMarkAndEndLinesByReturns) {
  EXPECT_EQ(read("\xEF\xBB\xBFset title = x\n" + one_mesh).header.title, "x");
  std::string returns = "set title = x\n" + one_mesh;
  std::replace(returns.begin(), returns.end(), '\n', '\r');
  EXPECT_EQ(read(returns).header.title, "x");
}

TEST_F(StudyFile, IsInUtf8OutsideOfComments) {
  expect_error_at(5, one_mesh + "set title = \xe9\xff\n", "is not UTF-8");
  EXPECT_EQ(read(one_mesh + "set title = \xc3\xa9 # \xe9\n").header.title, "\xc3\xa9");
}

TEST_F(StudyFile, IsARegularFile) {
  ASSERT_EQ(::mkfifo(file("pipe.prm").c_str(), 0600), 0);
  EXPECT_THAT(input_error_of([&] { read_study(file("pipe.prm")); }),
              ::testing::HasSubstr("is not a regular file"));
  for (const std::string endless : {"pipe.prm", "/dev/zero", "/dev/urandom"})
    expect_error_at(1, "include " + endless + "\n", "cannot read the file");
}

TEST_F(StudyFile, IncludesSoManyFilesAtMost) {
  for (int i = 0; i < 20; ++i)
    file_with(std::to_string(i) + ".prm", i == 0 ? ""
                                                 : "include " + std::to_string(i - 1) +
                                                       ".prm\ninclude " + std::to_string(i - 1) +
                                                       ".prm\n");
  EXPECT_THAT(input_error_of([&] { read("include 19.prm\n"); }),
              ::testing::HasSubstr("includes too many files"));
  EXPECT_EQ(read("include 5.prm\n" + one_mesh).meshes.size(), 1u);
}

TEST_F(StudyFile, KeysThatOneFileSetsTwiceAreNamed) {
  file_with("base.prm", "set degrees = 1\nset title = a\n");
  const StudyText text(file_with("own.prm",
                                 "include base.prm\nset degrees = 2\nset note = a\n"
                                 " subsection  solution # of it\nset u\t=x\nset  u = y\n end #\n"
                                 "set note = b\nset u = z\n"));
  const auto found = text.repetitions();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_THAT(found[0], ::testing::HasSubstr("own.prm:6: 'solution/u' is set a second time"));
  EXPECT_THAT(found[1], ::testing::ContainsRegex("own.prm:8: 'note'.*own.prm:3"));
}

TEST_F(StudyFile, CanBeLookedAtWithoutRunningItsCode) {
  const std::string text =
      one_mesh +
      "set plugins = none.so\nset methods = laplace, mine, theirs\n"
      "subsection method mine\n set type = python:none.py:Mine\n set gain = 2\nend\n"
      "subsection method theirs\n set type = of-the-plugin\n set threads = 2\nend\n";
  expect_error(text, "none.so");
  const OnlyLook only_look;
  const Study study = read(text);
  ASSERT_EQ(study.methods.size(), 3u);
  EXPECT_FALSE(study.methods[0].is_stand_in);
  EXPECT_TRUE(study.methods[1].is_stand_in && study.methods[2].is_stand_in);
  EXPECT_EQ(study.methods[1].type, "python:none.py:Mine");
  expect_error_at(5, one_mesh + "set degreesx = 1\n", "degreesx");
}

TEST_F(StudyFile, MethodParametersOutOfRangeAreFoundWithTheirLine) {
  const std::string start = one_mesh + "set methods = getme\nsubsection method getme\n";
  expect_error_at(7, start + " set simultaneous.lambda = -1\nend\n", "simultaneous.lambda");
  expect_error_at(7, start + " set simultaneous.lambda = much\nend\n", "much");
}

TEST_F(StudyFile, RefusesFilesThatAreNotParameterFiles) {
  expect_error_at(5, one_mesh + "degrees = 1\n", "degrees");
  error_of(one_mesh + "subsection solution\n set name = gear\n");  // no 'end'
  error_of(one_mesh + "end\n");
}

TEST_F(StudyFile, UnknownNamesAreRefused) {
  expect_error(one_mesh + "set methods = laplace, magic\n", "magic");
  expect_error(one_mesh + "set methods = a\nsubsection method a\n set type = magic\nend\n",
               "magic");
  expect_error(one_mesh + "set degrees = 1, 3\n", "'3'");
  expect_error(one_mesh + "subsection solution\n set name = nowhere\nend\n", "nowhere");
  expect_error("set meshes = a\nsubsection mesh a\n set domain = moon\nend\n", "moon");
  expect_error(
      "set meshes = a\nsubsection mesh a\n set domain = gear\n set elements = mixed\nend\n",
      "choose one of triangles, quadrilaterals");
  expect_error(one_mesh +
                   "set methods = laplace\nsubsection thresholds\n set reference = getme\n"
                   "end\n",
               "getme");
}

TEST_F(StudyFile, AFormulaIsASolutionWithoutAName) {
  const auto solution = [&](const std::string& keys) {
    return read_study(file_with("a.prm", one_mesh + "subsection solution\n" + keys + "end\n"));
  };
  EXPECT_EQ(solution("").solution.name, "gear");
  const Study own = solution(
      "set u = sin(x)\nset diffusivity = 2, x ; x, 2\n"
      "set natural = group outlet, 7\n");
  EXPECT_EQ(own.solution.name, "expression");
  EXPECT_EQ(own.solution.u, "sin(x)");
  EXPECT_EQ(own.solution.diffusivity, "2, x ; x, 2");
  EXPECT_EQ(own.finite_elements.natural_groups, (std::vector<std::string>{"outlet", "7"}));
  EXPECT_EQ(solution("set natural = a, b\n").finite_elements.natural_groups,
            (std::vector<std::string>{"a", "b"}));
  const auto has = [](const Study& study, const std::string& key, const std::string& value) {
    return std::count(study.header.parameters.begin(), study.header.parameters.end(),
                      std::pair{key, value}) == 1;
  };
  EXPECT_TRUE(has(own, "solution/u", "sin(x)"));
  EXPECT_TRUE(has(own, "solution/name", "expression"));
  EXPECT_TRUE(has(own, "solution/diffusivity", "2, x ; x, 2"));
  EXPECT_TRUE(has(own, "solution/natural", "group outlet, 7"));
  // Results from before these keys can be resumed.
  for (const auto& [key, value] : solution("set name = sine\n").header.parameters)
    EXPECT_TRUE(key != "solution/u" && key != "solution/natural" && key != "solution/diffusivity");
}

TEST_F(StudyFile, ASolutionIsGivenInOneWayOnly) {
  const auto expect = [&](const std::string& keys, const std::string& part) {
    expect_error(one_mesh + "subsection solution\n" + keys + "end\n", part);
  };
  expect("set name = sine\nset u = x\n", "has the name 'sine' and the formula 'u'");
  expect("set u = x\nset load = 0\n", "both 'u' and 'load'");
  expect("set u = x\nset value = x\n", "both 'u' and 'value'");
  expect("set name = sine\nset diffusivity = 2\n", "give its formula as 'u' instead");
  expect("set diffusivity = 2\n", "give its formula as 'u' instead");
}

TEST_F(StudyFile, MethodsNameTheSolutionsTheySmoothFor) {
  const std::string two = one_mesh +
                          "set methods = getme, both\nset solutions = sine, ramp\n"
                          "subsection solution ramp\n set u = x^2\n set diffusivity = 2\nend\n";
  const std::string both = "subsection method both\n set type = energy-descent\n";
  const Study study = read(two + both + "set smooth for = ramp, sine\nend\n");
  EXPECT_EQ(study.solution.name, "sine");
  EXPECT_EQ(study.solution.label, "sine");
  ASSERT_EQ(study.further_solutions.size(), 1u);
  EXPECT_EQ(study.further_solutions[0].label, "ramp");
  EXPECT_EQ(study.further_solutions[0].u, "x^2");
  EXPECT_EQ(study.further_solutions[0].diffusivity, "2");
  EXPECT_TRUE(study.methods[0].smooth_for.empty());
  EXPECT_EQ(study.methods[1].smooth_for, (std::vector<std::string>{"ramp", "sine"}));

  expect_error(
      two + both + "set smooth for = rmap\nend\n",
      "method both has 'smooth for' = rmap, which is not in the lists 'solutions' and 'solvers'");
  expect_error(two + both + "set smooth for = sine, sine\nend\n", "'sine' twice");
  expect_error(two + both + "end\nsubsection method getme\nset smooth for = sine\nend\n",
               "method getme has 'smooth for', but does not move nodes by a solution");
  expect_error(one_mesh + "set methods = both\n" + both + "set smooth for = sine\nend\n",
               "which is not in the list 'solvers', and the study has no list 'solutions'");
  expect_error(two + both + "end\nsubsection solution\nset u = x\nend\n",
               "both a list 'solutions' and, in the subsection 'solution', 'u'");
  expect_error(one_mesh + "set solutions = sine, nowhere\n", "nowhere");
  expect_error(one_mesh + "set solutions = sine, sine\n", "'sine' is named twice");
  expect_error_at(6, one_mesh + "set solutions = sine\nsubsection solution sin\nend\n",
                  "'set solutions' does not name 'sin'");
  // Results from before these keys can be resumed.
  for (const auto& [key, value] : read(one_mesh).header.parameters)
    EXPECT_TRUE(key != "solutions" && !key.ends_with("smooth for")) << key;
}

TEST_F(StudyFile, LabelsThatWouldBreakFilesAreRefused) {
  expect_error("set meshes = a b\nsubsection mesh a b\n set file = a.mesh\nend\n", "'a b'");
  expect_error("set meshes = ../a\nsubsection mesh ../a\n set file = a.mesh\nend\n", "'../a'");
  // A comma in the list makes two labels of it, so the subsection belongs to neither.
  expect_error_at(2, "set meshes = a,b\nsubsection mesh a,b\n set file = a.mesh\nend\n", "a,b");
  expect_error(one_mesh + "set methods = my method\n", "'my method'");
  expect_error("set meshes = a, a\nsubsection mesh a\n set file = a.mesh\nend\n", "'a'");
  expect_error(one_mesh + "set methods = laplace, laplace\n", "'laplace'");
  expect_error("", "mesh");
  expect_error(one_mesh + "set methods =\n", "method");
}

TEST_F(StudyFile, RefusesMissingFiles) {
  const auto missing = file("missing.prm");
  checked(input_error_of([&] { read_study(missing); }), missing);
  const auto folder = file("folder.prm");
  std::filesystem::create_directory(folder);
  checked(input_error_of([&] { read_study(folder); }), folder);
}

TEST_F(StudyFile, AFileThatBreaksTheCsvByItsNameIsRefused) {
  const auto spaced = file_with("my study.prm", one_mesh);
  EXPECT_NE(input_error_of([&] { read_study(spaced); }).find("'my study'"), std::string::npos);
}

TEST_F(StudyFile, TheTemplateListsKeysThatAStudyMayHave) {
  // 'smoothfem list --study-keys' prints it. With a label for LABEL it must be a study.
  std::string text = study_template();
  for (const std::string label : {"LABEL", "NAME"})
    for (std::size_t at = text.find(label); at != std::string::npos; at = text.find(label, at))
      text.replace(at, label.size(), "a");
  const auto at = text.find("set meshes");
  ASSERT_NE(at, std::string::npos);
  text.replace(text.find('=', at), 1, "= a");
  const auto scales = text.find("set scales");
  ASSERT_NE(scales, std::string::npos);
  text.replace(text.find('=', scales), 1, "= a");
  text = std::regex_replace(text, std::regex("set methods += all"), "set methods = a");
  text = std::regex_replace(text, std::regex("set type +=.*"), "set type = getme");
  EXPECT_EQ(read(text).header.parameters, read("set meshes = a\nset scales = a\nset methods = a\n"
                                               "subsection method a\n set type = getme\nend\n")
                                              .header.parameters);
}

TEST_F(StudyFile, ScalesThatTheStudyDoesNotHaveAreRefused) {
  const auto path = file_with("own.prm",
                              "set meshes = a\nset scales = small, large\n"
                              "subsection scale small\n set edge scale = 3\nend\n");
  EXPECT_EQ(read_study(path, "small").edge_scale, 3.0);
  EXPECT_EQ(read_study(path, "large").edge_scale, read_study(path).edge_scale);
  const std::string message = checked(input_error_of([&] { read_study(path, "huge"); }), path);
  EXPECT_NE(message.find("small"), std::string::npos) << message;
  EXPECT_NE(message.find("large"), std::string::npos) << message;
  const std::string misspelt = input_error_of([&] { read_study(path, "smalll"); });
  EXPECT_NE(misspelt.find("did you mean 'small'?"), std::string::npos) << misspelt;
}

TEST_F(StudyFile, ParametersInForceAreThoseOfTheScale) {
  const auto path = file_with(
      "own.prm",
      "set meshes = a, b\nset methods = getme\nset scales = small, same, wrong\n"
      "set edge scale = 2\nset timing runs = 5\n"
      "subsection scale small\n set edge scale = 3\n set timing runs = 1\n set record every = 7\n"
      " set record stages every = sequential: 4\n set meshes = b\nend\n"
      "subsection scale wrong\n set edge scale = 0.5\nend\n");
  const Study plain = read_study(path), small = read_study(path, "small");
  EXPECT_EQ(changes(plain.header, small.header),
            (StudyParameters{{"edge scale", "3"},
                             {"meshes", "b"},
                             {"record every", "7"},
                             {"record stages every", "sequential: 4"},
                             {"timing runs", "1"}}));
  EXPECT_EQ(small.timing_runs, 1);
  EXPECT_EQ(small.record_every.default_interval, 7);
  EXPECT_EQ(small.record_every.stages.at("sequential"), 4);
  EXPECT_EQ(small.meshes.size(), 1u);
  EXPECT_EQ(changes(plain.header, read_study(path, "same").header), StudyParameters{});
  const std::string message = checked(input_error_of([&] { read_study(path, "wrong"); }), path);
  EXPECT_NE(message.find("the scale wrong has 'edge scale = 0.5'"), std::string::npos) << message;
}

TEST_F(StudyFile, SeedsRepeatRandomMeshes) {
  const auto path = file_with(
      "own.prm",
      "set meshes = ball, bent, plain\nset methods = getme\nset dimension = 3\nset degrees =\n"
      "set seeds = 4, 2, 9\nset record seeds = results\nset scales = one\n"
      "subsection mesh ball\n set domain = sphere\nend\n"
      "subsection mesh bent\n set domain = flange\n set distort to = 0.5\nend\n"
      "subsection mesh plain\n set domain = flange\n set seed = 7\nend\n"
      "subsection scale one\n set seeds = 8\nend\n");
  const Study study = read_study(path);
  EXPECT_TRUE(study.only_results_of_seeds);
  std::vector<std::tuple<std::string, std::uint64_t, std::string>> found;
  for (const auto& mesh : study.meshes) found.emplace_back(mesh.name, mesh.seed, mesh.repeats);
  EXPECT_THAT(found, testing::ElementsAre(
                         std::tuple("ball", 4, ""), std::tuple("ball.seed-2", 2, "ball"),
                         std::tuple("ball.seed-9", 9, "ball"), std::tuple("bent", 4, ""),
                         std::tuple("bent.seed-2", 2, "bent"), std::tuple("bent.seed-9", 9, "bent"),
                         std::tuple("plain", 7, "")));
  EXPECT_EQ(read_study(path, "one").meshes.size(), 3u);
  EXPECT_EQ(read_study(path, "one").meshes[1].seed, 8u);
}

TEST_F(StudyFile, RefusesBadSeeds) {
  const auto message_of = [&](const std::string& lines) {
    const auto path = file_with("own.prm", "set methods = getme\n" + lines +
                                               "subsection mesh a\n set domain = gear\nend\n");
    return checked(input_error_of([&] { read_study(path); }), path);
  };
  EXPECT_THAT(message_of("set meshes = a\nset seeds = 1, x\n"),
              testing::HasSubstr("'x', which is no"));
  EXPECT_THAT(message_of("set meshes = a\nset seeds = -1\n"),
              testing::HasSubstr("'-1', which is no"));
  EXPECT_THAT(message_of("set meshes = a\nset seeds = 1, 3, 1\n"),
              testing::HasSubstr("has 1 twice"));
  EXPECT_THAT(message_of("set meshes = a, a.seed-2\nset seeds = 1, 2\n"),
              testing::HasSubstr("is called a.seed-2, which is another mesh"));
}

TEST(FindStudy, TakesNamesOfBuiltInStudiesAndPaths) {
  EXPECT_TRUE(std::filesystem::equivalent(find_study("gear"), gear_file));
  EXPECT_EQ(find_study(gear_file.string()), gear_file);
  for (const std::string path : {"nowhere/gear", "./gear", "gear.prm"})
    EXPECT_EQ(find_study(path), path) << "a path, whether the file is there or not";
  EXPECT_TRUE(
      input_error_of([&] {
        find_study("geer");
      }).starts_with("there is no study 'geer'; did you mean 'gear'? choose one of aorta, "))
      << input_error_of([&] { find_study("geer"); });
}

TEST_F(StudyFile, IsBuiltInWithTheNameAndTheTextOfAStudyOfTheProgramOnly) {
  const std::string text = content_of(gear_file);
  EXPECT_TRUE(read_study(find_study("gear")).header.built_in);
  EXPECT_TRUE(read_study(file_with("gear.prm", text)).header.built_in);
  EXPECT_FALSE(read_study(file_with("gear.prm", text + "set record every = 2\n")).header.built_in);
  EXPECT_FALSE(read_study(file_with("mine.prm", text)).header.built_in);
}

TEST_F(StudyFile, AScaleMayTakeSomeOfTheMeshes) {
  const auto path = file_with("own.prm",
                              "set meshes = a, b, c\nset scales = small, odd\n"
                              "subsection scale small\n set meshes = c, a\nend\n"
                              "subsection scale odd\n set meshes = d\nend\n");
  EXPECT_EQ(read_study(path).meshes.size(), 3u);
  const auto meshes = read_study(path, "small").meshes;
  ASSERT_EQ(meshes.size(), 2u);
  EXPECT_EQ(meshes[0].name, "c");
  EXPECT_EQ(meshes[1].name, "a");
  const std::string message = checked(input_error_of([&] { read_study(path, "odd"); }), path);
  EXPECT_NE(message.find("'d'"), std::string::npos) << message;
}

TEST_F(StudyFile, StagesMayHaveTheirOwnInterval) {
  const Study study =
      read("set meshes = a\nset record every = 2\nset record stages every = sequential: 30\n");
  EXPECT_EQ(study.record_every.default_interval, 2);
  EXPECT_EQ(study.record_every.stages.at("sequential"), 30);
  for (const std::string bad : {"sequential: 0", "often"})
    expect_error_at(5, one_mesh + "set record stages every = " + bad + "\n", bad);
  const auto path = file_with("own.prm", one_mesh + "set methods = getme\n" +
                                             "set record stages every = getme-sequential: 10\n");
  const std::string message = checked(input_error_of([&] { read_study(path); }), path);
  EXPECT_NE(message.find("choose one of simultaneous, sequential"), std::string::npos) << message;
}

}  // namespace
}  // namespace smoothfem
