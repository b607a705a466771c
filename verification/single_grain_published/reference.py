"""The published scene of one grain: its speed, less what the control grain says of the fluid's own noise, on linear theory (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import self_disturbance, self_disturbance_history, settling, sph_operators  # noqa: E402
from theory.lone_grain import OwnVolume, backflow, law_of, terminal_speed  # noqa: E402

UNITS = {"off_theory": "1", "distance": "1", "buoyancy": "1"}
SHARE, FLOOR = 0.10, 0.005  # of the disturbance, of u_t: the larger of both is the bound
REACH = 14.0  # k h of the greatest wave: beyond, the product of the filters is below 1e-6
GRAVITY = 9.81  # m/s2
DEPTH = 6e-3  # m, of the fluid


class Setting(NamedTuple):
    """What the theory needs of a scene; hashable. Coupling, drag and buoyancy are the case's, which a twin may break."""

    rho: float
    mu: float
    rho_p: float
    d: float
    kernel: str
    h: float
    c: float
    artificial: float
    spacing: float
    depth: float  # of the grain below the surface
    box: tuple
    end: float

    @property
    def tau(self):
        return settling.relaxation_time(self.rho_p, self.d, self.mu)

    @property
    def volume(self):
        return math.pi / 6.0 * self.d**3


def setting(run):
    """Of a run as it is meant: artificial viscosity belongs to the variants that the slides describe, and to no other."""
    fluid, grain, size = run.scene["fluid"], run.scene["grains"][0], run.scene["domain"]["size"]
    h, alpha = fluid["smoothing"] * fluid["spacing"], 0.1 if run.variant.startswith("as_slides") else 0.0
    return Setting(fluid["density"], fluid["viscosity"], grain["density"], grain["diameter"], fluid["kernel"], h, fluid["sound_speed"],
                   alpha * fluid["sound_speed"] * h / 20.0, fluid["spacing"], DEPTH - grain["arrange"]["position"][2], (size[0], size[1], DEPTH),
                   run.scene["time"]["end"])


def grain_of(s):
    """The grain at the porosity that it makes itself."""
    scheme = self_disturbance.one_kernel(s.kernel, s.h)
    return OwnVolume(law_of(1.0 - self_disturbance.own_volume_fraction(scheme, s.d)), s.rho_p, s.d, s.rho, s.mu)


def waves(scheme, s):
    """(modes, their wave vectors [n, 3]) of the periodic box, one octant for all; k = 0 is no wave."""
    unit = 2.0 * math.pi / np.array(s.box)
    counts = np.floor(REACH / s.h / unit).astype(int)
    n = np.stack(np.meshgrid(*[np.arange(count + 1) for count in counts], indexing="ij"), axis=-1).reshape(-1, 3)
    k = np.linalg.norm(n * unit, axis=1)
    n, k = n[(k > 0.0) & (k < REACH / s.h)], k[(k > 0.0) & (k < REACH / s.h)]
    share = 2.0 ** (n > 0).sum(axis=1) / math.prod(s.box) * self_disturbance.filter_product(scheme, k)
    return self_disturbance.Modes(k, n[:, 2] * unit[2] / k, share), n * unit


@lru_cache(maxsize=None)
def settled(s, times):
    """(v, u_self), m/s, downwards, at the times (increasing, > 0)."""
    scheme, fluid = self_disturbance.one_kernel(s.kernel, s.h), self_disturbance.Fluid(s.rho, s.mu, artificial=s.artificial)
    modes, vectors = waves(scheme, s)
    grain = grain_of(s)
    grain.b = backflow(scheme, modes, s)
    stiffness = GRAVITY * s.depth * sph_operators.lattice_stiffness(s.kernel, vectors, (0.0, 0.0, 1.0), s.h, s.spacing)
    memory = self_disturbance_history.ElasticMemory(modes, scheme, fluid, stiffness)
    found = self_disturbance_history.plain_settling(grain, scheme, modes, np.array(times), "slip", stress=True, memory=memory)
    return found.v / (1.0 + grain.b), found.u_self


