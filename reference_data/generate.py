#!/usr/bin/env python3
"""Write the analytic tables of this folder, or check that the committed ones are what the theory gives.

    generate.py            write every table
    generate.py --check    recompute and compare; exit 1 naming the first difference of each table

Numbers agree to 1e-12 relative (elementary functions differ in the last bits between machines); tables made by a
least-squares solution carry six digits, those made by quadrature or an eigenproblem eight, and agree to one unit of the last.
Needs NumPy and SciPy.
"""

import argparse
import csv
import io
import sys
from pathlib import Path
from typing import Callable, NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parent))

from drag_laws.drag_laws import LAWS, in_range  # noqa: E402
from theory import cylinder_arrays, layered_rayleigh_taylor, packed_beds, rayleigh_taylor  # noqa: E402
from theory import self_disturbance_tables, settling, smoothed_block  # noqa: E402

ROOT = Path(__file__).resolve().parent

# The grid avoids every point where a law jumps (Re_i = 0.1 ... 10^4 and 5000 of Morsi-Alexander, eps = 0.8 of Gidaspow,
# eps = 0.6 of Koch-Hill), so that < against <= cannot decide a row.
DRAG_EPS = (0.4, 0.45, 0.5, 0.55, 0.62, 0.7, 0.78, 0.82, 0.9, 0.97, 1.0)
DRAG_RE = (0.0, 1.0e-3) + tuple(float(f"{m}e{k}") for k in range(-3, 4) for m in (1.3, 3.2, 6.8)) + (1.3e4,)


class Generated(NamedTuple):
    """One analytic table: where it goes, its header, its rows, and the digits written."""

    path: str
    header: str
    rows: Callable
    digits: int = 17


def drag_rows():
    """(law, eps, Re, F, in range) over the conformance grid."""
    return [
        (name, eps, re, float(law(eps, re)), int(in_range(name, eps, re)))
        for name, law in LAWS.items()
        for eps in DRAG_EPS
        for re in DRAG_RE
    ]


def cylinder_rows(array):
    """Rows of one array without its name."""
    return [row[1:] for row in cylinder_arrays.rows() if row[0] == array]


