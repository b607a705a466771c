"""Tests of the Rayleigh-Taylor references beyond Chandrasekhar's: grains of finite inertia, smoothed layers, coupling kernels."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy import integrate

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT))

from drag_laws.drag_laws import di_felice  # noqa: E402
from tables import table  # noqa: E402
from theory import layered_rayleigh_taylor as layered  # noqa: E402
from theory import packed_beds, rayleigh_taylor, settling, sph_operators  # noqa: E402
from theory import sedimentation_scene as scene  # noqa: E402

GLYCEROL, WATER, AIR = (settling.FLUIDS[name] for name in ("glycerol_water", "water", "air"))
D = settling.GRAIN["d"]
RHO_P = settling.GRAIN["rho_p"]
G = settling.GRAVITY


# --- finite inertia ---


def mixture(fluid, phi=0.2, mu_2=None):
    return (fluid["rho"], fluid["mu"]), ((1 - phi) * fluid["rho"] + phi * RHO_P, fluid["mu"] if mu_2 is None else mu_2)


@pytest.mark.parametrize("fluid", [GLYCEROL, WATER, AIR])
def test_grains_without_inertia_grow_like_the_mixture(fluid):
    for k in scene.wave_numbers():
        sharp = rayleigh_taylor.growth_rate(k, *mixture(fluid))
        assert rayleigh_taylor.dusty_growth_rate(k, fluid, 0.2, fluid["mu"], 1e-9) == pytest.approx(sharp, rel=1e-6)


def test_heavy_loose_grains_grow_like_a_cube_root():
    thin = {"rho": 1000.0, "mu": 1e-12}
    for tau in (1e3, 1e5):
        n = rayleigh_taylor.dusty_growth_rate(1571.0, thin, 0.2, 1e-12, tau)
        left_out = 1.0 / (n * tau) + 1571.0 * math.sqrt(1e-15 / n)  # what f has beyond 1/(n tau); k over the boundary layers' q
        assert n == pytest.approx((G * 1571.0 * 0.2 * 1500.0 / (tau * 1800.0)) ** (1 / 3), rel=left_out)


def test_dusty_relation_by_hand():
    """Inviscid, n tau = 1: f = 1/2, n^2 (rho + 0.8 rho + 0.1 rho_p) = g k 0.1 (rho_p - rho)."""
    n = math.sqrt(G * 1000.0 * 0.1 * 1500.0 / 2050.0)
    thin = {"rho": 1000.0, "mu": 1e-12}
    assert rayleigh_taylor.dusty_growth_rate(1000.0, thin, 0.2, 1e-12, 1.0 / n) == pytest.approx(n, rel=1e-5)
    # with b = 0.4: f = 0.7
    n = math.sqrt(G * 1000.0 * 0.14 * 1500.0 / (1800.0 + 0.14 * 2500.0))
    assert rayleigh_taylor.dusty_growth_rate(1000.0, thin, 0.2, 1e-12, 1.0 / n, 0.4) == pytest.approx(n, rel=1e-5)


def test_grains_follow_by_their_own_equation():
    """rho_p dv/dt = rho_p (u - v)/tau + rho du/dt with u = exp(n t), integrated until only the growing part is left."""
    n, tau, b = 3.0, 0.4, 0.4
    solved = integrate.solve_ivp(lambda t, v: (math.exp(n * t) - v) / tau + b * n * math.exp(n * t), (0, 6), [0.0], rtol=1e-10)
    assert solved.y[0, -1] / math.exp(18.0) == pytest.approx(rayleigh_taylor.following(n, tau, b), rel=1e-6)


def test_relaxation_in_a_suspension():
    assert rayleigh_taylor.hindered_relaxation_time(GLYCEROL, 1.0) == pytest.approx(1.5605e-4 / 0.96, rel=1e-4)
    slow = rayleigh_taylor.hindered_relaxation_time(GLYCEROL, 0.8)
    assert slow == pytest.approx(1.5605e-4 / (0.96 * 0.8**-3.7), rel=1e-4)
    u = rayleigh_taylor.settling_slip(WATER, 0.8)
    force = lambda v: packed_beds.whole_force(di_felice, 0.8, v, D, WATER["rho"], WATER["mu"])  # noqa: E731
    per_speed = (force(1.001 * u) - force(0.999 * u)) / (0.002 * u / 0.8)  # of the interstitial slip
    mass = RHO_P * scene.GRAIN_VOLUME
    # force = 3 pi mu d u_s F/eps and u_s = eps (u - v): the slope over (u - v) is m/tau
    assert rayleigh_taylor.hindered_relaxation_time(WATER, 0.8, u) == pytest.approx(mass / per_speed, rel=1e-5)


def test_lowest_grain_starts_with_its_displacement():
    """At t = 0 it moves at (d/8)(2 n1 + n2) beside its settling; much later the faster wave alone counts."""
    step = 1e-7
    start = rayleigh_taylor.lowest_grain(step, (20.0, 30.0), 3e-4) / step
    assert start == pytest.approx(3e-4 + D / 8 * 70.0, rel=1e-5)
    assert rayleigh_taylor.lowest_grain(1.0, (20.0, 30.0), 0.0) == pytest.approx(D / 8 * math.exp(30.0), rel=1e-3)


# --- layered ---

DEEP = layered.Depth(60e-3, "free_slip", "free_slip")
THICK = layered.Layer(20e-3, 40e-3, 0.2)


@pytest.mark.parametrize("viscosity", ["pure_fluid", "krieger_dougherty"])
@pytest.mark.parametrize("fluid", [GLYCEROL, WATER])
def test_sharp_deep_limit_is_chandrasekhar(fluid, viscosity):
    closure = layered.Closure(viscosity)
    for k in scene.wave_numbers():
        sharp = rayleigh_taylor.growth_rate(k, *mixture(fluid, mu_2=float(closure.mu(fluid, 0.2))))
        assert layered.growth_rate(k, fluid, THICK, 2e-6, closure, DEEP) == pytest.approx(sharp, rel=2e-3)


@pytest.mark.parametrize("density_ratio", [0.0, 0.4])
def test_sharp_deep_limit_with_inertia_is_the_dusty_relation(density_ratio):
    k, tau = scene.wave_numbers()[0], 0.02  # n tau about 0.7
    closure = layered.Closure(tau=tau, density_ratio=density_ratio)
    dusty = rayleigh_taylor.dusty_growth_rate(k, WATER, 0.2, WATER["mu"], tau, density_ratio)
    assert dusty < 0.95 * rayleigh_taylor.growth_rate(k, *mixture(WATER))
    assert layered.growth_rate(k, WATER, THICK, 2e-6, closure, DEEP) == pytest.approx(dusty, rel=2e-3)


def test_inviscid_fluids_of_finite_depth():
    """n^2 = g k (rho2 - rho1)/(rho1 coth k H1 + rho2 coth k H2) between rigid lids (Lamb, article 231)."""
    thin, k, low, high = {"rho": 1000.0, "mu": 1e-7}, 500.0, 1e-3, 3e-3
    layer = layered.Layer(low, 1.0, 0.2)  # the heavy fluid reaches through the lid
    n = layered.growth_rate(k, thin, layer, 2e-6, depth=layered.Depth(low + high, "free_slip", "free_slip"))
    exact = math.sqrt(G * k * 300.0 / (1000.0 / math.tanh(k * low) + 1300.0 / math.tanh(k * high)))
    assert n == pytest.approx(exact, rel=3e-3)  # k h_c = 1e-3, and a boundary layer of mu


def test_inviscid_free_surface():
    """Lamb, article 231, w^2 = -n^2: (rho1 c1 c2 + rho2) w^4 - rho1 (c1 + c2) g k w^2 + (rho1 - rho2) g^2 k^2 = 0, c = coth k H."""
    thin, k, low, high = {"rho": 1000.0, "mu": 1e-7}, 300.0, 2e-3, 1e-3
    depth = layered.Depth(low + high, "free_slip", "free_surface")
    n = layered.growth_rate(k, thin, layered.Layer(low, 1.0, 0.2), 2e-6, depth=depth)
    c1, c2 = 1 / math.tanh(k * low), 1 / math.tanh(k * high)
    roots = np.roots([1000.0 * c1 * c2 + 1300.0, -1000.0 * (c1 + c2) * G * k, -300.0 * (G * k) ** 2])
    assert n == pytest.approx(math.sqrt(-roots.min()), rel=3e-3)


def test_equal_viscous_fluids_creep():
    """n = g (rho2 - rho1)/(4 k mu), Chandrasekhar's limit of large viscosity."""
    thick, k = {"rho": 1150.0, "mu": 10.0}, 2221.0
    n = layered.growth_rate(k, thick, THICK, 2e-6, depth=DEEP)
    assert n == pytest.approx(G * 0.2 * 1350.0 / (4 * k * 10.0), rel=2e-3)


