"""Where kernels take a fifth of a Rayleigh-Taylor wave's growth: loss against a sharp edge over (Re_p, lambda/h) (README.md)."""

import importlib.util
import math
from functools import lru_cache
from pathlib import Path

import numpy as np

_spec = importlib.util.spec_from_file_location("rayleigh_taylor_reference", Path(__file__).resolve().parents[1] / "rayleigh_taylor" / "reference.py")
scene_theory = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(scene_theory)

from scipy.spatial import cKDTree  # noqa: E402
from theory import rayleigh_taylor, released_layers, sedimentation_scene, settling  # noqa: E402

UNITS = {"loss": "1", "loss.boundary": "1", "loss.stable": "1", "loss.unstable": "1"}
WAVE = 0  # of sedimentation_scene.wave_numbers: the longer one, 4 mm
LOST = 0.2
SHARP = 5e-5  # m: kernels of a third of the layers' distance, for the waves a slab with sharp edges
PLACES = (1.5, 1.7, 1.9, 2.1)  # h over spacing, at which the predicted loss is worked out
SHORT = ("inside", "outside")  # runs that are no bisection's
MANY = 0.01  # share of paired particles that the map marks
PAIRED = 0.6  # spacings: particles closer than this count as paired


@lru_cache(maxsize=None)
def theory(rho, mu, h, end):
    """(window's start and end [s], slope of ln A in it for the scheme, for a sharp layer at rest [1/s])."""
    k, exact = sedimentation_scene.wave_numbers()[WAVE], dict(settles=False, morris=False)
    s = released_layers.Setting(rho, mu, h, sedimentation_scene.coupling_width(h, rayleigh_taylor.EPS), h)
    sharp = released_layers.Setting(rho, mu, SHARP, SHARP, h, **exact)
    times = tuple(np.linspace(0.0, end, round(end / scene_theory.GRID) + 1))
    rises = [released_layers.history(one, k, times, scene_theory.GRID).rise[:, 0] for one in (s, sharp)]
    t, wide = np.array(times), rises[0]
    grown = np.gradient(np.log(wide), t) >= scene_theory.DEVELOPED * released_layers.growth_rate(s, k)
    start = float(t[np.argmax(grown)]) if grown.any() else math.nan
    stop = float(np.interp(scene_theory.STEEP, k * settling.GRAIN["d"] / 8.0 * wide, t))
    return start, stop, *(scene_theory.fitted(t, rise, start, stop) for rise in rises)


def meant(scene):
    """rho, mu, end of the run: of the fluid; coupling and grains are the case's, which a twin may break."""
    return scene["fluid"]["density"], scene["fluid"]["viscosity"], scene["time"]["end"]


def width(scene):
    """h, m."""
    return scene["fluid"]["smoothing"] * scene["fluid"]["spacing"]


def predicted_loss(scene, h):
    rho, mu, end = meant(scene)
    _, _, wide, sharp = theory(rho, mu, h, end)
    return 1.0 - wide / sharp


@lru_cache(maxsize=None)
def predicted_smoothing(rho, mu, end, spacing):
    """h over spacing at which linear theory of the scheme loses LOST: between PLACES by a parabola."""
    scene = {"fluid": {"density": rho, "viscosity": mu}, "time": {"end": end}}
    losses = [predicted_loss(scene, place * spacing) for place in PLACES]
    return float(np.exp(np.polyval(np.polyfit(losses, np.log(PLACES), 2), LOST)))


def boundary(scene):
    return predicted_smoothing(*meant(scene), scene["fluid"]["spacing"])


def reference(quantity, scene, t):
    if quantity == "loss.boundary":
        return boundary(scene)
    if quantity in UNITS:
        return 0.0
    raise KeyError(quantity)


def loss(run):
    """Share of the sharp layer's growth that the run is short of, over the window of linear theory; 1 where nothing is left to fit."""
    start, stop, _, sharp = theory(*meant(run.scene)[:2], width(run.scene), meant(run.scene)[2])
    m = scene_theory.measured(run)
    return 1.0 - scene_theory.fitted(m.t, m.amplitude[WAVE], start, stop) / sharp


