"""Start-up of plane Couette and plane Poiseuille flow between walls at y = 0 and y = L (README.md)."""

import math

import numpy as np

UNITS = {
    "velocity_profile": "m/s",
    "centre_velocity": "m/s",
    "mean_velocity": "m/s",
    "wall_stress": "Pa",
    "velocity_l2": "1",
}
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
    """Channel of a scene: L = size[1], F = gravity[0], the wall speed that of the wall that moves along x, if any."""
    fluid, domain = scene["fluid"], scene["domain"]
    speeds = [wall.get("velocity", [0.0])[0] for wall in scene.get("wall", [])]
    moving = max(speeds, key=abs, default=0.0)
    return Channel(domain["size"][1], fluid["viscosity"] / fluid["density"], moving, domain["gravity"][0], fluid["density"])


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
    if quantity == "velocity_l2":
        return 0.0
    raise KeyError(quantity)
