// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Writes the histogram of the cells' quality as a picture; the program knows no plotting itself:
/// the Python package plots draws it. path: ends with .png, .pdf or .svg. title: what stands over
/// it. Python is the environment variable SMOOTHFEM_PYTHON, without it the one that the build was
/// configured with. Throws InputError where the picture cannot be made.
void write_histogram_figure(const std::filesystem::path& path, const std::string& title,
                            const Topology& topology, const std::vector<double>& cell_quality);

/// Throws InputError unless the path ends with .png, .pdf or .svg.
void require_figure_path(const std::filesystem::path& path);

}  // namespace smoothfem
