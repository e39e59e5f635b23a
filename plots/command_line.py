# SPDX-License-Identifier: GPL-3.0-or-later
"""The command lines of the package."""

import argparse
import math
import re
import sys
from pathlib import Path

from .make_outputs import FORMATS, TABLE_FORMATS, is_figure, is_table, make_study, request_of, say, suffix_of
from .report.libraries import NoLibrary
from .results.quality_histogram import read_quality_histogram
from .results.rows import ResultsError
from .study_kinds import outputs_of

HISTOGRAM, REPORT = "histogram", "report"
UNITS = {"in": 1.0, "": 1.0, "cm": 1 / 2.54, "mm": 1 / 25.4}  # inches
FORMAT = "pdf,png"  # unless another is asked for
WIDTHS = (2.0, 30.0)  # inches


def names(text):
    """The items of "a, b", for argparse."""
    return tuple(filter(None, (item.strip() for item in text.split(","))))


def width(text):
    """Inches of "84mm", "8.4cm", "3.3in" or "3.3", for argparse."""
    match = re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*(mm|cm|in|)\s*", text)
    inches = float(match[1]) * UNITS[match[2]] if match else 0.0
    if not WIDTHS[0] <= inches <= WIDTHS[1]:
        raise argparse.ArgumentTypeError(f"'{text}' is not a width from {WIDTHS[0]:.0f}in to {WIDTHS[1]:.0f}in, "
                                         "such as 84mm, 8.4cm or 3.3in")
    return inches


def axis_range(text):
    """(from, to) of "0.1:0.5", None for an end that is left out, for argparse."""
    try:
        low, high = (float(end) if end.strip() else None for end in text.split(":"))
    except ValueError:
        low = high = None
    ends = [end for end in (low, high) if end is not None]
    if not ends or not all(map(math.isfinite, ends)) or ends != sorted(set(ends)):
        raise argparse.ArgumentTypeError(f"'{text}' is not a range such as 0:0.5, 0.1: or :0.5")
    return low, high


def formats(text):
    """The formats in "pdf, svg", for argparse."""
    wanted = names(text)
    if not wanted or not set(wanted) <= set(FORMATS):
        raise argparse.ArgumentTypeError(f"'{text}' is not a list of formats; choose from {', '.join(FORMATS)}")
    return wanted


class Parser(argparse.ArgumentParser):
    """Refuses a command line in one sentence."""

    def error(self, message):
        self.exit(2, f"{self.prog}: {message}; --help lists the options.\n")


def output_path(text):
    """The path of a file or folder, for argparse. Refuses what looks like a file of a format that cannot be written."""
    path = Path(text)
    suffix = suffix_of(path)
    is_known = suffix in FORMATS or suffix in TABLE_FORMATS
    if re.fullmatch("[a-z]{2,5}", suffix) and not is_known and not text.endswith("/") and not path.is_dir():
        raise argparse.ArgumentTypeError(f"{suffix} is not one of {', '.join(FORMATS)} (figures) and {', '.join(TABLE_FORMATS)} (tables); "
                                         f"for a folder of this name, write {text}/")
    return path


def parse_study(arguments):
    """The command line for a results folder."""
    parser = Parser(
        prog="smoothfem plot", description="Regenerates tables and figures of a results folder.",
        epilog="Lists are separated by commas. From the sources: python3 -m plots FOLDER. "
               f"python3 -m plots {HISTOGRAM} --help: numbers of cells by mean ratio as a figure.")
    parser.add_argument("folder", help="results folder of a study, e.g. results/gear")
    parser.add_argument("--only", type=names, default=(), metavar="NAMES",
                        help="only these figures and tables, by their file names with or without number; "
                        "patterns such as 'history*' are allowed")
    parser.add_argument("--methods", type=names, default=(), help="only these methods, by their labels or titles; each keeps "
                        "its colour and mark")
    parser.add_argument("--meshes", type=names, default=(), help="only these meshes, by their labels or titles")
    parser.add_argument("--degrees", type=names, default=(), help="only these degrees of the finite elements")
    parser.add_argument("--columns", type=names, default=(), metavar="COLUMNS",
                        help="make one table of these columns of summary.csv, by their names or headings: "
                        "mesh,method,H1,q_min; without --only nothing else is made")
    parser.add_argument("--y", type=names, default=(), metavar="COLUMNS",
                        help="draw these columns of iterations.csv, by their names or headings such as 'cond(A)' or H1 (the true "
                        "error), each in a row of panels; without --only nothing else is made")
    parser.add_argument("--x", default="", metavar="COLUMN",
                        help="horizontal axis of these panels: this column (default: smoothing time)")
    parser.add_argument("--log-x", action="store_true", help="logarithmic horizontal axis for these panels")
    parser.add_argument("--log-y", action="store_true", help="logarithmic vertical axes for these panels")
    for axis in "xy":
        parser.add_argument(f"--{axis}-range", type=axis_range, default=(None, None), metavar="FROM:TO",
                            help=f"ends of the {'horizontal' if axis == 'x' else 'vertical'} axes of these panels; an end that is left "
                            "out fits the numbers: :0.5")
    parser.add_argument("--width", type=width, metavar="WIDTH",
                        help="width of the figures: 84mm, 8.4cm, 3.3in; inches without a unit "
                        "(default: 7 inches, narrower where there is little to show)")
    parser.add_argument("--format", type=formats, metavar="FORMATS", help=f"pdf, png or svg (default: {FORMAT})")
    parser.add_argument("-o", "--out", type=output_path, metavar="PATH",
                        help="folder for the folders tables and figures (default: FOLDER). With the suffix "
                        f"{', '.join(f'.{name}' for name in (*FORMATS, *TABLE_FORMATS))}: "
                        "exactly this file, for the one chosen figure or table")
    parser.add_argument("--no-figures", action="store_true", help="make the tables only")
    parser.add_argument("--verbose", action="store_true", help="print all tables and the paths of all files")
    parser.add_argument("--quiet", action="store_true", help="print nothing but warnings")
    parser.add_argument("--reload", action="store_true", help=argparse.SUPPRESS)  # of `study --watch`
    options = parser.parse_args(arguments)
    if options.no_figures and is_figure(options.out):
        parser.error(f"{options.out} is a figure, but --no-figures asks for none; leave out one of them")
    if options.no_figures and request_of(options).has_history:
        parser.error("--x, --y, --log-x, --log-y, --x-range and --y-range are about figures: leave out --no-figures")
    if options.columns and request_of(options).has_history:
        parser.error("--columns makes a table, --x, --y and their options figures: use one command for each")
    if options.format and (is_figure(options.out) or is_table(options.out)) and options.format != (suffix_of(options.out),):
        parser.error(f"{options.out} says the format already; leave out --format")
    options.format = options.format or formats(FORMAT)
    return options


