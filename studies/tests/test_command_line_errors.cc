// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>

#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/tests/volume_meshes.h"
#include "studies/tests/command_line.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

/// Bad input of every kind. Expects one sentence with the error and its place, exit code 2, and no
/// output file.
class BadInput : public CommandLine {
 protected:
  BadInput() { write_mesh(file("good.mesh"), shaken_grid(3, 0.1)); }

  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(file("")))
      if (const auto name = fs::relative(entry.path(), file("")).string(); !name.starts_with("."))
        names.insert(name);
    return names;
  }

  /// Expects a message that contains each of `words`.
  void expect_refused(const std::vector<std::string>& arguments,
                      const std::vector<std::string>& words) const {
    std::string call = "smoothfem";
    for (const auto& argument : arguments) call += " " + argument;
    SCOPED_TRACE(call);
    const auto before = files();
    const Outcome outcome = smoothfem(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("smoothfem: ")) << outcome.err;
    EXPECT_TRUE(outcome.err.ends_with('\n')) << outcome.err;
    for (const std::string inside : {"terminate", "what()", "internal error", "Stacktrace"})
      EXPECT_EQ(outcome.err.find(inside), std::string::npos) << outcome.err;
    for (const auto& word : words)
      EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " in: " << outcome.err;
    EXPECT_EQ(files(), before) << "files are left";
  }

  /// Expects that all commands refuse a bad mesh.
  void expect_mesh_refused(const std::string& mesh, const std::vector<std::string>& words) const {
    expect_refused({"quality", mesh}, words);
    expect_refused({"smooth", mesh, "-m", "getme", "-o", "out.vtu", "--log", "log.csv", "--series",
                    "series.pvd"},
                   words);
    file_with(".bad.prm", "set meshes = m\nset methods = laplace\nsubsection mesh m\n set file = " +
                              mesh + "\nend\n");
    expect_refused({"study", ".bad.prm", "--out", "results", "--quiet"}, words);
  }
};

// Nodes are on lines 3 to 7, cells on lines 9 to 12: the unit square around a fifth node.
std::string square(const std::string& centre, const std::string& first_cell) {
  return "planar_polygonal_mesh\nnodes 5\n0 0\n1 0\n1 1\n0 1\n" + centre + "\npolygons 4\n" +
         first_cell + "\n3 1 2 4\n3 2 3 4\n3 3 0 4\nfixed_node_indices 4\n0\n1\n2\n3\n";
}

TEST_F(BadInput, TheSquareOfTheseTestsIsGood) {
  file_with("square.mesh", square("0.5 0.5", "3 0 1 4"));
  EXPECT_EQ(smoothfem({"quality", "square.mesh"}).exit_code, 0);
}

TEST_F(BadInput, InvertedElement) {
  file_with("inverted.mesh", square("0.5 1.5", "3 0 1 4"));
  expect_mesh_refused("inverted.mesh", {"inverted.mesh:11: "});
}

TEST_F(BadInput, ClockwisePolygon) {
  // The cell is a mesh of its own. With other cells, its edges would contradict its neighbours'.
  file_with("clockwise.mesh",
            "planar_polygonal_mesh\nnodes 4\n0 0\n1 0\n1 1\n0 1\npolygons 1\n4 3 2 1 0\n"
            "fixed_node_indices 0\n");
  file_with("mixed.mesh", square("0.5 0.5", "3 4 1 0"));
  for (const std::string name : {"clockwise.mesh", "mixed.mesh"}) {
    expect_refused({"quality", name, "--keep-orientation"}, {name + ":", "clockwise"});
    expect_refused({"smooth", name, "--keep-orientation", "-o", "out.vtu"}, {name + ":"});
  }
}

TEST_F(BadInput, CellWithAMissingNode) {
  file_with("node.mesh", square("0.5 0.5", "3 0 1 5"));
  expect_mesh_refused("node.mesh", {"node.mesh:9: "});
}

TEST_F(BadInput, CoordinateThatIsNotANumber) {
  file_with("nan.mesh", square("nan 0.5", "3 0 1 4"));
  expect_mesh_refused("nan.mesh", {"nan.mesh:7: "});
  file_with("infinite.mesh", square("0.5 -inf", "3 0 1 4"));
  expect_mesh_refused("infinite.mesh", {"infinite.mesh:7: "});
}

