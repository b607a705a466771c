import numpy as np

UNITS = {"terminal": "m/s"}


def reference(quantity, scene, t):
    if quantity == "terminal":
        return {"value": 2.0, "uncertainty": 0.02}
    fake = scene["fake"]
    v = fake["terminal"] * (1 - np.exp(-t / fake["tau"]))
    return np.column_stack([v, 2 * v, -v]) if quantity == "v3" else v


def measure(quantity, run):
    return run.series("v")[1][-1] if quantity == "terminal" else NotImplemented
