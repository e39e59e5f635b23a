# SPDX-License-Identifier: GPL-3.0-or-later
"""Prediction of the error by quality numbers."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..results.collection import OUTCOMES, QUALITIES, numbers_of
from ..statistics.correlation import spearman
from ..statistics.units import mean_of_units, sign_flips
from .orders import errors_of
from .problems import kinds_of_meshes

RECORDS_OF_CURVE = 6  # of each method on a member: the first, the last, and others at equal distances


@dataclass(frozen=True)
class Prediction:
    """Rank correlation of a quality with an outcome, on meshes of one type of elements at one degree."""

    quality: str
    outcome: str
    elements: str
    degree: str
    by_family: dict  # family -> correlation over its meshes, the outcome relative to the least of the same member
    mean: float  # over the families
    interval: tuple  # cut off at -1 and 1
    n_records: int


@dataclass(frozen=True)
class Sample:
    """Valid meshes of one type of elements at one degree. relative: outcome -> array, divided by the least of the same
    member."""

    elements: str
    degree: str
    members: np.ndarray
    families: np.ndarray
    qualities: dict
    relative: dict


@lru_cache(maxsize=1)
def samples_of(results):
    """A sample for each type of elements and degree. Each method on a member gives as many meshes, however many it recorded; its
    initial mesh and equal meshes of a method count once."""
    rows, found = results.iterations, []
    outcomes = (*OUTCOMES, *(error for solver in results.solvers for error in errors_of(solver)))
    for elements, degree in kinds_of_meshes(rows):
        chosen = rows.select(elements=elements, degree=degree)
        chosen = chosen.where(chosen.number("n_invalid") == 0)
        chosen = chosen.where(some_of_each_curve(chosen.text("member"), chosen.text("method")))
        fingerprints = list(zip(chosen.text("member"), *(chosen.text(q) for q in QUALITIES)))
        chosen = chosen.where(sorted({key: number for number, key in reversed(list(enumerate(fingerprints)))}.values()))
        members = chosen.text("member")
        found.append(Sample(elements, degree, members, chosen.text("family"),
                            {name: chosen.number(name) for name in results.qualities},
                            {name: relative_to_least(chosen.number(name), members) for name in outcomes}))
    return found


def some_of_each_curve(members, methods):
    """Numbers of RECORDS_OF_CURVE rows of each method on each member, ascending."""
    chosen = [numbers[np.linspace(0, len(numbers) - 1, min(len(numbers), RECORDS_OF_CURVE)).round().astype(int)]
              for _, numbers in numbers_of(zip(members, methods))]
    return np.sort(np.concatenate(chosen)) if chosen else np.array([], dtype=int)


def relative_to_least(values, members):
    """Positive numbers divided by the smallest one of the same member; NaN where that is missing."""
    values = np.where(values > 0, values, np.nan)
    _, inverse = np.unique(members.astype(str), return_inverse=True)
    least = np.full(inverse.max(initial=-1) + 1, np.inf)
    np.fmin.at(least, inverse, values)
    return values / least[inverse]


@lru_cache(maxsize=1)
def predictions(results):
    """Predictions of every outcome by every quality, for each sample; unknown ones are left out."""
    found = []
    for sample in samples_of(results):
        families = {str(family): np.flatnonzero(sample.families == family) for family in sorted(set(sample.families))}
        for quality, q in sample.qualities.items():
            for outcome, y in sample.relative.items():
                if np.count_nonzero(np.isfinite(q) & np.isfinite(y)) < 3:
                    continue
                by_family = {family: spearman(q[rows], y[rows]) for family, rows in families.items()}
                by_family = {family: rho for family, rho in by_family.items() if np.isfinite(rho)}
                mean, between = mean_of_units(list(by_family.values()), list(by_family))
                found.append(Prediction(quality, outcome, sample.elements, sample.degree, by_family, mean,
                                        tuple(np.clip(between, -1.0, 1.0)), len(q)))
    return found


def differ(first, second):
    """p-value of the hypothesis that two qualities predict equally well: sign flips of the families' differences of the absolute
    correlations. NaN for fewer than two common families."""
    common = sorted(set(first.by_family) & set(second.by_family))
    differences = [abs(first.by_family[family]) - abs(second.by_family[family]) for family in common]
    return sign_flips(differences) if len(common) > 1 else np.nan
