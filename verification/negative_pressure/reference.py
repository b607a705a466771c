"""Small displacements of a particle lattice under uniform pressure: growth rates, and energy of a random start (README.md)."""

import sys
from pathlib import Path

import numpy as np
from scipy.optimize import brentq
from scipy.spatial import cKDTree

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import sph_operators, tait  # noqa: E402

UNITS = {"kinetic_energy": "m2/s2", "prediction_error": "1", "nearest_distance": "1", "paired_distance": "1"}
LINEAR = 1e-7  # kinetic energy over c^2 up to which displacements stay below a hundredth of a spacing (README)


class Lattice:
    """Square lattice of a scene with initial = {law = "uniform_pressure"}; equations (1) to (4) of the README."""

    def __init__(self, scene):
        fluid = scene["fluid"]
        self.fluid, self.spacing = fluid, fluid["spacing"]
        self.h = fluid["smoothing"] * self.spacing
        self.rho0, self.c = fluid["density"], fluid["sound_speed"]
        self.pressure = fluid["initial"]["pressure"]
        self.rho = float(tait.density(self.pressure, self.rho0, self.c))
        self.mass = self.rho0 * self.spacing**2
        self.nu = fluid["viscosity"] / self.rho
        self.cells = [round(side / self.spacing) for side in scene["domain"]["size"]]
        self.size = scene["domain"]["size"]
        self.jitter = fluid["arrange"].get("jitter", 0.0) * self.spacing
        self.shifting = fluid.get("shifting", 0.0) * self.h * fluid.get("reference_velocity", 0.0)
        self.diffusion = fluid.get("density_diffusion", 0.0)

    def wave_vectors(self):
        """[n, 2], 1/m: all waves of the box, the uniform one left out."""
        k = [2.0 * np.pi * np.fft.fftfreq(n, self.spacing) for n in self.cells]
        grid = np.stack(np.meshgrid(*k, indexing="ij"), axis=-1).reshape(-1, 2)
        return grid[1:]

    def _neighbours(self):
        reach = sph_operators.support(self.fluid["kernel"]) * self.h / self.spacing
        side = np.arange(-int(reach) - 1, int(reach) + 2)
        points = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
        length = np.linalg.norm(points, axis=1)
        return self.spacing * points[(length > 0) & (length < reach)]

    def sums(self, k):
        """G [n, 2] = sum grad W sin(k.r), D [n, 2, 2] = sum (grad grad W)(1 - cos k.r), and sum W'/r (1 - cos k.r) [n]."""
        x = self._neighbours()
        r = np.linalg.norm(x, axis=1)
        kernel = sph_operators.KERNELS[self.fluid["kernel"]]
        scale = kernel.sigma[2] / self.h**3
        slope = scale * kernel.slope(r / self.h)
        step = 1e-5
        bend = scale / self.h * (kernel.slope(r / self.h + step) - kernel.slope(r / self.h - step)) / (2.0 * step)
        along = x[:, :, None] * x[:, None, :] / r[:, None, None] ** 2
        hessian = bend[:, None, None] * along + (slope / r)[:, None, None] * (np.eye(2) - along)
        phase = k @ x.T
        one_less = 2.0 * np.sin(0.5 * phase) ** 2
        gradient = np.sin(phase) @ ((slope / r)[:, None] * x)
        return gradient, np.einsum("nr,rij->nij", one_less, hessian), one_less @ (slope / r)

    def matrices(self, k):
        """[n, 5, 5]: rates of (xi_x, xi_y, v_x, v_y, s) with s = -i delta rho, equation (3) of the README."""
        g, d, radial = self.sums(k)
        m, rho, p = self.mass, self.rho, self.pressure
        slope = self.c**2 * (rho / self.rho0) ** (tait.GAMMA - 1.0)  # dp/d rho
        ratio, change = p / rho**2, slope / rho**2 - 2.0 * p / rho**3
        matrix = np.zeros((len(k), 5, 5))
        matrix[:, 0:2, 2:4] = np.eye(2)
        matrix[:, 0:2, 0:2] = -self.shifting * m / rho * d
        matrix[:, 0:2, 4] = self.shifting * m / rho**2 * g
        matrix[:, 2:4, 0:2] = -2.0 * m * ratio * d
        matrix[:, 2:4, 2:4] = (2.0 * self.nu * m / rho * radial)[:, None, None] * np.eye(2)
        matrix[:, 2:4, 4] = -m * change * g
        matrix[:, 4, 2:4] = m * g
        matrix[:, 4, 4] = 2.0 * self.diffusion * self.h * self.c * m / rho * radial
        return matrix

    def growth_rates(self):
        """[n] of the waves of the box, 1/s: the largest real part of each."""
        return np.linalg.eigvals(self.matrices(self.wave_vectors())).real.max(axis=1)

    def kinetic_energy(self, t, displacement):
        """Mean v^2/2 at times t from displacements [n, 2] of the particles in order of their ids, v = 0, rho uniform."""
        grid = displacement.reshape(self.cells[1], self.cells[0], 2)  # ids run along x first
        start = np.fft.fft2(grid, axes=(0, 1)).transpose(1, 0, 2).reshape(-1, 2)[1:] / len(displacement)
        values, vectors = np.linalg.eig(self.matrices(self.wave_vectors()))
        share = np.linalg.solve(vectors, np.pad(start, ((0, 0), (0, 3)))[:, :, None].astype(complex))[:, :, 0]
        grown = [np.einsum("nij,nj->ni", vectors[:, 2:4], np.exp(values * time) * share) for time in t]
        return np.array([0.5 * (np.abs(v) ** 2).sum() for v in grown])

    def gained_density(self, shift):
        """What continuity adds when every second column of the lattice moves by 2 `shift` towards its neighbour, kg/m3."""
        kernel, side = sph_operators.KERNELS[self.fluid["kernel"]], np.arange(-8, 9)
        column, row = np.meshgrid(side, side, indexing="ij")

        def density(moved):
            x = column * self.spacing - np.where(column % 2 == 1, 2.0 * moved, 0.0)
            return self.mass * kernel.sigma[2] / self.h**2 * kernel.w(np.hypot(x, row * self.spacing) / self.h).sum()

        return density(shift) - density(0.0)

    def paired_distance(self):
        """Distance of paired columns over the spacing: equation (4) of the README; 0 when the pairs collapse."""
        missing, most = self.rho0 - self.rho, 0.5 * self.spacing
        if self.gained_density(most) < missing:
            return 0.0
        return 1.0 - 2.0 * brentq(lambda shift: self.gained_density(shift) - missing, 0.0, most) / self.spacing

    def displacements(self, x):
        """[n, 2] from the lattice sites at half spacings."""
        return (np.mod(x / self.spacing, 1.0) - 0.5) * self.spacing