def theory(s, t):
    """The same at times t that begin with 0."""
    v, u = settled(s, tuple(t[1:]))
    return np.append(0.0, v), np.append(0.0, u)


# --- what the control grain says ---


def slip_of_drag(grain, drag):
    """w with grain.drag(w) = drag, m/s; Newton from the Stokes value, the law being nearly linear here."""
    w = drag / (3.0 * math.pi * grain.mu * grain.d)
    for _ in range(20):
        w = w * np.where(np.abs(w) > 0.0, drag / np.where(w == 0.0, 1.0, grain.drag(w)), 0.0)
    return w


class Wake:
    """The velocity that a force at rest has made where it acts, at equal steps; the force is linear in between."""

    def __init__(self, s, dt):
        scheme = self_disturbance.one_kernel(s.kernel, s.h)
        modes = self_disturbance.box_modes(scheme, s.box, reach=REACH)
        rate = self_disturbance.decay_rate(scheme, self_disturbance.Fluid(s.rho, s.mu, artificial=s.artificial), modes.k)
        self.kept, before, after = self_disturbance_history.step_factors(rate * dt)
        self.before, self.after = dt * before, dt * after
        self.gathered = modes.share * (1.0 - modes.cosine**2) / s.rho
        self.at_once = float(self.gathered @ self.after)  # velocity per force at the end of a step
        self.a, self.force = np.zeros(len(modes.k)), 0.0

    def past(self):
        """m/s at the end of the step that begins, if the force ended there with zero."""
        self.a = self.kept * self.a + self.before * self.force
        return float(self.gathered @ self.a)

    def close(self, force):
        self.a, self.force = self.a + self.after * force, force


def noise(s, t, push, undisturbed):
    """What the fluid's own motion adds to the speed of the free grain [nt], m/s, downwards, README (1): the two of `control`."""
    grain, half = grain_of(s), 0.5 * t[1] / (s.rho_p * s.volume)
    u_t = grain.terminal_speed()
    beta = (grain.drag(1.001 * u_t) - grain.drag(0.999 * u_t)) / (0.002 * u_t)  # N s/m
    wake, moved = Wake(s, t[1]), np.zeros_like(t)
    for k in range(1, len(t)):
        slip = (moved[k - 1] + half * push[k] - undisturbed[k] - wake.past()) / (1.0 + (half + wake.at_once) * beta)
        wake.close(beta * slip)
        moved[k] = moved[k - 1] + 2.0 * half * (push[k] - beta * slip)
    return moved


def control(run, s, dt):
    """Of the held grain [nt], downwards, each over the step before its time: the force of the fluid's acceleration (stress less what it

    is at rest), N, and the velocity of the fluid without what the grain's own drag has made of it, m/s."""
    force, drag = np.ravel(run.series("force_held")[1]), run.series("drag")[1][:, 1]
    u, wake = -slip_of_drag(grain_of(s), drag), Wake(s, dt)
    for k in range(1, len(u)):
        u[k] -= wake.past() + wake.at_once * drag[k]
        wake.close(drag[k])
    return s.rho * s.volume * GRAVITY - (force - drag), u


@lru_cache(maxsize=None)
def series(run):
    """(t, v, noise), m/s, downwards."""
    s, (t, v) = setting(run), run.series("v")
    return t, -np.ravel(v), noise(s, t, *control(run, s, t[1]))


def buoyancy(run):
    """Mean force of the fluid less drag on the held grain over rho V g."""
    s, force, drag = setting(run), np.ravel(run.series("force_held")[1]), run.series("drag")[1][:, 1]
    return float(np.mean((force - drag)[1:])) / (s.rho * s.volume * GRAVITY)


@lru_cache(maxsize=None)
def compared(run):
    """(t, v without noise, theory, u_self) at the times of output."""
    t, v, moved = series(run)
    at = slice(None, None, round(run.scene["time"]["output_interval"] / t[1]))
    expected, u = theory(setting(run), t[at])
    return t[at], (v - moved)[at], expected, u


