# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs files with classes of a user's, and makes a sentence of what goes wrong in them."""

import inspect
import os
import sys
import traceback
import types

from ._core import InputError

_known = {}


def class_in(path, name, once, method):
    """Returns the class `name` of the file `path`. Raises InputError; the message lists classes with this method.

    once: if True, a file that has been run is not read again. Otherwise it is run again if its text has changed."""
    if once:
        _keep_process()
    known = _known.get(path)
    if known is None or not once:
        source = with_context(path, f"{path} cannot be read", lambda: _read(path))
        if known is None or known[0] != source:
            known = _known[path] = (source, with_context(path, f"{path} cannot be run", lambda: _run_file(path, source)))
    module = known[1]
    if not inspect.isclass(getattr(module, name, None)):
        classes = sorted(key for key, value in vars(module).items() if inspect.isclass(value) and callable(
            getattr(value, method, None)))
        raise InputError(f"{path} has no class '{name}'; " + (
            f"choose one of {', '.join(classes)}" if classes else f"it has no class with {method}(self, mesh) at all"))
    return getattr(module, name)


def files_of(path):
    """Returns the file and those of the modules that it imports from the same folder; nothing for no file."""
    if not path:
        return []
    folder = os.path.dirname(os.path.abspath(path))
    modules = (getattr(module, "__file__", None) for module in list(sys.modules.values()))
    others = {file for file in modules if file and os.path.dirname(os.path.abspath(file)) == folder and os.path.isfile(file)}
    return [path, *sorted(others - {path})]


def _keep_process():
    """Makes os._exit an error: it would end the program without its results. In processes that a smoother forks it stays."""
    if getattr(os._exit, "of_smoothfem", False):
        return
    leave, own = os._exit, os.getpid()

    def leave_if_forked(code):
        if os.getpid() != own:
            leave(code)
        raise SystemExit(code)

    leave_if_forked.of_smoothfem = True
    os._exit = leave_if_forked


def _read(path):
    with open(path, "rb") as file:
        return file.read()


def _run_file(path, source):
    """Runs the file as a module and returns it. It can import the modules in its folder, unless their names are those of
    installed ones. No byte code is written next to the file."""
    module = types.ModuleType(f"smoothfem method {path}")
    module.__file__ = path
    sys.modules[module.__name__] = module  # dataclasses look for it
    folder = os.path.dirname(os.path.abspath(path))
    if folder not in sys.path:
        sys.path.append(folder)
    sys.dont_write_bytecode, before = True, sys.dont_write_bytecode
    try:
        exec(compile(source, path, "exec"), module.__dict__)  # the file is the program of a user
    finally:
        sys.dont_write_bytecode = before
    return module


def unicode(text):
    """Returns a text that UTF-8 can hold."""
    return str(text).encode("utf-8", "replace").decode("utf-8")


def with_context(path, what, call):
    """Returns call(). Exceptions in it become an InputError of one sentence with file, line and their text."""
    try:
        return call()
    except (InputError, KeyboardInterrupt):
        raise
    except BaseException as error:  # an exit must not end the program either
        raise InputError(unicode(f"{what}: {_sentence(error, path)}")) from error


def _text_of(error):
    """Returns the text of an exception, whose own code may fail."""
    try:
        return str(error)
    except Exception:
        return "without a text"


def _sentence(error, path):
    """Returns, for example, 'mine.py:12: ZeroDivisionError: division by zero'. The line is the last line of the smoother's
    file in the traceback."""
    at = [(frame.filename, frame.lineno) for frame in traceback.extract_tb(error.__traceback__) if frame.filename == path]
    text = _text_of(error)
    if isinstance(error, SyntaxError) and error.lineno:
        at, text = [(error.filename, error.lineno)], error.msg
    place = f"{at[-1][0]}:{at[-1][1]}: " if at else ""
    return place + type(error).__name__ + (f": {' '.join(text.split())}" if text else "")
