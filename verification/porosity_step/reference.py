"""A step of porosity: where the fluid's lattice beside held grains stops being at rest, and flow through the step (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))
sys.path.insert(0, str(HERE))

from step_waves import Step  # noqa: E402

UNITS = {"risen": "1", "boundary_ratio": "1", "rest.stable": "m", "rest.unstable": "m", "rest.boundary": "m", "energy_at_end": "1", "energy_greatest": "1",
         "flux_missed": "1", "compressed": "1"}
RISEN = 10.0  # of the energy over its least value before: unstable


def fraction(scene, diameter=None):
    """1 - eps of the bed: four grains to a cell of its face-centred lattice."""
    grain = scene["grains"]
    return 4.0 * math.pi / 6.0 * ((diameter or grain["diameter"]) / grain["arrange"]["spacing"]) ** 3


def diameter_of(scene, phi):
    return scene["grains"]["arrange"]["spacing"] * (6.0 * phi / (4.0 * math.pi)) ** (1.0 / 3.0)


def sound_number(scene):
    """h c/nu."""
    fluid = scene["fluid"]
    return fluid["smoothing"] * fluid["spacing"] * fluid["sound_speed"] * fluid["density"] / fluid["viscosity"]


def step_of(scene, phi, **changes):
    fluid, arrange = scene["fluid"], scene["grains"]["arrange"]
    half = 0.5 * arrange["spacing"]  # between the planes of the face-centred lattice
    count = round((arrange["upper"][0] - arrange["lower"][0]) / half)
    planes = arrange["lower"][0] + (np.arange(count) + 0.5) * half
    h = fluid["smoothing"] * fluid["spacing"]
    wide = scene["coupling"].get("porosity_width", scene["coupling"]["kernel_width"])["times_smoothing"]
    numbers = {"c": fluid["sound_speed"], "mu": fluid["viscosity"], "rho": fluid["density"]} | changes
    return Step(round(scene["domain"]["size"][0] / fluid["spacing"]), fluid["spacing"], h, fluid["kernel"], wide * h, planes, phi * half,
                handed_on=bool(scene["coupling"]["forces"]), **numbers)


def start_of(run):
    """[planes, ny, nz, 3] velocities of the first snapshot at the sites, whose ids run along x first."""
    fluid, dx = run.snapshot(0)["fluid"], run.scene["fluid"]["spacing"]
    cells = [round(side / dx) for side in run.scene["domain"]["size"]]
    site = np.mod(np.floor(fluid["x"] / dx).astype(int), cells)
    v = np.zeros((*cells, 3))
    v[site[:, 0], site[:, 1], site[:, 2]] = fluid["v"]
    return v


def risen(energy):
    return energy / np.minimum.accumulate(energy)


_STARTS = {}  # velocities at the start, the same for every diameter


@lru_cache(maxsize=None)
def predicted(key, steps=12):
    """1 - eps of the bed at which the energy of the run's own start rises RISEN times by the end: equation (4)."""
    scene, start = _STARTS[key]
    t = np.linspace(0.0, scene["time"]["end"], 51)
    low, high = 0.005, 0.72
    for _ in range(steps):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if risen(step_of(scene, middle).energy(t, start)).max() > RISEN else (middle, high)
    return math.sqrt(low * high)


def predicted_of(run):
    key = (run.variant, sound_number(run.scene), run.scene["grains"]["arrange"]["spacing"], str(run.scene["coupling"]))
    _STARTS.setdefault(key, (run.scene, start_of(run)))
    return predicted(key)


def edges(run):
    """1 - eps at the highest stable and the lowest unstable diameter; None where there is none."""
    return [None if d is None else fraction(run.scene, d) for d in (getattr(run, "stable", None), getattr(run, "unstable", None))]


