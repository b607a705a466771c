"""The box of smoothed particles with plumb and LIGGGHTS, for ci/bench-peers.

LAMMPS has a package SPH too, but Debian's lammps is built without it.
"""
import json
import re
import shutil
import statistics
from pathlib import Path

PEERS = Path(__file__).resolve().parent
SIDE, CHECKED_SIDE = 64, 32  # particles to a side, of the timed and of the compared box
STEP = 0.25 * 1.3 / SIDE / 11.0  # the benchmark's 0.25 h/(c + U)
LEAST_STEPS = 20  # four renewals of the lists


def steps_per_second(output_of, folder, data, steps, side, step, out):
    text = output_of(["liggghts", "-in", PEERS / "sph_box.liggghts", "-var", "data", data, "-var", "steps", steps, "-var", "out",
                      out, "-var", "dx", 1.0 / side, "-var", "step", step, "-log", "none"], folder)
    seconds, done = re.search(r"Loop time of (\S+) on 1 procs for (\d+) steps", text).groups()
    return int(done) / float(seconds)


def check_physics(output_of, python, plumb, folder):
    """How far LIGGGHTS is from plumb after a hundred steps of the same equations, from the same start."""
    output_of([plumb, "run", PEERS / "sph_box.toml", "-o", "box", "--threads", "1", "--quiet"], folder)
    first, *_, last = sorted((folder / "box/snapshots").glob("*.h5"))
    states = [python, PEERS / "sph_states.py"]
    output_of([*states, "data", first, "box.data"], folder)
    steps_per_second(output_of, folder, "box.data", 100, CHECKED_SIDE, 5e-4, "box.dump")
    found = json.loads(output_of([*states, "compare", first, last, "box.dump"], folder))
    print("LIGGGHTS against plumb after 100 steps of {}^3 particles, over what changed: velocity {velocity:.1e}, energy {energy:+.1e}"
          .format(CHECKED_SIDE, **found), flush=True)
    return found


def plumb_updates(output_of, build, folder, seconds):
    text = output_of([build / "bin/plumb_benchmarks", "--benchmark_filter=^sph_box_h13/262144/threads:1$",
                      f"--benchmark_min_time={seconds}", "--benchmark_format=json"], folder)
    return json.loads(text[text.index("{"):text.rindex("}") + 1])["benchmarks"][0]["particle_updates/s"]


def bench(output_of, python, build, folder, repetitions, seconds):
    """Rates of both codes in turn, their ratio in each repetition; None where LIGGGHTS is not installed."""
    if not shutil.which("liggghts"):
        return None
    physics = check_physics(output_of, python, build / "bin/plumb", folder)
    output_of([python, PEERS / "sph_states.py", "start", SIDE, "start_sph.data"], folder)
    run = (output_of, folder, "start_sph.data")
    steps = max(LEAST_STEPS, int(seconds * steps_per_second(*run, LEAST_STEPS, SIDE, STEP, "sph.dump")))
    ours, theirs = [], []
    for _ in range(repetitions):
        ours.append(plumb_updates(output_of, build, folder, seconds))
        theirs.append(SIDE**3 * steps_per_second(*run, steps, SIDE, STEP, "sph.dump"))
    ratios = [a / b for a, b in zip(ours, theirs)]
    print(f"\n{'sph_box_h13':12} {'M particle updates/s':>21} {'least..most':>14}")
    for name, rates in (("plumb", ours), ("LIGGGHTS", theirs)):
        spread = f"{min(rates) * 1e-6:.2f}..{max(rates) * 1e-6:.2f}"
        print(f"{name:12} {statistics.median(rates) * 1e-6:21.3f} {spread:>14}")
    print(f"plumb over LIGGGHTS: {statistics.median(ratios):.1f} (median of {repetitions}; {min(ratios):.1f} to {max(ratios):.1f})")
    return {"particles": SIDE**3, "physics": physics, "plumb": ours, "liggghts": theirs, "ratio": statistics.median(ratios)}