def distance(run):
    """(t, v less noise and theory over the bound), signed, at the times of output."""
    t, v, expected, u = compared(run)
    return t, (v - expected) / np.maximum(SHARE * u, FLOOR * terminal_speed(setting(run)))


def measure(quantity, run):
    if quantity == "distance":
        return distance(run)
    if quantity == "off_theory":
        return float(np.max(np.abs(distance(run)[1])))
    return buoyancy(run) if quantity == "buoyancy" else NotImplemented


def reference(quantity, scene, t):
    if quantity in UNITS:
        return 0.0
    raise KeyError(quantity)


# --- the page ---


def table(runs):
    rows = []
    for run in runs:
        s, (t, v, expected, u), whole = setting(run), compared(run), series(run)
        u_t = terminal_speed(s)
        for multiple in (5, 10, 20, 60, 100):
            at = int(np.argmin(np.abs(t / s.tau - multiple)))
            if abs(t[at] / s.tau - multiple) < 0.02 * multiple:
                raw = np.interp(t[at], whole[0], whole[1])
                rows.append([run.variant, f"{s.h / s.d:g}", multiple, *(f"{x / u_t:.4f}" for x in (raw, v[at], expected[at], u[at]))])
    return {"columns": ["run", "h/d", "t/tau_p", "v/u_t", "without the fluid's noise", "theory", "of it the wake"], "rows": rows,
            "caption": "Speed over the terminal velocity of Di Felice's law at porosity 1."}


WIDTHS = {2.0: "C0", 3.0: "C1", 5.0: "C2", 6.0: "C5"}  # h/d: colour
PANELS = {"as_code": lambda name: name.startswith("as_code") and "water" not in name,
          "as_slides": lambda name: name.startswith("as_slides"),
          "quiet": lambda name: name.startswith("quiet") and "water" not in name,
          "water: as_code, quiet": lambda name: "water" in name}


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14.0, 4.2), layout="constrained")
    for axes, (title, belongs) in zip(figure.subplots(1, len(PANELS), sharey=True), PANELS.items()):
        for run in runs:
            if belongs(run.variant):
                _draw(axes, run)
        axes.axhspan(-2.0, 2.0, color="0.9", zorder=0)
        axes.set(title=title, xlabel="t/τ_p (-)", xscale="log", ylim=(-6.0, 20.0))
        handles, labels = axes.get_legend_handles_labels()
        once = dict(sorted(zip(labels, handles), key=lambda pair: pair[0]))
        if once:
            axes.legend(once.values(), once.keys(), fontsize=7, loc="upper left")
    figure.axes[0].set_ylabel("error of v (%)")
    return [("published", figure, "Error of the published scheme's speed against Di Felice's terminal velocity. Circles: less what the held grain "
             "feels of the sound (crosses: displaced masses, quiet); lines: theory; dashed: without the elasticity of the lattice; thin: v as it "
             "comes, at h/d = 6; grey: the 2 % of the slides' claim for h > 2 d.")]


def _draw(axes, run):
    s, (t, v, expected, _), (fine, raw, _) = setting(run), compared(run), series(run)
    u_t, width, after, later = terminal_speed(s), round(s.h / s.d, 3), t > 2.0 * s.tau, fine > 2.0 * s.tau
    colour = WIDTHS.get(width, "C7")
    viscous = theory(s._replace(depth=0.0), t)[0]
    if width == 6.0:
        axes.plot(fine[later] / s.tau, 100.0 * (raw[later] / u_t - 1.0), "-", color=colour, lw=0.3)
    axes.plot(t[after] / s.tau, 100.0 * (viscous[after] / u_t - 1.0), "--", color=colour, lw=0.8)
    axes.plot(t[after] / s.tau, 100.0 * (expected[after] / u_t - 1.0), "-", color=colour, lw=1.2)
    axes.plot(t[after] / s.tau, 100.0 * (v[after] / u_t - 1.0), "x" if run.variant.startswith("quiet") else "o", color=colour, ms=3.5, mfc="none",
              label=f"h/d = {width:g}")
