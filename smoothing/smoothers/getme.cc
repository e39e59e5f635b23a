// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/catalogue.h"

namespace smoothfem {
namespace {

/// Runs the simultaneous method for the mean quality, then the sequential one for the lowest.
template <int dim, int spacedim = dim>
Stages<dim, spacedim> make_stages() {
  auto stages = stages_of<dim, spacedim>("getme-simultaneous");
  for (auto& stage : stages_of<dim, spacedim>("getme-sequential"))
    stages.push_back(std::move(stage));
  return stages;
}

const RegisteredMethod registered({.name = "getme",
                                   .title = "GETMe",
                                   .description = "GETMe simultaneous, then GETMe sequential from "
                                                  "its best mesh",
                                   .source = "Section 4.4; parameters of Chapter 6"},
                                  {make_stages<2>, make_stages<3>, make_stages<2, 3>});

}  // namespace
}  // namespace smoothfem
