"""The meniscus between two equal spheres from the equation of Young and Laplace, without gravity: no fit, no torus.

Lengths in sphere radii, forces in 2 pi R gamma, pressures in gamma/R. README, equations (5) to (8).
`python3 young_laplace.py` prints the README's table of what the closed form misses.
"""

import numpy as np
from scipy.optimize import brentq, minimize_scalar

NODES, WEIGHTS = (lambda x, w: (0.5 * (x + 1), 0.5 * w))(*np.polynomial.legendre.leggauss(64))


def meniscus(beta, neck, theta):
    """Separation, volume of the liquid, force and pressure (inside less outside) of the bridge with this radius of the
    neck that wets the spheres up to the filling angle beta, at the contact angle theta (arrays)."""
    beta, neck = np.broadcast_arrays(beta, neck)
    edge, r0 = np.sin(beta)[..., None], neck[..., None]
    pressure = 2 * (edge * np.sin(beta[..., None] + theta) - r0) / (edge**2 - r0**2)
    r = r0 + (edge - r0) * NODES**2  # takes the inverse square root at the neck away
    cosine = (r0 + pressure * (r**2 - r0**2) / 2) / r
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = cosine / np.sqrt((r - r0) * (1 - pressure * (r + r0) / 2) * (1 + cosine) / r)
    dx = WEIGHTS * slope * 2 * (edge - r0) * NODES
    height = 1 - np.cos(beta)  # of the caps that are wetted
    separation = 2 * (dx.sum(-1) - height)
    volume = 2 * np.pi * ((dx * r**2).sum(-1) - height**2 * (3 - height) / 3)
    return separation, volume, neck - pressure[..., 0] * neck**2 / 2, pressure[..., 0]


def filling_angle(neck, volume, theta):
    """Filling angle at which a bridge with this neck holds the volume; nan if none does."""
    least = np.arcsin(neck)
    grid = least + (1.5 - theta - least) * np.geomspace(1e-6, 1, 300)
    excess = meniscus(grid, neck, theta)[1] - volume
    rises = np.flatnonzero((excess[:-1] < 0) & (excess[1:] >= 0))
    if not len(rises):
        return np.nan
    return brentq(lambda beta: meniscus(beta, neck, theta)[1] - volume, grid[rises[0]], grid[rises[0] + 1], xtol=1e-14)


def stable_branch(volume, theta, points=60):
    """Separations from 0 to rupture and the forces there: the branch with the thicker neck."""
    def separation(neck):
        return float(meniscus(filling_angle(neck, volume, theta), neck, theta)[0])

    necks = 2 * volume**0.25 * np.geomspace(1, 0.03, 120)
    known = np.array([separation(neck) for neck in necks])
    last = int(np.nanargmax(known))  # the fold: no meniscus farther apart
    first = int(np.flatnonzero(known[:last] < 0)[-1])  # before contact the spheres would overlap
    touching = brentq(separation, necks[first + 1], necks[first], xtol=1e-13)
    fold = minimize_scalar(lambda neck: -separation(neck), bounds=(necks[last + 1], necks[last - 1]), method="bounded",
                           options={"xatol": 1e-9}).x
    necks = fold + (touching - fold) * np.linspace(1, 0, points)**2  # s has no slope at the fold
    shape = [meniscus(filling_angle(neck, volume, theta), neck, theta) for neck in necks]
    s, force = (np.array([float(part[k]) for part in shape]) for k in (0, 2))
    s[0] = 0.0
    return s, force


def closed_form(s, volume, theta):
    """Willett et al. (2000), eq. 12, for the whole separation s."""
    scaled = s / np.sqrt(volume)
    return np.cos(theta) / (1 + 1.05 * scaled + 2.5 * scaled**2)


def missed(volume, theta):
    """What the closed form misses: force at contact, greatest miss farther out than s_c/10 over the force at contact,
    relative at s_c/2, work, and rupture distance."""
    s, force = stable_branch(volume, theta)
    fit = closed_form(s, volume, theta)
    far = s > 0.1 * s[-1]
    rupture = (1 + theta / 2) * volume**(1 / 3)
    path = np.linspace(0, rupture, 4001)
    work = np.trapezoid(closed_form(path, volume, theta), path) if hasattr(np, "trapezoid") else np.trapz(
        closed_form(path, volume, theta), path)
    fine = np.linspace(0, s[-1], 4001)
    exact = np.interp(fine, s, force)
    exact_work = np.sum(0.5 * (exact[1:] + exact[:-1]) * np.diff(fine))
    middle = np.interp(0.5 * s[-1], s, force)
    return (fit[0] / force[0] - 1, np.max(np.abs(fit - force)[far]) / force[0],
            closed_form(0.5 * s[-1], volume, theta) / middle - 1, work / exact_work - 1, rupture / s[-1] - 1)


if __name__ == "__main__":
    for angle in (0, 20, 40, 60):
        for ratio in (1e-5, 1e-4, 1e-3, 1e-2, 1e-1)[:5 if angle < 60 else 4]:
            parts = missed(ratio, np.radians(angle))
            print(f"{angle:3d} {ratio:7.0e} " + " ".join(f"{100 * part:+6.1f}" for part in parts))
