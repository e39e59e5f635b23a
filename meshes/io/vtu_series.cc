// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtu_series.h"

#include <cmath>
#include <cstdio>

#include "meshes/io/atomic_file.h"
#include "meshes/io/vtk/xml_tags.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

VtuSeries::VtuSeries(std::filesystem::path collection) : collection_(std::move(collection)) {
  if (collection_.extension() != ".pvd")
    throw InputError("the series " + collection_.string() + " must have the extension .pvd");
}

void VtuSeries::add(double time, const MeshView& mesh, const MeshFields& fields) {
  if (!std::isfinite(time))
    throw InputError("the series " + collection_.string() + " got a time that is not finite");
  const std::string stem = collection_.stem().string();
  char number[32];
  std::snprintf(number, sizeof number, "_%06zu.vtu", entries_.size());
  const std::string file = stem + "/" + stem + number;
  write_mesh(collection_.parent_path() / file, mesh, fields);
  entries_.push_back({time, file});
  write_collection();
}

void VtuSeries::write_collection() const {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (const auto& entry : entries_) {
    char time[32];
    std::snprintf(time, sizeof time, "%.17g", entry.time);
    text += std::string("    <DataSet timestep=\"") + time + "\" part=\"0\" file=\"" +
            escaped_for_xml(entry.file) + "\"/>\n";
  }
  text += "  </Collection>\n</VTKFile>\n";
  write_atomically(collection_, text);
}

}  // namespace smoothfem
