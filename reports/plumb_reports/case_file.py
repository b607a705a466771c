"""case.toml read strictly into plain data. The keys are explained in reports/README.md."""

from dataclasses import dataclass, field
from pathlib import Path

from .bisection_file import WorkPrecision, read_bisections, read_work_precision
from .metrics import ENSEMBLE, METRICS
from .presets import preset_overrides
from .strict import NAME_PATTERN, CaseError, is_number, toml_table

TIERS = ("quick", "full", "campaign")
REFERENCES = ("analytic", "manufactured", "measured", "published")
FIGURE_KINDS = ("time", "sweep")
AXIS_SCALES = ("linear", "log")
CASE_FILES = ("scene.toml", "case.toml", "reference.py", "README.md")
FEWEST_FOR_ORDER = 3  # two points fit every slope and leave no residual


@dataclass(frozen=True)
class Variant:
    """A named set of scene overrides; `swept` is False for a variant that runs once, without the sweep, and `values` says how many
    of the sweep's values it runs at most (None: all)."""
    name: str
    overrides: dict = field(default_factory=dict)
    swept: bool = True
    values: int = None


@dataclass(frozen=True)
class Sweep:
    """Values of one scene key, coarse to fine."""
    parameter: str
    values: tuple
    quick: int
    campaign: tuple = ()

    def values_of(self, tier):
        """The values that `tier` runs, coarse to fine."""
        return {"quick": self.values[:self.quick], "full": self.values, "campaign": self.values + self.campaign}[tier]


@dataclass(frozen=True)
class NotMet:
    """A bound the project aims at and does not reach yet: why we believe so, and the value accepted until then."""
    evidence: str
    accepted: float


@dataclass(frozen=True)
class Check:
    """One promise of a case: a quantity, how its error is measured, and what is demanded."""
    id: str
    quantity: str
    metric: str
    why: str
    reference: str
    variants: tuple
    tiers: tuple
    finest: dict
    range: tuple = None
    order: tuple = None
    window: tuple = None
    not_met: NotMet = None

    def bound(self, tier):
        """Upper bound of the error at the finest value of `tier`, or None."""
        return self.finest.get("quick" if tier == "quick" else "full")

    @property
    def twin_tier(self):
        """The tier whose runs and bound a must_fail twin of this check uses: the cheapest that judges it."""
        return min(self.tiers, key=TIERS.index)


@dataclass(frozen=True)
class MustFail:
    """Broken physics that has to break the check `breaks` of one variant."""
    breaks: str
    variant: str
    overrides: dict
    value: float = None
    planted: str = None


@dataclass(frozen=True)
class Figure:
    """A figure beyond those that the checks bring about."""
    quantity: str
    kind: str
    x: str


@dataclass(frozen=True)
class Case:
    """A whole case folder, ready to be run."""
    name: str
    folder: Path
    summary: str
    source: str
    reference: str
    areas: tuple
    variants: tuple
    sweep: Sweep
    checks: tuple
    must_fail: tuple
    figures: tuple
    bisections: tuple = ()
    work_precision: WorkPrecision = None

    def variant(self, name):
        """The variant called `name`."""
        return next(v for v in self.variants if v.name == name)

    def check(self, name):
        """The check with this id."""
        return next(c for c in self.checks if c.id == name)

    def bisection_of(self, variant):
        """The bisection that varies `variant`, or None."""
        return next((b for b in self.bisections if variant.name in b.variants), None)

    def runs_in(self, variant, tier):
        """Whether `tier` judges `variant`; one that no check names is only shown, in every tier."""
        judging = [check for check in self.checks if variant.name in check.variants]
        return not judging or any(tier in check.tiers for check in judging)

    def values_of(self, variant, tier):
        """Sweep values that `variant` runs in `tier`; (None,) without a sweep."""
        return self.sweep.values_of(tier)[:variant.values] if self.sweep and variant.swept else (None,)


def read_case(folder):
    """The Case in `folder`. Raises CaseError naming file and key for anything missing, unknown or out of range."""
    folder = Path(folder).resolve()
    for name in CASE_FILES:
        if not (folder / name).is_file():
            raise CaseError(f"{folder / name}: is missing; a case has {', '.join(CASE_FILES)}")
    table = toml_table(folder / "case.toml")
    summary, source, areas = table.text("summary"), table.text("source"), table.names("area")
    reference = table.text("reference", choices=REFERENCES)
    sweep = read_sweep(table.table("sweep", "[sweep]"))
    variants = read_variants(table, sweep, folder)
    checks = read_checks(table, reference, variants, sweep)
    bisections = read_bisections(table, variants, sweep)
    case = Case(folder.name, folder, summary, source, reference, areas, variants, sweep, checks,
                read_must_fail(table, checks, variants, sweep), read_figures(table), bisections,
                read_work_precision(table, checks, variants, bisections))
    table.finish()
    return case


