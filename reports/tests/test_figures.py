"""Figures that must not fail on what a run may give."""

from types import SimpleNamespace

from plumb_reports.figures import error_pictures


def judgement(*values):
    check = SimpleNamespace(id="drift", metric="final_absolute")
    return SimpleNamespace(check=check, measurements=[SimpleNamespace(value=value) for value in values])


def test_errors_of_exactly_zero_make_no_logarithmic_figure():
    assert error_pictures([judgement(0.0, 0.0, 0.0)]) == []
