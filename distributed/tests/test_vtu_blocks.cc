// SPDX-License-Identifier: GPL-3.0-or-later
// A declaration in a file makes the first rank read it alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "distributed/distributed_mesh.h"
#include "distributed/files/pieces.h"
#include "distributed/partition.h"
#include "distributed/tests/example_meshes.h"
#include "distributed/tests/folder.h"
#include "distributed/tests/scattered.h"
#include "distributed/tests/smooth_pieces.h"
#include "meshes/io/mesh_file.h"
#include "smoothing/loop/smooth.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;
using test::all_ranks;
using test::box_mesh;
using test::BoxCells;
using test::content_of;
using test::Folder;
using test::grid_mesh;
using test::GridCells;
using test::numbered_mesh;
using test::two_materials;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// How VTK writes a file.
struct Encoding {
  const char* name;
  bool is_appended, is_base64, is_compressed, has_long_headers, has_floats;
};
constexpr std::array encodings{Encoding{"inline", false, true, false, true, false},
                               Encoding{"inline_zlib", false, true, true, false, false},
                               Encoding{"raw", true, false, false, false, false},
                               Encoding{"raw_zlib", true, false, true, true, true},
                               Encoding{"base64", true, true, false, false, true},
                               Encoding{"base64_zlib", true, true, true, false, false}};

vtkSmartPointer<vtkUnstructuredGrid> grid_in(const fs::path& path) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0u) << path;
  return reader->GetOutput();
}

/// VTK reads a file and writes it in an encoding.
void encode(const fs::path& from, const Encoding& encoding, const fs::path& to) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  const auto grid = grid_in(from);
  if (encoding.has_floats) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToFloat();
    for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
      points->InsertNextPoint(grid->GetPoint(i));
    grid->SetPoints(points);
  }
  writer->SetInputData(grid);
  writer->SetFileName(to.c_str());
  if (encoding.is_appended)
    writer->SetDataModeToAppended();
  else
    writer->SetDataModeToBinary();
  writer->SetEncodeAppendedData(encoding.is_base64);
  if (!encoding.is_compressed) writer->SetCompressorTypeToNone();
  writer->SetBlockSize(4096);
  if (encoding.has_long_headers)
    writer->SetHeaderTypeToUInt64();
  else
    writer->SetHeaderTypeToUInt32();
  ASSERT_EQ(writer->Write(), 1);
}

/// Changes the content of a file, on the root.
template <class Change>
void change(const fs::path& from, const fs::path& to, const Change& by) {
  all_ranks().on_root([&] {
    std::string bytes = content_of(from);
    by(bytes);
    std::ofstream(to, std::ios::binary) << bytes;
  });
}

void declare(std::string& bytes) {
  bytes.insert(bytes.find("<VTKFile"), "<!DOCTYPE VTKFile>");
}
void add_comment(std::string& bytes) {
  bytes.insert(bytes.find("<Piece"), "<!-- a > b, written by \"VTK -->");
}

std::vector<std::size_t> of_all(const std::optional<NodeDirectory<std::size_t>>& directory) {
  if (!directory) return {};
  std::vector<GlobalIndex> numbers(directory->n());
  std::iota(numbers.begin(), numbers.end(), 0);
  return directory->ask(numbers, [](std::size_t id) { return id; });
}

template <int dim>
void expect_equal(const ScatteredMesh<dim>& found, const ScatteredMesh<dim>& expected) {
  EXPECT_EQ(found.n_cells, expected.n_cells);
  EXPECT_EQ(found.fixes_boundary, expected.fixes_boundary);
  EXPECT_EQ(all_cells(all_ranks(), found), all_cells(all_ranks(), expected));
  ASSERT_EQ(found.nodes.n(), expected.nodes.n());
  for (std::size_t i = 0; i < found.nodes.entries().size(); ++i) {
    const auto &a = found.nodes.entries()[i], &b = expected.nodes.entries()[i];
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.reasons, b.reasons);
    EXPECT_EQ(a.owner, b.owner);
  }
  EXPECT_LE(
      all_ranks().max(static_cast<double>(found.cells.size())) * all_ranks().size(),
      static_cast<double>(found.n_cells + static_cast<std::size_t>(all_ranks().size())) * 1.2);
}

