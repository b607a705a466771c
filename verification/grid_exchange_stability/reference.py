"""Where the exchange of drag on a grid stops being stable: the slip of a uniform bed, step by step (README.md)."""

import math

import numpy as np
from scipy.optimize import brentq

UNITS = {"slip": "1", "greatest_slip": "1", "slip_left": "1", "momentum": "1", "slip.boundary": "Pa s", "slip.stable": "Pa s",
         "slip.unstable": "Pa s", "line": "1"}

# What a step of z = dt/tau_p leaves of the slip to a fluid that keeps its velocity, as the solver documents it (plumb laws).
LEFT = {
    "exponential": lambda z: math.exp(-z),
    "implicit": lambda z: 1.0 / (1.0 + z + 0.5 * z * z),
    "explicit": lambda z: 1.0 - z + 0.5 * z * z,
}
GROWTH = 2.0  # of the slip, which ends the measurement


def step_matrix(exchange, z, load, parts, second_order):
    """What a step makes of (u, u one step before, v, what is owed by mass of grain): README, equations (1) to (4)."""
    left = LEFT[exchange]
    received = 1.0 - left(z / parts) ** parts
    share = 2.0 / 3.0 if second_order else 1.0
    old = np.array([4.0 / 3.0, -1.0 / 3.0, 0.0, 0.0]) if second_order else np.array([1.0, 0.0, 0.0, 0.0])
    grain, owed = np.eye(4)[2], np.eye(4)[3]
    if exchange == "explicit":
        foreseen = z * (np.eye(4)[0] - grain)
        fluid = old - share * load * (foreseen + owed)
    else:
        q = 1.0 - left(z)
        fluid = (old + share * load * (q * grain - owed)) / (1.0 + share * load * q)
        foreseen = q * (fluid - grain)
    gain = received * (fluid - grain)
    return np.array([fluid, np.eye(4)[0], grain + gain, gain - foreseen])


def radius(exchange, z, load, parts, second_order):
    """Largest growth factor of the slip in a step; the common velocity of both is the eigenvalue one and left out."""
    factors = np.linalg.eigvals(step_matrix(exchange, z, load, parts, second_order))
    return np.sort(np.abs(np.delete(factors, np.argmin(np.abs(factors - 1.0)))))[-1]


def boundary_line(load, parts=1, second_order=False):
    """The least dt/tau_p at which explicit exchange grows."""
    z = np.geomspace(0.05, 100.0, 150) / (1.0 + 3.0 * load)
    excess = [radius("explicit", a, load, parts, second_order) - 1.0 for a in z]
    first = next(k for k, e in enumerate(excess) if e > 1e-9)
    return brentq(lambda a: radius("explicit", a, load, parts, second_order) - 1.0 - 1e-12, z[first - 1], z[first])


class Bed:
    """The scene's numbers."""

    def __init__(self, scene):
        fluid, grain, time = scene["fluid"], scene["grains"], scene["time"]
        self.d, self.mu, self.dt = grain["diameter"], fluid["viscosity"], time["step"]
        self.tau_p = grain["density"] * self.d**2 / (18.0 * self.mu)
        phi = math.pi / 6.0 * (self.d / grain["arrange"]["spacing"]) ** 3
        self.eps = 1.0 - phi
        self.load = phi * grain["density"] / (self.eps * fluid["density"])
        self.parts = max(1, math.ceil(self.dt / time["grain_step"] * (1.0 - 1e-12)))
        self.steps = round(time["end"] / self.dt)
        self.exchange = scene["coupling"]["exchange"]
        self.second_order = time["integrator"] == "bdf2"

    @property
    def z(self):
        return self.dt / self.tau_p

    def states(self, z):
        """[steps + 1, 4] from a unit slip."""
        first = step_matrix(self.exchange, z, self.load, self.parts, False)
        later = step_matrix(self.exchange, z, self.load, self.parts, self.second_order)
        all_states = [np.array([0.0, 0.0, 1.0, 0.0])]
        for k in range(self.steps):
            all_states.append((first if k == 0 else later) @ all_states[-1])
        return np.array(all_states)

    def slip(self, z):
        s = self.states(z)
        return s[:, 2] - s[:, 0]

    def boundary(self):
        """The viscosity, Pa s, from which on the slip exceeds GROWTH within the run."""
        growth = [np.abs(self.slip(r * self.line())).max() for r in np.geomspace(0.5, 2.0, 141)]
        first = next(k for k, g in enumerate(growth) if g > GROWTH)
        low, high = np.geomspace(0.5, 2.0, 141)[first - 1 : first + 1]
        ratio = brentq(lambda r: np.abs(self.slip(r * self.line())).max() - GROWTH, low, high)
        return self.mu * ratio * self.line() / self.z

    def line(self):
        return boundary_line(self.load, self.parts, self.second_order)


