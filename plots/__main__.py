# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m plots FOLDER: the tables and figures of a study from its results folder.
python3 -m plots histogram COUNTS.csv FIGURE: numbers of cells by mean ratio as a figure."""

import sys

# Imported package -> its Debian package.
NEEDED = {"numpy": "python3-numpy", "scipy": "python3-scipy", "matplotlib": "python3-matplotlib"}


def main(arguments=None):
    """Runs the command line; returns the exit code: 0, or 2 if something given cannot be used."""
    try:
        from .command_line import run
        return run(sys.argv[1:] if arguments is None else arguments)
    except ImportError as error:
        package = NEEDED.get((error.name or "").partition(".")[0])
        if package is None:
            raise
        print(f"{sys.executable}: {error}; install the Debian package {package}, or start another python3 "
              "(smoothfem takes the one that the environment variable SMOOTHFEM_PYTHON names).",
              file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
