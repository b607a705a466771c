"""Where the step of smoothed particles stops being stable: linear theory of the sums over a lattice (README.md)."""

import itertools
import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import sph_operators  # noqa: E402

UNITS = {name: "1" for name in ("disorder", *(f"{limit}.{kind}" for limit in ("acoustic", "viscous", "diffusion", "shifting")
                                              for kind in ("stable", "unstable", "boundary")))}

# Shares that the solver documents (plumb check): 0.25 h/c (less without damping), 0.6 over the viscous rate and that of density diffusion, 1 over the rate of shifting.
SHARE = {"acoustic": 0.25, "viscous": 0.6, "diffusion": 0.6, "shifting": 1.0}
GROWTH = math.sqrt(2.0)  # of an amplitude while its energy doubles, which ends the measurement
STRENGTH = {"morris": lambda d: 2.0, "monaghan_gingold": lambda d: 2.0 * (d + 2), "cleary": lambda d: 2.0 * 4.96333}


class Lattice:
    """The particles of a scene on their undisturbed lattice, and what its sums make of the waves of the box."""

    def __init__(self, scene):
        fluid, size = scene["fluid"], scene["domain"]["size"]
        self.fluid, self.d = fluid, len(size)
        self.dx, self.h = fluid["spacing"], fluid["smoothing"] * fluid["spacing"]
        self.nu = fluid["viscosity"] / fluid["density"]
        self.kernel = sph_operators.KERNELS[fluid["kernel"]]
        self.x = self.dx * sph_operators._lattice(sph_operators.support(fluid["kernel"]) * self.h / self.dx, self.d)
        self.r = np.linalg.norm(self.x, axis=1)
        counts = [round(side / self.dx) for side in size]
        waves = itertools.product(*(range(n // 2 + 1) for n in counts))
        self.k = np.array([2.0 * math.pi * np.array(m) / size for m in waves if any(m)])
        self.phase = self.k @ self.x.T

    def f(self, r):
        """F of grad W = F x, times the particle's volume [1/m2]."""
        q = r / self.h
        return self.dx**self.d * self.kernel.sigma[self.d] / self.h ** (self.d + 2) * self.kernel.slope(q) / q

    def gradients(self):
        """[k, d]: grad q -> i g q."""
        return -(np.sin(self.phase) * self.f(self.r)) @ self.x

    def differences(self, weights):
        """[k, ...]: sum (1 - cos k.x) weights over the neighbours; weights [n, ...]."""
        return np.tensordot(1.0 - np.cos(self.phase), weights, axes=1)

    def viscosities(self):
        """[k, d, d], 1/s: dv/dt = -viscosities v."""
        term = self.fluid["viscous_term"]
        if term == "none":
            return np.zeros((len(self.k), self.d, self.d))
        weight = -STRENGTH[term](self.d) * self.nu * self.f(self.r)
        if term == "morris":
            return self.differences(weight)[:, None, None] * np.eye(self.d)
        weight = weight / (self.r**2 + 0.01 * self.h**2)
        return self.differences(weight[:, None, None] * self.x[:, :, None] * self.x[:, None, :])

    def rates(self):
        """[k, d + 1] complex, 1/s: eigenvalues of d(v, rho'/rho c)/dt for every wave of the box."""
        d, c = self.d, self.fluid["sound_speed"]
        matrix = np.zeros((len(self.k), d + 1, d + 1), complex)
        matrix[:, :d, :d] = -self.viscosities()
        matrix[:, :d, d] = matrix[:, d, :d] = -1j * c * self.gradients()
        matrix[:, d, d] = self.differences(self.diffusion() * self.f(self.r))
        return np.linalg.eigvals(matrix)

    def concentration_rates(self):
        """[k, d], 1/s: shifting takes a displacement back at this rate (negative: it drives it on)."""
        step = 1e-5 * self.h
        f, slope = self.f(self.r), (self.f(self.r + step) - self.f(self.r - step)) / (2.0 * step)
        hessian = f[:, None, None] * np.eye(self.d) + (slope / self.r)[:, None, None] * self.x[:, :, None] * self.x[:, None, :]
        diffusivity = self.fluid["shifting"] * self.h * self.fluid["reference_velocity"]
        return diffusivity * np.linalg.eigvalsh(self.differences(hessian))

    def phaseless_sum(self):
        """1/m2: sum V (-F) over many neighbours: what a wave feels whose phases differ as if by chance."""
        q, weight = sph_operators._nodes(self.fluid["kernel"])
        return weight @ (-self.kernel.sigma[self.d] * self.kernel.slope(q) / q * sph_operators.SHELL[self.d](q)) / self.h**2

    def phaseless_viscous_rate(self):
        """1/s: the same of the viscous term."""
        term = self.fluid["viscous_term"]
        return STRENGTH[term](self.d) * self.nu * self.phaseless_sum() / (1.0 if term == "morris" else self.d)

    def diffusion(self):
        """2 delta h c, m2/s."""
        return 2.0 * self.fluid.get("density_diffusion", 0.0) * self.h * self.fluid["sound_speed"]


def decay_share(integrator):
    """1/(1 + b): the greatest decay rate times the step at which the integrator is stable (README)."""
    return {"midpoint": 1.0, "damped_midpoint": 1.0 / 1.5}[integrator]


def undamped_share(lattice, integrator):
    """By how much the documented acoustic limit shrinks where the plain midpoint step has too little damping (README)."""
    fluid = lattice.fluid
    if integrator != "midpoint" or fluid.get("density_diffusion", 0.0) >= 0.05:
        return 1.0
    alpha = fluid.get("artificial_viscosity", 0.0)
    hc = lattice.h * fluid["sound_speed"]
    nu = lattice.nu + alpha * hc / (4.0 * (lattice.d + 2.0))
    return min(max((100.0 * nu / hc) ** (1.0 / 3.0), 0.1), 1.0)


def predicted_limit(lattice, name, integrator):
    """The step limit `name` at factor 1, s, by its documented formula."""
    if name == "acoustic":
        return SHARE[name] * undamped_share(lattice, integrator) * lattice.h / lattice.fluid["sound_speed"]
    if name == "viscous":
        greatest = np.linalg.eigvalsh(lattice.viscosities()).max()
        return SHARE[name] * decay_share(integrator) / max(greatest, lattice.phaseless_viscous_rate())
    if name == "diffusion":
        greatest = max(lattice.differences(-lattice.diffusion() * lattice.f(lattice.r)).max(), lattice.diffusion() * lattice.phaseless_sum())
        return SHARE[name] * decay_share(integrator) / greatest
    return SHARE[name] / lattice.concentration_rates().max()


def midpoint_growth(z):
    """Greatest |r| of the midpoint step with a predicted state for y' = y z/dt: r^2 - (1 + 3z/2) r + z/2 = 0."""
    half = 0.5 * (1.0 + 1.5 * z)
    root = np.sqrt(half**2 - 0.5 * z + 0j)
    return np.maximum(abs(half + root), abs(half - root))


def damped_midpoint_growth(z, memory=0.5):
    """The same with y* = y + dt/2 [(1 + b) y'_before - b y'_before_that]: (r - 1)(r^2 - z/2 [(1 + b) r - b]) = z r^2."""
    a = 0.5 * (1.0 + memory) * z
    companion = np.zeros((*z.shape, 3, 3), complex)
    companion[..., 0, 0], companion[..., 0, 1] = 1.0 + z + a, -(a + 0.5 * memory * z)
    companion[..., 0, 2] = 0.5 * memory * z
    companion[..., 1, 0] = companion[..., 2, 1] = 1.0
    return abs(np.linalg.eigvals(companion)).max(axis=-1)


def shifting_growth(z):
    """|r| of x <- x + D dt (-grad C): r = 1 + z, for z = -rate dt."""
    return abs(1.0 + z)


# integrator -> growth factor of a step; another integrator needs its characteristic polynomial here, nothing else.
INTEGRATORS = {"midpoint": midpoint_growth, "damped_midpoint": damped_midpoint_growth}


def boundary(scene, name):
    """The factor on the limit `name` at which the fastest wave of the box grows by GROWTH within the run."""
    lattice = Lattice(scene)
    limit = predicted_limit(lattice, name, scene["time"]["integrator"])
    shifts = name == "shifting"
    rates = -lattice.concentration_rates().max() if shifts else lattice.rates().ravel()
    growth = shifting_growth if shifts else INTEGRATORS[scene["time"]["integrator"]]

    def grows(factor):
        dt = factor * limit
        return scene["time"]["end"] / dt * math.log(max(np.max(growth(rates * dt)), 1e-300)) > math.log(GROWTH)

    factors = np.geomspace(0.1, 10.0, 400)  # the first that grows: growth need not be monotonous beyond
    first = next(i for i, factor in enumerate(factors) if grows(factor))
    low, high = factors[first - 1], factors[first]
    while high / low > 1.0 + 1e-6:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if grows(middle) else (middle, high)
    return low


def reference(quantity, scene, t):
    name, kind = quantity.split(".")
    if kind == "boundary":
        return boundary(scene, name)
    raise KeyError(quantity)


def disorder(run):
    """(t, root of the mean square distance from the nearest site of the lattice, in spacings) of every snapshot."""
    dx, times, values = run.scene["fluid"]["spacing"], [], []
    for k in range(len(run.snapshot_files())):
        state = run.snapshot(k)
        site = state["fluid"]["x"][:, :len(run.scene["domain"]["size"])] / dx - 0.5
        away = site - np.round(site)
        times.append(state["time"])
        values.append(math.sqrt(np.mean(np.sum(away**2, axis=1))))
    return np.array(times), np.array(values)


def measure(quantity, run):
    return disorder(run) if quantity == "disorder" else NotImplemented
