// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "meshes/io/file_parts.h"
#include "meshes/io/vtk/vtk_numbers.h"
#include "meshes/io/vtk/vtu_compressor.h"

namespace smoothfem {

/// How a .vtu file holds binary arrays, in the byte order of this machine.
struct VtuPacking {
  /// VTK's compressors, by their place in vtu_compressors.
  std::uint32_t compressor = 0;
  std::uint32_t header_size = 4;  ///< bytes of a number in the arrays' headers
};
inline constexpr std::array<const char*, 4> vtu_compressors{
    "", "vtkZLibDataCompressor", "vtkLZ4DataCompressor", "vtkLZMADataCompressor"};

/// A binary array of a .vtu file.
struct VtuPlace {
  std::uint64_t n = 0;   ///< tuples; 0: the file has no such array
  std::uint64_t at = 0;  ///< position of its header in the file
  std::uint64_t n_components = 1;
  VtkNumber type = VtkNumber::float64;
  bool is_base64 = false;
};

/// Reads ranges of a binary array. Compressed blocks outside a range are not touched. Throws
/// InputError for damage.
class VtuArrayParts {
 public:
  /// Reads the header. name: for messages.
  VtuArrayParts(const FileParts& file, std::string name, const VtuPlace& place,
                const VtuPacking& packing);

  std::uint64_t n_bytes() const { return n_bytes_; }
  /// Returns the size of the largest block; 0 if the array is not compressed.
  std::uint64_t block_size() const { return blocks_.empty() ? 0 : block_size_; }
  /// Returns the position behind its data in the file.
  std::uint64_t past_last() const;

  /// Calls use(number) for the first component of some tuples, or all components.
  template <class Value, class Use>
  void read(std::uint64_t first, std::uint64_t last, bool all_components, const Use& use) {
    constexpr std::uint64_t at_once = 4096;
    const std::size_t size = size_of(place_.type), tuple = size * place_.n_components;
    std::vector<char> bytes;
    for (; first < last; first += at_once) {
      bytes.resize(tuple * (std::min(last, first + at_once) - first));
      read_bytes(tuple * first, bytes);
      for (std::size_t at = 0; at < bytes.size(); at += all_components ? bytes.size() : tuple)
        for_each_vtk_number<Value>(place_.type, false, bytes.data() + at,
                                   all_components ? bytes.size() / size : 1, use);
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const;
  std::uint64_t word(std::uint64_t k) const;
  void end_header(std::uint64_t size);
  void read_bytes(std::uint64_t first, std::span<char> to);
  void read_packed(std::uint64_t position, std::uint64_t first, std::span<char> to) const;
  void open_block(std::uint64_t b);

  const FileParts& file_;
  std::string name_;
  VtuPlace place_;
  VtuPacking packing_;
  std::uint64_t n_bytes_ = 0;
  /// The packed bytes: where their encoding begins, which of them is the first of the data, and
  /// how many there are.
  std::uint64_t data_at_ = 0, first_byte_ = 0, n_packed_ = 0;
  std::vector<std::uint64_t> blocks_{};  ///< where each begins among the packed bytes, and the end
  std::uint64_t block_size_ = 0, last_block_size_ = 0;
  std::unique_ptr<VtuCompressor> compressor_{};
  std::uint64_t open_ = UINT64_MAX;  ///< the block in block_
  std::vector<char> block_{};
};

}  // namespace smoothfem
