// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace smoothfem {

/// Bytes in a .vtu file, raw or in Base64. Parts that are encoded separately, like headers, follow
/// each other.
class VtuBytes {
 public:
  VtuBytes(std::string_view text, bool is_base64) : text_(text), is_base64_(is_base64) {}

  /// Reads the next n bytes; false if there are not enough, or if they are not Base64.
  bool read(char* to, std::size_t n);
  /// Returns an upper bound of the remaining bytes.
  std::size_t most() const {
    return n_decoded_ + (is_base64_ ? text_.size() / 4 * 3 + 3 : text_.size());
  }

 private:
  std::size_t decode_four(char* to);

  std::string_view text_;
  bool is_base64_;
  std::array<char, 3> decoded_{};  ///< not yet read
  std::size_t n_decoded_ = 0;
};

/// Encoding of the arrays of a file.
struct VtuEncoding {
  bool is_swapped = false;      ///< relative to this machine's byte order
  std::size_t header_size = 4;  ///< bytes of a number in the arrays' headers
  std::string compressor;       ///< VTK's class; empty if arrays are not compressed
};

/// Largest decompressed size of all arrays. A file of a few kB may announce any size; meshes shrink
/// to about a tenth.
constexpr std::uint64_t max_decompressed_size(std::uint64_t file_size) {
  return (std::uint64_t{64} << 20) + 100 * file_size;
}

class VtuCompressor;

/// The content of a binary array after its header, decompressed block by block. Throws InputError
/// without a position for any damage.
class VtuArrayBytes {
 public:
  VtuArrayBytes(VtuBytes bytes, const VtuEncoding& encoding);
  VtuArrayBytes(VtuArrayBytes&&) noexcept;
  ~VtuArrayBytes();

  /// Returns the size in the header; the file has room for it, if it is not compressed.
  std::uint64_t size() const { return size_; }
  bool is_compressed() const { return compressor_ != nullptr; }

  void read(char* to, std::size_t n);

 private:
  std::uint64_t header_number();
  void read_block_sizes();
  void next_block();

  VtuBytes bytes_;
  const VtuEncoding& encoding_;
  std::uint64_t size_ = 0;
  std::unique_ptr<VtuCompressor> compressor_;
  std::vector<std::uint64_t> compressed_sizes_;
  std::uint64_t block_size_ = 0, last_block_size_ = 0;
  std::vector<char> compressed_, block_;
  std::size_t n_blocks_read_ = 0, block_at_ = 0;
};

}  // namespace smoothfem
