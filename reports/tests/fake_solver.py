#!/usr/bin/python3
"""Stands in for the solver in the judge's tests: v' = (u - v)/tau by a rule of known order, in plumb's result layout.

The scene's [fake] table chooses the rule and the misbehaviour: rule = "trapezoid" (second order) | "euler" (first),
gain = 1.0 (a factor on tau: wrong physics), noise = 0.0, exit = 0 (fails with that code, at steps above exit_above), nan = false.
"""

import json
import os
import sys
import tomllib
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from plumb_reports.strict import toml_value  # noqa: E402


def overridden(scene, settings):
    """The scene with every key.path=value applied; an unknown key is invalid input as in plumb."""
    for setting in settings:
        path, value = setting.split("=", 1)
        *tables, last = path.split(".")
        target = scene
        for name in tables:
            target = target[name]
        if last not in target:
            print(f"error: unknown key {path}", file=sys.stderr)
            sys.exit(2)
        target[last] = tomllib.loads(f"v = {value}")["v"]
    return scene


def velocity(scene):
    """(t, v) at every output; v(0) = 0."""
    fake, timing = scene["fake"], scene["time"]
    h, steps = timing["step"], round(timing["end"] / timing["step"])
    rate = h / (fake["tau"] * fake["gain"])
    factor = (1 - rate / 2) / (1 + rate / 2) if fake["rule"] == "trapezoid" else 1 - rate
    t = np.arange(steps + 1) * h
    noise = fake["noise"] * np.random.default_rng(1).standard_normal(steps + 1)
    v = fake["terminal"] * (1 - factor**np.arange(steps + 1)) + noise
    return t, np.full_like(v, np.nan) if fake["nan"] else v


def write_results(folder, scene, scene_path, t, v):
    """run.json, series.h5 and one snapshot."""
    (folder / "snapshots").mkdir(parents=True)
    with h5py.File(folder / "series.h5", "w") as file:
        for name, values in (("v", v), ("v3", np.column_stack([v, 2 * v, -v]))):
            file[f"{name}/time"], file[f"{name}/value"] = t, values
            file[f"{name}/time"].attrs["units"], file[f"{name}/value"].attrs["units"] = "s", "m/s"
    with h5py.File(folder / "snapshots" / "000000.h5", "w") as file:
        file.attrs["time"] = 0.5
        file["grains/x"] = np.zeros((2, 3))
    info = {"version": "0", "commit": os.environ.get("FAKE_COMMIT", "abc123"), "dirty": False, "compiler": "none",
            "flags": "", "scene": "\n".join(f"{k} = {toml_value(x)}" for k, x in scene.items()), "scene_hash": "h",
            "scene_path": str(scene_path), "overrides": [], "threads": 1, "processor": "fake", "start": "2000",
            "wall_s": 1e-6 * len(t), "cpu_s": scene["fake"]["cpu_s"], "peak_bytes": 1000, "steps": len(t) - 1,
            "updates": len(t) - 1, "step": scene["time"]["step"], "ruling_limit": "drag",
            "limits": {"drag": 1.25 * scene["time"]["step"]}, "exit": 0}
    (folder / "run.json").write_text(json.dumps(info), encoding="utf-8")


def main():
    """plumb run scene.toml [--set k=v]... -o DIR --threads N --quiet"""
    arguments = sys.argv[1:]
    scene_path = Path(arguments[1])
    settings = [arguments[i + 1] for i, word in enumerate(arguments) if word == "--set"]
    scene = overridden(tomllib.loads(scene_path.read_text(encoding="utf-8")), settings)
    if scene["fake"]["exit"] and scene["time"]["step"] > scene["fake"]["exit_above"]:
        print("error: it was asked for", file=sys.stderr)
        sys.exit(scene["fake"]["exit"])
    write_results(Path(arguments[arguments.index("-o") + 1]), scene, scene_path, *velocity(scene))


main()
