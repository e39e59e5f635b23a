// SPDX-License-Identifier: GPL-3.0-or-later
// How every name that a user gives is looked up: smoothing/base/find_named.h and registry.h.
#include <gmock/gmock.h>

#include <map>
#include <string>
#include <vector>

#include "smoothing/base/registry.h"

namespace smoothfem {
namespace {

struct Named {
  std::string name;
  int value;
};

std::string refusal(const std::string& wanted, const std::vector<std::string>& names) {
  try {
    find_named("domain", wanted, names);
  } catch (const InputError& error) {
    return error.what();
  }
  return "found";
}

TEST(EditDistance, CountsInsertedDeletedChangedAndSwappedLetters) {
  EXPECT_EQ(edit_distance("gear", "gear"), 0U);
  EXPECT_EQ(edit_distance("gear", "gears"), 1U);
  EXPECT_EQ(edit_distance("gear", "ear"), 1U);
  EXPECT_EQ(edit_distance("gear", "bear"), 1U);
  EXPECT_EQ(edit_distance("gear", "gaer"), 1U);
  EXPECT_EQ(edit_distance("gear", "egra"), 2U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("", "ring"), 4U);
  EXPECT_EQ(edit_distance("ring", ""), 4U);
  EXPECT_EQ(edit_distance("", ""), 0U);
  // The swapped "ca" would have to be edited again to give "abc".
  EXPECT_EQ(edit_distance("ca", "abc"), 3U);
}

TEST(EditDistance, IsSymmetric) {
  const std::vector<std::string> words{"plate", "pleat", "late", "palette", "axle", ""};
  for (const auto& a : words)
    for (const auto& b : words) EXPECT_EQ(edit_distance(a, b), edit_distance(b, a)) << a << b;
}

TEST(FindNamed, ReturnsTheElementOfTheName) {
  std::vector<Named> all{{"axle", 1}, {"gear", 2}, {"gear", 3}};
  const auto name_of = [](const Named& named) { return named.name; };
  find_named("domain", "gear", all, name_of).value = 4;
  EXPECT_EQ(all[1].value, 4);  // the element itself, and the first of the name
  EXPECT_EQ(all[2].value, 3);
  const std::map<std::string, int> map{{"axle", 1}, {"gear", 2}};
  const auto& [name, value] =
      find_named("domain", "gear", map, [](const auto& entry) { return entry.first; });
  EXPECT_EQ(value, 2);
  const std::vector<std::string> names{"axle", "gear"};
  EXPECT_EQ(&find_named("domain", "gear", names), &names[1]);
}

TEST(FindNamed, SuggestsTheNearestName) {
  EXPECT_EQ(refusal("gaer", {"axle", "gear", "ring"}),
            "there is no domain 'gaer'; did you mean 'gear'? choose one of axle, gear, ring");
  EXPECT_EQ(refusal("Gear", {"axle", "gear"}),
            "there is no domain 'Gear'; did you mean 'gear'? choose one of axle, gear");
}

TEST(FindNamed, SuggestsTheFirstOfEquallyNearNames) {
  EXPECT_EQ(nearest_name("subdivison", {"subdivide", "subdivision"}), "subdivision");
  EXPECT_EQ(nearest_name("bing", {"sing", "ring"}), "sing");
  EXPECT_EQ(nearest_name("bing", {"ring", "sing"}), "ring");
}

TEST(FindNamed, SuggestsNoDistantName) {
  EXPECT_EQ(refusal("tooth", {"axle", "gear"}),
            "there is no domain 'tooth'; choose one of axle, gear");
  EXPECT_EQ(nearest_name("gxxr", {"gear"}), "");  // two letters of four
  EXPECT_EQ(nearest_name("nonuniform-gxxx", {"nonuniform-grid"}), "nonuniform-grid");  // 3 of 15
  EXPECT_EQ(nearest_name("ab", {"bc"}), "");  // in short names one letter may be wrong
  EXPECT_EQ(nearest_name("ab", {"ac"}), "ac");
  EXPECT_EQ(nearest_name("", {"gear"}), "");
}

TEST(FindNamed, ReportsThatNoneIsAvailable) {
  EXPECT_EQ(refusal("gear", {}), "there is no domain 'gear'; none is available");
  EXPECT_EQ(nearest_name("gear", {}), "");
}

std::string refusal_of(const Registry<Named>& registry, const std::string& wanted) {
  try {
    registry.find(wanted);
  } catch (const InputError& error) {
    return error.what();
  }
  return "found";
}

TEST(Registry, ListsByNameInAnyOrderOfRegistration) {
  Registry<Named> registry("animal");
  for (const auto& entry : {Named{"dog", 2}, {"ant", 0}, {"cat", 1}}) registry.add(entry);
  ASSERT_EQ(registry.all().size(), 3U);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(registry.all()[i].value, i);
  EXPECT_EQ(registry.find("cat").value, 1);
  EXPECT_EQ(refusal_of(registry, "cta"),
            "there is no animal 'cta'; did you mean 'cat'? choose one of ant, cat, dog");
}

TEST(Registry, RefusesADuplicateNameAtTheFirstLookUp) {
  Registry<Named> registry("animal");
  registry.add({"dog", 1});
  registry.add({"dog", 2});
  EXPECT_EQ(
      refusal_of(registry, "dog"),
      "two entries of the kind animal are registered as 'dog'; give one of them another name");
  EXPECT_THROW(registry.all(), InputError);
}

}  // namespace
}  // namespace smoothfem
