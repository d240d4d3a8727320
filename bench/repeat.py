# SPDX-License-Identifier: BSD-3-Clause
"""Does a second run say the same? Ratios within their stated spread, counts exactly."""
import math
import os

import targets
from pages.figures import short, table

COUNTS = ('nodes', 'probes', 'unsound', 'failures', 'fewer', 'node growth')
UNTIMED = ('stability',)  # one round a problem: its counts are what is asked of it
PAGE = 'repeat.md'


def spread_of(target):
    """How far two runs of the command may be apart: a factor of 1 + spread for ratios, the spread itself for exponents, nothing
    for counts; None where figures say as much about the machine as about us."""
    if target['kind'] in ('microseconds', 'error'):
        return None
    return 0.0 if target['kind'] in COUNTS else float(target['slack'] or targets.SLACK[target['kind']])


def spread_text(target):
    """The same for people."""
    spread = spread_of(target)
    if spread is None:
        return 'not held'
    return 'exact' if target['kind'] in COUNTS else f'± {spread:g}' if target['kind'] == 'exponent' else f'{100.0 * spread:.0f} %'


def agree(first, second, target):
    spread = spread_of(target)
    if target['kind'] in COUNTS:
        return first == second
    if target['kind'] == 'exponent':
        return abs(first - second) <= spread
    return abs(math.log(first / second)) <= math.log1p(spread)


def compare_targets(rows, others):
    """For each target that both runs measured and that has a spread: target, both figures, whether they agree."""
    for target in targets.read_targets():
        first, second = targets.figure(rows, target), targets.figure(others, target)
        if first is not None and second is not None and spread_of(target) is not None:
            yield target, first, second, agree(first, second, target)


def all_ratios(rows):
    """Every other method's time over ours, by group, workload, parameter and method."""
    ours = {key_of(row): row for row in rows if row['method'] == targets.OURS and time_of(row)}
    return {(*key_of(row), row['method']): time_of(row) / time_of(ours[key_of(row)])
            for row in rows if row['method'] != targets.OURS and key_of(row) in ours and time_of(row)}


def key_of(row):
    return row['group'], row['workload'], row['parameter']


def time_of(row):
    """The median, or None where there is none or it is no time of its own."""
    value = float(row['median_us'] or 'nan')
    return value if value > 0.0 else None


def differences(rows, others):
    """Of each group: by what fraction each of its ratios differs between the runs, ascending."""
    first, second, found = all_ratios(rows), all_ratios(others), {}
    for key in first.keys() & second.keys():
        if key[0] not in UNTIMED:
            found.setdefault(key[0], []).append(math.exp(abs(math.log(first[key] / second[key]))) - 1.0)
    return {group: sorted(values) for group, values in sorted(found.items())}


def percent(values, quantile):
    return f'{100.0 * values[int(quantile * (len(values) - 1) + 0.5)]:.0f} %'


def page(compared, by_group, made):
    lines = [['same' if same else '**differs**', target['name'], short(first), short(second), spread_text(target)]
             for target, first, second, same in compared]
    groups = [[group, str(len(values)), percent(values, 0.5), percent(values, 0.9), percent(values, 1.0)]
              for group, values in by_group.items()]
    return f'''# A second run

This run: {made[0]}

The other: {made[1]}

A target's ratio is the same where both figures are within its spread, which `bench/targets.csv` states
(20 % where it says nothing; exponents 0.1); counts must be equal.

{table(['', 'target', 'this run', 'the other', 'spread'], lines)}

## Single ratios
Another method's time over ours, one for each workload and parameter: by how much it differs between the runs. The targets above are means or minima of these.

{table(['group', 'ratios', 'half differ by at most', 'nine tenths', 'all'], groups)}
'''


def report(rows, others, out, made):
    """made: how both runs came to be. Writes the page, prints a line for each target that differs and a summary; the number of those that differ."""
    compared = list(compare_targets(rows, others))
    with open(os.path.join(out, PAGE), 'w') as text:
        text.write(page(compared, differences(rows, others), made))
    differing = [line for line in compared if not line[-1]]
    for target, first, second, _ in differing:
        print(f"DIFFERS      {target['name']}: {first:.3g} and {second:.3g} ({target['kind']})")
    print(f'{len(compared) - len(differing)} of {len(compared)} targets are the same in both runs')
    return len(differing)
