"""Means of noisy, correlated series with their sampling error."""

from dataclasses import dataclass

import numpy as np
from scipy import stats

CONFIDENCE = 0.95  # level of every interval and error bar the judge reports
FEWEST_BLOCKS = 8  # fewer blocks say next to nothing about their own spread (uncertain by 1/sqrt(2(n-1)) = 27 %)


@dataclass(frozen=True)
class Mean:
    """A mean and the half width of its 95 % interval; `settled` tells whether the blocks became independent."""
    value: float
    error_bar: float
    settled: bool


def block_mean(x):
    """Mean of the series x [n >= 2] with the sampling error of block averaging.

    Neighbouring samples are averaged in pairs again and again; the standard error of the mean grows until the blocks
    are independent and then stays level (Flyvbjerg & Petersen, J. Chem. Phys. 91, 461 (1989), eqs 27 and 28). The first
    level that no later one exceeds by more than the later one's own uncertainty is taken; without such a level, and for
    too few samples to have a second level, the largest estimate is taken and `settled` is False.
    """
    x = np.asarray(x, dtype=float)
    mean = float(np.mean(x))
    levels = block_levels(x)
    for k, (error, blocks) in enumerate(levels[:-1]):
        if all(later <= error + later / np.sqrt(2 * (count - 1)) for later, count in levels[k + 1:]):
            return Mean(mean, half_width(error, blocks), True)
    error, blocks = max(levels)
    return Mean(mean, half_width(error, blocks), False)


def block_levels(x):
    """[(standard error of the mean, number of blocks)] for blocks of 1, 2, 4, ... samples."""
    levels = []
    blocks = np.asarray(x, dtype=float)
    while len(blocks) >= FEWEST_BLOCKS or not levels:
        levels.append((float(np.sqrt(np.var(blocks) / (len(blocks) - 1))), len(blocks)))
        even = blocks[:len(blocks) // 2 * 2]
        blocks = 0.5 * (even[0::2] + even[1::2])
    return levels


def half_width(standard_error, count):
    """Half width of the 95 % interval of a mean of `count` independent values (Student's t)."""
    return standard_error * student_factor(count - 1)


def student_factor(degrees_of_freedom):
    """Two-sided quantile of Student's t distribution at the level CONFIDENCE."""
    return float(stats.t.ppf(0.5 + 0.5 * CONFIDENCE, degrees_of_freedom))
