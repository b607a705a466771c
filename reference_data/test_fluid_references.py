"""Tests of the references of the fluid cases: equations recomputed by finite differences, limits, independent solutions."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy import integrate

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT))

from theory import field_errors, sph_operators, tait  # noqa: E402
from verification_case import case  # noqa: E402


def scene(size, initial, gravity=(0.0, 0.0, 0.0), **fluid):
    """The parts of a solved scene that references read."""
    standard = {"density": 1000.0, "viscosity": 1e-3, "spacing": 0.02, "smoothing": 1.5, "kernel": "wendland_c2",
                "sound_speed": 10.0}
    return {"domain": {"size": list(size), "gravity": list(gravity)}, "fluid": {**standard, **fluid, "initial": initial}}


def slope(function, x, axis, step=1e-4):
    """Fourth-order central difference of function(x [n, d]) along an axis."""
    shift = np.zeros(x.shape[1])
    shift[axis] = step
    f = [function(x + m * shift) for m in (-2, -1, 1, 2)]
    return (f[0] - 8.0 * f[1] + 8.0 * f[2] - f[3]) / (12.0 * step)


def curvature(function, x, axis, step=1e-3):
    shift = np.zeros(x.shape[1])
    shift[axis] = step
    f = [function(x + m * shift) for m in (-2, -1, 0, 1, 2)]
    return (-f[0] + 16.0 * f[1] - 30.0 * f[2] + 16.0 * f[3] - f[4]) / (12.0 * step**2)


def points(count=40, d=2, seed=3):
    return np.random.default_rng(seed).random((count, d))


# --- shared theory ---


def test_tait_is_inverted_and_has_its_sound_speed():
    rho = np.array([990.0, 1000.0, 1013.0])
    np.testing.assert_allclose(tait.density(tait.pressure(rho, 1000.0, 20.0), 1000.0, 20.0), rho, rtol=1e-14)
    slope_ = (tait.pressure(rho + 1e-3, 1000.0, 20.0) - tait.pressure(rho - 1e-3, 1000.0, 20.0)) / 2e-3
    np.testing.assert_allclose(np.sqrt(slope_), tait.sound_speed(rho, 1000.0, 20.0), rtol=1e-7)
    work = integrate.quad(lambda r: tait.sound_speed(r, 1000.0, 20.0) ** 2 / r, 1000.0, 1013.0)[0]
    assert tait.enthalpy(1013.0, 1000.0, 20.0) == pytest.approx(work, rel=1e-10)


KERNEL_CASES = [(name, d) for name, kernel in sph_operators.KERNELS.items() for d in kernel.sigma]


@pytest.mark.parametrize("kernel, d", KERNEL_CASES)
def test_kernels_are_normalised_and_their_slopes_are_derivatives(kernel, d):
    assert sph_operators.moment(kernel, d, 0) == pytest.approx(1.0, abs=1e-13)
    chosen = sph_operators.KERNELS[kernel]
    q = np.linspace(0.05, chosen.knots[-1] - 0.04, 23)
    central = (chosen.w(q + 1e-6) - chosen.w(q - 1e-6)) / 2e-6
    np.testing.assert_allclose(chosen.slope(q), central, atol=1e-7 * chosen.w(0.0))


@pytest.mark.parametrize("kernel, d", KERNEL_CASES)
def test_viscous_symbol_of_long_waves(kernel, d):
    kh = 0.05
    lack = 1.0 - sph_operators.viscosity_ratio(kernel, d, kh)
    assert lack == pytest.approx(kh**2 * sph_operators.moment(kernel, d) / (4 * d), rel=3e-4)  # next term O(kh^4)
    lack = 1.0 - sph_operators.transform(kernel, d, kh)
    assert lack == pytest.approx(kh**2 * sph_operators.moment(kernel, d) / (2 * d), rel=1e-3)


@pytest.mark.parametrize("kernel", sph_operators.KERNELS)
def test_symbols_against_dense_lattices(kernel):
    """Many neighbours in the plane and in space, the wave oblique: the direct sums tend to the integrals."""
    for d, h in ((2, 8.0), (3, 4.0)):
        k = np.array([0.8, 0.5, -0.3][:d]) / h
        kh = float(np.linalg.norm(k)) * h
        ratio = sph_operators.lattice_viscosity(kernel, k, h, 1.0)
        assert ratio == pytest.approx(sph_operators.viscosity_ratio(kernel, d, kh), rel=1e-4)
        np.testing.assert_allclose(sph_operators.lattice_gradient(kernel, k, h, 1.0),
                                   sph_operators.transform(kernel, d, kh) * k, rtol=1e-4)


def test_symbol_of_the_wendland_kernel_in_space_by_hand():
    """-W'/r = (21/16 pi)(5/h^5)(1-q/2)^3: Int of it (1 - sin z/z) 4 pi r^2 dr at kh = 2 by adaptive quadrature."""
    value = integrate.quad(lambda q: 5 * (1 - q / 2) ** 3 * (1 - np.sinc(2 * q / math.pi)) * q**2, 0, 2)[0]
    assert sph_operators.viscosity_ratio("wendland_c2", 3, 2.0) == pytest.approx(2 * 21 / 4 * value / 4.0, rel=1e-12)