def measure(quantity, run):
    return loss(run) if quantity == "loss" else NotImplemented


# --- the page ---


def re_p(scene):
    """Of a lone grain at its terminal velocity."""
    rho, mu, _ = meant(scene)
    return settling.hindered_re(settling.archimedes(settling.GRAIN["rho_p"], rho, settling.GRAIN["d"], mu), 1.0, 1)


def wavelength():
    return 2.0 * math.pi / sedimentation_scene.wave_numbers()[WAVE]


def paired(run):
    """Share of particles with another one closer than PAIRED spacings in the last snapshot of the window."""
    _, stop, _, _ = theory(*meant(run.scene)[:2], width(run.scene), meant(run.scene)[2])
    last = int(np.searchsorted(scene_theory.measured(run).t, stop + 1e-9, side="right")) - 1
    size, x = run.scene["domain"]["size"], run.snapshot(last)["fluid"]["x"]
    x = np.column_stack([x[:, 0] % size[0], x[:, 1] % size[1], x[:, 2]])
    near = cKDTree(x, boxsize=[size[0], size[1], 10.0 * size[2]]).query(x, k=2)[0][:, 1]
    return float(np.mean(near < PAIRED * run.scene["fluid"]["spacing"]))


def trials(runs):
    """[(variant, run)] of every finished run, those of the bisections each for itself."""
    return [(run.variant, trial) for run in runs for trial in run.trials if not trial.failure]


def table(runs):
    rows = []
    for variant, run in trials(runs):
        h = width(run.scene)
        rows.append([variant, f"{re_p(run.scene):.3f}", f"{run.scene['fluid']['smoothing']:.3f}", f"{wavelength() / h:.2f}", f"{loss(run):.3f}",
                     f"{predicted_loss(run.scene, h):.3f}", f"{paired(run):.3f}"])
    return {"columns": ["run", "Re_p", "h/spacing", "wavelength/h", "loss", "predicted loss", "share paired"], "rows": rows,
            "caption": "Loss: of the sharp layer's growth, over the case's window. Paired: share of particles with another one closer than "
                       f"{PAIRED:g} spacings at the window's end."}


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    seen, edge = set(), {}
    for variant, run in trials(runs):
        found, h = loss(run), width(run.scene)
        re, stable = re_p(run.scene), found <= LOST
        style, label = ("C0o", "loses less than a fifth") if stable else ("C3x", "loses more")
        left.plot(re, wavelength() / h, style, ms=5, mfc="none", label=None if label in seen else label)
        seen.add(label)
        if paired(run) > MANY:
            many = None if "many" in seen else f"more than {100 * MANY:g} % of the particles paired"
            left.plot(re, wavelength() / h, "ko", ms=10, mfc="none", lw=0.6, mew=0.6, label=many)
            seen.add("many")
        if variant not in SHORT:
            edge[re] = wavelength() / (boundary(run.scene) * run.scene["fluid"]["spacing"])
        right.plot(predicted_loss(run.scene, h), found, style, ms=5, mfc="none")
    places = sorted(edge)
    if places:
        left.plot(places, [edge[re] for re in places], "k-", lw=1, label="a fifth lost, linear theory of the scheme")
    left.set(xlabel="Re_p of a lone grain [-]", ylabel="wavelength over h [-]", xscale="log")
    left.legend(fontsize="x-small")
    right.axline((0.0, 0.0), slope=1.0, color="k", lw=0.8)
    right.set(xlabel="predicted loss [-]", ylabel="loss of the run [-]", xlim=(0.0, 0.5), ylim=(0.0, 0.5))
    return [("map", figure, "Share of the sharp layer's growth that kernels, Morris' friction and settling take: every run of the bisections, over the predicted "
             "boundary, and against the predicted loss.")]
