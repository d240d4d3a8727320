# SPDX-License-Identifier: BSD-3-Clause
"""stability.md: families of hard inputs against methods, each cell right / wrong / given up."""
import re

import targets
from pages.figures import table


def cells(rows, family_of):
    """Family -> method -> its counts, in the order of the rows."""
    found = {}
    for row in rows:
        cases = int(re.search(r'(\d+) (?:cases|problems|obstacles)', row['parameter'] + ' ' + row['workload'] + ' 0 cases').group(1))
        wrong, given_up = int(row['unsound']), int(row['failures'])
        found.setdefault(family_of(row), {})[row['method']] = (cases, wrong, given_up)
    return found


def cell(counts):
    if counts is None:
        return ''
    cases, wrong, given_up = counts
    right = f'{cases - wrong - given_up} right' if cases else ''
    bad = [f'**{wrong} wrong**'] * bool(wrong) + [f'{given_up} given up'] * bool(given_up)
    return ', '.join([right] * bool(right) + bad) or '0 wrong'


def grid(rows, family_of):
    found = cells(rows, family_of)
    methods = sorted(dict.fromkeys(row['method'] for row in rows), key=lambda name: not targets.is_ours({'method': name}))
    return table(['family', *methods], [[family, *(cell(of.get(method)) for method in methods)] for family, of in found.items()])


def section(title, text, rows, family_of):
    return f'## {title}\n{text}\n\n{grid(rows, family_of)}\n' if rows else ''


def page(figures):
    def of(group, workload=None):
        return [row for row in figures.rows if row['group'] == group and workload in (None, row['workload'])]
    return '\n'.join(filter(None, [
        '# Stability\n\nHard inputs whose answers are known, and what each method says of them. Wrong: an interval that misses the truth, or a value that '
        'is off by more than was asked, without saying so. Given up: out of its budget, or no answer. `results.csv` names the seeds.\n',
        section('Curves', 'Distances to 1e-9; the truth is known by construction. Sampling never says how far it may be off: more than 1e-9 is counted as wrong.',
                of('stability'), lambda row: row['workload']),
        section('Implicit bodies', 'Pairs of superquadrics and their like, to a relative gap of 1e-8.', of('implicit', 'hard families'), lambda row: row['parameter']),
        section('Robots', 'Thin wires, pins and plates beside arms in motion.', of('robots', 'thin obstacles'), lambda row: row['parameter']),
    ]))
