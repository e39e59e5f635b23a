# SPDX-License-Identifier: GPL-3.0-or-later
"""Lets a page that is open in a browser show its next version by itself."""

import hashlib
from string import Template

from ..results.write_files import write_atomically

VERSION_FILE = "report-version.js"  # a script, because pages from a disk may load scripts, but no other files
SCRIPT = Template("""<script>
setInterval(() => {
  const version = document.createElement("script");
  version.src = "$file?" + Date.now();
  version.onload = () => {
    version.remove();
    if (window.smoothfemVersion !== "$version") location.reload();
  };
  version.onerror = () => version.remove();
  document.head.append(version);
}, 1000);
</script>
</body>""")


def make_reloading(path):
    """Adds to a page that it looks for its next version every second."""
    text = path.read_text(encoding="utf-8")
    version = hashlib.sha256(text.encode()).hexdigest()
    head, end, tail = text.rpartition("</body>")
    write_atomically(path, head + SCRIPT.substitute(file=VERSION_FILE, version=version) + tail if end else text)
    write_atomically(path.with_name(VERSION_FILE), f'window.smoothfemVersion = "{version}";\n')


def make_final(path):
    """Removes what make_reloading has left next to the page before."""
    path.with_name(VERSION_FILE).unlink(missing_ok=True)
