"""A pulse of sound that leaves through an open side, and what the side's slow means send back (README.md)."""

import numpy as np

UNITS = {"returned": "1", "unexplained": "1", "flow_kept": "1"}
SIGN = {"+x": 1.0, "-x": -1.0}


class Pulse:
    """initial = {law = "pulse", ...} in a duct along x from 0 to size[0]."""

    def __init__(self, scene):
        fluid = scene["fluid"]
        start = fluid["initial"]
        self.c, self.impedance = fluid["sound_speed"], fluid["density"] * fluid["sound_speed"]
        self.amplitude, self.centre, self.width = start["speed"], start["centre"], start["width"]
        self.flow, self.sign, self.length = start["flow"], SIGN[start["towards"]], scene["domain"]["size"][0]
        side = scene["outlet" if self.sign > 0.0 else "inlet"]
        self.memory = (1.0 if self.sign > 0.0 else 2.0) * side[0]["averaging_time"]
        h = fluid["smoothing"] * fluid["spacing"]
        self.diffusion = fluid.get("density_diffusion", 0.0) * h * self.c

    def waves(self, fluid):
        """(x, incident, returned) of the particles: (p +- rho c (u - flow))/2 over rho c U."""
        x, p, u = fluid["x"][:, 0], fluid["p"], self.sign * (fluid["v"][:, 0] - self.flow)
        scale = 2.0 * self.impedance * self.amplitude
        return x, (p + self.impedance * u) / scale, (p - self.impedance * u) / scale

    def at_side(self, t):
        """The pulse where it leaves, over its height."""
        distance = self.length - self.centre if self.sign > 0.0 else self.centre
        return np.exp(-0.5 * (((self.c + self.sign * self.flow) * t - distance) / self.width) ** 2)

    def sent_back(self, t):
        """What comes back from the side at times t: README, (2) to (4)."""
        fine = np.linspace(0.0, max(float(np.max(t)), 1e-9), 4001)
        pulse, step = self.at_side(fine), fine[1] - fine[0]
        kept = np.zeros_like(fine)
        for k in range(1, len(fine)):  # d kept/dt = (pulse - kept)/memory, trapezoidal
            a = 0.5 * step / self.memory
            kept[k] = ((1.0 - a) * kept[k - 1] + a * (pulse[k] + pulse[k - 1])) / (1.0 + a)
        side = -1.0 if self.sign > 0.0 else 1.0
        mean = np.interp(t, fine, side * kept)
        kink = self.diffusion / self.c**2 * np.gradient(pulse, step)
        share = 1.0 if self.sign > 0.0 else 0.5
        return mean, mean + share * np.interp(t, fine, kink)

    def returned(self, x, t):
        """(by the means alone, with the kink of density diffusion) at places x of the duct."""
        way = self.length - x if self.sign > 0.0 else x
        left = t - way / (self.c - self.sign * self.flow)
        mean, whole = self.sent_back(np.maximum(left, 0.0))
        return np.where(left > 0.0, mean, 0.0), np.where(left > 0.0, whole, 0.0)


def measure(quantity, run):
    pulse, last = Pulse(run.scene), run.snapshot(-1)
    x, _, back = pulse.waves(last["fluid"])
    if quantity == "returned":
        return float(np.abs(back).max())
    if quantity == "unexplained":
        return float(np.abs(back - pulse.returned(x, last["time"])[1]).max())
    if quantity == "flow_kept":  # all of the pulse has left: mean velocity over that of the flow
        return float(last["fluid"]["v"][:, 0].mean() / pulse.flow)
    return NotImplemented


def reference(quantity, scene, t):
    return {"returned": 0.0, "unexplained": 0.0, "flow_kept": 1.0}[quantity]


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 6.0), layout="constrained")
    names = [n for n in ("outlet", "inlet") if any(run.variant == n for run in runs)]
    rows = figure.subplots(len(names), 1, squeeze=False)[:, 0]
    for axes, name in zip(rows, names):
        _returned(axes, [run for run in runs if run.variant == name], name)
    return [("returned", figure, "What comes back at the end of the run, over the height of the pulse: means alone (dashed), "
             "with the kink of density diffusion (black), particles (dots).")]


def _returned(axes, runs, name):
    for number, run in enumerate(runs):
        pulse, last = Pulse(run.scene), run.snapshot(-1)
        x, _, back = pulse.waves(last["fluid"])
        axes.plot(x, back, ".", markersize=2, color=f"C{number}", label=f"spacing {run.value:g} m")
        fine = np.linspace(0.0, pulse.length, 600)
        mean, whole = pulse.returned(fine, last["time"])
        axes.plot(fine, whole, color="black", linewidth=0.7)
    axes.plot(fine, mean, "--", color="black", linewidth=1.0, label="means alone")
    axes.set(xlabel="x (m)", ylabel="returned (-)", title=f"after the {name}")
    axes.legend(fontsize=7)


def table(runs):
    rows = []
    for run in runs:
        pulse, end = Pulse(run.scene), run.snapshot(-1)["time"]
        whole = pulse.returned(np.linspace(0.0, pulse.length, 2000), end)
        rows.append([run.variant, run.value, pulse.memory, measure("returned", run), float(np.abs(whole[0]).max()),
                     float(np.abs(whole[1]).max()), measure("unexplained", run)])
    return {"columns": ["variant", "spacing (m)", "memory (s)", "returned", "means alone", "with diffusion", "unexplained"],
            "rows": rows, "caption": "Amplitudes over that of the pulse."}
