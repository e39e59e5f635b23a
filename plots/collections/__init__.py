# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluation of collections: which quality predicts the error, and which method is better."""
