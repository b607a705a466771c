"""The judge of plumb: runs a case, measures errors, orders and cost, and says pass, fail or not_met and why.

Reading order: case_file (what a case asks), plan and runner (which runs are made), results (what a run left behind),
reference_file (what is compared with what), metrics, sampling and orders (how far apart), verdicts (is that good
enough), judge and twins (one check, one twin), outcome (one case and tier), report and pages (what people read).
"""
