# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs functions in processes that are copies of this one."""

import os
import signal
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context

from .rows import ResultsError

_tasks = []  # of this process, which its copies inherit


def _run(number):
    return _tasks[number]()


def finished(tasks):
    """Yields (number, result) of functions without arguments, as they finish. Results and exceptions have to be picklable;
    functions do not. A single function, or all on a machine with one core, run in this process."""
    n_processes = min(len(tasks), os.cpu_count() or 1)
    if n_processes < 2:
        yield from ((number, task()) for number, task in enumerate(tasks))
        return
    first = len(_tasks)
    _tasks.extend(tasks)
    try:
        # Ctrl-C ends the copies at once and without a word.
        with ProcessPoolExecutor(n_processes, get_context("fork"), signal.signal, (signal.SIGINT, signal.SIG_DFL)) as pool:
            running = {pool.submit(_run, first + number): number for number in range(len(tasks))}
            try:
                yield from ((running[future], future.result()) for future in as_completed(running))
            except BrokenProcessPool as error:
                raise ResultsError("A process that draws was ended, for example because the memory was full; start the command "
                                   "again.") from error
            finally:
                pool.shutdown(cancel_futures=True)
    finally:
        del _tasks[first:]
