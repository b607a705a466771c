"""Growth of a displaced lattice of grains above clear fluid: linear theory of the coupled scheme from the start on (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import layered_rayleigh_taylor as layered  # noqa: E402
from theory import falling_layers, rayleigh_taylor, released_layers, sedimentation_scene, settling  # noqa: E402

UNITS = {"history": "1", "growth": "1", "lowest": "1", "over_published": "1", "fall": "1", "over_relation": "1"}
DEVELOPED = 0.75  # of the largest rate: the window begins where the linear solution has reached it
STEEP = 0.1  # wave number times amplitude of the linear solution: the window ends there
AMPLITUDE = {"grains.csv": 1.0, "grains_tenth.csv": 0.1}  # of the published displacement, d/8 a wave
GRID = 2e-3  # s, on which the linear solution is tabulated: n^2 GRID^2/8 = 1e-3 at most, in a logarithm that bends by that
GRID_AIR = 1e-3


def closure(run):
    """Of the suspension's viscosity, as it is meant."""
    return "krieger_dougherty" if "suspension" in run.variant else "pure_fluid"


def in_air(run):
    """Whether the grains fall through a gas that they do not follow."""
    return run.variant.startswith("air")


def setting(run):
    """Of the run as it is meant: coupling, drag and the grains are the case's, which a twin may break."""
    fluid = run.scene["fluid"]
    h = 1.5 * fluid["spacing"]
    return released_layers.Setting(fluid["density"], fluid["viscosity"], h, sedimentation_scene.coupling_width(h, rayleigh_taylor.EPS),
                                   fluid["smoothing"] * fluid["spacing"], kernel=fluid["kernel"], viscosity=closure(run))


def start_amplitude(scene):
    """Of each wave, m."""
    return settling.GRAIN["d"] / 8.0 * AMPLITUDE[Path(scene["grains"]["arrange"]["path"]).name]


class Linear(NamedTuple):
    """The solution for a displacement of 1 at the start: t, amplitude of both waves at the lowest layer [2, nt], its fall [m]."""

    t: np.ndarray
    rise: np.ndarray
    fall: np.ndarray


def linear(run):
    return solved(setting(run), run.scene["time"]["end"], in_air(run))


@lru_cache(maxsize=None)
def solved(s, end, air):
    times = tuple(np.linspace(0.0, end, math.ceil(end / (GRID_AIR if air else GRID) - 1e-6) + 1))
    found = [falling_layers.history(s, k, times) if air else released_layers.history(s, k, times, GRID)
             for k in sedimentation_scene.wave_numbers()]
    return Linear(found[0].t, np.array([one.rise[:, 0] for one in found]), found[0].z[0, 0] - found[0].z[:, 0])


@lru_cache(maxsize=None)
def rates(s):
    """Largest rate of both waves on the layer at rest, 1/s."""
    return tuple(released_layers.growth_rate(s, k) for k in sedimentation_scene.wave_numbers())


class Measured(NamedTuple):
    """Of the lowest layer: t, amplitudes of both waves [2, nt], fall of its mean and of its lowest grain [m]."""

    t: np.ndarray
    amplitude: np.ndarray
    fall: np.ndarray
    lowest: np.ndarray


_measured = {}


def measured(run):
    """Projections on cos kx + cos ky and on cos kx cos ky over the 29 x 29 grains of the lowest layer, at their first x and y."""
    if id(run) not in _measured:
        count = sedimentation_scene.lattice(rayleigh_taylor.EPS).columns ** 2
        shots = [run.snapshot(k) for k in range(len(run.snapshot_files()))]
        places = np.array([shot["grains"]["x"][np.argsort(shot["grains"]["id"])][:count] for shot in shots])
        k, (x, y), z = sedimentation_scene.wave_numbers()[0], places[0, :, :2].T, places[:, :, 2]
        both = np.array([z @ (np.cos(k * x) + np.cos(k * y)), -4.0 * z @ (np.cos(k * x) * np.cos(k * y))]) / count
        _measured[id(run)] = Measured(np.array([shot["time"] for shot in shots]), both, z[0].mean() - z.mean(axis=1),
                                      z[0].min() - z.min(axis=1)), run
    return _measured[id(run)][0]


def arrival(run):
    """When the lowest layer is 2 h_c above the floor, which its kernel then reaches, s; at most the end of the run."""
    found, s = linear(run), setting(run)
    return float(np.interp(s.lattice.heights[0] - 2.0 * s.h_c, found.fall, found.t))


