# SPDX-License-Identifier: GPL-3.0-or-later
"""Formats numbers of tables: computed numbers with fixed digits, and their difference from the printed values."""

import math
import re

MISSING = "–"

# Seconds: the noise of clock and scheduler is more than a tenth of shorter times.
CLOCK = 1e-4
BELOW_CLOCK = f"<{CLOCK:.4f}"
# What four decimals would show as zero, as invalid cells have it.
LEAST_QUALITY = 1e-4
# Below this, four decimals would leave fewer than two digits.
SMALLEST_FIXED = 1e-3
# From this factor on, percents are hard to read.
FACTOR_FROM = 10


def formatted(values, specification):
    """Numbers as a format specification says; not-a-number as a dash."""
    return [MISSING if math.isnan(v) else format(v, specification) for v in values]


def format_integer(values):
    """Whole numbers."""
    return formatted(values, ".0f")


def format_scientific(values):
    """Three digits and an exponent, as the thesis prints condition numbers."""
    return formatted(values, ".2e")


def format_quality(values):
    """Four decimals, as the thesis prints mean ratio numbers. Tiny numbers are not shown as zero."""
    return [f"<{LEAST_QUALITY:.4f}" if 0 < value < LEAST_QUALITY else text
            for value, text in zip(values, formatted(values, ".4f"))]


def format_seconds(values):
    """Formats times with at least three decimals, and more if the shortest time needs them for two digits. Times that the
    clock cannot tell from zero are called so."""
    shortest = min((v for v in values if v >= CLOCK), default=1.0)
    decimals = max(3, 1 - math.floor(math.log10(shortest)))
    return [BELOW_CLOCK if 0 <= value < CLOCK else text for value, text in zip(values, formatted(values, f".{decimals}f"))]


def seconds_text(value):
    """Three digits of a time, unless the clock cannot tell it from zero."""
    return BELOW_CLOCK if 0 <= value < CLOCK else f"{value:.3g}"


def format_numbers(values):
    """Whole numbers as such, others with four decimals or an exponent."""
    whole = all(math.isnan(value) or value == round(value) for value in values)
    return format_integer(values) if whole else format_error(values)


def format_factor(values):
    """One decimal, as the thesis prints speedups."""
    return formatted(values, ".1f")


def format_memory(values):
    """Writes two decimals: one more than the thesis prints, since its meshes are larger than most of smoothfem's."""
    return formatted(values, ".2f")


def format_error(values):
    """Four decimals as in the thesis; with an exponent for the whole column if these are too few."""
    sizes = [abs(v) for v in values if not math.isnan(v) and v != 0]
    fixed = not sizes or (min(sizes) >= SMALLEST_FIXED and max(sizes) < 1e5)
    return formatted(values, ".4f" if fixed else ".4e")


def grouped(text):
    """Counts such as 5099700 and 124/5099700 with commas between thousands; other text as it is."""
    if not re.fullmatch(r"\d+(/\d+)*", text):
        return text
    return "/".join(f"{int(count):,}" for count in text.split("/"))


def relative_difference(computed, printed):
    """(computed - printed) / printed in percent; "=" if computed has all the printed digits; from ten times
    the printed number on, the factor, such as ×12.

    The sign is left out where one decimal would leave only a zero. `computed` is a number,
    `printed` the printed string. Returns MISSING if there is nothing to compare, or if only the printed value
    is zero.
    """
    try:
        reference = float(printed)
    except ValueError:
        return MISSING
    if math.isnan(computed):
        return MISSING
    if as_printed(computed, printed) == as_printed(reference, printed):
        return "="
    if reference == 0:
        return MISSING
    percent = 100 * (computed - reference) / reference
    if abs(percent) < 0.05:
        return "<0.1"
    return f"{percent:+.1f}" if computed / reference < FACTOR_FROM else f"×{computed / reference:,.0f}"


def as_printed(value, printed):
    """A number written with the digits of a printed one ("1.09e+08": three, ".3367": 4 decimals)."""
    mantissa, exponent, _ = printed.lower().partition("e")
    decimals = len(mantissa.partition(".")[2])
    return f"{value:.{decimals}{'e' if exponent else 'f'}}"
