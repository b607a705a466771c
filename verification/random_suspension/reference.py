"""Slip of random periodic suspensions under Di Felice's law, and what correlated places add to it (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import brentq
from scipy.spatial import cKDTree

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import di_felice  # noqa: E402
from theory import self_disturbance, sph_operators  # noqa: E402
from theory.packed_beds import richardson_zaki_exponent  # noqa: E402
from theory.settling import archimedes, hindered_re  # noqa: E402

UNITS = {"at_grain": "1", "under_stress": "1", "off_theory": "1", "momentum": "1"}
REACH = 10.0  # of wave vectors, over h: the product of two kernels is below 1e-5 there


class Bed:
    """The scene's numbers; speeds of settling grains are positive."""

    def __init__(self, scene, grains):
        fluid, grain = scene["fluid"], scene["grains"]
        self.rho, self.mu, self.kernel = fluid["density"], fluid["viscosity"], fluid["kernel"]
        self.d, self.rho_p, self.g = grain["diameter"], grain["density"], -scene["domain"]["gravity"][2]
        self.side, self.grains = scene["domain"]["size"][0], grains
        self.smoothing = fluid["smoothing"] * fluid["spacing"]
        self.h = scene["coupling"]["kernel_width"]["times_smoothing"] * self.smoothing
        self.volume = math.pi / 6.0 * self.d**3
        self.phi = grains * self.volume / self.side**3
        self.eps = 1.0 - self.phi

    @property
    def weight(self):
        """Weight less buoyancy of a grain, N."""
        return (self.rho_p - self.rho) * self.volume * self.g

    def slip(self, eps, held=None):
        """Interstitial slip, m/s, at which the law told `eps` gives a drag of `held` weights (eps of the bed when not given)."""
        held = self.eps if held is None else held
        stokes = (self.rho_p - self.rho) * self.g * self.d**2 / (18.0 * self.mu)

        def excess(w):
            u_s = eps * w
            drag = 3.0 * math.pi * self.mu * self.d * u_s * float(di_felice(eps, self.rho * self.d * u_s / self.mu))
            return drag / (held * self.weight) - 1.0

        return brentq(excess, 1e-9 * stokes, 3.0 * stokes, rtol=1e-12)

    def mean_slip(self, eps, own_share):
        """The law's slip averaged over the porosities eps [n] of the grains, by an interpolated table. `own_share`: every
        grain's drag is its own eps times the weight, not that of the bed."""
        nodes = np.linspace(eps.min(), eps.max(), 33)
        return float(np.interp(eps, nodes, [self.slip(e, e if own_share else None) for e in nodes]).mean())


# --- sums over a snapshot ---


def wrapped(x, side):
    x = np.mod(x, side)
    return np.where(x >= side, 0.0, x)


def kernel_matrix(bed, x, y, h):
    """W(|x_a - y_j|, h) of all pairs in the periodic box, 1/m3, sparse."""
    chosen = sph_operators.KERNELS[bed.kernel]
    trees = [cKDTree(wrapped(z, bed.side), boxsize=bed.side) for z in (x, y)]
    found = trees[0].sparse_distance_matrix(trees[1], sph_operators.support(bed.kernel) * h, output_type="coo_matrix")
    found.data = chosen.sigma[3] / h**3 * chosen.w(found.data / h)
    return found.tocsr()


def gathered(bed, snapshot):
    """(porosity, vertical fluid velocity) [n] at the grains: plain sums over all pairs."""
    x, u, y = snapshot["fluid"]["x"], snapshot["fluid"]["v"][:, 2], snapshot["grains"]["x"]
    chosen = sph_operators.KERNELS[bed.kernel]
    near = kernel_matrix(bed, x, x, bed.smoothing)
    near.setdiag(chosen.sigma[3] / bed.smoothing**3)
    volume = 1.0 / np.asarray(near.sum(axis=1)).ravel()
    weights = kernel_matrix(bed, x, y, bed.h)
    eps = 1.0 - bed.volume * np.asarray(weights.sum(axis=1)).ravel()
    total = weights.T @ volume
    return (weights.T @ (volume * eps)) / total, (weights.T @ (volume * u)) / total


# --- what the places of the grains add: README, equations (2) to (4) ---


