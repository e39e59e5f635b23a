// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

class vtkDataCompressor;

namespace smoothfem {

/// A compressor of VTK. It treats each block of an array alone.
class VtuCompressor {
 public:
  /// name: VTK's class, for example "vtkZLibDataCompressor". Throws InputError for other names.
  explicit VtuCompressor(const std::string& name);
  ~VtuCompressor();

  /// Fills `to`. Returns false if the block is damaged or has another size.
  bool decompress(std::span<const char> from, std::span<char> to) const;
  std::vector<char> compressed(std::span<const char> block) const;

 private:
  struct Release {
    void operator()(vtkDataCompressor* compressor) const;
  };
  std::unique_ptr<vtkDataCompressor, Release> compressor_;
};

}  // namespace smoothfem
