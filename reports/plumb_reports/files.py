"""Files written aside and renamed, so that a reader or a second judge never sees half of one."""

import contextlib
import fcntl
import json
import os
import tempfile
from pathlib import Path


def replace_file(path, content):
    """Writes `content` (str or bytes) to `path` in one step: whoever opens it sees the old or the new file."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    data = content.encode("utf-8") if isinstance(content, str) else content
    handle, aside = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        os.chmod(aside, 0o644)  # mkstemp makes files private
        os.replace(aside, path)
    except BaseException:
        os.unlink(aside)
        raise


def replace_json(path, value):
    """Writes `value` as JSON; refuses nan and inf, which JSON does not know."""
    replace_file(path, json.dumps(value, indent=2, allow_nan=False, ensure_ascii=False) + "\n")


@contextlib.contextmanager
def locked(folder):
    """Holds the lock of `folder` while the block runs; judges of other cases wait."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    with open(Path(folder) / ".lock", "w", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield  # closing the file releases the lock