class Waves:
    """Wave vectors of the box, half of them (the others are their conjugates, twice): modulus k, cosine to the vertical, factors."""

    def __init__(self, bed):
        unit = 2.0 * math.pi / bed.side
        top = math.floor(REACH / bed.h / unit)
        side = np.arange(-top, top + 1)
        n = np.stack(np.meshgrid(side, side, side, indexing="ij"), axis=-1).reshape(-1, 3)
        first = (n[:, 2] > 0) | ((n[:, 2] == 0) & ((n[:, 1] > 0) | ((n[:, 1] == 0) & (n[:, 0] > 0))))
        self.vectors = unit * n[first & ((n**2).sum(axis=1) <= top**2)]
        self.k = np.linalg.norm(self.vectors, axis=1)
        self.cosine = self.vectors[:, 2] / self.k
        self.filter = sph_operators.transform(bed.kernel, 3, self.k * bed.h)
        self.fluid_filter = sph_operators.transform(bed.kernel, 3, self.k * bed.smoothing)
        self.viscosity = self.k**2 * sph_operators.viscosity_ratio(bed.kernel, 3, self.k * bed.smoothing)

    def structure(self, x):
        """S(k) of the places x [n, 3]: |sum exp(i k.x)|^2/n."""
        total = np.zeros(len(self.k), complex)
        for part in np.array_split(x, max(1, len(x) // 100)):
            total += np.exp(1j * (self.vectors @ part.T)).sum(axis=1)
        return np.abs(total) ** 2 / len(x)


def carried(bed, waves, structure, t):
    """Mean fluid velocity at the grains over that of the box, m/s, upwards: README, equation (4)."""
    w, c2 = waves.filter, waves.cosine**2
    rate = bed.mu * waves.viscosity / (bed.eps * bed.rho + bed.phi * bed.rho_p)
    wakes = -bed.weight * w**2 * (1.0 - c2) / (bed.mu * waves.viscosity) * -np.expm1(-rate * t)
    slip, step = bed.slip(bed.eps), 1e-3
    slope = (bed.slip(bed.eps + step) - bed.slip(bed.eps - step)) / (2.0 * step)
    backflow = bed.volume * w**2 * c2 * (slip - bed.phi * w**2 * slope) / (bed.eps * waves.fluid_filter + bed.phi * w**2)
    return 2.0 * float(structure @ (wakes + backflow)) / bed.side**3


class State:
    """One snapshot of a run and what the theory says of it."""

    def __init__(self, run, k=-1):
        snapshot = run.snapshot(k)
        x, v = snapshot["grains"]["x"], snapshot["grains"]["v"][:, 2]
        self.bed = Bed(run.scene, len(x))
        self.eps, u = gathered(self.bed, snapshot)
        self.law = self.bed.mean_slip(self.eps, False)
        self.law_under_stress = self.bed.mean_slip(self.eps, True)
        self.at_grain = float(u.mean() - v.mean())
        self.carried = float(u.mean() - snapshot["fluid"]["v"][:, 2].mean())
        self.slip = self.at_grain - self.carried
        waves = Waves(self.bed)
        self.predicted = carried(self.bed, waves, waves.structure(x), snapshot["time"])
        fluid = self_disturbance.percus_yevick(self.bed.phi, self.bed.d)(waves.k)
        self.of_fluid = carried(self.bed, waves, fluid, snapshot["time"])

    @property
    def off_theory(self):
        """Distance from (4) over the larger of a tenth of the disturbance and 0.5 % of the law's slip."""
        return abs(self.carried - self.predicted) / max(0.1 * abs(self.predicted), 0.005 * self.law)


def momentum(run):
    """Vertical momentum of all at the end over the impulse that drag has exchanged."""
    start, last = run.snapshot(0), run.snapshot(-1)
    bed = Bed(run.scene, len(start["grains"]["x"]))
    place = {number: k for k, number in enumerate(start["fluid"]["id"])}
    share = start["fluid"]["eps"][[place[number] for number in last["fluid"]["id"]]]
    mass = bed.rho * bed.side**3 / len(share) * share
    total = np.sum(mass * last["fluid"]["v"][:, 2]) + bed.rho_p * bed.volume * np.sum(last["grains"]["v"][:, 2])
    return float(abs(total) / (bed.grains * bed.eps * bed.weight * run.scene["time"]["end"]))


def reference(quantity, scene, t):
    if quantity in ("at_grain", "under_stress"):
        return 1.0
    raise KeyError(quantity)


def measure(quantity, run):
    if quantity == "momentum":
        return momentum(run)
    if quantity == "at_grain":
        state = State(run)
        return state.at_grain / state.law
    if quantity == "under_stress":
        state = State(run)
        return state.at_grain / state.law_under_stress
    if quantity == "off_theory":
        return State(run).off_theory
    return NotImplemented


# --- the ensembles ---


def ensembles(runs):
    """{nominal fluid fraction: states of its runs}."""
    found = {}
    for run in runs:
        if not run.failure and run.variant.startswith("eps") and not run.variant.endswith("short"):
            state = State(run)
            found.setdefault(round(state.bed.eps, 3), []).append(state)
    return dict(sorted(found.items()))


def mean(values):
    """(mean, standard error or nan)."""
    values = np.asarray(values, float)
    return values.mean(), values.std(ddof=1) / math.sqrt(len(values)) if len(values) > 1 else math.nan


def alone(bed):
    """(Re, speed [m/s]) of one grain by the law."""
    re = hindered_re(archimedes(bed.rho_p, bed.rho, bed.d, bed.mu, bed.g), 1.0, 1)
    return re, re * bed.mu / (bed.rho * bed.d)


def table(runs):
    rows = []
    for eps, states in ensembles(runs).items():
        bed, (re, speed) = states[0].bed, alone(states[0].bed)
        carried_by, error = mean([-s.carried / s.law for s in states])
        settling, settling_error = mean([eps * s.slip / speed for s in states])
        rows.append([f"{eps:.3f}", str(len(states)), f"{mean([s.at_grain / s.law for s in states])[0]:.4f}",
                     f"{mean([s.at_grain / s.law_under_stress for s in states])[0]:.4f}",
                     f"{100 * carried_by:.2f} +- {100 * error:.2f}", f"{100 * mean([-s.predicted / s.law for s in states])[0]:.2f}",
                     f"{100 * mean([-s.of_fluid / s.law for s in states])[0]:.2f}", f"{settling:.4f} +- {settling_error:.4f}",
                     f"{eps * bed.slip(eps) / speed:.4f}", f"{eps ** richardson_zaki_exponent(re):.4f}"])
    return {"columns": ["eps", "runs", "slip at grains over the law's", "over the law under stress", "carried by wakes, % of slip",
                        "theory, S of the places", "theory, Percus-Yevick", "settling speed over u_t", "law alone", "Richardson-Zaki"],
            "rows": rows, "caption": "Means over the ensembles, with their standard error."}


def figure_of(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    for number, (eps, states) in enumerate(ensembles(runs).items()):
        speed = alone(states[0].bed)[1]
        for k, s in enumerate(states):
            left.plot(-100 * s.predicted / s.law, -100 * s.carried / s.law, "o", ms=4, mfc="none", color=f"C{number}",
                      label=None if k else f"eps {eps:.2f}")
            right.plot(eps, eps * s.slip / speed, "ko", ms=3, mfc="none", label=None if number or k else "runs")
        left.axvline(-100 * states[0].of_fluid / states[0].law, color=f"C{number}", ls=":", lw=0.8)
    top = left.get_xlim()[1]
    left.plot([0.0, top], [0.0, top], "k-", lw=0.6)
    left.set_xlabel("carried by wakes, theory with the places' own S(k) [% of slip]")
    left.set_ylabel("carried by wakes, run [% of slip]")
    left.legend(fontsize="x-small")
    states = next(iter(ensembles(runs).values()), None)
    if states:
        bed, (re, speed) = states[0].bed, alone(states[0].bed)
        ar, eps = archimedes(bed.rho_p, bed.rho, bed.d, bed.mu, bed.g), np.linspace(0.45, 1.0, 80)
        right.plot(eps, [hindered_re(ar, e, 1) * bed.mu / (bed.rho * bed.d) / speed for e in eps], "-", label="law, uniform")
        right.plot(eps, eps ** richardson_zaki_exponent(re), "--", label="Richardson-Zaki")
    right.set_yscale("log")
    right.set_xlabel("fluid fraction eps [-]")
    right.set_ylabel("settling speed over u_t [-]")
    right.legend(fontsize="x-small")
    return figure


def figures(runs):
    return [("ensemble", figure_of(runs), "Left: mean fluid velocity at the grains below that of the box, run against theory; dotted: Percus-Yevick. "
             "Right: settling speed at zero momentum.")]