# --- taylor_green ---


VORTEX = scene([1.0, 1.0], {"law": "taylor_green", "speed": 1.0}, viscosity=10.0)


@pytest.mark.parametrize("kernel", sph_operators.KERNELS)
def test_central_viscosity_on_a_shear_wave_is_its_sum(kernel):
    """The direction mean and the constant 10, against a lattice fine enough to be an integral; the softening is 0.01 h^2."""
    h, spacing = 1.0, 0.125
    chosen = sph_operators.KERNELS[kernel]
    x = spacing * sph_operators._lattice(sph_operators.support(kernel) * h / spacing, 3)
    r = np.linalg.norm(x, axis=1)
    force = -chosen.sigma[3] * chosen.slope(r / h) / r * x[:, 2] ** 2 / (r**2 + 0.01 * h**2)
    for k in (0.3, 1.0, 2.5):
        whole = 10.0 * spacing**3 * np.sum(force * (1.0 - np.cos(k * x[:, 0]))) / k**2
        assert whole == pytest.approx(sph_operators.central_shear_ratio(kernel, k * h), rel=2e-3)
    assert sph_operators.central_shear_ratio(kernel, 1e-3) == pytest.approx(sph_operators.central_shear_ratio(kernel, 2e-2), rel=1e-3)


def test_taylor_green_solves_the_navier_stokes_equations():
    vortex = case("taylor_green").Vortex(VORTEX)
    assert vortex.reynolds == pytest.approx(100.0)
    x, t = points(), 0.3
    v = lambda y: vortex.velocity(y, t)  # noqa: E731
    np.testing.assert_allclose(slope(v, x, 0)[:, 0] + slope(v, x, 1)[:, 1], 0.0, atol=1e-10)
    rate = (vortex.velocity(x, t + 1e-5) - vortex.velocity(x, t - 1e-5)) / 2e-5
    u = v(x)
    convection = u[:, :1] * slope(v, x, 0) + u[:, 1:] * slope(v, x, 1)
    pressure = np.stack([slope(lambda y: vortex.pressure(y, t), x, axis) for axis in (0, 1)], axis=1) / vortex.rho
    viscous = vortex.nu * (curvature(v, x, 0) + curvature(v, x, 1))
    np.testing.assert_allclose(rate + convection + pressure - viscous, 0.0, atol=1e-8)


def test_taylor_green_energy_is_the_mean_of_the_field():
    vortex = case("taylor_green").Vortex(VORTEX)
    side = (np.arange(16) + 0.5) / 16
    x = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    assert 0.5 * np.mean(np.sum(vortex.velocity(x, 0.7) ** 2, axis=1)) == pytest.approx(vortex.kinetic_energy(0.7))
    assert np.mean(vortex.pressure(x, 0.7)) == pytest.approx(0.0, abs=1e-12)
    assert np.abs(vortex.pressure(points(4000), 0.0)).max() <= 500.0


