"""Lift across a shear among smoothed particles: the law, the drift it makes, and the wake that makes it once more (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import self_disturbance, sheared_wake, sph_operators  # noqa: E402

UNITS = {"lift": "N", "law": "1", "across": "m/s", "along": "m/s", "with_wake": "m/s", "wake_share": "1", "side": "1", "momentum": "1"}


class Flow(NamedTuple):
    """u_x = rate s + sum A exp(-decay t) sin(k s), s = y - zero, as a kernel gathers it; hashable."""

    rate: float
    k: tuple
    amplitude: tuple
    decay: tuple

    def at(self, s, t):
        """(u_x, du_x/dy)"""
        waves = [(k, a * math.exp(-decay * t)) for k, a, decay in zip(self.k, self.amplitude, self.decay)]
        return (self.rate * s + sum(a * math.sin(k * s) for k, a in waves), self.rate + sum(a * k * math.cos(k * s) for k, a in waves))

    def strain(self, t):
        """Int_0^t du_x/dy dt at s = 0; t an array."""
        fading = sum(k * a / decay * -np.expm1(-decay * t) for k, a, decay in zip(self.k, self.amplitude, self.decay))
        return self.rate * np.asarray(t, float) + fading


class Scene:
    """The scene as it is meant; twins break the place of the grain, the forces, the direction and the widths of the coupling."""

    def __init__(self, scene):
        fluid, grain = scene["fluid"], scene["grains"]
        self.rho, self.mu, self.kernel = fluid["density"], fluid["viscosity"], fluid["kernel"]
        self.nu, self.dx = self.mu / self.rho, fluid["spacing"]
        self.h = fluid["smoothing"] * self.dx
        self.d, self.rho_p, self.gravity = grain["diameter"], grain["density"], scene["domain"]["gravity"][0]
        self.volume, self.size = math.pi / 6.0 * self.d**3, scene["domain"]["size"]
        self.stokes = 3.0 * math.pi * self.mu * self.d
        self.tau = self.rho_p * self.volume / self.stokes
        self.weight = (self.rho_p - self.rho) * self.volume * self.gravity
        self.li_ahmadi = grain["name"] == "li_ahmadi"
        self.no_law = grain["name"] == "no_law"
        self.walls, self.fluid = scene.get("wall", []), fluid
        self.end = scene["time"]["end"]

    def wave(self):
        return 2.0 * math.pi / self.size[1], self.fluid["initial"]["speed"]

    def decay(self, k):
        return self.nu * k**2 * sph_operators.viscosity_ratio(self.kernel, 3, k * self.h)

    def smoothed(self, k):
        return sph_operators.transform(self.kernel, 3, k * self.h)

    def flow(self):
        if not self.walls:
            k, speed = self.wave()
            return Flow(0.0, (k,), (float(speed * self.smoothed(k)),), (float(self.decay(k)),))
        # Couette flow from rest: the series of the plates' sudden start, each mode with its own decay
        half, speed = 0.5 * self.size[1], self.walls[1]["velocity"][0]
        k = math.pi / half * np.arange(1, 9)
        amplitude = 2.0 * speed / (np.pi * np.arange(1, 9)) * (-1.0) ** np.arange(1, 9) * self.smoothed(k)
        return Flow(speed / half, tuple(k), tuple(amplitude), tuple(self.decay(k)))

    def lift(self, w, shear):
        """(F_x, F_y), N, by the slip w = u - v [2] in du_x/dy = shear: Saffman 1965 with Mei's C or, for Li & Ahmadi, without."""
        speed = math.hypot(*w)
        if self.no_law or speed == 0.0 or shear == 0.0:
            return np.zeros(2)
        size = 6.46 / 4.0 * self.d**2 * math.sqrt(self.rho * self.mu * abs(shear)) * math.copysign(1.0, shear)
        if self.li_ahmadi:
            return size * np.array([w[1], w[0]])
        return size * mei(self.rho * speed * self.d / self.mu, 0.5 * abs(shear) * self.d / speed) * np.array([-w[1], w[0]])


def mei(re, alpha):
    """Mei (1992): what is left of Saffman's lift at a finite Re."""
    root = 0.3314 * math.sqrt(alpha)
    return (1.0 - root) * math.exp(-re / 10.0) + root if re <= 40.0 else 0.0524 * math.sqrt(alpha * re)


# --- a held grain: README, equation (2) ---


