"""The program under bad input, full disks, kills and interruptions, seen from outside.

Run with `PLUMB_BINARY=<build>/bin/plumb pytest test_faults.py`.
"""

import json
import os
import random
import resource
import shutil
import signal
import subprocess
import time
from pathlib import Path

import h5py
import numpy as np
import pytest

BINARY = os.environ.get("PLUMB_BINARY", "")
pytestmark = pytest.mark.skipif(not BINARY, reason="PLUMB_BINARY names no program")

# A few hundred grains fall into a box, rub and roll: every kind of memory is in use.
BED = """
[domain]
size = [0.01, 0.01, 0.04]
periodic = [true, true, false]
gravity = [0.3, 0.0, -9.81]
[grains]
name = "sand"
density = 2500.0
diameter = {law = "uniform", minimum = 0.9e-3, maximum = 1.1e-3, seed = 1}
rotation = true
motion = "free"
arrange = {law = "random", count = 400, lower = [0.0, 0.0, 0.001], upper = [0.01, 0.01, 0.015], seed = 2}
velocity = {law = "uniform_random", speed = 0.3, seed = 3}
angular_velocity = [0.0, 0.0, 0.0]
[grains.contact]
law = "linear_spring"
stiffness = 1000.0
restitution = 0.8
friction = 0.5
tangential_stiffness = 300.0
tangential_damping = 0.01
rolling = {law = "elastic_plastic", friction = 0.1, stiffness = 1e-6, damping = 0.3}
[[wall]]
name = "floor"
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
contact = "as_grains"
[time]
end = 0.02
output_interval = 5e-4
integrator = "velocity_verlet"
step = "auto"
snapshots = true
[[probe]]
name = "energy"
quantity = "grain_kinetic_energy"
[[probe]]
name = "weight"
quantity = "wall_force"
wall = "floor"
axis = "z"
interval = 1e-4
"""
LONG = ["--set", "time.end=100.0", "--set", "time.output_interval=5e-4"]


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "bed.toml"
    path.write_text(BED)
    return path


def plumb(*words, **options):
    return subprocess.run([BINARY, *map(str, words)], capture_output=True, text=True, timeout=60, **options)


def complaint(result, code):
    """The one line on stderr of a run that must fail with `code`."""
    assert result.returncode == code, result.stderr
    assert result.stderr.startswith("plumb: error: ")
    assert result.stderr.count("\n") == 1 and result.stderr.endswith("\n")
    return result.stderr


def changed(text, old, new):
    assert old in text
    return text.replace(old, new)


BAD_SCENES = {
    "unknown key": (lambda t: changed(t, "end = 0.02", "end = 0.02\nspeed = 1"), "time.speed"),
    "unknown table": (lambda t: t + "\n[magnet]\nfield = 1.0\n", "magnet"),
    "missing key": (lambda t: changed(t, 'integrator = "velocity_verlet"\n', ""), "time.integrator"),
    "missing table": (lambda t: t[: t.index("[time]")], "time"),
    "wrong type": (lambda t: changed(t, "density = 2500.0", 'density = "heavy"'), "grains.density"),
    "not a number": (lambda t: changed(t, "density = 2500.0", "density = nan"), "grains.density"),
    "infinite": (lambda t: changed(t, "end = 0.02", "end = inf"), "time.end"),
    "negative mass": (lambda t: changed(t, "density = 2500.0", "density = -2500.0"), "grains.density"),
    "zero spacing": (
        lambda t: changed(
            t,
            '{law = "random", count = 400, lower = [0.0, 0.0, 0.001], upper = [0.01, 0.01, 0.015], seed = 2}',
            '{law = "lattice", kind = "cubic", spacing = 0.0, lower = [0.0, 0.0, 0.001], upper = [0.01, 0.01, 0.015]}',
        ),
        "spacing",
    ),
    "unknown law": (lambda t: changed(t, "linear_spring", "rubber"), "contact.law"),
    "duplicated key": (lambda t: changed(t, "end = 0.02", "end = 0.02\nend = 0.03"), "line"),
    "empty": (lambda t: "", "empty"),
    "not TOML": (lambda t: "\x00\x01 what is this", "line 1"),
    "unfinished": (lambda t: t[: t.index("periodic") + 14], "line"),
    "grain outside": (lambda t: changed(t, "[0.01, 0.01, 0.015], seed", "[0.01, 0.01, 0.15], seed"), "arrange"),
    "overlapping start": (
        lambda t: changed(
            t,
            '{law = "random", count = 400, lower = [0.0, 0.0, 0.001], upper = [0.01, 0.01, 0.015], seed = 2}',
            '{law = "lattice", kind = "cubic", spacing = 0.625e-3, lower = [0.0, 0.0, 0.001], upper = [0.01, 0.01, 0.015]}',
        ),
        "overlap",
    ),
    "too many to place": (lambda t: changed(t, "count = 400", "count = 4000"), "arrange"),
    "no such CSV": (
        lambda t: changed(
            t,
            '{law = "random", count = 400, lower = [0.0, 0.0, 0.001], upper = [0.01, 0.01, 0.015], seed = 2}',
            '{law = "file", path = "none.csv"}',
        ),
        "none.csv",
    ),
    "truncated CSV": (
        lambda t: changed(
            t,
            '{law = "random", count = 400, lower = [0.0, 0.0, 0.001], upper = [0.01, 0.01, 0.015], seed = 2}',
            '{law = "file", path = "cut.csv"}',
        ),
        "cut.csv",
    ),
    "unreadable STL": (
        lambda t: changed(
            t, 'shape = "plane"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]', 'shape = "stl"\npath = "bad.stl"'
        ),
        "bad.stl",
    ),
    "step that does not divide": (lambda t: changed(t, 'step = "auto"', "step = 3.1e-6"), "output_interval"),
    "probe of nothing": (lambda t: changed(t, '"wall_force"', '"temperament"'), "probe[1].quantity"),
    "two probes of one name": (lambda t: changed(t, '"weight"', '"energy"'), "probe[1].name"),
}