def parse_histogram(arguments):
    """The command line for a histogram."""
    parser = Parser(
        prog=f"python3 -m plots {HISTOGRAM}",
        description="Draws numbers of cells by mean ratio, types of cells on top of each other.")
    parser.add_argument("counts", type=Path, help="CSV file with the columns lower, upper, count and, if "
                        "there is more than one type, cell_type")
    parser.add_argument("figure", type=Path, help="file to write: .pdf, .png or .svg")
    parser.add_argument("--title", help="title of the figure (default: the name of the CSV file)")
    parser.add_argument("--q-min", type=float, help="lowest mean ratio, drawn as a line")
    parser.add_argument("--q-mean", type=float, help="arithmetic mean, drawn as a line")
    parser.add_argument("--n-invalid", type=int, default=0, help="invalid cells, named in the title")
    return parser.parse_args(arguments)


def parse_report(arguments):
    """The command line for a report."""
    parser = Parser(
        prog="smoothfem report", description="Writes a results folder as one page, report.html, that opens without a "
        "network: tables to sort and filter, curves, meshes, claims, provenance.",
        epilog="A study writes its page when it ends; this command regenerates it, or compares two folders. Example: "
               "smoothfem report results/gear --against results/gear-before")
    parser.add_argument("folder", type=Path, help="results folder of a study, e.g. results/gear")
    parser.add_argument("--against", type=Path, metavar="DIR", help="another results folder of the same study, to compare with")
    parser.add_argument("--out", type=Path, metavar="FILE", help="page to write (default: FOLDER/report.html)")
    parser.add_argument("--quiet", action="store_true", help="do not print the path")
    return parser.parse_args(arguments)


def make_report(options):
    """Writes report.html; raises ResultsError, NoLibrary or OSError."""
    outputs = outputs_of(options.folder)
    path = outputs.write_page(options.against, options.out)
    if not options.quiet:
        say(f"wrote {path}")


def make_histogram(options):
    """Draws a histogram; raises ResultsError or OSError."""
    # Matplotlib takes a second to load.
    from .figures.quality_histogram import SUFFIXES, write_quality_histogram

    if options.figure.suffix.lower() not in SUFFIXES:
        raise ResultsError(f"{options.figure}: a figure ends with {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}.")
    title = options.counts.name if options.title is None else options.title
    write_quality_histogram(read_quality_histogram(options.counts, title, options.q_min, options.q_mean,
                                                   options.n_invalid), options.figure)


def run(arguments):
    """Runs a command line; returns the exit code: 0, or 2 if the results cannot be used."""
    # A terminal without UTF-8 gets replacement characters instead of an exception.
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")
    try:
        if arguments[:1] == [HISTOGRAM]:
            make_histogram(parse_histogram(arguments[1:]))
        elif arguments[:1] == [REPORT]:
            make_report(parse_report(arguments[1:]))
        else:
            make_study(parse_study(arguments))
    except (ResultsError, NoLibrary) as error:
        print(error, file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("Interrupted; the same command makes the other files.", file=sys.stderr)
        return 130
    except OSError as error:
        print(f"The files cannot be written: {error}.", file=sys.stderr)
        return 2
    return 0
