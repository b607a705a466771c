"""Shared by the judge's tests: copies of the fake case, in a folder whose path has spaces."""

import re
import shutil
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
sys.dont_write_bytecode = True

from plumb_reports import baseline  # noqa: E402

SOLVER = HERE / "fake_solver.py"


@pytest.fixture(autouse=True)
def no_baseline(tmp_path, monkeypatch):
    """Keeps the tests away from the accepted baselines of the project."""
    monkeypatch.setattr(baseline, "BASELINE_FOLDER", tmp_path / "accepted")


class FakeCase:
    """A case folder that a test may edit."""

    def __init__(self, folder):
        self.folder = folder

    def edit(self, file, pattern, replacement):
        """Replaces the first match of a regular expression in one of the case's files."""
        path = self.folder / file
        text, count = re.subn(pattern, lambda _: replacement, path.read_text(encoding="utf-8"), count=1,
                              flags=re.DOTALL | re.MULTILINE)
        assert count == 1, f"{pattern} not in {file}"
        path.write_text(text, encoding="utf-8")

    def append(self, file, text):
        """Adds text at the end of a file."""
        path = self.folder / file
        path.write_text(path.read_text(encoding="utf-8") + text, encoding="utf-8")


@pytest.fixture
def case(tmp_path):
    """A copy of the fake case."""
    folder = tmp_path / "with spaces" / "relaxation"
    shutil.copytree(HERE / "fake_case", folder)
    return FakeCase(folder)


@pytest.fixture
def build(tmp_path):
    """A build folder whose path has spaces."""
    return tmp_path / "a build"
