"""case.toml: what is read, and one clear line for each mistake."""

import subprocess
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from plumb_reports.__main__ import main
from plumb_reports.case_file import Variant, read_case
from plumb_reports.plan import tier_plans
from plumb_reports.strict import CaseError

CHECK = r'\[\[check\]\]\nid = "velocity".*?\n\n'


def test_the_fake_case(case):
    read = read_case(case.folder)
    assert read.name == "relaxation"
    assert [v.name for v in read.variants] == ["default"]
    assert read.sweep.values_of("quick") == (0.05, 0.025, 0.0125)
    assert len(read.sweep.values_of("full")) == 5
    velocity = read.check("velocity")
    assert velocity.order == (1.8, 2.2) and velocity.bound("quick") == 2e-3 and velocity.bound("campaign") == 1e-4
    assert read.check("mean").tiers == ("quick",)
    assert read.check("terminal").tiers == ("quick",)  # it has no bound for the full tier
    assert read.must_fail[1].value == 0.0125


def test_a_case_of_several_areas(case):
    case.edit("case.toml", 'area = "fake"', 'area = ["fake", "other"]   # "two"')
    assert read_case(case.folder).areas == ("fake", "other")


@pytest.mark.parametrize("line, areas", [('"fake"', ["fake"]), ('["fake", "other"]   # "two"', ["fake", "other"])])
def test_areas_are_labels_of_the_tests(case, tmp_path, line, areas):
    case.edit("case.toml", 'area = "fake"', f"area = {line}")
    module = Path(__file__).resolve().parents[1] / "cases.cmake"
    script = tmp_path / "areas.cmake"
    script.write_text(f'include("{module}")\nplumb_case_areas("{case.folder}/case.toml" found)\nmessage("areas=${{found}}")\n')
    run = subprocess.run(["cmake", "-P", str(script)], capture_output=True, text=True, check=True)
    assert f"areas={';'.join(areas)}" in run.stderr.splitlines()


def test_variants_and_campaign(case):
    case.edit("case.toml", "quick = 3", "quick = 3\ncampaign = [0.001]")
    case.append("case.toml", '[[variant]]\nname = "a"\nset = {"fake.tau" = 0.1}\n'
                '[[variant]]\nname = "b"\nset = {"time.step" = 0.01}\nsweep = false\n')
    case.edit("case.toml", 'why = "The trap', 'variants = ["a"]\nwhy = "The trap')
    read = read_case(case.folder)
    assert read.values_of(read.variant("a"), "campaign")[-1] == 0.001
    assert read.values_of(read.variant("b"), "full") == (None,)
    few = replace(read.variant("a"), values=2)
    assert read.values_of(few, "full") == read.values_of(few, "quick") == (0.05, 0.025)
    assert read.check("terminal").variants == ("a", "b")


def test_a_base_gives_its_overrides(case):
    case.append("case.toml", '[[variant]]\nname = "a"\nset = {"fake.tau" = 0.1, "fake.drift" = 0.01}\n'
                '[[variant]]\nname = "b"\nbase = "a"\nset = {"fake.drift" = 0.02}\n')
    assert read_case(case.folder).variant("b").overrides == {"fake.tau": 0.1, "fake.drift": 0.02}
    case.edit("case.toml", 'base = "a"', 'base = "c"')
    with pytest.raises(CaseError, match="'base' names 'c'; known are a"):
        read_case(case.folder)


def test_a_star_stands_for_every_base(case):
    case.append("case.toml", '[[variant]]\nname = "a1"\nset = {"fake.tau" = 0.1, "fake.drift" = 0.01}\n'
                '[[variant]]\nname = "a2"\nset = {"fake.tau" = 0.2}\n'
                '[[variant]]\nname = "fine_*"\nbase = ["a?"]\nset = {"fake.drift" = 0.02}\n')
    case.edit("case.toml", 'why = "The trap', 'variants = ["fine_*", "a1"]\nwhy = "The trap')
    read = read_case(case.folder)
    assert [v.name for v in read.variants] == ["a1", "a2", "fine_a1", "fine_a2"]
    assert read.variant("fine_a2").overrides == {"fake.tau": 0.2, "fake.drift": 0.02}
    assert read.check("velocity").variants == ("fine_a1", "fine_a2", "a1")


@pytest.mark.parametrize("name, base, problem", [
    ("fine", '["a", "b"]', "'name' has no \\* to stand for"), ("fine_*", None, "'base' is missing"), ("*_*", '"a"', "'name' has one \\*"),
    ("fine_*", '"c*"', "'base' names 'c\\*'"), ("fine_*", "3", "'base' names 3"), ("fine_*", "[]", "'base' names")])
def test_what_a_star_cannot_stand_for(case, name, base, problem):
    of = f"base = {base}\n" if base else ""
    case.append("case.toml", f'[[variant]]\nname = "a"\n[[variant]]\nname = "b"\n[[variant]]\nname = "{name}"\n{of}set = {{"fake.drift" = 0.02}}\n')
    with pytest.raises(CaseError, match=problem):
        read_case(case.folder)


