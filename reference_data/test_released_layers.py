"""Tests of the linear theory of released layers, of the lattice's elasticity, and of the Rayleigh-Taylor case's files."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy import integrate

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT))
sys.path.insert(0, str(ROOT.parent / "verification" / "rayleigh_taylor"))

import displaced_lattice  # noqa: E402
from theory import layered_rayleigh_taylor as layered  # noqa: E402
from theory import lattice_elasticity, layer_friction, rayleigh_taylor, released_layers, settling, sph_operators  # noqa: E402
from theory import sedimentation_scene as scene  # noqa: E402
from theory.released_layers import Setting  # noqa: E402

CASE = ROOT.parent / "verification" / "rayleigh_taylor"
WALLED = layered.Depth(scene.DEPTH, "no_slip", "no_slip")


def setting(name, across, **changes):
    fluid, h = settling.FLUIDS[name], scene.smoothing_length(across)
    return Setting(fluid["rho"], fluid["mu"], h, scene.coupling_width(h, 0.8), h, **changes)


@pytest.mark.parametrize("name, across", [("glycerol_water", 10), ("glycerol_water", 30), ("water", 10), ("water", 20)])
@pytest.mark.parametrize("mode", [0, 1])
def test_layers_at_rest_grow_like_the_slab(name, across, mode):
    """Exact viscosity, no settling: the form "gathered" with grains of finite inertia; layers for a slab cost (k a)^2/12, 0.8 %."""
    s, k, fluid = setting(name, across, settles=False, morris=False), scene.wave_numbers()[mode], settling.FLUIDS[name]
    tau = rayleigh_taylor.hindered_relaxation_time(fluid, 0.8, rayleigh_taylor.settling_slip(fluid, 0.8))
    slab = layered.growth_rate(k, fluid, layered.scene_layer(), s.h_c, layered.Closure(tau=tau, density_ratio=s.rho / settling.GRAIN["rho_p"]),
                               WALLED, s.h)
    assert released_layers.growth_rate(s, k) == pytest.approx(slab, rel=0.01)


@pytest.mark.parametrize("across, mode", [(10, 0), (10, 1), (20, 1)])
def test_weaker_operator_helps_as_at_a_single_edge(across, mode):
    s, k, fluid = setting("glycerol_water", across, settles=False), scene.wave_numbers()[mode], settling.FLUIDS["glycerol_water"]
    gain = released_layers.growth_rate(s, k) / released_layers.growth_rate(s._replace(morris=False), k)
    plain, morris = (layered.edge_growth_rate(k, fluid, 0.2, s.h_c, s.h, symbol) for symbol in (False, True))
    assert gain - 1.0 == pytest.approx(morris / plain - 1.0, rel=0.25)


@pytest.mark.parametrize("kernel", ["wendland_c2", "quintic_spline"])
def test_morris_average_transforms_into_its_symbol(kernel):
    """2 nu [M^(0) - M^(q)] at wave vector (k, q) is lambda."""
    h, k, q = 1.0, 1.1, 0.9
    z = np.linspace(0.0, sph_operators.support(kernel) * h, 4001)
    whole = 2.0 * integrate.simpson(layer_friction.morris_average(z, kernel, h, 0.0), x=z)
    wave = 2.0 * integrate.simpson(layer_friction.morris_average(z, kernel, h, k) * np.cos(q * z), x=z)
    square = k**2 + q**2
    assert 2.0 * (whole - wave) == pytest.approx(square * sph_operators.viscosity_ratio(kernel, 3, math.sqrt(square) * h), rel=1e-5)


def test_projections_add_up():
    """Along k = 0 all of a vertical field is a gradient; for k > 0, (I - P)_zz + k^2/K^2 = 1."""
    gap = np.array([0.0, 0.3, 1.1])
    flat = released_layers.gathered(gap, 1.0, 1.1, 0.0)
    np.testing.assert_allclose(flat.upright, flat.plain)
    np.testing.assert_allclose(flat.sideways, 0.0, atol=1e-14)
    small = 1e-5
    for name in ("plain", "upright", "sideways"):
        up, down = (getattr(released_layers.gathered(gap + sign * small, 1.0, 1.1, 1.3), name) for sign in (1, -1))
        slope = getattr(released_layers.gathered(gap, 1.0, 1.1, 1.3), "slope" if name == "plain" else name + "_slope")
        np.testing.assert_allclose((up - down) / (2 * small), slope, atol=1e-7)


def test_settling_moves_a_uniform_displacement_nowhere():
    """k -> 0: layers that are all displaced alike see what they saw before, so settling adds nothing."""
    s = setting("water", 15)
    z = s.lattice.heights
    vertical, side = released_layers._velocity_by_settling(s, released_layers.base(s, z), z, 1e-3)
    scale = np.abs(vertical[0]).max()
    np.testing.assert_allclose(vertical[0] @ np.ones(len(z)), 0.0, atol=1e-6 * scale)
    np.testing.assert_allclose(side[0], 0.0, atol=1e-4 * scale)


def test_base_settles_like_the_hindered_suspension():
    """A block of 16 mm at h = 0.3 mm: in its middle the hindered velocity at zero net flux."""
    s = setting("water", 20, block=(3.6e-3, 19.6e-3), height=24e-3)
    z = s.lattice.heights
    middle = released_layers.base(s, z).velocity[len(z) // 2]
    fluid = settling.FLUIDS["water"]
    assert -middle == pytest.approx(rayleigh_taylor.settling_slip(fluid, s.lattice.eps), rel=2e-3)


def test_history_starts_from_rest_and_ends_at_the_largest_rate():
    """After 0.4 s at rest the largest rate alone is left; the first step is the push on the fluid, quadratic in time."""
    s, k = setting("glycerol_water", 10, frozen=True), scene.wave_numbers()[1]
    found = released_layers.history(s, k, (0.0, 1e-3, 2e-3, 0.36, 0.4))
    gain = found.rise[:, 0] - 1.0
    assert 2.5 < gain[2] / gain[1] < 4.0
    assert math.log(found.rise[4, 0] / found.rise[3, 0]) / 0.04 == pytest.approx(released_layers.growth_rate(s, k), rel=2e-3)


def test_history_does_not_depend_on_its_steps():
    s, k = setting("water", 10), scene.wave_numbers()[0]
    coarse, fine = (released_layers.history(s, k, (0.0, 0.02, 0.04), most).rise[-1, 0] for most in (4e-3, 1e-3))
    assert coarse == pytest.approx(fine, rel=1e-3)


@pytest.mark.parametrize("across, mode", [(10, 0), (10, 1), (30, 1)])
def test_layers_of_more_viscous_suspension_grow_like_the_slab(across, mode):
    """Newton's friction with mu(phi): the form "gathered" with the same closure, whose sharp limit is Chandrasekhar's (test_rayleigh_taylor)."""
    s, k = setting("glycerol_water", across, settles=False, morris=False, viscosity="krieger_dougherty"), scene.wave_numbers()[mode]
    fluid = settling.FLUIDS["glycerol_water"]
    tau = rayleigh_taylor.hindered_relaxation_time(fluid, 0.8, rayleigh_taylor.settling_slip(fluid, 0.8))
    closure = layered.Closure("krieger_dougherty", tau, s.rho / settling.GRAIN["rho_p"])
    slab = layered.growth_rate(k, fluid, layered.scene_layer(), s.h_c, closure, WALLED, s.h)
    assert released_layers.growth_rate(s, k) == pytest.approx(slab, rel=0.01)


def test_sharp_deep_layer_has_chandrasekhars_rate_with_the_closures_viscosity():
    """Both depths 8 times 1/k, an edge of 0.01 mm; mu_2 = 1.82 mu."""
    fluid, layer, k = settling.FLUIDS["glycerol_water"], layered.Layer(5e-3, 10e-3, 0.2), scene.wave_numbers()[0]
    found = layered.growth_rate(k, fluid, layer, layered.SHARP, layered.Closure("krieger_dougherty"), layered.Depth(10e-3, "no_slip", "no_slip"))
    mu_2 = rayleigh_taylor.suspension_viscosity(fluid["mu"], 0.8)
    assert mu_2 / fluid["mu"] == pytest.approx(1.82, abs=0.005)
    deep = rayleigh_taylor.growth_rate(k, (fluid["rho"], fluid["mu"]), (0.8 * fluid["rho"] + 0.2 * settling.GRAIN["rho_p"], mu_2))
    assert found == pytest.approx(deep, rel=2e-3)


def viscosity_step(s):
    """(points, mu) of a smoothed step of the viscosity from 1 to 1.8 in the middle of the layer's space."""
    x = released_layers._space(s)
    return x, 1.4 + 0.4 * np.tanh((x.z - 3.6e-3) / 0.4e-3)


