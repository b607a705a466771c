"""What one run left behind, as reference.py and the judge see it."""

import json
import tomllib
from functools import cached_property

import h5py
import numpy as np

from .metrics import NotComparable


class Run:
    """A finished run of the solver.

    variant, parameter, value    which run this is; value is None without a sweep
    outcome                      of a bisection's run: "stable", or why it was not
    exit, failure                exit code and the reason why the run cannot be used (None when it can)
    info                         run.json as a dict
    scene                        the merged scene as a dict, overrides included
    series(name)                 (t [nt], v [nt] or [nt, n]) of a probe
    units(name)                  units of a probe's values
    snapshot(k)                  {"time": t, "grains": {"x": [n, 3], ...}, ...}; k may be negative
    other(variant)               the run of another variant at the same sweep value, of the same judgement
    """

    def __init__(self, plan, parameter, exit_code, failure):
        self.variant, self.value, self.overrides, self.folder = plan.variant, plan.value, plan.overrides, plan.folder
        self.parameter = parameter
        self.outcome = None  # of a bisection: "stable", or why not
        self.exit = exit_code
        self.judged_with = []  # all runs of the judgement; none for a twin
        self.failure = failure or self.missing_output()

    def missing_output(self):
        """Why a run that claims success left no usable result; None when it did."""
        try:
            self.scene  # reads run.json, too
        except (OSError, ValueError, KeyError, TypeError) as error:
            return f"the run left no usable run.json: {error}"
        return None if (self.folder / "series.h5").is_file() else "the run left no series.h5"

    @cached_property
    def info(self):
        """run.json as a dict."""
        return json.loads((self.folder / "run.json").read_text(encoding="utf-8"))

    @cached_property
    def scene(self):
        """The scene that was solved, as a dict."""
        return tomllib.loads(self.info["scene"])

    @property
    def trials(self):
        """The single runs that this stands for: itself."""
        return [self]

    def other(self, variant):
        """The run of the variant `variant` at this run's sweep value; raises NotComparable when there is none to compare with."""
        for run in self.judged_with:
            if run.variant == variant and run.value in (self.value, None):
                if run.failure:
                    raise NotComparable(f"{variant}, which it is compared with: {run.failure}")
                return run
        raise NotComparable(f"there is no run of '{variant}' in this judgement to compare with")

    def derived(self, quantity):
        """A quantity that several runs decide together (bisection.Bisected); a single run has none."""
        return NotImplemented

    def series(self, name):
        """(t [nt], v [nt] or [nt, n]) of the probe `name`; raises NotComparable when there is no such probe."""
        t, v, _ = self.probe(name)
        return t, v

    def units(self, name):
        """Units of the values of the probe `name`; raises NotComparable when there is no such probe."""
        return self.probe(name)[2]

    def probe(self, name):
        """(t, v, units) of the probe `name`; raises NotComparable when it cannot be had."""
        try:
            with h5py.File(self.folder / "series.h5", "r") as file:
                if name not in file:
                    raise NotComparable(f"there is no probe '{name}'; the run has {', '.join(file) or 'none'}")
                t, v = file[name]["time"], file[name]["value"]
                return np.asarray(t, dtype=float), np.asarray(v, dtype=float), text_attribute(v.attrs, "units")
        except (OSError, KeyError) as error:
            raise NotComparable(f"series.h5 cannot be read: {error}") from error

    def snapshot_files(self):
        """The snapshot files in the order of time."""
        return sorted((self.folder / "snapshots").glob("*.h5"))

    def snapshot(self, k):
        """The k-th snapshot as nested dicts of arrays, plus its "time" in s."""
        files = self.snapshot_files()
        if not -len(files) <= k < len(files):
            raise NotComparable(f"there is no snapshot {k}; the run has {len(files)}")
        with h5py.File(files[k], "r") as file:
            content = {name: arrays(group) for name, group in file.items() if isinstance(group, h5py.Group)}
            content["time"] = float(np.squeeze(file.attrs["time"]))
        return content

    def cost(self):
        """Cost of the run as recorded in run.json; None where a failed run recorded nothing."""
        keys = ("wall_s", "cpu_s", "peak_bytes", "updates", "steps", "step", "ruling_limit")
        try:
            return {key: self.info.get(key) for key in keys}
        except (OSError, ValueError):
            return dict.fromkeys(keys)


def arrays(group):
    """A HDF5 group as a dict of arrays."""
    return {name: np.asarray(data) for name, data in group.items() if isinstance(data, h5py.Dataset)}


def text_attribute(attributes, name):
    """A text attribute whether stored as bytes or str; "" when absent."""
    value = attributes.get(name, "")
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)
