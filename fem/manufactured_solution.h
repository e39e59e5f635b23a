#pragma once

#include <functional>
#include <string>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A known solution u of -laplace(u) = f with u = g on the boundary.
struct ManufacturedSolution {
  std::string name;
  std::string formula;                                ///< of u, for listings
  std::string source;                                 ///< where it comes from
  std::function<double(const Point<2>&)> value;       ///< u
  std::function<Point<2>(const Point<2>&)> gradient;  ///< grad u
  std::function<double(const Point<2>&)> load;        ///< f = -laplace(u)
};

/// The solutions that studies can name.
const std::vector<ManufacturedSolution>& manufactured_solutions();

/// The one of this name; throws InputError listing the names there are.
const ManufacturedSolution& manufactured_solution(const std::string& name);

/// A solution from expressions in x and y (and pi): u, its gradient as "u_x ; u_y", and
/// f = -laplace(u). Throws InputError if an expression cannot be read, or if gradient and load are
/// not those of u (checked against differences of u at points in and around `sample`). Safe to call
/// from several threads.
ManufacturedSolution parsed_solution(const std::string& value, const std::string& gradient,
                                     const std::string& load, const std::vector<Point<2>>& sample);

}  // namespace smoothfem
