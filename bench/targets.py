# SPDX-License-Identifier: BSD-3-Clause
"""Holds results against bench/targets.csv."""
import csv
import fnmatch
import math
import os

OURS = 'curve_proximity'
HERE = os.path.dirname(os.path.abspath(__file__))


def read_targets():
    with open(os.path.join(HERE, 'targets.csv'), newline='') as text:
        return list(csv.DictReader(line for line in text if not line.startswith('#')))


def is_ours(row):
    """Our method, or one of our methods where a group has several ("curve_proximity, hybrid")."""
    return row['method'].split(',')[0].strip() == OURS or row['method'].startswith(OURS + ' ')


def matching(rows, target):
    return [row for row in rows if all(fnmatch.fnmatchcase(row[key], target[key]) for key in ('group', 'workload', 'parameter'))]


def ratios(rows, baseline):
    """baseline's time over ours for each workload and parameter that has both."""
    theirs = {(r['workload'], r['parameter']): float(r['median_us']) for r in rows if r['method'] == baseline}
    ours = {(r['workload'], r['parameter']): float(r['median_us']) for r in rows if r['method'] == OURS}
    return [theirs[key] / ours[key] for key in ours if key in theirs]


def figure(rows, target):
    """The figure of a target, and whether it is met; None where there is nothing to judge."""
    kind, limit = target['kind'], float(target['limit'])
    found = matching(rows, target)
    if kind in ('ratio', 'each'):
        values = ratios(found, target['baseline'])
        if not values:
            return None
        value = min(values) if kind == 'each' else math.exp(sum(map(math.log, values)) / len(values))
        return value, value >= limit
    ours = [row for row in found if is_ours(row)]
    if not ours:
        return None
    if kind == 'growth':
        by_accuracy = sorted(ours, key=lambda row: row['parameter'])
        times = [float(row['median_us']) for row in by_accuracy]
        value = times[-1] / times[0]
    elif kind in ('nodes', 'probes'):
        value = max(float(row[kind]) for row in ours)
    else:
        value = sum(int(row[kind]) for row in ours)
    return value, value <= limit


def report(rows, only):
    """Prints a line for each target; the number of those missed. A target without rows is missed unless its group was left out."""
    missed = 0
    for target in read_targets():
        if only and target['group'] != '*' and target['group'] not in only:
            continue
        found = figure(rows, target)
        met = bool(found and found[1])
        missed += not met
        value = f'{found[0]:.3g}' if found else 'no rows'
        asked = 'at least' if target['kind'] in ('ratio', 'each') else 'at most'
        print(f"{'met   ' if met else 'MISSED'} {target['name']}: {value} ({target['kind']}, {asked} {target['limit']})")
    return missed
