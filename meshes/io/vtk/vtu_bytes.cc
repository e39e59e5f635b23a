// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtu_bytes.h"

#include <algorithm>
#include <cstring>

#include "meshes/io/vtk/vtk_numbers.h"
#include "meshes/io/vtk/vtu_compressor.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

[[noreturn]] void fail(const std::string& message) {
  throw InputError(message + "; the file is truncated or damaged");
}

// --- Base64 --------------------------------------------------------------------------------------

constexpr std::uint8_t no_digit = 64;

constexpr std::array<std::uint8_t, 256> base64_digits = [] {
  constexpr std::string_view alphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::uint8_t, 256> digits{};
  digits.fill(no_digit);
  for (std::uint8_t i = 0; i < 64; ++i) digits[static_cast<unsigned char>(alphabet[i])] = i;
  return digits;
}();

}  // namespace

/// Decodes three bytes, or fewer where '=' fills up the end of a part; returns 0 if there are none.
std::size_t VtuBytes::decode_four(char* to) {
  if (!text_.empty() && static_cast<unsigned char>(text_.front()) <= ' ')
    text_.remove_prefix(std::min(text_.find_first_not_of(" \t\r\n"), text_.size()));
  if (text_.size() < 4) return 0;
  const std::size_t n_bytes = text_[3] != '=' ? 3 : text_[2] != '=' ? 2 : 1;
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint8_t digit =
        k <= n_bytes ? base64_digits[static_cast<unsigned char>(text_[k])] : 0;
    if (digit == no_digit) return 0;
    bits = bits << 6 | digit;
  }
  for (std::size_t k = 0; k < 3; ++k) to[k] = static_cast<char>(bits >> (16 - 8 * k));
  text_.remove_prefix(4);
  return n_bytes;
}

bool VtuBytes::read(char* to, std::size_t n) {
  if (!is_base64_) {
    if (n > text_.size()) return false;
    std::memcpy(to, text_.data(), n);
    text_.remove_prefix(n);
    return true;
  }
  while (n > 0) {
    std::size_t n_taken = 0;
    if (n_decoded_ == 0 && n >= decoded_.size()) {
      n_taken = decode_four(to);
    } else {
      if (n_decoded_ == 0) n_decoded_ = decode_four(decoded_.data());
      n_taken = std::min(n, n_decoded_);
      std::copy_n(decoded_.begin(), n_taken, to);
      std::copy(decoded_.begin() + static_cast<std::ptrdiff_t>(n_taken), decoded_.end(),
                decoded_.begin());
      n_decoded_ -= n_taken;
    }
    if (n_taken == 0) return false;
    to += n_taken;
    n -= n_taken;
  }
  return true;
}

// --- Arrays --------------------------------------------------------------------------------------

VtuArrayBytes::VtuArrayBytes(VtuBytes bytes, const VtuEncoding& encoding)
    : bytes_(bytes), encoding_(encoding) {
  if (!encoding.compressor.empty()) {
    compressor_ = std::make_unique<VtuCompressor>(encoding.compressor);
    read_block_sizes();
  } else {
    size_ = header_number();
    if (size_ > bytes_.most()) fail("announces more bytes than there are");
  }
}

VtuArrayBytes::VtuArrayBytes(VtuArrayBytes&&) noexcept = default;
VtuArrayBytes::~VtuArrayBytes() = default;

std::uint64_t VtuArrayBytes::header_number() {
  std::array<char, 8> bytes{};
  if (!bytes_.read(bytes.data(), encoding_.header_size)) fail("has no header");
  std::uint64_t number = 0;
  const VtkNumber type = encoding_.header_size == 8 ? VtkNumber::uint64 : VtkNumber::uint32;
  for_each_vtk_number<std::int64_t>(
      type, encoding_.is_swapped, bytes.data(), 1,
      [&](std::int64_t value) { number = static_cast<std::uint64_t>(value); });
  return number;
}

/// Reads the header of a compressed array: number of blocks, their size, the size of the last one
/// if it differs, and the compressed size of each.
void VtuArrayBytes::read_block_sizes() {
  const std::uint64_t n_blocks = header_number();
  block_size_ = header_number();
  last_block_size_ = header_number();
  if (last_block_size_ == 0) last_block_size_ = block_size_;
  // Prevents overflow below; callers check the size against the array's purpose before they
  // allocate memory.
  constexpr std::uint64_t most = std::uint64_t{1} << 40;
  if (n_blocks > bytes_.most() / encoding_.header_size || block_size_ > most ||
      last_block_size_ > most)
    fail("has a damaged header");
  if (n_blocks == 0) return;
  if (n_blocks - 1 > (most - 1) / std::max<std::uint64_t>(block_size_, 1))
    fail("has a damaged header");
  size_ = (n_blocks - 1) * block_size_ + last_block_size_;
  for (std::uint64_t b = 0; b < n_blocks; ++b) {
    compressed_sizes_.push_back(header_number());
    if (compressed_sizes_.back() == 0) fail("has an empty block");
    if (compressed_sizes_.back() > bytes_.most()) fail("announces more bytes than there are");
  }
}

void VtuArrayBytes::next_block() {
  if (n_blocks_read_ == compressed_sizes_.size()) fail("has fewer values than announced");
  compressed_.resize(compressed_sizes_[n_blocks_read_++]);
  block_.resize(n_blocks_read_ == compressed_sizes_.size() ? last_block_size_ : block_size_);
  block_at_ = 0;
  if (!bytes_.read(compressed_.data(), compressed_.size()) ||
      !compressor_->decompress(compressed_, block_))
    fail("has compressed data that cannot be read");
}

void VtuArrayBytes::read(char* to, std::size_t n) {
  if (!compressor_) {
    if (!bytes_.read(to, n)) fail("has fewer values than announced, or some that are not encoded");
    return;
  }
  while (n > 0) {
    if (block_at_ == block_.size()) next_block();
    const std::size_t n_taken = std::min(n, block_.size() - block_at_);
    std::memcpy(to, block_.data() + block_at_, n_taken);
    block_at_ += n_taken;
    to += n_taken;
    n -= n_taken;
  }
}

}  // namespace smoothfem
