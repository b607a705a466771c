"""Which runs a tier needs: every variant at every sweep value."""

from dataclasses import dataclass
from pathlib import Path

from .strict import toml_value


@dataclass(frozen=True)
class Plan:
    """One run to be made: `overrides` go to --set in order; the result goes to `folder`."""
    variant: str
    value: float
    overrides: dict
    folder: Path


def tier_plans(case, tier, folder):
    """The plans of `tier`, variant by variant, coarse to fine. A variant that only other tiers judge is not run; the runs
    of a bisected one are not known beforehand."""
    return [plan(case, variant, value, folder / variant.name / f"{i:02d}")
            for variant in case.variants if case.runs_in(variant, tier) and not case.bisection_of(variant)
            for i, value in enumerate(case.values_of(variant, tier))]


def plan(case, variant, value, folder, broken=None):
    """The Plan of one variant at one sweep value; `broken` overrides come last and win."""
    overrides = dict(variant.overrides)
    if value is not None:
        overrides[case.sweep.parameter] = value
    broken = broken or {}
    kept = {key: setting for key, setting in overrides.items() if key not in broken}
    return Plan(variant.name, value, {**kept, **broken}, Path(folder))


def command(plumb, scene, plan_):
    """The command line of a run. One thread makes costs comparable; --jobs decides how many cores are used."""
    settings = [part for key, value in plan_.overrides.items() for part in ("--set", f"{key}={toml_value(value)}")]
    return [str(plumb), "run", str(scene), *settings, "-o", str(plan_.folder), "--threads", "1", "--quiet"]
