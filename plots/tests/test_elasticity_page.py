# SPDX-License-Identifier: GPL-3.0-or-later
"""The outcome of the study elasticity: its criteria, with numbers that are known."""

import math
import tempfile
import unittest
from pathlib import Path

from plots.manual import elasticity

COLUMNS = ("mesh", "degree", "method", "h1_error") + tuple(
    f"{label}.{name}" for label in ("compressible", "incompressible")
    for name in ("n_dofs", "h1_error", "energy_error", "energy", *elasticity.SOLVERS))


def written(folder, quotients):
    """Three studies with one mesh each, whose error falls to 0.5, and to this multiple of it in elasticity. L rises from 2 to 3."""
    for study, quotient in zip(elasticity.STUDIES, quotients):
        lines = [",".join(COLUMNS)]
        for method, h1, factor in (("initial", 1.0, 1.0), (elasticity.METHOD, 0.5, quotient)):
            numbers = [8, h1 * factor, 1.0, 4.0, 10 * h1, 20 * h1, "nan" if method == "initial" else 3]
            lines.append(",".join(map(str, ["m", 1, method, h1, *numbers, *numbers[:2], 2.0 if method == "initial" else 3.0, *numbers[3:]])))
        (folder / study).mkdir()
        (folder / study / "summary.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


class Outcome(unittest.TestCase):
    def test_criteria(self):
        with tempfile.TemporaryDirectory() as name:
            written(Path(name), (0.9, 1.0, 1.1))
            made = elasticity.blocks(Path(name))
        self.assertIn("| gear | m | 1 | 0.500 | 0.450 | 0.450 | more |", made["help"])
        self.assertIn("| beam | m | 1 | 0.500 | 0.500 | 0.500 | as much |", made["help"])
        self.assertIn("| flange | m | 1 | 0.500 | 0.550 | 0.550 | less |", made["help"])
        self.assertIn("More on 1, as much on 1, less on 1 of 3 pairs. **By the criterion, it depends on the mesh.**", made["help"])
        self.assertIn("| beam | m | 2.00 | 3.00 | more |", made["locking"])
        self.assertIn("**By the criterion, smoothing increases locking.**", made["locking"])
        self.assertIn("| .499 | CG with multigrid | – | – | 0 | 3 |", made["iterations"])
        self.assertIn("| .3 | CG | 0.50 | 0.50 to 0.50 | 3 | 0 |", made["iterations"])

    def test_limits_of_the_sign_test(self):
        """10 of 12 equal signs: two-sided p = 0.039; 9 of 12: 0.146."""
        p = [2 * sum(math.comb(12, k) for k in range(least, 13)) / 2 ** 12 for least in (elasticity.LEAST_OF_TWELVE, 9)]
        self.assertAlmostEqual(p[0], 0.0386, 4)
        self.assertGreater(p[1], 0.05)


if __name__ == "__main__":
    unittest.main()
