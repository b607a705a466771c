"""The self-disturbance of `self_disturbance` in time: under a given force, and of a grain released from rest.

Each wave vector carries one fading sum a(k, t). Within a step the force is linear and dX/dt constant, and (1) of
`self_disturbance` is integrated exactly, so that no step is too long for the fluid; the errors are those of the force and of
the grain's path, second order in the step.
"""

from typing import NamedTuple

import numpy as np

from theory import self_disturbance


def step_factors(z):
    """exp(-z), Int_0^1 (1-s) exp(-z(1-s)) ds, Int_0^1 s exp(-z(1-s)) ds: weights of the past, of F before and after."""
    safe = np.where(np.abs(z) < 0.02, 1.0, z)
    whole = np.where(np.abs(z) < 0.02, 1.0 - z / 2.0 + z**2 / 6.0 - z**3 / 24.0 + z**4 / 120.0, -np.expm1(-safe) / safe)
    after = np.where(np.abs(z) < 0.02, 0.5 - z / 6.0 + z**2 / 24.0 - z**3 / 120.0 + z**4 / 720.0, (1.0 - whole) / safe)
    return np.exp(-z), whole - after, after


class Memory:
    """The fading sums of one grain, from fluid at rest."""

    def __init__(self, modes, scheme, fluid):
        self.turn = modes.k * modes.cosine  # phase per metre
        self.decay = self_disturbance.decay_rate(scheme, fluid, modes.k)
        transverse = modes.share * (1.0 - modes.cosine**2)
        viscous = transverse * (self.decay - fluid.brinkman / fluid.rho)
        self.gathered = np.stack([transverse / fluid.rho, viscous])  # of a: velocity; and force density of the viscosity
        self.longitudinal = float(modes.share @ modes.cosine**2)  # force density of the pressure, per force
        self.a = np.zeros(len(modes.k))
        self._after = None

    def past(self, dt, dx, force):
        """Advance by dt, dX = dx with the part of the force that falls to zero. -> ([2] gathered, [2] more per final force)."""
        rate = self.decay * dt + (1j * self.turn * dx if dx != 0.0 else 0.0)
        kept, before, after = step_factors(rate)
        self.a = kept * self.a + dt * before * force
        self._after = dt * after
        return (self.gathered @ self.a).real, (self.gathered @ self._after).real

    def close(self, force):
        """Add what the force at the end of the step contributes."""
        self.a = self.a + self._after * force


class ElasticMemory(Memory):
    """The same where particles resist being moved out of their lattice: da/dt = F - lambda a - K Int a dt, K [n] of
    `sph_operators.lattice_stiffness`, 1/s2. Each wave is two fading sums, of the rates -s with s^2 + lambda s + K = 0."""

    def __init__(self, modes, scheme, fluid, stiffness):
        half = 0.5 * self_disturbance.decay_rate(scheme, fluid, modes.k)
        root = np.sqrt(half**2 - stiffness + 0j)
        root = np.where(np.abs(root) < 1e-9 * half, 1e-9 * half, root)  # two equal roots are the limit of two different ones
        slow, fast = -stiffness / (half + root), -(half + root)  # their product is K
        weights = np.concatenate([slow, -fast]) / np.tile(2.0 * root, 2)
        super().__init__(modes._replace(k=np.tile(modes.k, 2), cosine=np.tile(modes.cosine, 2), share=np.tile(modes.share, 2)), scheme, fluid)
        transverse = np.tile(modes.share * (1.0 - modes.cosine**2), 2) * weights
        self.decay = -np.concatenate([slow, fast])
        self.gathered = np.stack([transverse / fluid.rho, transverse * self.decay])
        self.longitudinal = float(modes.share @ modes.cosine**2)


