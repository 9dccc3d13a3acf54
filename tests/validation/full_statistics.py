#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the statistics of every BSDF at full size, judges them and tells the worst of each kind and where.

    tests/validation/full_statistics.py build/release/tests/full_statistics [--into docs/validation.md]

Takes hours on two cores. What is done is kept in build/full_statistics.tsv: the same command goes on after a stop, and
--no-run judges what is there. Prints a table (Markdown); with --into it also takes the place of the table there. Exits
with 1 where a limit is broken.
"""
import argparse
import collections
import pathlib
import subprocess
import sys

from tables import replace_table

ROOT = pathlib.Path(__file__).resolve().parents[2]
FIELDS = ("family name theta side band p_bins p_cells p_mass mass_error below weight pdf energy energy_sd "
          "jacobian_lacking jacobian reciprocity is_reciprocal conserves").split()
TEXTS = {"family", "name", "band"}

FAMILY_ALPHA = 0.01  # of all chi-square and mass tests together (Šidák 1967)
WEIGHT_LIMIT = 1e-4  # 99th percentile over all angles of a BSDF: the contract's own
# At one angle: rounding of single precision a thousandth above the horizon. Built in double precision (preset `double`) the
# largest seen, 3.5e-4 of two real measurements at 89.9 degrees, become 7e-13.
ONE_ANGLE_LIMIT = 5e-4
# Finite differences of single precision, where the lobe is no sliver of the horizon (to 85 degrees).
JACOBIAN_LIMIT, JACOBIAN_MOST_DEG = 2e-2, 85
RECIPROCITY_LIMITS = {"analytic": 1e-4, "table": 1e-3}  # tables turn rounding of directions into that of coordinates
TABLE_FAMILIES = ("Separated", "Compact", "Tables", "Paired", "real")
ENERGY_SIGMAS = 4.5


def read(path: pathlib.Path) -> list[dict]:
    rows = []
    for line in path.read_text(encoding="utf-8").splitlines():
        values = line.split("\t")
        if len(values) != len(FIELDS):
            sys.exit(f"{path}: a line of {len(values)} fields, expected {len(FIELDS)}")
        row = {key: value if key in TEXTS else float(value) for key, value in zip(FIELDS, values)}
        row["jacobian"] = max(row["jacobian"], row["jacobian_lacking"])
        rows.append(row)
    return rows


def place(row: dict) -> str:
    below = ", from below" if row["side"] < 0 else ""
    return f"{row['name'].replace('_', ' ')}, {row['theta']:g}°{below}, {row['band']} nm"


def broken_rules(rows: list[dict], level: float) -> list[str]:
    broken = []

    def demand(holds: bool, what: str, row: dict) -> None:
        if not holds:
            broken.append(f"{what} at {place(row)}")

    for r in rows:
        for key in ("p_bins", "p_cells", "p_mass"):
            demand(r[key] > level, f"{key} {r[key]:.2g}", r)
        demand(r["below"] == 0, f"{r['below']:.0f} samples below the horizon", r)
        demand(r["weight"] <= ONE_ANGLE_LIMIT and r["pdf"] <= ONE_ANGLE_LIMIT,
               f"weight {r['weight']:.2g}, density {r['pdf']:.2g}", r)
        if r["theta"] <= JACOBIAN_MOST_DEG:
            demand(r["jacobian"] <= JACOBIAN_LIMIT, f"Jacobian {r['jacobian']:.2g}", r)
        if r["conserves"]:
            demand(r["energy"] <= 1 + ENERGY_SIGMAS * r["energy_sd"] + 2e-6, f"energy {r['energy']:.5f}", r)
        if r["is_reciprocal"]:
            kind = "table" if r["family"].startswith(TABLE_FAMILIES) else "analytic"
            demand(r["reciprocity"] <= RECIPROCITY_LIMITS[kind], f"reciprocity {r['reciprocity']:.2g}", r)
    return broken


def cell(rows: list[dict], key: str, form: str, pick=max) -> str:
    if not rows:
        return "–"
    row = pick(rows, key=lambda r: r[key])
    return f"{format(row[key], form)} ({place(row)})"


def table(rows: list[dict], level: float) -> str:
    families = collections.defaultdict(list)
    for row in rows:
        families[row["family"]].append(row)
    text = ("| BSDFs | least p: 80 x 160 bins | least p: cells along the lobe | least p: mass | weight, 99 % | "
            "Jacobian, to 85° | most energy | reciprocity, 99 % |\n|---|---|---|---|---|---|---|---|\n")
    for family, of_family in families.items():
        inner = [r for r in of_family if r["theta"] <= JACOBIAN_MOST_DEG]
        text += (f"| {family}: {len({r['name'] for r in of_family})} "
                 f"| {cell(of_family, 'p_bins', '.1e', min)} | {cell(of_family, 'p_cells', '.1e', min)} "
                 f"| {cell(of_family, 'p_mass', '.1e', min)} | {cell(of_family, 'weight', '.1e')} "
                 f"| {cell(inner, 'jacobian', '.1e')} | {cell(of_family, 'energy', '.4f')} "
                 f"| {cell([r for r in of_family if r['is_reciprocal']], 'reciprocity', '.1e')} |\n")
    names = len({r["name"] for r in rows})
    return text + (f"\n{names} BSDFs, {len(rows)} combinations of incidence, side and band, {3 * len(rows)} tests: each at "
                   f"{level:.1e} for 0.01 of all.\n")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "build/full_statistics.tsv")
    parser.add_argument("--samples", default="1e6", help="of each incidence, side and band")
    parser.add_argument("--only", default="", help="BSDFs whose name contains this")
    parser.add_argument("--no-run", action="store_true", help="judge the results that are there")
    parser.add_argument("--into", type=pathlib.Path, help="a document whose table is replaced")
    arguments = parser.parse_args()
    if not arguments.no_run:
        subprocess.run([str(arguments.program), str(arguments.results), arguments.samples, arguments.only], check=True)
    rows = [r for r in read(arguments.results) if arguments.only in r["name"]]
    if not rows:
        sys.exit(f"{arguments.results}: no results")
    level = -((1 - FAMILY_ALPHA) ** (1 / (3 * len(rows))) - 1)
    made = table(rows, level)
    print(made)
    broken = broken_rules(rows, level)
    by_name = collections.defaultdict(list)
    for row in rows:
        by_name[row["name"]].append(row["weight"])
    broken += [f"weights of {name}: mean of the 99th percentiles {sum(w) / len(w):.2g}" for name, w in by_name.items()
               if sum(w) / len(w) > WEIGHT_LIMIT]
    for line in broken:
        print(line, file=sys.stderr)
    if arguments.into:
        replace_table(arguments.into, "full statistics", made)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
