# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes files so that a reader never sees a half-written one."""

import os
from pathlib import Path


def write_atomically(path, content):
    """Writes bytes or text to a temporary file next to `path` and renames it; makes the folder."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    # In the folder of the target, as renaming is atomic only within one file system.
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        temporary.write_bytes(content.encode("utf-8") if isinstance(content, str) else content)
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)
    return path