def read_sweep(table):
    """The Sweep of [sweep], or None."""
    if table is None:
        return None
    parameter, values = table.text("parameter"), tuple(table.numbers("values"))
    quick = table.integer("quick", len(values), lowest=1, highest=len(values))
    campaign = tuple(table.numbers("campaign", []))
    table.finish()
    steps = [b - a for a, b in zip(values + campaign, (values + campaign)[1:])]
    if not (all(s > 0 for s in steps) or all(s < 0 for s in steps)):
        raise table.error("values", "must run from coarse to fine without repetition, `campaign` continuing it")
    return Sweep(parameter, values, quick, campaign)


def read_variants(table, sweep, folder):
    """The variants; a single one called "default" when the case names none."""
    variants = []
    for entry in table.tables("variant"):
        most = len(sweep.values) if sweep else 0
        bases = read_bases(entry, variants)
        own = {**preset_overrides(entry, folder), **entry.dictionary("set", {})}
        swept, values = entry.flag("sweep", True), entry.integer("values", None, lowest=1, highest=most)
        entry.finish()
        if values and not swept:
            raise entry.error("values", "is given, but the variant is not swept")
        for name, overrides in bases.items():
            variant = Variant(name, {**overrides, **own}, swept, values)
            if any(v.name == name for v in variants):
                raise entry.error("name", f"{name!r} is used twice")
            if sweep and swept and sweep.parameter in variant.overrides:
                raise entry.error("set", f"sets the sweep parameter {sweep.parameter}; say sweep = false as well")
            variants.append(variant)
    return tuple(variants) or (Variant("default"),)


def read_bases(entry, variants):
    """{name: scene overrides of its base} of the variants that a [[variant]] stands for: itself, or with a * in its name one for
    each of the earlier variants that `base` names, whose names take the place of the *."""
    known = {variant.name: variant.overrides for variant in variants}
    stem = entry.text("name")
    bases = entry.matching("base", known) if "base" in entry.values else ()
    if "*" not in stem:
        name = entry.name("name")
        entry.where = f"[[variant]] '{name}'"
        if len(bases) > 1:
            raise entry.error("name", "has no * to stand for its bases, which are several")
        return {name: known[bases[0]] if bases else {}}
    entry.where = f"[[variant]] '{stem}'"
    if stem.count("*") > 1 or not NAME_PATTERN.match(stem.replace("*", "x")):
        raise entry.error("name", "has one * in what is a name otherwise")
    if not bases:
        raise entry.error("base", "is missing; it says what the * stands for")
    return {stem.replace("*", base): known[base] for base in bases}


def read_checks(table, reference, variants, sweep):
    """The checks; at least one, with different ids."""
    checks = []
    for entry in table.tables("check"):
        check = read_check(entry, reference, variants)
        refuse_idle_check(entry, check)
        refuse_impossible_ensemble(entry, check, variants, sweep)
        refuse_impossible_order(entry, check, variants, sweep)
        if any(c.id == check.id for c in checks):
            raise entry.error("id", f"{check.id!r} is used twice")
        checks.append(check)
    if not checks:
        raise table.error("check", "is missing; a case promises at least one thing")
    return tuple(checks)


def read_check(entry, reference, variants):
    """One Check from its table."""
    identity = entry.name("id")
    entry.where = f"[[check]] '{identity}'"
    bounds = {tier: entry.number(f"finest_{tier}", None) for tier in ("quick", "full")}
    finest = {tier: bound for tier, bound in bounds.items() if bound is not None}
    value_range, order = entry.interval("range", None), entry.interval("order", None)
    judged = [t for t in TIERS if value_range or order or ("quick" if t == "quick" else "full") in finest]
    check = Check(
        id=identity, quantity=entry.text("quantity"), metric=entry.text("metric", choices=METRICS),
        why=entry.text("why"), reference=entry.text("reference", reference, choices=REFERENCES),
        variants=entry.matching("variants", [v.name for v in variants]) if "variants" in entry.values else tuple(v.name for v in variants),
        tiers=entry.texts("tiers", tuple(judged), choices=TIERS), finest=finest, range=value_range, order=order,
        window=entry.interval("window", None), not_met=read_not_met(entry))
    entry.finish()
    for tier in check.tiers:
        if tier not in judged:
            raise entry.error("tiers", f"names {tier!r}, for which the check has neither bound, range nor order")
    return check


