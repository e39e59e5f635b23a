# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the content of a results folder and the printed values: CSV rows, meshes. Imports no other folder of plots."""
