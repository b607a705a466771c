"""What one grain costs: distance from the drag law's own relaxation, and CPU seconds beside those of the published scheme (README.md)."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from run_costs import cheaper, cost, repeated  # noqa: E402
from theory import settling  # noqa: E402
from theory.lone_grain import law_of  # noqa: E402
from theory.released_sphere import Sphere, speed_without_history  # noqa: E402

UNITS = {"off_law": "1"}
EARLIEST = 5.0  # tau_p
FLUIDS = {"glycerol": "glycerol-water", "water": "water"}  # beginning of a variant's name: label
GOAL = {"glycerol": 8.0, "water": 20.0}  # of as_code's CPU seconds over plumb_grains'
BOUND = 0.005
LABELS = {"as_code": "as_code", "as_code_quiet": "as_code, masses at rest", "as_slides": "as_slides", "implicit": "as_code, exponential exchange",
          "dynamic": "as_code, dynamic pressure", "dynamic_implicit": "dynamic, exponential exchange", "plain": "plumb_grains, not corrected",
          "one_way": "plumb_grains, one way", "plumb": "plumb_grains", "c4": "plumb_grains, C4, h = 1.95 spacings"}


def lone(scene):
    """The grain under Di Felice's law at porosity 1, and its tau_p, s."""
    fluid, grain = scene["fluid"], scene["grains"]
    sphere = Sphere(law_of(1.0), grain["density"], grain["diameter"], fluid["density"], fluid["viscosity"])
    return sphere, settling.relaxation_time(grain["density"], grain["diameter"], fluid["viscosity"])


def errors(run):
    """(t/tau_p, (v - law)/u_t) at the times of output from EARLIEST on."""
    sphere, tau = lone(run.scene)
    t, v = run.series("v")
    late = t > EARLIEST * tau * (1.0 - 1e-9)
    law = speed_without_history(sphere, t[late], False)
    return t[late] / tau, (-np.ravel(v)[late] - law) / sphere.terminal_speed()


def measure(quantity, run):
    return float(np.max(np.abs(errors(run)[1]))) if quantity == "off_law" else NotImplemented


def reference(quantity, scene, t):
    if quantity in UNITS:
        return 0.0
    raise KeyError(quantity)


# --- the page ---


def groups(runs):
    """{(fluid, scheme): its runs}."""
    return {tuple(name.split("_", 1)): same for name, same in repeated(runs).items()}


def table(runs):
    found, rows = groups(runs), []
    for (fluid, scheme), same in found.items():
        seconds, first = [run.info["cpu_s"] for run in same], same[0]
        rows.append([FLUIDS[fluid], LABELS[scheme], f"{100.0 * measure('off_law', first):.2f}", first.info["steps"], first.info["sph"]["particles"],
                     f"{1e6 * cost(same) / first.info['updates']:.2f}", f"{cost(same):.2f}", f"{min(seconds):.2f} to {max(seconds):.2f}" if len(same) > 1 else "",
                     cheaper(found.get((fluid, "as_code")), same)])
    return {"columns": ["fluid", "run", "error (%)", "steps", "particles", "CPU us/update", "CPU s (median)", "range", "as_code's CPU over it"], "rows": rows,
            "caption": "One grain, h/d = 3, 50 tau_p. Error: greatest distance from the drag law from 5 tau_p on, over u_t. Goal: as_code's CPU seconds over those of "
                       "plumb_grains at least " + ", ".join(f"{GOAL[fluid]:g} ({FLUIDS[fluid]})" for fluid in GOAL) + "."}


def figures(runs):
    from matplotlib.figure import Figure

    figure, found = Figure(figsize=(11.0, 4.6), layout="constrained"), groups(runs)
    *panels, key = figure.subplots(1, 3, sharey=True, gridspec_kw={"width_ratios": [1.0, 1.0, 0.6]})
    for axes, fluid in zip(panels, FLUIDS):
        for number, (scheme, label) in enumerate(LABELS.items()):
            if (fluid, scheme) in found:
                same = found[fluid, scheme]
                mark, size = {"plumb": ("*", 13), "implicit": ("x", 5), "dynamic_implicit": ("+", 7)}.get(scheme, ("o", 7))
                axes.plot(cost(same), 100.0 * measure("off_law", same[0]), mark, ms=size, color="k" if mark in "x+" else f"C{number}",
                          mew=1.0 if mark in "x+*" else 0.0, label=label)
        if (fluid, "as_code") in found:
            goal = cost(found[fluid, "as_code"]) / GOAL[fluid]
            axes.axvline(goal, color="0.4", lw=0.8, ls="--", label="goal: as_code/8, as_code/20")
        axes.axhline(100.0 * BOUND, color="0.4", lw=0.8, label="0.5 %")
        axes.set(title=FLUIDS[fluid], xlabel="CPU seconds", xscale="log", yscale="log")
    handles = {label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels())}
    key.legend(handles.values(), handles.keys(), loc="center left", fontsize=8)
    key.axis("off")
    figure.axes[0].set_ylabel("greatest error of the speed from 5 τ_p on (% of u_t)")
    return [("error_by_cost", figure, "Error against CPU seconds of one grain at h/d = 3, 50 tau_p; one core, runs one after the other; medians where repeated.")]
