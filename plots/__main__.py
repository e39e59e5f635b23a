# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m plots <results folder>: makes the tables and figures of a study."""

import argparse
import sys

from .results.rows import ResultsError
from .results.write_files import write_atomically
from .study_kinds import outputs_of
from .tables.formats import as_latex, as_markdown, as_text


def parse_arguments(arguments):
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python3 -m plots", description="Makes tables and figures from a results folder.")
    parser.add_argument("folder", help="results folder of a study, e.g. results/gear")
    parser.add_argument("--quiet", action="store_true", help="print neither tables nor paths")
    parser.add_argument("--no-figures", action="store_true", help="make the tables only")
    return parser.parse_args(arguments)


def main(arguments=None):
    """Runs the command line; returns the exit code: 0, or 2 if the results cannot be used."""
    options = parse_arguments(arguments)
    # A terminal without UTF-8 gets replacement characters instead of an exception.
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")

    def tell(text):
        if not options.quiet:
            print(text)

    try:
        outputs = outputs_of(options.folder)
        paths = []
        for table in outputs.tables:
            tell(as_text(table))
            for suffix, write in ((".md", as_markdown), (".tex", as_latex)):
                path = outputs.folder / "tables" / (table.name + suffix)
                paths.append(write_atomically(path, write(table)))
        for name, text in outputs.texts.items():
            paths.append(write_atomically(outputs.folder / "tables" / name, text))
        if not options.no_figures:
            paths += outputs.draw(lambda sentence: print(sentence, file=sys.stderr))
    except ResultsError as error:
        print(error, file=sys.stderr)
        return 2
    except OSError as error:
        print(f"The files cannot be written: {error}.", file=sys.stderr)
        return 2
    for path in paths:
        tell(f"wrote {path}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
