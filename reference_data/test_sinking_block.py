"""theory/sinking_block.py against smoothed_block.py, by hand, and in its limits. Run from this folder or from the root."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))

from theory import sedimentation_scene as scene  # noqa: E402
from theory import settling, sinking_block, smoothed_block, sph_operators  # noqa: E402
from theory.plane_kernel import plane_average  # noqa: E402

WATER, D, BOX = settling.FLUIDS["water"], settling.GRAIN["d"], 6.0e-3


def published(nominal, h):
    wide = scene.coupling_width(h, nominal)
    return sinking_block.Widths(h, wide, h, wide)


@pytest.mark.parametrize("nominal, ratio", [(0.6, 3), (0.8, 4), (0.95, 2)])
def test_exact_divergence_is_the_smoothed_block(nominal, ratio):
    block, h = scene.lattice(nominal), ratio * D
    widths = published(nominal, h)
    v = sinking_block.velocity(WATER, block, widths, sinking_block.field(block, BOX, widths))
    assert v == pytest.approx(smoothed_block.velocity(WATER, block, h), rel=1e-5)


def test_a_narrow_kernel_of_the_fluid_has_an_exact_divergence():
    block, wide = scene.lattice(0.8), 4.0 * D
    widths = sinking_block.Widths(0.5 * D, wide, wide, wide)
    at = sinking_block.field(block, BOX, widths, answered=sinking_block.Answer(1e4, 0.1 * D))
    assert at.w == pytest.approx(1.0 / at.eps, rel=2e-3)


def test_a_dilute_block_divides_the_kernel_out():
    """w - 1 -> phi^/W^ where answered, wave by wave; here all kernels are the same, so it is the layers' own density."""
    block = scene.Lattice(0.999, 3, 1, 6.2e-4, 0.0)
    widths = sinking_block.Widths(*[3.0 * D] * 4)
    at = sinking_block.field(block, 4.0e-3, widths, answered=sinking_block.Answer(300.0, 0.5 * D))
    count = len(at.z)
    k = 2.0 * np.pi * np.fft.rfftfreq(count, at.box / count)
    kernel = sph_operators.transform("wendland_c2", 3, k * widths.fluid)
    phi = np.abs(np.fft.rfft(1.0 - at.eps))
    low = slice(1, 7)  # beyond, W^ is small and the second order, phi^2, shows
    expected = phi[low] / kernel[low] * -np.expm1(-300.0 * kernel[low] ** 2)
    assert np.abs(np.fft.rfft(at.w - 1.0))[low] == pytest.approx(expected, rel=5e-3)


def test_no_flux_and_no_momentum_in_the_box():
    """With an exact divergence eps u + (1 - eps) v = 0 far from and inside the block, so the box follows from volumes alone."""
    block, widths = scene.lattice(0.8), published(0.8, 3 * D)
    at = sinking_block.field(block, BOX, widths)
    taken = block.grains * scene.GRAIN_VOLUME / (scene.WIDTH**2 * BOX)
    assert sinking_block.share_in_box(at, 2.5) == pytest.approx(1.0 / (1.0 + 1.5 * taken), rel=1e-4)


def test_narrow_kernels_leave_the_velocity_of_the_lattice():
    """Half the width, half the distance from the uniform suspension's velocity."""
    block = scene.lattice(0.8)
    plain = smoothed_block.uniform_velocity(WATER, block.eps)
    excess = []
    for width in (1.5 * D, 3.0 * D):
        widths = sinking_block.Widths(*[width] * 4)
        excess.append(sinking_block.velocity(WATER, block, widths, sinking_block.field(block, BOX, widths)) / plain - 1.0)
    assert 0.0 < excess[0] < excess[1] and excess[0] == pytest.approx(0.5 * excess[1], rel=0.15)