def test_norms_see_what_the_magnitude_and_the_largest_speed_do_not():
    reference = case("taylor_green")
    vortex, x = reference.Vortex(VORTEX), points(5000)
    exact = vortex.velocity(x, 0.0)
    turned = np.stack([-exact[:, 1], exact[:, 0]], axis=1)
    for wrong in (-exact, turned, np.where(x[:, :1] < 0.25, 0.0, exact)):
        assert np.abs(wrong).max() == pytest.approx(np.abs(exact).max(), rel=2e-3)
        assert min(reference.velocity_norms(VORTEX, x, wrong, 0.0)["l2"]) > 0.2
    assert np.abs(np.linalg.norm(turned, axis=1) - np.linalg.norm(exact, axis=1)).max() < 1e-12
    right = reference.velocity_norms(VORTEX, x, exact, 0.0)
    assert all(np.all(norm == 0.0) for norm in right.values())


def test_norms_of_a_known_error_and_of_what_is_not_finite():
    exact = np.zeros((4, 2))
    measured = np.array([[0.0, 1.0], [0.0, -1.0], [4.0, 1.0], [0.0, 1.0]])
    norms = field_errors.component_norms(measured, exact, 2.0)
    np.testing.assert_allclose(norms["l1"], [0.5, 0.5])
    np.testing.assert_allclose(norms["l2"], [1.0, 0.5])
    np.testing.assert_allclose(norms["linf"], [2.0, 0.5])
    measured[3, 1] = np.nan
    assert field_errors.component_norms(measured, exact, 2.0)["l2"][1] == np.inf


# --- shear_wave ---


def test_shear_wave_decay_and_projection():
    reference = case("shear_wave")
    s = scene([0.4, 1.0], {"law": "shear_wave", "speed": 0.1, "waves": 2}, viscosity=2.0)
    wave = reference.Wave(s)
    x = points(3000)
    rate = (wave.velocity(x, 1.0 + 1e-5) - wave.velocity(x, 1.0 - 1e-5)) / 2e-5
    diffusion = wave.nu * curvature(lambda y: wave.velocity(y, 1.0), x, 1)
    np.testing.assert_allclose(rate, diffusion, atol=1e-8)
    t = np.linspace(0.0, 2.0, 5)
    seen = [reference.amplitude(x, wave.velocity(x, time), wave) for time in t]
    np.testing.assert_allclose(seen, reference.reference("amplitude", s, t), rtol=1e-12)
    assert reference.decay_rate(t, seen) == pytest.approx(wave.rate)


def test_shear_wave_rates_are_ordered():
    reference = case("shear_wave")
    s = scene([1.0, 1.0], {"law": "shear_wave", "speed": 0.1})
    physics, operator, lattice = (reference.reference(q, s, 0.0) for q in ("decay_rate", "decay_rate_operator", "decay_rate_lattice"))
    assert lattice < operator < physics
    kh = 2 * math.pi * 0.03
    assert 1.0 - operator / physics == pytest.approx(kh**2 * (5 / 9) / 8, rel=0.01)


# --- sound_wave ---


def sound_scene(kind="standing", **fluid):
    initial = {"law": "sound_wave", "speed": 1e-3, "kind": kind}
    return scene([1.0, 1.0], initial, **{"density": 1.0, "viscosity": 2e-3, "sound_speed": 1.0, **fluid})


def runge_kutta(rates, y, step, count):
    """Classical fourth order; yields y after every step."""
    for _ in range(count):
        a = rates(y)
        b = rates(y + 0.5 * step * a)
        c = rates(y + 0.5 * step * b)
        y = y + step / 6.0 * (a + 2.0 * b + 2.0 * c + rates(y + step * c))
        yield y


