# SPDX-License-Identifier: GPL-3.0-or-later
"""Statistics against scipy, against other ways to compute them, and against cases computed manually."""

import unittest

import numpy as np
from scipy import stats

from plots.statistics import correlation, profiles, units


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


class Units(unittest.TestCase):
    def test_each_unit_counts_once(self):
        mean, (low, high) = units.mean_of_units([1.0, 3.0, 5.0, 9.0], ["a", "a", "b", "c"])
        self.assertAlmostEqual(mean, (2 + 5 + 9) / 3)
        np.testing.assert_allclose((low, high), stats.t.interval(0.95, 2, loc=mean, scale=stats.sem([2, 5, 9])))
        self.assertTrue(np.isnan(units.mean_of_units([1.0, 2.0], ["a", "a"])[1]).all())
        self.assertEqual(units.unit_medians([1.0, 9.0, 2.0, 5.0], ["b", "b", "b", "a"]), {"a": 5.0, "b": 2.0})
        self.assertEqual(units.mean_of_units([1.0, 9.0, 2.0, 5.0], ["b", "b", "b", "a"], units.unit_medians)[0], 3.5)
        self.assertTrue(np.isnan(units.mean_of_units([], [])[0]))

    def test_interval_covers_the_mean(self):
        """Of 400 intervals at 95 % for means of six values about 380 hold the true mean; bounds of a binomial at 1e-4."""
        random = np.random.default_rng(3)
        held = sum(low <= 0.0 <= high for low, high in (units.t_interval(random.normal(size=6)) for _ in range(400)))
        self.assertGreater(held, stats.binom.ppf(1e-4, 400, 0.95))
        self.assertLess(held, stats.binom.ppf(1 - 1e-4, 400, 0.95))

    def test_sign_flips_are_scipys(self):
        random = np.random.default_rng(2)
        for n, places in ((8, 12), (60, 2)):
            differences = random.normal(0.3, 1.0, n)
            expected = stats.permutation_test((differences, np.zeros(n)), lambda x, y, axis: np.mean(x - y, axis=axis),
                                              permutation_type="samples", vectorized=True, n_resamples=100000, random_state=1).pvalue
            self.assertAlmostEqual(units.sign_flips(differences, 100000), expected, places=places)
        self.assertEqual(units.sign_flips([0.0, 0.0]), 1.0)
        self.assertEqual(units.sign_flips([1, 1, 1, 1]), 2 / 16)
        self.assertEqual(units.least_p(4, 3), 3 * 2 / 16)

    def test_holm_by_hand(self):
        np.testing.assert_allclose(units.holm([0.01, 0.04, 0.03, np.nan]), [0.03, 0.06, 0.06, np.nan])
        np.testing.assert_allclose(units.holm([0.9, 0.8]), [1.0, 1.0])


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
        np.testing.assert_allclose(profiles.anytime(problems, "a", [0.5, 1.0, 2.5, 3.0])[1], [1.0, 0.625, 0.75, 0.5])


if __name__ == "__main__":
    unittest.main()
