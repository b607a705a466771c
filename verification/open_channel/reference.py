"""Developed flow between plates through open sides, in a slightly compressible fluid (README.md)."""

import numpy as np

UNITS = {"velocity": "1", "velocity_incompressible": "1", "pressure_gradient": "Pa/m", "particles": "1", "accumulated": "1", "mass_flow": "1"}
SETTLED = 0.5  # share of the run that is left out of averages


class Channel:
    """Plates across y over the whole box, flow along x from the inlet (x = 0) to the outlet (x = size[0])."""

    def __init__(self, scene):
        fluid = scene["fluid"]
        self.rho, self.mu, self.c = fluid["density"], fluid["viscosity"], fluid["sound_speed"]
        self.length, self.width = scene["domain"]["size"][:2]
        self.spacing = fluid["spacing"]
        self.speed = scene["fluid"]["reference_velocity"]  # mean over the width
        self.slope = 12.0 * self.mu * self.speed / self.width**2  # -dp/dx, incompressible
        self.squeeze = self.slope / (self.rho * self.c**2)  # relative change of density per length

    def profile(self, y):
        s = 2.0 * y / self.width - 1.0
        return 1.5 * self.speed * (1.0 - s * s)

    def velocity(self, x):
        """[n, 2], m/s: README, (2)."""
        u = self.profile(x[:, 1]) * (1.0 + self.squeeze * x[:, 0])
        return np.stack([u, np.zeros(len(x))], axis=1)

    def middle_slope(self):
        """-dp/dx half way, Pa/m: README, (3)."""
        return self.slope * (1.0 + 0.5 * self.squeeze * self.length) + 1.2 * self.rho * self.speed**2 * self.squeeze

    def particles(self):
        """Number between the open sides: README, (4)."""
        return self.length * self.width / self.spacing**2 * (1.0 + 0.5 * self.squeeze * self.length)


def late(run):
    """Snapshots of the settled part of the run, oldest first."""
    end = run.scene["time"]["end"]
    found, k = [], -1
    while True:
        snapshot = run.snapshot(k)
        if snapshot["time"] < SETTLED * end - 1e-9:
            return found[::-1]
        found.append(snapshot)
        k -= 1


def velocity_error(channel, fluid, incompressible):
    """Root mean square by component, the worse one, over the mean speed."""
    x, v = fluid["x"][:, :2], fluid["v"][:, :2]
    exact = channel.velocity(x)
    if incompressible:
        exact[:, 0] = channel.profile(x[:, 1])
    return float(np.sqrt(((v - exact) ** 2).mean(axis=0)).max()) / channel.speed


def pressure_line(channel, snapshots):
    """(slope, value at the inlet) of p over the middle half of the stretch, least squares over all snapshots."""
    x = np.concatenate([s["fluid"]["x"][:, 0] for s in snapshots])
    p = np.concatenate([s["fluid"]["p"] for s in snapshots])
    middle = np.abs(x - 0.5 * channel.length) < 0.25 * channel.length
    slope, value = np.polyfit(x[middle], p[middle], 1)
    return float(slope), float(value)


def mass_flow(channel, snapshots):
    """(places, mass flow through sections there over that of the inlet): means of the snapshots, each section a hat of half width
    a tenth of the stretch."""
    half = 0.1 * channel.length
    places = np.linspace(half, channel.length - half, 9)
    mass = channel.rho * channel.spacing**2
    flow = np.zeros(len(places))
    for snapshot in snapshots:
        x, u = snapshot["fluid"]["x"][:, 0], snapshot["fluid"]["v"][:, 0]
        for k, place in enumerate(places):
            flow[k] += mass * float((u * np.maximum(1.0 - np.abs(x - place) / half, 0.0)).sum()) / half
    inlet = channel.rho * (1.0 + channel.squeeze * channel.length) * channel.speed * channel.width
    return places, flow / len(snapshots) / inlet


def accumulated(channel, snapshots):
    """Growth of the number of particles over the number that passed through, in the settled part."""
    t = np.array([s["time"] for s in snapshots])
    n = np.array([len(s["fluid"]["x"]) for s in snapshots])
    return float(np.polyfit(t, n, 1)[0]) * channel.spacing**2 / (channel.speed * channel.width)