def unsteady(modes, scheme, fluid, times, force, path=None):
    """u_self [nt], m/s, at `times` (from 0, increasing) of force [nt], N, linear in between; path = X [nt], m, or at rest.

    A constant force switched on at t = 0 is force = full(nt, F): its steps are exact. The fluid is at rest at times[0].
    """
    memory = Memory(modes, scheme, fluid)
    steps = np.diff(times)
    moves = np.zeros_like(steps) if path is None else np.diff(path)
    u = [0.0]
    for dt, dx, before, after in zip(steps, moves, force[:-1], force[1:]):
        gathered, more = memory.past(dt, dx, before)
        memory.close(after)
        u.append(gathered[0] + more[0] * after)
    return np.array(u)


class Settling(NamedTuple):
    """At the times asked for: the grain's velocity, the part of it that is its own wake, and its force on the fluid, N."""

    v: np.ndarray
    u_self: np.ndarray
    force: np.ndarray


def _slip_at_end(sphere, load, share, response, guess):
    """Root w of w + response F + share F - load = 0, F = drag(w): the end of a trapezoidal step. Newton's method."""
    w, scale = guess, sphere.terminal_speed()
    for _ in range(60):
        step = 1e-6 * max(abs(w), 1e-6 * scale)
        drag = float(sphere.drag(w))
        slope = (float(sphere.drag(w + step)) - drag) / step
        change = (w + (share + response) * drag - load) / (1.0 + (share + response) * slope)
        w -= change
        if abs(change) < 1e-13 * scale:
            return w
    raise ValueError(f"no slip found near {guess} m/s: the step is too long for the drag law")


def plain_settling(sphere, scheme, modes, times, moves="slip", brinkman=0.0, stress=False, steps=300, memory=None):
    """`Settling` of a grain released from rest at t = 0, two-way coupled and not corrected.

        m dv/dt = (rho_p - rho) V g - F,   F = drag(v - u_self) [+ V times the gathered -(-grad p + div tau) of the wake]

    sphere: `released_sphere.Sphere`, its factor f(Re) the drag law at the porosity the grain sees. The fluid receives F at the
    grain's place, its own force from its own slip; hydrostatic pressure is balanced and counts as buoyancy only. `stress`: the
    grain also feels the pressure gradient and the stress of its wake. `memory`: sums of another kind than Memory(...). moves: see `self_disturbance` (modes that allow it).
    Trapezoidal in time on t = end (n/steps)^2 and `times`; 300 steps give v to about 1e-4 of the final one (by halving).
    """
    memory = memory or Memory(modes, scheme, self_disturbance.Fluid(sphere.rho, sphere.mu, brinkman))
    mass, weight = sphere.inertia(False), sphere.weight()
    volume = sphere.volume() if stress else 0.0
    grid = np.union1d(times[-1] * (np.arange(steps + 1) / steps) ** 2, times)
    v, u, force, slip = 0.0, 0.0, 0.0, 0.0
    states = [(v, u, force)]
    for dt in np.diff(grid):
        ahead = 0.5 * dt * (weight - force) / mass
        dx = {"still": 0.0, "slip": slip, "path": v}[moves] * dt + (0.0 if moves == "still" else ahead * dt)
        (wake, viscous), (more, more_viscous) = memory.past(dt, dx, force)
        # F = (drag + V viscous)/hold; then w + u(F) = v + dt/m (weight - (F_before + F)/2) is one equation for w
        hold = 1.0 - volume * (memory.longitudinal + more_viscous)
        share, held = 0.5 * dt / mass / hold, volume * viscous / hold
        load = v + dt / mass * (weight - 0.5 * force) - wake - (0.5 * dt / mass + more) * held
        slip = _slip_at_end(sphere, load, share, more / hold, slip)
        after = float(sphere.drag(slip)) / hold + held
        v += dt / mass * (weight - 0.5 * (force + after))
        force, u = after, wake + more * after
        memory.close(force)
        states.append((v, u, force))
    return Settling(*np.array(states)[np.searchsorted(grid, times)].T)
