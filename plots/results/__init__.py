# SPDX-License-Identifier: GPL-3.0-or-later
"""What is in a results folder and beside it: CSV rows, meshes, printed values. Knows no other room."""