def read_not_met(entry):
    """The NotMet mark of a check, or None."""
    mark = entry.table("not_met", f"{entry.where} not_met")
    if mark is None:
        return None
    not_met = NotMet(mark.text("evidence"), mark.number("accepted"))
    mark.finish()
    return not_met


def refuse_idle_check(entry, check):
    """Raises CaseError when a check demands nothing, or things that contradict each other."""
    if not check.tiers:
        raise entry.error("finest_quick", "is missing; a check has finest_quick, finest_full, range or order")
    for tier, bound in check.finest.items():
        if bound < 0:
            raise entry.error(f"finest_{tier}", f"must not be negative, but is {bound!r}")
    if (check.metric == "value") != (check.range is not None):
        raise entry.error("range", "and the metric \"value\" belong together: each needs the other")
    if check.metric == "value" and (check.finest or check.order):
        raise entry.error("range", "judges the value itself; errors and orders need a check of their own")
    if check.metric == "mean_relative" and check.window is None:
        raise entry.error("window", "is missing; an average is taken over a stated window")
    if check.not_met and check.order and check.finest:
        raise entry.error("not_met", "accepts one number; give the order a check of its own")


def refuse_impossible_ensemble(entry, check, variants, sweep):
    """Raises CaseError for an ensemble of one, or of swept variants."""
    if check.metric != ENSEMBLE:
        return
    if len(check.variants) < 2:
        raise entry.error("variants", "names fewer than two members of an ensemble")
    if sweep and any(v.swept for v in variants if v.name in check.variants):
        raise entry.error("variants", "names a swept variant; members of an ensemble have sweep = false")


def refuse_impossible_order(entry, check, variants, sweep):
    """Raises CaseError when an order is asked of too few sweep values."""
    if not check.order:
        return
    if sweep is None:
        raise entry.error("order", "needs a [sweep]")
    for variant in variants:
        if variant.name in check.variants and not variant.swept:
            raise entry.error("order", f"is asked of variant '{variant.name}', which has sweep = false")
        if variant.name in check.variants and variant.values and variant.values < FEWEST_FOR_ORDER:
            raise entry.error("order", f"is asked of variant '{variant.name}', which has values = {variant.values}")
    for tier in check.tiers:
        count = len(sweep.values_of(tier))
        if count < FEWEST_FOR_ORDER:
            raise entry.error("order", f"needs at least {FEWEST_FOR_ORDER} sweep values; tier '{tier}' has {count}")
    if min(sweep.values + sweep.campaign) <= 0:
        raise entry.error("order", "needs positive sweep values")


def read_must_fail(table, checks, variants, sweep):
    """The broken twins; at least one."""
    twins = []
    for entry in table.tables("must_fail"):
        breaks = entry.text("breaks", choices=[c.id for c in checks])
        entry.where = f"[[must_fail]] of '{breaks}'"
        check = next(c for c in checks if c.id == breaks)
        variant = entry.text("variant", check.variants[0], choices=check.variants)
        planted = entry.text("planted", None)
        overrides = entry.dictionary("set", {} if planted else None)
        if overrides is None:
            raise entry.error("set", "is missing; it says what is broken")
        twin = MustFail(breaks, variant, overrides, entry.value("value", None), planted)
        entry.finish()
        refuse_idle_value(entry, twin, check, variants, sweep)
        twins.append(twin)
    if not twins:
        raise table.error("must_fail", "is missing; every case shows at least once that it can fail")
    return tuple(twins)


def refuse_idle_value(entry, twin, check, variants, sweep):
    """Raises CaseError when the twin names a sweep value that cannot be used."""
    if twin.value is None:
        return
    if not is_number(twin.value):
        raise entry.error("value", f"must be a finite number, not {twin.value!r}")
    if sweep is None or not next(v for v in variants if v.name == twin.variant).swept:
        raise entry.error("value", "is given, but the variant is not swept")
    if check.bound(check.twin_tier) is None and not check.range:
        raise entry.error("value", "is given, but the check judges only an order there, which needs the whole sweep")


def read_figures(table):
    """The additional figures."""
    figures = []
    for entry in table.tables("figure"):
        figures.append(Figure(entry.text("quantity"), entry.text("kind", "time", choices=FIGURE_KINDS),
                              entry.text("x", "linear", choices=AXIS_SCALES)))
        entry.finish()
    return tuple(figures)
