"""A result as pictures."""

import json

import h5py
import numpy as np
import pytest
from PIL import Image

from plumb_reports import __main__ as command_line
from plumb_reports import film
from plumb_reports.strict import CaseError

SCENE = "[domain]\nsize = [2e-3, 2e-3, 4e-3]\n[fluid]\nspacing = 5e-4\n[time]\noutput_interval = 0.5\n"


@pytest.fixture
def result(tmp_path):
    """Two snapshots: fluid that goes up beside two grains, of which the middle plane cuts one."""
    folder = tmp_path / "run"
    (folder / "snapshots").mkdir(parents=True)
    (folder / "run.json").write_text(json.dumps({"scene": SCENE}))
    x = np.array([[5e-4, 1e-3, 1e-3], [1.5e-3, 1.1e-3, 3e-3], [1e-3, 1.9e-3, 2e-3]])
    for k in range(2):
        with h5py.File(folder / "snapshots" / f"{k:06d}.h5", "w") as file:
            file.attrs["time"] = 0.5 * k
            file["fluid/x"], file["fluid/v"] = x, np.tile([0.0, 0.0, 0.1 * (k + 1)], (3, 1))
            file["grains/x"] = np.array([[1e-3, 1.2e-3, 2e-3], [1e-3, 0.1e-3, 2e-3]])
            file["grains/diameter"] = np.array([1e-3, 1e-3])
    (folder / "snapshots" / "diverged.h5").write_bytes(b"")
    return folder


def test_film_has_a_frame_per_snapshot(result, tmp_path):
    assert command_line.main(["film", str(result), "-o", str(tmp_path / "film.gif")]) == 0
    assert Image.open(tmp_path / "film.gif").n_frames == 2


def test_only_what_the_slab_holds_is_drawn(result):
    read = film.result_in(result)
    assert film.greatest_speed(read) == pytest.approx(0.2)
    (_, axes) = film.sequence(read, [0, 1]).axes
    assert axes.get_title() == "0.50 s"
    grains, arrows = sorted(axes.collections, key=lambda c: c.get_zorder())
    assert np.allclose(arrows.get_offsets(), [[0.5, 1.0], [1.5, 3.0]])
    assert np.allclose(grains.get_offsets(), [[1.0, 2.0]])


def test_what_is_no_result_is_refused(tmp_path):
    with pytest.raises(CaseError, match="no run.json"):
        film.result_in(tmp_path)
    (tmp_path / "run.json").write_text(json.dumps({"scene": SCENE}))
    with pytest.raises(CaseError, match="no snapshots"):
        film.result_in(tmp_path)
