# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures that a study can have: known by their names before anything is drawn."""

from dataclasses import dataclass
from typing import Callable

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


def save_figures(planned, study_title, folder, formats, report):
    """Draws figures into files in a folder; returns the paths. `report` takes a sentence on each figure that cannot be
    drawn here."""
    paths, failure = [], None
    for plan in planned:
        if plan.rendered and failure is not None:
            continue  # where one picture cannot be rendered none can, and each try takes its time
        try:
            figure = plan.draw()
        except NoDisplay as error:
            failure = error
            continue
        if figure is not None:
            paths += style.save_figure(figure, folder, plan.name, f"{study_title}: {plan.title}", formats)
    if failure is not None:
        report(f"No pictures of volume meshes and surfaces: {failure}.")
    return paths


def plan_numbered(results, figures):
    """Figures from name -> (number in the thesis or empty, title, how to draw it); only those of the
    program's own study have their numbers in their names."""
    def name_of(name, number):
        return "_".join(filter(None, ("figure", number, name))) if results.is_thesis_study else name
    return [PlannedFigure(name_of(name, number), title, lambda draw=draw: draw(results))
            for name, (number, title, draw) in figures.items()]
