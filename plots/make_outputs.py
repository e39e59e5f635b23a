# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the tables, figures and the page of a results folder, as a command line asks for them."""

import os
import sys
import time
from dataclasses import replace

from .results.drawn import Drawn, inputs_of
from .results.names import select, short_name
from .results.processes import finished
from .results.request import Request
from .results.rows import ResultsError
from .results.write_files import write_atomically
from .report.libraries import NoLibrary
from .study_kinds import outputs_of
from .tables.chosen import CHOSEN
from .tables.formats import as_csv, as_markdown, as_text
from .tables.latex import as_latex

TABLE_FORMATS = {"csv": as_csv, "md": as_markdown, "tex": as_latex}
FORMATS = ("pdf", "png", "svg")


def suffix_of(path):
    """The suffix without its point, in lower case."""
    return path.suffix[1:].lower()


def is_figure(path):
    """True if the path has the suffix of a figure; False for None and for a folder."""
    return path is not None and suffix_of(path) in FORMATS and not path.is_dir()


def is_table(path):
    """True if the path has the suffix of a table; False for None and for a folder."""
    return path is not None and suffix_of(path) in TABLE_FORMATS and not path.is_dir()


def request_of(options):
    """The request of a command line."""
    return Request(options.methods, options.meshes, options.x, options.y, options.log_x, options.log_y, options.degrees,
                   options.x_range, options.y_range, options.columns)


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
    """Writes tables and the texts of these names; returns the paths. Removes tables of solvers that no longer have numbers."""
    made = {table.name for table in outputs.tables}
    for pattern in ("table_solver_*.*", "table_budgets_*.*", "table_orders_*.*"):
        for path in (folder / "tables").glob(pattern):
            if path.stem not in made:
                path.unlink(missing_ok=True)
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