@pytest.mark.parametrize("kind", BAD_SCENES)
@pytest.mark.parametrize("command", ["run", "check"])
def test_bad_scene_is_one_line_and_writes_nothing(tmp_path, kind, command):
    change, named = BAD_SCENES[kind]
    (tmp_path / "scene.toml").write_text(change(BED))
    (tmp_path / "cut.csv").write_text("x [m],y [m],z [m]\n0.001,0.001,0.001\n0.002,0.0")
    (tmp_path / "bad.stl").write_bytes(b"solid x\n facet normal 0 0")
    before = sorted(tmp_path.iterdir())
    text = complaint(plumb(command, "scene.toml", cwd=tmp_path), 2)
    assert named in text
    assert sorted(tmp_path.iterdir()) == before


def test_scenes_that_are_no_files(tmp_path):
    assert "no such file" in complaint(plumb("run", tmp_path / "none.toml"), 2)
    assert "directory" in complaint(plumb("run", tmp_path), 2)
    with open(tmp_path / "huge.toml", "wb") as file:
        file.truncate(1 << 33)  # 8 GiB of nothing, no disk space taken
    assert "too large" in complaint(plumb("run", tmp_path / "huge.toml"), 2)
    assert list(tmp_path.iterdir()) == [tmp_path / "huge.toml"]


def test_unreadable_scene(tmp_path, scene):
    if os.geteuid() == 0:
        pytest.skip("root reads everything")
    scene.chmod(0)
    complaint(plumb("run", scene, cwd=tmp_path), 2)


def test_too_large_a_step_diverges(tmp_path, scene):
    out = tmp_path / "out"
    text = complaint(plumb("run", scene, "-o", out, "--quiet", "--set", "time.step=5e-4", "--set", "probe.1.interval=5e-4"), 3)
    for part in ("step ", "grain ", "contact limit", "diverged.h5"):
        assert part in text
    with h5py.File(out / "snapshots" / "diverged.h5") as file:
        assert file["grains/x"].shape == (400, 3)
    assert json.loads((out / "run.json").read_text())["exit"] == 3


def limit_files(size):
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))


@pytest.mark.parametrize("size", [100, 5000, 40000])
def test_files_that_cannot_grow(tmp_path, scene, size):
    text = complaint(plumb("run", scene, "-o", tmp_path / "out", "--quiet", preexec_fn=limit_files(size)), 4)
    assert "too large" in text
    assert not list((tmp_path / "out").rglob("*.tmp"))


def test_full_disk(tmp_path, scene):
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = shutil.which("mount") and os.geteuid() == 0
    if not mounted or subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", disk]).returncode != 0:
        pytest.skip("no small disk can be mounted here")
    try:
        result = plumb("run", scene, "-o", disk / "out", "--quiet", "--set", "time.end=0.2")
        assert "No space left on device" in complaint(result, 4)
        for snapshot in (disk / "out" / "snapshots").glob("*.h5"):
            with h5py.File(snapshot) as file:
                assert file["grains/x"].shape == (400, 3)
    finally:
        subprocess.run(["umount", disk], check=True)


def test_unwritable_places(tmp_path, scene):
    complaint(plumb("run", scene, "-o", "/proc/here"), 4)
    (tmp_path / "file").write_text("x")
    complaint(plumb("run", scene, "-o", tmp_path / "file"), 2)
    with open("/dev/full", "w") as full:
        result = subprocess.run([BINARY, "check", scene], stdout=full, stderr=subprocess.PIPE, text=True)
    assert result.returncode == 4 and "No space left" in result.stderr


