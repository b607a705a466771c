"""Flow through a fixed bed of grains: reference_data/theory/packed_beds.py, for the law that the case names."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import LAWS  # noqa: E402
from theory import grid_weights, packed_beds  # noqa: E402

PER_CELL = {"cubic": 1, "fcc": 4}
UNITS = {"superficial": "m/s", "start_up": "m/s", "random": "m/s", "cell_porosity": "1"}


class Bed:
    """The scene's numbers; flow along x."""

    def __init__(self, scene):
        fluid, arrange = scene["fluid"], scene["grains"]["arrange"]
        self.rho, self.mu, self.d = fluid["density"], fluid["viscosity"], scene["grains"]["diameter"]
        self.law = LAWS[scene["coupling"]["drag"].removesuffix("_missing_eps")]  # as it is meant, also in a twin
        self.gradient = -scene["coupling"]["mean_pressure_gradient"][0]
        side = scene["domain"]["size"][0]
        self.random = arrange["law"] == "random"
        grains = arrange["count"] if self.random else PER_CELL[arrange["kind"]] * round(side / arrange["spacing"]) ** 3
        self.eps = 1.0 - grains * math.pi / 6.0 * self.d**3 / side**3

    def superficial(self, eps):
        """u_s of the law at porosity eps, m/s."""
        return packed_beds.superficial_velocity(self.law, eps, self.gradient, self.d, self.rho, self.mu)


def averaged(bed, eps):
    """u_s through a bed of porosities eps [n], m/s: to second order in the fluctuations of its mobility k an isotropic medium has
    <k> - var k/(3 <k>), e.g. Landau & Lifshitz, Electrodynamics of continuous media, sec. 9."""
    mobility = np.array([bed.superficial(e) for e in np.quantile(eps, (np.arange(400) + 0.5) / 400)])
    return float(mobility.mean() - mobility.var() / (3.0 * mobility.mean()))


def porosities(run, k):
    """eps [n] of the particles or cells in snapshot k; a cell's density is that of what it holds of fluid."""
    fluid = run.snapshot(k)["fluid"]
    return fluid["eps"] if "eps" in fluid else fluid["rho"] / run.scene["fluid"]["density"]


def superficial_of_snapshot(run):
    """Mean of eps u over the particles or cells, whose volumes are alike, m/s."""
    return float((porosities(run, -1) * run.snapshot(-1)["fluid"]["v"][:, 0]).mean())


def porosity_error(run):
    """Greatest difference of a cell's eps from a plain sum over all grains."""
    snapshot, bed, side = run.snapshot(-1), Bed(run.scene), run.scene["domain"]["size"][0]
    width = run.scene["coupling"]["kernel_width"]["times_diameter"] * bed.d
    weights = grid_weights.gaussian_weights(snapshot["fluid"]["x"], snapshot["grains"]["x"], width, side)
    eps = grid_weights.cell_porosity(weights, math.pi / 6.0 * bed.d**3, run.scene["fluid"]["spacing"] ** 3)
    return float(np.abs(porosities(run, -1) - eps).max())


def reference(quantity, scene, t):
    bed = Bed(scene)
    if quantity == "superficial":
        return bed.superficial(bed.eps)
    if quantity == "start_up":
        u = packed_beds.start_up_of_law(np.asarray(t, float), bed.gradient / bed.rho, bed.law, bed.eps, bed.d, bed.rho, bed.mu)
        return bed.eps * u
    if quantity == "random":
        return 1.0
    raise KeyError(quantity)


def measure(quantity, run):
    bed = Bed(run.scene)
    if quantity in ("superficial", "start_up"):
        t, u = run.series("fluid")
        return t, bed.eps * np.ravel(u)
    if quantity == "random":
        return superficial_of_snapshot(run) / averaged(bed, porosities(run, 0))
    if quantity == "cell_porosity":
        return porosity_error(run)
    return NotImplemented


# --- the page ---


def table(runs):
    rows = []
    for run in runs:
        if run.failure:
            continue
        bed = Bed(run.scene)
        u = bed.eps * float(np.ravel(run.series("fluid")[1])[-1]) if not bed.random else superficial_of_snapshot(run)
        darcy = bed.mu * u / bed.gradient / bed.d**2
        rows.append([run.variant, run.scene["coupling"]["drag"], f"{bed.eps:.3f}", f"{bed.rho * u * bed.d / bed.mu:.3g}", f"{u:.5g}",
                     f"{u / bed.superficial(bed.eps):.4f}", f"{darcy:.4g}", f"{packed_beds.kozeny_carman(bed.eps, bed.d) / bed.d**2:.4g}",
                     f"{bed.gradient / float(packed_beds.ergun_gradient(bed.eps, u, bed.d, bed.rho, bed.mu)):.3f}"])
    return {"columns": ["run", "law", "eps", "Re", "u_s (m/s)", "over the law's", "mu u_s/(d^2 gradient)", "Kozeny-Carman", "gradient over Ergun's"],
            "rows": rows, "caption": "Steady flow; Kozeny-Carman (180) holds for Re << 1."}


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 3.8), layout="constrained")
    starts, steady = figure.subplots(1, 2)
    lattices = [run for run in runs if not run.failure and not Bed(run.scene).random and run.variant not in ("step", "step_grid")]
    for index, run in enumerate(lattices):
        bed, (t, u) = Bed(run.scene), run.series("fluid")
        law = reference("start_up", run.scene, t)
        scale = law[-1]
        starts.plot(t / t[-1], law / scale, "-", color=f"C{index}", lw=1.0)
        starts.plot(t / t[-1], bed.eps * np.ravel(u) / scale, "o", color=f"C{index}", ms=4, mfc="none", label=run.variant)
    starts.set(xlabel="time over the run's (-)", ylabel="u_s over the last of the law (-)")
    starts.legend(fontsize=7)
    eps = np.linspace(0.36, 0.9, 60)
    steady.plot(eps, packed_beds.kozeny_carman(eps, 1.0), "k--", lw=1.0, label="Kozeny-Carman")
    for index, name in enumerate(("ergun", "di_felice", "beetstra")):
        steady.plot(eps, [packed_beds.darcy_permeability(LAWS[name], e, 1.0) for e in eps], color=f"C{index}", lw=1.0, label=f"{name}, Re = 0")
        own = [Bed(run.scene) for run in lattices if run.scene["coupling"]["drag"] == name]
        runs_of = [run for run in lattices if run.scene["coupling"]["drag"] == name]
        steady.plot([b.eps for b in own], [b.mu * b.eps * float(np.ravel(run.series("fluid")[1])[-1]) / b.gradient / b.d**2
                                           for b, run in zip(own, runs_of)], "o", color=f"C{index}", ms=5, mfc="none")
    steady.set(xlabel="eps (-)", ylabel="mu u_s/(d^2 gradient) (-)", yscale="log")
    steady.legend(fontsize=7)
    return [("bed", figure, "Left: start from rest, lines the law's ordinary differential equation, circles runs. Right: permeability over d^2 "
             "at Re = 0 (lines); runs, where Re is not small, lie below.")]
