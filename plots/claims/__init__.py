# SPDX-License-Identifier: GPL-3.0-or-later
"""Claims of the thesis, checked against results."""
