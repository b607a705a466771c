"""report.json: everything the pages show, as plain data. Keys are listed in reports/README.md."""

import time

from . import verdicts

SCHEMA_VERSION = 1
KIND = {"analytic": "theory", "manufactured": "theory", "measured": "measured", "published": "published"}
QUICK_BUDGET_S = 20.0  # CPU seconds a case may use in the quick tier (architecture: "A case and its verdict")
PROVENANCE = ("version", "commit", "dirty", "compiler", "flags", "threads", "processor")


def report(case, tier, runs, check_entries, problems):
    """The report of one case and tier as a dict ready for JSON."""
    words = [entry["verdict"] for entry in check_entries]
    return {
        "schema_version": SCHEMA_VERSION, "case": case.name, "tier": tier, "summary": case.summary,
        "source": case.source, "area": ", ".join(case.areas), "reference": case.reference,
        "verdict": verdicts.FAIL if problems else verdicts.worst(words), "counts": verdicts.counts(words),
        "problems": problems, "cost": total_cost(tier, runs), "runs": [run_entry(run) for run in runs],
        "checks": check_entries, "provenance": provenance(runs)}


def run_entry(run):
    """One run: what was varied, what it cost, how it ended."""
    return {"variant": run.variant, "parameter": run.parameter, "value": run.value, **run.cost(), "exit": run.exit,
            "failure": run.failure, "outcome": run.outcome, "overrides": run.overrides}


def check_entry(judgement):
    """One check of one variant in the tiers quick, full and campaign."""
    check, finest, fit = judgement.check, judgement.finest, judgement.fit
    return {
        "id": check.id, "variant": judgement.variant, "quantity": check.quantity, "metric": check.metric,
        "value": finest.value if finest else None, "error_bar": finest.error_bar if finest else None,
        "bound": list(judgement.bound) if check.range else judgement.bound,
        "order": fit.order if fit else None, "order_interval": [fit.lower, fit.upper] if fit else None,
        "order_bound": list(check.order) if check.order else None, "order_points": fit.used if fit else None,
        "plateau_points": fit.plateau if fit else None, "verdict": judgement.verdict.word,
        "reference": check.reference, "kind": KIND[check.reference], "why": check.why,
        "reason": judgement.verdict.reason, "judged": judgement.judged,
        "not_met": {"evidence": check.not_met.evidence, "accepted": check.not_met.accepted} if check.not_met else None,
        "deviation": finest.deviation if finest else None, "sigma": finest.sigma if finest else None,
        "component": finest.component if finest else None, "points": finest.points if finest else 0,
        "settled": finest.settled if finest else None, "window": list(check.window) if check.window else None,
        "units": judgement.comparisons[-1].units if judgement.comparisons else None,
        "sweep": [{"value": run.value, "error": m.value, "error_bar": m.error_bar}
                  for run, m in zip(judgement.runs, judgement.measurements)]}


def twin_entry(twin_judgement):
    """One must_fail twin, in the layout of a check."""
    twin = twin_judgement.twin
    entry = check_entry(twin_judgement.broken)
    entry.update(verdict=twin_judgement.verdict.word, reason=twin_judgement.verdict.reason,
                 broken_by=twin.overrides, planted=twin.planted, at=twin.value,
                 control=twin_judgement.control.verdict.reason if twin_judgement.control else None)
    return entry


def total_cost(tier, runs):
    """Sums over all runs, and whether the quick tier's budget holds."""
    sums = {key: sum(run.cost()[key] or 0.0 for run in runs) for key in ("wall_s", "cpu_s")}
    limit = QUICK_BUDGET_S if tier in ("quick", "must_fail") else None
    return {**sums, "cpu_limit_s": limit, "over_budget": limit is not None and sums["cpu_s"] > limit}


def provenance(runs):
    """Where the numbers come from, as the first usable run recorded it, and when they were judged."""
    info = next((run.info for run in runs if not run.failure), {})
    return {**{key: info.get(key) for key in PROVENANCE}, "scene_hash": info.get("scene_hash"),
            "judged": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())}

