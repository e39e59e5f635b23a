// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/files/vtu_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "meshes/io/node_order.h"
#include "meshes/io/vtk/vtk_grid.h"
#include "meshes/io/vtk/vtu_copy.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

constexpr std::size_t n_wedge_corners = 6;

/// Cells of a range of the file.
struct VtuRange {
  CellTable cells{};                    ///< of the mesh's dimension
  std::vector<std::size_t> ids{};       ///< of these, if the file has them
  std::vector<GlobalIndex> labelled{};  ///< nodes of tagged cells of lower dimension
};

/// Reads ranges of the cells.
class VtuCellReader {
 public:
  VtuCellReader(const FileParts& file, const VtuArrays& arrays, int dim)
      : path_(file.path().string()),
        arrays_(arrays),
        dim_(dim),
        offsets_(file, "offsets", arrays.offsets, arrays.packing),
        connectivity_(file, "connectivity", arrays.connectivity, arrays.packing),
        types_(file, "types", arrays.types, arrays.packing) {
    const auto open = [&](std::unique_ptr<VtuArrayParts>& array, const VtuPlace& place,
                          const char* name) {
      if (place.n > 0) array = std::make_unique<VtuArrayParts>(file, name, place, arrays.packing);
    };
    open(tags_, arrays.tags, "of the tags");
    open(lower_tags_, arrays.lower_tags, "of the tags");
    open(ids_, arrays.cell_ids, "cell_id");
  }

  VtuRange read(std::uint64_t first, std::uint64_t last, bool with_ids) {
    constexpr std::uint64_t at_once = 1 << 16;
    VtuRange range;
    for (; first < last; first += at_once)
      read_some(first, std::min(last, first + at_once), with_ids, range);
    return range;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(path_ + ": " + what); }

  static std::vector<std::int64_t> integers(VtuArrayParts& array, std::uint64_t first,
                                            std::uint64_t last) {
    std::vector<std::int64_t> result;
    result.reserve(last - first);
    array.read<std::int64_t>(first, last, false,
                             [&](std::int64_t value) { result.push_back(value); });
    return result;
  }

  /// As MeshField::number() gives them; nothing if the file has no such array.
  static std::vector<double> values(const std::unique_ptr<VtuArrayParts>& array,
                                    const VtuPlace& place, std::uint64_t first,
                                    std::uint64_t last) {
    std::vector<double> result;
    if (!array) return result;
    if (is_integer(place.type))
      array->read<AnyInteger>(first, last, false, [&](AnyInteger number) {
        result.push_back(static_cast<double>(number.value));
      });
    else
      array->read<AnyNumber>(first, last, false,
                             [&](AnyNumber number) { result.push_back(number.value); });
    return result;
  }

  /// Returns where the cells' corners begin, and the end of the last one.
  std::vector<std::int64_t> bounds(std::uint64_t first, std::uint64_t last) {
    auto bounds = integers(offsets_, first == 0 ? 0 : first - 1, last);
    if (first == 0) bounds.insert(bounds.begin(), 0);
    for (std::size_t i = 0; i + 1 < bounds.size(); ++i)
      if (bounds[i] < 0 || bounds[i + 1] < bounds[i] ||
          static_cast<std::uint64_t>(bounds[i + 1]) > arrays_.connectivity.n)
        fail("the array 'offsets' does not ascend at cell " + std::to_string(first + i) +
             "; the file is damaged");
    return bounds;
  }