def gathered(s, place, t):
    """(u_x, du_x/dy) that a grain at `place` gathers from the lattice at time t, by plain sums."""
    k, speed = s.wave()
    ratio = sph_operators.lattice_viscosity(s.kernel, np.array([0.0, k, 0.0]), s.h, s.dx)
    decay = s.nu * k**2 * ratio
    reach = sph_operators.support(s.kernel) * s.h
    near = [s.dx * (np.arange(math.floor((x - reach) / s.dx) - 1, math.ceil((x + reach) / s.dx) + 1) + 0.5) for x in place]
    x = np.stack(np.meshgrid(*near, indexing="ij"), axis=-1).reshape(-1, 3)
    shape = np.sin(k * x[:, 1])
    x[:, 0] += speed * -math.expm1(-decay * t) / decay * shape
    apart = np.array(place) - x
    r = np.linalg.norm(apart, axis=1)
    x, shape, apart, r = (a[r < reach] for a in (x, shape, apart, r))
    chosen = sph_operators.KERNELS[s.kernel]
    w, slope = chosen.w(r / s.h), chosen.slope(r / s.h) / s.h * apart[:, 1] / np.maximum(r, 1e-30)
    mean = np.sum(w * shape) / np.sum(w)
    amplitude = speed * math.exp(-decay * t)
    return amplitude * mean, amplitude * np.sum((shape - mean) * slope) / np.sum(w)


def held_lift(scene, times):
    s = Scene(scene)
    place = scene["grains"]["arrange"]["position"]
    found = []
    for t in times:
        u, shear = gathered(s, place, t)
        found.append(s.lift(np.array([u, 0.0]), shear)[1])
    return np.array(found)


def exact_lift(run, t):
    """The law in the exact flow, without any smoothing, N."""
    s = Scene(run.scene)
    k, speed = s.wave()
    y = run.scene["grains"]["arrange"]["position"][1]
    now = speed * math.exp(-s.nu * k**2 * t)
    return s.lift(np.array([now * math.sin(k * y), 0.0]), now * k * math.cos(k * y))[1]


# --- a free grain: README, equations (3) and (4) ---


def motion(s, flow, times, carried=None):
    """v_x, v_y [nt], m/s, from rest at s = 0 at `times` (from 0); carried(t): further fluid velocity across."""

    def rate(t, state):
        v, y = state[:2], state[2]
        u, shear = flow.at(y, t)
        w = np.array([u, carried(t) if carried else 0.0]) - v
        force = s.stokes * w + s.lift(w, shear) + np.array([s.weight, 0.0])
        return [*(force / (s.rho_p * s.volume)), v[1]]

    solved = solve_ivp(rate, (0.0, times[-1]), [0.0, 0.0, 0.0], "Radau", t_eval=times, rtol=1e-8, atol=1e-12)
    return solved.y[:2]


def wake(scene, times):
    """u_y, m/s, that the grain's own sheared wake gives it, at `times`: theory.sheared_wake with the forces of the motion without it."""
    s = Scene(scene)
    flow = s.flow()
    t = np.linspace(0.0, s.end, 1001)
    v = motion(s, flow, t)
    mass = s.rho_p * s.volume
    push = np.array([s.weight - mass * np.gradient(v[0], t), -mass * np.gradient(v[1], t)])  # on the fluid
    path, strain = np.concatenate([[0.0], np.cumsum(0.5 * (v[0][1:] + v[0][:-1]) * np.diff(t))]), flow.strain(t)
    quadrature = sheared_wake.Wake(self_disturbance.one_kernel(s.kernel, s.h), s.rho, s.mu)
    known = lambda values: lambda past: np.interp(past, t, values)  # noqa: E731
    return np.array([0.0 if now <= 0.0 else quadrature.across(
        now, known(push[0]), known(push[1]), lambda past: np.interp(now, t, strain) - np.interp(past, t, strain),
        lambda past: np.interp(now, t, path) - np.interp(past, t, path)) for now in times])


_known = {}


def with_wake(scene, times):
    key = repr((scene["fluid"], scene["grains"]["name"], scene["grains"]["diameter"], scene["domain"], scene["time"]["end"], tuple(times)))
    if key not in _known:
        s = Scene(scene)
        nodes = np.linspace(0.0, s.end, 13)
        carried = wake(scene, nodes)
        from scipy.interpolate import CubicSpline

        _known[key] = motion(s, s.flow(), times, CubicSpline(nodes, carried))
    return _known[key]


def reference(quantity, scene, t):
    if quantity == "lift":
        return held_lift(scene, np.asarray(t, float))
    if quantity in ("law", "wake_share"):
        return 1.0
    s = Scene(scene)
    if quantity == "with_wake":
        return with_wake(scene, np.asarray(t, float))[1]
    row = {"along": 0, "across": 1}[quantity]
    return motion(s, s.flow(), np.asarray(t, float))[row]


def half_step_ago(run, t):
    return t - 0.5 * run.info["step"]


def lift(run):
    """(t, N) across the flow: what the grain has received in the last step less drag; known at the middle of the step."""
    (t, force), (_, drag) = run.series("force"), run.series("drag")
    return half_step_ago(run, t)[1:], (np.ravel(force) - np.ravel(drag))[1:]


