# SPDX-License-Identifier: GPL-3.0-or-later
"""Configuration of Sphinx for the manual; docs/build calls it."""

import os

project = "smoothfem"
author = copyright = "The smoothfem developers"
extensions = ["myst_parser", "sphinx.ext.autodoc"]
exclude_patterns = ["doxygen.md", "tests"]
myst_heading_anchors = 3
highlight_language = "text"
html_theme = "furo"
html_title = "smoothfem"
html_extra_path = [os.environ["SMOOTHFEM_DOCS_EXTRA"]]
html_show_sourcelink = False
autodoc_member_order = "bysource"
