"""reference.py of a case: what is measured in a run, and what is expected."""

import traceback
import types
from dataclasses import replace

import numpy as np

from .metrics import TIME_AXIS, Comparison, NotComparable
from .strict import CaseError


class Reference:
    """The loaded reference.py. Never imports the solver and never reads its source; it sees runs only through Run."""

    def __init__(self, folder):
        self.file = folder / "reference.py"
        self.module = loaded_module(self.file)
        if not callable(getattr(self.module, "reference", None)):
            raise CaseError(f"{self.file}: function 'reference(quantity, scene, t)' is missing")

    def function(self, name):
        """The optional function `name` of reference.py, or None."""
        return getattr(self.module, name, None)

    def comparison(self, check, run):
        """The Comparison of one check with one run; raises NotComparable."""
        t, values, is_series = self.measured(check.quantity, run)
        data = Comparison(t.astype(float), columns(values, len(t)), units=self.units(check.quantity, run),
                          is_series=is_series, axis=self.axis(check.quantity, t))
        if check.metric == "value":
            return data
        expected, uncertainty = self.expected(check.quantity, run.scene, t)
        shape = data.measured.shape
        return replace(data, expected=spread(expected, shape, "reference"),
                       uncertainty=None if uncertainty is None else spread(uncertainty, shape, "uncertainty"))

    def measured(self, quantity, run):
        """(t [nt], values, is_series): from the bisection, else measure() of reference.py, else the probe of that name."""
        result = run.derived(quantity)
        if result is NotImplemented and self.function("measure"):
            result = self.call("measure", quantity, run)
        if result is NotImplemented:
            result = run.series(quantity)
        is_series = isinstance(result, tuple)
        try:
            t, values = result if is_series else (run.scene["time"]["end"], float(result))
            return np.atleast_1d(t), np.atleast_1d(np.asarray(values, dtype=float)), is_series
        except (TypeError, ValueError) as error:
            raise NotComparable(f"measure('{quantity}') returned neither a number nor (t, values): {error}") from error

    def expected(self, quantity, scene, t):
        """(expected values, their standard uncertainty or None)."""
        result = self.call("reference", quantity, scene, t)
        if isinstance(result, dict):
            if set(result) - {"value", "uncertainty"} or "value" not in result:
                raise CaseError(f"{self.file}: reference('{quantity}') must return value and, if known, uncertainty")
            return result["value"], result.get("uncertainty")
        return result, None

    def units(self, quantity, run):
        """Units of a quantity: from UNITS of reference.py, else those of the probe of that name."""
        units = getattr(self.module, "UNITS", {})
        if quantity in units:
            return units[quantity]
        try:
            return run.units(quantity)
        except NotComparable:  # a derived quantity without stated units
            return ""

    def axis(self, quantity, t):
        """Label of a quantity's abscissa: from AXES of reference.py; whole numbers count something; else it is time."""
        axes = getattr(self.module, "AXES", {})
        return axes.get(quantity, "number" if np.issubdtype(t.dtype, np.integer) else TIME_AXIS)

    def call(self, name, *arguments):
        """The result of a function of reference.py. An exception in it fails the check, with its trace on stderr."""
        try:
            return self.function(name)(*arguments)
        except NotComparable:
            raise
        except Exception as error:  # whatever the author's code raises
            traceback.print_exc()
            raise NotComparable(f"reference.py: {name}() raised {type(error).__name__}: {error}") from error


def loaded_module(path):
    """The module of a Python file, loaded afresh and without leaving a __pycache__ in the case folder."""
    module = types.ModuleType(f"reference_of_{path.parent.name}")
    module.__file__ = str(path)
    try:
        exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), module.__dict__)
    except Exception as error:  # whatever the author's code raises
        traceback.print_exc()
        raise CaseError(f"{path}: cannot be loaded: {type(error).__name__}: {error}") from error
    return module


def columns(values, count):
    """`values` as [nt, n] with nt = count; raises NotComparable when the number of rows is another one."""
    values = values[:, None] if values.ndim == 1 else values
    if values.ndim != 2 or values.shape[0] != count:
        raise NotComparable(f"measured values of shape {values.shape} for {count} times")
    return values


def spread(values, shape, name):
    """A reference of shape (), [nt], [nt, 1], [1, n] or [nt, n] spread over `shape` = [nt, n]; else NotComparable."""
    values = np.asarray(values, dtype=float)
    given = values.shape
    if values.ndim == 1 and given == (shape[0],):
        values = values[:, None]
    if values.ndim == 1 and given != (1,) or values.ndim > 2:
        raise NotComparable(f"{name} of shape {given} for measured values of shape {shape}")
    try:
        return np.broadcast_to(values, shape)
    except ValueError as error:
        raise NotComparable(f"{name} of shape {given} for measured values of shape {shape}") from error