def test_a_variant_that_only_another_tier_judges_is_not_run(case):
    read = read_case(case.folder)
    late = Variant("late", swept=False)
    shown = Variant("shown", swept=False)  # named by no check: run in every tier
    check = replace(read.check("velocity"), id="late", variants=("late",), tiers=("full",))
    read = replace(read, variants=(*read.variants, late, shown), checks=(*read.checks, check))
    assert {p.variant for p in tier_plans(read, "quick", Path("out"))} == {"default", "shown"}
    assert {p.variant for p in tier_plans(read, "full", Path("out"))} == {"default", "late", "shown"}


PRESETS = '[rough]\nkernel = "c2"\n[smooth]\nkernel = "c4"\nshifting = 4.0\n'


def with_preset(case, name):
    """The case with presets beside it and a variant that names one."""
    (case.folder.parent / "presets.toml").write_text(PRESETS)
    case.append("scene.toml", '\n[fluid]\nspacing = 0.1\nkernel = "c6"\nshifting = 1.0\nreference_velocity = 1.0\n')
    case.append("case.toml", f'[[variant]]\nname = "v"\npreset = "{name}"\nset = {{"fluid.density" = 2.0}}\n')


def test_a_preset_replaces_every_key_that_presets_have(case):
    with_preset(case, "rough")
    overrides = read_case(case.folder).variant("v").overrides
    assert overrides == {"fluid": {"spacing": 0.1, "kernel": "c2"}, "fluid.density": 2.0}  # no shifting, nor its scale
    assert list(overrides) == ["fluid", "fluid.density"]  # --set in this order


def test_a_preset_replaces_coupling_and_time_of_coupled_scenes_alone(case):
    with_preset(case, "rough")
    (case.folder.parent / "presets.toml").write_text(
        PRESETS + '[rough.coupling]\nexchange = "explicit"\n[rough.time]\nsafety = {acoustic = 1.2}\n[smooth.coupling]\nmass = "pure"\n')
    assert list(read_case(case.folder).variant("v").overrides) == ["fluid", "fluid.density"]
    time = tomllib.loads((case.folder / "scene.toml").read_text())["time"]
    case.append("scene.toml", '\n[coupling]\ndirection = "two_way"\nmass = "displaced"\nexchange = "implicit"\n')
    overrides = read_case(case.folder).variant("v").overrides
    assert overrides["fluid"] == {"spacing": 0.1, "kernel": "c2"}
    assert overrides["coupling"] == {"direction": "two_way", "exchange": "explicit"}
    assert overrides["time"] == {**time, "safety": {"acoustic": 1.2}}
    assert list(overrides)[-1] == "fluid.density"


def test_a_preset_without_a_table_leaves_the_scene_its_own(case):
    with_preset(case, "smooth")
    (case.folder.parent / "presets.toml").write_text(PRESETS + '[rough.time]\nsafety = {acoustic = 1.2}\n')
    case.append("scene.toml", '\n[coupling]\ndirection = "two_way"\n')
    assert list(read_case(case.folder).variant("v").overrides) == ["fluid", "fluid.density"]


def test_unknown_presets_are_refused(case):
    with_preset(case, "rouhg")
    with pytest.raises(CaseError, match="'preset' is 'rouhg'; known are rough, smooth"):
        read_case(case.folder)
    (case.folder.parent / "presets.toml").unlink()
    with pytest.raises(CaseError, match="presets.toml: is missing"):
        read_case(case.folder)


