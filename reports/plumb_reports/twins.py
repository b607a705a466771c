"""must_fail: runs a case with broken physics and demands that the named check breaks.

A twin that crashes, diverges, is refused as input or gives nothing finite to compare shows nothing about the check and
does not count. Other checks may break as well; only the named one is demanded.
"""

from dataclasses import dataclass

from . import verdicts
from .bisection import bisected
from .judge import Judgement, judgement
from .plan import plan
from .runner import executed
from .strict import CaseError


@dataclass
class TwinJudgement:
    """The outcome of one twin: `broken` judges the broken runs; `control` the unbroken ones (None when not needed)."""
    twin: object
    broken: Judgement
    control: Judgement
    verdict: verdicts.Verdict


def twin_values(case, twin):
    """The sweep values to run: the stated one, the whole sweep for an order, else the finest."""
    if twin.value is not None:
        return (twin.value,)
    check = case.check(twin.breaks)
    values = case.values_of(case.variant(twin.variant), check.twin_tier)
    return values if check.order else values[-1:]


def judged_twins(case, plumb, planted, jobs, folder, reference):
    """The TwinJudgement of every twin. Raises CaseError when a planted fault needs a binary that was not given."""
    results = []
    for i, twin in enumerate(case.must_fail):
        if twin.planted and planted is None:
            raise CaseError(f"{case.folder / 'case.toml'}: [[must_fail]] of '{twin.breaks}': key 'planted' needs the "
                            "test binary, --planted")
        binary = planted if twin.planted else plumb
        place = folder / f"twin_{i + 1:02d}"
        broken = twin_judgement(case, twin, twin.overrides, binary, jobs, place / "broken", reference)
        # At the values of the tier itself <case>.quick is the control; only a value of its own needs one here.
        control = None
        if twin.value is not None:
            control = twin_judgement(case, twin, {}, plumb, jobs, place / "control", reference)
        results.append(TwinJudgement(twin, broken, control, twin_verdict(broken, control)))
    return results


def twin_judgement(case, twin, overrides, plumb, jobs, folder, reference):
    """The Judgement of the named check on runs with `overrides`."""
    check, variant = case.check(twin.breaks), case.variant(twin.variant)
    bisection = case.bisection_of(variant)
    if bisection:
        boundary = bisected(case, bisection, variant, check.twin_tier, folder, plumb, reference, overrides)
        return judgement(check, twin.variant, check.twin_tier, [boundary], reference)
    plans = [plan(case, variant, value, folder / f"{k:02d}", overrides)
             for k, value in enumerate(twin_values(case, twin))]
    runs = executed(case, plans, plumb, jobs)
    return judgement(check, twin.variant, check.twin_tier, runs, reference, with_order=twin.value is None)


def twin_verdict(broken, control):
    """pass when the broken physics, and nothing else, made the check fail."""
    if control is not None and control.verdict.word == verdicts.FAIL:
        return verdicts.Verdict(verdicts.FAIL, f"the unbroken run fails already: {control.verdict.reason}")
    if not broken.judged:
        return verdicts.Verdict(verdicts.FAIL, f"does not count as breaking the check: {broken.verdict.reason}")
    if broken.verdict.word != verdicts.FAIL:
        return verdicts.Verdict(verdicts.FAIL, f"the check did not notice: {broken.verdict.reason}")
    return verdicts.Verdict(verdicts.PASS, f"caught: {broken.verdict.reason}")
