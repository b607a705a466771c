"""Tests of the reference tables: they can be regenerated, are documented column by column, and pass independent checks."""

import csv
import math
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT))

import generate  # noqa: E402
import tables  # noqa: E402
from drag_laws import drag_laws  # noqa: E402
from theory import cylinder_arrays, rayleigh_taylor, released_sphere, settling, water  # noqa: E402

CSV_FILES = sorted(path.relative_to(ROOT) for path in ROOT.glob("*/*.csv"))
KINDS = {"measured", "published", "analytic", "theory"}


@pytest.mark.parametrize("table", generate.TABLES, ids=lambda table: table.path)
def test_committed_table_is_what_the_theory_gives(table):
    assert generate.difference(table) is None


def test_check_mode_names_a_changed_digit(tmp_path, monkeypatch):
    table = next(table for table in generate.TABLES if "single_grain" in table.path)
    text = (ROOT / table.path).read_text(encoding="utf-8")
    (tmp_path / table.path).parent.mkdir()
    (tmp_path / table.path).write_text(text.replace("0.00089,", "0.000890000001,"), encoding="utf-8")
    monkeypatch.setattr(generate, "ROOT", tmp_path)
    assert "line 3, mu [Pa s]" in generate.difference(table)


@pytest.mark.parametrize("path", CSV_FILES, ids=str)
def test_every_column_has_a_unit_and_a_documented_uncertainty(path):
    source = tomllib.loads((ROOT / path.parent / "source.toml").read_text(encoding="utf-8"))
    assert source["citation"]
    entry = [table for table in source["table"] if table["file"] == path.name]
    assert len(entry) == 1, "one [[table]] in source.toml"
    assert entry[0]["kind"] in KINDS and entry[0]["place"]
    numeric = [name for name, unit in tables.header(path) if unit is not None]
    assert set(entry[0]["uncertainty"]) == set(numeric)
    assert all(len(column) > 0 for column in tables.table(path).values())


def test_units_are_converted():
    cell = tables.table("robinson_2014/dispersion_cell.csv")
    velocity = cell["flow"][0] / (math.pi * cell["inlet_radius"][0] ** 2)
    assert velocity == pytest.approx(cell["inlet_velocity"][0], rel=2e-3)  # 2.122 against the printed 2.12


# --- physics the tables must obey ---


def test_relaxation_times_agree_with_the_slides():
    printed = tables.table("robinson_2014/fluids.csv")
    computed = tables.table("settling_theory/single_grain.csv")
    assert printed["fluid"] == computed["fluid"]
    np.testing.assert_allclose(computed["tau_p"], printed["tau_p"], rtol=5e-3)  # printed to two or three digits


def test_reynolds_row_of_the_slides_is_the_plain_form():
    printed = tables.table("robinson_2014/fluids.csv")
    hindered = tables.table("settling_theory/hindered.csv")
    for index, fluid in enumerate(printed["fluid"]):
        re = {e: r for f, e, r in zip(hindered["fluid"], hindered["eps"], hindered["re_plain"]) if f == fluid}
        assert re[0.6] == pytest.approx(printed["re_least"][index], rel=0.2)  # 0.002 has one digit
        assert re[1.0] == pytest.approx(printed["re_greatest"][index], rel=0.02)


def test_settling_speed_tends_to_stokes_at_small_re():
    ar = 1e-9
    re = settling.hindered_re(ar, 1.0, 1)
    assert re == pytest.approx(ar / 18.0 / 0.96, rel=1e-3)  # Di Felice is 0.96 of Stokes there


def test_growth_rate_limits():
    # inviscid: n = sqrt(A g k); equal, very viscous fluids: n = (rho2 - rho1) g/(2 k (mu1 + mu2))
    inviscid = rayleigh_taylor.growth_rate(100.0, (1.0, 1e-12), (3.0, 1e-12))
    assert inviscid == pytest.approx(math.sqrt(0.5 * 9.81 * 100.0), rel=1e-4)
    creeping = rayleigh_taylor.growth_rate(100.0, (1.0, 50.0), (3.0, 50.0))
    assert creeping == pytest.approx(2.0 * 9.81 / (2.0 * 100.0 * 100.0), rel=1e-4)


