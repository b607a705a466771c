"""Grains in a fluid on a grid with plumb and OpenFOAM's DPMFoam, for ci/bench-peers.

Both solve the locally averaged equations with grains by DEM, but there is no scene that both run: DPMFoam needs cells wider
than its grains, the mud cake's throats need narrower ones. So each does its own, DPMFoam the fluidised bed that comes with it
(Goldschmidt's, 24 750 grains on 5400 cells), plumb a whole row of the mud cake, clean flow and start of the program
included. Compared are steps of one grain per second of CPU time with all that the fluid costs; of DPMFoam each of the several
collision steps in a step of its fluid counts, and its start does not.
"""
import gzip
import json
import re
import shutil
import statistics
import subprocess
from pathlib import Path

PEERS = Path(__file__).resolve().parent
CAKE = PEERS.parent / "mud_cake/scene.toml"
STEP = 2e-5  # [s] of the fluid, the example's own
LEAST_STEPS = 10
CONTROL = """FoamFile {{ version 2.0; format ascii; class dictionary; object controlDict; }}
application DPMFoam;
startFrom startTime; startTime 0; stopAt endTime; endTime {end};
deltaT {step};
writeControl timeStep; writeInterval 1000000000;
timeFormat general; timePrecision 9;
"""


def packaged(package, ending):
    """The path of an installed Debian package that ends so, or None."""
    run = subprocess.run(["dpkg", "-L", package], capture_output=True, text=True)
    return next((Path(line) for line in run.stdout.splitlines() if line.endswith(ending)), None)


def copy_example(example, folder):
    """The example with its files unpacked: Debian compresses what lies among the documentation."""
    shutil.copytree(example, folder)
    for packed in folder.rglob("*.gz"):
        packed.with_suffix("").write_bytes(gzip.decompress(packed.read_bytes()))
        packed.unlink()


def grain_steps_per_second(log):
    """From the end of the first step to the end of the last: collision steps of all grains over CPU seconds."""
    first, *steps = re.split(r"^Time = ", log, flags=re.M)[1:]
    grains = int(re.search(r"Current number of parcels\s+= (\d+)", first)[1])
    seconds = [float(re.search(r"ExecutionTime = (\S+) s", text)[1]) for text in (first, steps[-1])]
    done = 0
    for text in steps:
        parts = re.search(r"(\d+) move-collide subCycles", text)
        done += grains * (int(parts[1]) if parts else 1)
    return done / (seconds[1] - seconds[0])


class DPMFoam:
    name = "DPMFoam"

    def __init__(self, output_of, folder):
        self.run, self.folder = output_of, folder / "bed"
        self.environment = {"WM_PROJECT_DIR": str(packaged("openfoam", "/etc/controlDict").parent.parent)}
        copy_example(packaged("openfoam-examples", "/DPMFoam/Goldschmidt"), self.folder)
        self.write_control(1)
        self.log("blockMesh")

    def log(self, program):
        return self.run([program], self.folder, **self.environment)

    def write_control(self, steps):
        (self.folder / "system/controlDict").write_text(CONTROL.format(step=STEP, end=f"{steps * STEP:.9g}"))

    def version(self):
        return re.search(r"Build  : (.+)", self.log("blockMesh"))[1]

    def grain_steps(self, steps):
        self.write_control(steps)
        return grain_steps_per_second(self.log("DPMFoam"))


class Plumb:
    name = "plumb"

    def __init__(self, output_of, plumb, folder):
        self.run, self.plumb, self.folder = output_of, plumb, folder

    def version(self):
        return self.run([self.plumb, "--version"], self.folder).split("\n")[0]

    def grain_steps(self, _steps):
        shutil.rmtree(self.folder / "cake", ignore_errors=True)
        self.run([self.plumb, "run", CAKE, "-o", "cake", "--threads", "1", "--quiet"], self.folder)
        made = json.loads((self.folder / "cake/run.json").read_text())
        given_drag = sum(made["drag_range"][key] for key in ("inside", "outside", "dry"))  # grains, of all the fluid's steps
        return given_drag * made["coupling"]["grain_steps"] / made["cpu_s"]


def bench(output_of, plumb, folder, repetitions, seconds):
    """Rates of both codes in turn; None where DPMFoam or its example is not installed."""
    if not shutil.which("DPMFoam") or not packaged("openfoam-examples", "/DPMFoam/Goldschmidt"):
        print("grains on a grid: left out, the packages openfoam and openfoam-examples are not installed", flush=True)
        return None
    codes = [Plumb(output_of, plumb, folder), DPMFoam(output_of, folder)]
    rate = codes[1].grain_steps(LEAST_STEPS)
    steps = max(LEAST_STEPS, int(seconds * rate / 75_000))  # two or three times 24 750 grain steps each
    rates = {code.name: [] for code in codes}
    for _ in range(repetitions):
        for code in codes:
            rates[code.name].append(code.grain_steps(steps))
    ratios = [a / b for a, b in zip(rates["plumb"], rates["DPMFoam"])]
    print(f"\n{'on a grid':9} {'M grain-steps/s':>16} {'least..most':>15}  version")
    rows = []
    for code in codes:
        found = rates[code.name]
        rows.append({"name": code.name, "version": code.version(), "median": statistics.median(found), "all": found})
        spread = f"{min(found) * 1e-6:.2f}..{max(found) * 1e-6:.2f}"
        print(f"{code.name:9} {statistics.median(found) * 1e-6:16.3f} {spread:>15}  {rows[-1]['version']}")
    print(f"plumb over DPMFoam: {statistics.median(ratios):.1f} ({min(ratios):.1f}..{max(ratios):.1f})")
    return {"codes": rows, "ratios": ratios}
