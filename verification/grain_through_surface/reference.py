"""A grain at a free surface of smoothed particles: where the fluid begins for it (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import di_felice  # noqa: E402
from theory.lone_grain import law_of  # noqa: E402
from theory.released_sphere import Sphere  # noqa: E402
from theory.sph_operators import KERNELS, support  # noqa: E402

UNITS = {"path_in": "m/s", "dry_fall": "1", "dry_ratio": "1", "deep_speed": "1", "return_speed": "1", "float_height": "1", "momentum_lost": "1",
         "momentum_given": "1"}
GRAVITY = 9.81
REACH_OF = 1.0  # kernel width over h of the scene as it is meant; a twin's is another


def sphere_of(scene):
    fluid, grain = scene["fluid"], scene["grains"]
    return Sphere(law_of(1.0), grain["density"], grain["diameter"], fluid["density"], fluid["viscosity"])


def particles(scene):
    """[n, 3] the lattice of the fluid at the start around the column of the grain, images along x and y included."""
    fluid, dx = scene["fluid"], scene["fluid"]["spacing"]
    lower, upper = np.array(fluid["fill"]["lower"]), np.array(fluid["fill"]["upper"])
    cells = np.round((upper - lower) / dx).astype(int)
    axes = [low + (np.arange(n if axis == 2 else 3 * n) + 0.5) * dx - (0.0 if axis == 2 else n * dx) for axis, (low, n) in enumerate(zip(lower, cells))]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def kernel_width(scene):
    return REACH_OF * scene["fluid"]["smoothing"] * scene["fluid"]["spacing"]


def edge(scene):
    """Height from which on no particle is in reach: equation (1)."""
    x, at = particles(scene), np.array(scene["grains"]["arrange"]["position"])
    reach = support(scene["coupling"]["kernel"]) * kernel_width(scene)
    across = np.hypot(x[:, 0] - at[0], x[:, 1] - at[1])
    near = across < reach
    return float(np.max(x[near, 2] + np.sqrt(reach**2 - across[near] ** 2)))


def own_porosity(scene, z):
    """eps that the grain gathers of its own volume among the particles at rest: 1 - V sum W^2/sum W."""
    x, at = particles(scene), np.array(scene["grains"]["arrange"]["position"])
    kernel, h = KERNELS[scene["coupling"]["kernel"]], kernel_width(scene)
    w = kernel.sigma[3] / h**3 * kernel.w(np.minimum(np.linalg.norm(x - [at[0], at[1], z], axis=1) / h, 2.0))
    volume = math.pi / 6.0 * scene["grains"]["diameter"] ** 3
    return 1.0 - volume * float(np.sum(w * w) / w.sum()) if w.sum() > 0.0 else 1.0


def path(scene, times):
    """(z, v) upwards of a grain whose fluid stays at rest: equation (2)."""
    grain, fluid = scene["grains"], scene["fluid"]
    body, top = sphere_of(scene), edge(scene)
    heights = np.linspace(0.5 * top, top, 400)
    porosities = np.array([own_porosity(scene, z) for z in heights])

    def rate(_, y):
        z, v = y
        if z >= top:
            return [v, -GRAVITY]
        eps = float(np.interp(z, heights, porosities))
        slip = eps * abs(v)
        re = fluid["density"] * slip * body.d / body.mu
        drag = 3.0 * math.pi * body.mu * body.d * eps * v * float(di_felice(eps, max(re, 1e-12)))
        return [v, -(body.weight() + drag) / (grain["density"] * body.volume())]

    start = [grain["arrange"]["position"][2], grain["velocity"][2]]
    found = solve_ivp(rate, (0.0, times[-1]), start, t_eval=times, rtol=1e-8, atol=1e-12, max_step=2e-5)
    return found.y


def reference(quantity, scene, t):
    if quantity == "path_in":
        return path(scene, np.asarray(t, float))[1]
    return 0.0


def flight(run):
    """t, z, v along z and whether no particle of the start is in reach."""
    (t, z), (_, v) = run.series("z"), run.series("v")
    return t, np.ravel(z), np.ravel(v), np.ravel(z) > edge(run.scene) + 0.1 * run.scene["fluid"]["spacing"]


def momenta(run):
    """[2, n] along x and z: (grain, fluid) over that of the grain at the start."""
    fluid, grain = run.scene["fluid"], run.scene["grains"]
    files, parts = len(run.snapshot_files()), []
    mass, particle = grain["density"] * math.pi / 6.0 * grain["diameter"] ** 3, fluid["density"] * fluid["spacing"] ** 3
    for k in range(files):
        state = run.snapshot(k)
        parts.append([mass * state["grains"]["v"][0], particle * state["fluid"]["v"].sum(axis=0)])
    return np.array(parts) / (mass * np.linalg.norm(grain["velocity"]))


def measure(quantity, run):
    scene = run.scene
    if quantity == "path_in":
        t, _, v, _ = flight(run)
        return t, v
    if quantity == "dry_fall":
        t, _, v, dry = flight(run)
        both = dry[1:] & dry[:-1]
        return float(np.max(np.abs(np.diff(v) + GRAVITY * np.diff(t))[both]) / np.max(np.abs(v)))
    if quantity == "dry_ratio":
        t, z, _, _ = flight(run)
        out = np.interp(np.linspace(0.0, t[-1], 20001), t, z) > edge(scene)
        counted = run.info["drag_range"]["dry"] * run.info["step"]
        return float(counted / (t[-1] * out.mean()))
    if quantity == "deep_speed":
        t, _, v, _ = flight(run)
        return float(-v[t > 0.75 * t[-1]].mean() / sphere_of(scene).terminal_speed())
    if quantity == "return_speed":
        t, z, v, _ = flight(run)
        out = np.flatnonzero(z > edge(scene))
        first, last = out[0], out[-1]
        rise = GRAVITY * (z[last] - z[first])  # the two are not at one height
        return float(math.sqrt(v[last] ** 2 + 2.0 * rise) / v[first])
    if quantity == "float_height":
        _, z, _, _ = flight(run)
        return float((z[-1] - edge(scene)) / scene["grains"]["diameter"])
    if quantity in ("momentum_lost", "momentum_given"):
        parts = momenta(run)
        if quantity == "momentum_lost":
            whole = parts.sum(axis=1)
            return float(np.max(np.abs(whole - whole[0])))
        return float(np.linalg.norm(parts[-1, 1]) / np.linalg.norm(parts[0, 0]))
    return NotImplemented


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    for n, run in enumerate(run for run in runs if not run.failure and run.variant != "shot"):
        t, z, v, _ = flight(run)
        left.plot(1e3 * t, 1e3 * z, "-", lw=1, color=f"C{n}", label=run.variant)
        right.plot(1e3 * v, 1e3 * z, "-", lw=1, color=f"C{n}", label=run.variant)
        if run.variant == "falls_in_one_way":
            z_expected, v_expected = path(run.scene, t)
            right.plot(1e3 * v_expected, 1e3 * z_expected, "k:", lw=1.5, label="theory, fluid at rest")
            left.axhline(1e3 * edge(run.scene), color="0.5", ls="--", lw=0.8)
            right.axhline(1e3 * edge(run.scene), color="0.5", ls="--", lw=0.8)
            for axes in (left, right):
                axes.axhspan(0.0, 1.6, color="C0", alpha=0.08, lw=0)
    left.set(xlabel="t (ms)", ylabel="height (mm)", ylim=(1.0, 2.6))
    right.set(xlabel="velocity upwards (mm/s)", ylabel="height (mm)", ylim=(1.0, 2.6))
    left.legend(fontsize="x-small")
    right.legend(fontsize="x-small")
    return [("paths", figure, "Paths of the grains; blue: the fluid at the start; dashed: the edge of the kernel's reach, where the fluid begins and ends for a grain.")]
