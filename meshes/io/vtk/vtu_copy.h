// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <ostream>
#include <span>
#include <string>
#include <string_view>

#include "meshes/io/atomic_file.h"
#include "meshes/io/error_latching_filebuf.h"
#include "meshes/io/vtk/vtu_layout.h"

namespace smoothfem {

/// Bytes of VTK's blocks before they are compressed.
inline constexpr std::uint64_t vtu_block_size = 32768;

/// Writes a copy of a .vtu file with other points, as numbers of 64 bits in the encoding of the
/// file. All functions throw InputError.
class VtuCopy {
 public:
  /// Writes all before the points. block_sizes: of the compressed blocks of vtu_block_size bytes;
  /// not used if the file is not compressed.
  VtuCopy(const std::filesystem::path& from, const VtuLayout& layout,
          const std::filesystem::path& out, std::span<const std::uint64_t> block_sizes);

  /// Writes the next bytes of the points, compressed if the file is.
  void append(std::string_view bytes);
  /// Writes all behind the points, and gives the file its name.
  void finish();

 private:
  void copy_until(std::uint64_t position);
  void write_header(std::span<const std::uint64_t> block_sizes);
  void end_encoding();

  std::filesystem::path out_;
  FileParts from_;
  VtuLayout layout_;
  AtomicFile file_;
  ErrorLatchingFilebuf buffer_;
  std::ostream stream_;
  std::uint64_t at_ = 0;  ///< in the old file
  std::size_t n_edits_ = 0;
  std::string waiting_;  ///< bytes that do not yet fill a group of Base64
};

}  // namespace smoothfem
