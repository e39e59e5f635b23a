// SPDX-License-Identifier: GPL-3.0-or-later
// Binary .msh files written byte by byte, and files that announce more than they hold.
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "meshes/tests/mesh_tests.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;

/// Writes the bytes of a binary file in one of the two byte orders.
class Bytes {
 public:
  explicit Bytes(bool is_swapped) : is_swapped_(is_swapped) {}

  Bytes& text(const std::string& words) {
    content_ += words;
    return *this;
  }
  template <class Number>
  Bytes& add(std::initializer_list<Number> values) {
    for (const Number value : values) {
      char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      if (is_swapped_) std::reverse(bytes, bytes + sizeof value);
      content_.append(bytes, sizeof value);
    }
    return *this;
  }
  Bytes& ints(std::initializer_list<std::int32_t> values) { return add(values); }
  Bytes& sizes(std::initializer_list<std::uint64_t> values) { return add(values); }
  Bytes& reals(std::initializer_list<double> values) { return add(values); }

  const std::string& content() const { return content_; }

 private:
  std::string content_;
  bool is_swapped_;
};

const std::string names = "$PhysicalNames\n1\n2 6 \"sheet\"\n$EndPhysicalNames\n";

/// A unit square of two triangles with nodes 7, 8, 9, 4. counts: values that replace the right
/// ones.
struct Counts {
  std::uint64_t blocks = 1, nodes = 4, nodes_in_block = 4, elements = 2, elements_in_block = 2,
                entities = 1, groups = 1;
};

std::string binary_4(bool is_swapped, const Counts& n = {}) {
  Bytes file(is_swapped);
  file.text("$MeshFormat\n4.1 1 8\n").ints({1}).text("\n$EndMeshFormat\n" + names);
  file.text("$Entities\n").sizes({0, 0, n.entities, 0}).ints({3}).reals({0, 0, 0, 1, 1, 0});
  file.sizes({n.groups}).ints({6}).sizes({0}).text("\n$EndEntities\n");
  file.text("$Nodes\n").sizes({n.blocks, n.nodes, 4, 9}).ints({2, 3, 1}).sizes({n.nodes_in_block});
  file.sizes({7, 8, 9, 4}).reals({0, 0, 0, -1, -1}).reals({1, 0, 0, -1, -1});
  file.reals({1, 1, 0, -1, -1}).reals({0, 1, 0, -1, -1}).text("\n$EndNodes\n");
  file.text("$Elements\n").sizes({n.blocks, n.elements, 1, 2});
  file.ints({2, 3, 2}).sizes({n.elements_in_block, 1, 7, 8, 9, 2, 7, 9, 4});
  return file.text("\n$EndElements\n").content();
}

std::string binary_2(bool is_swapped, const Counts& n = {}) {
  const auto narrow = [](std::uint64_t value) { return static_cast<std::int32_t>(value); };
  Bytes file(is_swapped);
  file.text("$MeshFormat\n2.2 1 8\n").ints({1}).text("\n$EndMeshFormat\n" + names);
  file.text("$Nodes\n" + std::to_string(n.nodes) + "\n").ints({7}).reals({0, 0, 0});
  file.ints({8}).reals({1, 0, 0}).ints({9}).reals({1, 1, 0}).ints({4}).reals({0, 1, 0});
  file.text("\n$EndNodes\n$Elements\n" + std::to_string(n.elements) + "\n");
  file.ints({2, narrow(n.elements_in_block), 2 * narrow(n.groups)});
  file.ints({1, 6, 3, 7, 8, 9}).ints({2, 6, 3, 7, 9, 4});
  return file.text("\n$EndElements\n").content();
}

using MshEncodings = FileTest;

TEST_F(MshEncodings, BinaryFilesOfBothByteOrdersAreRead) {
  for (auto* const file_of : {&binary_2, &binary_4})
    for (const bool is_swapped : {false, true}) {
      const PlanarFile read = read_planar(file_with("a.msh", (*file_of)(is_swapped, {})));
      EXPECT_EQ(read.mesh.copied_coordinates()[0], Point<2>(0, 1)) << "node 4 comes first";
      EXPECT_EQ(read.mesh.copied_coordinates()[3], Point<2>(1, 1));
      EXPECT_EQ(read.mesh.topology().cells().entries(), (std::vector<NodeIndex>{1, 2, 3, 1, 3, 0}));
      const MeshLabels& labels = read.mesh.topology().labels();
      EXPECT_EQ(labels.cell_tags, (std::vector<int>{6, 6}));
      EXPECT_EQ(labels.node_ids, (std::vector<std::size_t>{4, 7, 8, 9}));
      EXPECT_EQ(labels.names.at({2, 6}), "sheet");
    }
}

struct Greedy {
  std::string name, content;
  friend void PrintTo(const Greedy& parameter, std::ostream* out) { *out << parameter.name; }
};

class GreedyMsh : public FileTest, public ::testing::WithParamInterface<Greedy> {};

TEST_P(GreedyMsh, IsRefusedWithoutAllocatingTheAnnouncedMemory) {
  const auto path = file_with("a.msh", GetParam().content);
  const std::string message = [&] {
    const LittleMemory memory(32 << 20);
    return input_error_of([&] { read_mesh(path); });
  }();
  EXPECT_THAT(message, ::testing::StartsWith(path.string() + ":"));
  EXPECT_THAT(message, ::testing::Not(HasSubstr("too large"))) << "out of memory";
}

