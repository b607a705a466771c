"""Energy and momentum of elastic grains are constant; the error of velocity Verlet has a known size."""

import numpy as np

MASS = 2500.0 * np.pi / 6 * 0.995e-3**3   # kg
UNITS = {"energy_error": "1", "energy_rms": "1", "momentum_error": "1"}


def reference(quantity, scene, t):
    """Nothing changes."""
    if quantity not in UNITS:
        raise KeyError(quantity)
    return np.zeros_like(np.asarray(t, dtype=float))


def energy_error(run):
    """(t, change of the total energy over the kinetic energy at the start)."""
    t, energy = run.series("total_energy")
    return t, (energy - energy[0]) / run.series("kinetic_energy")[1][0]


def measure(quantity, run):
    """Error of the energy over time, its root mean square, or the largest change of momentum over sqrt(2 M K(0))."""
    if quantity == "energy_error":
        return energy_error(run)
    if quantity == "energy_rms":
        return float(np.sqrt(np.mean(energy_error(run)[1]**2)))
    if quantity != "momentum_error":
        return NotImplemented
    grains = 256  # 4 x 4 x 4 cells of 4
    scale = np.sqrt(2 * grains * MASS * run.series("kinetic_energy")[1][0])
    change = [np.max(np.abs(p - p[0])) for _, p in (run.series(f"momentum_{axis}") for axis in "xyz")]
    return float(max(change) / scale)


def figures(runs):
    """Error of the energy over time, divided by the square of the step."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(7.0, 6.0), layout="constrained")
    names = [name for name in dict.fromkeys(run.variant for run in runs) if name != "gas_long"]
    panels = np.atleast_1d(figure.subplots(len(names), 1))
    for axes, name in zip(panels, names):
        for run in runs:
            if run.variant != name or run.failure:
                continue
            t, error = energy_error(run)
            axes.plot(t, error / run.value**2, lw=0.8, label=f"{run.value:.3g} s")
        axes.set_title(name, fontsize="small")
        axes.set_ylabel("error/step^2 [1/s2]")
    panels[0].legend(fontsize="x-small", title="step", title_fontsize="x-small")
    panels[-1].set_xlabel("time [s]")
    return [("energy", figure, "Error of the total energy over the initial kinetic energy and the square of the step: the "
             "curves coincide as long as the paths do, hence second order. Gases are chaotic and part after a while.")]
