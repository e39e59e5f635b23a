# SPDX-License-Identifier: GPL-3.0-or-later
"""The formats that translate.py reads and writes: one module for each library or format."""