@pytest.mark.parametrize("law", ["overlap", "deconvolved"])
def test_filters_of_porosity_are_those_of_space(law):
    """A plane's eps from its definition in space: W averaged over spheres whose centres fill the plane, and 2 W - W*W along z."""
    width = 1.3 * D
    z = np.linspace(-8.0 * D, 8.0 * D, 3201)
    plane = plane_average(z, width)
    if law == "overlap":
        ball = np.maximum(0.25 * D**2 - z**2, 0.0) * 6.0 / D**3  # a slice of a sphere over its volume
        expected = np.convolve(plane, ball, "same") * (z[1] - z[0])
    else:
        expected = 2.0 * plane - np.convolve(plane, plane, "same") * (z[1] - z[0])
    block = scene.Lattice(0.9, 4, 1, 1.6e-3, 0.0)  # one layer, 1.6 mm of the box's 6
    widths = sinking_block.Widths(width, width, width, width, law)
    at = sinking_block.field(block, BOX, widths)
    found = (1.0 - at.eps) / ((1.0 - block.eps) * block.spacing)
    assert found == pytest.approx(np.interp(at.z - block.heights[0], z, expected, left=0.0, right=0.0), abs=2e-3 * expected.max())


def test_all_filters_leave_the_middle_of_a_thick_block_alone_and_deconvolution_its_edge_sharper():
    block, width = scene.lattice(0.8), 2.5 * D
    fields = {law: sinking_block.field(block, BOX, sinking_block.Widths(*[width] * 4, law)) for law in sinking_block.POROSITY}
    middle, edge = 0.5 * (block.bottom + block.top), block.top
    for at in fields.values():
        assert np.interp(middle, at.z, at.eps) == pytest.approx(block.eps, abs=1e-3)
        assert np.interp(edge, at.z, at.eps) == pytest.approx(0.5 * (1.0 + block.eps), abs=5e-3)
    slope = {law: np.gradient(at.eps, at.z).max() for law, at in fields.items()}
    assert slope["overlap"] < slope["kernel"] and slope["deconvolved"] == pytest.approx(1.3 * slope["kernel"], rel=0.03)


def test_own_volume_of_one_kernel():
    """V Int W^2 dV, by quadrature in space: 0.0785 (d/h)^3 of wendland_c2."""
    r = np.linspace(0.0, 2.0, 20001)
    kernel = 21.0 / (16.0 * np.pi) * (1.0 - 0.5 * r) ** 4 * (1.0 + 2.0 * r)
    expected = np.pi / 6.0 * np.sum(4.0 * np.pi * r**2 * kernel**2) * r[1] / 27.0
    assert sinking_block.own_volume(sinking_block.Widths(*[3.0 * D] * 4)) == pytest.approx(expected, rel=1e-5)
    wide = sinking_block.Widths(*[3.0 * D] * 4, "deconvolved")
    assert sinking_block.own_volume(wide) > expected


def test_a_grain_that_leaves_out_its_own_volume_falls_faster():
    block, width = scene.lattice(0.8), 2.0 * D
    v = []
    for own in (True, False):
        widths = sinking_block.Widths(*[width] * 4, "kernel", own)
        v.append(sinking_block.velocity(WATER, block, widths, sinking_block.field(block, BOX, widths)))
    assert v[1] > 1.01 * v[0]


def test_a_wave_of_two_spacings_is_not_answered():
    """Whatever the last bit of box over spacing."""
    block, spacing = scene.lattice(0.6), 4.0 * D
    widths = sinking_block.Widths(6.0 * D, 2.0 * D, 2.0 * D, 2.0 * D)
    v = []
    for slightly in (1.0 - 1e-12, 1.0, 1.0 + 1e-12):
        at = sinking_block.field(block, 12.0 * spacing, widths, sinking_block.Answer(1e3, slightly * spacing))
        v.append(sinking_block.velocity(WATER, block, widths, at))
    assert v == pytest.approx([v[1]] * 3, rel=1e-9)
