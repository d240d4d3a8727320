# SPDX-License-Identifier: BSD-3-Clause
"""Does a second run say the same? Ratios within their stated spread, counts exactly."""
import math
import os

import passes
import targets
from pages.figures import short, table

UNTIMED = ('stability',)  # one round a problem: its counts are what is asked of it
PAGE = 'repeat.md'


def spread_text(target, spread):
    """The spread of passes.spread_of() for people."""
    if spread is None:
        return 'not held'
    return 'exact' if spread == 0.0 else f'± {spread:.2g}' if target['kind'] == 'exponent' else f'{100.0 * spread:.0f} %'


def agree(first, second, target, spread):
    if spread == 0.0:
        return first == second
    if target['kind'] == 'exponent':
        return abs(first - second) <= spread
    return abs(math.log(first / second)) <= math.log1p(spread)


def compare_targets(rows, others, *of_passes):
    """For each target that both runs measured and that has a spread: target, both figures, the spread, whether they agree."""
    for target in targets.read_targets():
        first, second = targets.figure(rows, target), targets.figure(others, target)
        spread = passes.spread_of(target, *of_passes)
        if first is not None and second is not None and spread is not None:
            yield target, first, second, spread, agree(first, second, target, spread)


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
    lines = [['same' if same else '**differs**', target['name'], short(first), short(second), spread_text(target, spread)]
             for target, first, second, spread, same in compared]
    groups = [[group, str(len(values)), percent(values, 0.5), percent(values, 0.9), percent(values, 1.0)]
              for group, values in by_group.items()]
    return f'''# A second run

This run: {made[0]}

The other: {made[1]}

A target's ratio is the same where the two figures differ by no more than the spread: what the passes of the one run and those of the other
differ by, together (`spread.csv` of each), at least 20 % (exponents 0.1, tails 50 %). Counts must be equal.

{table(['', 'target', 'this run', 'the other', 'spread'], lines)}

## Single ratios
Another method's time over ours, one for each workload and parameter: by how much it differs between the runs. The targets above are means or minima of these.

{table(['group', 'ratios', 'half differ by at most', 'nine tenths', 'all'], groups)}
'''


def report(rows, others, folders, made):
    """folders: of both runs, the page goes into the first. made: how they came to be. Writes the page, prints a line for each target that differs and a summary; the number of those that differ."""
    compared = list(compare_targets(rows, others, *map(passes.read_spread, folders)))
    with open(os.path.join(folders[0], PAGE), 'w') as text:
        text.write(page(compared, differences(rows, others), made))
    differing = [line for line in compared if not line[-1]]
    for target, first, second, *_ in differing:
        print(f"DIFFERS      {target['name']}: {first:.3g} and {second:.3g} ({target['kind']})")
    print(f'{len(compared) - len(differing)} of {len(compared)} targets are the same in both runs')
    return len(differing)
