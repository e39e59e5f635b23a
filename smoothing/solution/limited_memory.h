// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>

#include "smoothing/solution/node_laplacian.h"

namespace smoothfem {

/// The limited-memory BFGS approximation of an inverse Hessian from the last steps s and the
/// changes y of the gradient along them (Nocedal 1980). It starts from gamma L^-1 instead of a
/// multiple of the identity; inverse(r) computes L^-1 r.
class LimitedMemory {
 public:
  explicit LimitedMemory(std::size_t n_pairs) : n_pairs_(n_pairs) {}

  void clear() { pairs_.clear(); }

  /// Adds a pair. Pairs along which the function is not convex carry no information and are
  /// skipped.
  void add(NodeVectors s, NodeVectors y) {
    const double curvature = dot(s, y);
    if (n_pairs_ == 0 || !(curvature > 0.0)) return;
    if (pairs_.size() == n_pairs_) pairs_.pop_front();
    pairs_.push_back({std::move(s), std::move(y), curvature});
  }

  bool empty() const { return pairs_.empty(); }

  /// Returns the approximate inverse Hessian times a gradient.
  template <class Inverse>
  NodeVectors apply(const NodeVectors& gradient, const Inverse& inverse) const {
    if (pairs_.empty()) return inverse(gradient);
    NodeVectors q = gradient;
    std::deque<double> factors;
    for (auto pair = pairs_.rbegin(); pair != pairs_.rend(); ++pair) {
      factors.push_front(dot(pair->s, q) / pair->curvature);
      q -= factors.front() * pair->y;
    }
    const Pair& last = pairs_.back();
    const double gamma = last.curvature / dot(last.y, inverse(last.y));
    NodeVectors r = gamma * inverse(q);
    for (const Pair& pair : pairs_) {
      r += (factors.front() - dot(pair.y, r) / pair.curvature) * pair.s;
      factors.pop_front();
    }
    return r;
  }

 private:
  struct Pair {
    NodeVectors s, y;
    double curvature;
  };

  static double dot(const NodeVectors& a, const NodeVectors& b) { return a.cwiseProduct(b).sum(); }

  std::size_t n_pairs_;
  std::deque<Pair> pairs_;
};

}  // namespace smoothfem
