"""Slip of random periodic suspensions under Di Felice's law, and what correlated places add to it (README.md)."""

import math
import re
import sys
from functools import lru_cache
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

UNITS = {"at_grain": "1", "under_stress": "1", "off_theory": "1", "off_corrected": "1", "settling": "m/s", "momentum": "1"}
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
        self.numbers = n[first & ((n**2).sum(axis=1) <= top**2)]  # of waves along the sides
        self.unit, self.top = unit, top
        self.k = unit * np.linalg.norm(self.numbers, axis=1)
        self.cosine = unit * self.numbers[:, 2] / self.k
        self.filter = sph_operators.transform(bed.kernel, 3, self.k * bed.h)
        self.fluid_filter = sph_operators.transform(bed.kernel, 3, self.k * bed.smoothing)
        self.viscosity = self.k**2 * sph_operators.viscosity_ratio(bed.kernel, 3, self.k * bed.smoothing)

    def structure(self, x):
        """S(k) of the places x [n, 3]: |sum exp(i k.x)|^2/n, the exponential a product of three."""
        orders = self.unit * np.arange(-self.top, self.top + 1)
        along = [np.exp(1j * np.outer(orders, x[:, axis])) for axis in range(3)]
        total = np.stack([(along[1] * first) @ along[2].T for first in along[0]])
        return np.abs(total[tuple((self.numbers + self.top).T)]) ** 2 / len(x)


def carried(bed, waves, structure, t):
    """Mean fluid velocity at the grains over that of the box, m/s, upwards: README, equation (4)."""
    w, c2 = waves.filter, waves.cosine**2
    rate = bed.mu * waves.viscosity / (bed.eps * bed.rho + bed.phi * bed.rho_p)
    wakes = -bed.weight * w**2 * (1.0 - c2) / (bed.mu * waves.viscosity) * -np.expm1(-rate * t)
    slip, step = bed.slip(bed.eps), 1e-3
    slope = (bed.slip(bed.eps + step) - bed.slip(bed.eps - step)) / (2.0 * step)
    backflow = bed.volume * w**2 * c2 * (slip - bed.phi * w**2 * slope) / (bed.eps * waves.fluid_filter + bed.phi * w**2)
    return 2.0 * float(structure @ (wakes + backflow)) / bed.side**3


# --- what the correction takes out: README, equations (5) and (6) ---


def own_marks(bed, structure_of, c_s, slip, t):
    """(velocity [m/s] upwards, share of volume) that `self_disturbance` takes out of what a grain gathers: the integral over all waves of
    unbounded space, with S = structure_of(k), of the wake of the grain's own push W, and of its backflow at the slip w."""
    scheme = self_disturbance.one_kernel(bed.kernel, bed.h)
    k, dk = self_disturbance.wave_numbers(scheme)
    measure = dk * k**2 / (2.0 * math.pi**2) * structure_of(k) * sph_operators.transform(bed.kernel, 3, k * bed.h) ** 2
    rate = bed.mu / bed.rho * k**2 * sph_operators.viscosity_ratio(bed.kernel, 3, k * bed.smoothing)
    wake = -(2.0 / 3.0) * bed.weight / bed.rho * float(measure @ (-np.expm1(-rate * t) / rate))
    own = sph_operators.transform(bed.kernel, 3, k * bed.smoothing)
    seen = own > 1e-6  # waves that the fluid's own kernel does not see have no pressure
    settled = np.where(seen, -np.expm1(-((c_s * k * own) ** 2) / rate * t) / np.where(seen, own, 1.0), 0.0)
    return wake + bed.volume / 3.0 * slip * float(measure @ settled), bed.volume * float(measure.sum())


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
        hard_spheres = self_disturbance.percus_yevick(self.bed.phi, self.bed.d)
        self.of_fluid = carried(self.bed, waves, hard_spheres(waves.k), snapshot["time"])
        self.hindered = self.bed.slip(self.bed.eps)
        self.taken, self.law_corrected = 0.0, self.law_under_stress
        if corrected(run):  # equations (5) and (6)
            c_s = run.scene["fluid"]["sound_speed"]
            self.taken, share = own_marks(self.bed, hard_spheres, c_s, self.hindered, snapshot["time"])
            self.law_corrected = self.bed.mean_slip(np.minimum(self.eps + share, 1.0), True)
        self.predicted_slip = self.law_corrected + self.taken - self.predicted

    @property
    def off_theory(self):
        """Distance from (4) over the larger of a tenth of the disturbance and 0.5 % of the law's slip."""
        return abs(self.carried - self.predicted) / max(0.1 * abs(self.predicted), 0.005 * self.law)

    @property
    def off_corrected(self):
        """Distance of a corrected run's slip from (6), over the same bound."""
        return abs(self.slip - self.predicted_slip) / max(0.1 * abs(self.predicted), 0.005 * self.law)


