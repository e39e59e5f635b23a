# SPDX-License-Identifier: GPL-3.0-or-later
"""The command lines of the package."""

import argparse
import math
import os
import re
import sys
import time
from dataclasses import replace
from pathlib import Path

from .results.drawn import Drawn, inputs_of
from .results.names import select, short_name
from .results.processes import finished
from .results.quality_histogram import read_quality_histogram
from .report.libraries import NoLibrary
from .results.request import Request
from .results.rows import ResultsError
from .results.write_files import write_atomically
from .study_kinds import outputs_of
from .tables.chosen import CHOSEN
from .tables.formats import as_csv, as_markdown, as_text
from .tables.latex import as_latex

HISTOGRAM, REPORT = "histogram", "report"
FORMATS = ("pdf", "png", "svg")
TABLE_FORMATS = {"csv": as_csv, "md": as_markdown, "tex": as_latex}
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


def suffix_of(path):
    """The suffix without its point, in lower case."""
    return path.suffix[1:].lower()


def is_figure(path):
    """True if the path has the suffix of a figure; False for None and for a folder."""
    return path is not None and suffix_of(path) in FORMATS and not path.is_dir()


def is_table(path):
    """True if the path has the suffix of a table; False for None and for a folder."""
    return path is not None and suffix_of(path) in TABLE_FORMATS and not path.is_dir()


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


def request_of(options):
    """The request of a command line."""
    return Request(options.methods, options.meshes, options.x, options.y, options.log_x, options.log_y, options.degrees,
                   options.x_range, options.y_range, options.columns)


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


def warn(sentence):
    """Prints a sentence on something that is left out."""
    print(sentence, file=sys.stderr)


