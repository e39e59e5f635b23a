# SPDX-License-Identifier: GPL-3.0-or-later
"""A results folder as one page of HTML that needs nothing else: tables, curves, meshes, provenance."""
