# SPDX-License-Identifier: GPL-3.0-or-later
"""What the results of a collection say, as numbers: which quality predicts the error, which method is better."""
