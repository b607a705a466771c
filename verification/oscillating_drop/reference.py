"""Second mode of a drop without weight in the plane: exact viscous frequency and damping (README.md)."""

import cmath
import importlib.util
import math
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares, root
from scipy.special import ivp, iv

UNITS = {"period": "s", "damping": "1/s", "late_period": "s"}
MODE = 2

_spec = importlib.util.spec_from_file_location("static_drop_reference", Path(__file__).parents[1] / "static_drop" / "reference.py")
static_drop = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(static_drop)


class Drop:
    """A disc of the fluid's volume."""

    def __init__(self, scene):
        fluid = scene["fluid"]
        self.radius, self.rho = static_drop.radius(scene), fluid["density"]
        self.nu = fluid["viscosity"] / self.rho
        self.tension = fluid["surface"]["tension"] if isinstance(fluid["surface"], dict) else 1.0

    def inviscid_frequency(self, n=MODE):
        """rad/s (Rayleigh 1879; README, equation 1)."""
        return math.sqrt(n * (n * n - 1) * self.tension / (self.rho * self.radius**3))

    def damping_estimate(self, n=MODE):
        """Rate of the amplitude, 1/s, for small viscosity (README, equation 2)."""
        return 2.0 * n * (n - 1) * self.nu / self.radius**2

    def exponent(self, n=MODE):
        """s, 1/s, of exp(s t): root of the linearised viscous equations (README, equation 3)."""
        if self.nu == 0.0:
            return complex(0.0, self.inviscid_frequency(n))
        unit = self.inviscid_frequency(n)
        start = complex(-self.damping_estimate(n), unit)

        def residual(parts):
            value = self._determinant(complex(*parts) * unit, n)
            return [value.real, value.imag]

        found = root(residual, [start.real / unit, start.imag / unit], tol=1e-13)
        s = complex(*found.x) * unit
        if abs(self._determinant(s, n)) > 1e-8 or abs(s - start) > 0.3 * abs(start):
            raise ArithmeticError("no viscous mode near the inviscid one")
        return s

    def _determinant(self, s, n):
        """Of shear and normal stress on r = R for A r^n and B I_n(m r), m^2 = s/nu; columns scaled to one at the surface."""
        big_r, nu = self.radius, self.nu
        m = cmath.sqrt(s / nu)
        z = m * big_r
        bessel = iv(n, z)
        first, second = m * ivp(n, z, 1) / bessel, m * m * ivp(n, z, 2) / bessel
        shear_a, shear_b = 2.0 * n * (n - 1) / big_r**2, second - first / big_r + n * n / big_r**2
        radial_a, radial_b = n / big_r, n / big_r
        strain_a, strain_b = n * (n - 1) / big_r**2, n * (first / big_r - 1.0 / big_r**2)
        stiff = self.tension * (n * n - 1) / (self.rho * big_r**2 * s)
        normal_a = s + 2.0 * nu * strain_a + stiff * radial_a
        normal_b = 2.0 * nu * strain_b + stiff * radial_b
        scale = self.inviscid_frequency(n) * abs(m) ** 2
        return (shear_a * normal_b - shear_b * normal_a) / scale


def fit(run, start=None):
    """(damping, frequency), 1/s, of the difference of the second moments over their sum, from half a period on."""
    drop = Drop(run.scene)
    t, x = run.series("moment_x")
    _, y = run.series("moment_y")
    shape = ((x - y) / (x + y)).ravel()
    late = t > (math.pi / drop.inviscid_frequency() if start is None else start)
    t, shape = t[late], shape[late]

    def misfit(parts):
        return parts[0] * np.exp(-parts[1] * t) * np.cos(parts[2] * t + parts[3]) + parts[4] - shape

    found = least_squares(misfit, [np.abs(shape).max(), drop.damping_estimate(), drop.inviscid_frequency(), 0.0, 0.0], x_scale="jac")
    return float(found.x[1]), float(abs(found.x[2]))


def reference(quantity, scene, t):
    s = Drop(scene).exponent()
    if quantity in ("period", "late_period"):
        return 2.0 * math.pi / s.imag
    if quantity == "damping":
        return -s.real
    raise KeyError(quantity)


def measure(quantity, run):
    if quantity == "period":
        return 2.0 * math.pi / fit(run)[1]
    if quantity == "damping":
        return fit(run)[0]
    return NotImplemented


def table(runs):
    rows = []
    for run in runs:
        if run.failure:
            continue
        damping, frequency = fit(run)
        s = Drop(run.scene).exponent()
        rows.append([run.variant, f"{Drop(run.scene).radius / run.scene['fluid']['spacing']:.2f}",
                     f"{100.0 * (s.imag / frequency - 1.0):+.2f}", f"{100.0 * (damping / -s.real - 1.0):+.1f}"])
    return {"columns": ["variant", "R over spacing", "period, error [%]", "damping, error [%]"], "rows": rows,
            "caption": "Fitted over the run after its first half period, against the exact viscous mode."}


def figures(runs):
    """The swing over time against the exact mode, and the errors over the spacing."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5, 3.8), layout="constrained")
    swing, error = figure.subplots(1, 2)
    good = [run for run in runs if not run.failure]
    for number, name in enumerate(dict.fromkeys(run.variant for run in good)):
        own = sorted((run for run in good if run.variant == name), key=lambda run: -run.scene["fluid"]["spacing"])
        last = own[-1]
        t, x = last.series("moment_x")
        _, y = last.series("moment_y")
        shape = ((x - y) / (x + y)).ravel()
        s = Drop(last.scene).exponent()
        swing.plot(t, shape, lw=1.0, color=f"C{number}", label=name)
        swing.plot(t, shape[0] * np.exp(s.real * t) * np.cos(s.imag * t), lw=0.8, ls="--", color=f"C{number}")
        points = [(run.scene["fluid"]["spacing"] / Drop(run.scene).radius, 100.0 * abs(Drop(run.scene).exponent().imag / fit(run)[1] - 1.0)) for run in own]
        error.loglog(*zip(*points), "o-", ms=4, lw=1.0, color=f"C{number}", label=name)
    swing.set_xlabel("time [s]")
    swing.set_ylabel("(moment_x - moment_y)/(moment_x + moment_y)")
    swing.legend(fontsize="x-small")
    error.axhline(2.0, color="0.6", lw=0.8)
    error.set_xlabel("spacing/R")
    error.set_ylabel("error of the period [%]")
    return [("swing", figure, "Left: the swing at the finest spacing, dashed the exact mode of the same start. Right: error of the period.")]