def corrected(run):
    """Whether the case means this run to be corrected; a twin may have broken it."""
    return run.variant.startswith("corrected")


@lru_cache(maxsize=None)
def last_state(run):
    return State(run)


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
    if quantity == "settling":
        arrange = scene["grains"]["arrange"]
        grains = arrange["count"] if arrange["law"] == "random" else sum(1 for _ in open(HERE / arrange["path"], encoding="utf-8")) - 1
        bed = Bed(scene, grains)
        return bed.eps * bed.slip(bed.eps)
    raise KeyError(quantity)


def measure(quantity, run):
    if quantity == "momentum":
        return momentum(run)
    if quantity == "settling":
        (_, u), (_, v) = run.series("fluid"), run.series("grains")
        return last_state(run).bed.eps * float(np.ravel(u)[-1] - np.ravel(v)[-1])
    if quantity == "at_grain":
        return last_state(run).at_grain / last_state(run).law
    if quantity == "under_stress":
        return last_state(run).at_grain / last_state(run).law_under_stress
    if quantity in ("off_theory", "off_corrected"):
        return getattr(last_state(run), quantity)
    return NotImplemented


# --- the ensembles ---


def ensembles(runs, prefix):
    """{name: states of its runs} of the variants <name>_<number> whose names begin with the prefix."""
    found = {}
    for run in runs:
        if not run.failure and run.variant.startswith(prefix) and re.search(r"_\d+$", run.variant):
            found.setdefault(re.sub(r"_\d+$", "", run.variant), []).append(last_state(run))
    return dict(sorted(found.items(), key=lambda pair: (-round(pair[1][0].bed.eps, 3), pair[0])))


def mean(values):
    """(mean, standard error or nan)."""
    values = np.asarray(values, float)
    return values.mean(), values.std(ddof=1) / math.sqrt(len(values)) if len(values) > 1 else math.nan


def alone(bed):
    """(Re, speed [m/s]) of one grain by the law."""
    re = hindered_re(archimedes(bed.rho_p, bed.rho, bed.d, bed.mu, bed.g), 1.0, 1)
    return re, re * bed.mu / (bed.rho * bed.d)


def percent(values):
    """Text of the mean in per cent with its standard error."""
    value, error = mean(values)
    return f"{100 * value:.2f} +- {100 * error:.2f}"