constexpr std::uint64_t billion = 1'000'000'000, enormous = 0x7fff'ffff'ffff'ffff;

std::string text_4(const std::string& right, const std::string& wrong) {
  std::string content =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 6 \"sheet\"\n$EndPhysicalNames\n"
      "$Entities\n0 0 1 0\n3 0 0 0 1 1 0 1 6 0\n$EndEntities\n$Nodes\n1 3 1 3\n2 3 0 3\n1\n2\n3\n"
      "0 0 0\n1 0 0\n0 1 0\n$EndNodes\n$Elements\n1 1 1 1\n2 3 2 1\n1 1 2 3\n$EndElements\n";
  return content.replace(content.find(right), right.size(), wrong);
}

std::string text_4_0(const std::string& right, const std::string& wrong) {
  std::string content =
      "$MeshFormat\n4 0 8\n$EndMeshFormat\n$Entities\n1 0 1 0\n1 0 0 0 0 0 0 0\n"
      "3 0 0 0 1 1 0 1 6 0\n$EndEntities\n$Nodes\n1 3\n3 2 0 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
      "$EndNodes\n$Elements\n1 1\n3 2 2 1\n1 1 2 3\n$EndElements\n";
  return content.replace(content.find(right), right.size(), wrong);
}

std::string text_2(const std::string& right, const std::string& wrong) {
  std::string content =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
      "$Elements\n1\n1 2 2 6 1 1 2 3\n$EndElements\n";
  return content.replace(content.find(right), right.size(), wrong);
}

INSTANTIATE_TEST_SUITE_P(
    Msh, GreedyMsh,
    ::testing::ValuesIn(std::vector<Greedy>{
        {"nodes_2b", binary_2(false, {.nodes = billion})},
        {"elements_2b", binary_2(false, {.elements = billion})},
        {"elements_in_block_2b",
         binary_2(false, {.elements = billion, .elements_in_block = billion})},
        {"tags_2b", binary_2(false, {.groups = billion})},
        {"blocks_4b", binary_4(false, {.blocks = enormous})},
        {"nodes_4b", binary_4(false, {.nodes = enormous, .nodes_in_block = enormous})},
        {"elements_4b", binary_4(false, {.elements = enormous, .elements_in_block = enormous})},
        {"entities_4b", binary_4(false, {.entities = enormous})},
        {"groups_4b", binary_4(false, {.groups = enormous})},
        {"names_4t", text_4("Names\n1", "Names\n1000000000")},
        {"entities_4t", text_4("0 0 1 0\n3", "0 0 1000000000 0\n3")},
        {"groups_4t", text_4("0 1 6 0", "0 1000000000 6 0")},
        {"node_blocks_4t", text_4("1 3 1 3", "1000000000 3 1 3")},
        {"nodes_4t", text_4("2 3 0 3", "2 3 0 1000000000")},
        {"element_blocks_4t", text_4("1 1 1 1\n", "1000000000 1 1 1\n")},
        {"elements_4t", text_4("2 3 2 1\n", "2 3 2 9223372036854775807\n")},
        {"entities_4_0", text_4_0("1 0 1 0\n1", "1 0 1000000000 0\n1")},
        {"groups_4_0", text_4_0("0 1 6 0", "0 1000000000 6 0")},
        {"node_blocks_4_0", text_4_0("1 3\n3 2", "1000000000 3\n3 2")},
        {"nodes_4_0", text_4_0("3 2 0 3", "3 2 0 1000000000")},
        {"element_blocks_4_0", text_4_0("1 1\n3 2 2 1", "1000000000 1\n3 2 2 1")},
        {"elements_4_0", text_4_0("3 2 2 1\n", "3 2 2 9223372036854775807\n")},
        {"nodes_2t", text_2("Nodes\n3", "Nodes\n1000000000")},
        {"elements_2t", text_2("Elements\n1", "Elements\n1000000000")},
        {"tags_2t", text_2("1 2 2 6", "1 2 1000000000 6")}}),
    [](const auto& info) { return info.param.name; });

TEST_F(MshEncodings, RightCountsAreNotRefused) {
  EXPECT_EQ(read_planar(file_with("a.msh", text_4("0 1 0\n", "0 1 0\n"))).mesh.n_cells(), 1u);
  EXPECT_EQ(read_planar(file_with("a.msh", text_4_0("3 0 1 0", "3 0 1 0"))).mesh.n_cells(), 1u);
  EXPECT_EQ(read_planar(file_with("a.msh", text_2("3 0 1 0", "3 0 1 0"))).mesh.n_cells(), 1u);
}

/// Memory is a small multiple of the file's size, even if the file consists of the smallest records
/// only.
TEST_F(MshEncodings, MemoryIsASmallMultipleOfTheFile) {
  constexpr std::size_t n = 200'000;
  std::string content =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n" + std::to_string(n) + " 0 0 0\n";
  for (std::size_t i = 0; i < n; ++i) content += "1 0 0 0 1 1\n";
  content += "$EndEntities\n$Nodes\n" + std::to_string(n) + " 0 0 0\n";
  for (std::size_t i = 0; i < n; ++i) content += "0 1 0 0\n";
  content += "$EndNodes\n$Elements\n0 0 0 0\n$EndElements\n";
  const auto path = file_with("a.msh", content);
  const std::string message = [&] {
    const LittleMemory memory(10 * content.size());
    return input_error_of([&] { read_mesh(path); });
  }();
  EXPECT_THAT(message, HasSubstr("the mesh has no cells"));
}

}  // namespace
}  // namespace smoothfem
