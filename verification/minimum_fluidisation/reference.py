"""Water up through a settled bed of free grains, ever faster: minimum fluidisation (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import LAWS  # noqa: E402
from theory.bed_on_floor import LayeredBed, part_below  # noqa: E402

G = 9.81
UNITS = {"onset": "1", "carried": "1", "packed_drop": "1", "porosity": "1", "flux_missed": "1"}
CARRIED = (1.4, 2.0)  # window of superficial velocities in which the bed is carried, over that of minimum fluidisation
PACKED = (0.3, 0.8)  # in which it lies, likewise


def area(scene):
    return scene["domain"]["size"][0] * scene["domain"]["size"][1]


def inflow(scene, t):
    """Superficial velocity at time t, m/s."""
    inlet = scene["inlet"][0]
    opens = inlet["opens"]
    return inlet["profile"]["speed"] * np.clip((t - opens["from"]) / opens["over"], 0.0, 1.0)


def weight(scene):
    """Of the bed in the fluid, over the area, Pa."""
    grains, fluid = scene["grains"], scene["fluid"]
    volume = grains["arrange"]["count"] * math.pi / 6.0 * grains["diameter"] ** 3
    return (grains["density"] - fluid["density"]) * G * volume / area(scene)


def gradient(scene, eps, u):
    """-dp/dz of a uniform bed, Pa/m: drag of its grains over the fluid's share of the volume."""
    grains, fluid = scene["grains"], scene["fluid"]
    d, mu = grains["diameter"], fluid["viscosity"]
    law = LAWS["ergun"]
    drag = 3.0 * math.pi * mu * d * u * law(eps, fluid["density"] * d * u / mu)
    return drag * (1.0 - eps) / (math.pi / 6.0 * d**3) / eps


def bisected(excess):
    """Where a rising function of the velocity is zero, m/s."""
    return brentq(excess, 1e-5, 0.1, xtol=1e-9)


def onset_by_law(scene, eps):
    """Superficial velocity at which a uniform bed of porosity eps is carried, m/s: gradient = weight of its volume."""
    grains, fluid = scene["grains"], scene["fluid"]
    wanted = (grains["density"] - fluid["density"]) * G * (1.0 - eps)
    return bisected(lambda u: gradient(scene, eps, u) - wanted)


def drops(run):
    """Times and the mean pressure of the lowest slice of the bed less that above the bed, Pa."""
    t, low = run.series("p_low")
    _, top = run.series("p_top")
    return t, np.ravel(low) - np.ravel(top)


def slice_height(scene):
    return next(p for p in scene["probe"] if p["name"] == "p_low")["upper"][2]


def settled(run):
    """Heights of the grains when the inlet opens, m, ascending."""
    k = round(run.scene["inlet"][0]["opens"]["from"] / run.scene["time"]["output_interval"])
    return np.sort(run.snapshot(k)["grains"]["x"][:, 2])


