"""Slip of a uniform periodic suspension under Di Felice's law, from the kit reference_data/drag_laws (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.spatial import cKDTree

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import di_felice  # noqa: E402
from theory import grid_suspension, grid_weights  # noqa: E402
from theory.packed_beds import richardson_zaki_exponent  # noqa: E402
from theory.settling import archimedes, hindered_re  # noqa: E402

PER_CELL = {"cubic": 1, "fcc": 4}
UNITS = {"settling": "m/s", "start_up": "m/s", "at_grain": "1", "at_grain_random": "1", "off_carried": "1", "momentum": "1"}


def count_of(arrange, side):
    """Number of grains in the box."""
    if arrange["law"] == "random":
        return arrange["count"]
    if arrange["law"] == "file":
        return len(np.loadtxt(HERE / arrange["path"], delimiter=",", skiprows=1))
    return PER_CELL[arrange["kind"]] * round(side / arrange["spacing"]) ** 3


class Suspension:
    """The scene's numbers; vertical components count upwards, speeds are positive."""

    def __init__(self, scene):
        fluid, grain, arrange = scene["fluid"], scene["grains"], scene["grains"]["arrange"]
        self.rho, self.mu = fluid["density"], fluid["viscosity"]
        self.d, self.rho_p = grain["diameter"], grain["density"]
        self.g = -scene["domain"]["gravity"][2]
        self.side = scene["domain"]["size"][0]
        self.on_grid, self.random = fluid["method"] == "grid", arrange["law"] != "lattice"
        self.spacing, self.volume = fluid["spacing"], math.pi / 6.0 * self.d**3
        width = scene["coupling"]["kernel_width"]
        if self.on_grid:
            self.h = width["times_diameter"] * self.d  # standard deviation of the Gaussian
        else:
            self.smoothing = fluid["smoothing"] * fluid["spacing"]
            self.h = width["times_smoothing"] * self.smoothing
        self.grains = count_of(arrange, self.side)
        self.eps = 1.0 - self.grains * self.volume / self.side**3

    @property
    def effective_weight(self):
        """Drag on a grain in the steady bed, N: eps of its weight less buoyancy; the mean gradient carries the rest."""
        return self.eps * (self.rho_p - self.rho) * self.volume * self.g

    def drag(self, eps, w):
        """f_d, N, at porosity eps and interstitial slip w: 3 pi mu d u_s F(eps, Re), u_s = eps w."""
        u_s = eps * w
        return 3.0 * math.pi * self.mu * self.d * u_s * float(di_felice(eps, self.rho * self.d * u_s / self.mu))

    def slip(self, eps, held=None):
        """Interstitial slip, m/s, at which a law told `eps` gives the drag of a bed whose fluid fills `held` of the box
        (`eps` of the bed itself when not given): 1/(1 + phi/held) of the weight less buoyancy."""
        held = self.eps if held is None else held
        weight = self.effective_weight / self.eps * held / (held + 1.0 - self.eps)
        stokes = (self.rho_p - self.rho) * self.g * self.d**2 / (18.0 * self.mu)
        return brentq(lambda w: self.drag(eps, w) / weight - 1.0, 1e-9 * stokes, 3.0 * stokes, rtol=1e-13)

    @property
    def settling(self):
        """Settling speed at zero net flux = superficial slip, m/s: the root of (4/3) Ar eps^(1 + chi) = C_D Re^2."""
        re = hindered_re(archimedes(self.rho_p, self.rho, self.d, self.mu, self.g), self.eps, 1)
        return re * self.mu / (self.rho * self.d)

    def start_up(self, t):
        """Superficial slip at the times t from rest, m/s (README, equation 3)."""
        both = 1.0 / (self.rho_p * self.volume) + (1.0 - self.eps) / (self.eps * self.rho * self.volume)
        rate = lambda _, w: [both * (self.effective_weight - self.drag(self.eps, max(w[0], 1e-30)))]  # noqa: E731
        solved = solve_ivp(rate, (0.0, float(t[-1])), [0.0], "Radau", t_eval=t, rtol=1e-9, atol=1e-12 * self.settling)
        return self.eps * solved.y[0]


