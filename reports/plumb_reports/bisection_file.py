"""[[bisection]] and [work_precision] of case.toml. The keys are explained in reports/README.md."""

import math
from dataclasses import dataclass

QUANTITIES = ("stable", "unstable", "boundary")  # what a bisection measures, as `<id>.stable` and so on


@dataclass(frozen=True)
class Bisection:
    """Where a scene stops being stable as one of its keys grows.

    `default` is tried first; the boundary is then sought up to `high`, or down to `low` when the default is unstable
    already, until it is known within `resolution`, the natural logarithm of lowest unstable over highest stable value.
    """
    id: str
    parameter: str
    variants: tuple
    low: float
    default: float
    high: float
    resolution: dict  # by tier, as Check.finest
    quantity: str
    times_start: float = None
    above: float = None
    rules: str = None  # step limit that has to rule in every run

    def resolution_of(self, tier):
        """The resolution that `tier` asks for."""
        return self.resolution["quick" if tier == "quick" else "full"]

    @property
    def quantities(self):
        """The quantities that a check of a bisected variant may name besides those of its runs."""
        return tuple(f"{self.id}.{name}" for name in QUANTITIES)


@dataclass(frozen=True)
class WorkPrecision:
    """A chart of the error that `check` measures against CPU time, for every run of `variants`."""
    check: str
    variants: tuple


def read_bisections(table, variants, sweep):
    """The bisections; a variant belongs to one at most, and a bisected variant is not swept."""
    bisections = []
    for entry in table.tables("bisection"):
        bisection = read_bisection(entry, variants)
        if any(b.id == bisection.id for b in bisections):
            raise entry.error("id", f"{bisection.id!r} is used twice")
        for name in bisection.variants:
            variant = next(v for v in variants if v.name == name)
            if any(name in b.variants for b in bisections):
                raise entry.error("variants", f"names '{name}', which another bisection varies already")
            if bisection.parameter in variant.overrides:
                raise entry.error("parameter", f"is set by variant '{name}'")
            if sweep and variant.swept:
                raise entry.error("variants", f"names '{name}', which is swept; say sweep = false there")
        bisections.append(bisection)
    return tuple(bisections)


def read_bisection(entry, variants):
    """One Bisection from its table."""
    identity = entry.name("id")
    entry.where = f"[[bisection]] '{identity}'"
    names = [v.name for v in variants]
    resolution = {"full": entry.number("resolution")}
    resolution["quick"] = entry.number("quick_resolution", resolution["full"])
    unstable = entry.table("unstable", f"{entry.where} unstable")
    if unstable is None:
        raise entry.error("unstable", "is missing; it says which quantity tells that a run is unstable")
    bisection = Bisection(
        identity, entry.text("parameter"), entry.texts("variants", tuple(names), choices=names), entry.number("low"),
        entry.number("default"), entry.number("high"), resolution, unstable.text("quantity"),
        unstable.number("times_start", None), unstable.number("above", None), entry.text("rules", None))
    unstable.finish()
    entry.finish()
    refuse_impossible_bracket(entry, unstable, bisection)
    return bisection


def refuse_impossible_bracket(entry, unstable, bisection):
    """Raises CaseError for numbers between which nothing can be sought, or a quantity without one clear bound."""
    if not 0.0 < bisection.low < bisection.default < bisection.high:
        raise entry.error("default", f"must lie between low and high, all positive, but is {bisection.default!r}")
    widest = math.log(bisection.high / bisection.low)
    for key, tier in (("resolution", "full"), ("quick_resolution", "quick")):
        if not 0.0 < bisection.resolution[tier] < widest:
            raise entry.error(key, f"must lie between 0 and ln(high/low) = {widest:.4g}")
    if (bisection.times_start is None) == (bisection.above is None):
        raise unstable.error("times_start", "or 'above' has to be given, and not both")
    if bisection.times_start is not None and bisection.times_start <= 1.0:
        raise unstable.error("times_start", f"must be more than 1, but is {bisection.times_start!r}")


def read_work_precision(table, checks, variants, bisections):
    """The WorkPrecision of [work_precision], or None. Every variant that is not bisected is shown unless some are named."""
    entry = table.table("work_precision", "[work_precision]")
    if entry is None:
        return None
    bisected = {name for bisection in bisections for name in bisection.variants}
    names = tuple(v.name for v in variants if v.name not in bisected)
    check = entry.text("check", choices=[c.id for c in checks])
    stated = WorkPrecision(check, entry.texts("variants", names, choices=names))
    entry.finish()
    if next(c for c in checks if c.id == check).range:
        raise entry.error("check", f"is {check!r}, which judges a value; the chart needs an error")
    return stated
