"""Packed grains, clamped porosities, a grain in a dry region (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import di_felice  # noqa: E402

UNITS = {"slip": "m/s", "fall": "m/s", "clamps": "1", "least_porosity": "1", "speed": "1"}
GRAVITY = 9.81  # of the scene; the twin's is ten times as strong


def stokes(scene):
    fluid, grain = scene["fluid"], scene["grains"]
    return (grain["density"] - fluid["density"]) * GRAVITY * grain["diameter"] ** 2 / (18.0 * fluid["viscosity"])


def law_slip(scene):
    """Interstitial slip of the uniform bed: f_d = eps (rho_p - rho) V g, fcc lattice."""
    fluid, grain = scene["fluid"], scene["grains"]
    d, mu, rho = grain["diameter"], fluid["viscosity"], fluid["density"]
    eps = 1.0 - 4.0 * math.pi / 6.0 * (d / grain["arrange"]["spacing"]) ** 3
    weight = (grain["density"] - rho) * math.pi / 6.0 * d**3 * GRAVITY

    def excess(w):
        u_s = eps * w
        return 3.0 * math.pi * mu * d * u_s * float(di_felice(eps, rho * d * u_s / mu)) / (eps * weight) - 1.0

    return brentq(excess, 1e-9 * stokes(scene), 3.0 * stokes(scene), rtol=1e-12)


def reference(quantity, scene, t):
    if quantity == "slip":
        return law_slip(scene)
    if quantity == "least_porosity":
        return 1.0 - math.pi / math.sqrt(18.0)
    if quantity == "fall":
        return -GRAVITY * np.asarray(t, float)
    raise KeyError(quantity)


def measure(quantity, run):
    if quantity == "slip":
        (t, u), (_, v) = run.series("fluid"), run.series("grains")
        return t, (u - v).ravel()
    if quantity == "fall":
        t, v = run.series("grains")
        return t[1:], v.ravel()[1:]
    if quantity == "clamps":
        return float(run.info["coupling"]["clamped_porosities"])
    last = run.snapshot(-1)
    if quantity == "least_porosity":
        return float(last["fluid"]["eps"].min())
    if quantity == "speed":
        return float(max(np.linalg.norm(last[name]["v"], axis=1).max() for name in ("fluid", "grains")) / stokes(run.scene))
    return NotImplemented
