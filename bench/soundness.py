# SPDX-License-Identifier: BSD-3-Clause
"""The committed full run of scripts/soundness, held against what is asked of it."""
import csv
import os

RECORD = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'doc', 'charts', 'soundness.csv')
# Campaigns whose names begin so, how many cases each needs, and the least that the largest error may be of its bound (a bound that
# is never approached is padded).
ASKED = [(f'{build}: {theorem}', 100000, least) for build in ('rounding', 'rounding_fused')
         for theorem, least in (('T1', .15), ('T2', .15), ('T3', .15), ('T4', .15), ('T6', .15))]
ASKED += [(f'{build}: T5', 100000, .1) for build in ('rounding_chain', 'rounding_chain_fused')]
ASKED += [('certificates of robots and mutants', 10000, None)]
ASKED += [(f'attack: {family}', 1000000, None) for family in
          ('coaxial', 'coincident', 'contact', 'flat', 'inside', 'lengths', 'starve', 'superquadrics', 'ties',
           'time_of_contact', 'movers')]
ASKED += [(f'attack: {family}', 100000, None) for family in ('gradients', 'links', 'robots')]
ASKED += [('intervals of queries', 1000000, None), ('certificates and mutants', 10000, None)]


def judge_all(path=RECORD):
    """Judgement, name, and a message for each campaign that is asked for."""
    rows = []
    if os.path.exists(path):
        with open(path, newline='') as text:
            rows = list(csv.DictReader(text))
    for name, least, tightness in ASKED:
        found = [row for row in rows if row['campaign'].startswith(name)]
        cases = sum(int(row['cases']) for row in found)
        violations = sum(int(row['violations']) for row in found)
        met = bool(found) and cases >= least and violations == 0
        if tightness:
            met = met and all(float(row['figure'].split()[0]) >= tightness for row in found)
        said = f"{violations} violations in {cases} cases (at least {least})" if found else 'no record'
        where = f", {found[0]['figure']}, seed {found[0]['seed']}, commit {found[0]['commit']}" if found else ''
        yield 'met' if met else 'MISSED', f'soundness, {name}', said + where


def report():
    """Prints a line for each; the number of those missed."""
    missed = 0
    for verdict, name, said in judge_all():
        missed += verdict == 'MISSED'
        print(f'{verdict:<12} {name}: {said}')
    return missed
