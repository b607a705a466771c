"""A shear wave on particles off their lattice: the viscous sum as a random network, built here from its definition (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.sparse import bmat, csr_matrix, diags
from scipy.sparse.linalg import expm_multiply
from scipy.spatial import cKDTree

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import sph_operators  # noqa: E402

UNITS = {name: "1" for name in ("noise", "rate_error", "noise_over_network", "amplitude_over_network")}


class Network:
    """The linear equations of the sums on a fixed set of points: README, equation (2). All masses and volumes are equal."""

    def __init__(self, scene, x):
        fluid, self.size = scene["fluid"], np.array(scene["domain"]["size"])
        self.h, self.nu = fluid["smoothing"] * fluid["spacing"], fluid["viscosity"] / fluid["density"]
        self.c, self.volume = fluid["sound_speed"], fluid["spacing"] ** 2
        self.k = 2.0 * math.pi * fluid["initial"]["waves"] / self.size[1]
        self.x = np.mod(x[:, :2], self.size)
        self._pairs(fluid["kernel"])

    def _pairs(self, name):
        kernel, reach = sph_operators.KERNELS[name], sph_operators.support(name) * self.h
        pairs = cKDTree(self.x, boxsize=self.size).query_pairs(reach, output_type="ndarray")
        self.a, self.b = np.concatenate([pairs, pairs[:, ::-1]]).T
        apart = self.x[self.a] - self.x[self.b]
        self.apart = apart - self.size * np.round(apart / self.size)
        r = np.linalg.norm(self.apart, axis=1)
        self.weight = self.volume * kernel.sigma[2] / self.h**3 * kernel.slope(r / self.h) / r  # V W'/r; times apart: V grad W

    def _sum_of(self, weight, sign):
        """Matrix of sum_b weight (q_a + sign q_b)."""
        count = len(self.x)
        both = csr_matrix((weight, (self.a, self.b)), shape=(count, count))
        return diags(np.ravel(both.sum(axis=1))) + sign * both

    def viscosity(self):
        return self._sum_of(2.0 * self.nu * self.weight, -1.0)

    def equations(self):
        """Matrix of d(u, v, s)/dt, s = c rho'/rho_0: viscosity, symmetric pressure sum, continuity."""
        viscous = self.viscosity()
        slopes = [self.c * self.weight * self.apart[:, axis] for axis in (0, 1)]
        push = [-self._sum_of(slope, 1.0) for slope in slopes]
        gain = [self._sum_of(slope, -1.0) for slope in slopes]
        return bmat([[viscous, None, push[0]], [None, viscous, push[1]], [gain[0], gain[1], None]]).tocsr()

    def velocity(self, t):
        """[n] of u_x/U at time t."""
        count = len(self.x)
        start = np.concatenate([np.sin(self.k * self.x[:, 1]), np.zeros(2 * count)])
        return expm_multiply(self.equations() * t, start)[:count]

    def viscous_velocity(self, t):
        """The same without pressure."""
        return expm_multiply(self.viscosity() * t, np.sin(self.k * self.x[:, 1]))


def amplitude(k, y, u):
    """Projection of u on sin(ky), as the probe takes it."""
    return 2.0 * float(np.mean(u * np.sin(k * y)))


def noise(k, y, u):
    """Root mean square of what is no sine, over the sine's own amplitude."""
    shapes = np.stack([np.sin(k * y), np.cos(k * y)], axis=1)
    found, *_ = np.linalg.lstsq(shapes, u, rcond=None)
    return float(np.sqrt(np.mean((u - shapes @ found) ** 2)) / np.hypot(*found))


def measured(run):
    """(noise, relative error of the decay rate) at the end of a run."""
    last = run.snapshot(-1)
    fluid, scene = last["fluid"], run.scene
    k = 2.0 * math.pi * scene["fluid"]["initial"]["waves"] / scene["domain"]["size"][1]
    t, a = (np.ravel(part) for part in run.series("amplitude"))
    rate = -math.log(a[-1] / a[0]) / (t[-1] - t[0])
    return (noise(k, fluid["x"][:, 1], fluid["v"][:, 0]),
            rate / (scene["fluid"]["viscosity"] / scene["fluid"]["density"] * k**2) - 1.0)


def against_network(run):
    """(noise, amplitude) of a run over those of the network on the run's own first points."""
    network, last = Network(run.scene, run.snapshot(0)["fluid"]["x"]), run.snapshot(-1)
    y, u = network.x[:, 1], network.velocity(last["time"])
    mine = last["fluid"]["v"][:, 0] / run.scene["fluid"]["initial"]["speed"]
    return (noise(network.k, y, mine) / noise(network.k, y, u), amplitude(network.k, y, mine) / amplitude(network.k, y, u))


def measure(quantity, run):
    if quantity in ("noise", "rate_error"):
        return measured(run)[quantity == "rate_error"]
    if quantity in ("noise_over_network", "amplitude_over_network"):
        return against_network(run)[quantity == "amplitude_over_network"]
    return NotImplemented


def reference(quantity, scene, t):
    return {"noise": 0.0, "rate_error": 0.0, "noise_over_network": 1.0, "amplitude_over_network": 1.0}[quantity]


def figures(runs):
    return [("particles", _particles(runs), "Particles at the end, coloured by what their velocity has besides the wave."),
            ("against_jitter", _against_jitter(runs), "Noise and error of the decay rate against the disorder of the start, spacing 0.02.")]


def _at_standard(runs):
    return [run for run in runs if run.scene["fluid"]["spacing"] == 0.02 and run.variant != "wide"]


def _kind(run):
    """Set of models of a run: the preset, the scene's with shifting, or the plain ones."""
    if run.variant == "plumb":
        return "plumb"
    return "shifted" if "shifting" in run.scene["fluid"] else "plain"


def _particles(runs):
    from matplotlib.figure import Figure

    chosen = [run for run in _at_standard(runs) if run.variant != "jitter_01"]
    figure = Figure(figsize=(3.1 * len(chosen), 3.3), layout="constrained")
    for axes, run in zip(figure.subplots(1, len(chosen), squeeze=False)[0], chosen):
        fluid, k = run.snapshot(-1)["fluid"], 2.0 * math.pi / run.scene["domain"]["size"][1]
        y, u = fluid["x"][:, 1], fluid["v"][:, 0] / run.scene["fluid"]["initial"]["speed"]
        rest = u - amplitude(k, y, u) * np.sin(k * y)
        points = axes.scatter(fluid["x"][:, 0], y, c=rest, s=5, cmap="coolwarm", vmin=-0.05, vmax=0.05)
        axes.set(xlim=(0, 0.5), ylim=(0, 0.5), aspect="equal", title=run.variant, xlabel="x (m)", ylabel="y (m)")
        axes.grid(False)
    figure.colorbar(points, ax=figure.axes, label="(u - wave)/U (-)", shrink=0.7)
    return figure


def _against_jitter(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 3.6), layout="constrained")
    axes = figure.subplots()
    for label, mark in (("plain", "o"), ("shifted", "s"), ("plumb", "^")):
        chosen = [run for run in _at_standard(runs) if _kind(run) == label]
        jitter = [run.scene["fluid"]["arrange"]["jitter"] for run in chosen]
        axes.plot(jitter, [measured(run)[0] for run in chosen], mark, color="C0", label=f"noise, {label}")
        axes.plot(jitter, [measured(run)[1] for run in chosen], mark, color="C1", label=f"error of the rate, {label}")
    axes.set(xlabel="jitter of the start (spacings)", ylabel="over U, over nu k² (-)")
    axes.legend()
    return figure