@pytest.mark.parametrize("kind", ["standing", "travelling"])
def test_sound_wave_against_the_nonlinear_equations(kind):
    """Fourier collocation of drho/dt = -(rho u)', du/dt = -u u' - p'/rho + nu u''; two wave periods."""
    sound = case("sound_wave").Sound(sound_scene(kind))
    n, periods = 48, 2.0
    x = np.arange(n) / n
    wave = 2j * math.pi * np.fft.rfftfreq(n, 1.0 / n) * (np.arange(n // 2 + 1) < n / 3)
    d = lambda f: np.fft.irfft(wave * np.fft.rfft(f))  # noqa: E731

    def rates(y):
        u, rho = y
        return np.stack([-u * d(u) - rho**5 * d(rho) + sound.nu * d(d(u)), -d(rho * u)])  # p'/rho = c^2 rho^5 rho' at c = rho_0 = 1

    *_, (u, rho) = runge_kutta(rates, np.stack(sound.fields(x, 0.0)[:2]), periods / 240, 240)
    linear, density, _ = sound.fields(x, periods)
    second = 2.0 * abs(np.fft.rfft(u)[2]) / n / sound.speed
    assert second == pytest.approx(sound.second_harmonic(periods), rel=2e-3)
    first = np.fft.irfft(np.fft.rfft(u) * (np.arange(n // 2 + 1) < 2))
    assert np.abs(first - linear).max() < 1e-3 * sound.speed  # O(second^2)
    assert np.abs(u - linear).max() == pytest.approx(second * sound.speed, rel=0.05)
    assert np.abs(rho - density).max() < 1.1 * second * sound.speed  # Ma rho_0 = speed


def chain_rates(kernel, h, spacing, nu, background):
    """Right-hand side of one-dimensional SPH, y = (x, v, rho): Tait with c = rho_0 = 1, Morris' viscosity, a ring of length 1."""
    chosen = sph_operators.KERNELS[kernel]

    def rates(y):
        x, v, rho = y
        gap = x[:, None] - x[None]
        gap -= np.round(gap)
        pull = chosen.sigma[1] / h**2 * chosen.slope(np.abs(gap) / h) * np.sign(gap)
        over = np.divide(pull * np.sign(gap), np.abs(gap), out=np.zeros_like(gap), where=gap != 0.0)
        slip = v[:, None] - v[None]
        p = (background + tait.pressure(rho, 1.0, 1.0)) / rho**2
        push = -(p[:, None] + p[None]) * pull + 2.0 * nu / np.outer(rho, rho) * over * slip
        return np.stack([v, spacing * push.sum(axis=1), spacing * rho * (slip / rho * pull).sum(axis=1)])

    return rates


@pytest.mark.parametrize("background", [0.0, 0.3])
def test_dispersion_of_sph_against_a_chain_of_particles(background):
    reference = case("sound_wave")
    n, nu = 24, 0.01
    sound = reference.Sound(sound_scene(viscosity=nu, spacing=1 / n, smoothing=2.0, kernel="quintic_spline",
                                        background_pressure=background))
    x = (np.arange(n) + 0.5) / n
    start = np.stack([x, 1e-6 * np.sin(sound.k * x), np.ones(n)])
    step, count = 1 / 400, 500
    path = runge_kutta(chain_rates("quintic_spline", 2.0 / n, 1 / n, nu, background), start, step, count)
    seen = [reference.amplitudes(x, y[1], sound.k)[0] for y in path]
    mode = sound.operator_mode(1)
    expected = mode.standing(step * np.arange(1, count + 1), 1e-6)[0]
    assert np.abs(seen - expected).max() < 3e-5 * 1e-6
    assert mode.frequency < 0.96 * sound.mode().frequency  # so the agreement is not the physics'


def test_sound_lattice_and_limits():
    reference = case("sound_wave")
    sound = reference.Sound(sound_scene(smoothing=1.5, spacing=0.01))
    assert sound.mode().frequency == pytest.approx(2 * math.pi, rel=1e-4)
    assert sound.lattice_mode(2).frequency == pytest.approx(sound.operator_mode(2).frequency, rel=5e-3)
    assert reference.Sound(sound_scene(), reference.STOKES_FLUID).damping == pytest.approx(4 / 3 * sound.damping)
    breaking = reference.shock_distance(sound.k, sound.mach)
    assert 0.25 * 8 * sound.k * sound.speed * breaking == pytest.approx(0.5)  # Fubini: u2/u1 of that order where it breaks


# --- hydrostatic ---


def test_hydrostatic_column():
    reference = case("hydrostatic")
    fill = {"law": "box", "lower": [0.0, 0.0, 0.0], "upper": [0.3, 0.2, 1.0]}
    s = scene([0.3, 0.2, 2.0], {"law": "hydrostatic", "surface": 1.0}, gravity=(0.0, 0.0, -9.81), sound_speed=30.0, fill=fill)
    column = reference.Column(s)
    d = np.linspace(0.0, 1.0, 9)
    gradient = (column.pressure(d + 1e-3) - column.pressure(d - 1e-3)) / 2e-3
    np.testing.assert_allclose(gradient, column.density(d) * 9.81, rtol=1e-7)
    np.testing.assert_allclose(column.pressure(d), tait.pressure(column.density(d), 1000.0, 30.0))
    assert integrate.quad(column.density, 0.0, column.height)[0] * column.base == pytest.approx(column.mass, rel=1e-12)
    assert column.pressure(column.height) == pytest.approx(9810.0, rel=1e-10)
    assert 1.0 - column.height == pytest.approx(9.81 / (2 * 900.0), rel=0.03)
    z = 0.37  # the mass below a settled height is the mass below the height it had
    below = integrate.quad(lambda y: column.density(column.height - y), 0.0, column.settled(z))[0]
    assert below == pytest.approx(1000.0 * z, rel=1e-12)
    exact = column.pressure(column.height - d[:5])
    assert reference.pressure_error(column, d[:5], exact + 98.1) == pytest.approx((0.01, 0.01))


def test_incompressible_limit_of_the_column():
    fill = {"law": "box", "lower": [0.0, 0.5], "upper": [1.0, 1.5]}
    s = scene([1.0, 2.0], {"law": "hydrostatic", "surface": 1.5}, gravity=(0.0, -9.81), sound_speed=3000.0, fill=fill)
    column = case("hydrostatic").Column(s)
    np.testing.assert_allclose(column.pressure([0.1, 0.8]), column.incompressible_pressure([0.1, 0.8]), rtol=1e-6)
    assert column.base == 1.0 and column.axis == 1


def test_lattice_rate_is_the_sum_over_all_pairs_of_a_periodic_box():
    """Morris' sum written out over the 12 x 12 particles of a box; the shear wave is an eigenvector with -lattice_rate."""
    reference = case("shear_wave")
    side, n = 1.0, 12
    s = scene([side, side], {"law": "shear_wave", "speed": 1.0}, spacing=side / n, viscosity=3.0)
    wave = reference.Wave(s)
    places = (np.arange(n) + 0.5) / n * side
    x = np.stack(np.meshgrid(places, places), axis=-1).reshape(-1, 2)
    gap = x[:, None] - x[None]
    gap -= side * np.round(gap / side)
    r = np.linalg.norm(gap, axis=2)
    h = 1.5 * side / n
    slope_ = 7 / (4 * math.pi) / h**3 * -5 * (r / h) * np.maximum(1 - r / (2 * h), 0) ** 3
    factor = 2 * wave.nu * (side / n) ** 2 * slope_ / np.where(r > 0, r, 1.0)
    u = wave.velocity(x, 0.0)[:, 0]
    acceleration = (factor * (u[:, None] - u[None])).sum(axis=1)
    np.testing.assert_allclose(acceleration, -wave.lattice_rate(2) * u, atol=1e-12 * wave.rate)
