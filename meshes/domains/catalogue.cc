// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/domains/catalogue.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "meshes/tools/outline.h"
#include "smoothing/base/registry.h"
#include "smoothing/second_order/midside_placement.h"

namespace smoothfem {

namespace {

Registry<Domain>& registry() {
  static Registry<Domain> domains("domain");
  return domains;
}

/// Returns the name that a word such as "quads" or "tet" begins like; otherwise the word.
std::string unabbreviated(const std::string& word, const std::vector<std::string>& names) {
  constexpr std::size_t n_letters = 3;
  for (const auto& name : names)
    if (word.size() >= n_letters && name.starts_with(word.substr(0, n_letters))) return name;
  return word;
}

/// Explains that a mesh cannot have so few edges, by the edge scale, which users know.
InputError too_large_scale(const Domain& domain, const DomainParameters& wanted,
                           const TooFewEdges& error) {
  // Numbers of edges may be rounded up by half a step.
  const double n_edges = static_cast<double>(error.n_edges) - 0.5 * error.multiple_of;
  const double largest = wanted.edge_scale * n_edges / static_cast<double>(error.n_least);
  std::ostringstream text;
  text << "the edge scale " << wanted.edge_scale << " is too large for " << wanted.elements
       << " of the domain " << domain.name << ", whose boundary has curves that need "
       << error.n_least << " edges together; give an edge scale of at most "
       << std::floor(10.0 * largest) / 10.0;
  return InputError(text.str());
}

}  // namespace

RegisteredDomain::RegisteredDomain(Domain domain) {
  registry().add(std::move(domain));
}

const std::vector<Domain>& domains() {
  return registry().all();
}

const Domain& find_domain(const std::string& name) {
  return registry().find(name);
}

const std::string& Domain::elements_named(const std::string& wanted) const {
  if (wanted.empty()) return elements.front();
  const auto found = std::find(elements.begin(), elements.end(), wanted);
  if (found == elements.end())
    throw InputError("the domain '" + name + "' has no mesh of '" + wanted + "'; " +
                     choose_one_of(elements, unabbreviated(wanted, elements)));
  return *found;
}

std::string Domain::offers() const {
  std::string text;
  for (const auto& its_elements : elements) {
    text += (text.empty() ? "" : "; ") + its_elements;
    if (const auto known = algorithms.find(its_elements); known != algorithms.end())
      text += " by " + joined(known->second);
  }
  return text;
}

std::string Domain::algorithm_named(const std::string& wanted, const std::string& elements) const {
  const auto known = algorithms.find(elements);
  if (known == algorithms.end()) {
    if (wanted.empty()) return {};
    throw InputError("the " + elements + " of the domain '" + name +
                     "' have no choice of algorithms; leave out '" + wanted + "'");
  }
  const auto& names = known->second;
  if (wanted.empty()) return names.front();
  if (std::find(names.begin(), names.end(), wanted) == names.end())
    throw InputError("the domain '" + name + "' has no algorithm '" + wanted + "' for " + elements +
                     "; " + choose_one_of(names, wanted));
  return wanted;
}

std::optional<double> Domain::eps_of(std::optional<double> wanted) const {
  if (!wanted) return eps;
  if (!eps) throw InputError("the domain '" + name + "' has no eps; leave it out");
  if (*wanted > 0.0 && *wanted <= 1.0) return wanted;
  std::ostringstream text;
  text << "eps of the domain '" << name << "' is " << *wanted
       << "; give a number above 0 and at most 1, which is the uniform grid";
  throw InputError(text.str());
}

bool Domain::is_random(const std::string& wanted) const {
  return std::find(random_elements.begin(), random_elements.end(), elements_named(wanted)) !=
         random_elements.end();
}

DomainParameters Domain::known(const DomainParameters& parameters) const {
  DomainParameters known = parameters;
  known.elements = elements_named(parameters.elements);
  known.algorithm = algorithm_named(parameters.algorithm, known.elements);
  known.eps = eps_of(parameters.eps);
  return known;
}

AnyMesh Domain::generate(const DomainParameters& parameters) const {
  const DomainParameters all = known(parameters);
  try {
    return make(all);
  } catch (const TooFewEdges& error) {
    if (all.edge_scale > 1.0) throw too_large_scale(*this, all, error);
    throw;
  }
}

void Domain::require_second_order() const {
  if (boundary) return;
  std::string names;
  for (const Domain& domain : domains())
    if (domain.boundary) names += (names.empty() ? "" : ", ") + domain.name;
  throw InputError("the domain '" + name + "' has no meshes of second order; these have: " + names);
}

SecondOrderMesh Domain::of_second_order(const AnyMesh& mesh,
                                        const DomainParameters& parameters) const {
  require_second_order();
  const AnyOntoBoundary onto = boundary(known(parameters));
  return std::visit(
      [&]<int dim, int spacedim>(const Mesh<dim, spacedim>& linear) -> SecondOrderMesh {
        if constexpr (dim == spacedim) {
          auto curved = with_curved_boundary(linear, std::get<OntoBoundary<dim>>(onto));
          const MidsideReport report = repair_midside_nodes(curved);
          return {std::move(curved), report};
        }
        throw InputError("surface meshes of second order cannot be generated");
      },
      mesh);
}

const std::vector<std::string>& element_names() {
  static const std::vector<std::string> names = {"triangles", "quadrilaterals", "mixed",
                                                 "tetrahedra", "hexahedra"};
  return names;
}

}  // namespace smoothfem
