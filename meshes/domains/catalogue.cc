// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/domains/catalogue.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "smoothing/base/find_named.h"

namespace smoothfem {

namespace {

/// Sorted by name, so that listings do not depend on the order in which files are linked or loaded.
std::vector<Domain>& registered_domains() {
  static std::vector<Domain> all;
  return all;
}

}  // namespace

RegisteredDomain::RegisteredDomain(Domain domain) {
  std::vector<Domain>& all = registered_domains();
  const auto next =
      std::lower_bound(all.begin(), all.end(), domain,
                       [](const Domain& a, const Domain& b) { return a.name < b.name; });
  if (next != all.end() && next->name == domain.name)
    throw std::logic_error("two domains are registered as '" + domain.name + "'");
  all.insert(next, std::move(domain));
}

const std::vector<Domain>& domains() {
  return registered_domains();
}

const Domain& find_domain(const std::string& name) {
  return find_named("domain", name, domains(), [](const Domain& domain) { return domain.name; });
}

const std::string& Domain::elements_named(const std::string& wanted) const {
  if (wanted.empty()) return elements.front();
  const auto found = std::find(elements.begin(), elements.end(), wanted);
  if (found == elements.end())
    throw InputError("the domain '" + name + "' has no mesh of '" + wanted + "'; " +
                     choose_one_of(elements, wanted));
  return *found;
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
