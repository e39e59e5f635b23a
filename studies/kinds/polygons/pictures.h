// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "studies/kinds/polygons/polygon_study.h"

/// Functions for the tables that figures are drawn from, as CSV texts (columns:
/// studies/columns.json).
namespace smoothfem {

std::string decomposition_csv(const PolygonStudy& study);  ///< Fig. 2.10
std::string domains_csv(const PolygonStudy& study);        ///< Fig. 2.11
std::string limits_csv(const PolygonStudy& study);         ///< Fig. 2.3
std::string sequences_csv(const PolygonStudy& study);      ///< Figs. 2.5 and 2.12
std::string side_ratios_csv(const PolygonStudy& study);    ///< Propositions 2.1 and 2.3

}  // namespace smoothfem