def reference(quantity, scene, t):
    bed = Suspension(scene)
    if quantity == "settling":
        return bed.settling
    if quantity == "start_up":
        return bed.start_up(np.asarray(t, float))
    if quantity in ("at_grain", "at_grain_random"):
        return 1.0
    raise KeyError(quantity)


def superficial_slip(run):
    """(t, eps times (fluid's less grains' mean velocity)), m/s."""
    (t, u), (_, v) = run.series("fluid"), run.series("grains")
    return t, Suspension(run.scene).eps * (u.ravel() - v.ravel())


def wendland_c2(r, h):
    """The kernel in space, 1/m3; Wendland 1995, support 2 h."""
    q = np.minimum(r / h, 2.0)
    return 21.0 / (16.0 * math.pi * h**3) * (1.0 - 0.5 * q) ** 4 * (1.0 + 2.0 * q)


def wrapped(x, side):
    x = np.mod(x, side)
    return np.where(x >= side, 0.0, x)  # -1e-20 modulo the side is the side


def kernel_matrix(x, y, h, side):
    """W(|x_a - y_j|, h) of all pairs in the periodic box, sparse."""
    trees = [cKDTree(wrapped(z, side), boxsize=side) for z in (x, y)]
    found = trees[0].sparse_distance_matrix(trees[1], 2.0 * h, output_type="coo_matrix")
    found.data = wendland_c2(found.data, h)
    return found.tocsr()


def gathered(run, k):
    """(porosity, fluid velocity) [n] at the grains of snapshot k, by plain sums over all pairs (README, equation 4)."""
    bed, snapshot = Suspension(run.scene), run.snapshot(k)
    x, u, y = snapshot["fluid"]["x"], snapshot["fluid"]["v"][:, 2], snapshot["grains"]["x"]
    near = kernel_matrix(x, x, bed.smoothing, bed.side)
    near.setdiag(wendland_c2(0.0, bed.smoothing))
    volume = 1.0 / np.asarray(near.sum(axis=1)).ravel()
    weights = kernel_matrix(x, y, bed.h, bed.side)
    eps = 1.0 - bed.volume * np.asarray(weights.sum(axis=1)).ravel()
    total = weights.T @ volume
    return (weights.T @ (volume * eps)) / total, (weights.T @ (volume * u)) / total


def at_grain(run, k):
    """Mean slip that the grains gather over what the law gives at the mean porosity that they gather."""
    eps, u = gathered(run, k)
    v, held = run.snapshot(k)["grains"]["v"][:, 2], run.snapshot(0)["fluid"]["eps"].mean()
    return float((u.mean() - v.mean()) / Suspension(run.scene).slip(eps.mean(), held))


# --- random beds on a grid: reference_data/theory/grid_suspension.py ---


def grid_bed(bed, dt):
    """The numbers of the theory; the slip of the law changes by its slope with the eps that a grain gathers, and a step of the exponential
    exchange holds fluid and grain together by b phi_1(b dt/m), b = f_d/slip."""
    step = 1e-3
    slope = (bed.slip(bed.eps + step, bed.eps) - bed.slip(bed.eps - step, bed.eps)) / (2.0 * step)
    weight = bed.effective_weight / bed.eps
    inertia = bed.rho_p * bed.volume / dt
    held = -inertia * math.expm1(-bed.effective_weight / bed.slip(bed.eps) / inertia)
    return grid_suspension.Bed(bed.side, round(bed.side / bed.spacing), bed.h, bed.volume, weight, bed.rho, bed.rho_p, bed.mu,
                               bed.slip(bed.eps), slope, held)


