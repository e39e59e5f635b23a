# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m plots FOLDER: the tables and figures of a study from its results folder.
python3 -m plots histogram COUNTS.csv FIGURE: numbers of cells by mean ratio as a figure."""

import argparse
import sys
from pathlib import Path

from .results.quality_histogram import read_quality_histogram
from .results.rows import ResultsError
from .results.write_files import write_atomically
from .study_kinds import outputs_of
from .tables.formats import as_latex, as_markdown, as_text

HISTOGRAM = "histogram"


def parse_study(arguments):
    """The command line for a results folder."""
    parser = argparse.ArgumentParser(
        prog="python3 -m plots", description="Makes tables and figures from a results folder.",
        epilog=f"python3 -m plots {HISTOGRAM} --help: numbers of cells by mean ratio as a figure.")
    parser.add_argument("folder", help="results folder of a study, e.g. results/gear")
    parser.add_argument("--quiet", action="store_true", help="print neither tables nor paths")
    parser.add_argument("--no-figures", action="store_true", help="make the tables only")
    return parser.parse_args(arguments)


def parse_histogram(arguments):
    """The command line for a histogram."""
    parser = argparse.ArgumentParser(
        prog=f"python3 -m plots {HISTOGRAM}",
        description="Draws numbers of cells by mean ratio, types of cells on top of each other.")
    parser.add_argument("counts", type=Path, help="CSV file with the columns lower, upper, count and, if "
                        "there is more than one type, cell_type")
    parser.add_argument("figure", type=Path, help="file to write: .pdf, .png or .svg")
    parser.add_argument("--title", help="what stands over the figure; the name of the CSV file if not given")
    parser.add_argument("--q-min", type=float, help="lowest mean ratio, drawn as a line")
    parser.add_argument("--q-mean", type=float, help="arithmetic mean, drawn as a line")
    parser.add_argument("--n-invalid", type=int, default=0, help="invalid cells, named in the title")
    return parser.parse_args(arguments)


def make_study(options):
    """Makes the tables and figures of a study; raises ResultsError or OSError."""
    def tell(text):
        if not options.quiet:
            print(text)

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
    for path in paths:
        tell(f"wrote {path}")


def make_histogram(options):
    """Draws a histogram; raises ResultsError or OSError."""
    # Matplotlib takes a second to load.
    from .figures.quality_histogram import SUFFIXES, write_quality_histogram

    if options.figure.suffix.lower() not in SUFFIXES:
        raise ResultsError(f"{options.figure}: a figure ends with {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}.")
    title = options.counts.name if options.title is None else options.title
    write_quality_histogram(read_quality_histogram(options.counts, title, options.q_min, options.q_mean,
                                                   options.n_invalid), options.figure)


def main(arguments=None):
    """Runs the command line; returns the exit code: 0, or 2 if the results cannot be used."""
    arguments = sys.argv[1:] if arguments is None else arguments
    # A terminal without UTF-8 gets replacement characters instead of an exception.
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")
    try:
        if arguments[:1] == [HISTOGRAM]:
            make_histogram(parse_histogram(arguments[1:]))
        else:
            make_study(parse_study(arguments))
    except ResultsError as error:
        print(error, file=sys.stderr)
        return 2
    except OSError as error:
        print(f"The files cannot be written: {error}.", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
