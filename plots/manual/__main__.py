# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m plots.manual: writes the generated blocks of README.md, docs/ and paper/ anew."""

import sys

from ..results.rows import ResultsError
from ..results.write_files import write_atomically
from .blocks import updated
from .pages import blocks


def main():
    """Writes the pages; returns the exit code."""
    try:
        texts = {path: updated(path, made) for path, made in blocks().items()}
        for path, text in texts.items():
            write_atomically(path, text)
    except (OSError, ResultsError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
