"""Tests of the references of the cases that fail on purpose: limits, and agreement with the other references."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT))

from theory import sph_operators  # noqa: E402
from verification_case import case  # noqa: E402


def scene(initial, size=(1.0, 1.0), **fluid):
    standard = {"density": 1.0, "viscosity": 0.01, "spacing": 0.05, "smoothing": 1.5, "kernel": "wendland_c2",
                "sound_speed": 10.0, "arrange": {"law": "lattice"}}
    return {"domain": {"size": list(size)}, "fluid": {**standard, **fluid, "initial": initial}}


def tension(pressure, **fluid):
    return case("negative_pressure").Lattice(scene({"law": "uniform_pressure", "pressure": pressure}, **fluid))


# A wrong sign or factor of sound or viscosity in the lattice's matrix: without pressure it is the mode of sound_wave.
def test_lattice_without_tension_carries_the_sound_of_the_sums():
    lattice, k = tension(0.0), np.array([[2.0 * math.pi, 0.0]])
    damping = 0.5 * 0.01 * k[0, 0] ** 2 * sph_operators.lattice_viscosity("wendland_c2", k[0], 0.075, 0.05)
    g = sph_operators.lattice_gradient("wendland_c2", k[0], 0.075, 0.05)[0]
    found = np.linalg.eigvals(lattice.matrices(k)[0])
    wave = found[found.imag > 1.0][0]
    assert wave.real == pytest.approx(-damping, rel=1e-6)
    assert wave.imag == pytest.approx(math.sqrt((10.0 * g) ** 2 - damping**2), rel=1e-6)


# The elasticity of the kernel with the wrong sign: tension grows, pressure of the same size does not, at the edge of the zone.
def test_rows_pair_under_tension_only():
    edge = np.array([[math.pi / 0.05, 0.0]])
    rates = {p: np.linalg.eigvals(tension(p).matrices(edge)[0]).real.max() for p in (-1.0, 1.0)}
    assert rates[-1.0] > 1.0 and rates[1.0] < 1e-9


# The energy of one mode by hand: displacements of the zone edge, started at rest, follow cosh when nothing damps them.
def test_energy_of_an_undamped_pairing_mode():
    lattice = tension(-1.0, viscosity=0.0)
    sites = np.arange(20)
    xi = np.zeros((400, 2))
    xi[:, 0] = 1e-5 * np.tile((-1.0) ** sites, 20)  # ids run along x first
    rate = np.linalg.eigvals(lattice.matrices(np.array([[math.pi / 0.05, 0.0]]))[0]).real.max()
    t = np.array([0.01, 0.03])
    np.testing.assert_allclose(lattice.kinetic_energy(t, xi), 0.5 * (1e-5 * rate * np.sinh(rate * t)) ** 2, rtol=1e-6)


def test_pairs_are_closer_under_more_tension_and_collapse():
    distances = [tension(p).paired_distance() for p in (-0.1, -1.0, -2.0)]
    assert 1.0 > distances[0] > distances[1] > distances[2] > 0.0
    assert tension(-8.0).paired_distance() == 0.0


# The network on a lattice is the lattice's sum; on any points it conserves momentum.
def test_network_on_a_lattice_decays_at_the_lattice_rate():
    case_ = case("disorder")
    one = scene({"law": "shear_wave", "speed": 1.0, "waves": 1}, viscosity=0.1)
    site = (np.arange(20) + 0.5) / 20
    x = np.stack(np.meshgrid(site, site, indexing="ij"), axis=-1).reshape(-1, 2)
    network = case_.Network(one, x)
    k = np.array([0.0, 2.0 * math.pi])
    rate = 0.1 * k[1] ** 2 * sph_operators.lattice_viscosity("wendland_c2", k, 0.075, 0.05)
    u = network.velocity(0.1)
    assert case_.amplitude(k[1], x[:, 1], u) == pytest.approx(math.exp(-0.1 * rate), rel=1e-9)
    assert case_.noise(k[1], x[:, 1], u) < 1e-9
    off = case_.Network(one, x + np.random.default_rng(3).uniform(-0.02, 0.02, x.shape))
    assert np.mean(off.velocity(0.1)) == pytest.approx(np.mean(np.sin(k[1] * off.x[:, 1])), abs=1e-12)


# The compressible flow tends to the incompressible one with Ma^2; its density is that of the pressure.
def test_compressible_vortex_tends_to_the_incompressible_one():
    low = case("low_sound_speed")
    found = [low.compressibility(scene({"law": "taylor_green", "speed": 1.0}, sound_speed=c), 0.1) for c in (5.0, 10.0, 20.0)]
    assert 3.0 < found[0] / found[2] < 64.0 and found[2] < 1e-3
    one = scene({"law": "taylor_green", "speed": 1.0}, sound_speed=20.0)
    assert np.std(low.solved(one, 0.1).state[2]) == pytest.approx(low.Vortex(one).density_rms(0.1), rel=0.02)


# Limits of the compression: no pressure, and sound.
def test_held_up_compression():
    low = case("low_sound_speed")
    wave = scene({"law": "sound_wave", "speed": 1e-4}, viscosity=10.0, sound_speed=1e-3)
    assert low.HeldUp(wave, physical=True).held_up(1.0) == pytest.approx(1.0, abs=1e-6)
    fast = low.HeldUp(scene({"law": "sound_wave", "speed": 1e-4}, viscosity=1e-6, sound_speed=10.0), physical=True)
    t, k = 0.013, 2.0 * math.pi
    assert fast.held_up(t) == pytest.approx(1e-6 * k / 10.0 * math.sin(10.0 * k * t), rel=1e-3)