def test_cylinder_force_against_printed_and_dilute_values():
    for c, printed in ((0.2, 51.53), (0.3, 102.9), (0.4, 217.9)):  # Sangani & Acrivos (1982), square
        assert cylinder_arrays.force(c, "square") == pytest.approx(printed, rel=2e-4)
    c = 1e-3  # dilute square array: 4 pi/(-ln(c)/2 - 0.738 + c)
    assert cylinder_arrays.force(c, "square") == pytest.approx(4 * math.pi / (-0.5 * math.log(c) - 0.738 + c), rel=1e-3)


def test_lubrication_limit_of_the_permeability():
    for array, densest in (("square", math.pi / 4), ("hexagonal", math.pi / (2 * math.sqrt(3)))):
        c = 0.86 * densest
        exact = cylinder_arrays.permeability_from_force(cylinder_arrays.force(c, array, order=32), c)
        assert cylinder_arrays.gebart(c, array) == pytest.approx(exact, rel=0.05)


def test_morsi_alexander_intervals_meet():
    rows = tables.table("morsi_alexander_1972/coefficients.csv")
    drag = lambda i, re: rows["a1"][i] + rows["a2"][i] / re + rows["a3"][i] / re**2  # noqa: E731
    for i in range(len(rows["re_to"]) - 1):
        re = rows["re_to"][i]
        assert rows["re_from"][i + 1] == re
        assert drag(i, re) == pytest.approx(drag(i + 1, re), rel=0.024)  # 2.4 % at 10^4, under 0.5 % elsewhere


def test_morsi_alexander_code_uses_the_table():
    rows = tables.table("morsi_alexander_1972/coefficients.csv")
    for i, (upper, *coefficients) in enumerate(drag_laws.MORSI_ALEXANDER):
        assert coefficients == [rows["a1"][i], rows["a2"][i], rows["a3"][i]]
        assert upper in (rows["re_to"][i], math.inf)


def test_correlation_of_the_mud_cake_paper_misses_its_own_table():
    data = tables.table("mudcake_ddpm_dem/bed_and_pressure.csv", si=False)
    fit = {name: column[0] for name, column in tables.table("mudcake_ddpm_dem/correlation.csv", si=False).items()}
    predicted = fit["constant"] + fit["per_obstacle"] * data["obstacles"] + fit["per_rate"] * data["rate"]
    predicted = predicted + fit["per_diameter"] * data["d"]
    residual = ((data["pressure"] - predicted) ** 2).sum() / ((data["pressure"] - data["pressure"].mean()) ** 2).sum()
    assert 1.0 - residual == pytest.approx(0.907, abs=5e-4) and fit["r_squared"] == 0.966
    assert np.abs(predicted / data["pressure"] - 1.0).max() == pytest.approx(0.243, abs=1e-3)


def test_errors_of_table_2_and_their_misprint():
    data = tables.table("mudcake_ddpm_dem/terminal_velocity.csv")
    measured, simulated, error = data["u_measured"], data["u_simulated"], data["error"]
    reachable = np.abs(measured - simulated) / measured
    slack = 0.00051 / measured  # half a unit of the last digit of the simulated speed
    assert list(np.abs(reachable - error) <= slack) == [True] * 5  # 0.0765 rounds to 0.076 only just
    assert error[0] == pytest.approx(0.0025 / 0.074, abs=1e-5)
    assert reachable[0] == pytest.approx(0.0270, abs=1e-4)


@pytest.mark.parametrize("path", ["u_on_vertical_line", "v_on_horizontal_line"])
def test_cavity_profiles_are_smooth_but_for_the_known_misprint(path):
    """Each value is near the cubic through its four neighbours; a swapped digit would stand out."""
    data = tables.table(f"ghia_1982/{path}.csv")
    s, *columns = data.values()
    rough = []
    for name, column in zip(list(data)[1:], columns):
        for i in range(2, len(s) - 2):
            if s[i - 2] - s[i + 2] > 0.1:
                continue  # too far apart to interpolate
            near = [i - 2, i - 1, i + 1, i + 2]
            guess = np.polyval(np.polyfit(s[near] - s[i], column[near], 3), 0.0)
            if abs(guess - column[i]) > 0.01:
                rough.append((name, float(s[i])))
    assert all(name == "v_re_400" for name, _ in rough) and len(rough) <= 3


def test_water_at_printed_temperatures():
    assert water.density(25.0) == pytest.approx(997.047, abs=3e-3)  # CIPM tables; Kell is good to 3 ppm
    assert water.viscosity(20.0) == pytest.approx(1.002e-3)
    assert water.viscosity(25.0) == pytest.approx(0.8903e-3, rel=5e-4)  # Kestin et al. (1978), table


