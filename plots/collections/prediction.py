# SPDX-License-Identifier: GPL-3.0-or-later
"""Prediction of the error by quality numbers, and thresholds of a good quality."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..results.collection import OUTCOMES, QUALITIES
from ..statistics.bootstrap import interval, intervals
from ..statistics.correlation import good_enough, ranks, spearman
from .problems import ERROR, group_column, kinds_of_meshes

N_SAMPLES = 200
MOST_ROWS = 2000  # of one correlation with interval: more would take long and change little
LEAST_MEMBERS_RECORDS = 4  # of a member whose own correlation counts


@dataclass(frozen=True)
class Prediction:
    """Rank correlation of a quality with an outcome, on meshes of one type of elements at one degree."""

    quality: str
    outcome: str
    elements: str
    degree: str
    across: float  # over all records, the outcome relative to the least of the same member
    across_interval: tuple
    within: float  # median of the members' own
    within_interval: tuple
    n_records: int
    n_members: int


@dataclass(frozen=True)
class Sample:
    """Records of one type of elements at one degree with valid meshes. relative: outcome -> array, divided by
    the least of the same member."""

    elements: str
    degree: str
    members: np.ndarray
    groups: np.ndarray
    families: np.ndarray
    qualities: dict
    relative: dict


@lru_cache(maxsize=1)
def samples_of(results):
    """A sample for each type of elements and degree, each mesh of a method counted once."""
    rows = results.iterations
    found = []
    for elements, degree in kinds_of_meshes(rows):
        chosen = rows.select(elements=elements, degree=degree)
        chosen = chosen.where(chosen.number("n_invalid") == 0)
        fingerprints = list(zip(chosen.text("member"), *(chosen.text(q) for q in QUALITIES)))
        chosen = chosen.where(sorted({key: number for number, key in reversed(list(enumerate(fingerprints)))}.values()))
        members = chosen.text("member")
        found.append(Sample(elements, degree, members, chosen.text(group_column(chosen)), chosen.text("family"),
                            {name: chosen.number(name) for name in results.qualities},
                            {name: relative_to_least(chosen.number(name), members) for name in OUTCOMES}))
    return found


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
        intervals = across_intervals(sample)
        for (quality, outcome), between in intervals.items():
            known = np.isfinite(sample.qualities[quality]) & np.isfinite(sample.relative[outcome])
            if np.count_nonzero(known) >= 3:
                found.append(prediction(sample, quality, outcome, known, between))
    return found


def across_intervals(sample):
    """(quality, outcome) -> interval of their correlation over all records. Of each draw the ranks are computed once for
    all pairs without gaps."""
    some = np.linspace(0, len(sample.groups) - 1, min(len(sample.groups), MOST_ROWS)).astype(int)
    columns = {name: values[some] for name, values in (*sample.qualities.items(), *sample.relative.items())}
    whole = {name for name, values in columns.items() if np.isfinite(values).all()}

    def correlations(rows):
        centred = {}
        for name in whole:
            of_rows = ranks(columns[name][rows])
            of_rows -= of_rows.mean()
            norm = np.sqrt(of_rows @ of_rows)
            centred[name] = of_rows / norm if norm > 0 else np.full(len(rows), np.nan)
        return [centred[quality] @ centred[outcome] if quality in whole and outcome in whole
                else spearman(columns[quality][rows], columns[outcome][rows]) for quality, outcome in pairs]

    pairs = [(quality, outcome) for quality in sample.qualities for outcome in sample.relative]
    return dict(zip(pairs, intervals(correlations, len(pairs), sample.groups[some].astype(str), N_SAMPLES)))


def prediction(sample, quality, outcome, known, across_interval):
    """One of them, of the records that are known."""
    q, y = sample.qualities[quality][known], sample.relative[outcome][known]
    members, groups = sample.members[known], sample.groups[known]
    own, own_groups = [], []
    order = np.argsort(members.astype(str), kind="stable")
    for chosen in np.split(order, np.flatnonzero(members[order][1:] != members[order][:-1]) + 1):
        rho = spearman(q[chosen], y[chosen]) if len(chosen) >= LEAST_MEMBERS_RECORDS else np.nan
        if np.isfinite(rho):
            own.append(rho)
            own_groups.append(groups[chosen[0]])
    own = np.array(own)
    return Prediction(
        quality, outcome, sample.elements, sample.degree, spearman(q, y), across_interval,
        float(np.median(own)) if len(own) else np.nan,
        interval(lambda rows: np.median(own[rows]), np.array(own_groups, dtype=str), N_SAMPLES),
        len(q), len(set(members)))


def thresholds(results, gain=0.05):
    """(elements, degree, quality, least number beyond which the H1 error falls by less than `gain`, interval), for mean
    ratios."""
    found = []
    for sample in samples_of(results):
        error = sample.relative["h1_error"]
        for quality in QUALITIES:
            q = sample.qualities[quality]
            known = np.flatnonzero(np.isfinite(q) & np.isfinite(error))
            if len(known) < 3:
                continue
            some = known[np.linspace(0, len(known) - 1, min(len(known), MOST_ROWS)).astype(int)]
            between = interval(lambda rows: good_enough(q[some][rows], error[some][rows], gain),
                               sample.groups[some].astype(str), N_SAMPLES)
            found.append((sample.elements, sample.degree, quality, good_enough(q[known], error[known], gain), between))
    return found


def thresholds_of_families(results, gain=0.05):
    """(elements, degree, family, least q_mean beyond which the H1 error falls by less than `gain`), where it is known."""
    found = []
    for sample in samples_of(results):
        q, error = sample.qualities["q_mean"], sample.relative[ERROR]
        for family in sorted(set(sample.families)):
            known = np.flatnonzero(np.isfinite(q) & np.isfinite(error) & (sample.families == family))
            value = good_enough(q[known], error[known], gain) if len(known) >= 3 else np.nan
            if np.isfinite(value):
                found.append((sample.elements, sample.degree, family, float(value)))
    return found
