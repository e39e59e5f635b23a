// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <type_traits>

#include "fem/solutions/manufactured_solution.h"
#include "smoothing/simd/vectors.h"

namespace smoothfem {

/// The identity as diffusivity A of cells' stiffness matrices; it costs nothing.
struct IdentityDiffusivity {
  struct Tensor {
    template <class AnyVector>
    AnyVector operator*(AnyVector v) const {
      return v;
    }
  };
  template <class AnyVector>
  Tensor at(const AnyVector&) const {
    return {};
  }
};

/// A number times the identity, on all cells.
struct ConstantDiffusivity {
  struct Tensor {
    double factor;
    template <class AnyVector>
    AnyVector operator*(AnyVector v) const {
      return factor * v;
    }
  };
  double factor;
  template <class AnyVector>
  Tensor at(const AnyVector&) const {
    return {factor};
  }
};

/// True for a diffusivity that is the same at all positions.
template <class AnyDiffusivity>
constexpr bool is_constant_diffusivity = std::is_same_v<AnyDiffusivity, IdentityDiffusivity> ||
                                         std::is_same_v<AnyDiffusivity, ConstantDiffusivity>;

/// A diffusivity that is a function of the position.
template <int dim>
struct VariableDiffusivity {
  template <class Real>
  struct Tensor {
    std::array<Vector<dim, Real>, dim> rows;
    Vector<dim, Real> operator*(Vector<dim, Real> v) const {
      if constexpr (dim == 2)
        return {dot(rows[0], v), dot(rows[1], v)};
      else
        return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
    }
  };

  const std::function<Diffusivity<dim>(const Point<dim>&)>& function;

  /// Returns the tensor in each lane.
  Tensor<Lanes> at(const Vector<dim, Lanes>& position) const {
    Tensor<Lanes> tensor;
    for (std::size_t l = 0; l < n_lanes; ++l) {
      const Diffusivity<dim> a = function(lane(position, l));
      for (int i = 0; i < dim; ++i) {
        auto& row = tensor.rows[static_cast<std::size_t>(i)];
        row.x[l] = a(i, 0);
        row.y[l] = a(i, 1);
        if constexpr (dim == 3) row.z[l] = a(i, 2);
      }
    }
    return tensor;
  }
};

}  // namespace smoothfem