TABLES = (
    Generated("drag_laws/drag_table.csv", "law,eps [1],re [1],f [1],in_range [1]", drag_rows),
    Generated(
        "settling_theory/single_grain.csv",
        "fluid,rho [kg/m3],mu [Pa s],tau_p [s],u_t_stokes [m/s],u_t_di_felice [m/s],re_p [1]",
        settling.single_grain_rows,
    ),
    Generated(
        "settling_theory/hindered.csv",
        "fluid,eps [1],v_mixture [m/s],re_mixture [1],v_plain [m/s],re_plain [1]",
        settling.hindered_rows,
    ),
    Generated(
        "chandrasekhar_1961/growth_rate.csv",
        "fluid,viscosity_above,k [1/m],rho_above [kg/m3],mu_above [Pa s],n [1/s]",
        rayleigh_taylor.rows,
    ),
    Generated(
        "sangani_acrivos_1982/square.csv",
        "solid_fraction [1],force [1],permeability [1]",
        lambda: [row[:3] for row in cylinder_rows("square")],
        6,
    ),
    Generated(
        "sangani_acrivos_1982/hexagonal.csv",
        "solid_fraction [1],force [1],permeability [1]",
        lambda: [row[:3] for row in cylinder_rows("hexagonal")],
        6,
    ),
    Generated(
        "gebart_1992/permeability.csv",
        "array,solid_fraction [1],permeability [1],over_exact [1]",
        lambda: [(row[0], row[1], row[4], row[5]) for row in cylinder_arrays.rows()],
        6,
    ),
    Generated(
        "self_disturbance/kernels.csv",
        "kernel,viscous_operator,h_over_d [1],coefficient [1],excess [1]",
        self_disturbance_tables.kernel_rows,
        8,
    ),
    Generated(
        "self_disturbance/widths.csv",
        "spread_over_gather [1],viscous_over_gather [1],coefficient [1]",
        self_disturbance_tables.width_rows,
        8,
    ),
    Generated(
        "self_disturbance/oseen_brinkman.csv",
        "viscous_operator,re_h [1],screening [1],coefficient [1]",
        self_disturbance_tables.resistance_rows,
        8,
    ),
    Generated(
        "self_disturbance/suspension.csv",
        "solid_fraction [1],h_over_d [1],s_0 [1],coefficient [1]",
        self_disturbance_tables.suspension_rows,
        8,
    ),
    Generated(
        "self_disturbance/steady_settling.csv",
        "fluid,h_over_d [1],re_h [1],u_creeping [1],u_slip [1],u_path [1]",
        self_disturbance_tables.steady_rows,
        8,
    ),
    Generated(
        "self_disturbance/nonlinear.csv",
        "fluid,h_over_d [1],re_h [1],u_full [1],u_slip [1],u_path [1]",
        self_disturbance_tables.nonlinear_rows,
        6,
    ),
    Generated(
        "self_disturbance/release.csv",
        "fluid,h_over_d [1],t_over_tau_p [1],nu_t_over_h2 [1],v_creeping [1],u_creeping [1],v_slip [1],u_slip [1]",
        self_disturbance_tables.release_rows,
        8,
    ),
    Generated(
        "self_disturbance/hasimoto.csv",
        "cell_over_d [1],solid_fraction [1],k_point [1],k_hasimoto [1],k_sangani_acrivos [1],"
        "corrected_h1 [1],corrected_h2 [1],corrected_h3 [1]",
        self_disturbance_tables.hasimoto_rows,
        8,
    ),
    Generated(
        "suspension_theory/hindered_settling.csv",
        "fluid,eps [1],v_mixture [m/s],v_plain [m/s],v_richardson_zaki [m/s],exponent [1]",
        packed_beds.hindered_rows,
    ),
    Generated(
        "suspension_theory/packed_bed.csv",
        "law,eps [1],re [1],gradient [1],over_ergun [1],permeability [1],kozeny_carman [1]",
        packed_beds.bed_rows,
    ),
    Generated(
        "suspension_theory/smoothed_porosity.csv",
        "eps_nominal [1],h_over_d [1],columns [1],layers [1],spacing [m],eps_lattice [1],eps_h [1],eps_h_c [1],eps_particle [1]",
        smoothed_block.porosity_rows,
        8,
    ),
    Generated(
        "suspension_theory/smoothed_block.csv",
        "fluid,eps_nominal [1],h_over_d [1],v_gathered [m/s],v_particle [m/s],v_local [m/s],v_nominal [m/s],"
        "v_lattice [m/s]",
        smoothed_block.velocity_rows,
        8,
    ),
    Generated(
        "suspension_theory/dusty_growth_rate.csv",
        "fluid,viscosity_above,k [1/m],tau_of,tau [s],n_gas [1/s],n_liquid [1/s]",
        rayleigh_taylor.dusty_rows,
        8,
    ),
    Generated(
        "suspension_theory/layered_growth_rate.csv",
        "fluid,viscosity_above,k [1/m],across [1],h [m],n_deep [1/s],n_layer [1/s],n_once [1/s],n_once_inertia [1/s],"
        "n_gathered [1/s],n_gathered_inertia [1/s]",
        layered_rayleigh_taylor.rows,
        8,
    ),
    Generated(
        "suspension_theory/edge_growth_rate.csv",
        "fluid,k [1/m],across [1],n_point [1/s],n_kernels [1/s],n_kernels_morris [1/s]",
        layered_rayleigh_taylor.edge_rows,
        8,
    ),
)


def _text(value, digits):
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return str(value)
    return repr(value) if digits == 17 else f"{value:.{digits}g}"


def csv_text(table):
    """The table as the text of its file."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(table.header.split(","))
    writer.writerows([_text(value, table.digits) for value in row] for row in table.rows())
    return stream.getvalue()


def _same(mine, theirs, digits):
    if mine == theirs:
        return True
    try:
        a, b = float(mine), float(theirs)
    except ValueError:
        return False
    return abs(a - b) <= (1e-12 if digits == 17 else 1.01 * 10.0 ** (1 - digits)) * max(abs(a), abs(b))


def difference(table):
    """None, or a sentence that names the first difference between the committed table and the theory."""
    path = ROOT / table.path
    if not path.is_file():
        return f"{table.path}: missing"
    committed = list(csv.reader(io.StringIO(path.read_text(encoding="utf-8"))))
    fresh = list(csv.reader(io.StringIO(csv_text(table))))
    if len(committed) != len(fresh):
        return f"{table.path}: {len(committed)} lines, expected {len(fresh)}"
    for number, (ours, theirs) in enumerate(zip(fresh, committed), start=1):
        if len(ours) != len(theirs):
            return f"{table.path}, line {number}: {len(theirs)} fields, expected {len(ours)}"
        for name, mine, other in zip(fresh[0], ours, theirs):
            if not _same(mine, other, table.digits):
                return f"{table.path}, line {number}, {name}: {other}, expected {mine}"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--check", action="store_true", help="compare with the committed tables instead of writing")
    if not parser.parse_args().check:
        for table in TABLES:
            (ROOT / table.path).parent.mkdir(exist_ok=True)
            (ROOT / table.path).write_text(csv_text(table), encoding="utf-8")
            print(f"wrote {table.path}")
        return 0
    found = [message for message in map(difference, TABLES) if message]
    print("\n".join(found) if found else f"{len(TABLES)} analytic tables agree")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
