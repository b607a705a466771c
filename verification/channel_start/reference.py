"""Start-up of plane Couette and plane Poiseuille flow between walls at y = 0 and y = L (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory.channel_rows import steady_rows  # noqa: E402
from theory.local_fit import fitted  # noqa: E402

UNITS = {
    "velocity_profile": "m/s",
    "centre_velocity": "m/s",
    "mean_velocity": "m/s",
    "wall_stress": "Pa",
    "velocity_l2": "1",
    "velocity_linf": "1",
    "from_rows": "1",
}
FIT_RADIUS = 3.0  # spacings; some 28 particles for the six coefficients of a parabola
PROFILE = 9  # places of "velocity_profile": y = L j/(PROFILE + 1), j = 1 ... PROFILE

# Numbers of Morris, Fox & Zhu (1997), J. Comput. Phys. 136, 214, section 4 (from memory; they fit together, see the test).
MORRIS = {"width": 1e-3, "nu": 1e-6, "rho": 1000.0, "wall_speed": 1.25e-5, "force": 1e-4}
TERMS_END = 40.0  # series end where exp(-...) < exp(-40) = 4e-18 of the first term


class Channel:
    """Fluid at rest; from t = 0 the wall y = L moves at wall_speed, m/s, along x and the force per mass `force`, m/s2, acts."""

    def __init__(self, width, nu, wall_speed=0.0, force=0.0, rho=1000.0):
        self.width, self.nu, self.wall_speed, self.force, self.rho = width, nu, wall_speed, force, rho
        self.time = width**2 / (math.pi**2 * nu)  # of the slowest mode
        self.peak = force * width**2 / (8.0 * nu)  # Poiseuille, at the centre

    def _modes(self, t):
        """Mode numbers [m] that matter at t > 0."""
        last = math.sqrt(TERMS_END * self.time / t)
        return np.arange(1.0, min(max(last, 3.0), 2e4) + 1.0)

    def steady(self, y):
        """u, m/s, after a long time: V y/L + F y (L - y)/(2 nu)."""
        y = np.asarray(y, float)
        return self.wall_speed * y / self.width + self.force / (2.0 * self.nu) * y * (self.width - y)

    def velocity(self, y, t):
        """u [n], m/s, at heights y [n], m, and one time t, s: README, equation (1)."""
        y = np.asarray(y, float)
        if t <= 0.0:
            return np.where(y >= self.width, self.wall_speed, 0.0)
        n = self._modes(t)
        decay = np.exp(-(n**2) * t / self.time)
        couette = 2.0 * self.wall_speed / (math.pi * n) * np.where(n % 2 == 0, 1.0, -1.0)
        poiseuille = np.where(n % 2 == 0, 0.0, -4.0 * self.force * self.width**2 / (self.nu * math.pi**3 * n**3))
        modes = np.sin(math.pi * np.multiply.outer(y / self.width, n))
        return self.steady(y) + modes @ ((couette + poiseuille) * decay)

    def mean(self, t):
        """Mean of u over the width, m/s."""
        settled = 0.5 * self.wall_speed + self.force * self.width**2 / (12.0 * self.nu)
        if t <= 0.0:
            return 0.0
        n = self._modes(t)
        n = n[n % 2 == 1]  # the mean of sin(n pi y/L) is 2/(n pi) for odd n, else 0
        share = 2.0 * self.wall_speed / (math.pi * n) + 4.0 * self.force * self.width**2 / (self.nu * math.pi**3 * n**3)
        return settled - float(np.sum(2.0 / (math.pi * n) * share * np.exp(-(n**2) * t / self.time)))

    def lower_wall_stress(self, t):
        """rho nu du/dy at y = 0, Pa, t > 0."""
        n = self._modes(t)
        k = math.pi * n / self.width
        couette = 2.0 * self.wall_speed / (math.pi * n) * np.where(n % 2 == 0, 1.0, -1.0)
        poiseuille = np.where(n % 2 == 0, 0.0, -4.0 * self.force * self.width**2 / (self.nu * math.pi**3 * n**3))
        slope = self.wall_speed / self.width + self.force * self.width / (2.0 * self.nu)
        return self.rho * self.nu * (slope + float(np.sum(k * (couette + poiseuille) * np.exp(-(n**2) * t / self.time))))


def channel(scene):
    """Channel of a scene: L = size[1], F = body_force[0], the wall speed that of the wall that moves along x, if any."""
    fluid, domain = scene["fluid"], scene["domain"]
    speeds = [wall.get("velocity", [0.0])[0] for wall in scene.get("wall", [])]
    moving = max(speeds, key=abs, default=0.0)
    return Channel(domain["size"][1], fluid["viscosity"] / fluid["density"], moving, fluid.get("body_force", [0.0])[0], fluid["density"])


def greatest(flow):
    """Largest steady speed, m/s: the scale of errors (Morris et al. compare with the same peak in both flows)."""
    return max(abs(flow.wall_speed), abs(flow.peak))


def profile_error(flow, y, u, t):
    """(L1, L2, Linf) of velocities u [n] at heights y [n] over the largest steady speed."""
    error = np.abs(np.asarray(u, float) - flow.velocity(y, t)) / greatest(flow)
    return float(np.mean(error)), float(np.sqrt(np.mean(error**2))), float(np.max(error))


def reference(quantity, scene, t):
    flow = channel(scene)
    times = np.atleast_1d(np.asarray(t, float))
    if quantity == "velocity_profile":  # [nt, PROFILE]
        y = flow.width * np.arange(1, PROFILE + 1) / (PROFILE + 1)
        return np.array([flow.velocity(y, time) for time in times])
    if quantity == "centre_velocity":
        return np.array([flow.velocity([0.5 * flow.width], time)[0] for time in times])
    if quantity == "mean_velocity":
        return np.array([flow.mean(time) for time in times])
    if quantity == "wall_stress":
        return np.array([flow.lower_wall_stress(time) for time in times])
    if quantity in ("velocity_l2", "velocity_linf", "from_rows"):
        return 0.0  # norms of errors; judged by absolute metrics
    raise KeyError(quantity)


def snapshots(run):
    """The snapshots of a run but the first, the start from rest."""
    return [run.snapshot(k) for k in range(1, len(run.snapshot_files()))]


def profile(scene, fluid):
    """u [PROFILE], m/s, at the places of velocity_profile from the particles: parabolas fitted in the middle of the channel's length."""
    size, spacing = scene["domain"]["size"], scene["fluid"]["spacing"]
    y = size[1] * np.arange(1, PROFILE + 1) / (PROFILE + 1)
    places = np.stack((np.full(PROFILE, 0.5 * size[0]), y), axis=1)
    return fitted(fluid["x"], np.asarray(fluid["v"])[:, 0], places, FIT_RADIUS * spacing)


