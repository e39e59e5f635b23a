# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m plots.quality_histogram: what `smoothfem quality --histogram` starts."""

import sys

from .figures.quality_histogram import main

if __name__ == "__main__":
    sys.exit(main())
