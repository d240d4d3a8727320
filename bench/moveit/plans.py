#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What moveit_plans has printed: a summary, or the page of doc/charts with its chart.

    bench/moveit/plans.py moveit_plans.csv                            prints the tables
    bench/moveit/plans.py moveit_plans.csv MOVEIT_VERSION FOLDER [REMARK]
                                                                      writes moveit_plans.md and moveit_plans.png there
"""
import csv
import math
import os
import statistics
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..'))
from pages.figures import table  # noqa: E402

WITHOUT, WITH = 'ompl', 'ompl_certified'
NAMES = {WITHOUT: 'without the adapter', WITH: 'with the adapter'}


def rows_of(path):
    with open(path, newline='') as file:
        return list(csv.DictReader(file))


def times(rows):
    return [float(row['ms']) for row in rows]


def line(robot, rows, pipeline):
    """Of one pipeline: how many plans, how many of them hold, and their times."""
    asked = [row for row in rows if row['pipeline'] == pipeline]
    plans = [row for row in asked if row['plan'] == '1']
    hits = [row for row in plans if int(row['hits']) > 0]
    proven = sum(row['proven'] == '1' for row in plans)
    ms = sorted(times(asked))
    return [robot, NAMES[pipeline], f'{len(plans)} of {len(asked)}', f'{proven} of {len(plans)}', str(len(hits)),
            str(sum(row['proven'] == '1' for row in hits)), f'{statistics.median(ms):.0f}', f'{statistics.mean(ms):.0f}',
            f'{ms[int(0.95 * len(ms))]:.0f}', f'{statistics.mean(float(row["duration"]) for row in plans):.2f}']


def pairs(rows, column):
    """By problem: the times with the adapter to those without, of requests with the same random numbers."""
    ms = {(row['scene'], row['way'], row['round'], row['pipeline']): float(row[column]) for row in rows}
    out = {}
    for scene, way, number, pipeline in ms:
        if pipeline == WITH:
            out.setdefault((scene, way), []).append(ms[scene, way, number, WITH] / ms[scene, way, number, WITHOUT])
    return out


def mean_of_problems(values):
    """Mean and standard error of the problems' means: the plans of one problem are no independent samples."""
    means = [statistics.mean(own) for own in values]
    return statistics.mean(means), statistics.stdev(means) / math.sqrt(len(means))


def added(rows):
    """What a certification takes, in parts of a plan without it: medians."""
    plans = [row for row in rows if row['pipeline'] == WITHOUT and row['plan'] == '1']
    certify = [float(row['certify_ms']) for row in plans]
    return statistics.median(certify), statistics.median(c / float(row['ms']) for c, row in zip(certify, plans))


def robots_of(rows):
    names = list(dict.fromkeys(row['robot'] for row in rows))
    return [(name, [row for row in rows if row['robot'] == name]) for name in names] + [('both', rows)]


def by_first_plan(rows):
    """The rows of pairs whose first plan is proven, and of the others."""
    proven = {(row['robot'], row['scene'], row['way'], row['round']) for row in rows if row['pipeline'] == WITHOUT and row['proven'] == '1'}
    kinds = [[row for row in rows if ((row['robot'], row['scene'], row['way'], row['round']) in proven) == wanted] for wanted in (True, False)]
    return list(zip(('first plan proven', 'first plan not proven'), kinds))


