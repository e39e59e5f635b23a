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

/// Bytes in a .vtu file, as they are or in Base64. Parts that have been encoded one by one, as
/// headers are, follow each other.
class VtuBytes {
 public:
  VtuBytes(std::string_view text, bool is_base64) : text_(text), is_base64_(is_base64) {}

  /// The next n bytes; false if there are not so many, or they are no Base64.
  bool read(char* to, std::size_t n);
  /// There are no more.
  std::size_t most() const {
    return n_decoded_ + (is_base64_ ? text_.size() / 4 * 3 + 3 : text_.size());
  }

 private:
  std::size_t decode_four(char* to);

  std::string_view text_;
  bool is_base64_;
  std::array<char, 3> decoded_{};  ///< but not yet read
  std::size_t n_decoded_ = 0;
};

/// How the arrays of a file are written.
struct VtuEncoding {
  bool is_swapped = false;      ///< against this machine's order of bytes
  std::size_t header_size = 4;  ///< bytes of a number in the arrays' headers
  std::string compressor;       ///< VTK's class; empty if arrays are not compressed
};

class VtuDecompressor;

/// The content of a binary array behind its header, decompressed block by block. Throws InputError
/// without a position for whatever is damaged.
class VtuArrayBytes {
 public:
  VtuArrayBytes(VtuBytes bytes, const VtuEncoding& encoding);
  VtuArrayBytes(VtuArrayBytes&&) noexcept;
  ~VtuArrayBytes();

  /// What the header says; the file has room for it, if it is not compressed.
  std::uint64_t size() const { return size_; }
  bool is_compressed() const { return decompressor_ != nullptr; }

  void read(char* to, std::size_t n);

 private:
  std::uint64_t header_number();
  void read_block_sizes();
  void next_block();

  VtuBytes bytes_;
  const VtuEncoding& encoding_;
  std::uint64_t size_ = 0;
  std::unique_ptr<VtuDecompressor> decompressor_;
  std::vector<std::uint64_t> compressed_sizes_;
  std::uint64_t block_size_ = 0, last_block_size_ = 0;
  std::vector<char> compressed_, block_;
  std::size_t n_blocks_read_ = 0, block_at_ = 0;
};

}  // namespace smoothfem
