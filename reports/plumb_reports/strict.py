"""A strict view of a TOML table: every key must be known, present, of the right type, and read."""

import fnmatch
import math
import re
import tomllib

REQUIRED = object()
NAME_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.+-]*\Z")  # names become folder names, so no spaces or slashes


class CaseError(Exception):
    """Bad input of the judge: one line that names the file and the key. Ends the judge with exit code 2."""


class Table:
    """One TOML table. Readers return a value and mark its key as read; `finish` reports the keys nobody read."""

    def __init__(self, values, file, where=""):
        self.values = values
        self.file = file
        self.where = where
        self.read = set()

    def error(self, key, problem):
        """CaseError with file, table, key and problem in one line."""
        place = f"{self.where}: " if self.where else ""
        return CaseError(f"{self.file}: {place}key '{key}' {problem}")

    def value(self, key, default=REQUIRED):
        """The raw value of `key`, or `default`; raises CaseError when a required key is missing."""
        self.read.add(key)
        if key in self.values:
            return self.values[key]
        if default is REQUIRED:
            raise self.error(key, "is missing")
        return default

    def text(self, key, default=REQUIRED, choices=None):
        """A non-empty string, one of `choices` when given."""
        value = self.value(key, default)
        if value is default:
            return value
        if not isinstance(value, str) or not value.strip():
            raise self.error(key, f"must be a non-empty string, not {value!r}")
        if choices is not None and value not in choices:
            raise self.error(key, f"is {value!r}; allowed are {', '.join(choices)}")
        return value

    def name(self, key):
        """A string that may also serve as the name of a folder."""
        value = self.text(key)
        if not NAME_PATTERN.match(value):
            raise self.error(key, f"is {value!r}; a name consists of letters, digits and _ . + - only")
        return value

    def names(self, key):
        """One name, or a list of different ones, as a tuple."""
        value = self.value(key)
        found = value if isinstance(value, list) else [value]
        for name in found:
            if not isinstance(name, str) or not NAME_PATTERN.match(name):
                raise self.error(key, f"has {name!r}; a name consists of letters, digits and _ . + - only")
        if not found or len(set(found)) < len(found):
            raise self.error(key, "must be a name, or a list of different ones")
        return tuple(found)

    def number(self, key, default=REQUIRED):
        """A finite number."""
        value = self.value(key, default)
        if value is not default and not is_number(value):
            raise self.error(key, f"must be a finite number, not {value!r}")
        return value

    def integer(self, key, default=REQUIRED, lowest=0, highest=2**31):
        """A whole number in [lowest, highest]."""
        value = self.value(key, default)
        if value is default:
            return value
        if isinstance(value, bool) or not isinstance(value, int) or not lowest <= value <= highest:
            raise self.error(key, f"must be a whole number from {lowest} to {highest}, not {value!r}")
        return value

    def flag(self, key, default):
        """true or false."""
        value = self.value(key, default)
        if not isinstance(value, bool):
            raise self.error(key, f"must be true or false, not {value!r}")
        return value

    def numbers(self, key, default=REQUIRED, count=None):
        """A list of finite numbers, of `count` entries when given."""
        values = self.value(key, default)
        if values is default:
            return values
        if not isinstance(values, list) or not values or not all(is_number(v) for v in values):
            raise self.error(key, f"must be a list of finite numbers, not {values!r}")
        if count is not None and len(values) != count:
            raise self.error(key, f"must have {count} entries, not {len(values)}")
        return values

    def interval(self, key, default=REQUIRED):
        """A pair (lower, upper) with lower < upper."""
        values = self.numbers(key, default, count=2)
        if values is default:
            return values
        if not values[0] < values[1]:
            raise self.error(key, f"must be [lower, upper] with lower < upper, not {values!r}")
        return tuple(values)

    def texts(self, key, default=REQUIRED, choices=()):
        """A non-empty list of different strings, each one of `choices`."""
        values = self.value(key, default)
        if values is default:
            return values
        if not isinstance(values, list) or not values or len(set(map(str, values))) != len(values):
            raise self.error(key, f"must be a list of different names, not {values!r}")
        for value in values:
            if value not in choices:
                raise self.error(key, f"names {value!r}; known are {', '.join(choices)}")
        return tuple(values)

    def matching(self, key, known):
        """Those of `known` that a name, or a list of names, stands for, each once and in the order named. A name may have the
        wildcards of a shell (* ? [abc]); one that matches nothing is an error."""
        value = self.value(key)
        found = {}
        for name in value if isinstance(value, list) and value else [value]:
            matches = [one for one in known if fnmatch.fnmatchcase(one, name)] if isinstance(name, str) else []
            if not matches:
                raise self.error(key, f"names {name!r}; known are {', '.join(known) or 'none'}")
            found.update(dict.fromkeys(matches))
        return tuple(found)

    def dictionary(self, key, default=REQUIRED):
        """A non-empty table whose keys are free (overrides of the scene)."""
        value = self.value(key, default)
        if value is default:
            return value
        if not isinstance(value, dict) or not value:
            raise self.error(key, f"must be a non-empty table, not {value!r}")
        return value

    def table(self, key, where):
        """The sub-table `key`, or None when it is absent."""
        value = self.value(key, None)
        if value is None:
            return None
        if not isinstance(value, dict):
            raise self.error(key, f"must be a table, not {value!r}")
        return Table(value, self.file, where)

    def tables(self, key):
        """The array of tables [[key]], possibly empty."""
        values = self.value(key, [])
        if not isinstance(values, list) or not all(isinstance(v, dict) for v in values):
            raise self.error(key, f"must be an array of tables, [[{key}]]")
        return [Table(v, self.file, f"[[{key}]] number {i + 1}") for i, v in enumerate(values)]

    def finish(self):
        """Raises CaseError when the table holds a key that nobody has read."""
        unknown = [key for key in self.values if key not in self.read]
        if unknown:
            raise self.error(unknown[0], f"is unknown; known are {', '.join(sorted(self.read))}")


def is_number(value):
    """True for a finite int or float (bool is not a number in TOML)."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def toml_table(path):
    """The Table of a TOML file; raises CaseError when the file cannot be read as TOML."""
    try:
        with open(path, "rb") as file:
            return Table(tomllib.load(file), path)
    except OSError as error:
        raise CaseError(f"{path}: cannot be read: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise CaseError(f"{path}: is not TOML: {error}") from error


def toml_value(value):
    """`value` written as a TOML value, as --set takes it; floats keep every bit."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\t", "\\t")
        return f'"{escaped}"'
    if isinstance(value, list):
        return "[" + ", ".join(toml_value(v) for v in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{toml_key(k)} = {toml_value(v)}" for k, v in value.items()) + "}"
    raise TypeError(f"no TOML form for {type(value).__name__}")


def toml_key(key):
    """`key` written as a TOML key: bare where that is allowed, quoted otherwise."""
    return key if re.match(r"[A-Za-z0-9_-]+\Z", key) else toml_value(key)
