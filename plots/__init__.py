# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and figures from the CSV and VTU files of a results folder. Nothing is computed here."""
