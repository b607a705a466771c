"""Analytic reference values, each a few lines of theory; used by generate.py and by the cases' reference.py."""
