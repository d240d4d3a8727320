#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What moveit_detectors has printed: a summary, or the page of doc/charts with its chart.

    bench/moveit/detectors.py moveit_detectors.csv                        prints the tables
    bench/moveit/detectors.py moveit_detectors.csv MOVEIT_VERSION FOLDER [REMARK]
                                                                          writes moveit_detectors.md and .png there
"""
import csv
import math
import os
import statistics
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..'))
from pages.figures import table  # noqa: E402

NAMES = {'fcl': "states by FCL's detector", 'ours': 'states by ours', 'proven': 'proven edges'}


def problem(row):
    return row['robot'], row['scene'], row['way'], row['round']


def line(robot, rows, edges):
    """Of one way to check edges: plans, whether they hold, and their times."""
    asked = [row for row in rows if row['edges'] == edges]
    plans = [row for row in asked if row['plan'] == '1']
    valid = [row for row in plans if row['valid'] == '1']
    ms = [float(row['cpu_ms']) for row in asked]
    by_fcl = {problem(row): float(row['cpu_ms']) for row in rows if row['edges'] == 'fcl'}
    ratios = [float(row['cpu_ms']) / by_fcl[problem(row)] for row in asked]
    return [robot, NAMES[edges], f'{len(plans)} of {len(asked)}', str(len(valid)),
            str(sum(int(row['hits']) > 0 for row in valid)), str(sum(row['proven'] == '0' for row in valid)),
            f'{statistics.median(ms):.0f}', f'{statistics.mean(ms):.0f}', f'{statistics.median(ratios):.2f}',
            f'{math.exp(statistics.mean(math.log(ratio) for ratio in ratios)):.2f}']


def tables(rows):
    head = ['robot', 'edges', 'plans', 'valid for MoveIt', 'of these hit by samples', 'of these not proven',
            'median [ms]', 'mean [ms]', 'median ratio', 'geometric mean']
    groups = [(robot, [row for row in rows if row['robot'].startswith(robot)]) for robot in ('panda', 'ur5')]
    groups = [(robot, own) for robot, own in groups if own] + [('both', rows)]
    return table(head, [line(robot, own, edges) for robot, own in groups for edges in NAMES])


def families(rows):
    """By family of problems: plans and the median time of each way."""
    head = ['family'] + [f'{name}: {what}' for name in NAMES.values() for what in ('plans', 'median [ms]')]
    out = []
    names = sorted({row['scene'].split('/')[0].rsplit('_', 1)[0] for row in rows})
    for name in names:
        cells = [name.replace('_', ' ')]
        for edges in NAMES:
            own = [row for row in rows if row['edges'] == edges and row['scene'].startswith(name + '_')]
            cells.append(f"{sum(row['plan'] == '1' for row in own)} of {len(own)}")
            cells.append(f"{statistics.median(float(row['cpu_ms']) for row in own):.0f}")
        out.append(cells)
    return table(head, out)


def page(rows, version, remark):
    states = sum(int(row['states'] or 0) for row in rows)
    return f'''# Plans by MoveIt's detectors, and by proven edges

OMPL's RRTConnect in MoveIt {version}'s OMPL interface, in one process: edges checked by states with MoveIt's FCL
detector, by states with ours, and proven whole in OMPL's motion validator (ours for single states). Problems of
MotionBenchMaker in all seven families, from start to goal and back; all three get the same random numbers.
`scripts/moveit_beside WORKSPACE --plans` makes this page and [moveit_detectors.csv](moveit_detectors.csv).

Each plan is the polyline that the planner leaves. "Valid for MoveIt" is its own check of the path. "Hit by samples":
FCL finds a contact at states at most 1e-3 rad apart, {states} in all. "Not proven": an edge of it is not proven by us.
Times are of the processor; a ratio is that to FCL's states with the same random numbers. Times without a plan count.
{remark}

{tables(rows)}

{families(rows)}

![Time to a plan](moveit_detectors.png)
'''


def draw(rows, path):
    import charts
    charts.style()
    figure, axes = charts.plt.subplots()
    for edges, name in NAMES.items():
        ms = sorted(float(row['cpu_ms']) for row in rows if row['edges'] == edges and row['plan'] == '1')
        asked = sum(row['edges'] == edges for row in rows)
        axes.step(ms, [(i + 1) / asked for i in range(len(ms))], where='post', label=name)
    axes.set_xscale('log')
    axes.set_xlabel('time of the processor [ms]')
    axes.set_ylabel('problems with a plan')
    axes.legend()
    figure.savefig(path, bbox_inches='tight')


def main():
    with open(sys.argv[1], newline='') as file:
        rows = list(csv.DictReader(file))
    if len(sys.argv) < 4:
        print(tables(rows) + '\n\n' + families(rows))
        return
    version, folder, *remark = sys.argv[2:]
    with open(os.path.join(folder, 'moveit_detectors.md'), 'w') as out:
        out.write(page(rows, version, ' '.join(remark)))
    draw(rows, os.path.join(folder, 'moveit_detectors.png'))


if __name__ == '__main__':
    main()
