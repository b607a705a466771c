"""Judges one check on the runs of one variant."""

from dataclasses import dataclass, field

import numpy as np

from . import verdicts
from .metrics import ENSEMBLE, Comparison, Measurement, NotComparable, measurement, value_measurement
from .orders import NoOrder, OrderFit, order_fit


@dataclass
class Judgement:
    """The outcome of one check for one variant.

    `measurements` and `comparisons` belong to `runs`, coarse to fine, and are empty when the check could not be judged
    (`judged` is False: a run failed, nothing to compare, not finite, an exception in reference.py).
    """
    check: object
    variant: str
    runs: list
    verdict: verdicts.Verdict
    judged: bool
    bound: object = None
    measurements: list[Measurement] = field(default_factory=list)
    comparisons: list[Comparison] = field(default_factory=list)
    fit: OrderFit = None

    @property
    def finest(self):
        """The Measurement of the finest run, or None."""
        return self.measurements[-1] if self.measurements else None


def judgements(case, tier, runs, reference):
    """The Judgement of every check of `tier` for each of its variants, or for all together if they are an ensemble."""
    found = []
    for check in (c for c in case.checks if tier in c.tiers):
        if check.metric == ENSEMBLE:
            found.append(ensemble_judgement(check, tier, [r for r in runs if r.variant in check.variants], reference))
        else:
            found += [judgement(check, variant, tier, [r for r in runs if r.variant == variant], reference)
                      for variant in check.variants]
    return found


def ensemble_judgement(check, tier, runs, reference):
    """The Judgement of one check on the mean of all its variants, one run each."""
    name, bound = f"{check.variants[0]} to {check.variants[-1]}", check.bound(tier)
    try:
        data = ensemble([(run.variant, comparison(check, run, reference)) for run in runs])
        mean = measured(check, data)
    except NotComparable as error:
        return Judgement(check, name, runs, verdicts.Verdict(verdicts.FAIL, str(error)), False, bound)
    return Judgement(check, name, runs[-1:], bound_verdict(check, bound, mean), True, bound, [mean], [data])


def ensemble(members):
    """One Comparison of (variant, Comparison of single numbers) pairs: a row for each."""
    for name, member in members:
        if member.is_series:
            raise NotComparable(f"{name}: a member of an ensemble is a single number, not a series")
    measured_, expected = (np.concatenate([getattr(m, part) for _, m in members]) for part in ("measured", "expected"))
    return Comparison(np.arange(1.0, len(members) + 1.0), measured_, expected, units=members[0][1].units, axis="member")


def judgement(check, variant, tier, runs, reference, with_order=True):
    """The Judgement of one check on `runs`, coarse to fine. `with_order` is False when single runs are judged."""
    bound = check.range or check.bound(tier)
    try:
        comparisons = [comparison(check, run, reference) for run in runs]
        measurements = [measured(check, data) for data in comparisons]
    except NotComparable as error:
        return Judgement(check, variant, runs, verdicts.Verdict(verdicts.FAIL, str(error)), False, bound)
    fit, order_problem = fitted_order(runs, measurements) if check.order else (None, None)
    demands = []
    if bound is not None:
        demands.append(bound_verdict(check, bound, measurements[-1]))
    if check.order and with_order:
        demands.append(order_verdict(check, fit, order_problem))
    return Judgement(check, variant, runs, verdicts.joined(demands), True, bound, measurements, comparisons, fit)


def comparison(check, run, reference):
    """The Comparison of one run; raises NotComparable when the run failed or cannot be compared."""
    if run.failure:
        raise NotComparable(at(run) + run.failure)
    try:
        return reference.comparison(check, run)
    except NotComparable as error:
        raise NotComparable(at(run) + str(error)) from error


def at(run):
    """"parameter = value: " of a swept run."""
    return "" if run.value is None else f"{run.parameter} = {verdicts.number(run.value)}: "


def measured(check, data):
    """The Measurement that the check asks for."""
    if check.range:
        return value_measurement(data, check.window, check.range)
    return measurement(check.metric, data, check.window)


def bound_verdict(check, bound, finest):
    """Verdict of the finest run on the check's bound or range, sampling error included."""
    accepted = check.not_met.accepted if check.not_met else None
    if not check.range:
        return verdicts.error_verdict(finest.value, finest.error_bar, bound, accepted)
    bar = finest.error_bar or 0.0
    return verdicts.interval_verdict(finest.value - bar, finest.value + bar, bound, finest.value, accepted)


def fitted_order(runs, measurements):
    """(OrderFit or None, why there is none or None)."""
    bars = [m.error_bar or 0.0 for m in measurements]
    try:
        return order_fit([run.value for run in runs], [m.value for m in measurements], bars), None
    except NoOrder as error:
        return None, str(error)


def order_verdict(check, fit, problem):
    """Verdict on the fitted order: its whole 95 % interval has to lie in the band."""
    if fit is None:
        return verdicts.Verdict(verdicts.FAIL, f"no order: {problem}")
    accepted = check.not_met.accepted if check.not_met else None
    verdict = verdicts.interval_verdict(fit.lower, fit.upper, check.order, fit.order, accepted)
    dropped = f" (fitted to the {fit.used} coarsest points, {fit.plateau} on a plateau)" if fit.plateau else ""
    return verdicts.Verdict(verdict.word, f"order {verdicts.number(fit.order)}{dropped}: interval {verdict.reason}")

