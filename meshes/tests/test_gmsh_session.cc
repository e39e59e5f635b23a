// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmsh.h>

#include <csignal>

#include "meshes/tests/mesh_tests.h"
#include "meshes/tools/gmsh_session.h"
#include "smoothing/base/parallel.h"

namespace smoothfem {
namespace {

TEST(GmshSession, KeepsTheNumberOfThreads) {
  for (const int threads : {3, 2}) {
    set_n_threads(threads);
    { const GmshSession session; }
    EXPECT_EQ(n_threads(), threads);
  }
}

/// Gmsh must not replace them: interrupted studies finish cleanly.
TEST(GmshSession, KeepsSignalHandlers) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const auto handler = [](int) {};
    const auto former = std::signal(signal, handler);
    { const GmshSession session; }
    EXPECT_EQ(std::signal(signal, former), static_cast<void (*)(int)>(handler));
  }
}

TEST(GmshSession, NestsAndSeparatesOptionsAndModels) {
  const auto option = [] {
    double value = 0.0;
    gmsh::option::getNumber("Mesh.SaveAll", value);
    return value;
  };
  GmshSession outer;
  outer.set_option("Mesh.SaveAll", 1);
  gmsh::model::addDiscreteEntity(2, 17);
  {
    GmshSession inner;
    inner.set_option("Mesh.SaveAll", 0);
    gmsh::vectorpair entities;
    gmsh::model::getEntities(entities);
    EXPECT_TRUE(entities.empty());
    EXPECT_EQ(option(), 0.0);
  }
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities);
  EXPECT_EQ(entities, (gmsh::vectorpair{{2, 17}}));
  EXPECT_EQ(option(), 1.0);
}

TEST(GmshSession, PassesOnErrorMessages) {
  const GmshSession session;
  EXPECT_EQ(input_error_of([&] { session.run("here", [] { throw std::string("words"); }); }),
            "here: Gmsh: words");
}

}  // namespace
}  // namespace smoothfem
