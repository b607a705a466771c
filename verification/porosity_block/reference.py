"""Fall of the rigid block: from the 1-D theory reference_data/theory/sinking_block.py (README), and of a uniform suspension."""

import math
import sys
from functools import lru_cache
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import sedimentation_scene, sinking_block, smoothed_block  # noqa: E402

UNITS = {"speed": "m/s", "speed_exact_divergence": "m/s", "fall": "m/s"}


class Setting:
    """What the theory needs of a scene as it is meant: laws, mass and direction are the case's, which a twin may break."""

    def __init__(self, scene):
        fluid, cp, arrange = scene["fluid"], scene["coupling"], scene["grains"]["arrange"]
        self.fluid = {"rho": fluid["density"], "mu": fluid["viscosity"]}
        self.h = fluid["spacing"] * fluid["smoothing"]
        self.c, self.end = fluid["sound_speed"], scene["time"]["end"]
        self.box = scene["domain"]["size"][2]
        self.closed = not scene["domain"]["periodic"][2]
        spacing, low = arrange["spacing"], arrange["lower"][2]
        layers = round((arrange["upper"][2] - low) / spacing)
        self.block = sedimentation_scene.Lattice(math.nan, round(sedimentation_scene.WIDTH / spacing), layers, spacing, low)
        widths = [cp[key]["times_smoothing"] * self.h if isinstance(cp[key], dict) else cp[key]
                  for key in ("kernel_width", "gather_width", "porosity_width")]
        self.widths = sinking_block.Widths(self.h, *widths, cp["porosity"], cp["own_volume"] == "included")
        self.surface = fluid["fill"]["upper"][2] if fluid.get("free_surface") else None
        artificial = fluid.get("artificial_viscosity", 0.0) * self.c * self.h / 20.0  # alpha c h/(4 (d + 2)), approaching pairs only
        reached = self.c**2 * self.end / (fluid["viscosity"] / fluid["density"] + artificial)
        self.answered = sinking_block.Answer(reached, fluid["spacing"])

    @property
    def period(self):
        """Of the longest wave of sound, s; under a free surface a quarter of it stands in the fluid."""
        if self.surface is not None:
            return 4.0 * self.surface / self.c
        return (2.0 if self.closed else 1.0) * self.box / self.c


@lru_cache(maxsize=None)
def _theory(key):
    fluid, block, widths, box, answered, closed = key
    fluid = dict(fluid)
    depth = box + 4.0 * max(widths[:4]) if closed else box  # a box with walls has no images: theirs are kept out of reach
    at = sinking_block.field(block, depth, widths, answered)
    v = sinking_block.velocity(fluid, block, widths, at)
    return v, 1.0 if closed else sinking_block.share_in_box(at, smoothed_block.GRAIN["rho_p"] / fluid["rho"])


def theory(s, answered):
    """(V through clear fluid at rest, share of it that the block has in the scene's box); answered = None: exact divergence."""
    return _theory((tuple(s.fluid.items()), s.block._replace(nominal=0.0), s.widths, s.box, answered, s.closed))


def quasi_steady(run):
    """Speed of the block, m/s, downwards: averaged twice over the period of sound, at the end of the run."""
    s, (t, v) = Setting(run.scene), run.series("block")
    v = -np.ravel(v)
    per_period = round(s.period / (t[1] - t[0]))
    once = np.ones(per_period) / per_period
    return float(np.convolve(np.convolve(v, once, "valid"), once, "valid")[-1])


def fall(run):
    """Speed through clear fluid at rest, m/s: that of the block over its share in the box, which follows from volumes."""
    s = Setting(run.scene)
    return quasi_steady(run) / theory(s, s.answered)[1]


def measure(quantity, run):
    if quantity in ("speed", "speed_exact_divergence"):
        return quasi_steady(run)
    if quantity == "fall":
        return fall(run)
    return NotImplemented


def reference(quantity, scene, t):
    s = Setting(scene)
    if quantity == "fall":
        return smoothed_block.uniform_velocity(s.fluid, s.block.eps)
    if quantity in UNITS:
        return math.prod(theory(s, s.answered if quantity == "speed" else None))
    raise KeyError(quantity)


