"""Tests of the resistance of a lattice of smoothed particles under pressure to shear, and of a wake that feels it."""

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT))

from theory import self_disturbance, self_disturbance_history, sph_operators  # noqa: E402
from theory.self_disturbance import Fluid, Modes, one_kernel  # noqa: E402

KERNEL, UP = "wendland_c2", (0.0, 0.0, 1.0)


def force_on_displaced(k, polarisation, h, spacing, size):
    """-2 sum V grad W at the origin, [3], when every particle of a cubic lattice is displaced by size polarisation cos(k.x)."""
    x = spacing * sph_operators._lattice(sph_operators.support(KERNEL) * h / spacing + 1.0, 3)
    apart = size * polarisation - (x + size * np.outer(np.cos(x @ k), polarisation))  # x_a - x_b
    r = np.linalg.norm(apart, axis=1)
    kernel = sph_operators.KERNELS[KERNEL]
    slope = kernel.sigma[3] / h**4 * kernel.slope(np.minimum(r / h, 2.0))
    return -2.0 * spacing**3 * (slope / r) @ apart


@pytest.mark.parametrize("k", [(1.3, 0.0, 0.4), (0.7, 0.9, 0.0), (0.2, -0.5, 1.1)])
def test_stiffness_is_the_force_on_displaced_particles(k):
    k, h, spacing, size = np.array(k), 1.0, 1.0 / 1.5, 1e-5
    shear = np.array(UP) - k * k[2] / (k @ k)
    shear = shear / np.linalg.norm(shear)
    change = [force_on_displaced(k, shear, h, spacing, sign * size) for sign in (1.0, -1.0)]
    expected = -(change[0] - change[1]) @ shear / (2.0 * size)
    assert sph_operators.lattice_stiffness(KERNEL, [k], UP, h, spacing)[0] == pytest.approx(expected, rel=1e-4, abs=1e-7)


def test_shear_of_many_neighbours_feels_no_pressure():
    k = np.array([[0.6, 0.3, 0.5]])
    """The kernel's transform falls with the sixth power at the lattice's own wave numbers, and the stiffness takes two more of them:
    about the fourth power of h/spacing. The third is asked for."""
    numbers = (1.5, 3.0, 5.0)
    found = [abs(sph_operators.lattice_stiffness(KERNEL, k, UP, 1.0, 1.0 / n)[0]) for n in numbers]
    for coarse, fine, ratio in zip(found, found[1:], (1.5 / 3.0, 3.0 / 5.0)):
        assert fine < ratio**3 * coarse


def test_a_push_along_the_wave_moves_nothing_across():
    assert sph_operators.lattice_stiffness(KERNEL, [[0.0, 0.0, 1.0]], UP, 1.0, 0.6)[0] == 0.0


@pytest.mark.parametrize("stiffness", [0.0, 0.05, 3.0, -0.2])
def test_elastic_memory_against_its_equation(stiffness):
    """Overdamped, oscillating and growing waves; da/dt = F - lambda a - K Int a dt."""
    scheme, fluid = one_kernel(KERNEL, 0.5), Fluid(2.0, 0.5)
    modes = Modes(np.array([1.5]), np.array([0.3]), np.array([0.7]))
    memory = self_disturbance_history.ElasticMemory(modes, scheme, fluid, np.array([stiffness]))
    rate, share = self_disturbance.decay_rate(scheme, fluid, modes.k)[0], 0.7 * (1.0 - 0.3**2)

    def equation(t, y):
        return [np.cos(t) - rate * y[0] - stiffness * y[1], y[0]]

    times = np.linspace(0.0, 4.0, 2001)
    path = solve_ivp(equation, (0.0, 4.0), [0.0, 0.0], t_eval=times, rtol=1e-10, atol=1e-13).y
    for k in range(1, len(times)):
        gathered, more = memory.past(times[k] - times[k - 1], 0.0, np.cos(times[k - 1]))
        memory.close(np.cos(times[k]))
    velocity, stress = gathered + more * np.cos(times[-1])
    assert velocity == pytest.approx(share / fluid.rho * path[0, -1], rel=1e-5)
    assert stress == pytest.approx(share * (rate * path[0, -1] + stiffness * path[1, -1]), rel=1e-5)


def test_without_stiffness_it_is_the_plain_memory():
    scheme, fluid = one_kernel(KERNEL, 1.0), Fluid(1.0, 0.3)
    modes = self_disturbance.box_modes(scheme, (6.0, 6.0, 6.0))
    plain = self_disturbance_history.Memory(modes, scheme, fluid)
    elastic = self_disturbance_history.ElasticMemory(modes, scheme, fluid, np.zeros(len(modes.k)))
    for force in (1.0, 2.0, 0.5):
        for memory in (plain, elastic):
            memory.past(0.4, 0.2, force)
            memory.close(force)
    assert elastic.past(0.1, 0.0, 0.0)[0] == pytest.approx(plain.past(0.1, 0.0, 0.0)[0], rel=1e-9)
    assert elastic.longitudinal == pytest.approx(plain.longitudinal)
