#pragma once

#include <functional>
#include <vector>

#include "meshes/generators/gear.h"

namespace smoothfem {

/// A piece of a boundary. point(t), t in [0, 1], moves along it with constant speed.
struct Curve {
  double length;
  std::function<Point<2>(double)> point;
};

/// Closed: each curve ends where the next begins, the last where the first begins.
using Outline = std::vector<Curve>;

/// The outer boundary, the four kidneys, the bore; each counterclockwise. Throws InputError for
/// parameters that give no such shape.
std::vector<Outline> gear_outlines(const GearParameters& parameters);

/// Closed polygons with n_edges edges altogether, of nearly equal length and a multiple of
/// `multiple_of` on each curve. Throws InputError if that is not possible.
std::vector<std::vector<Point<2>>> divide(const std::vector<Outline>& outlines, std::size_t n_edges,
                                          std::size_t multiple_of);

}  // namespace smoothfem
