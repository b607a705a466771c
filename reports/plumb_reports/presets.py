"""Presets: named sets of models that a variant takes over, from the file presets.toml beside the case folders."""

from .strict import CaseError, toml_table

FILE = "presets.toml"


ELSEWHERE = ("coupling", "time")  # tables of a preset that belong to these of the scene, and to coupled scenes only


def preset_overrides(entry, folder):
    """Scene overrides of the preset that a [[variant]] names, {} if it names none: the scene's [fluid], and of a scene with
    [coupling] that table and [time], with the preset's keys in place of every key that any preset has there. A table that the
    preset does not have stays as it is. Raises CaseError for an unknown preset or a scene without [fluid]."""
    name = entry.text("preset", None)
    if name is None:
        return {}
    presets = read_presets(folder.parent / FILE)
    if name not in presets:
        raise entry.error("preset", f"is {name!r}; known are {', '.join(presets)}")
    scene = toml_table(folder / "scene.toml")
    if not isinstance(scene.value("fluid", None), dict):
        raise entry.error("preset", "needs a scene with a [fluid] table")
    overrides = {"fluid": without_idle_scale(with_keys(scene, "fluid", fluid_keys(presets[name]), map(fluid_keys, presets.values())))}
    for table in ELSEWHERE:
        if "coupling" in scene.values and table in presets[name]:
            known = [preset.get(table, {}) for preset in presets.values()]
            overrides[table] = with_keys(scene, table, presets[name][table], known)
    return overrides


def with_keys(scene, table, keys, known):
    """A table of the scene with `keys` in place of all that any of the `known` sets has."""
    owned = {key for one in known for key in one}
    return {key: value for key, value in scene.value(table).items() if key not in owned} | keys


def fluid_keys(preset):
    """The keys of a preset that belong to [fluid]."""
    return {key: value for key, value in preset.items() if key not in ELSEWHERE}


def without_idle_scale(fluid):
    """`fluid` less its reference_velocity where neither shifting nor an automatic sound speed uses it: an idle key is an error."""
    used = "shifting" in fluid or fluid.get("sound_speed") == "auto"
    return {key: value for key, value in fluid.items() if used or key != "reference_velocity"}


def read_presets(file):
    """{name: {key of [fluid], or a table of ELSEWHERE: value}}."""
    if not file.is_file():
        raise CaseError(f"{file}: is missing; a variant names a preset")
    table = toml_table(file)
    return {name: table.dictionary(name) for name in table.values}