template <class Arrays>
void expect_equal_arrays(Arrays& found, Arrays& expected) {
  ASSERT_EQ(found.GetNumberOfArrays(), expected.GetNumberOfArrays());
  for (int k = 0; k < found.GetNumberOfArrays(); ++k) {
    auto &a = *found.GetArray(k), &b = *expected.GetArray(k);
    EXPECT_STREQ(a.GetName(), b.GetName());
    ASSERT_EQ(a.GetNumberOfValues(), b.GetNumberOfValues());
    for (vtkIdType i = 0; i < a.GetNumberOfValues(); ++i)
      EXPECT_EQ(a.GetVariantValue(i).ToDouble(), b.GetVariantValue(i).ToDouble());
  }
}

/// Moves the nodes of a file; compares the result with that of the first rank, and, as VTK reads
/// it, with the file.
template <int dim>
void expect_same_copy(const fs::path& path, const fs::path& declared) {
  const fs::path out = path.parent_path() / "out.vtu", other = path.parent_path() / "other.vtu";
  const auto write = [&](const fs::path& from, const fs::path& to) {
    const Pieces pieces(all_ranks(), from);
    auto mesh = std::get<ScatteredMesh<dim>>(pieces.read());
    for (NodeEntry<dim>& entry : mesh.nodes.entries())
      entry.x[0] += 0.1 * std::sin(entry.x[1] + 1.0);
    pieces.template write<dim>(to, mesh.nodes);
  };
  write(path, out);
  write(declared, other);
  all_ranks().on_root([&] {
    const auto points = [](const fs::path& file) {
      return std::get<Mesh<dim>>(read_mesh(file, {.turns_over = false}).mesh).copied_coordinates();
    };
    EXPECT_EQ(points(out), points(other)) << path;
    const auto copy = grid_in(out), old = grid_in(path), alone = grid_in(other);
    ASSERT_EQ(copy->GetNumberOfPoints(), old->GetNumberOfPoints());
    EXPECT_EQ(copy->GetPoints()->GetDataType(), VTK_DOUBLE);
    for (vtkIdType i = 0; i < copy->GetNumberOfPoints(); ++i)
      for (int d = 0; d < 3; ++d) EXPECT_EQ(copy->GetPoint(i)[d], alone->GetPoint(i)[d]) << path;
    expect_equal_arrays(*copy->GetPointData(), *old->GetPointData());
    expect_equal_arrays(*copy->GetCellData(), *old->GetCellData());
    ASSERT_EQ(copy->GetNumberOfCells(), old->GetNumberOfCells());
    for (vtkIdType c = 0; c < copy->GetNumberOfCells(); ++c) {
      EXPECT_EQ(copy->GetCellType(c), old->GetCellType(c));
      vtkNew<vtkIdList> a, b;
      copy->GetCellPoints(c, a);
      old->GetCellPoints(c, b);
      EXPECT_TRUE(std::equal(a->begin(), a->end(), b->begin(), b->end()));
    }
    const std::string bytes = content_of(out);
    for (const char* of_old_points : {"RangeMin", "_RANGE"})
      EXPECT_GT(bytes.find(of_old_points, bytes.find("<Points")), bytes.find("</Points"));
  });
}

/// Compares a mesh in all encodings with what the first rank reads.
template <int dim>
void expect_same_as_alone(const Mesh<dim>& mesh) {
  const Folder folder;
  const fs::path path = folder / "mesh.vtu", declared = folder / "declared.vtu";
  all_ranks().on_root([&] { write_mesh(folder / "own.vtu", mesh); });
  for (const Encoding& encoding : encodings) {
    all_ranks().on_root([&] { encode(folder / "own.vtu", encoding, path); });
    change(path, declared, declare);
    change(path, path, add_comment);
    EXPECT_EQ(file_blocks(all_ranks(), path)->obstacle(), "") << encoding.name;
    EXPECT_EQ(file_blocks(all_ranks(), declared)->obstacle(), "it declares a type of documents");
    for (const ReadFor purpose : {ReadFor::smoothing, ReadFor::examination}) {
      const auto found = std::get<ScatteredMesh<dim>>(Pieces(all_ranks(), path).read(purpose)),
                 expected =
                     std::get<ScatteredMesh<dim>>(Pieces(all_ranks(), declared).read(purpose));
      expect_equal(found, expected);
      const bool has_ids = found.node_ids.has_value();
      EXPECT_EQ(has_ids,
                purpose == ReadFor::examination && !mesh.topology().labels().node_ids.empty());
      if (!has_ids) continue;
      EXPECT_EQ(of_all(found.node_ids), of_all(expected.node_ids));
      EXPECT_EQ(of_all(found.cell_ids), of_all(expected.cell_ids));
    }
    expect_same_copy<dim>(path, declared);
  }
}

