// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/domains/catalogue.h"

#include <algorithm>
#include <utility>

#include "smoothing/base/registry.h"

namespace smoothfem {

namespace {

Registry<Domain>& registry() {
  static Registry<Domain> domains("domain");
  return domains;
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
                     choose_one_of(elements, wanted));
  return *found;
}

bool Domain::is_random(const std::string& wanted) const {
  return std::find(random_elements.begin(), random_elements.end(), elements_named(wanted)) !=
         random_elements.end();
}

AnyMesh Domain::generate(const DomainParameters& parameters) const {
  DomainParameters known = parameters;
  known.elements = elements_named(parameters.elements);
  return make(known);
}

const std::vector<std::string>& element_names() {
  static const std::vector<std::string> names = {"triangles", "quadrilaterals", "mixed",
                                                 "tetrahedra", "hexahedra"};
  return names;
}

}  // namespace smoothfem
