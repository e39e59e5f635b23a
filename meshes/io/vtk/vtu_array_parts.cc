// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtu_array_parts.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "meshes/io/line_reader.h"
#include "meshes/io/vtk/vtu_bytes.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

/// Returns the number of Base64's characters for some bytes.
constexpr std::uint64_t encoded_size(std::uint64_t n_bytes) {
  return (n_bytes + 2) / 3 * 4;
}

}  // namespace

VtuArrayParts::VtuArrayParts(const FileParts& file, std::string name, const VtuPlace& place,
                             const VtuPacking& packing)
    : file_(file), name_(std::move(name)), place_(place), packing_(packing) {
  const std::uint64_t most = file.size();  // of anything that the file holds as it is
  if (packing.compressor == 0) {
    n_packed_ = n_bytes_ = word(0);
    if (n_bytes_ > most) fail("announces more bytes than there are");
    end_header(packing.header_size);
  } else {
    compressor_ = std::make_unique<VtuCompressor>(vtu_compressors[packing.compressor]);
    const std::uint64_t n_blocks = word(0);
    block_size_ = word(1);
    last_block_size_ = word(2);
    if (last_block_size_ == 0) last_block_size_ = block_size_;
    const std::uint64_t most_decompressed = max_decompressed_size(most);
    if (n_blocks > most / packing.header_size || block_size_ > most_decompressed ||
        last_block_size_ > block_size_ ||
        (block_size_ > 0 && n_blocks > most_decompressed / block_size_ + 1))
      fail("has a damaged header");
    n_bytes_ = n_blocks == 0 ? 0 : (n_blocks - 1) * block_size_ + last_block_size_;
    const std::uint64_t n_words = 3 + n_blocks;
    std::vector<char> words(n_words * packing.header_size);
    read_packed(place.at, 0, words);
    blocks_.push_back(0);
    for (std::uint64_t b = 0; b < n_blocks; ++b) {
      std::uint64_t size = 0;
      std::memcpy(&size, words.data() + (3 + b) * packing.header_size, packing.header_size);
      if (size == 0 || size > most) fail("has a damaged header");
      blocks_.push_back(blocks_.back() + size);
    }
    n_packed_ = blocks_.back();
    end_header(n_words * packing.header_size);
  }
  if (past_last() > file.size()) fail("announces more bytes than there are");
}

void VtuArrayParts::fail(const std::string& what) const {
  throw InputError(file_.path().string() + ": the array " + in_quotes(name_) + " " + what +
                   "; the file is truncated or damaged");
}

/// Returns a number of the header. All machines that this program runs on are little endian.
std::uint64_t VtuArrayParts::word(std::uint64_t k) const {
  std::vector<char> bytes((k + 1) * packing_.header_size);
  read_packed(place_.at, 0, bytes);
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data() + k * packing_.header_size, packing_.header_size);
  return value;
}

/// Finds the data behind a header of this size. In Base64, they begin anew or go on in the same
/// group of four characters.
void VtuArrayParts::end_header(std::uint64_t size) {
  if (!place_.is_base64) {
    data_at_ = place_.at + size;
    return;
  }
  const std::uint64_t end = place_.at + encoded_size(size);
  std::array<char, 4> group{};
  if (end > file_.size()) fail("has no header");
  file_.read(end - group.size(), group);
  const auto n_fill = std::count(group.begin(), group.end(), '=');
  const bool begins_anew = n_fill == static_cast<std::ptrdiff_t>((3 - size % 3) % 3);
  data_at_ = begins_anew ? end : place_.at;
  first_byte_ = begins_anew ? 0 : size;
}

std::uint64_t VtuArrayParts::past_last() const {
  const std::uint64_t n = first_byte_ + n_packed_;
  return data_at_ + (place_.is_base64 ? encoded_size(n) : n);
}

/// Reads decoded bytes that begin at a position of the file; first: of these.
void VtuArrayParts::read_packed(std::uint64_t position, std::uint64_t first,
                                std::span<char> to) const {
  if (to.empty()) return;
  if (!place_.is_base64) {
    if (position > file_.size() || first + to.size() > file_.size() - position)
      fail("has fewer bytes than announced");
    return file_.read(position + first, to);
  }
  const std::uint64_t begin = position + first / 3 * 4,
                      end = position + encoded_size(first + to.size());
  if (end > file_.size()) fail("has fewer bytes than announced");
  std::string text(end - begin, '\0');
  file_.read(begin, text);
  VtuBytes bytes(text, true);
  std::array<char, 3> skipped{};
  if (!bytes.read(skipped.data(), first % 3) || !bytes.read(to.data(), to.size()))
    fail("has bytes that are not encoded");
}

void VtuArrayParts::open_block(std::uint64_t b) {
  if (open_ == b) return;
  open_ = b;
  std::vector<char> packed(blocks_[b + 1] - blocks_[b]);
  read_packed(data_at_, first_byte_ + blocks_[b], packed);
  block_.resize(b + 2 == blocks_.size() ? last_block_size_ : block_size_);
  if (!compressor_->decompress(packed, block_)) fail("has compressed data that cannot be read");
}

void VtuArrayParts::read_bytes(std::uint64_t first, std::span<char> to) {
  if (first > n_bytes_ || to.size() > n_bytes_ - first) fail("has fewer values than announced");
  if (!compressor_) return read_packed(data_at_, first_byte_ + first, to);
  while (!to.empty()) {
    open_block(first / block_size_);
    const std::size_t at = first % block_size_, n = std::min(to.size(), block_.size() - at);
    std::copy_n(block_.begin() + static_cast<std::ptrdiff_t>(at), n, to.begin());
    first += n;
    to = to.subspan(n);
  }
}

}  // namespace smoothfem
