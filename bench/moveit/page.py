#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the page of doc/charts about MoveIt's collision detectors.

    bench/moveit/page.py moveit.csv moveit_costs.csv MOVEIT_VERSION > moveit.md
"""
import csv
import math
import statistics
import sys

QUERIES = {
    'state': ('One state: self and world, verdict', 'differs from ours'),
    'distance': ('One state: distance to the world', 'differs by more than 1e-4 m'),
    'segment': ('The straight motion between two states, against the world: verdict', 'differs from ours'),
}


def rows_of(path):
    with open(path, newline='') as file:
        return list(csv.DictReader(file))


def table(rows, query):
    """A line a method: over the scenes."""
    title, differs = QUERIES[query]
    rows = [row for row in rows if row['query'] == query]
    ours = {row['scene']: float(row['median_us']) for row in rows if row['method'] == 'curve_proximity'}
    lines = [f'## {title}', '', f'| detector | cases | hits | {differs} | median time [us] | time / ours |'
             + (' too large by at most [m] |' if query == 'distance' else ''),
             '|---|---|---|---|---|---|' + ('---|' if query == 'distance' else '')]
    for method in dict.fromkeys(row['method'] for row in rows):
        own = [row for row in rows if row['method'] == method]
        times = [float(row['median_us']) for row in own]
        ratio = math.exp(statistics.mean(math.log(float(row['median_us']) / ours[row['scene']]) for row in own))
        line = [method, sum(int(row['cases']) for row in own), sum(int(row['hits']) for row in own),
                sum(int(row['differs']) for row in own), f'{statistics.median(times):.1f}', f'{ratio:.2f}']
        if query == 'distance':
            line.append(f"{max(float(row['error']) for row in own):.1g}")
        lines.append('| ' + ' | '.join(map(str, line)) + ' |')
    return lines + ['']


def main():
    rows, costs, version = rows_of(sys.argv[1]), rows_of(sys.argv[2]), sys.argv[3]
    scenes = len({row['scene'] for row in rows})
    print(f'''# MoveIt's collision detectors

MoveIt {version}'s FCL and Bullet detectors and ours, each inside its own `CollisionEnv`, in one process: a Panda with
its meshes in {scenes} scenes of MotionBenchMaker. `scripts/moveit_beside` makes this page and [moveit.csv](moveit.csv).
Half of the states are random, half lie beside a planned path. Times are the median over scenes of each scene's median;
ratios are geometric means over the scenes.
''')
    for query in QUERIES:
        print('\n'.join(table(rows, query)))
    print('''FCL answers a motion at states .05 rad apart, as MoveIt's planners do. Bullet casts the convex hull of each link from
its first to its last pose: rotations between them are not swept. Ours is certified for the whole motion.

## After one change of the scene

Ours alone, a Panda: the first question, the median of 31 more, and that of 31 after one change each, in milliseconds of
the processor ([moveit_costs.csv](moveit_costs.csv)). Leaves are occupied cells. Where they are apart,
no cell touches another one, and each has a parent of its own: that is the largest tree. Between two plans beside an
octomap 110 ms pass.

| question; what changes | first [ms] | again [ms] | after a change [ms] |
|---|---|---|---|''')
    for row in costs:
        print(f"| {row['what']} | {float(row['first_ms']):.2f} | {float(row['again_ms']):.3f} | {float(row['changed_ms']):.3f} |")


if __name__ == '__main__':
    main()
