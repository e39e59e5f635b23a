# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of the manual: parts of pages that are made from results/reference (python3 -m plots.manual)."""
