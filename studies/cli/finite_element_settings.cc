// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/cli/piece_commands.h"
#include "studies/framework/definition/study.h"

void smoothfem_read_finite_elements(const std::vector<std::string>& settings,
                                    smoothfem::PoissonOptions& options) {
  options = smoothfem::finite_element_options(settings);
}
