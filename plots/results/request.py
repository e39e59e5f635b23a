# SPDX-License-Identifier: GPL-3.0-or-later
"""A user's request for some of the tables and figures."""

from dataclasses import dataclass

TIME = "smoothing_seconds"


@dataclass(frozen=True)
class Request:
    """Some methods and meshes, and columns of iterations.csv against another one; nothing: all."""

    methods: tuple = ()
    meshes: tuple = ()
    x: str = ""
    y: tuple = ()
    log_x: bool = False
    log_y: bool = False

    @property
    def has_history(self):
        """True if the user asks for a history that is not drawn by default."""
        return bool(self.x or self.y or self.log_x or self.log_y)

    @property
    def history_name(self):
        """The name of its figure: history_q_min_e_max_over_iteration_log_y."""
        parts = ["history", *self.y, *(["over", self.x] if self.x else []),
                 *(["log_x"] if self.log_x else []), *(["log_y"] if self.log_y else [])]
        return "_".join(parts)