def say(text):
    """Prints a text as long as somebody reads it: after `| head`, the files are still made."""
    try:
        print(text, flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def planned_figures(outputs, request, only, width, report=None):
    """The figures to choose from. Meshes are read only if figures of them may be among those chosen."""
    # Matplotlib takes a second to load.
    from .figures.style import FULL_WIDTH, apply_style

    if width and width < outputs.least_width:
        raise ResultsError(f"{outputs.folder}: the figures of this kind of study are at least "
                           f"{outputs.least_width}in wide; choose a larger --width.")
    apply_style(width or FULL_WIDTH)
    planned = outputs.plan()
    known = {*outputs.names, *(name for figure in planned for name in (figure.name, figure.whole))}
    known |= {short_name(name) for name in known}
    if known.issuperset(only) if only else request.has_history:
        return planned
    return outputs.plan_of_meshes(report or warn) + planned


def is_whole(options, request):
    """True if the user asks for all that a study makes."""
    return not (options.only or options.no_figures or options.out or request != Request())


def make_study(options):
    """Makes the tables and figures of a study; raises ResultsError or OSError. Problems of
    the results are found before the first file is written."""
    request = request_of(options)
    outputs = outputs_of(options.folder, request)
    if is_whole(options, request):
        return make_all(options, outputs)
    only_tables = options.no_figures or is_table(options.out) or (request.columns and not options.only)
    figures = [] if only_tables else planned_figures(outputs, request, options.only, options.width)
    drawn = {figure.name: figure.whole for figure in figures}
    wanted = (select(options.only, {**dict.fromkeys(outputs.names, ""), **drawn}) if options.only else
              set(drawn) if request.has_history else {CHOSEN} if request.columns else {*outputs.names, *drawn})
    tables = [table for table in outputs.tables if table.name in wanted or table.name == CHOSEN]
    if is_figure(options.out):
        return make_chosen_figure(options, [figure for figure in figures if figure.name in wanted])
    if is_table(options.out):
        return make_chosen_table(options, tables)
    folder = options.out or outputs.folder
    show_results(options, outputs, tables, options.only or request.columns)
    paths = write_tables(outputs, tables, [name for name in outputs.texts if name in wanted], folder)
    if not wanted.isdisjoint(drawn):
        from .figures.planned import save_figures
        paths += save_figures([figure for figure in figures if figure.name in wanted], folder / "figures", options.format, warn)
    show_paths(options, outputs, paths, folder)
    if options.no_figures and not options.out and Drawn(outputs.folder, "").figures:
        warn_about_old_figures(options, outputs)


def warn_about_old_figures(options, outputs):
    """Says that the figures and the page are of earlier results, if they are."""
    drawn = Drawn(outputs.folder, inputs_of(outputs.folder, outputs.provenance, [options.width, options.format]))
    if drawn.all_paths() is None:
        warn(f"The figures and report.html in {outputs.folder} are of earlier results; 'smoothfem plot {outputs.folder}' makes new "
             "ones.")


def make_all(options, outputs):
    """Makes all tables, the page and those figures that have changed. Problems of the results are found before the first
    file is written."""
    drawn = Drawn(outputs.folder, inputs_of(outputs.folder, outputs.provenance, [options.width, options.format]))
    figures, sentences, planned = drawn.all_paths(), [], None
    if figures is None:
        planned = planned_figures(outputs, Request(), (), options.width, sentences.append)
    show_results(options, outputs, outputs.tables)
    paths = write_tables(outputs, outputs.tables, outputs.texts, outputs.folder)
    draw = [] if planned is None else [lambda: draw_changed(options, planned, drawn, sentences)]
    page = [lambda: write_page(outputs, options.reload)]
    # The page takes as long as some figures, so it is made at the same time, unless it shows them.
    for tasks in (draw, page) if outputs.page_shows_figures else (draw + page,):
        for made, remarks in dict(finished(tasks)).values():
            paths += made
            sentences += remarks
    for sentence in sentences:
        warn(sentence)
    show_paths(options, outputs, paths + (figures or []), outputs.folder)


def write_page(outputs, reload):
    """Writes report.html; returns its path and sentences for the user."""
    try:
        return [outputs.write_page(reload=reload)], []
    except NoLibrary as error:  # tables and figures are complete without the page
        return [], [str(error)]


def draw_changed(options, planned, drawn, left_out):
    """Draws the figures that have changed; returns the paths of all of them and sentences for the user. left_out: sentences on
    figures that could not be planned; the next run tries them again."""
    from .figures.planned import save_figures
    progress, sentences = FigureProgress(options.quiet), []
    paths = save_figures(planned, drawn.folder, options.format, sentences.append, drawn, progress.show)
    drawn.save(None if left_out or sentences else [figure.name for figure in planned])
    progress.end()
    return paths, sentences


class FigureProgress:
    """Shows the number of finished figures on a terminal, and the time at the end."""

    def __init__(self, quiet):
        self.quiet, self.on_terminal, self.began = quiet, sys.stderr.isatty(), time.monotonic()
        if not quiet and not self.on_terminal:
            warn("Figures")

    def show(self, n_done, n):
        """Takes the numbers of finished figures and of all."""
        if not self.quiet and self.on_terminal:
            print(f"\rFigures: {n_done} of {n}", end="", file=sys.stderr, flush=True)

    def end(self):
        """Replaces the numbers by the time."""
        if not self.quiet:
            warn(("\r\033[KFigures: " if self.on_terminal else "  done in ") + f"{time.monotonic() - self.began:.1f} s")


def show_results(options, outputs, tables, in_full=False):
    """Prints warnings, and the results: whole tables if the user wants them."""
    for sentence in outputs.warnings:
        warn(sentence)
    if not options.quiet:
        say("\n".join(as_text(table) for table in tables) if options.verbose or in_full else outputs.screen)


def write_tables(outputs, tables, texts, folder):
    """Writes tables and the texts of these names; returns the paths."""
    files = [(f"{table.name}.{suffix}", write(table)) for table in tables for suffix, write in TABLE_FORMATS.items()]
    files += [(f"{name}.md", outputs.texts[name]) for name in texts]
    return [write_atomically(folder / "tables" / name, text) for name, text in files]


def show_paths(options, outputs, paths, folder):
    """Prints where the files are."""
    if options.quiet:
        return
    for sentence in ((*(f"wrote {path}" for path in paths), *outputs.remarks) if options.verbose else
                     [summary_of(paths, folder)]):
        say(sentence)


def summary_of(paths, folder):
    """Returns a sentence with the number of files and their folder."""
    page = [path for path in paths if path.suffix == ".html"]
    count = f"{len(paths)} file{'' if len(paths) == 1 else 's'}"
    return (f"Wrote {count} to {folder}; --verbose lists them." +
            (f" Open {page[0]} in a browser." if page else ""))


def options_that_select(figures):
    """The options that choose one of several figures."""
    differs = {"--degrees": len({figure.degree for figure in figures}) > 1,
               "--meshes": len({figure.meshes for figure in figures}) > 1}
    return " and ".join(option for option, helps in differs.items() if helps) or "--only"


def listed(names, most=4):
    """Some of the names, and the number of the others."""
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


def make_chosen_figure(options, chosen):
    """Draws the one chosen figure into the given file; raises ResultsError or OSError."""
    from .figures.planned import save_figures
    if not chosen:
        raise ResultsError(f"{options.folder}: there is no figure to draw into {options.out}; choose others by --only or --y.")
    if len(chosen) > 1:
        raise ResultsError(f"{options.out} has room for one figure, but there are {len(chosen)}: "
                           f"{listed([figure.name for figure in chosen])}; choose one by {options_that_select(chosen)}, or give a "
                           "folder.")
    paths = save_figures([replace(chosen[0], name=options.out.stem)], options.out.parent, (options.out.suffix[1:],), warn)
    if not paths:
        raise ResultsError(f"{options.folder}: there is no figure to draw into {options.out}; choose others by --only or --y.")
    if not options.quiet:
        say(f"wrote {paths[0]}")


def make_chosen_table(options, tables):
    """Writes the one chosen table into the given file; raises ResultsError or OSError."""
    if len(tables) != 1:
        raise ResultsError(f"{options.out} has room for one table, but there are {len(tables)}"
                           f"{': ' if tables else ''}{listed([table.name for table in tables])}; choose one by --only or --columns, or "
                           "give a folder.")
    # The label in LaTeX comes from the name: a paper may have several such tables.
    table = replace(tables[0], name=options.out.stem)
    path = write_atomically(options.out, TABLE_FORMATS[suffix_of(options.out)](table))
    if not options.quiet:
        say(f"{as_text(tables[0])}wrote {path}")


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
