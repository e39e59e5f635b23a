# SPDX-License-Identifier: GPL-3.0-or-later
"""Location of the data that come with the program: printed values and claims of the thesis."""

import os
from pathlib import Path

from .rows import ResultsError

PACKAGE = Path(__file__).resolve().parents[1]
THESIS = Path("studies", "thesis")  # what the folder has


def data_folder():
    """The folder above studies/thesis. The environment variable SMOOTHFEM_DATA can name it; otherwise it is the one
    above this package (the repository, or share/smoothfem of an installation), else share/smoothfem of the prefix that
    this package is installed under. Raises ResultsError if it does not exist."""
    chosen = os.environ.get("SMOOTHFEM_DATA")
    if chosen:
        if not (Path(chosen) / THESIS).is_dir():
            raise ResultsError(f"SMOOTHFEM_DATA: {chosen} has no folder {THESIS}.")
        return Path(chosen)
    for folder in (PACKAGE.parent, *(prefix / "share" / "smoothfem" for prefix in PACKAGE.parents)):
        if (folder / THESIS).is_dir():
            return folder
    raise ResultsError(f"{PACKAGE.parent}: there is no folder {THESIS}, nor in share/smoothfem of a folder "
                       "above; set SMOOTHFEM_DATA to the folder that has it.")


def study_files():
    """The files of the built-in studies, by name."""
    return {path.stem: path for path in sorted((data_folder() / "studies" / "catalogue").glob("*/*.prm"))}


def thesis_folder():
    """The folder of printed values, deviations and claims; its README.md explains the files."""
    return data_folder() / THESIS
