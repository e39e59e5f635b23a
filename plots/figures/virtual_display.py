# SPDX-License-Identifier: GPL-3.0-or-later
"""An X server without a screen, for VTK: Debian's VTK draws through X even off screen, and ends the
whole process where no server answers."""

import contextlib
import logging
import os
import shutil


class NoDisplay(Exception):
    """Nothing can be rendered here; the message is half a sentence, for after a colon."""


@contextlib.contextmanager
def virtual_display():
    """Runs Xvfb on a free display, which DISPLAY names within the block; ends it afterwards.

    Used even where there is a real display: its software rendering gives the same pixels everywhere.
    """
    before = os.environ.get("LIBGL_ALWAYS_SOFTWARE")
    server = started_server()
    try:
        os.environ["LIBGL_ALWAYS_SOFTWARE"] = "1"
        yield
    finally:
        server.stop()
        os.environ.pop("LIBGL_ALWAYS_SOFTWARE")
        if before is not None:
            os.environ["LIBGL_ALWAYS_SOFTWARE"] = before


def started_server():
    """The server, ready to draw; raises NoDisplay."""
    if shutil.which("Xvfb") is None:
        raise NoDisplay("Xvfb is not installed; install the Debian package xvfb")
    try:
        from easyprocess import EasyProcessError
        from pyvirtualdisplay.abstractdisplay import XStartError, XStartTimeoutError
        from pyvirtualdisplay.xvfb import XvfbDisplay
    except ImportError as error:
        raise NoDisplay(f"PyVirtualDisplay is missing ({error}); install the Debian package "
                        "python3-pyvirtualdisplay") from None

    class Server(XvfbDisplay):
        """Gets SIGTERM from the kernel when Python dies, so that a killed one leaves none behind."""

        def _cmd(self):
            return ["setpriv", "--pdeathsig", "TERM", *super()._cmd()]

    # What it says about its attempts is no sentence for a user.
    logging.getLogger("pyvirtualdisplay").setLevel(logging.CRITICAL)
    try:
        # It stays as it is between two pictures, when VTK has closed its window.
        server = Server(size=(64, 64), retries=1, extra_args=["-noreset"])
        server.start()
    except OSError as error:
        raise NoDisplay(f"Xvfb cannot be started ({error})") from None
    except (EasyProcessError, XStartError, XStartTimeoutError):
        raise NoDisplay("Xvfb did not start") from None
    return server