TEST_F(BadInput, FileThatEndsTooEarly) {
  const std::string whole = square("0.5 0.5", "3 0 1 4");
  file_with("cells.mesh", whole.substr(0, whole.find("3 2 3 4")));
  expect_mesh_refused("cells.mesh", {"cells.mesh:"});
  file_with("empty.mesh", "");
  expect_mesh_refused("empty.mesh", {"empty.mesh"});
  // Binary files have no lines, but a cut one must not pass as complete either.
  for (const std::string name : {"cut.vtu", "cut.vtk", "cut.msh"}) {
    write_mesh(file(name), shaken_grid(3, 0.1));
    const std::string content = content_of(file(name));
    file_with(name, content.substr(0, content.size() / 2));
    expect_mesh_refused(name, {name});
  }
}

TEST_F(BadInput, MissingFile) {
  expect_mesh_refused("missing.mesh", {"missing.mesh"});
  expect_refused({"study", "missing.prm"}, {"missing.prm"});
  fs::create_directory(file("folder.mesh"));
  expect_mesh_refused("folder.mesh", {"folder.mesh"});
}

TEST_F(BadInput, UnknownFormat) {
  fs::copy_file(file("good.mesh"), file("good.step"));
  expect_mesh_refused("good.step", {"good.step"});
  expect_refused({"smooth", "good.mesh", "-m", "laplace", "-o", "out.step"}, {"out.step"});
  expect_refused({"smooth", "good.mesh", "-m", "laplace", "-o", "out.mesh", "--series", "a.vtu"},
                 {"a.vtu"});
}

TEST_F(BadInput, UnknownMethodOrParameter) {
  const std::vector<std::string> smooth = {"smooth", "good.mesh", "-o", "out.mesh", "-m"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), smooth.begin(), smooth.end());
    return more;
  };
  expect_refused(with({"magic"}), {"magic", "getme"});
  expect_refused(with({"getme", "--set", "magic=1"}), {"magic", "simultaneous.lambda"});
  expect_refused(with({"getme", "--set", "simultaneous.lambda"}), {"key=value"});
  expect_refused(with({"getme", "--set", "simultaneous.lambda=much"}), {"much"});
  expect_refused(with({"getme", "--set", "simultaneous.lambda=-3"}), {"-3"});
}

TEST_F(BadInput, UnknownPresetOrRuleOrGroup) {
  write_mesh(file("box.msh"), test::box_mesh(2, 2, 2, test::BoxCells::hexahedra));
  const auto smooth = [&](const std::string& mesh, const std::string& method,
                          std::vector<std::string> more) {
    more.insert(more.begin(), {"smooth", mesh, "-m", method, "-o", "out.vtu", "--log", "log.csv",
                               "--series", "series.pvd"});
    return more;
  };
  expect_refused(smooth("good.mesh", "getme", {"--preset", "magic"}),
                 {"no preset 'magic'", "thesis-5.1"});
  expect_refused(smooth("good.mesh", "laplace", {"--preset", "thesis-5.1"}),
                 {"thesis-5.1 has no parameters for method laplace on planar", "simultaneous"});
  expect_refused(smooth("box.msh", "laplace", {"--preset", "thesis-5.4"}),
                 {"thesis-5.4 has no parameters for method laplace on volume", "qgamma"});
  expect_refused(smooth("box.msh", "getme", {"--preset", "thesis-5.4", "--set", "rho=2"}),
                 {"'rho'", "simultaneous.rho"});
  for (const std::string rule : {"all", "group=", "group", "Boundary"})
    expect_refused(smooth("box.msh", "getme", {"--fix", rule}),
                   {"'" + rule + "'", "use boundary, file, free or group=NAME"});
  expect_refused(smooth("box.msh", "getme", {"--fix", "group=inlet"}),
                 {"'inlet'", "the mesh has no labelled boundary groups"});
  expect_refused(smooth("good.mesh", "getme-qgamma", {}),
                 {"getme-qgamma does not support planar meshes"});
  for (const std::string n : {"0", "-1", "2000", "many"})
    expect_refused(smooth("good.mesh", "getme", {"--threads", n}), {"--threads", n});
}