def settled_porosity(run):
    """Of the settled bed's inside, two diameters off its floor and top: grains cut by planes count by their volume."""
    d, z = run.scene["grains"]["diameter"], settled(run)
    low, high = 2.0 * d, z[-len(z) // 20] - 1.5 * d
    volume = np.sum(part_below(z, d, high) - part_below(z, d, low)) * math.pi / 6.0 * d**3
    return 1.0 - volume / (area(run.scene) * (high - low))


def smoothed_bed(run):
    """The settled grains, each a layer of its own, as the kernel smooths them along z."""
    scene = run.scene
    fluid = scene["fluid"]
    h = scene["coupling"]["kernel_width"]["times_smoothing"] * fluid["smoothing"] * fluid["spacing"]
    return LayeredBed(settled(run), 1.0 / area(scene), scene["grains"]["diameter"], h)


def slice_pressure(run, bed, forces):
    """Mean pressure of the lowest slice over that above the bed, Pa, when every grain gets its force (N) from the fluid."""
    gradient_at = bed.per_area * np.asarray(forces) @ bed.weights
    above = np.cumsum(gradient_at[::-1])[::-1] * bed.dz - 0.5 * gradient_at * bed.dz
    return float(np.mean(above[bed.at < slice_height(run.scene)]))


def drop_by_theory(run, bed, u):
    """`drops` of the bed as it lies."""
    fluid = run.scene["fluid"]
    return slice_pressure(run, bed, bed.forces(LAWS["ergun"], u, fluid["density"], fluid["viscosity"]))


def drop_by_weight(run, bed):
    """`drops` of the bed when it is carried."""
    return slice_pressure(run, bed, np.full(len(bed.z), weight(run.scene) / bed.per_area / len(bed.z)))


def packed_ratio(run):
    """Drop over that of the smoothed bed by theory, while it lies."""
    scene, bed = run.scene, smoothed_bed(run)
    t, drop = drops(run)
    u, u_mf = inflow(scene, t), onset_by_law(scene, settled_porosity(run))
    lying = (u >= PACKED[0] * u_mf) & (u <= PACKED[1] * u_mf)
    some = np.linspace(PACKED[0], PACKED[1], 6) * u_mf
    law = np.interp(u[lying], some, [drop_by_theory(run, bed, one) for one in some])
    return float(np.sum(drop[lying] * law) / np.sum(law * law))


def carried(run):
    """Mean drop over the weight while the bed is carried, and its standard error from ten blocks."""
    scene = run.scene
    t, drop = drops(run)
    over = inflow(scene, t) / onset_by_law(scene, settled_porosity(run))
    ratios = drop[(over >= CARRIED[0]) & (over <= CARRIED[1])] / drop_by_weight(run, smoothed_bed(run))
    blocks = [np.mean(block) for block in np.array_split(ratios, 10)]
    return float(np.mean(ratios)), float(np.std(blocks, ddof=1) / math.sqrt(len(blocks)))


def onset(run):
    """Superficial velocity at which the drop of the lying bed, continued by the law, meets that of the carried bed, over theory's."""
    bed, factor, found = smoothed_bed(run), packed_ratio(run), carried(run)[0]
    wanted = drop_by_weight(run, bed)
    by_theory = bisected(lambda u: drop_by_theory(run, bed, u) - wanted)
    return bisected(lambda u: factor * drop_by_theory(run, bed, u) - found * wanted) / by_theory


def flux_missed(run):
    """Of eps u in slices of four spacings over the last second, from the inflow: the greatest, relative."""
    height, dx = run.scene["domain"]["size"][2], run.scene["fluid"]["spacing"]
    edges = np.arange(0.0, height + 0.5 * dx, 4.0 * dx)
    sums = np.zeros((3, len(edges) - 1))
    interval, count = run.scene["time"]["output_interval"], len(run.snapshot_files())
    for k in range(count - round(1.0 / interval), count):
        fluid = run.snapshot(k)["fluid"]
        room, u = fluid["mass"] / fluid["rho"], inflow(run.scene, k * interval)
        for i, values in enumerate((room * u, room * fluid["eps"] * fluid["v"][:, 2])):
            sums[i] += np.histogram(fluid["x"][:, 2], edges, weights=values)[0]
    return float(np.max(np.abs(sums[1] / sums[0] - 1.0)))


def measure(quantity, run):
    if quantity == "carried":
        return carried(run)[0]
    if quantity == "packed_drop":
        return packed_ratio(run)
    found = {"onset": onset, "porosity": settled_porosity, "flux_missed": flux_missed}.get(quantity)
    return found(run) if found else NotImplemented


def reference(quantity, scene, t):
    return 0.0 if quantity in ("porosity", "flux_missed") else 1.0


def figures(runs):
    """Pressure drop over superficial velocity, and where the grains are."""
    from matplotlib.figure import Figure

    runs = [run for run in runs if run.failure is None]
    if not runs:
        return []
    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    for run in runs:
        scene, eps = run.scene, settled_porosity(run)
        t, drop = drops(run)
        bed = smoothed_bed(run)
        carries = drop_by_weight(run, bed)
        u, mean = inflow(scene, t), np.convolve(drop, np.ones(10) / 10.0, mode="same")
        (line,) = left.plot(1e3 * u, mean / carries, lw=0.8, label=f"{run.variant}: eps {eps:.3f}")
        some = np.linspace(1e-6, u[-1], 30)
        law = np.array([drop_by_theory(run, bed, one) for one in some]) / carries
        left.plot(1e3 * some, np.minimum(law, 1.0), color=line.get_color(), lw=0.8, ls="--")
        t, z = run.series("grains_z")
        right.plot(1e3 * inflow(scene, t), 1e3 * np.ravel(z), lw=0.8, color=line.get_color())
    left.set(xlabel="superficial velocity (mm/s)", ylabel="pressure under the bed over that of its weight", ylim=(0.0, 1.4))
    right.set(xlabel="superficial velocity (mm/s)", ylabel="mean height of the grains (mm)")
    left.legend(fontsize=7)
    return [("onset", figure, "Pressure drop over the weight (dashed: theory of the settled bed as the kernel smooths it), and the bed's height.")]
