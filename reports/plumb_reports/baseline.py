"""The accepted baseline: what a case last agreed to be. Shown as drift; never part of a verdict."""

import json
from pathlib import Path

from .files import replace_json
from .strict import CaseError
from .verdicts import FAIL

BASELINE_FOLDER = Path(__file__).resolve().parents[1] / "baseline"


def baseline_file(case, tier):
    """Where the baseline of a case and tier is kept."""
    return BASELINE_FOLDER / f"{case}.{tier}.json"


def drift(report):
    """{"reason", "commit", "rows": [...]} of a report against its baseline, or None without one.

    A row: id, variant, accepted and current value and order, relative change of the value (None from or to nothing).
    """
    path = baseline_file(report["case"], report["tier"])
    if not path.is_file():
        return None
    baseline = json.loads(path.read_text(encoding="utf-8"))
    accepted = {(row["id"], row["variant"]): row for row in baseline["checks"]}
    rows = []
    for check in report["checks"]:
        old = accepted.get((check["id"], check["variant"]))
        before, now = old["value"] if old else None, check["value"]
        change = (now - before) / abs(before) if before and now is not None else None
        rows.append({"id": check["id"], "variant": check["variant"], "accepted": before, "value": now,
                     "accepted_order": old["order"] if old else None, "order": check["order"], "change": change})
    return {"reason": baseline["reason"], "commit": baseline["commit"], "rows": rows}


def accept(build, case, tier, reason):
    """Makes the current report the baseline; returns the file. Raises CaseError when there is nothing acceptable."""
    path = Path(build) / "reports" / case / tier / "report.json"
    if not path.is_file():
        raise CaseError(f"{path}: is missing; judge the case first")
    report = json.loads(path.read_text(encoding="utf-8"))
    if not reason.strip():
        raise CaseError("--reason: must say why the new numbers are right")
    if report["verdict"] == FAIL:
        raise CaseError(f"{path}: has a failing check; a baseline is made of accepted results only")
    origin = report["provenance"]
    content = {"case": case, "tier": tier, "reason": reason, "commit": origin["commit"], "dirty": origin["dirty"],
               "checks": [{key: check[key] for key in ("id", "variant", "value", "error_bar", "order")}
                          for check in report["checks"]]}
    target = baseline_file(case, tier)
    replace_json(target, content)
    return target