TEST(VtuBlocks, PlanarMeshesAreThoseOfOneReader) {
  expect_same_as_alone(two_materials(grid_mesh(6, GridCells::mixed), 0.3, 3));
}

/// Prisms, and numbers, labelled facets and a node that no cell has.
TEST(VtuBlocks, MixedMeshesAreThoseOfOneReader) {
  expect_same_as_alone(numbered_mesh());
}

/// In the mirrored mesh, most volumes are positive in Gmsh's order of the corners.
TEST(VtuBlocks, PrismsMayHaveTheOrderOfGmsh) {
  const Folder folder;
  const fs::path path = folder / "mesh.vtu", declared = folder / "declared.vtu";
  const auto mesh = numbered_mesh();
  all_ranks().on_root([&] {
    auto mirrored = mesh.copied_coordinates();
    for (Point<3>& point : mirrored) point.x() = -point.x();
    write_mesh(path, VolumeMesh(mesh.shared_topology(), std::move(mirrored)));
  });
  change(path, declared, declare);
  change(path, path, add_comment);
  const auto read = [](const fs::path& file) {
    return std::get<ScatteredMesh<3>>(Pieces(all_ranks(), file).read());
  };
  const auto found = read(path);
  expect_equal(found, read(declared));
  all_ranks().on_root([&] { write_mesh(path, mesh); });
  const auto cells = all_cells(all_ranks(), found),
             unmirrored = all_cells(all_ranks(), read(path));  // on the root
  EXPECT_EQ(cells != unmirrored, all_ranks().is_root());
}

TEST(VtuBlocks, TetrahedraAreThoseOfOneReader) {
  expect_same_as_alone(two_materials(box_mesh(3, 3, 3, BoxCells::tetrahedra), 0.2, 3));
}

/// The points fill more than one block.
TEST(VtuBlocks, HexahedraAreThoseOfOneReader) {
  expect_same_as_alone(two_materials(box_mesh(11, 11, 10, BoxCells::hexahedra), 0.2, 3));
}

TEST(VtuBlocks, SmoothedMeshesAreThoseOfOneReader) {
  const Folder folder;
  all_ranks().on_root([&] {
    write_mesh(folder / "mesh.vtu", two_materials(box_mesh(4, 3, 3, BoxCells::tetrahedra), 0.3, 4));
  });
  change(folder / "mesh.vtu", folder / "declared.vtu", declare);
  const auto smoothed = [&](const char* name, const char* out) {
    const Pieces pieces(all_ranks(), folder / name);
    test::smooth_pieces<3>(all_ranks(), pieces, folder / out, "smart-laplace");
    EXPECT_TRUE(!all_ranks().is_root() ||
                pieces.notes().empty() == (all_ranks().size() == 1 || name[0] == 'm'));
  };
  smoothed("mesh.vtu", "out.vtu");
  smoothed("declared.vtu", "other.vtu");
  all_ranks().on_root([&] {
    const auto mesh = [&](const char* name) {
      return std::get<VolumeMesh>(read_mesh(folder / name, {.turns_over = false}).mesh);
    };
    EXPECT_EQ(mesh("out.vtu").copied_coordinates(), mesh("other.vtu").copied_coordinates());
    EXPECT_NE(mesh("out.vtu").copied_coordinates(), mesh("mesh.vtu").copied_coordinates());
    EXPECT_EQ(content_of(folder / "out.vtu").size() <= content_of(folder / "mesh.vtu").size(),
              true);
  });
}

