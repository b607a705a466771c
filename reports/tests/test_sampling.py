"""Block averaging on series whose sampling error is known."""

import numpy as np
import pytest
from plumb_reports.sampling import block_mean, student_factor


def test_constant_series_has_no_error():
    mean = block_mean(np.full(64, 3.0))
    assert (mean.value, mean.error_bar, mean.settled) == (3.0, 0.0, True)


def test_white_noise():
    x = np.random.default_rng(7).standard_normal(4096)
    mean = block_mean(x)
    assert mean.settled
    assert mean.error_bar == pytest.approx(1.96 / np.sqrt(4096), rel=0.15)


def test_correlated_noise_has_a_larger_error():
    # x_k = a x_{k-1} + noise: the variance of the mean is that of white noise times (1 + a)/(1 - a) = 19 for a = 0.9.
    rng = np.random.default_rng(11)
    x = np.zeros(2**15)
    for k in range(1, len(x)):
        x[k] = 0.9 * x[k - 1] + rng.standard_normal()
    exact = 1.96 * np.std(x) * np.sqrt(19 / len(x))
    assert block_mean(x).error_bar == pytest.approx(exact, rel=0.25)


def test_interval_covers_the_true_mean_about_as_often_as_it_says():
    rng = np.random.default_rng(3)
    hits = 0
    for _ in range(400):
        mean = block_mean(rng.standard_normal(128))
        hits += abs(mean.value) <= mean.error_bar
    assert 0.90 <= hits / 400 <= 0.99


def test_a_drifting_series_never_settles():
    mean = block_mean(np.arange(256.0))
    assert not mean.settled
    assert mean.error_bar > 256 / np.sqrt(12) / np.sqrt(256) * 1.96  # more than if the samples were independent


def test_two_samples():
    # Mean 1, standard error |2 - 0|/2 = 1, one degree of freedom: t = 12.706 (tables).
    mean = block_mean([0.0, 2.0])
    assert mean.value == 1.0
    assert mean.error_bar == pytest.approx(12.706, rel=1e-4)
    assert not mean.settled


def test_student_factor_of_the_tables():
    assert student_factor(4) == pytest.approx(2.776, abs=1e-3)
