"""Cells from 4 d to 0.2 d: what a grain that moves through them does to the water, and flow through a bed that they resolve or not (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "reference_data")]

from displaced_column import Column  # noqa: E402
from drag_laws.drag_laws import LAWS  # noqa: E402
from theory import packed_beds  # noqa: E402

UNITS = {"swings": "Pa", "greatest_swing": "Pa", "porosity_jump": "1", "flow_over_law": "1", "flow_over_field": "1", "mean_porosity": "1",
         "bounded": "1"}


class RandomBed:
    """The numbers of a fixed random bed and of its flow along x."""

    def __init__(self, scene):
        fluid, arrange = scene["fluid"], scene["grains"]["arrange"]
        self.rho, self.mu, self.d = fluid["density"], fluid["viscosity"], scene["grains"]["diameter"]
        self.law, self.gradient = LAWS[scene["coupling"]["drag"]], -scene["coupling"]["mean_pressure_gradient"][0]
        self.eps = 1.0 - arrange["count"] * math.pi / 6.0 * self.d**3 / math.prod(scene["domain"]["size"])

    def superficial(self, eps):
        return packed_beds.superficial_velocity(self.law, eps, self.gradient, self.d, self.rho, self.mu)


def reference(quantity, scene, t):
    if quantity == "swings":
        return Column(scene).swings()
    if quantity == "greatest_swing":
        return float(Column(scene).swings().max())
    if quantity == "porosity_jump":
        return jumps(Column(scene))
    if quantity == "mean_porosity":
        return RandomBed(scene).eps
    return 1.0  # flow_over_law, flow_over_field


def jumps(column):
    """The greatest change of a cell's porosity in a step."""
    places = [column.start] + [column.start + column.speed * (n + 1) * column.dt for n in range(column.steps)]
    eps = np.array([column.porosity(x) for x in places])
    return float(np.abs(np.diff(eps, axis=0)).max())


def porosities(run, k):
    return run.snapshot(k)["fluid"]["rho"] / run.scene["fluid"]["density"]


def measure(quantity, run):
    if quantity not in UNITS:
        return NotImplemented
    if quantity == "bounded":
        return float(run.info["coupling"]["bounded_porosities"])
    if quantity == "mean_porosity":
        return float(porosities(run, -1).mean())
    if quantity.startswith("flow"):
        bed = RandomBed(run.scene)
        size = run.scene["domain"]["size"]
        flow = float(run.series("flow")[1].ravel()[-1]) / (size[1] * size[2])
        return flow / (bed.superficial(bed.eps) if quantity == "flow_over_law" else averaged(bed, porosities(run, -1)))
    pressures = [run.snapshot(k)["fluid"]["p"] for k in range(1, len(run.snapshot_files()))]
    if quantity == "porosity_jump":
        fields = np.array([porosities(run, k) for k in range(len(run.snapshot_files()))])
        return float(np.abs(np.diff(fields, axis=0)).max())
    found = np.array([p.max() - p.min() for p in pressures])
    return float(found.max()) if quantity == "greatest_swing" else (np.arange(1, len(found) + 1), found)


def averaged(bed, eps):
    """u_s through cells of porosities eps, m/s, to second order in the fluctuations of their mobility k: <k> - var k/(3 <k>),
    e.g. Landau & Lifshitz, Electrodynamics of continuous media, sec. 9."""
    mobility = np.array([bed.superficial(e) for e in np.quantile(np.minimum(eps, 0.999), (np.arange(200) + 0.5) / 200)])
    return float(mobility.mean() - mobility.var() / (3.0 * mobility.mean()))


def kernel_name(scene):
    coupling = scene["coupling"]
    if coupling["kernel"] == "cell_counting":
        return "cell_counting"
    return f"{coupling['kernel']} {coupling['kernel_width'] / scene['grains']['diameter']:.2g} d"


def figures(runs):
    return [("swing", swing_figure(runs), "Swing of the pressure and greatest change of a porosity in a step of 1 ms (a tenth of a diameter): runs and the column's theory."),
            ("bed", bed_figure(runs), "Flow through a random bed at a given pressure gradient over that of the law at the mean porosity, and the extremes of the cells' porosity.")]


def swing_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    own = [run for run in runs if not run.variant.startswith("bed") and not run.failure and run.scene["time"]["step"] == 1e-3]
    for axes, quantity, label in zip(figure.subplots(1, 2), ("greatest_swing", "porosity_jump"), ("swing of the pressure [Pa]", "greatest change of eps in a step [-]")):
        for number, name in enumerate(sorted({kernel_name(run.scene) for run in own})):
            group = sorted((run for run in own if kernel_name(run.scene) == name), key=lambda run: run.scene["fluid"]["spacing"][0])
            h = [run.scene["fluid"]["spacing"][0] / run.scene["grains"]["diameter"] for run in group]
            axes.loglog(h, [measure(quantity, run) for run in group], f"C{number}o", mfc="none", label=name)
            axes.loglog(h, [reference(quantity, run.scene, 0.0) for run in group], f"C{number}-", lw=1)
        axes.set(xlabel="cells, h/d [-]", ylabel=label)
        axes.legend(fontsize="x-small")
    return figure


def bed_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    own = [run for run in runs if run.variant.startswith("bed") and not run.failure]
    left, right = figure.subplots(1, 2)
    for number, name in enumerate(sorted({kernel_name(run.scene) for run in own})):
        group = sorted((run for run in own if kernel_name(run.scene) == name), key=lambda run: run.scene["fluid"]["spacing"])
        h = [run.scene["fluid"]["spacing"] / run.scene["grains"]["diameter"] for run in group]
        left.semilogx(h, [measure("flow_over_law", run) for run in group], f"C{number}o-", mfc="none", lw=1, label=name)
        right.semilogx(h, [porosities(run, -1).min() for run in group], f"C{number}v-", mfc="none", lw=1, label=name)
        right.semilogx(h, [porosities(run, -1).max() for run in group], f"C{number}^-", mfc="none", lw=1)
    left.set(xlabel="cells, h/d [-]", ylabel="flow over that of the law [-]")
    right.set(xlabel="cells, h/d [-]", ylabel="least and greatest eps of a cell [-]")
    left.legend(fontsize="x-small")
    return figure
