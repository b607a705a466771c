"""CPU seconds of runs that a case repeats for their cost: variants <name>, <name>_2, <name>_3, ..."""

import re
import statistics


def repeated(runs):
    """{variant without the number of its repetition: its runs}, in the order of the first ones."""
    found = {}
    for run in runs:
        found.setdefault(re.sub(r"_\d$", "", run.variant), []).append(run)
    return found


def cost(runs):
    """Median CPU seconds."""
    return statistics.median(run.info["cpu_s"] for run in runs)


def cheaper(published, runs):
    """Text: how often the cost of `runs` goes into that of the published scheme's, where there are any."""
    return f"{cost(published) / cost(runs):.1f}" if published else ""
