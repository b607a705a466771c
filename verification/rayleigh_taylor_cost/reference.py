"""What rayleigh_taylor costs: its error in the rates and CPU seconds, as published and with what replaces it (README.md)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "reference_data"))

from run_costs import cheaper, cost, repeated  # noqa: E402
from verification_case import case  # noqa: E402

scene_theory = case("rayleigh_taylor")

UNITS = {"growth": "1"}
GOAL = 5.0  # of as_code's CPU seconds over plumb_grains'
LABELS = {"as_code": "as_code", "plumb": "plumb_grains, c = 1 m/s"}


def measure(quantity, run):
    return scene_theory.measure(quantity, run) if quantity in UNITS else NotImplemented


def reference(quantity, scene, t):
    if quantity in UNITS:
        return 0.0
    raise KeyError(quantity)


# --- the page ---


def table(runs):
    found, rows = repeated(runs), []
    for scheme, same in found.items():
        (one, linear_one), (other, linear_other) = scene_theory.growth(same[0])
        rows.append([LABELS[scheme], same[0].info["steps"], f"{one / linear_one - 1.0:+.3f}", f"{other / linear_other - 1.0:+.3f}",
                     f"{cost(same):.2f}", " ".join(f"{run.info['cpu_s']:.2f}" for run in same), cheaper(found.get("as_code"), same)])
    return {"columns": ["run", "steps", "error of the rate, k", "sqrt 2 k", "CPU s (median)", "each", "as_code's CPU over it"], "rows": rows,
            "caption": f"50 ms of rayleigh_taylor, glycerol-water, 10 across. Goal: as_code's CPU seconds over those of plumb_grains at least {GOAL:g}."}


def figures(runs):
    from matplotlib.figure import Figure

    figure, found = Figure(figsize=(6.0, 4.4), layout="constrained"), repeated(runs)
    axes = figure.subplots()
    for scheme, same in found.items():
        axes.plot(cost(same), 100.0 * measure("growth", same[0]), "o", ms=8, label=LABELS[scheme])
    if "as_code" in found:
        axes.axvline(cost(found["as_code"]) / GOAL, color="0.4", lw=0.8, ls="--", label=f"as_code/{GOAL:g}")
    axes.axhline(5.0, color="0.4", lw=0.8, label="5 %")
    axes.set(xlabel="CPU seconds", ylabel="error of the rate, the worse wave (%)", xscale="log", yscale="log")
    axes.legend(fontsize=7)
    return [("error_by_cost", figure, "Error of the growth rate against linear theory over CPU seconds, one core, runs one after the other; medians where repeated.")]