def smooth_field(s, x):
    return np.linalg.lstsq(x.value.toarray(), np.sin(math.pi * x.z / s.height) ** 4, rcond=None)[0]


def test_pair_friction_of_long_waves_is_the_gradient_form():
    """A smooth field's dissipation differs by terms of (K h)^2."""
    s, k = setting("glycerol_water", 20), scene.wave_numbers()[0]
    x, mu = viscosity_step(s)
    c, error = smooth_field(s, x), []
    for h in (0.6e-3, 0.3e-3):
        pairs = layer_friction.form(x, mu, k, layer_friction.Operator("wendland_c2", h, s.height, "no_slip"))
        error.append(abs(c @ pairs @ c / (c @ layer_friction.limit_form(x, mu, k) @ c) - 1.0))
    assert error[1] < 0.03
    assert error[1] == pytest.approx(error[0] / 4.0, rel=0.1)


def test_pair_friction_is_newtons_where_the_viscosity_is_uniform():
    s, k = setting("glycerol_water", 20), scene.wave_numbers()[0]
    x, mu = viscosity_step(s)
    one, c = np.ones_like(mu), smooth_field(s, x)
    newton = layered.viscous_form(x, one, k)
    np.testing.assert_allclose(layer_friction.limit_form(x, one, k), newton, atol=1e-8 * np.abs(newton).max())
    assert c @ layer_friction.limit_form(x, mu, k) @ c < 0.97 * (c @ layered.viscous_form(x, mu, k) @ c)


