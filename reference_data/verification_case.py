"""Loads reference.py of a verification case, for the tests of this folder and for cases that judge by another one's theory."""

import types
from functools import lru_cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


@lru_cache(maxsize=None)
def case(name):
    """The module <name>/reference.py of a case, executed as the judge does it (no __pycache__ in the folder)."""
    path = next(ROOT.glob(f"*/{name}/reference.py"))
    module = types.ModuleType(f"reference_of_{name}")
    module.__file__ = str(path)
    exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), module.__dict__)
    return module