def relation_in_air(run):
    """Rates of the dusty relation, 1/s: grains of finite inertia on a layer at rest."""
    s = setting(run)
    slip = rayleigh_taylor.settling_slip(s.fluid, rayleigh_taylor.EPS)
    tau = rayleigh_taylor.hindered_relaxation_time(s.fluid, rayleigh_taylor.EPS, slip)
    return [rayleigh_taylor.dusty_growth_rate(k, s.fluid, 1.0 - rayleigh_taylor.EPS, s.mu, tau, s.rho / settling.GRAIN["rho_p"])
            for k in sedimentation_scene.wave_numbers()]


def interpolated(t, times, values):
    """Between the places of the table: the logarithm is smooth."""
    return np.exp(np.interp(t, times, np.log(values)))


def window(run, mode):
    """(start, end) in s, from theory alone, at most to the end of the run; NaN if it does not get so far."""
    if in_air(run):
        return math.nan, arrival(run)
    found, k = linear(run), sedimentation_scene.wave_numbers()[mode]
    rise = found.rise[mode]
    developed = np.gradient(np.log(rise), found.t) >= DEVELOPED * rates(setting(run))[mode]
    start = float(found.t[np.argmax(developed)]) if developed.any() else math.nan
    return start, float(np.interp(STEEP, k * start_amplitude(run.scene) * rise, found.t))


def fitted(t, amplitude, start, end):
    """Slope of ln(amplitude) over the window, 1/s; NaN with less than four points in it."""
    inside = (t >= start - 1e-9) & (t <= end + 1e-9)
    if inside.sum() < 4:
        return math.nan
    return float(np.polyfit(t[inside], np.log(np.maximum(amplitude[inside], 1e-12)), 1)[0])


def growth(run):
    """(fitted rate of the run, of the linear solution in the same window) of both waves, 1/s."""
    m, found, pairs = measured(run), linear(run), []
    for mode in (0, 1):
        ends = window(run, mode)
        pairs.append((fitted(m.t, m.amplitude[mode], *ends), fitted(m.t, interpolated(m.t, found.t, found.rise[mode]), *ends)))
    return pairs


def settled_rates(run):
    """Rates that the run would have without start and settling: the relation's, times measured over linear; 1/s."""
    return [n * one / other for n, (one, other) in zip(rates(setting(run)), growth(run))]


def published(scene):
    """Chandrasekhar's rates of the slides: sharp edge, suspension viscosity, 1/s."""
    fluid = {"rho": scene["fluid"]["density"], "mu": scene["fluid"]["viscosity"]}
    rho_2 = rayleigh_taylor.EPS * fluid["rho"] + (1.0 - rayleigh_taylor.EPS) * settling.GRAIN["rho_p"]
    mu_2 = rayleigh_taylor.suspension_viscosity(fluid["mu"], rayleigh_taylor.EPS)
    return [rayleigh_taylor.growth_rate(k, (fluid["rho"], fluid["mu"]), (rho_2, mu_2)) for k in sedimentation_scene.wave_numbers()]


def lowest(run, t):
    """Fall of the lowest grain by linear theory, m."""
    a0, found = start_amplitude(run.scene), linear(run)
    rise = [interpolated(t, found.t, one) for one in found.rise]
    return np.interp(t, found.t, found.fall) + a0 * (2.0 * (rise[0] - 1.0) + rise[1] - 1.0)


def measure(quantity, run):
    if quantity not in UNITS:
        return NotImplemented
    if quantity == "growth":
        return max(abs(one / other - 1.0) for one, other in growth(run))
    if quantity == "over_published":
        return max(one / other for one, other in zip(settled_rates(run), published(run.scene)))
    a0, m, found = start_amplitude(run.scene), measured(run), linear(run)
    last = int(np.searchsorted(m.t, window(run, 0)[1] + 1e-9, side="right")) - 1
    if quantity == "over_relation":
        return max(float(m.amplitude[mode][last]) / (a0 * math.exp(n * m.t[last])) for mode, n in enumerate(relation_in_air(run)))
    if quantity == "fall":
        return float(np.max(np.abs(m.fall[1 : last + 1] / np.interp(m.t[1 : last + 1], found.t, found.fall) - 1.0)))
    if quantity == "lowest":
        return float(abs(m.lowest[last] / lowest(run, m.t[last]) - 1.0))
    worst = 0.0
    for mode in (0, 1):
        before = m.t <= window(run, mode)[1] + 1e-9
        linear_rise = a0 * interpolated(m.t[before], found.t, found.rise[mode])
        worst = max(worst, float(np.max(np.abs(np.log(np.maximum(m.amplitude[mode][before], 1e-12) / linear_rise)))))
    return worst


