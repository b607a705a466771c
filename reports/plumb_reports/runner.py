"""Runs the solver. Nothing is taken from an earlier run: every verdict rests on fresh output."""

import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

from .plan import command
from .results import Run

EXIT_MEANING = {2: "invalid input", 3: "diverged", 4: "input/output failure", 130: "interrupted"}


def executed(case, plans, plumb, jobs):
    """The Runs of `plans`, in their order, at most `jobs` at a time."""
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        return list(pool.map(lambda plan: executed_plan(case, plan, plumb), plans))


def executed_plan(case, plan, plumb):
    """The Run of one Plan. A run that fails is a Run with its `failure` set, not an exception."""
    shutil.rmtree(plan.folder, ignore_errors=True)
    plan.folder.parent.mkdir(parents=True, exist_ok=True)
    done = subprocess.run(command(plumb, case.folder / "scene.toml", plan), cwd=case.folder, check=False,
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
    parameter = case.sweep.parameter if case.sweep and plan.value is not None else None
    return Run(plan, parameter, done.returncode, failure_text(done))


def failure_text(done):
    """Why a finished process counts as failed, in one line; None when it exited with 0."""
    if done.returncode == 0:
        return None
    lines = (done.stderr.strip() or done.stdout.strip()).splitlines()
    last = f": {lines[-1].strip()}" if lines else ""
    if done.returncode < 0:
        return f"the run was killed by signal {-done.returncode}{last}"
    meaning = EXIT_MEANING.get(done.returncode, "unexpected")
    return f"the run ended with exit {done.returncode} ({meaning}){last}"
