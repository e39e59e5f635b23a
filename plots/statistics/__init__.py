# SPDX-License-Identifier: GPL-3.0-or-later
"""Statistics of many runs: what predicts what, which method is better, and how sure that is. Arrays in, numbers
out; nothing here knows files or figures."""