def flux_missed(run):
    """Greatest distance of eps u from its mean along the column, over that mean: planes of two spacings, second half of the run."""
    length, dx = run.scene["domain"]["size"][0], run.scene["fluid"]["spacing"]
    bins = round(length / (2.0 * dx))
    files = len(run.snapshot_files())
    total = np.zeros(bins)
    for k in range(files // 2, files):
        fluid = run.snapshot(k)["fluid"]
        place = (np.mod(fluid["x"][:, 0], length) / length * bins).astype(int)
        # eps u of a plane: what flows through it, so particles count with their room
        room = 1.0 / fluid["rho"]
        flux = np.bincount(place, fluid["eps"] * fluid["v"][:, 0] * room, bins) / np.bincount(place, room, bins)
        total += flux / flux.mean()
    mean = total / (files - files // 2)
    return float(np.max(np.abs(mean - 1.0)))


def measure(quantity, run):
    if quantity == "risen":
        t, energy = (np.ravel(part) for part in run.series("energy"))
        return t, risen(energy)
    if quantity == "boundary_ratio":
        stable, unstable = edges(run)
        return math.sqrt(stable * unstable) / predicted_of(run)
    if quantity == "energy_at_end":
        energy = np.ravel(run.series("energy")[1])
        return float(energy[-1] / energy[0])
    if quantity == "energy_greatest":
        energy = np.ravel(run.series("energy")[1])
        return float(np.max(energy) / energy[0])
    if quantity == "compressed":
        fluid = run.scene["fluid"]
        return float(np.max(np.abs(run.snapshot(-1)["fluid"]["p"]))) / (fluid["density"] * fluid["sound_speed"] ** 2)
    if quantity == "flux_missed":
        return flux_missed(run)
    return NotImplemented


def reference(quantity, scene, t):
    return 0.0


# --- the page ---


def rate_curve(scene, mu, phis):
    """Fastest growth over c/h of the waves of the box, across: the corner of the zone and along x alone."""
    h, c = scene["fluid"]["smoothing"] * scene["fluid"]["spacing"], scene["fluid"]["sound_speed"]
    n = round(scene["domain"]["size"][1] / scene["fluid"]["spacing"])
    corner = 2.0 * math.pi * (n // 2) / scene["domain"]["size"][1]
    return [max(step_of(scene, phi, mu=mu).growth_rate(k) for k in ((0.0, 0.0), (corner, corner))) * h / c for phi in phis]


def onset(scene, mu):
    """1 - eps from which some wave grows at all."""
    low, high = 0.005, 0.72
    if rate_curve(scene, mu, [high])[0] < 1e-6:
        return math.nan
    for _ in range(9):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if rate_curve(scene, mu, [middle])[0] > 1e-6 else (middle, high)
    return math.sqrt(low * high)


def bisected(runs):
    return [run for run in runs if getattr(run, "stable", None) is not None and getattr(run, "unstable", None) is not None]


def table(runs):
    rows = []
    for run in bisected(runs):
        stable, unstable = edges(run)
        h = run.scene["fluid"]["smoothing"] * run.scene["fluid"]["spacing"]
        rows.append([run.variant, f"{sound_number(run.scene):.0f}", f"{h / run.stable:.2f}", f"{stable:.3f}", f"{unstable:.3f}", f"{predicted_of(run):.3f}",
                     f"{onset(run.scene, run.scene['fluid']['viscosity']):.3f}"])
    return {"columns": ["run", "h c/nu", "h/d", "1 - eps stable", "unstable", "predicted for this run", "onset of any growth"], "rows": rows,
            "caption": "Height of the step of porosity at which a column at rest stops being at rest."}


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    found = bisected(runs)
    if found:
        scene = found[0].scene
        numbers = np.geomspace(15.0, 3000.0, 14)
        reach = scene["fluid"]["smoothing"] * scene["fluid"]["spacing"] * scene["fluid"]["sound_speed"] * scene["fluid"]["density"]
        left.plot(numbers, [onset(scene, reach / number) for number in numbers], "k-", lw=1, label="some wave grows above (theory)")
    for n, run in enumerate(found):
        stable, unstable = edges(run)
        h = run.scene["fluid"]["smoothing"] * run.scene["fluid"]["spacing"]
        expected = predicted_of(run)
        for axes, x in ((left, sound_number(run.scene)), (right, h / run.stable)):
            first = axes is left and n == 0
            axes.plot(x, stable, "C0o", ms=5, mfc="none", label="highest stable" if first else None)
            axes.plot(x, unstable, "C3x", ms=5, label="lowest unstable" if first else None)
            axes.plot([x / 1.15, x * 1.15], [expected, expected], "k--", lw=1, label="predicted for the run's length" if first else None)
        right.annotate(f"{sound_number(run.scene):.0f}", (h / run.stable, unstable), textcoords="offset points", xytext=(6, 3), fontsize="x-small")
    left.axvspan(20.0, 48.0, color="0.92", lw=0)
    left.set(xscale="log", yscale="log", xlabel="h c/nu (grey: `auto` to `plumb_grains`)", ylabel="step of porosity, 1 - eps", ylim=(0.03, 0.75))
    right.set(xscale="log", yscale="log", xlabel="h/d at the boundary (numbers: h c/nu)", ylabel="step of porosity, 1 - eps", ylim=(0.03, 0.75))
    left.legend(fontsize="x-small")
    return [("map", figure, "Step of porosity at which a column at rest becomes unstable: bisected runs over linear theory."), ("energy", _energies(found), "Energy of the runs at the highest stable step over linear theory from the same start (lines).")]


def _energies(found):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.5, 3.8), layout="constrained")
    axes = figure.subplots()
    for n, run in enumerate(found):
        t, energy = (np.ravel(part) for part in run.series("energy"))
        theory = step_of(run.scene, fraction(run.scene)).energy(t, start_of(run))
        axes.semilogy(t, energy, ".", ms=3, color=f"C{n}", label=run.variant)
        axes.semilogy(t, theory, "-", lw=0.8, color=f"C{n}")
    axes.set(xlabel="t (s)", ylabel="mean v²/2 (m²/s²)")
    axes.legend(fontsize="x-small")
    return figure
