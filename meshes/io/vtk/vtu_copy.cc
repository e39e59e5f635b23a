// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtu_copy.h"

#include <vtkBase64Utilities.h>

#include <algorithm>
#include <vector>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

std::string base64(std::string_view bytes) {
  std::string text((bytes.size() + 2) / 3 * 4, '\0');
  if (!bytes.empty())
    vtkBase64Utilities::Encode(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                               reinterpret_cast<unsigned char*>(text.data()));
  return text;
}

}  // namespace

VtuCopy::VtuCopy(const std::filesystem::path& from, const VtuLayout& layout,
                 const std::filesystem::path& out, std::span<const std::uint64_t> block_sizes)
    : out_(out),
      from_(from),
      layout_(layout),
      file_(out),
      buffer_(file_.temporary()),
      stream_(&buffer_) {
  const VtuPlace& points = layout.arrays.points;
  const std::uint64_t words = layout.arrays.packing.compressor == 0 ? 1 : 3 + block_sizes.size();
  std::uint64_t header = words * layout.arrays.packing.header_size, n_bytes = 0;
  for (const std::uint64_t size : block_sizes) n_bytes += size;
  if (layout.arrays.packing.compressor == 0) n_bytes = 24 * layout.arrays.n_points;
  const auto encoded = [&](std::uint64_t n) { return points.is_base64 ? (n + 2) / 3 * 4 : n; };
  const std::uint64_t new_size = layout.arrays.packing.compressor == 0
                                     ? encoded(header + n_bytes)
                                     : encoded(header) + encoded(n_bytes),
                      old_size = layout.points_end - points.at;
  for (const auto& [at, size, value] : layout.later_offsets)
    layout_.edits.push_back({at, size, std::to_string(value - old_size + new_size)});
  std::sort(layout_.edits.begin(), layout_.edits.end(),
            [](const VtuEdit& a, const VtuEdit& b) { return a.at < b.at; });
  copy_until(points.at);
  write_header(block_sizes);
  at_ = layout.points_end;
}

/// Copies bytes of the old file, with the edits among them.
void VtuCopy::copy_until(std::uint64_t position) {
  constexpr std::uint64_t step = std::uint64_t{1} << 20;
  std::string bytes;
  while (at_ < position) {
    const bool has_edit = n_edits_ < layout_.edits.size() && layout_.edits[n_edits_].at < position;
    const std::uint64_t end = has_edit ? layout_.edits[n_edits_].at : position;
    while (at_ < end) {
      bytes.resize(std::min(step, end - at_));
      from_.read(at_, bytes);
      stream_ << bytes;
      at_ += bytes.size();
    }
    if (!has_edit) continue;
    const VtuEdit& edit = layout_.edits[n_edits_++];
    stream_ << edit.text;
    at_ = edit.at + edit.size;
  }
}

/// As VTK: the header of a compressed array is encoded alone.
void VtuCopy::write_header(std::span<const std::uint64_t> block_sizes) {
  const std::uint64_t n_bytes = 24 * layout_.arrays.n_points;
  const VtuPacking& packing = layout_.arrays.packing;
  std::vector<std::uint64_t> words{n_bytes};
  if (packing.compressor != 0) {
    words = {block_sizes.size(), vtu_block_size, n_bytes % vtu_block_size};
    words.insert(words.end(), block_sizes.begin(), block_sizes.end());
  }
  std::string bytes;
  for (const std::uint64_t word : words)
    bytes.append(reinterpret_cast<const char*>(&word), packing.header_size);
  append(bytes);
  if (packing.compressor != 0) end_encoding();
}

void VtuCopy::append(std::string_view bytes) {
  if (!layout_.arrays.points.is_base64) {
    stream_ << bytes;
    return;
  }
  constexpr std::size_t step = 3 << 18;  // whole groups
  while (!bytes.empty()) {
    const std::size_t n = std::min(bytes.size(), step - waiting_.size());
    waiting_ += bytes.substr(0, n);
    bytes.remove_prefix(n);
    if (waiting_.size() == step) end_encoding();
  }
}

void VtuCopy::end_encoding() {
  stream_ << base64(waiting_);
  waiting_.clear();
}

void VtuCopy::finish() {
  end_encoding();
  copy_until(from_.size());
  try {
    buffer_.finish();
  } catch (const std::runtime_error& error) {
    throw InputError("cannot write " + out_.string() + ": " + error.what());
  }
  file_.finish();
}

}  // namespace smoothfem
