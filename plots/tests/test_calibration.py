# SPDX-License-Identifier: GPL-3.0-or-later
"""The calibration of GETMe adaptive: the presets have the pair that its design chooses (studies/reasons/README.md)."""

import importlib.util
import json
import sys
import unittest

from plots.claims.reasons import reference
from plots.results.data_folder import data_folder

STUDIES = data_folder() / "studies"


def distances():
    """The script of the calibration as a module."""
    described = importlib.util.spec_from_file_location("distance", STUDIES / "reasons" / "distance.py")
    module = importlib.util.module_from_spec(described)
    described.loader.exec_module(module)
    return module


class Calibration(unittest.TestCase):
    def test_distance_by_hand(self):
        distance = distances().distance
        self.assertAlmostEqual(distance("6/209", [215]), 0.0)
        self.assertAlmostEqual(distance("30/0", [15, 47]), 0.6931471806 + 3.8501476017)

    def test_presets_have_the_nearest_pair(self):
        module = distances()
        missing = [study for study in module.STUDIES if not (reference() / "reasons" / f"adaptive-{study}").is_dir()]
        if missing:
            print(f"SKIPPED: the calibration has no results of {', '.join(missing)}; run ./run reference reasons/adaptive-NAME", file=sys.stderr)
            self.skipTest("the calibration was not run")
        total = module.totals(module.counts(reference() / "reasons"), list(module.PRINTED))
        nearest = min(total, key=total.get)
        reading, fraction = nearest.split("-", 1)
        preset = json.loads((STUDIES / "presets" / "thesis-5.5.json").read_text(encoding="utf-8"))["volume"]["min"]
        self.assertEqual(preset["no_gain"][0], {"row": "in-a-row", "cycle": "in-cycle"}[reading])
        self.assertEqual(float(preset["fraction"][0]), float(fraction))
