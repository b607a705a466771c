"""A square patch of fluid that turns without walls: ballistic corners, conserved quantities, and the shape by potential flow (README.md)."""

import math
from functools import lru_cache

import numpy as np

UNITS = {
    "corner": "m",
    "corner_late": "m",
    "waist": "m",
    "centre_pressure": "Pa",
    "angular_momentum": "1",
    "kinetic_energy_left": "1",
    "roughness": "1",
    "hole": "1",
}
NODES, DEGREE, STEPS = 200, 8, 200  # nodes on a side, powers of z^4, steps to rate t = 1 (README: what they change)


class Patch:
    """initial = {law = "rotating_square", rate = w, side = L, centre}: u = w (y_c - y, x - x_c), no gravity, no viscosity."""

    def __init__(self, scene):
        fluid, initial = scene["fluid"], scene["fluid"]["initial"]
        self.rate, self.side, self.centre = initial["rate"], initial["side"], np.array(initial["centre"])
        self.rho, self.spacing = fluid["density"], fluid["spacing"]

    def corner(self, turned, start=None):
        """Distance of a corner from the middle, m, at rate t = turned: no pressure gradient acts on it, it flies straight."""
        start = self.side / math.sqrt(2.0) if start is None else start
        return start * math.sqrt(1.0 + turned**2)


def potential(z, phi):
    """(f, df/dz, f at the middle) of the polynomial f in z^4 whose real part is phi at the boundary's nodes z [n], least squares.

    A quarter of the boundary is enough: the patch keeps the square's symmetry.
    """
    scale = np.abs(z).max()
    powers = 4 * np.arange(DEGREE + 1)
    terms = (z[:, None] / scale) ** powers
    around = np.concatenate([-1j * z[-1:], z, 1j * z[:1]])
    weight = np.sqrt(np.abs(np.gradient(around))[1:-1])[:, None]
    matrix = np.hstack([terms.real, -terms[:, 1:].imag])
    found = np.linalg.lstsq(matrix * weight, phi * weight[:, 0], rcond=1e-12)[0]
    c = found[: DEGREE + 1].astype(complex)
    c[1:] += 1j * found[DEGREE + 1:]
    return terms @ c, (terms * powers / z[:, None]) @ c, c[0].real


def rates(z, phi):
    """(dz/dt, dphi/dt, phi in the middle) of the surface in the frame that turns with the patch (README, equation 3)."""
    f, slope, middle = potential(z, phi)
    return np.conj(slope), 0.5 * np.abs(slope) ** 2 - 2.0 * f.imag + 0.5 * np.abs(z) ** 2, middle


@lru_cache(maxsize=None)
def shape(turned):
    """(waist/L, centre pressure/(rho w^2 L^2)) at rate t = turned <= 1, by the fourth-order Runge-Kutta rule."""
    if turned > 1.0:
        raise ValueError("the shape is computed up to rate t = 1: later the surface's own instability grows out of the fit")
    z = 0.5 - 0.5j * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
    phi, dt = np.zeros(NODES), turned / STEPS
    middles = []
    for _ in range(STEPS):
        k1 = rates(z, phi)
        k2 = rates(z + 0.5 * dt * k1[0], phi + 0.5 * dt * k1[1])
        k3 = rates(z + 0.5 * dt * k2[0], phi + 0.5 * dt * k2[1])
        k4 = rates(z + dt * k3[0], phi + dt * k3[1])
        middles.append(k1[2])
        z = z + dt / 6.0 * (k1[0] + 2.0 * k2[0] + 2.0 * k3[0] + k4[0])
        phi = phi + dt / 6.0 * (k1[1] + 2.0 * k2[1] + 2.0 * k3[1] + k4[1])
    middles.append(rates(z, phi)[2])
    recent = np.array(middles[-5:])  # p/rho = -dphi/dt in the middle: backward difference of fourth order
    slope = recent @ np.array([3.0, -16.0, 36.0, -48.0, 25.0]) / (12.0 * dt)
    return float(np.abs(z).min()), float(-slope)


def state(run, turned):
    """Positions from the middle [n, 2], velocities, pressures, ids at rate t = turned."""
    patch, files = Patch(run.scene), len(run.snapshot_files())
    step = turned / patch.rate / run.scene["time"]["end"] * (files - 1)
    snapshot = run.snapshot(round(step))
    if not math.isclose(snapshot["time"] * patch.rate, turned, rel_tol=1e-6, abs_tol=1e-9):
        raise ValueError(f"no snapshot at rate t = {turned}")
    fluid = snapshot["fluid"]
    return fluid["x"][:, :2] - patch.centre, fluid["v"][:, :2], fluid["p"], fluid["id"]


def corner(run, turned):
    """Mean distance of the four corner particles, over where they started, times that of the square's corners, m."""
    first, _, _, ids = state(run, 0.0)
    start = np.linalg.norm(first, axis=1)
    four = ids[start > start.max() * (1.0 - 1e-9)]
    x, _, _, now = state(run, turned)
    moved = np.linalg.norm(x[np.isin(now, four)], axis=1).mean()
    return float(moved / start.max() * Patch(run.scene).side / math.sqrt(2.0))