def gathered_on_grid(run, k):
    """(porosity, fluid velocity) [n] at the grains of snapshot k, by plain sums over all pairs."""
    bed, snapshot = Suspension(run.scene), run.snapshot(k)
    x, cells = snapshot["grains"]["x"], round(bed.side / bed.spacing)
    of_cells = grid_weights.gaussian_weights(grid_weights.nodes(bed.side, cells), x, bed.h, bed.side)
    of_faces = grid_weights.gaussian_weights(grid_weights.nodes(bed.side, cells, 2), x, bed.h, bed.side)
    eps = grid_weights.cell_porosity(of_cells, bed.volume, bed.spacing**3)
    return of_cells.T @ eps, of_faces.T @ snapshot["grid"]["u_z"].ravel()


def slip_under_stress(bed, eps):
    """The law's slip averaged over the porosities eps [n] of the grains, each with its own eps of the weight as drag."""
    nodes = np.linspace(eps.min(), eps.max(), 17)
    return float(np.interp(eps, nodes, [bed.slip(e, e / (1.0 - e) * (1.0 - bed.eps)) for e in nodes]).mean())


def at_grain_random(run, k):
    """Mean slip that the grains of a random bed gather over what the law gives at the porosities that they gather."""
    eps, u = gathered_on_grid(run, k)
    return float((u.mean() - run.snapshot(k)["grains"]["v"][:, 2].mean()) / slip_under_stress(Suspension(run.scene), eps))


def carried(run, k):
    """(measured, wakes, backflow): mean fluid velocity at the grains over that of the box, m/s, upwards."""
    snapshot = run.snapshot(k)
    measured = float(gathered_on_grid(run, k)[1].mean() - snapshot["grid"]["u_z"].mean())
    return measured, *grid_suspension.carried(grid_bed(Suspension(run.scene), run.scene["time"]["step"]), snapshot["grains"]["x"], snapshot["time"])


def off_carried(run, k):
    """Distance from the theory over the larger of a tenth of itself and 0.5 % of the law's slip."""
    measured, wakes, backflow = carried(run, k)
    bed, theory = Suspension(run.scene), wakes + backflow
    return abs(measured - theory) / max(0.1 * abs(theory), 0.005 * bed.slip(bed.eps))


def momentum(run):
    """Vertical momentum of all at the end over the impulse that drag has exchanged."""
    bed, start, last = Suspension(run.scene), run.snapshot(0), run.snapshot(-1)
    place = {number: k for k, number in enumerate(start["fluid"]["id"])}
    share = start["fluid"]["eps"][[place[number] for number in last["fluid"]["id"]]]
    mass = bed.rho * bed.side**3 / len(share) * share
    total = np.sum(mass * last["fluid"]["v"][:, 2]) + bed.rho_p * bed.volume * np.sum(last["grains"]["v"][:, 2])
    return float(abs(total) / (bed.grains * bed.effective_weight * run.scene["time"]["end"]))


def measure(quantity, run):
    if quantity == "start_up":
        return superficial_slip(run)
    if quantity == "settling":  # the second half of the run
        t, w = superficial_slip(run)
        late = t >= 0.5 * run.scene["time"]["end"] * (1.0 - 1e-9)
        return t[late], w[late]
    if quantity == "at_grain":
        return at_grain(run, -1)
    if quantity == "at_grain_random":
        return at_grain_random(run, -1)
    if quantity == "off_carried":
        return off_carried(run, -1)
    if quantity == "momentum":
        return momentum(run)
    return NotImplemented


def fluid_name(run):
    rho = run.scene["fluid"]["density"]
    return "air" if rho < 100.0 else "water" if rho < 1100.0 else "glycerol-water"