  void read_some(std::uint64_t first, std::uint64_t last, bool with_ids, VtuRange& range) {
    const auto begins = bounds(first, last);
    const auto corners = integers(connectivity_, static_cast<std::uint64_t>(begins.front()),
                                  static_cast<std::uint64_t>(begins.back()));
    const auto types = integers(types_, first, last);
    const auto tags = values(tags_, arrays_.tags, first, last),
               lower_tags = values(lower_tags_, arrays_.lower_tags, first, last),
               ids = with_ids ? values(ids_, arrays_.cell_ids, first, last) : std::vector<double>();
    std::vector<GlobalIndex> row;
    for (std::size_t i = 0; i < types.size(); ++i) {
      const auto kind = vtk_cell_kind(static_cast<int>(types[i]));
      row.clear();
      for (auto k = begins[i]; k < begins[i + 1]; ++k) {
        const std::int64_t corner = corners[static_cast<std::size_t>(k - begins.front())];
        if (corner < 0 || static_cast<std::uint64_t>(corner) >= arrays_.n_points)
          fail("cell " + std::to_string(first + i) + " names point " + std::to_string(corner) +
               ", but the file has only " + std::to_string(arrays_.n_points) + " points");
        row.push_back(static_cast<GlobalIndex>(corner));
      }
      if (!kind || (kind->n_nodes != 0 && row.size() != kind->n_nodes))
        fail("cell " + std::to_string(first + i) + " has " + std::to_string(row.size()) +
             " nodes, but its type " + std::to_string(types[i]) + " has another number of them");
      const auto& of_cell = kind->dimension < dim_ && !lower_tags.empty() ? lower_tags : tags;
      const int tag = of_cell.empty() ? 0 : vtk_tag(of_cell[i]);
      if (kind->dimension == dim_) {
        range.cells.append(static_cast<GlobalIndex>(range.cells.size()), tag, row);
        if (!ids.empty()) range.ids.push_back(vtk_id(ids[i]));
      } else if (tag != 0) {
        range.labelled.insert(range.labelled.end(), row.begin(), row.end());
      }
    }
  }

  std::string path_;
  const VtuArrays& arrays_;
  int dim_;
  VtuArrayParts offsets_, connectivity_, types_;
  std::unique_ptr<VtuArrayParts> tags_{}, lower_tags_{}, ids_{};
};

/// Chooses the order of wedges as parts_of_grid(): that of Gmsh unless the one of VTK fits as well
/// or better. Collective.
void choose_wedge_order(const Ranks& ranks, ScatteredMesh<3>& mesh) {
  CellTable& cells = mesh.cells;
  std::vector<GlobalIndex> used;
  const auto is_wedge = [&](std::size_t c) { return cells[c].size() == n_wedge_corners; };
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (is_wedge(c)) used.insert(used.end(), cells[c].begin(), cells[c].end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const auto points = mesh.nodes.ask(used, [](const NodeEntry<3>& entry) { return entry.x; });
  std::int64_t votes = 0;  // for Gmsh's order
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!is_wedge(c)) continue;
    std::array<Point<3>, n_wedge_corners> x;
    for (std::size_t k = 0; k < x.size(); ++k)
      x[k] = Point<3>(
          points[static_cast<std::size_t>(std::lower_bound(used.begin(), used.end(), cells[c][k]) -
                                          used.begin())]
              .data());
    votes += signed_prism_volume(x) > 0.0 ? 1 : -1;
  }
  ranks.sum(std::span(&votes, 1));
  for (std::size_t c = 0; c < cells.size() && votes <= 0; ++c)
    if (is_wedge(c))
      permute(std::span(cells.corners).subspan(cells.offsets[c], n_wedge_corners), vtk_wedge);
}

}  // namespace

VtuBlocks::VtuBlocks(const Ranks& ranks, const std::filesystem::path& path)
    : ranks_(ranks), path_(path) {
  ranks_.on_root([&] { layout_ = vtu_layout(path); });
  std::vector<char> obstacle(layout_.obstacle.begin(), layout_.obstacle.end());
  ranks_.broadcast(obstacle);
  layout_.obstacle.assign(obstacle.begin(), obstacle.end());
  ranks_.broadcast(layout_.arrays);
  if (layout_.obstacle.empty()) check_types();
}

