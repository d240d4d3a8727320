# SPDX-License-Identifier: BSD-3-Clause
"""The committed full run of scripts/soundness, held against what is asked of it."""
import csv
import os

RECORD = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'doc', 'charts', 'soundness.csv')
# Campaigns whose names begin so, and how many cases each needs.
ASKED = [('rounding: T1', 100000), ('rounding: T2', 100000), ('rounding: T3', 100000), ('rounding: T4', 100000),
         ('rounding: T6', 100000), ('rounding_fused: T1', 100000), ('intervals of queries', 1000000),
         ('certificates and mutants', 10000)]


def judge_all(path=RECORD):
    """Judgement, name, and a sentence for each campaign that is asked for."""
    rows = []
    if os.path.exists(path):
        with open(path, newline='') as text:
            rows = list(csv.DictReader(text))
    for name, least in ASKED:
        found = [row for row in rows if row['campaign'].startswith(name)]
        cases = sum(int(row['cases']) for row in found)
        violations = sum(int(row['violations']) for row in found)
        met = bool(found) and cases >= least and violations == 0
        said = f"{violations} violations in {cases} cases (at least {least})" if found else 'no record'
        where = f", seed {found[0]['seed']}, commit {found[0]['commit']}" if found else ''
        yield 'met' if met else 'MISSED', f'soundness, {name}', said + where


def report():
    """Prints a line for each; the number of those missed."""
    missed = 0
    for verdict, name, said in judge_all():
        missed += verdict == 'MISSED'
        print(f'{verdict:<12} {name}: {said}')
    return missed
