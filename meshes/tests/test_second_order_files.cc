// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of second order in files, against VTK and Gmsh. The nodes of the meshes say where they
// are: a wrong order of nodes bends the straight cells.
#include <gmsh.h>
#include <vtkCell.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <Eigen/Dense>
#include <fstream>
#include <iterator>

#include "meshes/io/mesh_assembly.h"
#include "meshes/tests/mesh_tests.h"
#include "meshes/tools/gmsh_session.h"

namespace smoothfem {
namespace {

struct SecondOrder {
  std::string name;
  int dim;
  std::size_t n_corners, n_midside;
  std::vector<std::string> extensions{};  ///< formats that hold the element
  friend void PrintTo(const SecondOrder& parameter, std::ostream* out) { *out << parameter.name; }
};

const std::vector<std::string> all{".msh", ".vtk", ".vtu", ".inp", ".mesh"},
    vtk_and_abaqus{".msh", ".vtk", ".vtu", ".inp"}, vtk_only{".msh", ".vtk", ".vtu"};
const auto elements = ::testing::Values(
    SecondOrder{"TRI6", 2, 3, 3, all}, SecondOrder{"TRI7", 2, 3, 4, {".vtk", ".vtu"}},
    SecondOrder{"QUAD8", 2, 4, 4, vtk_and_abaqus}, SecondOrder{"QUAD9", 2, 4, 5, all},
    SecondOrder{"TET10", 3, 4, 6, all}, SecondOrder{"PYRAMID13", 3, 5, 8, vtk_and_abaqus},
    SecondOrder{"PYRAMID14", 3, 5, 9, {".msh"}}, SecondOrder{"PRISM15", 3, 6, 9, vtk_and_abaqus},
    SecondOrder{"PRISM18", 3, 6, 12, vtk_only}, SecondOrder{"HEX20", 3, 8, 12, vtk_and_abaqus},
    SecondOrder{"HEX27", 3, 8, 19, vtk_only});

/// Corners of the reference cells, in the order of volume_elements.h.
std::vector<Point<3>> reference_corners(int dim, std::size_t n) {
  const std::vector<Point<3>> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<Point<3>> corners = n == 3 || n == 6 || (dim == 3 && n == 4) ? triangle : square;
  if (dim == 2) return corners;
  if (n == 4) corners.emplace_back(0, 0, 1);
  if (n == 5) corners.emplace_back(.5, .5, 1);
  for (std::size_t k = 0, base = corners.size(); n >= 6 && k < base; ++k)
    corners.push_back(corners[k] + Point<3>(0, 0, 1));
  return corners;
}

/// An affine map without symmetries; it keeps the plane z = 0.
Point<3> placed(const Point<3>& p) {
  return {2.0 * p.x() + 0.3 * p.y() + 0.2 * p.z() + 0.1, 0.4 * p.x() + 1.5 * p.y() - 0.1 * p.z(),
          1.2 * p.z()};
}

/// A mesh of one cell whose midside nodes come first in the numbering, and by `bend` away from
/// their straight places.
MeshParts one_cell(const SecondOrder& element, double bend = 0.0) {
  MeshParts parts;
  const auto corners = reference_corners(element.dim, element.n_corners);
  std::vector<NodeIndex> row;
  const auto add = [&](const Point<3>& p) { parts.coordinates.push_back(p); };
  std::vector<NodeIndex> positions(element.n_corners);
  for (std::size_t k = 0; k < positions.size(); ++k)
    positions[k] = static_cast<NodeIndex>(element.n_midside + k);
  std::vector<NodeIndex> midside(element.n_midside);
  for (std::size_t k = 0; k < midside.size(); ++k) midside[k] = static_cast<NodeIndex>(k);
  for_each_midside_place(
      element.dim, positions, midside, [&](const MidsidePlace& place, NodeIndex) {
        Point<3> sum = Point<3>::Zero();
        int n = 0;
        for (const NodeIndex node : place)
          if (node != no_corner) {
            sum += corners[node - element.n_midside];
            ++n;
          }
        const double k = static_cast<double>(parts.coordinates.size() + 1);
        const Point<3> off(bend / k, -bend / (k + 1.0), element.dim == 3 ? bend / (k + 2.0) : 0.0);
        add(placed(sum / n) + off);
      });
  for (const Point<3>& corner : corners) add(placed(corner));
  row = positions;
  row.insert(row.end(), midside.begin(), midside.end());
  ElementList& list = parts.elements[static_cast<std::size_t>(element.dim)];
  list.append_nodes(row, element.n_corners);
  return parts;
}

AnyMesh mesh_of(const SecondOrder& element, double bend = 0.0) {
  return assemble_mesh("made here", one_cell(element, bend)).mesh;
}

class SecondOrderFile : public FileTest, public ::testing::WithParamInterface<SecondOrder> {
 protected:
  bool is_held(const std::string& extension) const {
    const auto& held = GetParam().extensions;
    return std::find(held.begin(), held.end(), extension) != held.end();
  }
  std::filesystem::path written(const std::string& extension, double bend = 0.0) const {
    const auto path = file("cell" + extension);
    write_mesh(path, mesh_of(GetParam(), bend), {}, {.binary = false});
    return path;
  }
};

TEST_P(SecondOrderFile, keeps_rows_and_every_bit_of_bent_nodes) {
  const AnyMesh mesh = mesh_of(GetParam(), 0.05);
  for (const auto& extension : GetParam().extensions)
    for (const auto version : {MshVersion::v2_2, MshVersion::v4_1}) {
      SCOPED_TRACE(extension);
      const auto path = file("cell" + extension);
      write_mesh(path, mesh, {}, {.msh_version = version});
      const AnyMesh again = read_mesh(path).mesh;
      const MeshView a(mesh), b(again);
      ASSERT_EQ(a.n_nodes(), b.n_nodes());
      for (NodeIndex i = 0; i < a.n_nodes(); ++i) EXPECT_EQ(a.point(i), b.point(i));
      EXPECT_EQ(a.topology().cells(), b.topology().cells());
      EXPECT_EQ(*a.topology().midside(), *b.topology().midside());
    }
}

TEST_P(SecondOrderFile, is_refused_with_a_sentence_where_a_format_has_no_such_element) {
  for (const std::string extension : {".msh", ".vtk", ".vtu", ".inp", ".mesh", ".ucd"})
    if (!is_held(extension)) {
      EXPECT_THAT(input_error_of([&] { written(extension); }), ::testing::HasSubstr("use"));
      EXPECT_FALSE(std::filesystem::exists(file("cell" + extension)));
    }
}

/// Returns the cell of a file as VTK reads it.
template <class Reader>
vtkSmartPointer<vtkUnstructuredGrid> read_by_vtk(const std::filesystem::path& path) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

TEST_P(SecondOrderFile, is_straight_for_vtk) {
  for (const std::string extension : {".vtk", ".vtu"}) {
    if (!is_held(extension)) continue;
    const auto path = written(extension);
    const auto grid = extension == ".vtk" ? read_by_vtk<vtkUnstructuredGridReader>(path)
                                          : read_by_vtk<vtkXMLUnstructuredGridReader>(path);
    ASSERT_EQ(grid->GetNumberOfCells(), 1);
    vtkCell& cell = *grid->GetCell(0);
    ASSERT_EQ(cell.GetNumberOfPoints(),
              static_cast<vtkIdType>(GetParam().n_corners + GetParam().n_midside));
    // An affine function of the parametric coordinates, found from four points.
    const auto at = [&](double r, double s, double t) {
      Point<3> x;
      int sub = 0;
      std::vector<double> weights(static_cast<std::size_t>(cell.GetNumberOfPoints()));
      const double parameters[3] = {r, s, t};
      cell.EvaluateLocation(sub, parameters, x.data(), weights.data());
      return x;
    };
    // VTK's pyramids are collapsed cubes: only their base is affine.
    const bool is_pyramid = GetParam().n_corners == 5;
    const Point<3> o = at(0, 0, 0), dr = at(1, 0, 0) - o, ds = at(0, 1, 0) - o,
                   dt = GetParam().dim == 3 && !is_pyramid ? Point<3>(at(0, 0, 1) - o)
                                                           : Point<3>::Zero();
    for (const auto& [r, s, t] : {std::array{.2, .3, .4}, {.1, .6, .2}, {.5, .1, .3}}) {
      const double height = dt.isZero(0.0) ? 0.0 : t;
      const Point<3> expected = o + r * dr + s * ds + height * dt;
      EXPECT_LT((at(r, s, height) - expected).norm(), 1e-12);
    }
    if (is_pyramid) {
      EXPECT_LT((at(.5, .5, .5) - placed({.5, .5, .5})).norm(), 1e-12);
    }
  }
}

TEST_P(SecondOrderFile, is_straight_for_gmsh) {
  if (!is_held(".msh")) GTEST_SKIP() << "Gmsh has no such element";
  const auto path = written(".msh");
  const GmshSession session;
  gmsh::open(path.string());
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, GetParam().dim);
  ASSERT_EQ(types.size(), 1u);
  ASSERT_EQ(nodes[0].size(), GetParam().n_corners + GetParam().n_midside);
  std::vector<double> jacobians, determinants, points;
  const std::vector<double> at = GetParam().dim == 2
                                     ? std::vector{.2, .3, .0, .1, .6, .0, .4, .1, .0}
                                     : std::vector{.2, .3, .1, .1, .2, .3, .3, .1, .2};
  gmsh::model::mesh::getJacobians(types[0], at, jacobians, determinants, points);
  ASSERT_EQ(determinants.size(), 3u);
  for (const double determinant : determinants) {
    EXPECT_GT(determinant, 0.0);
    EXPECT_NEAR(determinant, determinants[0], 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Second, SecondOrderFile, elements,
                         [](const auto& info) { return info.param.name; });

// --- Of other programs ---------------------------------------------------------------------------

using SecondOrderRead = FileTest;

TEST_F(SecondOrderRead, lagrange_cells_of_vtk_with_both_orders_of_hexahedra) {
  const auto path = file("cell.vtk");
  const SecondOrder hexahedron{"HEX27", 3, 8, 19};
  const AnyMesh mesh = mesh_of(hexahedron);
  write_mesh(path, mesh, {}, {.binary = false});
  std::string text = content_of(path);
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, text.npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("CELL_TYPES 1\n29", "CELL_TYPES 1\n72");
  const MidsideNodes expected = *MeshView(mesh).topology().midside();
  const auto read = read_mesh(file_with("lagrange.vtk", text));
  EXPECT_EQ(*MeshView(read.mesh).topology().midside(), expected);
  EXPECT_THAT(read.notes, ::testing::Contains(::testing::HasSubstr("Lagrange cells become")));
  // The edges 2-6 and 3-7 have nodes 10 and 11 here.
  replace(" 10 11 ", " 11 10 ");
  EXPECT_EQ(*MeshView(read_mesh(file_with("older.vtk", text)).mesh).topology().midside(), expected);
}

TEST_F(SecondOrderRead, linear_lagrange_cells_of_vtk) {
  const auto path =
      file_with("cell.vtk",
                "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
                "0 0 0 1 0 0 1 1 0 0 1 0\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n70\n");
  const auto read = read_mesh(path);
  EXPECT_EQ(MeshView(read.mesh).topology().midside(), nullptr);
  EXPECT_EQ(MeshView(read.mesh).topology().cell_type(0), ElementType::quadrilateral);
}

/// A triangle whose edge 1-2 is a labelled line, by rows of an input file of Abaqus.
std::string triangle_with_line(const std::string& line) {
  return "*NODE\n1, 0, 0\n2, 2, 0\n3, 0, 2\n4, 1, 0\n5, 1, 1\n6, 0, 1\n"
         "*ELEMENT, TYPE=CPS6\n1, 1, 2, 3, 4, 5, 6\n"
         "*ELEMENT, TYPE=T2D3, ELSET=bottom\n2, " +
         line + "\n";
}

TEST_F(SecondOrderRead, lines_of_abaqus_with_their_middle_in_the_middle_or_at_the_end) {
  for (const std::string line : {"1, 4, 2", "1, 2, 4"}) {
    const AnyMesh mesh = read_mesh(file_with("line.inp", triangle_with_line(line))).mesh;
    const Topology& topology = MeshView(mesh).topology();
    ASSERT_EQ(topology.labels().facets.size(), 1u);
    EXPECT_THAT(topology.labels().facets[0], ::testing::ElementsAre(0, 1));
    EXPECT_THAT(topology.midside()->of_facets[0], ::testing::ElementsAre(3));
  }
}

/// A triangle in a plane of its own. Abaqus allows empty fields, and nodes without an element.
TEST_F(SecondOrderRead, nodes_of_abaqus_with_empty_coordinates_and_off_the_plane) {
  const std::string text =
      "*NODE\n1, 0, , 0,\n2, 2, 0, ,0\n3, 0, 2\n4, 1, 0\n5, 1, 1\n6, 0, 1\n7, 1, 1, -0.5\n"
      "*ELEMENT, TYPE=CAX6\n1, 1, 2, 3, 4, 5, 6\n*NSET, NSET=pole\n7\n"
      "*ELEMENT, TYPE=D\n2, 0, 7, 1\n";
  const MeshFile read = read_mesh(file_with("axis.inp", text));
  EXPECT_THAT(read.notes, ::testing::IsSupersetOf({"2 empty coordinates are read as 0",
                                                   "1 element of type D is left out, as it is "
                                                   "no cell"}));
  ASSERT_TRUE(std::holds_alternative<PlanarMesh>(read.mesh));
  const Topology& topology = MeshView(read.mesh).topology();
  EXPECT_THAT(topology.midside_nodes(0), ::testing::ElementsAre(3, 4, 5));
  const auto path = file("written.inp");
  write_mesh(path, read.mesh);
  std::ifstream written(path);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(written), {}), text);
  write_mesh(file("written.vtu"), read.mesh);
  EXPECT_TRUE(std::holds_alternative<PlanarMesh>(read_mesh(file("written.vtu")).mesh));
}

/// Moves the first node of a file of Abaqus and returns the new text.
std::string text_with_first_node_at(double x, const std::filesystem::path& path) {
  MeshFile read = read_mesh(path);
  std::get<PlanarMesh>(read.mesh).coordinates()[0].x() = x;
  write_mesh(path, read.mesh);
  std::ifstream written(path);
  return {std::istreambuf_iterator<char>(written), {}};
}

TEST_F(SecondOrderRead, lines_of_abaqus_that_are_no_nodes_of_the_mesh_stay) {
  const std::string nodes = ", 0\n2, 2, 0\n3, 0, 2\n4, 1, 0\n5, 1, 1\n6, 0, 1\n",
                    blanks = " *ELEMENT, TYPE=CPS6\n1, 1, 2, 3, 4, 5, 6\n *NSET, NSET=a\n1, 2\n";
  EXPECT_EQ(text_with_first_node_at(0.25, file_with("blanks.inp", " *NODE\n1, 0" + nodes + blanks)),
            " *NODE\n1, 0.25" + nodes + blanks);
  const std::string part = "*PART, NAME=P\n*NODE\n1, 0",
                    rest =
                        "*ELEMENT, TYPE=CPS6\n1, 1, 2, 3, 4, 5, 6\n*END PART\n"
                        "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n"
                        "*NODE\n1, 7, 8, 9\n*END ASSEMBLY\n";
  EXPECT_EQ(text_with_first_node_at(0.25, file_with("part.inp", part + nodes + rest)),
            "*PART, NAME=P\n*NODE\n1, 0.25" + nodes + rest);
  const std::string other = "*PART, NAME=Q\n*NODE\n1, 7, 8\n*END PART\n";
  EXPECT_THAT(text_with_first_node_at(0.25, file_with("parts.inp", other + part + nodes + rest)),
              ::testing::Not(::testing::HasSubstr("*PART")));
}

TEST_F(SecondOrderRead, meshes_of_lines_are_refused_with_their_number) {
  const std::string text = "*NODE\n1, 0, 0\n2, 1, 0\n3, 2, 0\n*ELEMENT, TYPE=B32\n1, 1, 2, 3\n";
  EXPECT_THAT(input_error_of([&] { read_mesh(file_with("beam.inp", text)); }),
              ::testing::HasSubstr("the mesh has no cells, only 1 line; use"));
}

TEST_F(SecondOrderRead, clockwise_cells_are_turned_with_their_midside_nodes) {
  const std::string text =
      "*NODE\n1, 0, 0\n2, 2, 0\n3, 0, 2\n4, 1, 0\n5, 1, 1\n6, 0, 1\n"
      "*ELEMENT, TYPE=CPS6\n1, 1, 3, 2, 6, 5, 4\n";
  const MeshFile read = read_mesh(file_with("turned.inp", text));
  EXPECT_THAT(read.notes, ::testing::Contains(::testing::HasSubstr("turned over 1 of 1")));
  const Topology& topology = MeshView(read.mesh).topology();
  EXPECT_THAT(topology.cell_nodes(0), ::testing::ElementsAre(0, 1, 2));
  EXPECT_THAT(topology.midside_nodes(0), ::testing::ElementsAre(3, 4, 5));
}

TEST_F(SecondOrderRead, coincident_midside_nodes_are_merged_with_their_corners) {
  const std::string text =
      "*NODE\n1, 0, 0\n2, 2, 0\n3, 0, 2\n4, 1, 0\n5, 1, 1\n6, 0, 1\n"
      "7, 2, 0\n8, 2, 2\n9, 0, 2\n10, 2, 1\n11, 1, 2\n12, 1, 1\n"
      "*ELEMENT, TYPE=CPS6\n1, 1, 2, 3, 4, 5, 6\n2, 7, 8, 9, 10, 11, 12\n";
  const MeshFile read = read_mesh(file_with("seam.inp", text), {.merges = true});
  EXPECT_EQ(MeshView(read.mesh).n_nodes(), 9u);
  EXPECT_EQ(MeshView(read.mesh).topology().midside_nodes(1)[2], 4u);
}

TEST_F(SecondOrderRead, edges_with_two_midside_nodes_are_refused) {
  const std::string text =
      "*NODE\n1, 0, 0\n2, 2, 0\n3, 0, 2\n4, 1, 0\n5, 1, 1\n6, 0, 1\n8, 2, 2\n10, 2, 1\n"
      "11, 1, 2\n12, 1, 1\n"
      "*ELEMENT, TYPE=CPS6\n1, 1, 2, 3, 4, 5, 6\n2, 2, 8, 3, 10, 11, 12\n";
  EXPECT_THAT(input_error_of([&] { read_mesh(file_with("seam.inp", text)); }),
              ::testing::HasSubstr("on the edge between nodes"));
}

}  // namespace
}  // namespace smoothfem