/// Finds the cells' dimension, and types that are obstacles.
void VtuBlocks::check_types() {
  std::array<std::int64_t, 256> n_of_type{};
  std::int64_t n_unknown = 0;
  try {
    ranks_.together([&] {
      const FileParts file(path_);
      VtuArrayParts types(file, "types", layout_.arrays.types, layout_.arrays.packing);
      types.read<std::int64_t>(first_of_share(ranks_, layout_.arrays.n_cells, ranks_.rank()),
                               first_of_share(ranks_, layout_.arrays.n_cells, ranks_.rank() + 1),
                               false, [&](std::int64_t type) {
                                 if (type >= 0 && type < 256)
                                   ++n_of_type[static_cast<std::size_t>(type)];
                                 else
                                   ++n_unknown;
                               });
    });
  } catch (const InputError&) {
    layout_.obstacle = "it is damaged";
    return;
  }
  ranks_.sum(n_of_type);
  ranks_.sum(std::span(&n_unknown, 1));
  constexpr int poly_vertex = 2, poly_line = 4, pixel = 8, voxel = 11;  // VTK's numbers
  int dimension = 0;
  for (int type = 0; type < 256; ++type) {
    if (n_of_type[static_cast<std::size_t>(type)] == 0) continue;
    const auto kind = vtk_cell_kind(type);
    if (!kind) ++n_unknown;
    if (type == poly_vertex || type == poly_line)
      layout_.obstacle = "it has lines or vertices of several nodes";
    if (type == pixel || type == voxel) layout_.obstacle = "it has pixels or voxels";
    if (kind) dimension = std::max(dimension, kind->dimension);
  }
  if (dimension < 2) layout_.obstacle = "it has no cells of dimension 2 or 3";
  if (n_unknown > 0) layout_.obstacle = "it has cells of second order or of unknown types";
  dimension_ = dimension;
}

template <int dim>
ScatteredMesh<dim> VtuBlocks::read_as(ReadFor purpose) {
  const VtuArrays& arrays = layout_.arrays;
  ScatteredMesh<dim> mesh{.nodes = NodeDirectory<NodeEntry<dim>>(ranks_, arrays.n_points),
                          .fixes_boundary = arrays.fixed.n == 0,
                          .is_compact = false};
  std::vector<std::size_t> node_ids;
  double least_z = std::numeric_limits<double>::infinity(), most_z = -least_z;
  bool is_flat = true;
  VtuRange range;
  ranks_.together([&] {
    const FileParts file(path_);
    auto& entries = mesh.nodes.entries();
    const std::uint64_t first = mesh.nodes.first(), last = first + entries.size();
    const auto open = [&](const char* name, const VtuPlace& place) {
      return VtuArrayParts(file, name, place, arrays.packing);
    };
    std::size_t i = 0;
    Point<3> point;
    Eigen::Index component = 0;
    open("Points", arrays.points).template read<double>(first, last, true, [&](double x) {
      point[component++] = x;
      if (component < 3) return;
      component = 0;
      entries[i++] = node_entry<dim>(point.template head<dim>(), FixedReasons{0});
      least_z = std::min(least_z, x);
      most_z = std::max(most_z, x);
      is_flat &= !std::isnan(x);
    });
    if (arrays.fixed.n > 0) {
      i = 0;
      open("fixed", arrays.fixed).template read<AnyNumber>(first, last, false, [&](AnyNumber mark) {
        if (mark.value != 0.0) entries[i].reasons |= bit(FixedReason::marked);
        ++i;
      });
    }
    if (purpose == ReadFor::examination && arrays.node_ids.n > 0)
      open("node_id", arrays.node_ids)
          .template read<AnyNumber>(first, last, false, [&](AnyNumber number) {
            const std::size_t id = vtk_id(number.value);
            node_ids.push_back(id != 0 ? id : first + node_ids.size());
          });
    range = VtuCellReader(file, arrays, dim)
                .read(first_of_share(ranks_, arrays.n_cells, ranks_.rank()),
                      first_of_share(ranks_, arrays.n_cells, ranks_.rank() + 1),
                      purpose == ReadFor::examination);
  });
  if (dim == 2 && (ranks_.any(!is_flat) || ranks_.max(most_z) != -ranks_.max(-least_z)))
    throw InputError(path_.string() +
                     ": a surface mesh cannot be handled in parts; use one file without mpirun");
  plane_ = ranks_.max(most_z);
  mesh.nodes.name(range.labelled,
                  [](NodeEntry<dim>& entry, int) { entry.reasons |= bit(FixedReason::interface); });
  mesh.cells = std::move(range.cells);
  mesh.n_cells = ranks_.sum(mesh.cells.size());
  const auto first_cell = static_cast<GlobalIndex>(ranks_.exclusive_scan(mesh.cells.size()));
  for (GlobalIndex& number : mesh.cells.numbers) number += first_cell;
  if constexpr (dim == 3) choose_wedge_order(ranks_, mesh);
  if (purpose == ReadFor::examination && arrays.node_ids.n > 0)
    mesh.node_ids.emplace(ranks_, arrays.n_points).entries() = std::move(node_ids);
  if (purpose == ReadFor::examination && arrays.cell_ids.n > 0) {
    for (std::size_t c = 0; c < range.ids.size(); ++c)
      if (range.ids[c] == 0) range.ids[c] = mesh.cells.numbers[c];
    mesh.cell_ids.emplace(ranks_, mesh.n_cells)
        .give(mesh.cells.numbers, range.ids,
              [](std::size_t& kept, std::size_t id, int) { kept = id; });
  }
  return mesh;
}

