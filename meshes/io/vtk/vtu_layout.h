// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "meshes/io/vtk/vtu_array_parts.h"

namespace smoothfem {

/// Counts and arrays of a .vtu file with one piece.
struct VtuArrays {
  std::uint64_t n_points = 0, n_cells = 0;
  VtuPacking packing{};
  VtuPlace points{}, connectivity{}, offsets{}, types{};
  /// Arrays with a meaning (parts_of_grid()); labels of cells of lower dimension.
  VtuPlace fixed{}, node_ids{}, cell_ids{}, tags{}, lower_tags{};
};

/// Bytes of a file that are replaced by others.
struct VtuEdit {
  std::uint64_t at = 0, size = 0;
  std::string text{};
};

/// Where a .vtu file has its arrays, so that several processes can each read a part of it.
struct VtuLayout {
  VtuArrays arrays{};
  std::string obstacle{};  ///< why the file cannot be read in parts; empty if it can

  /// For a copy with other points of 64 bits: changes of their tag; offsets in the appended data
  /// that follow, and the value of each; the bytes of the points in the file.
  std::vector<VtuEdit> edits{};
  struct Offset {
    std::uint64_t at, size, value;
  };
  std::vector<Offset> later_offsets{};
  std::uint64_t points_end = 0;
};

/// True if the file is one of VTK's XML formats.
bool begins_as_vtk_xml(const std::filesystem::path& path);

/// Finds the arrays; reads the tags and the headers of arrays only. Obstacles are another byte
/// order, text, declarations, several pieces, ghost cells, global numbers of cells, arrays that say
/// which nodes must stay other than 'fixed', and large compressed blocks. Types of cells are not
/// looked at. Damaged and missing files have an obstacle, too: read_mesh() names the fault.
VtuLayout vtu_layout(const std::filesystem::path& path);

}  // namespace smoothfem
