"""A grain moved along a periodic column of cells: the water's velocity and pressure, step by step (README.md, equations 1 to 4)."""

import math

import numpy as np


SUPPORT = 3.5  # of the Gaussian, in widths


class Column:
    """The scene's numbers."""

    def __init__(self, scene):
        fluid, grain, self.coupling, time = scene["fluid"], scene["grains"], scene["coupling"], scene["time"]
        self.length, self.across, _ = scene["domain"]["size"]
        self.h, self.rho, self.dt = fluid["spacing"][0], fluid["density"], time["step"]
        self.cells, self.steps = round(self.length / self.h), round(time["end"] / time["step"])
        self.volume = math.pi / 6.0 * grain["diameter"] ** 3
        self.start, self.speed = grain["arrange"]["position"][0], grain["velocity"][0]

    def weights(self, x):
        """Share of each cell of a grain at x, in the middle of the column."""
        if self.coupling["kernel"] == "cell_counting":
            share = np.zeros(self.cells)
            share[math.floor(x / self.h) % self.cells] = 1.0
            return share
        support, width = SUPPORT, self.coupling["kernel_width"]
        beyond = math.ceil(support * width / self.across) + 1
        side = np.arange(-beyond, beyond + 1) * self.across
        across = np.add.outer(side**2, side**2).ravel()
        turns = math.ceil(support * width / self.length) + 1
        share = np.zeros(self.cells)
        for turn in range(-turns, turns + 1):
            along = (np.arange(self.cells) + 0.5) * self.h + turn * self.length - x
            q = np.sqrt(along[:, None] ** 2 + across) / width
            share += np.where(q < support, np.exp(-0.5 * q * q), 0.0).sum(axis=1)
        return share / share.sum()

    def porosity(self, x):
        """By cell; too much goes to the neighbours, of which four of six are the cell itself."""
        solid = self.volume * self.weights(x) / (self.h * self.across**2)
        most = 1.0 - self.coupling["least_porosity"]
        for _ in range(1000):
            excess = np.maximum(solid - most, 0.0)
            if not excess.max() > 1e-12:
                break
            solid = solid - excess * (2.0 / 6.0) + (np.roll(excess, 1) + np.roll(excess, -1)) / 6.0
        return 1.0 - solid

    def swings(self):
        """Greatest less least pressure of each step, Pa."""
        eps, u, found = self.porosity(self.start), np.zeros(self.cells), []
        for n in range(self.steps):
            new = self.porosity(self.start + self.speed * (n + 1) * self.dt)
            face = 0.5 * (new + np.roll(new, 1))  # face k below cell k
            flow = -np.cumsum(np.roll(new - eps, 1)) * self.h / self.dt
            flow -= (flow / face).sum() / (1.0 / face).sum()  # no mean push: the sum of the velocities stays zero
            now = flow / face
            p = np.cumsum(-self.rho * self.h * (now - u) / self.dt)
            found.append(p.max() - p.min())
            eps, u = new, now
        return np.array(found)
