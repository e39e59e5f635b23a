#pragma once

#include <vector>

#include "meshes/generators/gear.h"
#include "meshes/generators/outline.h"

namespace smoothfem {

/// The outer boundary, the four kidneys, the bore; each counterclockwise. Throws InputError for
/// parameters that give no such shape.
std::vector<Outline> gear_outlines(const GearParameters& parameters);

}  // namespace smoothfem
