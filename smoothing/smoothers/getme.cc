#include "smoothing/loop/catalogue.h"

namespace smoothfem {
namespace {

/// The simultaneous method for the mean quality, then the sequential one for the lowest.
Stages make_stages() {
  Stages stages = stages_of("getme-simultaneous");
  for (auto& stage : stages_of("getme-sequential")) stages.push_back(std::move(stage));
  return stages;
}

const RegisteredMethod registered({.name = "getme",
                                   .title = "GETMe",
                                   .description = "GETMe simultaneous, then GETMe sequential from "
                                                  "its best mesh",
                                   .source = "Section 4.4; parameters of Section 6.2"},
                                  make_stages);

}  // namespace
}  // namespace smoothfem