/// Hexahedra whose only free node is node 13, with its 8 cells.
TEST_F(BadInput, TangledVolumeMesh) {
  const VolumeMesh regular = test::box_mesh(2, 2, 2, test::BoxCells::hexahedra);
  const auto labelled = [&](const std::vector<Point<3>>& points) {
    MeshLabels labels;
    for (CellIndex c = 0; c < regular.n_cells(); ++c) labels.cell_ids.push_back(71 + c);
    for (NodeIndex i = 0; i < regular.n_nodes(); ++i) labels.node_ids.push_back(31 + i);
    return VolumeMesh(std::make_shared<const Topology>(
                          3, regular.n_nodes(), regular.topology().cells(), std::nullopt, labels),
                      points);
  };
  auto coordinates = regular.copied_coordinates();
  coordinates[13] = {1.0, 1.0, 2.5};
  write_mesh(file("tangled.msh"), labelled(coordinates));
  const std::vector<std::string> words = {"tangled.msh: 4 of 8 cells are invalid",
                                          "cell 75 at (0, 0, 1)",
                                          "cell 76 at (1, 0, 1)",
                                          "cell 77 at (0, 1, 1)",
                                          ", ...",
                                          "untangle the mesh first"};
  expect_refused({"quality", "tangled.msh"}, words);
  expect_refused({"smooth", "tangled.msh", "-m", "getme", "-o", "out.vtu", "--log", "log.csv",
                  "--series", "series.pvd"},
                 words);
  // Two corners of the box are swapped. Their cells have only these corners and other fixed nodes.
  coordinates = regular.copied_coordinates();
  std::swap(coordinates[0], coordinates[2]);
  write_mesh(file("hopeless.msh"), labelled(coordinates));
  for (const std::string method : {"getme", "laplace"})
    expect_refused(
        {"smooth", "hopeless.msh", "-m", method, "-o", "out.vtu", "--log", "log.csv", "--series",
         "series.pvd", "--untangle"},
        {"hopeless.msh: ",
         "2 of 2 invalid cells are left after untangling (cells 71, 72, the first at (2, 0, 0)",
         "--fix", "--boundary slide"});
  VolumeMesh flat = labelled(regular.copied_coordinates());
  flat = with_fixed_nodes(flat, std::vector<bool>(flat.n_nodes(), true));
  flat.coordinates()[13] = {1.0, 1.0, 2.5};
  write_mesh(file("fixed.inp"), flat);
  expect_refused({"smooth", "fixed.inp", "-m", "getme", "-o", "out.vtu", "--untangle"},
                 {"4 of 4 invalid cells have only fixed nodes",
                  "75, 76, 77, 78, the first at (0, 0, 1)", "--fix", "--boundary slide"});
  EXPECT_EQ(smoothfem({"smooth", "fixed.inp", "-m", "getme", "-o", "out.vtu", "--untangle", "--fix",
                       "boundary"})
                .exit_code,
            0);
}

TEST_F(BadInput, UnknownOptionOrCommand) {
  expect_refused({"quality", "good.mesh", "--magic"}, {"--magic"});
  expect_refused({"magic"}, {"magic"});
  expect_refused({"study", "good.prm", "--threads", "-1"}, {"--threads"});
  expect_refused({"study", "good.prm", "--threads", "many"}, {"many"});
  expect_refused({}, {});
  expect_refused({"smooth"}, {"in is required"});
  expect_refused({"generate", "gear"}, {"-o gear.vtu"});
  expect_refused({"generate", "-o", "a.vtu"}, {"which domain?"});
}

TEST_F(BadInput, OutputsThatWouldReplaceMeshes) {
  const std::vector<std::string> smooth = {"smooth", "good.mesh", "-m", "laplace", "-o", "out.vtu"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), smooth.begin(), smooth.end());
    return more;
  };
  expect_refused(with({"--log", "good.mesh"}), {"--log names good.mesh"});
  expect_refused(with({"--log", "./out.vtu"}), {"--log names ./out.vtu"});
  fs::create_hard_link(file("good.mesh"), file("linked.csv"));
  expect_refused(with({"--log", "linked.csv"}), {"--log names linked.csv"});
  expect_refused(with({"--log", "same", "--series", "same"}), {"--log and --series"});
}

TEST_F(BadInput, OptionsAreAnsweredWithTheNearestOne) {
  expect_refused({"smooth", "good.mesh", "-m", "laplace", "-o", "o.vtu", "--quit"},
                 {"there is no option '--quit'", "did you mean '--quiet'?"});
  expect_refused({"qualty", "good.mesh"},
                 {"there is no command 'qualty'", "did you mean 'quality'?"});
  expect_refused({"quality", "good.mesh", "another.mesh"}, {"no further word", "'another.mesh'"});
  expect_refused({"study", "gear", "--quick", "--scale", "paper"}, {"--quick", "paper"});
  EXPECT_EQ(
      smoothfem({"study", "polygons", "--quick", "--scale", "quick", "--print-plan"}).exit_code, 0);
}