# A separate calculation to its digits: smoothed once, nominal layer 3.6 to 5.2 mm, mu_2 = mu; across 10, 20, 30, sharp.
SMOOTHED = {
    ("glycerol_water", 1): (18.2, 20.9, 21.7, 22.6),
    ("glycerol_water", 0): (20.3, 22.5, 23.1, 23.7),
    ("water", 1): (35.8, 40.8, 42.7, 45.2),
    ("water", 0): (33.2, 36.8, 38.0, 39.6),
}


@pytest.mark.parametrize("fluid, mode", SMOOTHED)
def test_smoothed_layer_against_a_separate_calculation(fluid, mode):
    layer, k = layered.Layer(3.6e-3, 5.2e-3, 0.2), scene.wave_numbers()[mode]
    widths = [scene.coupling_width(scene.smoothing_length(across), 0.8) for across in (10, 20, 30)] + [layered.SHARP]
    rates = [layered.growth_rate(k, settling.FLUIDS[fluid], layer, width) for width in widths]
    np.testing.assert_allclose(rates, SMOOTHED[fluid, mode], rtol=4e-3)


def test_finer_splines_change_nothing(monkeypatch):
    k, layer = scene.wave_numbers()[1], layered.scene_layer()
    h = scene.smoothing_length(10)
    rates = lambda: [layered.growth_rate(k, GLYCEROL, layer, scene.coupling_width(h, 0.8), h=g) for g in (None, h)]  # noqa: E731
    coarse, plain = rates(), layered.knots
    monkeypatch.setattr(layered, "knots", lambda height, edges, width: plain(height, edges, width, 1 / 80, 1 / 7))
    layered._space.cache_clear()
    layered._gathered.cache_clear()
    np.testing.assert_allclose(rates(), coarse, rtol=1e-8)
    layered._space.cache_clear()
    layered._gathered.cache_clear()


