"""The truth table of the verdicts."""

import pytest
from plumb_reports.verdicts import MET_NOTE, counts, error_verdict, interval_verdict, joined, worst


@pytest.mark.parametrize("error, bar, bound, accepted, word", [
    (0.9, None, 1.0, None, "pass"),
    (1.0, None, 1.0, None, "pass"),
    (1.1, None, 1.0, None, "fail"),
    (0.9, 0.05, 1.0, None, "pass"),
    (0.9, 0.2, 1.0, None, "fail"),       # the bound counts with the error bar
    (0.9, None, 1.0, 1.5, "pass"),       # meets its bound now
    (1.5, None, 1.0, 1.5, "not_met"),
    (1.64, None, 1.0, 1.5, "not_met"),   # worse by less than a tenth
    (1.66, None, 1.0, 1.5, "fail"),
    (1.2, None, 1.0, 1.5, "not_met"),    # better than accepted, still not met
    (0.9, 0.2, 1.0, 1.5, "not_met")])
def test_errors(error, bar, bound, accepted, word):
    assert error_verdict(error, bar, bound, accepted).word == word


@pytest.mark.parametrize("lower, upper, value, accepted, word", [
    (1.8, 2.2, 2.0, None, "pass"),
    (1.7, 2.3, 2.0, None, "pass"),
    (1.6, 2.2, 1.9, None, "fail"),       # the interval reaches out
    (1.8, 2.4, 2.1, None, "fail"),       # two-sided: too good is wrong as well
    (1.4, 1.6, 1.5, 1.5, "not_met"),     # accepted misses by 0.2
    (1.3, 1.5, 1.47, 1.5, "fail"),       # misses by 0.23 > 0.22
    (1.3, 1.6, 1.49, 1.5, "not_met"),    # misses by 0.21
    (1.9, 2.1, 2.0, 1.5, "pass")])
def test_intervals(lower, upper, value, accepted, word):
    assert interval_verdict(lower, upper, (1.7, 2.3), value, accepted).word == word


def test_a_met_mark_is_told():
    assert MET_NOTE in error_verdict(0.5, None, 1.0, 1.5).reason
    assert MET_NOTE not in error_verdict(0.5, None, 1.0).reason


def test_words():
    assert worst(["pass", "not_met", "pass"]) == "not_met"
    assert worst(["pass", "fail", "not_met"]) == "fail"
    assert worst([]) == "pass"
    assert counts(["pass", "pass", "fail"]) == {"pass": 2, "fail": 1, "not_met": 0}
    both = joined([error_verdict(0.5, None, 1.0), error_verdict(2.0, None, 1.0)])
    assert both.word == "fail" and "0.5 <= 1" in both.reason and "2 > 1" in both.reason