TEST(VtuBlocks, OtherFilesAreForTheFirstRank) {
  const Folder folder;
  const auto mesh = two_materials(box_mesh(2, 2, 2, BoxCells::tetrahedra), 0.1, 1);
  all_ranks().on_root([&] {
    write_mesh(folder / "text.vtu", mesh, {}, {.binary = false});
    write_mesh(folder / "mesh.vtu", mesh);
    encode(folder / "mesh.vtu", encodings[2], folder / "raw.vtu");
  });
  const auto expect = [&](const char* name, const char* obstacle) {
    EXPECT_THAT(file_blocks(all_ranks(), folder / name)->obstacle(), HasSubstr(obstacle)) << name;
  };
  const auto replaced = [&](const char* name, const std::string& from, const std::string& to) {
    change(folder / "mesh.vtu", folder / name, [&](std::string& bytes) {
      ASSERT_NE(bytes.find(from), bytes.npos);
      bytes.replace(bytes.find(from), from.size(), to);
    });
  };
  expect("text.vtu", "is text");
  replaced("ghosts.vtu", "\"physical_tag\"", "\"vtkGhostType\"");
  expect("ghosts.vtu", "ghost cells");
  replaced("required.vtu", "\"fixed\"", "\"required\"");
  expect("required.vtu", "'required' say which nodes must stay");
  replaced("ids.vtu", "<CellData>", "<CellData GlobalIds=\"physical_tag\">");
  expect("ids.vtu", "GlobalIds");
  replaced("big.vtu", "LittleEndian", "BigEndian");
  expect("big.vtu", "another byte order");
  replaced("pieces.vtu", "</Piece>", "</Piece><Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>");
  expect("pieces.vtu", "2 pieces");
  // All cells become quadratic ones.
  change(folder / "raw.vtu", folder / "curved.vtu", [&](std::string& bytes) {
    const std::size_t at = bytes.find(std::string(mesh.n_cells(), '\x0a'));
    ASSERT_NE(at, bytes.npos);
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), mesh.n_cells(), '\x18');
  });
  expect("curved.vtu", "second order or of unknown types");
  expect("missing.vtu", "no regular file");
}

TEST(VtuBlocks, DamagedFilesAreRefusedOnAllRanks) {
  const Folder folder;
  const auto mesh = two_materials(box_mesh(3, 3, 3, BoxCells::tetrahedra), 0.1, 1);
  all_ranks().on_root([&] { write_mesh(folder / "own.vtu", mesh); });
  const auto expect_refused = [&](const std::string& what) {
    EXPECT_THAT([&] { Pieces(all_ranks(), folder / "damaged.vtu").read(); },
                ThrowsMessage<InputError>(HasSubstr(what)));
    (void)all_ranks().any(false);
  };
  for (const Encoding& encoding : encodings) {
    all_ranks().on_root([&] { encode(folder / "own.vtu", encoding, folder / "mesh.vtu"); });
    for (const double share : {0.2, 0.6, 0.95, 0.99}) {
      change(folder / "mesh.vtu", folder / "damaged.vtu", [&](std::string& bytes) {
        bytes.resize(static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
      });
      expect_refused("damaged.vtu");
    }
    if (!encoding.is_compressed) continue;
    change(folder / "mesh.vtu", folder / "damaged.vtu", [&](std::string& bytes) {
      // Inside the points: of the inline data, or the appended ones behind one array of marks.
      const std::size_t begin =
          encoding.is_appended ? bytes.find("<AppendedData") : bytes.find("<Points");
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(begin + 450), 20, 'A');
    });
    expect_refused("damaged.vtu");
  }
  // A corner beyond all points, and an offset below the one before it.
  all_ranks().on_root([&] { encode(folder / "own.vtu", encodings[2], folder / "raw.vtu"); });
  const auto damage = [&](const char* name, std::int64_t value) {
    change(folder / "raw.vtu", folder / "damaged.vtu", [&](std::string& bytes) {
      const std::size_t tag = bytes.find("Name=\"" + std::string(name) + "\""),
                        offset = bytes.find("offset=\"", tag) + 8,
                        at = bytes.find('_', bytes.find("<AppendedData")) + 1 + 4 +
                             std::stoul(bytes.substr(offset)) + 8;
      bytes.replace(at, 8, reinterpret_cast<const char*>(&value), 8);
    });
  };
  damage("connectivity", 1 << 20);
  expect_refused("cell 0 names point 1048576, but the file has only 64 points");
  damage("offsets", 3);
  expect_refused("the array 'offsets' does not ascend at cell 1");
}

}  // namespace
}  // namespace smoothfem