def reference(quantity, scene, t):
    if quantity in UNITS:
        return 0.0
    raise KeyError(quantity)


# --- the page ---


def name(run):
    return f"{run.variant}, {round(4e-3 / run.scene['fluid']['spacing'])} across"


def table(runs):
    rows = []
    for run in (run for run in runs if not in_air(run)):
        s = setting(run)
        fluid = {"rho": s.rho, "mu": s.mu}
        for mode, (k, n, (one, other), slides) in enumerate(
                zip(sedimentation_scene.wave_numbers(), rates(s), growth(run), published(run.scene))):
            sharp = layered.growth_rate(k, fluid, layered.scene_layer(), layered.SHARP, layered.Closure(s.viscosity), depth=layered.Depth(s.height, s.floor, s.floor))
            start, end = window(run, mode)
            rows.append([name(run), f"{k:.0f}", f"{1e3 * start:.0f} to {1e3 * end:.0f}", f"{one:.2f}", f"{other:.2f}", f"{one / other - 1.0:+.3f}",
                         f"{n:.2f}", f"{n * one / other:.2f}", f"{sharp:.2f}", f"{slides:.2f}"])
    return {"columns": ["run", "k (1/m)", "window (ms)", "rate of the run", "linear", "error", "relation", "relation x run/linear",
                        "sharp layer", "slides' reference"], "rows": rows,
            "caption": "Rates in 1/s. Relation: largest rate of the layer at rest, seen through the kernels; sharp layer: without them; both with mu_2 = mu, or with the run's suspension viscosity."}


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    liquid = [run for run in runs if not in_air(run)]
    for number, run in enumerate(liquid):
        draw(run, left, right, f"C{number % 10}", "osv^D"[number // 10 % 5])
    for run in {run.variant: run for run in liquid if "tenth" not in run.variant}.values():
        fluid, t = {"rho": run.scene["fluid"]["density"], "mu": run.scene["fluid"]["viscosity"]}, measured(run).t
        path = rayleigh_taylor.lowest_grain(t, published(run.scene), rayleigh_taylor.settling_slip(fluid, rayleigh_taylor.EPS))
        right.plot(1e3 * t, 1e6 * path, ":", color="k", lw=1.2)
    label(left, right)
    left.set_ylim(bottom=0.1 * left.get_ylim()[0])
    left.legend(fontsize=6, ncol=3, loc="lower center")
    found = [("growth", figure, "Lines: linear theory; marks: runs, wave k; crosses: wave √2 k. Right: lines linear theory, dotted the slides' "
              "relation growing from t = 0.")]
    air = [run for run in runs if in_air(run)]
    return found + [("air", air_figure(air), "Lines: linear theory about the falling layers; dotted: the dusty relation from t = 0, the "
                     "layer at rest; circles and crosses: the run, waves k and √2 k. The thin line ends the window.")] if air else found


def label(left, right):
    left.set(xlabel="t (ms)", ylabel="amplitude at the lowest layer (μm)", yscale="log")
    right.set(xlabel="t (ms)", ylabel="fall of the lowest grain (μm)")


def draw(run, left, right, colour, mark):
    """Amplitudes and the lowest grain's path of a run and of its linear solution."""
    a0, m, found = start_amplitude(run.scene), measured(run), linear(run)
    for mode, one in ((0, mark), (1, "x")):
        inside = found.t <= m.t[-1] + 1e-9
        left.plot(1e3 * found.t[inside], a0 * found.rise[mode][inside] * 1e6, "-", color=colour, lw=0.8)
        left.plot(1e3 * m.t, 1e6 * m.amplitude[mode], one, color=colour, ms=3.0, mfc="none", label=name(run) if mode == 0 else None)
    right.plot(1e3 * m.t, 1e6 * lowest(run, m.t), "-", color=colour, lw=0.8)
    right.plot(1e3 * m.t, 1e6 * m.lowest, mark, color=colour, ms=3.0, mfc="none")


def air_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    for number, run in enumerate(runs):
        draw(run, left, right, f"C{number}", "o")
        t, a0 = measured(run).t, start_amplitude(run.scene)
        for n in relation_in_air(run):
            left.plot(1e3 * t, 1e6 * a0 * np.exp(n * t), ":", color="k", lw=1.0)
        for axes in (left, right):
            axes.axvline(1e3 * arrival(run), color="0.6", lw=0.6)
    label(left, right)
    left.legend(fontsize=7)
    return figure
