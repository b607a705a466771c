"""A lone grain falls through a fluid on a grid of cubes that it pushes: linear theory of the two-way coupled scheme, from rest on.

The box is periodic with no net flux (k = 0 is left out); a tall closed one is the same until the grain comes near its ends. The
grain is spread over the nodes, and gathers from them, by a Gaussian of deviation w cut off at 3.5 w, and moves at v(t) downwards. Waves
k_i = 2 pi n_i/L_i, |n_i| < N_i/2; first differences of cells a make of them K_i = (2/a) sin(k_i a/2) (Harlow & Welch 1965), friction is
nu K^2, and a gradient takes the part along K, c = K_z/|K|. With g(k) the transform of the kernel and share = g^2/volume for each wave,

    dA/dt = F - (nu K^2 + i k_z U) A,                         the fading sum of the grain's push F on the fluid, N s             (1)
    u     = sum share [(1 - c^2) Re A/rho - c^2 V v]          the velocity gathered: wake, and the fluid that makes room          (2)
    S     = -sum share' [(1 - c^2) nu K^2 Re A + c^2 F + c^2 rho V v']      -grad p + div tau gathered, N/m3                      (3)
    rho a = sum share [(1 - c^2) (F - nu K^2 Re A) - c^2 rho V v']          rho du/dt gathered where the grain is, N/m3          (4)

(4) is the stress and the push; cells gather what faces have, share' = share cos(k_z a/2). The grain:

    m v' = W - D(v - u) + V S + [V rho a - rho V v']/2,    F = D(v - u) - [V rho a - rho V v']/2,                               (5)

the brackets with virtual mass only, V S with the pressure gradient only. U is the slip v - u, as in `self_disturbance` ("slip").
Left out: the wake's own momentum flux (second order in u/v), the porosity in friction, of the order of the grain's share of its own
kernel, sampling (2.7e-9 of the kernel for w = a), the solver's step.
"""

from typing import NamedTuple

import numpy as np

from theory.grid_wake import GridScheme, box_waves


class Box(NamedTuple):
    """size [3], m; cell, m; width: deviation of the Gaussian, m. Motion along the last axis."""

    size: tuple
    cell: float
    width: float


class Modes(NamedTuple):
    """One entry for each set of mirrored waves: k_z, K^2, c^2, shares of (2) and (3)."""

    turn: np.ndarray
    square: np.ndarray
    along: np.ndarray
    share: np.ndarray
    of_cells: np.ndarray


def modes(box, least=1e-9):
    """Of the box; waves whose g^2 is below `least` are left out."""
    waves = box_waves(GridScheme("gaussian", box.width, box.cell), box.size, least)
    square, turn = (waves.grid**2).sum(axis=1), waves.k[:, 2]
    return Modes(turn, square, waves.grid[:, 2] ** 2 / square, waves.share, waves.share * np.cos(0.5 * turn * box.cell))


class Fall(NamedTuple):
    """At the times asked for, downwards: speed of the grain and velocity gathered at it, m/s."""

    v: np.ndarray
    u: np.ndarray


class _Grain:
    """Equations (2) to (5) for given A and v, solved for F and v'."""

    def __init__(self, sphere, waves, forces):
        self.sphere, self.waves, self.nu = sphere, waves, sphere.mu / sphere.rho
        self.virtual = 0.5 if "virtual_mass" in forces else 0.0
        self.stress = 1.0 if "pressure_gradient" in forces else 0.0
        volume = sphere.volume()
        self.whole = volume * float(waves.of_cells @ waves.along)  # V times what multiplies F in -S
        self.room = volume * float(waves.share @ waves.along)
        self.push = volume * float(waves.share @ (1.0 - waves.along))  # V times what multiplies F in rho a

    def gathered(self, v, a):
        return float((self.waves.share * (1.0 - self.waves.along)) @ a.real) / self.sphere.rho - self.room * v

    def rates(self, v, a):
        """(v', F)."""
        s, w = self.sphere, self.waves
        drag = float(s.drag(v - self.gathered(v, a)))
        fades = (1.0 - w.along) * self.nu * w.square
        stress_of_wake, slowing = -s.volume() * float((w.of_cells * fades) @ a.real), -s.volume() * float((w.share * fades) @ a.real)
        displaced = s.rho * s.volume()
        # V S = stress_of_wake - whole (F + displaced v'), V rho a = slowing + push F - room displaced v'; unknowns (v', F)
        matrix = [[s.rho_p * s.volume() + (self.stress * self.whole + self.virtual * (1.0 + self.room)) * displaced, self.stress * self.whole - self.virtual * self.push],
                  [-self.virtual * (1.0 + self.room) * displaced, 1.0 + self.virtual * self.push]]
        right = [s.weight() - drag + self.stress * stress_of_wake + self.virtual * slowing, drag - self.virtual * slowing]
        return np.linalg.solve(matrix, right)


def _moved(grain, waves, v, a, rate, push, slip, dt):
    """(v, A) after dt with these rates held: (1) exactly."""
    z = (grain.nu * waves.square + 1j * waves.turn * slip) * dt
    return v + dt * rate, a * np.exp(-z) - push * dt * np.expm1(-z) / z


def two_way(sphere, box, forces, times, start=0.0, steps=600):
    """Fall [nt] at increasing times that may begin with 0, from the speed `start` in fluid at rest. Second order in the step (Heun): 400 steps
    to six relaxation times are good to 1e-5 of the speed after a tenth of them."""
    waves = modes(box)
    grain, dt = _Grain(sphere, waves, forces), times[-1] / steps
    v, a = start, np.zeros(len(waves.share), complex)
    t, speed, found = np.linspace(0.0, times[-1], steps + 1), [v], [grain.gathered(v, a)]
    for _ in range(steps):
        rate, push = grain.rates(v, a)
        slip = v - found[-1]
        v_next, a_next = _moved(grain, waves, v, a, rate, push, slip, dt)
        rate_end, push_end = grain.rates(v_next, a_next)
        slip_end = v_next - grain.gathered(v_next, a_next)
        means = (0.5 * (rate + rate_end), 0.5 * (push + push_end), 0.5 * (slip + slip_end))
        v, a = _moved(grain, waves, v, a, *means, dt)
        speed.append(v)
        found.append(grain.gathered(v, a))
    return Fall(np.interp(times, t, speed), np.interp(times, t, found))