def nearest(scene, x):
    """[n] distance of every particle to its nearest one, over the spacing."""
    size = scene["domain"]["size"]
    distance, _ = cKDTree(np.mod(x[:, :2], size), boxsize=size).query(np.mod(x[:, :2], size), k=2)
    return distance[:, 1] / scene["fluid"]["spacing"]


def compared(run):
    """(t, measured, predicted) kinetic energies while the prediction is linear; the start, where both are zero, is left out."""
    t, measured = (np.ravel(part) for part in run.series("kinetic_energy"))
    lattice, first = Lattice(run.scene), run.snapshot(0)["fluid"]
    predicted = lattice.kinetic_energy(t, lattice.displacements(first["x"][:, :2]))
    linear = (t > 0.0) & (np.maximum.accumulate(predicted) < LINEAR * lattice.c**2)
    return t[linear], measured[linear], predicted[linear]


def measure(quantity, run):
    if quantity == "prediction_error":
        _, measured, predicted = compared(run)
        return float(np.abs(np.log(measured / predicted)).max())
    if quantity in ("nearest_distance", "paired_distance"):
        return float(nearest(run.scene, run.snapshot(-1)["fluid"]["x"]).mean())
    return NotImplemented


def reference(quantity, scene, t):
    if quantity == "prediction_error":
        return 0.0
    if quantity == "nearest_distance":
        return 1.0  # of the lattice
    if quantity == "paired_distance":
        return Lattice(scene).paired_distance()
    raise KeyError(quantity)


def figures(runs):
    return [("particles", _particles(runs), "Particles at the end. Under tension the plain scheme draws them into clumps."),
            ("growth", _growth(runs), "Kinetic energy (points) and linear theory from the same start (lines).")]


def _by_label(runs):
    return {f"{run.variant}, p = {run.scene['fluid']['initial']['pressure']:g} Pa": run for run in runs}


def _particles(runs):
    from matplotlib.figure import Figure

    chosen = {label: run for label, run in _by_label(runs).items() if run.variant not in ("plain", "compressed", "weak")}
    figure = Figure(figsize=(3.0 * len(chosen), 3.3), layout="constrained")
    for axes, (label, run) in zip(figure.subplots(1, len(chosen), squeeze=False)[0], chosen.items()):
        x = np.mod(run.snapshot(-1)["fluid"]["x"][:, :2], run.scene["domain"]["size"])
        axes.plot(x[:, 0], x[:, 1], ".", markersize=1.5)
        axes.set(xlim=(0, 0.5), ylim=(0, 0.5), aspect="equal", title=label, xlabel="x (m)", ylabel="y (m)")
        axes.grid(False)
    return figure


def _growth(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.5, 3.8), layout="constrained")
    axes = figure.subplots()
    plain = [run for run in runs if run.variant in ("weak", "strong", "compressed")]
    for number, run in enumerate(plain):
        t, measured = (np.ravel(part) for part in run.series("kinetic_energy"))
        colour = f"C{number}"
        axes.semilogy(t[1:], measured[1:], ".", color=colour, label=f"p = {run.scene['fluid']['initial']['pressure']:g} Pa")
        t, _, predicted = compared(run)
        axes.semilogy(t, predicted, "-", color=colour)
    axes.set(xlabel="t (s)", ylabel="mean v²/2 (m²/s²)")
    axes.legend()
    return figure