def test_a_uniform_excess_adds_to_the_viscosity():
    """Grains so few that the porosity hardly varies: the suspension's friction is the pure fluid's at mu (1 + excess)."""
    s, k = setting("water", 10, viscosity="krieger_dougherty"), scene.wave_numbers()[1]
    pure = released_layers.friction(s._replace(viscosity="pure_fluid"), k, s.lattice.heights)
    far = released_layers.friction(s, k, np.array([-1.0]))  # no layer within reach
    np.testing.assert_allclose(far, pure, rtol=1e-12, atol=1e-12 * np.abs(pure).max())
    many = released_layers.friction(s, k, s.lattice.heights)
    assert 1.0 < np.trace(many) / np.trace(pure) < 1.82


def test_suspension_viscosity_slows_growth_from_the_start():
    k, times = scene.wave_numbers()[1], (0.0, 0.03)
    pure, full = (released_layers.history(setting("glycerol_water", 10, viscosity=law), k, times).rise[-1, 0] for law in ("pure_fluid", "krieger_dougherty"))
    assert 1.0 < full < pure


@pytest.mark.parametrize("kernel", ["wendland_c2", "quintic_spline"])
def test_space_filled_with_particles_is_not_elastic(kernel):
    """With many neighbours the sum is an integral: shear costs nothing, compression along k costs 2 k^2 p."""
    k = 0.05
    across = [abs(lattice_elasticity.stiffness(kernel, smoothing, (k, 0.0, k), (1.0, 0.0, -1.0))) for smoothing in (1.5, 4.0)]
    assert across[1] < 0.1 * across[0]
    # in the limit of long waves: 2 (1/2) k^2 Int x^2 d2W/dx2 dV = 2 k^2
    assert lattice_elasticity.stiffness(kernel, 4.0, (k, 0.0, 0.0), (1.0, 0.0, 0.0)) == pytest.approx(2.0 * k**2, rel=0.03)


@pytest.mark.parametrize("name", displaced_lattice.FILES)
def test_grains_of_the_case_are_the_displaced_lattice(name):
    amplitude = displaced_lattice.FILES[name]
    assert (CASE / name).read_text(encoding="utf-8") == displaced_lattice.text(amplitude)
    places = np.loadtxt(CASE / name, delimiter=",", skiprows=1)
    block = scene.lattice(0.8)
    assert len(places) == block.grains == 9251
    lowest = places[places[:, 2].argmin()]
    assert block.heights[0] - lowest[2] == pytest.approx(0.5 * amplitude * settling.GRAIN["d"], abs=1e-11)
    np.testing.assert_allclose(lowest[:2], 0.5 * scene.WIDTH, rtol=1e-9)
