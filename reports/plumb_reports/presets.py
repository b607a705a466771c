"""Presets: named sets of models that a variant takes over, from the file presets.toml beside the case folders."""

from .strict import CaseError, toml_table

FILE = "presets.toml"


def preset_overrides(entry, folder):
    """Scene overrides of the preset that a [[variant]] names, {} if it names none: the scene's [fluid] with the preset's keys in
    place of every key that any preset has. Raises CaseError for an unknown preset or a scene without [fluid]."""
    name = entry.text("preset", None)
    if name is None:
        return {}
    presets = read_presets(folder.parent / FILE)
    if name not in presets:
        raise entry.error("preset", f"is {name!r}; known are {', '.join(presets)}")
    fluid = toml_table(folder / "scene.toml").value("fluid", None)
    if not isinstance(fluid, dict):
        raise entry.error("preset", "needs a scene with a [fluid] table")
    owned = {key for preset in presets.values() for key in preset}
    kept = {key: value for key, value in fluid.items() if key not in owned}
    return {"fluid": without_idle_scale(kept | presets[name])}


def without_idle_scale(fluid):
    """`fluid` less its reference_velocity where neither shifting nor an automatic sound speed uses it: an idle key is an error."""
    used = "shifting" in fluid or fluid.get("sound_speed") == "auto"
    return {key: value for key, value in fluid.items() if used or key != "reference_velocity"}


def read_presets(file):
    """{name: {key of [fluid]: value}}."""
    if not file.is_file():
        raise CaseError(f"{file}: is missing; a variant names a preset")
    table = toml_table(file)
    return {name: table.dictionary(name) for name in table.values}