def waist(run, turned):
    """Least over directions of the greatest distance of a particle, and half a spacing, m; quarters laid on each other, in
    sectors that hold two spacings of the square's side."""
    x, _, _, _ = state(run, turned)
    sectors = round(0.5 * Patch(run.scene).side / Patch(run.scene).spacing)
    r, angle = np.linalg.norm(x, axis=1), np.mod(np.arctan2(x[:, 1], x[:, 0]), 0.5 * math.pi)
    sector = np.minimum((angle / (0.5 * math.pi) * sectors).astype(int), sectors - 1)
    return float(min(r[sector == n].max() for n in range(sectors)) + 0.5 * Patch(run.scene).spacing)


def centre_pressure(run, turned):
    """Pressure in the middle, Pa: p = p_0 + b r^2 fitted to the particles within a tenth of the side."""
    x, _, p, _ = state(run, turned)
    r_sq = np.sum(x**2, axis=1)
    near = r_sq < (0.1 * Patch(run.scene).side) ** 2
    return float(np.polyfit(r_sq[near], p[near], 1)[1])


def hole(run, turned):
    """Greatest distance of a place within 0.2 sides of the middle from the nearest particle, in spacings (lattice: 0.71)."""
    from scipy.spatial import cKDTree

    patch = Patch(run.scene)
    x, _, _, _ = state(run, turned)
    line = np.linspace(-0.2, 0.2, 81) * patch.side
    places = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    places = places[np.linalg.norm(places, axis=1) < 0.2 * patch.side]
    return float(cKDTree(x).query(places)[0].max() / patch.spacing)


def angular_momentum(run, turned):
    """Over that at the start."""
    x, v, _, _ = state(run, turned)
    x0, v0, _, _ = state(run, 0.0)
    turn = lambda a, b: np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])  # noqa: E731
    return float(turn(x, v) / turn(x0, v0))


def roughness(run, turned):
    """Root mean square of pressure less the mean of the particle and its eight neighbours, within 0.3 sides, over rho w^2 L^2."""
    from scipy.spatial import cKDTree

    patch = Patch(run.scene)
    x, _, p, _ = state(run, turned)
    near = cKDTree(x).query(x, k=9)[1]
    inner = np.linalg.norm(x, axis=1) < 0.3 * patch.side
    return float(np.sqrt(np.mean((p - p[near].mean(axis=1))[inner] ** 2)) / (patch.rho * (patch.rate * patch.side) ** 2))


def reference(quantity, scene, t):
    patch = Patch(scene)
    if quantity == "corner":
        return patch.corner(1.0)
    if quantity == "corner_late":
        return patch.corner(2.0)
    if quantity == "waist":
        return shape(1.0)[0] * patch.side
    if quantity == "centre_pressure":
        return shape(1.0)[1] * patch.rho * (patch.rate * patch.side) ** 2
    if quantity in ("angular_momentum", "kinetic_energy_left"):
        return 1.0
    if quantity == "roughness":
        return 0.0
    raise KeyError(quantity)


def measure(quantity, run):
    if quantity == "corner":
        return corner(run, 1.0)
    if quantity == "corner_late":
        return corner(run, 2.0)
    if quantity == "waist":
        return waist(run, 1.0)
    if quantity == "centre_pressure":
        return centre_pressure(run, 1.0)
    if quantity == "angular_momentum":
        return angular_momentum(run, 2.0)
    if quantity == "kinetic_energy_left":
        energy = run.series("kinetic_energy")[1]
        return float(energy[-1] / energy[0])
    if quantity == "roughness":
        return roughness(run, 1.0)
    if quantity == "hole":
        return hole(run, 2.0)
    return NotImplemented


def figures(runs):
    """The patch of every variant's finest run at rate t = 0.5, 1, 2, coloured by pressure, with the ballistic corners."""
    from matplotlib.figure import Figure

    finest = {run.variant: run for run in runs if not run.failure}
    times = (0.5, 1.0, 2.0)
    figure = Figure(figsize=(9.0, 3.0 * len(finest)), layout="constrained")
    rows = np.atleast_2d(figure.subplots(len(finest), len(times)))
    for row, (name, run) in zip(rows, finest.items()):
        patch = Patch(run.scene)
        scale = patch.rho * (patch.rate * patch.side) ** 2
        for axes, turned in zip(row, times):
            x, _, p, _ = state(run, turned)
            drawn = axes.scatter(x[:, 0], x[:, 1], c=p / scale, s=1.5, cmap="coolwarm", vmin=-0.15, vmax=0.15, linewidths=0)
            angle = 0.25 * math.pi + math.atan(turned) + 0.5 * math.pi * np.arange(4)
            axes.plot(patch.corner(turned) * np.cos(angle), patch.corner(turned) * np.sin(angle), "k+", ms=7)
            axes.set_aspect("equal")
            axes.set_title(f"{name}, rate t = {turned:g}", fontsize="small")
    figure.colorbar(drawn, ax=rows, shrink=0.5, label="p/(rho w^2 L^2)")
    return [("patch", figure, "The patch at the finest spacing, coloured by pressure; crosses: the exact places of the corners.")]