def error_norm(scene, snapshot, norm):
    """velocity_l2 or velocity_linf where the particles are."""
    x, v, flow = snapshot["fluid"]["x"], snapshot["fluid"]["v"], channel(scene)
    return profile_error(flow, x[:, 1], v[:, 0], snapshot["time"])[("l1", "l2", "linf").index(norm.removeprefix("velocity_"))]


def distance_from_rows(scene, snapshot):
    """Greatest difference of the particles' u from what the steady rows of theory/channel_rows.py predict, over the peak.

    What is left of the start is added from the series.
    """
    flow, x = channel(scene), snapshot["fluid"]["x"][:, 1]
    y, u = steady_rows(round(flow.width / scene["fluid"]["spacing"]), scene["fluid"]["smoothing"])
    unsteady = (flow.velocity(x, snapshot["time"]) - flow.steady(x)) / greatest(flow)
    return float(np.max(np.abs(snapshot["fluid"]["v"][:, 0] / greatest(flow) - CubicSpline(y, u)(x / flow.width) - unsteady)))


def measure(quantity, run):
    if quantity == "from_rows":
        return distance_from_rows(run.scene, run.snapshot(-1))
    if quantity not in ("velocity_profile", "velocity_l2", "velocity_linf"):
        return NotImplemented
    shots = snapshots(run)
    t = np.array([shot["time"] for shot in shots])
    if quantity == "velocity_profile":
        return t, np.array([profile(run.scene, shot["fluid"]) for shot in shots])
    return t, np.array([error_norm(run.scene, shot, quantity) for shot in shots])


def figures(runs):
    """Profiles at four times of the finest run of every variant, with the series."""
    import matplotlib.pyplot as plt

    finest = {run.variant: run for run in runs if run.failure is None}
    figure, axes = plt.subplots(1, len(finest), figsize=(2.6 * len(finest), 3.0), sharey=True, squeeze=False)
    for axis, (name, run) in zip(axes[0], finest.items()):
        flow, shots = channel(run.scene), snapshots(run)
        y = np.linspace(0.0, flow.width, 201)
        for colour, k in enumerate(sorted({0, 1, 3, len(shots) - 1})):
            t = shots[k]["time"]
            axis.plot(flow.velocity(y, t) / greatest(flow), y / flow.width, color=f"C{colour}", lw=1, label=f"{flow.nu * t / flow.width**2:.3g}")
            x, v = shots[k]["fluid"]["x"], shots[k]["fluid"]["v"]
            axis.plot(v[:, 0] / greatest(flow), x[:, 1] / flow.width, ".", ms=1.5, color=f"C{colour}", alpha=0.5)
        axis.set_title(name, fontsize=9)
        axis.set_xlabel("$u$ / greatest steady speed")
    axes[0][0].set_ylabel("$y/L$")
    axes[0][0].legend(title=r"$\nu t/L^2$", fontsize=7, title_fontsize=7)
    figure.tight_layout()
    return [("profiles", figure, "Every particle of the finest run (dots) and the series (lines).")]