@pytest.mark.parametrize("across", [10, 20])
def test_gathered_form_against_the_sum_over_wave_vectors(across):
    """Creeping flow, one edge far from all else: equation (2) needs no basis and no depth."""
    thick, k = {"rho": 1150.0, "mu": 10.0}, scene.wave_numbers()[1]
    h = scene.smoothing_length(across)
    h_c = scene.coupling_width(h, 0.8)
    n = layered.growth_rate(k, thick, THICK, h_c, depth=DEEP, h=h)
    assert n == pytest.approx(layered.edge_growth_rate(k, thick, 0.2, h_c, h), rel=3e-4)


def creeping_rate_of_layers(block, fluid, k, h, h_c):
    """Largest growth rate of the lattice's own layers in creeping, unbounded flow; no slab, no continuum of grains along z.

    A layer displaced by (X, Z) exp(i k x) pulls with -(i k X + i q Z) exp(-i q z_m) F/a^2 times the spread kernel; the fluid answers
    with (I - KK/K^2)/(mu K^2), K = (k, q), the layers gather it: a matrix over (layer, direction), whose eigenvalues are rates.
    """
    q = np.linspace(-40.0 / h, 40.0 / h, 8001)
    square = q**2 + k**2
    spread, gather = (sph_operators.transform("wendland_c2", 3, np.sqrt(square) * width) for width in (h_c, h))
    pull = scene.GRAIN_VOLUME * (RHO_P - fluid["rho"]) * G / block.spacing**2
    answer = pull / fluid["mu"] * spread * gather / square * (q[1] - q[0]) / (2 * math.pi) * np.array([k * q, -(k**2) + 0 * q]) / square
    source = -1j * np.array([k + 0 * q, q])
    gap = np.subtract.outer(block.heights, block.heights)
    part = {d: (answer * np.exp(1j * q * d)) @ source.T for d in np.unique(gap.round(12))}
    return np.linalg.eigvals(np.block([[part[d] for d in row] for row in gap.round(12)])).real.max()