def hindered_figure(runs):
    """Settling speed over that of one grain, over eps: the law in both conventions, Richardson-Zaki, and the runs."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 3.6), layout="constrained")
    names = ("air", "water", "glycerol-water")
    for axes, name in zip(figure.subplots(1, 3, sharey=True), names):
        own = [run for run in runs if not run.failure and fluid_name(run) == name and not Suspension(run.scene).random]
        if not own:
            continue
        bed = Suspension(own[0].scene)
        ar = archimedes(bed.rho_p, bed.rho, bed.d, bed.mu, bed.g)
        alone, eps = hindered_re(ar, 1.0, 1), np.linspace(0.4, 1.0, 121)
        for extra, label in ((1, "law, eps^(1+chi)"), (0, "law, eps^chi")):
            axes.plot(eps, [hindered_re(ar, e, extra) / alone for e in eps], "-" if extra else ":", label=label)
        axes.plot(eps, eps ** richardson_zaki_exponent(alone), "--", label="Richardson-Zaki")
        points = [(Suspension(run.scene).eps, superficial_slip(run)[1][-1]) for run in own]
        speed = alone * bed.mu / (bed.rho * bed.d)
        axes.plot([e for e, _ in points], [w / speed for _, w in points], "ko", ms=4, mfc="none", label="runs")
        axes.set_title(f"{name}, Re {alone:.3g}", fontsize="small")
        axes.set_yscale("log")
        axes.set_xlabel("fluid fraction eps [-]")
        axes.legend(fontsize="x-small")
    figure.axes[0].set_ylabel("settling speed over u_t [-]")
    return figure


def lattice_figure(runs):
    """Slip over the law's at the mean eps, and what the law gives at the eps the grains gather, over the drift."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 3.6), layout="constrained")
    axes = figure.subplots()
    shown = [run for run in runs if not run.failure and run.variant in ("water_080", "narrow", "coarse_narrow")]
    for colour, run in zip(("C0", "C1", "C2"), shown):
        bed = Suspension(run.scene)
        t, w = superficial_slip(run)
        axes.plot(1e3 * t, w / bed.settling, "-", color=colour, label=run.variant)
        files = np.arange(2, len(run.snapshot_files()), 2)
        held = run.snapshot(0)["fluid"]["eps"].mean()
        law = [bed.slip(gathered(run, k)[0].mean(), held) / bed.slip(bed.eps) for k in files]
        times = [1e3 * run.snapshot(k)["time"] for k in files]
        axes.plot(times, law, "o", ms=4, mfc="none", color=colour)
        if run.variant == "coarse_narrow":
            slips = [gathered(run, k)[1].mean() - run.snapshot(k)["grains"]["v"][:, 2].mean() for k in files]
            axes.plot(times, np.array(slips) / bed.slip(bed.eps), "x", ms=4, color=colour)
    axes.set_ylim(0.98, 1.03)
    axes.set_xlabel("time [ms]")
    axes.set_ylabel("slip over the law's at the mean eps [-]")
    axes.legend(fontsize="small")
    return figure


def table(runs):
    rows = []
    for run in runs:
        bed = None if run.failure else Suspension(run.scene)
        if bed is None or not (bed.on_grid and bed.random):
            continue
        slip = bed.slip(bed.eps)
        measured, wakes, backflow = carried(run, -1)
        rows.append([run.variant, f"{bed.eps:.3f}", f"{bed.h / bed.d:.2f}", f"{at_grain_random(run, -1):.4f}",
                     *(f"{100.0 * u / slip:.2f}" for u in (measured, wakes + backflow, wakes, backflow)),
                     f"{superficial_slip(run)[1][-1] / bed.settling:.4f}"])
    return {"columns": ["run", "eps", "width/d", "slip at grains over law's", "carried, % of slip", "theory", "wakes", "backflow",
                        "settling speed over law's"],
            "rows": rows, "caption": "Random beds on a grid: what their own wakes add to the velocity that grains gather (down: negative)."}


def figures(runs):
    return [("hindered", hindered_figure(runs), "Settling speed at zero net flux over that of one grain of the same law."),
            ("lattice", lattice_figure(runs), "Lines: mean slip; circles: the law at the porosity that the grains gather, from plain "
             "sums over the snapshots; crosses: the slip that the grains of coarse_narrow gather.")]
