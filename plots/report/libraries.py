# SPDX-License-Identifier: GPL-3.0-or-later
"""The page's libraries, from Debian's packages: Plotly (curves, meshes), jQuery and DataTables (tables)."""

import contextlib
import os
import shutil
import subprocess
from pathlib import Path

from ..results.write_files import write_atomically

JAVASCRIPT = Path("/usr/share/javascript")
PLOTLY = (Path("/usr/share/python3-plotly/plotly.js"), "python3-plotly")
LIBRARIES = ((JAVASCRIPT / "jquery/jquery.min.js", "libjs-jquery"),
             (JAVASCRIPT / "jquery-datatables/jquery.dataTables.min.js", "libjs-jquery-datatables"))


class NoLibrary(Exception):
    """A Debian package that the page needs is missing; the message is one sentence."""


def library(path, package):
    """The text of a library's file."""
    if not path.is_file():
        raise NoLibrary(f"No report.html: {path} is missing; install the Debian package {package}.")
    return path.read_text(encoding="utf-8")


def minified(path, package):
    """Returns the content of a file without blanks and comments."""
    if not path.is_file():
        library(path, package)
    state = path.stat()
    known = cache_folder() / f"{path.stem}-{state.st_size}-{state.st_mtime_ns}.min.js"
    with contextlib.suppress(OSError):
        return known.read_text(encoding="utf-8")
    if not shutil.which("esbuild"):
        raise NoLibrary("No report.html: esbuild is missing; install the Debian package esbuild.")
    text = subprocess.run(["esbuild", "--minify", "--charset=utf8", str(path)], check=True, capture_output=True,
                          text=True, encoding="utf-8").stdout
    with contextlib.suppress(OSError):  # the next page takes longer, that is all
        write_atomically(known, text)
    return text


def cache_folder():
    """The folder for what can be made again, by the convention of the XDG base directories."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "smoothfem"


def scripts(with_plots=True):
    """The texts of all of them, Plotly's only if wanted, in the order in which they need one another. Raises NoLibrary."""
    return [*([minified(*PLOTLY)] if with_plots else []), *(library(*file) for file in LIBRARIES)]