@pytest.mark.parametrize("across", [10, 30])
@pytest.mark.parametrize("mode", [0, 1])
def test_gathered_form_against_layers_of_grains(across, mode):
    """A slab for layers a apart costs (k a)^2/12, 0.8 %, and what the kernels leave of single layers; "once" grows faster."""
    thick, k, h = {"rho": 1150.0, "mu": 10.0}, scene.wave_numbers()[mode], scene.smoothing_length(across)
    block = scene.lattice(0.8, (20e-3, 21.6e-3))
    layer, h_c = layered.Layer(block.bottom, block.top, 1 - block.eps), scene.coupling_width(h, 0.8)
    depth = layered.Depth(46e-3, "free_slip", "free_slip")
    rate = creeping_rate_of_layers(block, thick, k, h, h_c)
    assert layered.growth_rate(k, thick, layer, h_c, depth=depth, h=h) == pytest.approx(rate, rel=0.01)
    assert layered.growth_rate(k, thick, layer, h_c, depth=depth) > 1.01 * rate


def test_gathered_form_with_inertia_against_the_sum_over_wave_vectors():
    """So dilute that one density does: phi = 1e-3, the grains' mass 0.25 % of the fluid's; rho n is 1 to 10 mu k^2 here."""
    k, layer = scene.wave_numbers()[1], layered.Layer(20e-3, 40e-3, 1e-3)
    thin = {"rho": 1000.0, "mu": 1e-5}
    h = scene.smoothing_length(15)
    n = layered.growth_rate(k, thin, layer, h, depth=DEEP, h=h)
    assert n * thin["rho"] > thin["mu"] * k**2
    assert n == pytest.approx(layered.edge_growth_rate(k, thin, 1e-3, h, h), rel=3e-3)


def test_gathered_form_tends_to_the_sharp_layer():
    k, layer = scene.wave_numbers()[0], layered.scene_layer()
    sharp = layered.growth_rate(k, WATER, layer, layered.SHARP)
    assert layered.growth_rate(k, WATER, layer, 2e-5, h=2e-5) == pytest.approx(sharp, rel=5e-3)


def test_edge_with_point_kernels_is_nearly_chandrasekhar():
    """Equal viscosities; the mean density for both sides costs O(A^2) = 1 % at most."""
    for fluid in (GLYCEROL, WATER):
        for k in scene.wave_numbers():
            sharp = rayleigh_taylor.growth_rate(k, *mixture(fluid))
            assert layered.edge_growth_rate(k, fluid, 0.2, 1e-7, 1e-7) == pytest.approx(sharp, rel=0.01)


def test_kernels_slow_the_growth_and_a_weaker_operator_less():
    rows = table("suspension_theory/edge_growth_rate.csv")
    assert np.all(rows["n_kernels"] < rows["n_kernels_morris"]) and np.all(rows["n_kernels_morris"] < rows["n_point"])
    rates = table("suspension_theory/layered_growth_rate.csv")
    # in air the kernels smooth the inertia as much as the driving: the order is that of the liquids
    liquid = np.array([fluid != "air" for fluid in rates["fluid"]])
    ordered = (("n_layer", "n_once"), ("n_once", "n_gathered"), ("n_once", "n_once_inertia"), ("n_gathered", "n_gathered_inertia"))
    for above, below in ordered:
        assert np.all(rates[below][liquid] < rates[above][liquid])


def test_stable_layers_are_refused():
    with pytest.raises(ValueError, match="nothing grows"):
        layered.growth_rate(1571.0, {"rho": 1000.0, "mu": 1e-3}, layered.Layer(-1.0, 3e-3, 0.2), 2e-5)
    with pytest.raises(ValueError, match="viscosity"):
        layered.Closure("einstein").mu(WATER, 0.2)
