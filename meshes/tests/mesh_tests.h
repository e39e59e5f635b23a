// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "meshes/io/mesh_file.h"
#include "smoothing/base/input_error.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

inline void PrintTo(const MeshFormat& format, std::ostream* out) {
  *out << format.name;
}
inline void PrintTo(ElementType type, std::ostream* out) {
  *out << name_of(type);
}

namespace test {
/// True in the long tests (`./run test --all`).
inline bool is_long() {
  return std::getenv("SMOOTHFEM_LONG_TESTS") != nullptr;
}
/// Skips a test whose mesh has the size of the thesis, unless the long tests run.
#define SKIP_UNLESS_LONG() \
  if (!test::is_long()) GTEST_SKIP() << "run by the long tests"

/// Returns the sizes that a test takes: small ones, and in the long tests all.
inline std::vector<double> short_or_long(std::vector<double> small, std::vector<double> all) {
  return is_long() ? all : small;
}
}  // namespace test

/// Returns the content of a file; empty if it does not exist.
inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A separate folder for each test, removed afterwards.
class FileTest : public ::testing::Test {
 protected:
  FileTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("smoothfem-") + std::to_string(::getpid()) + "-" +
                       test->test_suite_name() + "-" + test->name();
    // Names of tests with parameters have slashes; removing a folder would leave its parent.
    std::replace(name.begin(), name.end(), '/', '-');
    folder_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::create_directories(folder_);
  }
  ~FileTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file(const std::string& name) const { return folder_ / name; }

  /// Number of files and subfolders in a folder of the test.
  std::size_t n_entries(const std::string& folder = "") const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(file(folder)), {}));
  }

  std::filesystem::path file_with(const std::string& name, const std::string& content) const {
    std::ofstream(file(name), std::ios::binary) << content;
    return file(name);
  }

 private:
  std::filesystem::path folder_;
};

/// Simulates a full disk: each file can have only so many bytes, by a limit on the size of files.
class FullDisk {
 public:
  explicit FullDisk(rlim_t n_bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &former_);
    const rlimit small = {n_bytes, former_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  void (*handler_)(int);
  rlimit former_;
};

/// Simulates a machine with so much memory more than this process has now, by a limit on its
/// address space.
class LittleMemory {
 public:
  explicit LittleMemory(rlim_t n_bytes) {
    getrlimit(RLIMIT_AS, &former_);
    rlim_t n_pages = 0;
    std::ifstream("/proc/self/statm") >> n_pages;
    const rlimit small = {n_pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + n_bytes,
                          former_.rlim_max};
    setrlimit(RLIMIT_AS, &small);
  }
  ~LittleMemory() { setrlimit(RLIMIT_AS, &former_); }
  LittleMemory(const LittleMemory&) = delete;
  LittleMemory& operator=(const LittleMemory&) = delete;

 private:
  rlimit former_;
};

/// Returns the message of the InputError that a call throws; empty if it throws none.
template <class Call>
std::string input_error_of(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// Two triangles, two quadrilaterals and a pentagon around node 4, whose coordinates need all
/// digits.
inline PlanarMesh mixed_mesh(bool with_pentagon, MeshLabels labels = {},
                             std::optional<std::vector<bool>> fixed = std::nullopt) {
  const std::vector<Point<2>> x = {{0, 0},   {1, 0}, {2, 0}, {0, 1}, {0.9 + 1e-16, 1.0 / 3.0},
                                   {2, 1.1}, {0, 2}, {1, 2}, {2, 2}, {-1.0 / 7.0, 1.5}};
  CompressedRows<NodeIndex> cells;
  cells.append(std::vector<NodeIndex>{0, 1, 4, 3});
  cells.append(std::vector<NodeIndex>{1, 2, 4});
  cells.append(std::vector<NodeIndex>{2, 5, 4});
  if (with_pentagon) {
    cells.append(std::vector<NodeIndex>{4, 7, 6, 9, 3});
    cells.append(std::vector<NodeIndex>{4, 5, 8, 7});
  } else {
    cells.append(std::vector<NodeIndex>{4, 5, 8, 7});
    cells.append(std::vector<NodeIndex>{3, 4, 7, 6});
    cells.append(std::vector<NodeIndex>{3, 6, 9});
  }
  return PlanarMesh(std::make_shared<const Topology>(2, x.size(), std::move(cells),
                                                     std::move(fixed), std::move(labels)),
                    x);
}

struct PlanarFile {
  PlanarMesh mesh;
  std::vector<std::size_t> cell_lines;
};

inline PlanarFile read_planar(const std::filesystem::path& path,
                              const MeshReadOptions& options = {}) {
  const MeshFile file = read_mesh(path, options);
  return {planar_mesh(file, path), file.cell_lines};
}

inline VolumeMesh read_volume(const std::filesystem::path& path,
                              const MeshReadOptions& options = {}) {
  return std::get<VolumeMesh>(read_mesh(path, options).mesh);
}

/// Returns the nodes that are free but for the interfaces between tags.
inline std::vector<NodeIndex> nodes_free_but_for_interfaces(const Topology& topology) {
  std::vector<NodeIndex> nodes;
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    if ((topology.fixed_reasons(i) & ~bit(FixedReason::interface)) == 0) nodes.push_back(i);
  return nodes;
}

template <int dim>
void expect_same_mesh(const Mesh<dim>& a, const Mesh<dim>& b) {
  EXPECT_EQ(a.copied_coordinates(), b.copied_coordinates());  // bit by bit
  EXPECT_EQ(a.topology().cells(), b.topology().cells());
  EXPECT_EQ(nodes_free_but_for_interfaces(a.topology()),
            nodes_free_but_for_interfaces(b.topology()));
}

/// Tags of all cells and two facets of mixed_mesh, and some names.
inline MeshLabels labels_of_mixed_mesh() {
  MeshLabels labels;
  labels.cell_tags = {7, 7, 3, 3, 7, 3};
  labels.facets.append(std::vector<NodeIndex>{1, 2});
  labels.facets.append(std::vector<NodeIndex>{0, 1});
  labels.facet_tags = {5, 4};
  labels.names = {{{2, 7}, "steel"}, {{2, 3}, "air gap"}, {{1, 5}, "inlet"}};
  return labels;
}

}  // namespace smoothfem
