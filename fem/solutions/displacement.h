// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "smoothing/mesh/point.h"

namespace smoothfem {

class FormulaProgram;

/// Formulas of the components of a vector, in x, y (and z).
template <int dim>
class VectorFormula {
 public:
  /// text: "f_x ; f_y" (in space also "; f_z"). key: its name in messages. Throws InputError if it
  /// cannot be read.
  VectorFormula(const std::string& key, const std::string& text);

  Eigen::Matrix<double, dim, 1> at(const Point<dim>& p) const;

 private:
  std::shared_ptr<const FormulaProgram> program_;
};

/// A known displacement u, and its derivatives in the equations of linear elasticity.
template <int dim>
class Displacement {
 public:
  struct Derivatives {
    Eigen::Matrix<double, dim, 1> value;
    Eigen::Matrix<double, dim, dim> gradient;  ///< row i: grad u_i
    Eigen::Matrix<double, dim, 1> grad_div, laplacian;
  };

  /// text: as in VectorFormula. Derivatives are symbolic.
  explicit Displacement(const std::string& text);

  Derivatives at(const Point<dim>& p) const;

 private:
  std::shared_ptr<const FormulaProgram> program_;
};

}  // namespace smoothfem
