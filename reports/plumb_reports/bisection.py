"""Finds by bisection where a run stops being stable as one key of its scene grows.

Stability is taken to be monotonous: whatever lies above an unstable value is not tried again. Every value is run afresh
and listed among the runs of the report.
"""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from .metrics import NotComparable
from .plan import Plan
from .runner import executed_plan

DIVERGED = 3  # exit code of the solver
STABLE = "stable"


class Bisected:
    """A bisected variant, as checks and reference.py see it: the run at the highest stable value, and the boundary.

    failure         why no boundary could be sought (None when it could)
    stable          highest stable value, None when none was found
    unstable        lowest unstable value, None when none was found
    trials          the Runs, in the order in which they were made; their `outcome` says "stable" or why not
    Whatever else a Run has is that of the run at the highest stable value (or of the first, when none was stable).
    """

    parameter = value = None  # of a sweep, which a bisected variant is not part of

    def __init__(self, bisection, variant, trials, failure):
        self.bisection, self.variant, self.trials, self.failure = bisection, variant, trials, failure
        stable = [trial for trial in trials if trial.outcome == STABLE]
        unstable = [trial for trial in trials if trial.outcome not in (STABLE, None)]
        self.best = max(stable, key=lambda trial: trial.value, default=trials[0])
        self.stable = max((used_value(bisection, trial) for trial in stable), default=None)
        self.unstable = min((used_value(bisection, trial) for trial in unstable), default=None)

    def __getattr__(self, name):
        return getattr(self.best, name)

    def derived(self, quantity):
        """The value of `<id>.stable`, `.unstable` or `.boundary` (their geometric mean); else NotImplemented."""
        if quantity not in self.bisection.quantities:
            return NotImplemented
        missing = [name for name in (STABLE, "unstable") if getattr(self, name) is None]
        wanted = quantity.rsplit(".", 1)[1]
        if wanted in missing or wanted == "boundary" and missing:
            values = [trial.value for trial in self.trials]
            raise NotComparable(f"no {' and no '.join(missing)} {self.bisection.parameter} was found from "
                                f"{min(values):.4g} to {max(values):.4g}")
        return math.sqrt(self.stable * self.unstable) if wanted == "boundary" else getattr(self, wanted)


def used_value(bisection, trial):
    """The value that the run really had: a factor on a step limit is rounded down, as outputs are whole steps apart."""
    if bisection.rules is None:
        return trial.value
    return trial.value * trial.info["step"] / trial.info["limits"][bisection.rules]


def bisected_variants(case, tier, folder, plumb, jobs, reference):
    """The Bisected of every bisected variant that `tier` runs, at most `jobs` at a time."""
    chosen = [(bisection, case.variant(name)) for bisection in case.bisections for name in bisection.variants
              if case.runs_in(case.variant(name), tier)]
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        return list(pool.map(lambda pair: bisected(case, *pair, tier, folder / pair[1].name, plumb, reference), chosen))


def bisected(case, bisection, variant, tier, folder, plumb, reference, broken=None):
    """The Bisected of one variant; `broken` overrides win over the variant's."""
    search = Search(case, bisection, variant, folder, plumb, reference, broken or {})
    failure = None
    try:
        search.narrow(bisection.resolution_of(tier))
    except NotComparable as error:
        failure = str(error)
    return Bisected(bisection, variant.name, search.trials, failure)


class Search:
    """One bisection under way."""

    def __init__(self, case, bisection, variant, folder, plumb, reference, broken):
        self.case, self.bisection, self.variant = case, bisection, variant
        self.folder, self.plumb, self.reference, self.broken = folder, plumb, reference, broken
        self.trials = []

    def narrow(self, resolution):
        """Tries values until lowest unstable and highest stable are within `resolution` (of their logarithm), or until
        an end of the bracket turns out to lie on the same side as the default. Raises NotComparable for other errors."""
        low, high = self.bisection.low, self.bisection.high
        if self.is_stable(self.bisection.default):
            low = self.bisection.default
            if self.is_stable(high):
                return
        else:
            high = self.bisection.default
            if not self.is_stable(low):
                return
        while math.log(high / low) > resolution:
            middle = math.sqrt(low * high)
            if self.is_stable(middle):
                low = middle
            else:
                high = middle

    def is_stable(self, value):
        """Whether the run at `value` is stable. Raises NotComparable when that cannot be said."""
        bisection = self.bisection
        overrides = {**self.variant.overrides, **self.broken, bisection.parameter: value}
        plan = Plan(self.variant.name, value, overrides, self.folder / f"{len(self.trials):02d}")
        run = executed_plan(self.case, plan, self.plumb)
        run.parameter = bisection.parameter
        self.trials.append(run)
        try:
            run.outcome = outcome(bisection, run, self.reference)
        except NotComparable as error:
            raise NotComparable(f"{bisection.parameter} = {value:.4g}: {error}") from error
        return run.outcome == STABLE


def outcome(bisection, run, reference):
    """"stable", or why the run was not; raises NotComparable for a failure that is no instability."""
    diverged = run.exit == DIVERGED
    if run.failure and not diverged:
        raise NotComparable(run.failure)
    demand_ruling_limit(bisection, run)
    if diverged:
        return f"unstable: {run.failure}"
    _, values, _ = reference.measured(bisection.quantity, run)
    bound = bisection.above if bisection.above is not None else bisection.times_start * np.abs(values[0]).max()
    largest = np.abs(values).max()
    if largest <= bound:  # written so that NaN is not stable
        return STABLE
    return f"unstable: {bisection.quantity} reached {largest:.4g}, more than {bound:.4g}"


def demand_ruling_limit(bisection, run):
    """Raises NotComparable when another limit than the bisected one set the step: the value then changed nothing."""
    if bisection.rules is None:
        return
    try:
        ruling = run.info["ruling_limit"]
    except (OSError, ValueError, KeyError) as error:
        raise NotComparable(f"the run left no usable run.json: {error}") from error
    if ruling != bisection.rules:
        raise NotComparable(f"the step is ruled by '{ruling}', not by '{bisection.rules}'")
