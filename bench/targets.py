# SPDX-License-Identifier: BSD-3-Clause
"""Holds results against bench/targets.csv."""
import csv
import fnmatch
import math
import os
import re

OURS = 'curve_proximity'
HERE = os.path.dirname(os.path.abspath(__file__))

AT_LEAST = ('ratio', 'each', 'fewer', 'smaller')
# How far a figure may be beyond its limit: two runs on a shared machine differ by so much. Counts do not.
SLACK = {'ratio': 0.2, 'each': 0.2, 'growth': 0.2, 'tail': 0.5, 'exponent': 0.1}
# Peers that a machine may lack.
PEERS = ('coal', 'Tight-Inclusion', 'VAMP', 'FCL', 'octomap', 'Ipopt', 'ipopt', 'OpenCASCADE', 'SISL', 'Bullet', 'NLopt', 'OMPL', 'KDL')


def read_targets():
    with open(os.path.join(HERE, 'targets.csv'), newline='') as text:
        return list(csv.DictReader(line for line in text if not line.startswith('#')))


def is_ours(row):
    """Our method, or one of our methods where a group has several ("curve_proximity, hybrid")."""
    return row['method'].split(',')[0].strip() == OURS or row['method'].startswith(OURS + ' ')


def matching(rows, target):
    return [row for row in rows if all(fnmatch.fnmatchcase(row[key], target[key]) for key in ('group', 'workload', 'parameter'))]


def ratios(rows, baseline, column='median_us', our_column=None):
    """baseline's time, or its count, over ours for each workload and parameter that has both."""
    def times(method, column):
        return {(r['workload'], r['parameter']): float(r[column]) for r in rows
                if r['method'] == method and r[column] not in ('', 'nan', '0')}
    theirs, ours = times(baseline, column), times(OURS, our_column or column)
    return [theirs[key] / ours[key] for key in ours if key in theirs]


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def size_of(row):
    """The first number in the parameter."""
    return float(re.search(r'\d+(\.\d+)?', row['parameter']).group())


def exponent(rows, column='median_us'):
    """The slope of log time (or of another column) against the log of the size, by least squares."""
    if not all(float(row[column]) > 0.0 for row in rows):
        return math.inf  # nothing that grows: a target of it is missed
    points = [(math.log(size_of(row)), math.log(float(row[column]))) for row in rows]
    mean_x, mean_y = (sum(c) / len(points) for c in zip(*points))
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)


def figure(rows, target):
    """The figure of a target; None where there is nothing to judge."""
    kind = target['kind']
    found = matching(rows, target)
    if kind in AT_LEAST:
        values = ratios(found, target['baseline'], {'fewer': 'nodes', 'smaller': 'error'}.get(kind, 'median_us'))
        if not values:
            return None
        return min(values) if kind in ('each', 'smaller') else geometric_mean(values)
    if kind == 'tail':
        values = ratios(found, target['baseline'] or OURS, 'median_us', 'p95_us')
        return max(1.0 / value for value in values) if values else None
    ours = [row for row in found if (row['method'] == target['baseline'] if target['baseline'] else is_ours(row))]
    if not ours:
        return None
    if kind in ('growth', 'node growth'):
        by_accuracy, column = sorted(ours, key=lambda row: row['parameter']), 'median_us' if kind == 'growth' else 'nodes'
        return float(by_accuracy[-1][column]) / float(by_accuracy[0][column])
    if kind in ('exponent', 'error exponent'):
        column = 'median_us' if kind == 'exponent' else 'error'
        return max(exponent([row for row in ours if row['workload'] == name], column) for name in {row['workload'] for row in ours})
    if kind in ('microseconds', 'p95 microseconds'):
        return max(float(row['median_us' if kind == 'microseconds' else 'p95_us']) for row in ours)
    if kind in ('nodes', 'distance_queries'):
        return max(float(row[kind]) for row in ours)
    if kind == 'error':
        return max(float(row['error']) for row in ours)
    return sum(int(row[kind]) for row in ours)


def judge(value, target):
    """"met", "within slack" or "MISSED"; of microseconds, which say as much about the machine, only whether they are "above"."""
    limit, slack = float(target['limit']), float(target.get('slack') or SLACK.get(target['kind'], 0.0))
    if target['kind'] in AT_LEAST:
        return 'met' if value >= limit else 'within slack' if value * (1.0 + slack) >= limit else 'MISSED'
    if target['kind'].endswith('microseconds'):
        return 'met' if value <= limit else 'above'
    return 'met' if value <= limit else 'within slack' if value <= limit + abs(limit) * slack else 'MISSED'


def judge_all(rows, only=None):
    """A line for each target: judgement, target, figure. A target without rows is missed unless its group was left out, or its
    peer is one that this machine lacks."""
    for target in read_targets():
        if only and target['group'] != '*' and target['group'] not in only:
            continue
        value = figure(rows, target)
        if value is not None:
            yield judge(value, target), target, value
        elif target['baseline'].startswith(PEERS) and any(is_ours(row) for row in matching(rows, target)):
            yield 'not measured', target, None
        else:
            yield 'MISSED', target, None


def asked(target):
    return f"{'at least' if target['kind'] in AT_LEAST else 'at most'} {target['limit']}"


def report(rows, only):
    """Prints a line for each target; the number of those missed beyond their slack."""
    missed = 0
    for verdict, target, value in judge_all(rows, only):
        missed += verdict == 'MISSED'
        shown = 'no rows' if value is None else f'{value:.3g}'
        print(f"{verdict:<12} {target['name']}: {shown} ({target['kind']}, {asked(target)})")
    return missed
