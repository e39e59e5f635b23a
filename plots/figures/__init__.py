# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures from results: which ones a study has, what they show, and how meshes are rendered."""
