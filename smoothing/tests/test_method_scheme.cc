// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/method_scheme.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A method that does nothing; the object is the name of its stage.
class Idle final : public Smoother<2> {
 public:
  explicit Idle(std::string name) : name_(std::move(name)) {}
  std::string_view name() const override { return name_; }
  StepReport step(SmoothingState<2>&) override { return {}; }

 private:
  std::string name_;
};

const RegisteredScheme registered({.name = "idle", .make = [](const MethodInFile& method) {
                                     const auto make = [name = method.object] {
                                       Stages<2> stages;
                                       stages.push_back(std::make_unique<Idle>(name));
                                       return stages;
                                     };
                                     return MethodEntry{.name = method.name(),
                                                        .info = {.name = method.name(),
                                                                 .title = method.file.string(),
                                                                 .description = "",
                                                                 .source = ""},
                                                        .factories = {.planar = make}};
                                   }});

TEST(MethodScheme, MakesTheMethodsOfTheFile) {
  const auto method = make_method<2>("idle:folder/a:b.x:Name");
  EXPECT_EQ(method.info.title, "folder/a:b.x");
  ASSERT_EQ(method.stages.size(), 1U);
  EXPECT_EQ(method.stages[0]->name(), "Name");
  EXPECT_TRUE(supports_mesh_kind<2>("idle:f:Name"));
  EXPECT_FALSE(supports_mesh_kind<3>("idle:f:Name"));
  EXPECT_THAT(
      [] { (void)make_method<3>("idle:f:Name"); },
      ThrowsMessage<InputError>(HasSubstr("does not support volume meshes; choose one of")));
}

TEST(MethodScheme, FilesAreRelativeToAFolder) {
  EXPECT_EQ(method_name_in("there", "idle:f.x:Name"), "idle:there/f.x:Name");
  EXPECT_EQ(method_name_in("there", "idle:/f.x:Name"), "idle:/f.x:Name");
  EXPECT_EQ(method_name_in("", "idle:f.x:Name"), "idle:f.x:Name");
  EXPECT_EQ(method_name_in("there", "laplace"), "laplace");
  EXPECT_EQ(method_name_in("there", "other:f.x:Name"), "other:f.x:Name");
}

TEST(MethodScheme, RefusesIncompleteNames) {
  for (const char* name : {"idle:", "idle:f", "idle::Name", "idle:f:"})
    EXPECT_THAT([&] { (void)make_method<2>(name); },
                ThrowsMessage<InputError>(HasSubstr("write idle:FILE:NAME")))
        << name;
  EXPECT_THAT([] { (void)make_method<2>("other:f:Name"); },
              ThrowsMessage<InputError>(HasSubstr("there is no method 'other:f:Name'")));
}

}  // namespace
}  // namespace smoothfem
