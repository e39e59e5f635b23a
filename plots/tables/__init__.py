# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables from results, and their formats."""
