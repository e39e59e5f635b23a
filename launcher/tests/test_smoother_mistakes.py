# SPDX-License-Identifier: GPL-3.0-or-later
"""For an incomplete smoother, the first compiler message is a sentence that names the missing part."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

SMOOTHER = """#include "smoothing/loop/catalogue.h"
namespace smoothfem {
template <int dim>
class Incomplete final %s {
 public:
  %s
  %s
};
const RegisteredMethod registered({.name = "incomplete"}, single_stage<Incomplete>());
}  // namespace smoothfem
"""
BASE = ": public Smoother<dim>"
NAME = 'std::string_view name() const override { return "incomplete"; }'
STEP = "StepReport step(SmoothingState<dim>&) override { return {}; }"


class SmootherMistakes(unittest.TestCase):
    def errors(self, *parts):
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder) / "incomplete.cc"
            source.write_text(SMOOTHER % parts, encoding="utf-8")
            result = subprocess.run(
                [os.environ.get("CXX", "c++"), "-std=c++20", "-fsyntax-only", f"-I{ROOT}", "-isystem",
                 "/usr/include/eigen3", source], capture_output=True, text=True, check=False)
        return [line for line in result.stderr.splitlines() if "error:" in line]

    def test_a_complete_one_compiles(self):
        self.assertEqual(self.errors(BASE, NAME, STEP), [])

    def test_what_is_missing_is_said_first(self):
        for parts, sentence in (((BASE, NAME, ""), "a smoother needs 'std::string_view name()"),
                                ((BASE, "", STEP), "a smoother needs 'std::string_view name()"),
                                (("", "", ""), "a smoother derives from Smoother<dim>")):
            errors = self.errors(*parts)
            self.assertTrue(errors and sentence in errors[0], errors)


if __name__ == "__main__":
    unittest.main()