def _stokes_sphere():
    return released_sphere.Sphere(drag_laws.one_sphere_stokes, 2500.0, 1e-4, 1000.0, 1e-3)


def test_released_sphere_without_history_is_the_exponential():
    sphere = _stokes_sphere()
    tau = sphere.inertia(True) / (3.0 * math.pi * sphere.mu * sphere.d)
    times = np.linspace(0.0, 5.0 * tau, 11)
    exact = -sphere.terminal_speed() * np.expm1(-times / tau)
    np.testing.assert_allclose(released_sphere.speed_without_history(sphere, times, True), exact, rtol=1e-9)


def test_released_sphere_with_basset_force_against_the_laplace_transform():
    """Stokes drag is linear: V(s) = W/[s (M s + K sqrt(pi s) + beta)], two poles a, b in sqrt(s)."""
    from scipy.special import wofz

    sphere = _stokes_sphere()
    mass, beta = sphere.inertia(True), 3.0 * math.pi * sphere.mu * sphere.d
    a, b = np.roots([mass, 1.5 * math.pi * sphere.d**2 * math.sqrt(sphere.rho * sphere.mu), beta])
    times = np.linspace(0.0, 20.0 * mass / beta, 41)
    root = np.sqrt(times)
    part = lambda q: (wofz(-1j * q * root) - 1.0) / q  # noqa: E731  inverse of 1/[s (sqrt(s) - q)]
    exact = (sphere.weight() / mass * (part(a) - part(b)) / (a - b)).real
    solved = released_sphere.speed_with_history(sphere, times, nodes=800)
    np.testing.assert_allclose(solved, exact, atol=2e-5 * sphere.terminal_speed())


def test_mei_adrian_kernel_is_basset_at_short_times():
    sphere = _stokes_sphere()
    t = np.linspace(0.0, 1e-9, 5)
    for ours, basset in zip(
        released_sphere.mei_adrian_weights(sphere, t, 1e-4 * np.ones(5)), released_sphere.basset_weights(sphere, t, None)
    ):
        np.testing.assert_allclose(ours, basset, rtol=1e-3)


# --- the drag-law kit ---


@pytest.mark.parametrize("law", [name for name in drag_laws.LAWS if name != "ergun"])
def test_one_grain_in_creeping_flow(law):
    expected = 0.96 if law in ("di_felice", "rong") else 1.0  # Dallavalle: 4.8^2/24
    assert drag_laws.LAWS[law](1.0, 0.0) == pytest.approx(expected, rel=1e-12)


def test_hand_worked_values():
    # eps = 0.5, Re = 0: Ergun 150 x 0.5/(18 x 0.25); Beetstra and Tang 10 x 0.5/0.25 + 0.25 (1 + 1.5 sqrt 0.5)
    assert drag_laws.ergun(0.5, 0.0) == pytest.approx(50.0 / 3.0)
    assert drag_laws.beetstra(0.5, 0.0) == pytest.approx(20.0 + 0.25 * (1.0 + 1.5 * math.sqrt(0.5)))
    assert drag_laws.tang(0.5, 0.0) == pytest.approx(20.0 + 0.25 * (1.0 + 1.5 * math.sqrt(0.5)))
    # Koch-Hill above phi = 0.4: eps x 10 phi/eps^3
    assert drag_laws.koch_hill(0.5, 0.0) == pytest.approx(20.0)
    # Tenneti: eps (1/eps^3 + 5.81 phi/eps^3 + 0.48 phi^(1/3)/eps^4)
    assert drag_laws.tenneti(0.5, 0.0) == pytest.approx(0.5 * (8.0 + 23.24 + 0.48 * 0.5 ** (1 / 3) * 16.0))
    # Di Felice at log10 Re = 1.5: chi = 3.05
    re = 10.0**1.5
    assert drag_laws.di_felice(0.5, re) == pytest.approx((0.63 * math.sqrt(re) + 4.8) ** 2 / 24.0 * 2.0**3.05)
    # Rong there: chi = 2.65 x 1.5 - (5.3 - 1.75) x 0.25
    assert drag_laws.rong(0.5, re) == pytest.approx((0.63 * math.sqrt(re) + 4.8) ** 2 / 24.0 * 2.0**3.0875)
    # Schiller-Naumann on the interstitial slip: Re_i = 2 at eps = 0.5, Re = 1
    assert drag_laws.schiller_naumann(0.5, 1.0) == pytest.approx((1.0 + 0.15 * 2.0**0.687) / 0.5)
    assert drag_laws.wen_yu(0.5, 1.0) == pytest.approx(1.15 * 2.0**3.65)


