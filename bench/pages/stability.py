# SPDX-License-Identifier: BSD-3-Clause
"""stability.md: families of hard inputs against methods, each cell right / wrong / given up."""
import re

import targets
from pages.figures import picture, table


def family_of(row):
    """What stands before the number of cases."""
    return re.sub(r' \d+ cases.*', '', row['parameter'])


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
        return 'not asked'
    cases, wrong, given_up = counts
    right = f'{cases - wrong - given_up} right' if cases else ''
    bad = [f'**{wrong} wrong**'] * bool(wrong) + [f'{given_up} given up'] * bool(given_up)
    return ', '.join([right] * bool(right) + bad) or '0 wrong'


def grid(rows, family_of):
    found = cells(rows, family_of)
    methods = sorted(dict.fromkeys(row['method'] for row in rows), key=lambda name: not targets.is_ours({'method': name}))
    return table(['family', *methods], [[family, *(cell(of.get(method)) for method in methods)] for family, of in found.items()])


def section(title, text, rows, family_of, peers=()):
    """peers: libraries that a machine may lack; those that it lacked are named."""
    if not rows:
        return ''
    missing = [peer for peer in peers if not any(row['method'].startswith(peer) for row in rows)]
    said = f"\n\nNot measured, since not installed: {', '.join(missing)}." if missing else ''
    return f'## {title}\n{text}\n\n{grid(rows, family_of)}{said}\n'


def page(figures, out):
    def of(group, workload=None):
        return [row for row in figures.rows if row['group'] == group and workload in (None, row['workload'])]
    hard = of('stability')
    missed = [row for row in hard if row['workload'].startswith(('plate', 'graze'))]
    gaps = [row for row in hard if row['workload'].startswith('gap: ')]
    return '\n'.join(filter(None, [
        '# Stability\n\nHard inputs whose answers are known, and what each method says of them. Wrong: an interval that misses the truth, or a value that '
        'is off by more than was asked, without saying so. Given up: out of its budget, or no answer. `results.csv` names the seeds.\n',
        f"{picture(out, 'stability', 'Hard inputs: right, wrong and given up, by method')}\n",
        section('Curves', 'Distances to 1e-9; the truth is known by construction. Samples and libraries never say how far they may be off: more than 1e-9 is '
                'counted as wrong. SISL is asked about points and curves only. Of the kinks, the infinite speed and the turns no more is known than points '
                'and lengths. Chebyshev\'s polynomial with eight minima has control points 5e4 times as high as itself; with ten, where they are 7e5 '
                'times as high, rounding leaves intervals of 6e-9 (status `precision`).',
                [row for row in hard if row not in missed and row not in gaps], lambda row: row['workload'], ('OpenCASCADE', 'SISL')),
        section('Collisions that sampling misses', 'A point or a ball along a quintic through thin plates, and grazes by that depth; all of them collide, by a '
                'witness that none of the methods gave. Wrong: not seen; a time of contact that is late, or early by more than 1e-6 m.',
                missed, lambda row: row['workload'], ('FCL', 'Bullet')),
        section('Overlapping solids', 'Do the interiors of two solids overlap? Half of the cases do, by a common point; half are apart by a plane, from 1 mm '
                'to 1 m. Gaps of 33 samples; V alone, and with the bounds per direction that a verdict asks first. Wrong: clear for an overlap, or an overlap '
                'for what is apart. Given up: apart and not proven so. A tuned gap proves nothing.', gaps,
                lambda row: row['workload'][len('gap: '):]),
        section('Implicit bodies', 'Pairs of superquadrics and their like, to a relative gap of 1e-8.', of('implicit', 'hard families'),
                family_of, ('ipopt',)),
        section('Robots', 'Thin wires, pins and plates beside arms in motion; thin superquadrics of exponents 1.2 to 100, and lenses '
                'that a plane cuts.', of('robots', 'thin obstacles'), family_of),
    ]))
