// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/tests/edited_studies.h"

namespace smoothfem {
namespace {

TEST_F(EditedStudies, EndWithTheRowsOfAFreshRunAfterTwoHundredEdits) {
  edit_and_compare(200, 2);
}

}  // namespace
}  // namespace smoothfem