def test_bed_pressure_drop_returns_the_ergun_equation():
    """f_d / eps is the whole force; n of them per volume balance the pressure gradient of Ergun's equation."""
    eps, d, mu, rho, u_s = 0.42, 2e-3, 1e-3, 1000.0, 0.05
    f_d = 3.0 * math.pi * mu * d * u_s * drag_laws.ergun(eps, rho * d * u_s / mu)
    gradient = (1.0 - eps) / (math.pi * d**3 / 6.0) * f_d / eps
    viscous = 150.0 * mu * (1.0 - eps) ** 2 * u_s / (eps**3 * d**2)
    assert gradient == pytest.approx(viscous + 1.75 * rho * (1.0 - eps) * u_s**2 / (eps**3 * d))


@pytest.mark.parametrize("law", ["ergun", "beetstra", "tang", "tenneti", "koch_hill"])
def test_dense_creeping_laws_are_near_kozeny_carman(law):
    """At eps = 0.5, Re = 0 the whole force is that of K = d^2 eps^3/(180 (1-eps)^2): F = 10 phi/eps^2, Ergun's 150 below it."""
    assert drag_laws.LAWS[law](0.5, 0.0) == pytest.approx(20.0, rel=0.17)


def test_sphere_laws_agree_where_they_are_all_valid():
    for re in (1.0, 10.0, 100.0, 700.0):
        laws = [name for name in drag_laws.ONE_SPHERE if name not in ("stokes", "di_felice")]
        values = [drag_laws.ONE_SPHERE[name](np.array(re)) for name in laws]
        assert max(values) / min(values) < 1.08


def _check(path, *options):
    command = [sys.executable, str(ROOT / "drag_laws" / "check_drag_table.py"), str(path), *options]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def _table(path, law, function):
    with open(path, "w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(["law", "eps", "re", "f"])
        grid = [(eps, re) for eps in generate.DRAG_EPS for re in generate.DRAG_RE]
        writer.writerows((law, eps, re, repr(float(function(eps, re)))) for eps, re in grid)


def test_kit_accepts_its_own_table():
    result = _check(ROOT / "drag_laws" / "drag_table.csv", "--all")
    assert result.returncode == 0 and result.stdout.count("agree") == len(drag_laws.LAWS)


MISTAKES = {
    "di_felice with the exponent on the interstitial slip": ("di_felice", lambda e, r: drag_laws.di_felice(e, r) / e**2),
    "di_felice with ln for log10": (
        "di_felice",
        lambda e, r: drag_laws.one_sphere_dallavalle(r)
        * e ** -(3.7 - 0.65 * math.exp(-((1.5 - math.log(max(r, 1e-300))) ** 2) / 2)),
    ),
    "schiller_naumann with 1.15 for 0.15": ("schiller_naumann", lambda e, r: (1.0 + 1.15 * (r / e) ** 0.687) / e),
    "stokes without eps": ("stokes", lambda e, r: 1.0),
    "beetstra as the whole force": ("beetstra", lambda e, r: drag_laws.beetstra(e, r) / e),
    "koch_hill with the diameter in Re": ("koch_hill", lambda e, r: 2.0 * drag_laws.koch_hill(e, r) - drag_laws.koch_hill(e, 0.0)),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_kit_catches_the_usual_mistakes(mistake, tmp_path):
    law, function = MISTAKES[mistake]
    _table(tmp_path / "mine.csv", law, function)
    result = _check(tmp_path / "mine.csv")
    assert result.returncode == 1 and f"{law} at eps" in result.stdout


def test_kit_reports_missing_rows_and_bad_files(tmp_path):
    (tmp_path / "short.csv").write_text("law,eps,re,f\nstokes,0.5,0,2\n", encoding="utf-8")
    result = _check(tmp_path / "short.csv")
    assert result.returncode == 1 and "is missing" in result.stdout
    for text in ("", "law,eps,re\nstokes,1,0\n", "law,eps,re,f\nstokes,1,zero,1\n", "law,eps,re,f\nno_such_law,1,0,1\n"):
        (tmp_path / "bad.csv").write_text(text, encoding="utf-8")
        result = _check(tmp_path / "bad.csv")
        assert result.returncode == 2 and result.stderr