def tables(rows):
    first = table(['robot', 'pipeline', 'plans', 'proven', 'hit by samples', 'of these proven', 'median [ms]', 'mean [ms]', '95 % [ms]', 'mean duration [s]'],
                  [line(robot, own, name) for robot, own in robots_of(rows) for name in (WITHOUT, WITH)])
    lines = []
    for robot, own in robots_of(rows) + by_first_plan(rows):
        certify, part = added(own)
        for column, name in (('cpu_ms', 'processor'), ('ms', 'clock')):
            ratios = pairs(own, column)
            every = [ratio for problem in ratios.values() for ratio in problem]
            mean, error = mean_of_problems(ratios.values())
            log, log_error = mean_of_problems([[math.log(ratio) for ratio in problem] for problem in ratios.values()])
            total = math.fsum(float(row[column]) for row in own if row['pipeline'] == WITH) / math.fsum(float(row[column]) for row in own if row['pipeline'] == WITHOUT)
            lines.append([robot, name, str(len(ratios)), str(len(every)), f'{statistics.median(every):.3f}', f'{math.exp(log):.3f} ± {math.exp(log) * log_error:.3f}',
                          f'{mean:.3f} ± {error:.3f}', f'{total:.2f}', f'{certify:.1f}', f'{100.0 * part:.1f} %'])
    second = table(['robot', 'time', 'problems', 'pairs', 'median ratio', 'geometric mean', 'mean', 'total with / without', 'a certification [ms]', 'of a plan'], lines)
    return first, second


def draw(rows, path):
    import charts
    charts.style()
    figure, axes = charts.plt.subplots()
    for name, colour in ((WITHOUT, charts.OTHERS[3]), (WITH, charts.COLOURS[charts.OURS])):
        ms = sorted(times([row for row in rows if row['pipeline'] == name and row['plan'] == '1']))
        asked = sum(row['pipeline'] == name for row in rows)
        axes.step(ms, [100.0 * (i + 1) / asked for i in range(len(ms))], where='post', color=colour, label=NAMES[name])
    axes.set(xscale='log', xlabel='time of a call of plan_kinematic_path [ms]', ylabel='requests that have a plan [%]', ylim=(0, 101),
             title='move_group with and without curve_proximity/CertifyTrajectory')
    charts.readable(axes.xaxis)
    axes.legend(loc='lower right')
    figure.savefig(path, bbox_inches='tight')


def main():
    rows = rows_of(sys.argv[1])
    first, second = tables(rows)
    if len(sys.argv) == 2:
        print(first, second, sep='\n\n')
        return
    version, out, *remark = sys.argv[2:]
    rounds = len({row['round'] for row in rows})
    moments = sum(int(row['moments'] or 0) for row in rows)
    draw(rows, os.path.join(out, 'moveit_plans.png'))
    with open(os.path.join(out, 'moveit_plans.md'), 'w') as page:
        page.write(f"""# Plans of move_group with and without the adapter

A running move_group of MoveIt {version} with OMPL's RRTConnect and MoveIt's default adapters: one pipeline as it is, one
with `curve_proximity/CertifyTrajectory` besides. Problems of MotionBenchMaker in all seven families, for a Panda and a
UR5 (without its gripper), from start to goal and back. Both pipelines are asked in turn, up to {rounds} times each; the two
requests of a pair have the same random numbers, so that OMPL's first plan is the same.
`scripts/moveit_beside WORKSPACE --plans` makes this page and [moveit_plans.csv](moveit_plans.csv).

Each plan is judged twice: by the capability `curve_proximity/CertifyPath` ("proven"), and by MoveIt's FCL detector at
moments of the spline at most 1e-3 rad apart, {moments} in all ("hit by samples"). MoveIt has called every plan valid.
A plan that is not proven is led round what it hits (`certify_repair_ms` 200); else the adapter may ask for up to 10 plans
(`certify_attempts`), within the 60 s of a request. The duration is that of the motion.
{' '.join(remark)}

{first}

Times are of the whole service call: by the clock, or of the processor in all threads of move_group, which other work on
the machine changes less. A ratio is that of a pair: with the adapter to without. Means are those of the problems' means,
with one standard error. The adapter may add 5 % to the processor's time of all requests: that is what a user waits for.
A certification is a call of the service `certify_path` for a plan of the pipeline without the adapter, by the clock.

{second}

![Time to a plan](moveit_plans.png)
""")


if __name__ == '__main__':
    main()
