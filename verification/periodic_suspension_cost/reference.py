"""What a uniform periodic suspension costs: its error in the hindered velocity and CPU seconds, as published and with what replaces it (README.md)."""

import sys
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "reference_data"))

from run_costs import cheaper, cost, repeated  # noqa: E402
from verification_case import case  # noqa: E402

suspension = case("periodic_suspension")
UNITS = {"settling": "m/s", "one_way": "m/s"}
PANELS = {("glycerol", "060"): "glycerol-water, eps 0.6", ("glycerol", "090"): "glycerol-water, eps 0.9", ("water", "060"): "water, eps 0.6",
          ("water", "090"): "water, eps 0.9"}
LABELS = {"as_code": "as_code", "implicit": "as_code, exponential exchange", "dynamic": "as_code, dynamic pressure",
          "dynamic_implicit": "dynamic, exponential exchange", "one_way": "plumb_grains, one way", "plain": "plumb_grains, not corrected", "plumb": "plumb_grains"}


def one_way(scene):
    """eps times the slip at which drag alone holds the whole weight less buoyancy of a grain, m/s (README, equation 1)."""
    bed = suspension.Suspension(scene)
    weight = bed.effective_weight / bed.eps
    stokes = (bed.rho_p - bed.rho) * bed.g * bed.d**2 / (18.0 * bed.mu)
    return bed.eps * brentq(lambda w: bed.drag(bed.eps, w) / weight - 1.0, 1e-9 * stokes, 3.0 * stokes, rtol=1e-13)


def reference(quantity, scene, t):
    return one_way(scene) if quantity == "one_way" else suspension.reference(quantity, scene, t)


def measure(quantity, run):
    return suspension.measure("settling", run) if quantity in UNITS else NotImplemented


def error(run):
    """Greatest distance from the hindered velocity in the second half of the run, over it."""
    return float(np.max(np.abs(suspension.measure("settling", run)[1] / suspension.reference("settling", run.scene, 0.0) - 1.0)))


# --- the page ---


def groups(runs):
    """{(fluid, eps, scheme): its runs}."""
    return {tuple(name.split("_", 2)): same for name, same in repeated(run for run in runs if not run.failure).items()}


def table(runs):
    found, rows = groups(runs), []
    for (fluid, eps, scheme), same in found.items():
        seconds, first = [run.info["cpu_s"] for run in same], same[0]
        rows.append([PANELS[fluid, eps], LABELS[scheme], f"{100.0 * error(first):.2g}", first.info["steps"], first.info["ruling_limit"],
                     f"{1e6 * cost(same) / first.info['updates']:.2f}", f"{cost(same):.2f}", f"{min(seconds):.2f} to {max(seconds):.2f}" if len(same) > 1 else "",
                     cheaper(found.get((fluid, eps, "as_code")), same)])
    return {"columns": ["suspension", "run", "error (%)", "steps", "ruled by", "CPU us/update", "CPU s (median)", "range", "as_code's CPU over it"], "rows": rows,
            "caption": "1000 grains, 1000 particles, 4 ms in glycerol-water and 40 ms in water. Error: greatest distance from the hindered velocity in the second half, over it."}


def figures(runs):
    from matplotlib.figure import Figure
    from matplotlib.ticker import NullFormatter

    figure, found = Figure(figsize=(12.0, 4.0), layout="constrained"), groups(runs)
    *panels, key = figure.subplots(1, 5, sharey=True, gridspec_kw={"width_ratios": [1.0, 1.0, 1.0, 1.0, 0.95]})
    for axes, (fluid, eps) in zip(panels, PANELS):
        for number, (scheme, label) in enumerate(LABELS.items()):
            if (fluid, eps, scheme) in found:
                same = found[fluid, eps, scheme]
                mark, size = {"plumb": ("*", 13), "implicit": ("x", 6), "dynamic_implicit": ("+", 8)}.get(scheme, ("o", 6))
                axes.plot(cost(same), 100.0 * error(same[0]), mark, ms=size, color="k" if mark in "x+" else f"C{number}", label=label)
        axes.axhline(0.5, color="0.4", lw=0.8, label="0.5 %")
        axes.set_title(PANELS[fluid, eps], fontsize="small")
        axes.set(xlabel="CPU seconds", xscale="log", yscale="log")
        axes.xaxis.set_minor_formatter(NullFormatter())
    handles = {label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels())}
    key.legend(handles.values(), handles.keys(), loc="center left", fontsize=8)
    key.axis("off")
    figure.axes[0].set_ylabel("greatest error of the hindered velocity (%)")
    return [("error_by_cost", figure, "Error against CPU seconds of a uniform suspension; one core, runs one after the other; medians where repeated.")]