def momentum(run):
    """Momentum along x of all less what weight has given, over the latter."""
    s, start, last = Scene(run.scene), run.snapshot(0), run.snapshot(-1)
    share = start["fluid"]["eps"][np.argsort(start["fluid"]["id"])]
    change = [last["fluid"]["v"][np.argsort(last["fluid"]["id"]), c] - start["fluid"]["v"][np.argsort(start["fluid"]["id"]), c] for c in (0, 1)]
    grain = s.rho_p * s.volume * last["grains"]["v"][0]
    given = s.weight * last["time"]
    total = [s.rho * s.dx**3 * np.sum(share * change[c]) + grain[c] for c in (0, 1)]
    return float(math.hypot(total[0] - given, total[1]) / abs(given))


def measure(quantity, run):
    if quantity == "lift":
        return lift(run)
    if quantity == "law":
        t, force = lift(run)
        return float(force[-1] / exact_lift(run, t[-1]))
    if quantity in ("across", "with_wake", "along"):
        t, v = run.series("vx" if quantity == "along" else "vy")
        return t, np.ravel(v)
    if quantity == "wake_share":  # at the end
        t, v = run.series("vy")
        return float(np.ravel(v)[-1] / with_wake(run.scene, t)[1][-1])
    if quantity == "side":  # +1: a lagging grain to the faster side, a leading one to the slower; shear of the scene at y = 0 > 0
        (_, x), (_, y) = run.series("vx"), run.series("vy")
        return float(np.sign(-np.ravel(x)[-1] * np.ravel(y)[-1]))
    if quantity == "momentum":
        return momentum(run)
    return NotImplemented


def by_name(runs, *names):
    finest = {}
    for run in runs:
        if not run.failure and run.variant in names:
            finest[run.variant] = run
    return [finest[name] for name in names if name in finest]


def drift_figure(runs):
    """Velocity across the flow over Saffman's own, 1.615/(3 pi) d sqrt(G/nu) w, with G at the start (Couette: in the end)."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    for n, run in enumerate(by_name(runs, "leading", "lagging", "li_ahmadi", "two_way", "couette")):
        s, (t, v) = Scene(run.scene), measure("across", run)
        left.plot(t / t[-1], motion(s, s.flow(), t)[1] / scale(s), "-", color=f"C{n}", lw=0.8)
        left.plot(t / t[-1], v / scale(s), "os^dv"[n], ms=4, mfc="none", color=f"C{n}", label=f"{run.variant}, {1e3 * t[-1]:.3g} ms")
    for n, run in enumerate(by_name(runs, "wake_alone", "wake_corrected", "wake_and_law", "wake_small")):
        s, (t, v) = Scene(run.scene), measure("across", run)
        right.plot(1e3 * t, with_wake(run.scene, t)[1] / scale(s), "-", color=f"C{n}", lw=0.8)
        right.plot(1e3 * t, motion(s, s.flow(), t)[1] / scale(s), ":", color=f"C{n}", lw=0.8)
        right.plot(1e3 * t, v / scale(s), "os^d"[n], ms=4, mfc="none", color=f"C{n}", label=run.variant)
    left.set_xlabel("time over that of the run [-]")
    right.set_xlabel("time [ms]")
    left.set_ylabel("velocity across, over Saffman's at the start [-]")
    for axes in (left, right):
        axes.axhline(0.0, color="0.7", lw=0.6)
        if axes.get_legend_handles_labels()[0]:
            axes.legend(fontsize="x-small")
        else:
            axes.remove()  # these runs belong to the full tier
    return figure


def scale(s):
    if s.walls:
        shear = s.walls[1]["velocity"][0] / (0.5 * s.size[1])
    else:
        shear = s.wave()[0] * s.wave()[1]
    return 6.46 / 4.0 / (3.0 * math.pi) * s.d * math.sqrt(shear / s.nu) * abs(s.weight) / s.stokes


def share_figure():
    """Saffman's lift that the scheme's own wake makes, over h sqrt(G/nu), after strains of 0.3 to 30."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 3.8), layout="constrained")
    axes, width = figure.subplots(), np.geomspace(0.05, 5.0, 13)
    for strain in (0.3, 1.0, 3.0, 30.0):
        share = [sheared_wake.of_constant_push(self_disturbance.one_kernel("wendland_c2", h), 1.0, 1.0, 1.0, 1.0, strain)
                 / sheared_wake.saffman_share(1.0, 1.0, 1.0, 1.0) for h in width]
        axes.semilogx(width, share, label=f"strain {strain:g}")
    axes.set_ylim(0.0, 1.0)
    axes.set_xlabel("h sqrt(G/nu) [-]")
    axes.set_ylabel("drift by the wake over Saffman's [-]")
    axes.legend(fontsize="small")
    return figure


def figures(runs):
    return [("drift", drift_figure(runs), "Symbols: runs. Left, full lines: equation (3). Right: (4), dotted (3), which without a law is nothing."),
            ("share", share_figure(), "Equation (4) for a constant push in a constant shear, Wendland C2 for all, Morris' operator.")]
