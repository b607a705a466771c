"""References of the fluid on a grid: manufactured medium, porous channels, arrays of cylinders with inertia."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))

from theory import cylinder_arrays, inertial_arrays, manufactured_medium, porous_flow  # noqa: E402

LAW = {"speed": 1.3, "porosity": {"mean": 0.65, "amplitude": 0.1, "waves": [2, 1], "period": 0.7}}


def flow():
    return manufactured_medium.ManufacturedMedium(LAW, length=1.0, density=2.0, viscosity=0.05)


def test_manufactured_medium_keeps_mass():
    made = flow()
    x, y = made.grid(64)
    for t in (0.0, 0.13):
        u, eps = made.velocity(x, y, t), made.porosity(x, y, t)
        loss = made.rate(lambda s: made.porosity(x, y, s), t) + sum(made.along(eps * u[i], i, 1) for i in (0, 1))
        assert np.abs(loss).max() < 1e-7 * np.abs(made.rate(lambda s: made.porosity(x, y, s), t)).max()


def test_manufactured_source_by_differences():
    """The source at one point from central differences of the fields alone."""
    made, h, t = flow(), 1e-4, 0.2
    x, y = made.grid(64)
    at = (11, 37)
    here = np.array([x[at], y[at]])
    beta = manufactured_medium.ergun(0.6)
    u = lambda p, s=t: np.array(made.velocity(p[0], p[1], s))  # noqa: E731
    eps = lambda p: made.porosity(p[0], p[1], t)  # noqa: E731
    e = np.eye(2) * h
    slope = [(u(here + e[j]) - u(here - e[j])) / (2 * h) for j in (0, 1)]
    rate = (u(here, t + h) - u(here, t - h)) / (2 * h)
    friction = sum(eps(here + e[j] / 2) * (u(here + e[j]) - u(here)) - eps(here - e[j] / 2) * (u(here) - u(here - e[j])) for j in (0, 1)) / h**2
    pressure = np.array([(made.pressure(*(here + e[j]), t) - made.pressure(*(here - e[j]), t)) / (2 * h) for j in (0, 1)])
    resistance = beta(eps(here), np.linalg.norm(u(here)), 2.0, 0.05) * u(here) / eps(here)
    expected = rate + u(here)[0] * slope[0] + u(here)[1] * slope[1] + (pressure - 0.05 * friction / eps(here) + resistance) / 2.0
    found = [s[at] for s in manufactured_medium.source(made, beta, x, y, t)]
    assert np.allclose(found, expected, rtol=1e-5)


def test_truncation_is_that_of_central_differences():
    """A wave alone: u d3u/6 of central differences, against the differences themselves."""
    made = flow()
    x, _ = made.grid(96)
    k, h = 2.0 * math.pi, 1e-3
    exact = k * np.cos(k * x)
    central = (np.sin(k * (x + h)) - np.sin(k * (x - h))) / (2 * h)
    assert np.allclose(central - exact, h**2 / 6.0 * made.along(np.sin(k * x), 0, 3), atol=1e-8)


def test_resistances_give_their_laws():
    """-eps grad p = beta u, with the superficial velocity by hand: Ergun as in test_grid.cpp, 10 Pa/m at U = 1."""
    beta = porous_flow.ergun(1.0)(0.5, 2.0, 1.0, 0.01)
    assert beta * 2.0 / 0.5 == pytest.approx(150.0 * 0.01 * 0.25 / 0.125 + 1.75 * 0.5 / 0.125)
    assert porous_flow.darcy(1e-3)(0.5, 0.0, 1.0, 0.01) * 0.2 / 0.5 == pytest.approx(0.01 / 1e-3 * 0.1)
    k = 0.2**2 * 0.5**3 / (180.0 * 0.25)
    assert porous_flow.kozeny_carman(0.2)(0.5, 0.0, 1.0, 0.01) == pytest.approx(porous_flow.darcy(k)(0.5, 0.0, 1.0, 0.01))
    assert manufactured_medium.ergun(0.3)(0.4, 1.7, 1.2, 0.02) == pytest.approx(porous_flow.ergun(0.3)(0.4, 1.7, 1.2, 0.02))


def test_layered_flow():
    """Uniform eps gives Brinkman's profile; without resistance and with eps = 1 it is the parabola."""
    y = np.linspace(0.0, 1.0, 41)
    made = porous_flow.Layered(1.0, 1.0, 1.0, 0.1, lambda at: np.full_like(at, 0.5), porous_flow.darcy(0.005))
    assert np.allclose(made.velocity(y), porous_flow.brinkman(y, 1.0, 1.0, 1.0, 0.1, 0.005, 0.5), atol=1e-13)
    free = porous_flow.Layered(1.0, 1.0, 1.0, 0.1, lambda at: np.ones_like(at), lambda *_: np.zeros(81))
    assert np.allclose(free.velocity(y), 5.0 * y * (1.0 - y), atol=1e-12)
    varied = [porous_flow.Layered(1.0, 1.0, 1.0, 0.1, lambda at: 0.3 + 0.4 * at, porous_flow.kozeny_carman(1.5), n) for n in (60, 90)]
    assert np.allclose(*(made.velocity(y) for made in varied), atol=1e-12)


def test_plug_without_a_change_is_darcy():
    made = porous_flow.Plug(2.0, 0.5, 0.5, 0.3, 1.0, 0.01, porous_flow.darcy(1e-3))
    assert made.pressure([2.0])[0] == pytest.approx(-2.0 * 0.01 / 1e-3 * 0.3)
    changing = porous_flow.Plug(1.0, 0.9, 0.4, 0.9, 1.0, 0.0, lambda *_: 0.0)  # Bernoulli
    assert changing.pressure([1.0])[0] == pytest.approx(0.5 * (1.0 - (0.9 / 0.4) ** 2))


@pytest.mark.parametrize("array, fraction", [("square", 0.2), ("square", 0.4), ("hexagonal", 0.4)])
def test_spectral_elements_meet_creeping_flow(array, fraction):
    """Sangani and Acrivos' force by another method altogether: area/K, for forces along and between the sides' normals."""
    expected = cylinder_arrays.force(fraction, array)
    area = inertial_arrays.Cell(array, fraction, 3).area
    for angle in (0.0, 0.3):
        assert area / inertial_arrays.permeability(array, fraction, 0.0, angle, degree=7) == pytest.approx(expected, rel=2e-6)


def test_inertia_starts_with_the_square_of_the_reynolds_number():
    """K = K_0 (1 - c Re^2) for small Re (Koch & Ladd 1997, J. Fluid Mech. 349, 31): the drag is odd in U."""
    rest, slow, fast = (inertial_arrays.permeability("square", 0.2, force, 0.0, 5) for force in (0.0, 50.0, 100.0))
    assert 0.0 < slow < rest
    assert (rest - fast) / (rest - slow) == pytest.approx(4.0, abs=0.1)


def test_inertial_degrees_agree():
    coarse, fine = (inertial_arrays.permeability("square", 0.3, 1000.0, 0.0, degree) for degree in (5, 7))
    assert coarse == pytest.approx(fine, rel=2e-4)
