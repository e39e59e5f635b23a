# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m docs.tests.gear_results: computes the results of `study gear --quick` for several pages. ctest runs it once."""

import os
import shutil
import sys

from launcher.tests.build_folder import BUILD, SMOOTHFEM, run

RESULTS = BUILD / "docs" / "results" / "gear"


def make():
    """Computes the results again, without figures."""
    shutil.rmtree(RESULTS, ignore_errors=True)
    RESULTS.parent.mkdir(parents=True, exist_ok=True)
    run(SMOOTHFEM, "study", "gear", "--quick", "--quiet", "--no-figures", "--out", RESULTS, folder=RESULTS.parent)


def copy_to(folder):
    """Copies the results into the folder `results` below a folder; computes them first if they are missing or older than the program."""
    program = os.stat(SMOOTHFEM.parents[1] / "libexec" / "smoothfem" / "smoothfem").st_mtime
    made = RESULTS / "tables"
    if not made.is_dir() or made.stat().st_mtime < program:
        make()
    shutil.copytree(RESULTS, folder / "results" / "gear")


if __name__ == "__main__":
    sys.exit(make())
