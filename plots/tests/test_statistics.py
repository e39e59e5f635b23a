# SPDX-License-Identifier: GPL-3.0-or-later
"""Statistics against scipy, against other ways to compute them, and against cases computed manually."""

import unittest

import numpy as np
from scipy import stats

from plots.statistics import bootstrap, correlation, profiles


class Correlation(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(5)

    def test_ranks_are_scipys(self):
        values = self.random.integers(7, size=40)
        np.testing.assert_allclose(correlation.ranks(values), stats.rankdata(values))

    def test_spearman_is_scipys(self):
        for ties in (3, 10, 10**6):
            x, y = self.random.integers(ties, size=(2, 50)) + 0.0
            self.assertAlmostEqual(correlation.spearman(x, x + y), stats.spearmanr(x, x + y)[0], places=12)

    def test_spearman_leaves_out_what_is_not_known(self):
        x, y = [1.0, 2.0, 3.0, np.nan, 5.0], [2.0, 1.0, 4.0, 9.0, np.inf]
        self.assertAlmostEqual(correlation.spearman(x, y), stats.spearmanr(x[:3], y[:3])[0])
        self.assertTrue(np.isnan(correlation.spearman([1, 2], [1, 2])))
        self.assertTrue(np.isnan(correlation.spearman([1, 1, 1], [1, 2, 3])))

    def test_decreasing_fit_by_hand(self):
        steps, values = correlation.decreasing_fit([4, 1, 2, 3, 3], [0, 5, 1, 4, 2])
        np.testing.assert_allclose(steps, [1, 2, 3, 4])
        np.testing.assert_allclose(values, [5, 7 / 3, 7 / 3, 0])  # 1 and the two of 3 are pooled

    def test_decreasing_fit_is_nearest(self):
        """No decreasing function near it is nearer: checked by small changes that keep it decreasing."""
        x, y = np.arange(30.0), self.random.normal(size=30) - 0.05 * np.arange(30)
        _, fitted = correlation.decreasing_fit(x, y)
        self.assertTrue((np.diff(fitted) <= 1e-12).all())
        least = ((fitted - y) ** 2).sum()
        for _ in range(500):
            other = np.sort(fitted + 0.05 * self.random.normal(size=30))[::-1]
            self.assertGreaterEqual(((other - y) ** 2).sum(), least)

    def test_good_enough(self):
        quality = np.linspace(0.1, 1.0, 91)
        error = np.where(quality < 0.6, 2.0 - quality, 1.0)  # falls until .6, no more from there on
        self.assertAlmostEqual(correlation.good_enough(quality, error, gain=0.05), 0.6, places=9)
        self.assertAlmostEqual(correlation.good_enough(quality, np.exp(-quality), gain=0.05),
                               next(q for q in quality if np.exp(-1.0) >= 0.95 * np.exp(-q)), places=9)
        self.assertTrue(np.isnan(correlation.good_enough([1, 2], [1, 2])))


class Bootstrap(unittest.TestCase):
    def test_interval_of_a_mean_covers_it(self):
        """Of 200 intervals at 90 % about 180 contain the true mean; bounds of a binomial at 1e-4."""
        random, held = np.random.default_rng(3), 0
        for trial in range(200):
            x = random.normal(size=40)
            low, high = bootstrap.interval(lambda rows, x=x: x[rows].mean(), np.arange(40), 300, 0.9, trial)
            held += low <= 0.0 <= high
        self.assertGreater(held, stats.binom.ppf(1e-4, 200, 0.87))
        self.assertLess(held, stats.binom.ppf(1 - 1e-4, 200, 0.93))

    def test_groups_are_drawn_whole(self):
        """A hundred copies of each of ten numbers are no more evidence than the ten."""
        x = np.random.default_rng(1).normal(size=10)
        alone = bootstrap.interval(lambda rows: x[rows].mean(), np.arange(10))
        copies, groups = np.repeat(x, 100), np.repeat(np.arange(10), 100)
        np.testing.assert_allclose(bootstrap.interval(lambda rows: copies[rows].mean(), groups), alone)

    def test_one_group_says_nothing(self):
        self.assertTrue(np.isnan(bootstrap.interval(lambda rows: 1.0, np.zeros(5))).all())

    def test_paired_test_is_scipys(self):
        random = np.random.default_rng(2)
        for n, places in ((8, 12), (60, 2)):
            a, b = random.normal(size=(2, n)) + [[0.3], [0.0]]
            expected = stats.permutation_test((a, b), lambda x, y, axis: np.mean(x - y, axis=axis), permutation_type="samples",
                                              vectorized=True, n_resamples=20000, random_state=1).pvalue
            self.assertAlmostEqual(bootstrap.paired_test(a, b), expected, places=places)
        self.assertEqual(bootstrap.paired_test([1, 2], [1, 2]), 1.0)
        self.assertEqual(bootstrap.paired_test([1, 1, 1, 1], [0, 0, 0, 0]), 2 / 16)

    def test_pairs_of_a_group_are_swapped_together(self):
        self.assertEqual(bootstrap.paired_test([1, 1, 1, 1], [0, 0, 0, 0], ["x", "x", "y", "y"]), 2 / 4)
        a, groups = np.random.default_rng(3).normal(0.1, 1.0, 400), np.repeat(np.arange(100), 4)
        sums = a.reshape(100, 4).sum(axis=1)
        expected = stats.permutation_test((sums, np.zeros(100)), lambda x, y, axis: np.mean(x - y, axis=axis),
                                          permutation_type="samples", vectorized=True, n_resamples=20000, random_state=1).pvalue
        self.assertAlmostEqual(bootstrap.paired_test(a, np.zeros(400), groups), expected, places=2)


class Profiles(unittest.TestCase):
    def test_profile_by_hand(self):
        profile = profiles.performance_profile({"a": [1.0, 4.0, np.nan, np.inf], "b": [2.0, 2.0, 3.0, np.nan]})
        np.testing.assert_allclose(profile["a"][0], [1.0, 2.0])
        np.testing.assert_allclose(profile["a"][1], [0.25, 0.5])
        np.testing.assert_allclose(profile["b"][0], [1.0, 1.0, 2.0])
        np.testing.assert_allclose(profile["b"][1], [0.25, 0.5, 0.75])

    def test_targets_and_times_by_hand(self):
        curves = {"a": ([0, 1, 2], [16.0, 4.0, 1.0]), "b": ([0, 5], [16.0, 2.0])}
        np.testing.assert_allclose(profiles.targets_of(curves, 4), [8, 4, 2, 1])
        reached = profiles.runtime_distribution([curves], 4)
        np.testing.assert_allclose(reached["a"], [1, 1, 2, 2])
        np.testing.assert_allclose(reached["b"], [5, 5, 5, np.inf])
        self.assertEqual(len(profiles.targets_of({"a": ([0, 1], [1.0, 2.0])})), 0)

    def test_anytime_by_hand(self):
        problems = [{"a": ([0, 1, 2], [4.0, 1.0, 2.0])}, {"a": ([0, 3], [1.0, 0.5])}, {"b": ([0], [1.0])}]
        np.testing.assert_allclose(profiles.anytime(problems, "a", [0.5, 1.0, 2.5, 3.0])[1], [1.0, 0.625, 0.625, 0.375])

    def test_mean_ranks_are_friedmans(self):
        random = np.random.default_rng(4)
        costs = {name: random.lognormal(size=25) for name in "abcd"}
        found = {name: ranks.mean() for name, ranks in profiles.ranks_of_problems(costs).items()}
        by_scipy = np.mean([stats.rankdata([costs[n][i] for n in "abcd"]) for i in range(25)], axis=0)
        np.testing.assert_allclose([found[n] for n in "abcd"], by_scipy)
        found = profiles.ranks_of_problems({"a": [np.nan, 1.0], "b": [2.0, 3.0]})
        self.assertEqual({name: ranks.tolist() for name, ranks in found.items()}, {"a": [2.0, 1.0], "b": [1.0, 2.0]})
        self.assertEqual(len(profiles.ranks_of_problems({"a": [], "b": []})["a"]), 0)


if __name__ == "__main__":
    unittest.main()