MISTAKES = [
    ('summary = ".*?"', "", "'summary' is missing"),
    ('summary = ".*?"', "summary = 3", "'summary' must be a non-empty string"),
    ('reference = "analytic"', 'reference = "guessed"', "'reference' is 'guessed'"),
    ('area = "fake"', 'area = "fake"\ncolour = "red"', "'colour' is unknown"),
    ('area = "fake"', "area = ", "is not TOML"),
    ('area = "fake"', 'area = ["fake", "fake"]', "'area' must be a name, or a list of different ones"),
    ('area = "fake"', "area = []", "'area' must be a name, or a list of different ones"),
    ('area = "fake"', 'area = ["a b"]', "'area' has 'a b'"),
    ("quick = 3", "quick = 9", "'quick' must be a whole number"),
    ("quick = 3", "quick = 2", "'order' needs at least 3 sweep values"),
    ("quick = 3", "quick = true", "'quick' must be a whole number"),
    ("quick = 3", "fine = 3", "'fine' is unknown"),
    (r"values = \[0.05, 0.025", "values = [0.05, 0.05", "'values' must run from coarse to fine"),
    (r"values = \[0.05", "values = [nan", "'values' must be a list of finite numbers"),
    (r"0.003125\]", "-1.0]", "'order' needs positive sweep values"),
    (r"\[sweep\].*?quick = 3", "", "'order' needs a [sweep]"),
    ('why = "The trap.*?"', "", "'why' is missing"),
    ('why = "The trap.*?"', 'why = " "', "'why' must be a non-empty string"),
    ('id = "terminal"', 'id = "velocity"', "'velocity' is used twice"),
    ('id = "terminal"', 'id = "a/b"', "'id' is 'a/b'"),
    ('metric = "relative_l2"', 'metric = "l2"', "'metric' is 'l2'"),
    ("finest_quick = 2e-3", "finest = 2e-3", "'finest' is unknown"),
    ("finest_quick = 2e-3", "finest_quick = inf", "'finest_quick' must be a finite number"),
    ("finest_quick = 2e-3", "finest_quick = -1", "'finest_quick' must not be negative"),
    ("finest_quick = 2.0", "", "'finest_quick' is missing"),
    (r"order = \[1.8, 2.2\]", "order = [2.2, 1.8]", "'order' must be [lower, upper]"),
    (r"order = \[1.8, 2.2\]", "order = [2.0]", "'order' must have 2 entries"),
    (r"range = \[1.9, 2.0\]", "finest_quick = 1.0", "the metric \"value\" belong together"),
    ('metric = "value"', 'metric = "final_relative"', "the metric \"value\" belong together"),
    (r'metric = "value"\nwindow = \[0.4, 0.5\]\nrange = \[1.9, 2.0\]',
     'metric = "mean_relative"\nfinest_quick = 1.0', "'window' is missing"),
    (r'tiers = \["quick"\]', 'tiers = ["quick", "nightly"]', "'tiers' names 'nightly'"),
    ("finest_quick = 2.0", 'finest_quick = 2.0\ntiers = ["full"]', "'tiers' names 'full'"),
    ("finest_quick = 2.0", 'finest_quick = 2.0\nvariants = ["other"]', "'variants' names 'other'"),
    ("finest_quick = 2.0", 'finest_quick = 2.0\nnot_met = {accepted = 3.0}', "'evidence' is missing"),
    ("finest_quick = 2e-3", 'finest_quick = 2e-3\nnot_met = {evidence = "e", accepted = 3.0}', "accepts one number"),
    (r"\[\[must_fail\]\].*", "", "'must_fail' is missing"),
    (r"\[\[check\]\].*", "", "'check' is missing"),
    ('breaks = "velocity"\nvalue', 'breaks = "speed"\nvalue', "'breaks' is 'speed'"),
    (r'set = \{"fake.gain" = 1.1\}', "", "'set' is missing"),
    (r'set = \{"fake.gain" = 1.1\}', "set = {}", "'set' must be a non-empty table"),
    ("value = 0.0125", "value = true", "'value' must be a finite number"),
    ("value = 0.0125", 'variant = "other"', "'variant' is 'other'"),
    (r"\[sweep\]", '[[variant]]\nname = "a"\nset = {"time.step" = 1.0}\n\n[sweep]', "sets the sweep parameter"),
    (r"\[sweep\]", '[[variant]]\nname = "a"\nset = {"fake.tau" = 1.0}\nsweep = false\n\n[sweep]', "has sweep = false"),
    (r"\[sweep\]", '[[variant]]\nname = "a"\nvalues = 9\n\n[sweep]', "'values' must be a whole number"),
    (r"\[sweep\]", '[[variant]]\nname = "a"\nvalues = 2\n\n[sweep]', "which has values = 2"),
    (r"\[sweep\]", '[[variant]]\nname = "a"\nvalues = 2\nsweep = false\n\n[sweep]', "the variant is not swept"),
    (r"\[sweep\]", "[[figure]]\nx = \"log\"\n\n[sweep]", "'quantity' is missing"),
    ('metric = "in_sigma"', 'metric = "ensemble_relative"', "names fewer than two members of an ensemble"),
    (r"\[sweep\]", "[[sweep]]", "'sweep' must be a table"),
]


@pytest.mark.parametrize("pattern, replacement, message", MISTAKES)
def test_mistakes(case, pattern, replacement, message):
    case.edit("case.toml", pattern, replacement)
    with pytest.raises(CaseError) as caught:
        read_case(case.folder)
    text = str(caught.value)
    assert message in text
    assert str(case.folder / "case.toml") in text
    assert "\n" not in text


@pytest.mark.parametrize("name", ["scene.toml", "case.toml", "reference.py", "README.md"])
def test_missing_files(case, name):
    (case.folder / name).unlink()
    with pytest.raises(CaseError, match="is missing"):
        read_case(case.folder)


def test_exit_code_and_line(case, build, capsys):
    case.edit("case.toml", 'why = "The trap.*?"', "")
    solver = case.folder.parents[2] / "none"
    arguments = ["judge", str(case.folder), "--tier", "quick", "--build", str(build), "--plumb"]
    assert main([*arguments, __file__.replace("test_case_file", "fake_solver")]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and "[[check]] 'velocity': key 'why' is missing" in error
    assert main([*arguments, str(solver)]) == 2
    assert "is not a program" in capsys.readouterr().err
    assert not build.exists()