def table(runs):
    rows = []
    for name, states in [*ensembles(runs, "eps").items(), *ensembles(runs, "corrected").items()]:
        bed, (re_t, speed) = states[0].bed, alone(states[0].bed)
        eps = bed.eps
        settling, settling_error = mean([eps * s.slip / speed for s in states])
        rows.append([name, f"{eps:.3f}", f"{bed.side / bed.d:.1f}", str(len(states)), f"{mean([s.at_grain / s.law for s in states])[0]:.4f}",
                     f"{mean([s.at_grain / s.law_under_stress for s in states])[0]:.4f}", percent([-s.carried / s.law for s in states]),
                     f"{100 * mean([-s.predicted / s.law for s in states])[0]:.2f}", f"{100 * mean([-s.of_fluid / s.law for s in states])[0]:.2f}",
                     f"{100 * mean([-s.taken / s.law for s in states])[0]:.2f}", percent([s.slip / s.hindered - 1.0 for s in states]),
                     f"{100 * mean([s.predicted_slip / s.hindered - 1.0 for s in states])[0]:.2f}", f"{settling:.4f} +- {settling_error:.4f}",
                     f"{eps * bed.slip(eps) / speed:.4f}", f"{eps ** richardson_zaki_exponent(re_t):.4f}"])
    return {"columns": ["beds", "eps", "side over d", "runs", "slip at grains over the law's", "over the law under stress", "carried by wakes, % of slip",
                        "theory, S of the places", "theory, Percus-Yevick", "taken out", "settling off the law, %", "its theory", "settling speed over u_t",
                        "law alone", "Richardson-Zaki"],
            "rows": rows, "caption": "Means over the ensembles, with their standard error. In corrected beds grains feel the slip at the grains plus what is taken out."}


def figure_of(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    plain = ensembles(runs, "eps")
    for number, states in enumerate(plain.values()):
        speed, eps = alone(states[0].bed)[1], states[0].bed.eps
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
    states = next(iter(plain.values()), None)
    if states:
        bed, (re_t, speed) = states[0].bed, alone(states[0].bed)
        ar, eps = archimedes(bed.rho_p, bed.rho, bed.d, bed.mu, bed.g), np.linspace(0.45, 1.0, 80)
        right.plot(eps, [hindered_re(ar, e, 1) * bed.mu / (bed.rho * bed.d) / speed for e in eps], "-", label="law, uniform")
        right.plot(eps, eps ** richardson_zaki_exponent(re_t), "--", label="Richardson-Zaki")
    right.set_yscale("log")
    right.set_xlabel("fluid fraction eps [-]")
    right.set_ylabel("settling speed over u_t [-]")
    right.legend(fontsize="x-small")
    return figure


def off_law(states):
    """(theory, runs) [n]: settling speed off the law, %."""
    return [100 * np.array([getattr(s, name) / s.hindered - 1.0 for s in states]) for name in ("predicted_slip", "slip")]


def corrected_figure(runs):
    """Left: every corrected bed against theory. Right: the means of the ensembles, not corrected and corrected."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    all_beds = {**ensembles(runs, "eps"), **ensembles(runs, "corrected")}
    for row, (name, states) in enumerate(all_beds.items()):
        theory, run = off_law(states)
        colour = "0.6" if name.startswith("eps") else f"C{row % 10}"
        if not name.startswith("eps"):
            left.plot(theory, run, "o", ms=4, mfc="none", color=colour, label=name)
        value, error = mean(run)
        right.errorbar(value, -row, xerr=0.0 if math.isnan(error) else error, fmt="o", color=colour, capsize=2)
        right.plot(theory.mean(), -row, "k|", ms=12)
    left.axline((0.0, 0.0), slope=1.0, color="k", lw=0.6)
    left.set_xlabel("settling speed off the law, theory with the places' own S(k) [%]")
    left.set_ylabel("run [%]")
    left.legend(fontsize="x-small")
    right.axvspan(-2.0, 2.0, color="0.92", zorder=0)
    right.set_yticks([-row for row in range(len(all_beds))], list(all_beds), fontsize="x-small")
    right.set_xlabel("settling speed off the law, mean of the beds [%]")
    return figure


def figures(runs):
    return [("ensemble", figure_of(runs), "Left: mean fluid velocity at the grains below that of the box, run against theory; dotted: Percus-Yevick. "
             "Right: settling speed at zero momentum."),
            ("corrected", corrected_figure(runs), "Left: corrected beds against theory. Right: means with their standard error, bars: theory, grey band: 2 %; "
             "grey points: not corrected.")]