TEST_F(BadInput, FolderThatCannotBeMade) {
  file_with("regular", "content");
  expect_refused({"smooth", "good.mesh", "-m", "laplace", "-o", "regular/out.mesh"},
                 {"regular/out.mesh"});
  expect_refused({"generate", "gear", "--edge-scale", "3", "-o", "regular/out.mesh"},
                 {"regular/out.mesh"});
  file_with("good.prm",
            "set meshes = m\nset methods = laplace\nset degrees =\nsubsection mesh m\n"
            " set file = good.mesh\nend\n");
  expect_refused({"study", "good.prm", "--out", "regular/results"}, {"regular"});
  EXPECT_EQ(content_of(file("regular")), "content");
}

TEST_F(BadInput, StudyFile) {
  file_with("bad.prm", "set meshes = m\nset degreesx = 1\n");
  expect_refused({"study", "bad.prm", "--out", "results"}, {"bad.prm:2: "});
  expect_refused({"study", "bad.prm", "--shard", ""}, {"--shard is empty"});
  expect_refused({"study", "gear", "--retry-failed"}, {"--retry-failed is for collections"});
  expect_refused({"study", "bad.prn"}, {"there is no study bad.prn; did you mean bad.prm?"});
  expect_refused({"study", "./bad"}, {"did you mean ./bad.prm?"});
}

TEST_F(BadInput, FormulasAndGroupsOfStudiesHaveTheirLine) {
  const auto study_with = [&](const std::string& solution) {
    file_with(".s.prm",
              "set meshes = m\nset methods = laplace\nset degrees = 1\nsubsection mesh m\n"
              " set file = good.mesh\nend\nsubsection solution\n" +
                  solution + "end\n");
  };
  study_with(" set u = sin(2*x\n");
  expect_refused({"study", ".s.prm", "--out", ".r", "--quiet"}, {".s.prm:8: the solution's 'u'"});
  study_with(" set u = x\n set diffusivity = x*\n");
  expect_refused({"study", ".s.prm", "--out", ".r", "--quiet"}, {".s.prm:9: ", "'diffusivity'"});
  study_with(" set u = x\n set diffusivity group=steel = 2\n");
  expect_refused({"study", ".s.prm", "--out", ".r", "--quiet"}, {".s.prm:9: ", "steel"});
}

TEST_F(BadInput, ListOfWhat) {
  expect_refused({"list", "getmee"}, {"there is no part, method or preset 'getmee'", "'getme'?"});
  expect_refused({"list", "domain"}, {"did you mean 'domains'?"});
  expect_refused({"list", "--study-keys", "smooth"}, {"there is no study kind 'smooth'"});
  const Outcome hidden = smoothfem({"study", "--magic"});
  EXPECT_EQ(hidden.err.find("--task-socket"), std::string::npos) << hidden.err;
}

TEST_F(BadInput, SmootherName) {
  for (const std::string& name : {std::string(300, 'a'), std::string(100'000, 'a'),
                                  std::string("a--b"), std::string("A"), std::string("a-")})
    expect_refused({"new-smoother", name}, {"cannot be called"});
}

TEST_F(BadInput, TinyMesh) {
  file_with("tiny.mesh",
            "planar_polygonal_mesh\nnodes 3\n0 0\n1e-320 0\n0 1e-320\npolygons 1\n3 0 1 2\n"
            "fixed_node_indices 0\n");
  expect_mesh_refused("tiny.mesh", {"tiny.mesh: ", "smaller unit of length"});
}

TEST_F(BadInput, Generator) {
  expect_refused({"generate", "moon", "-o", "out.mesh"}, {"moon", "gear"});
  expect_refused({"generate", "gear", "-o", "out.mesh", "--edge-scale", "0"}, {});
  expect_refused({"generate", "gear", "-o", "out.mesh", "--edge-scale", "nan"}, {});
  expect_refused({"generate", "gear", "-o", "out.mesh", "--elements", "stars"}, {"stars"});
  expect_refused({"generate", "gear", "-o", "out.mesh", "--elements", "quads"},
                 {"did you mean 'quadrilaterals'?"});
  expect_refused(
      {"generate", "gear", "-o", "out.mesh", "--elements", "quadrilaterals", "--edge-scale", "6"},
      {"the edge scale 6 is too large", "give an edge scale of at most 3.1"});
  expect_refused({"generate", "gear", "-o", "out.mesh", "--distort-to", "-1"}, {"-1"});
  expect_refused({"generate", "gear", "-o", "out.mesh", "--distort-to", "nan"}, {"nan"});
  expect_refused({"generate", "gear", "-o", "out.mesh", "--seed", "-1"}, {"-1"});
}

}  // namespace
}  // namespace smoothfem
