# SPDX-License-Identifier: GPL-3.0-or-later
"""A user's request for some of the tables and figures."""

from dataclasses import dataclass

from .symbols import short_column

TIME = "smoothing_seconds"
LONGEST = 34  # letters of a history's name, without the degree and the mesh that may follow
MORE = "more"  # for the columns that the name has no room for


@dataclass(frozen=True)
class Request:
    """Some methods, meshes and degrees, and columns of iterations.csv against another one; nothing: all. Ranges of axes:
    (from, to), None where the data decide."""

    methods: tuple = ()
    meshes: tuple = ()
    x: str = ""
    y: tuple = ()
    log_x: bool = False
    log_y: bool = False
    degrees: tuple = ()
    x_range: tuple = (None, None)
    y_range: tuple = (None, None)
    columns: tuple = ()  # of summary.csv, for one table

    @property
    def has_history(self):
        """True if the user asks for a history that is not drawn by default."""
        return bool(self.x or self.y or self.log_x or self.log_y
                    or any(end is not None for end in (*self.x_range, *self.y_range)))

    @property
    def history_name(self):
        """The name of its figure: history_h1_cond_iterations_log."""
        after = [*([short_column(self.x)] if self.x else []), *(["logx"] if self.log_x else []),
                 *(["log"] if self.log_y else [])]
        columns = [short_column(name) for name in self.y]
        shown = len(columns)
        while shown > 1 and len("_".join(self.parts(columns, shown, after))) > LONGEST:
            shown -= 1
        return "_".join(self.parts(columns, shown, after))

    @staticmethod
    def parts(columns, shown, after):
        """The parts of the name with so many of the columns."""
        return ["history", *columns[:shown], *([MORE] if shown < len(columns) else []), *after]