std::variant<ScatteredMesh<2>, ScatteredMesh<3>> VtuBlocks::read(ReadFor purpose) {
  if (dimension_ == 3) return read_as<3>(purpose);
  return read_as<2>(purpose);
}

template <int dim>
void VtuBlocks::write_as(const std::filesystem::path& out,
                         const NodeDirectory<NodeEntry<dim>>& directory) const {
  // Each rank packs a range of the blocks.
  constexpr std::uint64_t point_size = sizeof(double) * 3;
  const std::uint64_t n_bytes = point_size * layout_.arrays.n_points,
                      n_blocks = (n_bytes + vtu_block_size - 1) / vtu_block_size;
  const auto bound = [&](int rank) {
    return std::min(n_bytes, vtu_block_size * first_of_share(ranks_, n_blocks, rank));
  };
  const std::uint64_t begin = bound(ranks_.rank()), end = bound(ranks_.rank() + 1),
                      first = begin / point_size, last = (end + point_size - 1) / point_size;
  std::vector<GlobalIndex> numbers;
  for (std::uint64_t i = first; i < last && begin < end; ++i)
    numbers.push_back(static_cast<GlobalIndex>(i));
  std::vector<double> x;
  for (const auto& point :
       directory.ask(numbers, [](const NodeEntry<dim>& entry) { return entry.x; })) {
    x.insert(x.end(), point.begin(), point.end());
    if (dim == 2) x.push_back(plane_);
  }
  std::string_view bytes(reinterpret_cast<const char*>(x.data()), sizeof(double) * x.size());
  if (!bytes.empty()) bytes = bytes.substr(begin - point_size * first, end - begin);
  std::vector<char> packed;
  std::vector<std::uint64_t> sizes;
  const std::uint32_t compressor = layout_.arrays.packing.compressor;
  if (compressor == 0) {
    packed.assign(bytes.begin(), bytes.end());
  } else {
    const VtuCompressor compress(vtu_compressors[compressor]);
    for (std::size_t at = 0; at < bytes.size(); at += vtu_block_size) {
      const auto block = compress.compressed(bytes.substr(at, vtu_block_size));
      packed.insert(packed.end(), block.begin(), block.end());
      sizes.push_back(block.size());
    }
  }
  x = {};
  sizes = ranks_.gather(sizes);
  std::unique_ptr<VtuCopy> file;
  ranks_.on_root([&] { file = std::make_unique<VtuCopy>(path_, layout_, out, sizes); });
  visit_in_turn(ranks_, std::move(packed), [&](int, const std::vector<char>& next) {
    file->append({next.data(), next.size()});
  });
  ranks_.on_root([&] { file->finish(); });
}

}  // namespace smoothfem
