"""Limits of theory/grid_fall.py: creeping flow in a cubic box, no viscosity at all, nothing that pushes."""

import math

import numpy as np
import pytest
from drag_laws.drag_laws import ONE_SPHERE
from theory import grid_fall, grid_wake, hasimoto
from theory.released_sphere import Sphere, speed_without_history


def test_transform_of_the_gaussian():
    """1 at 0; exp(-(k w)^2/2) but for what is cut off beyond 3.5 deviations, .7 % of the kernel."""
    kw = np.array([0.0, 0.5, 1.0, 2.0])
    assert grid_wake.transform("gaussian", kw) == pytest.approx(np.exp(-0.5 * kw**2), abs=0.007)
    assert grid_wake.transform("gaussian", 0.0) == pytest.approx(1.0, abs=1e-14)


def test_creeping_wake_in_a_cubic_box():
    """d/(2 sqrt(pi) w) less Hasimoto's images of Stokes' speed, for cells half as wide as the kernel: friction sin(x)^2/x^2 there is 2 % low at
    the shortest waves that count, the cut-off kernel .7 % narrower."""
    d, w, size = 1e-3, 1e-3, 16e-3
    sphere = Sphere(ONE_SPHERE["stokes"], 1001.0, d, 1000.0, 10.0)  # Re 5e-9
    end = 3.0 * (size / (2.0 * math.pi)) ** 2 / 0.01  # the longest wave has settled
    found = grid_fall.two_way(sphere, grid_fall.Box((size,) * 3, 0.5 * w, w), ("buoyancy",), np.array([0.0, end]), sphere.terminal_speed(), 400)
    expected = d / w / (2.0 * math.sqrt(math.pi)) - 3.0 * math.pi * d * (hasimoto.POINT_LATTICE / (6.0 * math.pi * size) - 6.0 * w**2 / (9.0 * size**3))
    room = math.pi / 6.0 * d**3 / (8.0 * math.pi**1.5 * w**3) / 3.0
    slip = sphere.terminal_speed()
    wake = found.u[-1] + room * found.v[-1]
    assert wake / slip == pytest.approx(expected, rel=0.03)
    assert found.v[-1] == pytest.approx(slip + found.u[-1], rel=1e-3)


def test_wake_without_viscosity():
    """(C_D/64) (d/w)^2 at a constant push, once far gone from the start; the box returns what passes the plane of the sphere, half of (pi/8) C_D (d/W)^2."""
    d, w = 1e-3, 2e-3
    sphere = Sphere(lambda re: 0.4 / 24.0 * re, 1e6, d, 1000.0, 1e-6)  # too heavy to change its speed on the way
    start, width = sphere.terminal_speed(), 24.0 * w
    box = grid_fall.Box((width, width, 48.0 * w), w, w)
    found = grid_fall.two_way(sphere, box, ("buoyancy",), np.array([0.0, 16.0 * w / start]), start, 400)
    room = math.pi / 6.0 * d**3 / (8.0 * math.pi**1.5 * w**3) / 3.0
    expected = 0.4 / 64.0 * (d / w) ** 2 - 0.5 * math.pi / 8.0 * 0.4 * (d / width) ** 2
    assert found.u[-1] / start + room == pytest.approx(expected, rel=0.08)


def test_a_vanishing_sphere_falls_by_its_law():
    """With a kernel of 50 diameters nothing of the own push is left: drag and virtual mass alone, to 1e-4."""
    sphere = Sphere(ONE_SPHERE["schiller_naumann"], 2560.0, 5e-4, 997.0, 9e-4)
    times, w = np.linspace(0.0, 0.2, 21), 0.025
    found = grid_fall.two_way(sphere, grid_fall.Box((16 * w, 16 * w, 16 * w), w, w), ("buoyancy", "pressure_gradient", "virtual_mass"), times)
    assert found.v == pytest.approx(speed_without_history(sphere, times, True), abs=1e-4 * sphere.terminal_speed())


def test_virtual_mass_of_an_inviscid_wake():
    """A push that begins in fluid at rest without viscosity sets it in motion by rho a = (2/3) F/(8 pi^(3/2) w^3): two thirds of a force are without
    divergence. It carries the grain by half of that on its volume, which it has of its own push."""
    d, w = 1e-3, 2e-3
    sphere = Sphere(lambda re: 0.4 / 24.0 * re, 1e6, d, 1000.0, 1e-9)
    size = 24.0 * w
    start, times = sphere.terminal_speed(), np.array([0.0, 1e-6])
    fall = [grid_fall.two_way(sphere, grid_fall.Box((size,) * 3, 0.5 * w, w), forces, times, start, 2) for forces in (("buoyancy",), ("buoyancy", "virtual_mass"))]
    share = math.pi / 6.0 * d**3 / (8.0 * math.pi**1.5 * w**3)
    carried = 0.5 * (2.0 / 3.0) * share * float(sphere.drag(start))  # N
    without, found = ((one.v[-1] - start) / times[-1] * sphere.volume() * sphere.rho_p for one in fall)
    assert found - without == pytest.approx(carried, rel=0.05)
