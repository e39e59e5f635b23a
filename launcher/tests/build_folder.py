# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths of the build folder for tests: SMOOTHFEM_BUILD, which ctest sets."""

import os
import subprocess
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("SMOOTHFEM_BUILD", SOURCE / "build" / "release"))
SMOOTHFEM = BUILD / "bin" / "smoothfem"
COMMANDS = ("study", "smooth", "quality", "check", "repair", "convert", "generate", "list", "merge", "new-smoother", "new-problem")
DRAWING = ("plot", "report")  # commands of the launcher, not of the program


def environment(**more):
    """Returns the environment of a user, with additional variables; the value None removes a variable."""
    merged = {**os.environ, **more}
    for name in ("SMOOTHFEM_DATA", "SMOOTHFEM_PUBLISHED_URL", "CI", "MAKEFLAGS"):
        if name not in more:
            merged.pop(name, None)
    return {name: str(value) for name, value in merged.items() if value is not None}


def run(*command, folder=None, check=True, timeout=600, **more):
    """Runs a command and returns its result; raises AssertionError with its messages if it fails."""
    outcome = subprocess.run([str(word) for word in command], cwd=folder, env=environment(**more), text=True,
                             stdin=subprocess.DEVNULL, capture_output=True, check=False, timeout=timeout)
    if check and outcome.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: exit code {outcome.returncode}\n"
                             f"{outcome.stdout[-2000:]}\n{outcome.stderr[-2000:]}")
    return outcome

