// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtu_compressor.h"

#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkZLibDataCompressor.h>

#include "meshes/io/line_reader.h"
#include "meshes/io/vtk/vtk_messages.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

void VtuCompressor::Release::operator()(vtkDataCompressor* compressor) const {
  compressor->Delete();
}

VtuCompressor::VtuCompressor(const std::string& name) {
  if (name == "vtkZLibDataCompressor") compressor_.reset(vtkZLibDataCompressor::New());
  if (name == "vtkLZ4DataCompressor") compressor_.reset(vtkLZ4DataCompressor::New());
  if (name == "vtkLZMADataCompressor") compressor_.reset(vtkLZMADataCompressor::New());
  if (!compressor_)
    throw InputError("is compressed by " + in_quotes(name) + ", which is not known");
}

VtuCompressor::~VtuCompressor() = default;

bool VtuCompressor::decompress(std::span<const char> from, std::span<char> to) const {
  const VtkMessages silence;
  return compressor_->Uncompress(reinterpret_cast<const unsigned char*>(from.data()), from.size(),
                                 reinterpret_cast<unsigned char*>(to.data()),
                                 to.size()) == to.size();
}

std::vector<char> VtuCompressor::compressed(std::span<const char> block) const {
  std::vector<char> result(compressor_->GetMaximumCompressionSpace(block.size()));
  result.resize(compressor_->Compress(reinterpret_cast<const unsigned char*>(block.data()),
                                      block.size(), reinterpret_cast<unsigned char*>(result.data()),
                                      result.size()));
  return result;
}

}  // namespace smoothfem