# --- the page ---


def _numbers(run):
    """(eps of the lattice, h/d, width/d, gathered eps, V, theory, exact divergence, lattice's V)"""
    s = Setting(run.scene)
    at = sinking_block.field(s.block, s.box, s.widths, None)
    gather = sinking_block.plane_average(sinking_block.heights_apart(at.z, s.block, s.box), s.widths.gather)
    gathered = float(((gather.T @ at.eps) / gather.sum(axis=0)).mean())
    v = [theory(s, answered)[0] for answered in (s.answered, None)]
    d = smoothed_block.GRAIN["d"]
    return s.block.eps, s.h / d, s.widths.porosity / d, gathered, fall(run), *v, smoothed_block.uniform_velocity(s.fluid, s.block.eps)


def table(runs):
    rows = []
    for run in runs:
        if run.failure:
            continue
        eps, h, width, seen, v, own, exact, lattice = _numbers(run)
        smoothed = smoothed_block.uniform_velocity(Setting(run.scene).fluid, seen)
        rows.append([run.variant, f"{eps:.3f}", f"{seen:.3f}", f"{h:.2g}", f"{width:.2f}", f"{1e3 * v:.4g}", f"{v / own:.4f}",
                     f"{v / exact:.4f}", f"{v / smoothed:.3f}", f"{v / lattice:.3f}"])
    return {"columns": ["run", "eps of the lattice", "mean eps gathered", "h/d", "width of porosity/d", "V (mm/s)", "over the theory",
                        "over that with an exact divergence", "over the law at the eps gathered", "over the law at the lattice's eps"],
            "rows": rows, "caption": "Fall of the block through clear fluid at rest."}


PANELS = {"published": ("published widths", 2.6), "narrow": ("one narrow width", 1.3), "best": ("porosity deconvolved", 1.3)}
MARKS = {6.0: "s", 4.0: "v", 3.0: "^", 2.0: "o", 1.5: "D"}


def _panel(run):
    """Where a run is shown; None: nowhere."""
    words = run.variant.split("_")
    if run.failure or words[0] not in ("water", "glycerol") or words[-1] in ("wider", "commensurate"):
        return None
    return next((word for word in PANELS if word in words), "published")


def _draw(axes, shown):
    """Points of the runs and lines of the theory; shown: [(fluid, _numbers)]."""
    for index, width in enumerate(sorted(MARKS)):
        for fluid, filled in (("water", False), ("glycerol", True)):
            own = sorted(n for name, n in shown if name == fluid and abs(n[1] - width) < 0.1)
            if not own:
                continue
            eps = [n[0] for n in own]
            axes.plot(eps, [n[5] / n[7] for n in own], "--" if filled else "-", color=f"C{index}", lw=1.0)
            axes.plot(eps, [n[4] / n[7] for n in own], MARKS[width], color=f"C{index}", ms=5,
                      mfc=None if filled else "none", label=f"h/d = {width:g}, {fluid}")


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 4.0), layout="constrained")
    good = [(_panel(run), run.variant.split("_")[0], _numbers(run)) for run in runs if _panel(run)]
    for axes, (name, (title, top)) in zip(figure.subplots(1, 3), PANELS.items()):
        _draw(axes, [(fluid, numbers) for panel, fluid, numbers in good if panel == name])
        axes.axhspan(0.95, 1.05, color="0.85", zorder=0)
        axes.axhspan(0.9, 1.1, color="0.93", zorder=-1)
        axes.set(title=title, xlabel="eps of the lattice (-)", ylabel="V over the law's at that eps (-)", xlim=(0.5, 1.0), ylim=(0.9, top))
        if axes.get_legend_handles_labels()[0]:
            axes.legend(fontsize=7)
    return [("block", figure, "Fall of the block over that of a uniform suspension of the lattice's own porosity. Lines: theory, dashed in "
             "glycerol-water; symbols: runs, filled in glycerol-water; grey: 5 and 10 %.")]
