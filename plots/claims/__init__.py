# SPDX-License-Identifier: GPL-3.0-or-later
"""What the thesis says in words, checked against results."""
