# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of README.md and the manual."""
