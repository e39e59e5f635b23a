# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m plots.quality_histogram FILE: the histogram that `smoothfem quality` writes.

Reads JSON from the standard input: `title`, `n_invalid`, `q_min`, `q_mean`, and
`histogram`, for each cell type the numbers of cells in equal parts of [0, 1].
"""

import json
import sys
from pathlib import Path

import numpy as np

from .results.quality_histogram import QualityHistogram


def from_json(text):
    """The numbers as a QualityHistogram."""
    numbers = json.loads(text)
    counts = {name: np.array(of_type) for name, of_type in numbers["histogram"].items()}
    edges = np.arange(len(next(iter(counts.values()))) + 1)
    edges = edges / edges[-1]
    return QualityHistogram(numbers["title"], edges[:-1], edges[1:], counts, numbers["q_min"],
                            numbers["q_mean"], numbers["n_invalid"])


def main(arguments=None, stream=None):
    """Runs the command line; returns the exit code: 0, or 2 if the file cannot be written."""
    from .figures.quality_histogram import SUFFIXES, write_quality_histogram

    arguments = sys.argv[1:] if arguments is None else arguments
    if len(arguments) != 1 or Path(arguments[0]).suffix.lower() not in SUFFIXES:
        print("Give one file that ends with .pdf, .png or .svg.", file=sys.stderr)
        return 2
    histogram = from_json((stream or sys.stdin).read())
    try:
        write_quality_histogram(histogram, arguments[0])
    except OSError as error:
        print(f"The figure cannot be written: {error}.", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
