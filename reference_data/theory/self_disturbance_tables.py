"""Rows of the self-disturbance tables: the slides' grain in their three fluids, every kernel, suspensions and cubic cells."""

import numpy as np
from drag_laws.drag_laws import di_felice
from theory import hasimoto, nonlinear_wake, self_disturbance, self_disturbance_history, settling
from theory.released_sphere import Sphere
from theory.sph_operators import KERNELS

WIDTHS = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0)  # h/d
KERNEL = "wendland_c2"
TIMES = {  # t/tau_p
    "air": (0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0),
    "water": (1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 60.0, 100.0),
    "glycerol_water": (1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 60.0, 100.0),
}


def slides_grain(fluid, law=di_felice):
    """The slides' grain in one of their fluids, its drag law at porosity 1."""
    grain, liquid = settling.GRAIN, settling.FLUIDS[fluid]
    return Sphere(lambda re: law(1.0, re), grain["rho_p"], grain["d"], liquid["rho"], liquid["mu"])


def kernel_rows():
    """(kernel, viscous operator, h/d, C, excess over Stokes), one kernel and width for everything, creeping flow."""
    rows = []
    for kernel in KERNELS:
        for viscosity in ("exact", "morris"):
            for ratio in WIDTHS:
                scheme = self_disturbance.one_kernel(kernel, ratio, viscosity == "morris")
                coefficient = self_disturbance.steady_coefficient(scheme)
                rows.append((kernel, viscosity, ratio, coefficient, self_disturbance.steady_excess(scheme, 1.0)))
    return rows


def width_rows():
    """(spread/gather, viscosity/gather, C): Wendland C2 with Morris' operator, widths apart, creeping flow."""
    gather = self_disturbance.Smoothing(KERNEL, 1.0)
    rows = []
    for spread in (0.5, 0.75, 1.0, 1.25, 1.5, 2.0):
        for viscous in (0.5, 1.0, 2.0):
            parts = [gather._replace(h=width) for width in (spread, 1.0, viscous)]
            rows.append((spread, viscous, self_disturbance.steady_coefficient(self_disturbance.Scheme(*parts))))
    return rows


def resistance_rows():
    """(viscous operator, Re_h, h sqrt(beta/mu), C): Oseen and Brinkman, Wendland C2."""
    return [
        (name, re_h, screening,
         self_disturbance.steady_coefficient(self_disturbance.one_kernel(KERNEL, 1.0, name == "morris"), re_h, screening))
        for name in ("exact", "morris")
        for re_h in (0.0, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0)
        for screening in (0.0, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)
    ]


def suspension_rows():
    """(solid fraction, h/d, S(0), C): Percus-Yevick structure factor, Wendland C2, Morris, no screening."""
    rows = []
    for fraction in (0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5):
        factor = self_disturbance.percus_yevick(fraction, 1.0)
        for ratio in WIDTHS:
            scheme = self_disturbance.one_kernel(KERNEL, ratio)
            coefficient = self_disturbance.steady_coefficient(scheme, structure=factor)
            rows.append((fraction, ratio, float(factor(0.0)), coefficient))
    return rows


def steady_rows():
    """(fluid, h/d, Re_h, u_self/u_t in creeping flow, of Oseen with the slip, with the path): Morris, Di Felice."""
    rows = []
    for fluid in settling.FLUIDS:
        sphere = slides_grain(fluid)
        for ratio in WIDTHS:
            scheme = self_disturbance.one_kernel(KERNEL, ratio * sphere.d)
            found = [self_disturbance.steady_settling(sphere, scheme, moves) for moves in ("still", "slip", "path")]
            re_h = sphere.rho * found[0][0] * scheme.gather.h / sphere.mu
            rows.append((fluid, ratio, re_h, *(u / slip for slip, u in found)))
    return rows


def nonlinear_rows(cell=16.0):
    """(fluid, h/d, Re_h on the slip, u_self/u_t of the full equations, of Oseen with the slip, with the path) in a cube of `cell` h."""
    rows, scheme, fluid = [], self_disturbance.one_kernel(KERNEL, 1.0), self_disturbance.Fluid(1.0, 1.0)
    modes = self_disturbance.box_modes(scheme, (cell,) * 3, reach=12.0)
    for name in ("air", "water"):
        sphere = slides_grain(name)
        for ratio in (1.0, 2.0, 3.0, 6.0):
            re_h = sphere.reynolds(sphere.terminal_speed()) * ratio
            force = sphere.weight() * sphere.rho / sphere.mu**2
            full = nonlinear_wake.steady_wake(scheme, re_h, force, cell)
            slip = self_disturbance.steady_velocity(modes, scheme, fluid, force, re_h)
            path = 0.0
            for _ in range(60):
                path = 0.5 * (path + self_disturbance.steady_velocity(modes, scheme, fluid, force, re_h + path))
            rows.append((name, ratio, re_h, full / re_h, slip / re_h, path / re_h))
    return rows


def _released(sphere, ratio, times, moves):
    scheme = self_disturbance.one_kernel(KERNEL, ratio * sphere.d)
    fluid = self_disturbance.Fluid(sphere.rho, sphere.mu)
    speed = 1.01 * sum(self_disturbance.steady_settling(sphere, scheme)) if moves != "still" else 0.0  # never exceeded
    modes = self_disturbance.unbounded_modes(scheme, fluid, path=speed * times[-1], speed=speed)
    return self_disturbance_history.plain_settling(sphere, scheme, modes, times, moves)


def release_rows():
    """(fluid, h/d, t/tau_p, nu t/h^2, then v/u_t and u_self/u_t in creeping flow and with Oseen's slip)."""
    rows = []
    for fluid, multiples in TIMES.items():
        sphere = slides_grain(fluid)
        final = sphere.terminal_speed()
        times = np.array(multiples) * settling.relaxation_time(sphere.rho_p, sphere.d, sphere.mu)
        for ratio in WIDTHS:
            still, slip = (_released(sphere, ratio, times, moves) for moves in ("still", "slip"))
            spread = sphere.mu / sphere.rho * times / (ratio * sphere.d) ** 2
            columns = (multiples, spread, still.v / final, still.u_self / final, slip.v / final, slip.u_self / final)
            rows += [(fluid, ratio, *(float(value) for value in row)) for row in zip(*columns)]
    return rows


def hasimoto_rows():
    """(L/d, phi, K with 2, 4 and 6 terms, then the corrected two-way Stokes grain over its Stokes speed at h/d = 1, 2, 3).

    The latter only where the two supports, 4 h, fit into the cell.
    """
    rows = []
    for cell in (2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0, 40.0, 60.0, 100.0):
        fraction = hasimoto.volume_fraction(cell)
        series = [hasimoto.inverse_drag(fraction, terms) for terms in (2, 4, 6)]
        corrected = [
            hasimoto.corrected_speed(self_disturbance.one_kernel(KERNEL, ratio), 1.0, cell) if 4.0 * ratio < cell else ""
            for ratio in (1.0, 2.0, 3.0)
        ]
        rows.append((cell, fraction, *series, *corrected))
    return rows
