"""Tests of verification/mms: residuals by finite differences, the formulas of its README, an independent derivation."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT))

from theory import tait  # noqa: E402
from verification_case import case  # noqa: E402

LENGTH, SPEED, RHO, C, NU = 0.7, 1.3, 900.0, 13.0, 0.02


def made(divergence=0.3):
    fluid = {"density": RHO, "viscosity": RHO * NU, "sound_speed": C, "initial": {"speed": SPEED, "divergence": divergence}}
    scene = {"domain": {"size": [LENGTH, LENGTH]}, "fluid": fluid}
    return case("mms").Manufactured(scene), scene


def stencil(function, x, t, axis, order):
    """Fourth-order central difference along x (0), y (1) or t (2)."""
    step = 2e-4
    shift = np.eye(3)[axis] * step
    f = {m: function(x + m * shift[:2], t + m * shift[2]) for m in (-2, -1, 0, 1, 2)}
    if order == 1:
        return (f[-2] - 8 * f[-1] + 8 * f[1] - f[2]) / (12 * step)
    return (-f[-2] + 16 * f[-1] - 30 * f[0] + 16 * f[1] - f[2]) / (12 * step**2)


@pytest.mark.parametrize("divergence", [0.0, 0.3])
@pytest.mark.parametrize("t", [0.0, 0.21])
def test_sources_close_the_equations(divergence, t):
    flow, _ = made(divergence)
    x = LENGTH * np.random.default_rng(5).random((50, 2))
    v, rho = flow.velocity(x, t), flow.density(x, t)
    carried = lambda f: stencil(f, x, t, 2, 1) + sum(  # noqa: E731
        v[:, d].reshape((-1,) + (1,) * (f(x, t).ndim - 1)) * stencil(f, x, t, d, 1) for d in (0, 1))
    div = stencil(flow.velocity, x, t, 0, 1)[:, 0] + stencil(flow.velocity, x, t, 1, 1)[:, 1]
    np.testing.assert_allclose(flow.divergence(x, t), div, atol=1e-6)
    np.testing.assert_allclose(carried(flow.density), -rho * div + flow.density_source(x, t), atol=1e-4)
    pressure = np.stack([stencil(flow.pressure, x, t, d, 1) for d in (0, 1)], axis=1) / rho[:, None]
    viscous = RHO * NU / rho[:, None] * (stencil(flow.velocity, x, t, 0, 2) + stencil(flow.velocity, x, t, 1, 2))
    np.testing.assert_allclose(carried(flow.velocity), -pressure + viscous + flow.momentum_source(x, t), atol=2e-5)
    np.testing.assert_allclose(tait.pressure(rho, RHO, C), flow.pressure(x, t), rtol=1e-10, atol=1e-8)
    if divergence == 0.0:
        assert np.abs(flow.divergence(x, t)).max() < 1e-12 * flow.k * SPEED
    else:
        assert np.abs(flow.density_source(x, t)).max() > 0.5 * RHO * flow.k * SPEED


def test_fields_are_the_formulas_of_the_readme():
    flow, _ = made(0.3)
    x, t = LENGTH * np.random.default_rng(6).random((20, 2)), 0.4
    a, b, d, k = *(2 * math.pi * x / LENGTH).T, 0.3, 2 * math.pi / LENGTH
    c, s = math.cos(k * SPEED * t), math.sin(k * SPEED * t)
    swing = (0.5 + s) * np.sin(a - 2 * b)
    u = np.sin(a) * np.cos(b) - c * np.sin(2 * a + b) / 2 - d * swing
    v = -np.cos(a) * np.sin(b) + c * np.sin(2 * a + b) + 2 * d * swing
    np.testing.assert_allclose(flow.velocity(x, t), SPEED * np.stack([u, v], axis=1), atol=1e-12)
    p = (np.cos(2 * a) + np.cos(b)) / 4 + s * np.sin(a + 2 * b) / 2
    np.testing.assert_allclose(flow.pressure(x, t), RHO * SPEED**2 * p, atol=1e-9)
    np.testing.assert_allclose(flow.divergence(x, t), -5 * d * SPEED * k * (0.5 + s) * np.cos(a - 2 * b), atol=1e-11)


def test_a_carried_particle_keeps_the_exact_density_and_velocity():
    """Dx/Dt = v, D rho/Dt = -rho div v + s_rho, Dv/Dt = -grad p/rho + nu lap v + s_v along exact fields, Runge-Kutta 4."""
    flow, _ = made(0.05)
    x = LENGTH * np.random.default_rng(7).random((6, 2))
    y, t, step = np.column_stack([x, flow.density(x, 0.0)]), 0.0, 1e-3

    def rates(y, t):
        x, rho = y[:, :2], y[:, 2]
        return np.column_stack([flow.velocity(x, t), -rho * flow.divergence(x, t) + flow.density_source(x, t)])

    for _ in range(300):
        a = rates(y, t)
        b = rates(y + step / 2 * a, t + step / 2)
        c = rates(y + step / 2 * b, t + step / 2)
        y, t = y + step / 6 * (a + 2 * b + 2 * c + rates(y + step * c, t + step)), t + step
    np.testing.assert_allclose(y[:, 2], flow.density(y[:, :2], t), rtol=1e-7)


def test_sources_against_symbolic_derivation():
    sympy = pytest.importorskip("sympy")
    x, y, t = sympy.symbols("x y t", real=True)
    k = 2 * sympy.pi / sympy.Rational(7, 10)
    speed, rho_0, c_0, nu, d = (sympy.Rational(str(value)) for value in (SPEED, RHO, C, NU, 0.3))
    psi = speed / k * (sympy.sin(k * x) * sympy.sin(k * y) + sympy.cos(k * speed * t) * sympy.cos(2 * k * x + k * y) / 2)
    chi = d * speed / k * (sympy.Rational(1, 2) + sympy.sin(k * speed * t)) * sympy.cos(k * x - 2 * k * y)
    u, v = psi.diff(y) + chi.diff(x), -psi.diff(x) + chi.diff(y)
    p = rho_0 * speed**2 * ((sympy.cos(2 * k * x) + sympy.cos(k * y)) / 4
                            + sympy.sin(k * speed * t) * sympy.sin(k * x + 2 * k * y) / 2)
    rho = rho_0 * (1 + 7 * p / (rho_0 * c_0**2)) ** sympy.Rational(1, 7)
    carried = lambda f: f.diff(t) + u * f.diff(x) + v * f.diff(y)  # noqa: E731
    momentum = [carried(f) + p.diff(q) / rho - rho_0 * nu / rho * (f.diff(x, 2) + f.diff(y, 2)) for f, q in ((u, x), (v, y))]
    formulas = sympy.lambdify((x, y, t), [carried(rho) + rho * (u.diff(x) + v.diff(y)), *momentum])
    flow, _ = made(0.3)
    for place in ((0.11, 0.52), (0.63, 0.07), (0.4, 0.33)):
        expected = formulas(*place, 0.37)
        here = np.array([place])
        assert flow.density_source(here, 0.37)[0] == pytest.approx(expected[0], rel=1e-11)
        np.testing.assert_allclose(flow.momentum_source(here, 0.37)[0], expected[1:], rtol=1e-10)


def test_norms_vanish_for_the_exact_fields_and_scale_with_the_flow():
    reference, (flow, scene) = case("mms"), made()
    x = LENGTH * np.random.default_rng(8).random((30, 2))
    assert max(reference.velocity_norms(scene, x, flow.velocity(x, 0.1), 0.1)["linf"]) == 0.0
    off = reference.density_norms(scene, x, np.full(30, RHO), 0.1)["linf"]
    assert 0.3 < off[0] < 1.1  # the exact variation is of order one in these units


def test_velocity_gradient_and_deformed_lattices():
    from theory import deformed_lattice

    flow, _ = made(0.3)
    x = LENGTH * np.random.default_rng(9).random((10, 2))
    slopes = np.stack([stencil(flow.velocity, x, 0.2, d, 1) for d in (0, 1)], axis=-1)
    np.testing.assert_allclose(flow.velocity_gradient(x, 0.2), slopes, atol=1e-6)
    # a deformation is the derivative of the places by the start
    times, e = np.linspace(0.0, 0.1, 41), 1e-5
    ends, f = deformed_lattice.carried(flow.velocity, flow.velocity_gradient, x, times)
    for axis in (0, 1):
        moved = [deformed_lattice.carried(flow.velocity, flow.velocity_gradient, x + s * e * np.eye(2)[axis], times)[0][-1]
                 for s in (-1, 1)]
        np.testing.assert_allclose(f[-1][:, :, axis], (moved[1] - moved[0]) / (2 * e), atol=1e-6)
    # moments: the unit matrix for many neighbours, turned with the lattice, by a plain double loop
    turn = np.array([[math.cos(0.3), -math.sin(0.3)], [math.sin(0.3), math.cos(0.3)]])
    stretch = np.array([[1.5, 0.1], [0.0, 0.7]])
    many = deformed_lattice.moments("wendland_c2", np.array([stretch / math.sqrt(np.linalg.det(stretch))]), 12.0)[0]
    np.testing.assert_allclose(many, np.eye(2), atol=1e-5)
    m, turned = deformed_lattice.moments("wendland_c2", np.array([stretch, turn @ stretch]), 1.5)
    np.testing.assert_allclose(turned, turn @ m @ turn.T, atol=1e-13)
    total = np.zeros((2, 2))
    for a in range(-9, 10):
        for b in range(-9, 10):
            r = stretch @ [a, b]
            q = np.linalg.norm(r) / 1.5
            if 0 < q < 2:
                gradient = 7 / (4 * math.pi * 1.5**2) * -5 * q * (1 - q / 2) ** 3 / 1.5 * r / np.linalg.norm(r)
                total -= np.outer(r, gradient)
    np.testing.assert_allclose(m, total, atol=1e-13)
