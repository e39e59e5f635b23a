# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures that a study can have: known by their names before anything is drawn."""

import itertools
from dataclasses import dataclass
from typing import Callable

from ..results.processes import finished
from . import style
from .virtual_display import NoDisplay


@dataclass(frozen=True)
class PlannedFigure:
    """A figure by its file name without suffix; `draw` returns a figure of matplotlib, or None if
    there is nothing to show, and may raise NoDisplay."""

    name: str
    title: str
    draw: Callable
    rendered: bool = False  # whether it needs VTK's pictures
    whole: str = ""  # of one for some meshes: the name that all of them would have in one figure
    degree: str = ""  # of one for one of several degrees
    meshes: tuple = ()  # of one for some of several meshes

    def save(self, folder, formats):
        """Draws the figure into files in a folder; returns their paths. Raises NoDisplay."""
        figure = self.draw()
        return [] if figure is None else style.save_figure(figure, folder, self.name, self.title, formats)


def save_figures(planned, folder, formats, report, drawn=None, show=lambda n_done, n: None):
    """Draws figures into files in a folder; returns the paths of all, drawn now or before.

    report: takes a sentence on each figure that cannot be drawn here. drawn: the known figures of the folder; None: draw all.
    show: takes the numbers of finished figures and of all that are to be drawn. Figures are drawn in several processes; those
    with VTK's pictures in this one, because a virtual display serves one process."""
    paths = {plan.name: drawn.paths(plan.name) if drawn else None for plan in planned}
    missing = [plan for plan in planned if paths[plan.name] is None]
    count = itertools.count(1)

    def note(plan, made):
        paths[plan.name] = made
        if drawn:
            drawn.note(plan.name, made)
        show(next(count), len(missing))

    plain = [plan for plan in missing if not plan.rendered]
    for number, made in finished([lambda plan=plan: plan.save(folder, formats) for plan in plain]):
        note(plain[number], made)
    try:
        for plan in missing:
            if plan.rendered:
                note(plan, plan.save(folder, formats))
    except NoDisplay as error:  # where one picture cannot be rendered none can, and each try takes its time
        report(f"No pictures of volume meshes and surfaces: {error}.")
    return [path for plan in planned for path in paths[plan.name] or ()]


def plan_numbered(results, figures):
    """Figures from name -> (number in the thesis or empty, title, how to draw it); only those of the
    program's own study have their numbers in their names."""
    def name_of(name, number):
        return "_".join(filter(None, ("figure", number, name))) if results.is_thesis_study else name
    return [PlannedFigure(name_of(name, number), title, lambda draw=draw: draw(results))
            for name, (number, title, draw) in figures.items()]