def started(scene, out, *more):
    process = subprocess.Popen([BINARY, "run", scene, "-o", out, "--quiet", *more], stderr=subprocess.PIPE, text=True)
    for _ in range(500):
        if (out / "checkpoint.h5").exists():
            return process
        time.sleep(0.01)
    process.kill()
    raise AssertionError("no checkpoint after 5 s")


def test_kill_leaves_complete_files(tmp_path, scene):
    pause = random.Random(1)
    for k in range(5):
        out = tmp_path / f"out{k}"
        process = started(scene, out, *LONG)
        time.sleep(pause.uniform(0.0, 0.6))
        process.kill()
        process.wait()
        for path in [out / "series.h5", out / "checkpoint.h5", *sorted((out / "snapshots").glob("*.h5"))]:
            with h5py.File(path) as file:
                file.visititems(lambda _, item: item[()] if isinstance(item, h5py.Dataset) else None)
        json.loads((out / "run.json").read_text())
        last = sorted((out / "snapshots").glob("*.h5"))[-1]
        with h5py.File(last) as file:
            assert np.isfinite(file["grains/x"][()]).all()
            assert (file["grains/id"][()] == np.arange(400)).all()


@pytest.fixture(scope="module")
def unbroken(tmp_path_factory):
    folder = tmp_path_factory.mktemp("unbroken")
    (folder / "bed.toml").write_text(BED)
    assert plumb("run", folder / "bed.toml", "-o", folder / "out", "--quiet", "--threads", 1, "--set", "time.end=0.1").returncode == 0
    return folder / "out"


def identical(a, b):
    result = plumb("diff", a, b)
    assert result.returncode == 0, result.stdout + result.stderr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_resumed_run_is_the_unbroken_one(tmp_path, scene, unbroken, number):
    out = tmp_path / "out"
    process = started(scene, out, "--threads", "1", "--set", "time.end=0.1")
    stops = 0
    for k in range(3):
        time.sleep(0.1 + 0.1 * k)
        if process.poll() is not None:
            break
        process.send_signal(number)
        asked = time.monotonic()
        _, errors = process.communicate(timeout=30)
        if process.returncode == 0:
            break
        stops += 1
        if number == signal.SIGKILL:
            assert process.returncode == -signal.SIGKILL
        else:
            assert process.returncode == 130
            assert time.monotonic() - asked < 3.0  # one second, and patience with a busy machine
            assert errors.startswith("plumb: interrupted after step") and errors.count("\n") == 1
            assert json.loads((out / "run.json").read_text())["exit"] == 130
        threads = str(1 + k % 2)
        process = subprocess.Popen([BINARY, "resume", out, "--quiet", "--threads", threads], stderr=subprocess.PIPE, text=True)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 0, errors
    assert stops > 0
    identical(unbroken, out)


def test_threads_do_not_matter(tmp_path, scene, unbroken):
    out = tmp_path / "two"
    assert plumb("run", scene, "-o", out, "--quiet", "--threads", 2, "--set", "time.end=0.1").returncode == 0
    identical(unbroken, out)
    assert json.loads((out / "run.json").read_text())["threads"] == 2


def test_broken_checkpoints_are_refused(tmp_path, scene):
    out = tmp_path / "out"
    assert plumb("run", scene, "-o", out, "--quiet", "--set", "time.end=0.001").returncode == 0
    whole = (out / "checkpoint.h5").read_bytes()
    for content in (b"", b"garbage", whole[: len(whole) // 2], whole[:-1]):
        (out / "checkpoint.h5").write_bytes(content)
        complaint(plumb("resume", out), 4)
    (out / "checkpoint.h5").unlink()
    complaint(plumb("resume", out), 2)


def test_second_run_replaces_the_first(tmp_path, scene):
    out = tmp_path / "out"
    assert plumb("run", scene, "-o", out, "--quiet", "--set", "time.end=0.002").returncode == 0
    assert len(list((out / "snapshots").iterdir())) == 5
    (out / "notes.txt").write_text("mine")
    assert plumb("run", scene, "-o", out, "--quiet", "--set", "time.end=0.001").returncode == 0
    assert len(list((out / "snapshots").iterdir())) == 3
    assert (out / "notes.txt").read_text() == "mine"


def test_index_is_readable(tmp_path, scene):
    import xml.etree.ElementTree as xml

    out = tmp_path / "out"
    assert plumb("run", scene, "-o", out, "--quiet", "--set", "time.end=0.001").returncode == 0
    grids = xml.parse(out / "result.xdmf").getroot().findall("./Domain/Grid/Grid")
    assert len(grids) == 3
    for grid in grids:
        for item in grid.iter("DataItem"):
            name, dataset = item.text.split(":")
            with h5py.File(out / name) as file:
                assert list(file[dataset].shape) == [int(n) for n in item.get("Dimensions").split()]
