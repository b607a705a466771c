"""history.jsonl: one line per check and commit; judging the same state again replaces its lines."""

import json

from .files import locked, replace_file

STATE = ("commit", "dirty", "case", "tier")  # judging one of these again replaces its lines


def history_lines(report):
    """The lines that a report adds to the history, as dicts."""
    origin = report["provenance"]
    return [{"commit": origin["commit"], "dirty": origin["dirty"], "time": origin["judged"], "case": report["case"],
             "tier": report["tier"], "id": check["id"], "variant": check["variant"],
             "twin": i + 1 if report["tier"] == "must_fail" else None,
             "value": check["value"], "error_bar": check["error_bar"], "order": check["order"],
             "verdict": check["verdict"], "cpu_s": report["cost"]["cpu_s"]}
            for i, check in enumerate(report["checks"])]


def extend_history(folder, report):
    """Writes the lines of `report` into <folder>/history.jsonl in place of older ones of the same case, tier, state."""
    path = folder / "history.jsonl"
    fresh = history_lines(report)
    states = {tuple(line[key] for key in STATE) for line in fresh}
    with locked(folder):
        kept = [line for line in read_history(path) if tuple(line[key] for key in STATE) not in states]
        replace_file(path, "".join(json.dumps(line) + "\n" for line in kept + fresh))


def read_history(path):
    """The lines of a history file as dicts; none when there is no file."""
    if not path.is_file():
        return []
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]
