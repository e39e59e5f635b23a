# SPDX-License-Identifier: GPL-3.0-or-later
"""An X server without a screen, for VTK: Debian's VTK draws through X even off screen, and ends the
whole process where no server answers."""

import contextlib
import ctypes
import os
import select
import shutil
import signal
import subprocess

SECONDS_TO_START = 20
PR_SET_PDEATHSIG = 1  # linux/prctl.h


class NoDisplay(Exception):
    """Nothing can be rendered here; the message is one sentence."""


@contextlib.contextmanager
def virtual_display():
    """Runs Xvfb on a free display, which DISPLAY names within the block; ends it afterwards.

    Used even where there is a real display: its software rendering gives the same pixels everywhere.
    """
    program = shutil.which("Xvfb")
    if program is None:
        raise NoDisplay("Xvfb is not installed; install the Debian package xvfb")
    reader, writer = os.pipe()
    try:
        server = subprocess.Popen(
            [program, "-displayfd", str(writer), "-screen", "0", "64x64x24", "-nolisten", "tcp",
             "-noreset"], pass_fds=(writer,), preexec_fn=end_with_parent,
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    except OSError as error:
        os.close(reader)
        raise NoDisplay(f"Xvfb cannot be started ({error})") from None
    finally:
        os.close(writer)
    variables = {"DISPLAY": None, "LIBGL_ALWAYS_SOFTWARE": "1"}
    before = {name: os.environ.get(name) for name in variables}
    try:
        variables["DISPLAY"] = f":{display_number(reader)}"
        os.environ.update(variables)
        yield
    finally:
        os.close(reader)
        for name, value in before.items():
            os.environ.pop(name, None)
            if value is not None:
                os.environ[name] = value
        end(server)


def end_with_parent():
    """Called in the server's process: it gets SIGTERM when Python dies, so none is left behind."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def display_number(reader):
    """The number that the server writes when it is ready."""
    ready, _, _ = select.select([reader], [], [], SECONDS_TO_START)
    number = os.read(reader, 16).decode().strip() if ready else ""
    if not number.isdigit():
        raise NoDisplay("Xvfb did not start" if ready else
                        f"Xvfb did not start within {SECONDS_TO_START} s")
    return number


def end(server):
    """Ends a process and waits until it is gone."""
    server.terminate()
    try:
        server.wait(timeout=5)
    except subprocess.TimeoutExpired:
        server.kill()
        server.wait()