def measure(quantity, run):
    channel = Channel(run.scene)
    snapshots = late(run)
    if quantity in ("velocity", "velocity_incompressible"):
        errors = [velocity_error(channel, s["fluid"], quantity != "velocity") for s in snapshots]
        return float(np.sqrt(np.mean(np.square(errors))))
    if quantity == "pressure_gradient":
        return pressure_line(channel, snapshots)[0]
    if quantity == "particles":
        return (np.array([s["time"] for s in snapshots]), np.array([len(s["fluid"]["x"]) for s in snapshots], float))
    if quantity == "accumulated":
        return accumulated(channel, snapshots)
    if quantity == "mass_flow":
        return float(np.abs(mass_flow(channel, snapshots)[1] - 1.0).max())
    return NotImplemented


def reference(quantity, scene, t):
    channel = Channel(scene)
    if quantity == "pressure_gradient":
        return -channel.middle_slope()
    if quantity == "particles":
        return np.full(np.shape(t), channel.particles())
    return {"velocity": 0.0, "velocity_incompressible": 0.0, "accumulated": 0.0, "mass_flow": 0.0}[quantity]


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 6.5), layout="constrained")
    axes = figure.subplots(2, 2)
    for number, variant in enumerate(sorted({run.variant for run in runs})):
        run = min((r for r in runs if r.variant == variant), key=lambda r: r.scene["fluid"]["spacing"])
        _draw(axes, run, f"C{number}")
    axes[0, 0].legend(fontsize=7)
    return [("flow", figure, "The finest run of every variant in the settled part; black: theory of the slightly compressible fluid.")]


def _draw(axes, run, color):
    channel, snapshots = Channel(run.scene), late(run)
    fluid = snapshots[-1]["fluid"]
    x = fluid["x"][:, :2]
    down = np.abs(x[:, 0] - 2.5 * channel.width) < 0.25 * channel.width
    axes[0, 0].plot(x[down, 1], fluid["v"][down, 0], ".", markersize=2, color=color, label=run.variant)
    y = np.linspace(0.0, channel.width, 100)
    axes[0, 0].plot(y, channel.profile(y), color="black", linewidth=0.8)
    axes[0, 0].set(xlabel="y (m)", ylabel="u (m/s)", title="profile around x = 2.5 widths")
    centre = np.abs(x[:, 1] - 0.5 * channel.width) < 0.05 * channel.width
    axes[0, 1].plot(x[centre, 0], fluid["v"][centre, 0], ".", markersize=2, color=color)
    line = np.linspace(0.0, channel.length, 50)
    axes[0, 1].plot(line, 1.5 * channel.speed * (1.0 + channel.squeeze * line), color="black", linewidth=0.8)
    axes[0, 1].set(xlabel="x (m)", ylabel="u (m/s)", title="along the axis")
    axes[1, 0].plot(x[:, 0], fluid["p"], ".", markersize=1, color=color)
    axes[1, 0].plot(line, channel.slope * (channel.length - line), color="black", linewidth=0.8)
    axes[1, 0].set(xlabel="x (m)", ylabel="p (Pa)", title="pressure")
    places, flow = mass_flow(channel, snapshots)
    axes[1, 1].plot(places, flow, "o-", markersize=3, color=color)
    axes[1, 1].axhline(1.0, color="black", linewidth=0.8)
    axes[1, 1].set(xlabel="x (m)", ylabel="mass flow over the inlet's (-)", title="sections")


def table(runs):
    rows = [[run.variant, run.value, *(measure(q, run) for q in ("velocity", "velocity_incompressible", "pressure_gradient", "accumulated", "mass_flow")),
             float(measure("particles", run)[1].mean() / Channel(run.scene).particles() - 1.0)] for run in runs]
    return {"columns": ["variant", "spacing (m)", "velocity", "incompressible", "pressure gradient (Pa/m)", "accumulated", "mass flow", "particles"],
            "rows": rows, "caption": "Errors relative to theory; the pressure gradient as it is."}
