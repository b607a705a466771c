"""From numbers to a verdict. Pure functions; the truth table is in reports/tests/test_verdicts.py."""

from dataclasses import dataclass

PASS, FAIL, NOT_MET = "pass", "fail", "not_met"
TOLERATED_GROWTH = 1.1  # a not_met check may be worse than accepted by a tenth (architecture: "A case and its verdict")
MET_NOTE = "is marked not_met but meets its bound: remove the mark"


@dataclass(frozen=True)
class Verdict:
    """pass, fail or not_met, and the reason in a sentence."""
    word: str
    reason: str


def error_verdict(error, error_bar, bound, accepted=None):
    """Verdict on an error that must not exceed `bound`, its error bar included."""
    reach = error + (error_bar or 0.0)
    if reach <= bound:
        return met(f"{number(reach)} <= {number(bound)}", accepted)
    return missed(f"{number(reach)} > {number(bound)}", accepted, error, accepted)


def interval_verdict(lower, upper, band, value, accepted=None):
    """Verdict on an interval [lower, upper] around `value` that has to lie inside the closed band."""
    text = f"[{number(lower)}, {number(upper)}]" if lower < upper else number(value)
    allowed = f"[{number(band[0])}, {number(band[1])}]"
    if band[0] <= lower and upper <= band[1]:
        return met(f"{text} inside {allowed}", accepted)
    distance_accepted = None if accepted is None else distance(accepted, band)
    return missed(f"{text} not inside {allowed}", accepted, distance(value, band), distance_accepted)


def met(reason, accepted):
    """The verdict when the bound holds."""
    return Verdict(PASS, reason if accepted is None else f"{reason}; {MET_NOTE}")


def missed(reason, accepted, miss, accepted_miss):
    """The verdict when the bound is missed by `miss`, where `accepted_miss` (of the value `accepted`) is tolerated."""
    if accepted is None:
        return Verdict(FAIL, reason)
    if miss <= TOLERATED_GROWTH * accepted_miss:
        return Verdict(NOT_MET, f"{reason}; not worse than the accepted {number(accepted)} by more than a tenth")
    return Verdict(FAIL, f"{reason}; worse than the accepted {number(accepted)} by more than a tenth")


def distance(value, band):
    """How far `value` lies outside the band; 0 inside."""
    return max(band[0] - value, value - band[1], 0.0)


def joined(verdicts):
    """One verdict for several demands: the worst word, all reasons."""
    word = worst(v.word for v in verdicts)
    return Verdict(word, "; ".join(v.reason for v in verdicts))


def worst(words):
    """fail before not_met before pass; pass for nothing."""
    return max(words, key=(PASS, NOT_MET, FAIL).index, default=PASS)


def counts(words):
    """{"pass": n, "fail": n, "not_met": n}."""
    words = list(words)
    return {word: words.count(word) for word in (PASS, FAIL, NOT_MET)}


def number(value):
    """A number for people: four significant digits."""
    return f"{value:.4g}"
