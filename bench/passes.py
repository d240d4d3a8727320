# SPDX-License-Identifier: BSD-3-Clause
"""A run goes over its groups several times, in fresh processes: the results are what the passes have in the middle, the spread of a
target's figure is what they differ by.

Two processes of the same program differ by more than their rounds do: by where memory lies, and by what the machine does meanwhile."""
import csv
import math
import os
import statistics

import targets

SPREAD = 'spread.csv'
TIMES = ('median_us', 'p95_us')
# Rounds vary little in these; or they are counts.
LARGEST = ('nodes', 'distance_queries', 'error', 'unsound', 'failures')


def key_of(row):
    return row['group'], row['workload'], row['method'], row['parameter']


def merged_cells(of):
    """One row from the same row of several passes: the median of its times, the largest of its counts."""
    def numbers(column):
        return [value for value in (float(row[column] or 'nan') for row in of) if not math.isnan(value)]
    one = dict(of[0])
    for column, choose in [*((c, statistics.median) for c in TIMES), *((c, max) for c in LARGEST)]:
        if numbers(column):
            chosen = choose(numbers(column))
            one[column] = next((row[column] for row in of if row[column] and float(row[column]) == chosen), f'{chosen:.4g}')
    return one


def merge(passes):
    """The rows of all passes as one run, in the order in which they first came."""
    rows = {}
    for one in passes:
        for row in one:
            rows.setdefault(key_of(row), []).append(row)
    return [merged_cells(of) for of in rows.values()]


def figures(passes):
    """The figures of each target whose group was in more than one pass, by the target's name."""
    found = {}
    for target in targets.read_targets():
        if target['kind'] in targets.SLACK:
            values = [value for value in (targets.figure(rows, target) for rows in passes) if value is not None]
            if len(values) > 1:
                found[target['name']] = values
    return found


def write_spread(passes, out):
    with open(os.path.join(out, SPREAD), 'w', newline='') as text:
        writer = csv.writer(text)
        writer.writerow(['target', 'figures of the passes'])
        writer.writerows([name, ' '.join(f'{value:.4g}' for value in values)] for name, values in figures(passes).items())


def read_spread(folder):
    """By the target's name: the figures of the passes; nothing where the folder has none."""
    path = os.path.join(folder, SPREAD)
    if not os.path.exists(path):
        return {}
    with open(path, newline='') as text:
        return {row['target']: [float(value) for value in row['figures of the passes'].split()] for row in csv.DictReader(text)}


def seen_by(target, of_passes):
    """By how much the passes of a run differ: a factor, or for an exponent a difference."""
    values = of_passes.get(target['name'], [1.0])
    return max(values) - min(values) if target['kind'] == 'exponent' else max(values) / min(values)


def spread_of(target, *runs):
    """How far a figure may be off, or those of two runs apart: what the passes of each run differ by, together, and never
    less than the target's slack, even where three passes happen to agree. A factor of 1 + spread for ratios, the spread itself for
    exponents, nothing for counts; None where figures say as much about the machine as about us."""
    if target['kind'] in ('microseconds', 'p95 microseconds', 'error'):
        return None
    if target['kind'] not in targets.SLACK:
        return 0.0
    seen = [seen_by(target, of_passes) for of_passes in runs]
    return max(sum(seen) if target['kind'] == 'exponent' else math.prod(seen) - 1.0, float(target['slack'] or targets.SLACK[target['kind']]))