def reference(quantity, scene, t):
    bed = Bed(scene)
    if quantity == "slip":
        return bed.slip(bed.z)
    if quantity == "slip.boundary":
        return bed.boundary()
    if quantity == "line":
        return 1.0
    if quantity == "slip_left":
        return math.exp(-(1.0 + bed.load) * float(t) / bed.tau_p)
    raise KeyError(quantity)


def velocities(run):
    (t, v), (_, u) = run.series("grains"), run.series("fluid")
    return t, v.ravel(), u.ravel()


def measure(quantity, run):
    if quantity not in UNITS or quantity.startswith("slip."):
        return NotImplemented
    bed = Bed(run.scene)
    if quantity == "line":  # highest stable and lowest unstable dt/tau_p over theory's, their geometric mean
        return math.sqrt(run.stable * run.unstable) * bed.z / bed.mu / bed.line()
    t, v, u = velocities(run)
    slip = (v - u) / (v - u)[0]
    if quantity == "slip":
        return t, slip
    if quantity == "slip_left":
        return float(slip[-1])
    if quantity == "greatest_slip":
        return float(np.abs(slip).max())
    total = u + bed.load * v  # nothing is owed at the end of the runs that are judged by it
    return float(total[-1] / total[0])


def figures(runs):
    return [("map", map_figure(runs), "Exchange of drag on a grid: trials and theory's boundary of explicit exchange."),
            ("relaxation", relaxation_figure(runs), "Error of the slip after 0.95 relaxations against the step, and the recursion's.")]


def map_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.4), layout="constrained")
    loads = np.geomspace(0.02, 2500.0, 90)
    for axes, second_order in zip(figure.subplots(1, 2, sharey=True), (False, True)):
        line = np.array([boundary_line(load, 1, second_order) for load in loads])
        axes.fill_between(loads, line, 1e4, color="0.92", lw=0)
        axes.plot(loads, line, "k-", lw=1, label="theory: explicit is unstable above")
        axes.plot(loads, 2.0 / (1.0 + loads), "k:", lw=1, label="2/(1 + load)")
        mark_runs(axes, [run for run in runs if Bed(run.scene).second_order == second_order and run.variant[:5] != "relax"])
        axes.set(xscale="log", yscale="log", ylim=(1e-4, 3e3), xlim=(0.02, 2500.0), xlabel="mass of grains over fluid, load [-]")
        axes.set_title("bdf2" if second_order else "implicit_euler", fontsize="medium")
        axes.legend(fontsize="x-small", loc="lower left")
        top = axes.secondary_xaxis(-0.22, functions=(lambda x: x, lambda x: x))
        top.set_xticks([2.5 * (1.0 - e) / e for e in (0.99, 0.9, 0.6, 0.4)], ["0.99", "0.9", "0.6", "0.4"], minor=False)
        top.minorticks_off()
        top.set_xlabel("eps, for rho_p/rho = 2.5")
    figure.axes[0].set_ylabel("step over relaxation time, dt/tau_p [-]")
    return figure


def mark_runs(axes, runs):
    seen = set()

    def mark(bed, mu, style, label):
        axes.plot(bed.load, bed.z * mu / bed.mu, style, ms=5, mfc="none", label=None if label in seen else label)
        seen.add(label)

    for run in runs:
        bed = Bed(run.scene)
        if bed.exchange == "explicit":
            if bed.parts > 1 or getattr(run, "stable", None) is None or getattr(run, "unstable", None) is None:
                continue
            mark(bed, run.stable, "C0o", "explicit, highest stable")
            mark(bed, run.unstable, "C3x", "explicit, lowest unstable")
        elif not run.failure:
            mark(bed, bed.mu, "C2^" if bed.exchange == "implicit" else "C1v", f"{bed.exchange}, bounded")


def relaxation_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.5, 4.0), layout="constrained")
    axes = figure.subplots()
    for number, name in enumerate(sorted({run.variant for run in runs if run.variant.startswith("relax")})):
        own = sorted((run for run in runs if run.variant == name and not run.failure), key=lambda run: run.scene["time"]["step"])
        beds = [Bed(run.scene) for run in own]
        exact = [reference("slip_left", run.scene, run.scene["time"]["end"]) for run in own]
        z = [bed.z for bed in beds]
        axes.loglog(z, [abs(measure("slip_left", run) / e - 1.0) for run, e in zip(own, exact)], f"C{number}o", mfc="none", label=name)
        axes.loglog(z, [abs(bed.slip(bed.z)[-1] / e - 1.0) for bed, e in zip(beds, exact)], f"C{number}-", lw=1)
    axes.set(xlabel="dt/tau_p [-]", ylabel="relative error of the slip [-]")
    axes.legend(fontsize="x-small")
    return figure
