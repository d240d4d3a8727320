# SPDX-License-Identifier: BSD-3-Clause
"""README.md of a folder of results: how they were made, targets, growth, where others are faster, what each chart shows."""
import csv
import fnmatch
import os
import re

import passes
import repeat
import targets
from pages.figures import microseconds, short, table

HERE = os.path.dirname(os.path.abspath(__file__))

CHARTS = [
    ('work_precision_*', 'time against the accuracy asked: a point, a polygon, a polytope, another curve, long splines, trigonometric series; beside the '
                         'published method, points of the curve (by FCL where a polytope is asked about), OpenCASCADE and SISL'),
    ('distance_by_order', 'the same queries over orders 5, 15, 45'),
    ('tolerance', 'verdicts over delta, as a fraction of the distance'),
    ('splines_*', 'long B-splines: time against the number of segments'),
    ('trigonometric', 'series that are compiled once, distance and tolerance'),
    ('peers_*', 'curves and paths beside OpenCASCADE, SISL, FCL and Bullet, those that are installed'),
    ('batches*', 'a thousand quintics against 2, 50 and 100 obstacles, beside sampling by FCL, and over threads'),
    ('robots_*', 'arms along joint splines, against the scene and themselves, beside the bound by both ends of an interval and samples; verdicts; '
                 "checks of states by FCL, and MoveIt's own figures for reference"),
    ('worlds_*', 'meshes, point clouds, octree leaves, sets of bodies, beside FCL'),
    ('implicit_*', 'pairs of implicit bodies: interior point, support functions, both together, a general solver'),
    ('fourier_*', 'over-reach of gap functions by kernel and n, what verdicts are worth in space, and what it costs; gradients; an SE(2) obstacle, '
     'convergence, value, terms and gradient along a ray, boxes, nesting, planning problems from random starts'),
]


def reasons():
    with open(os.path.join(HERE, 'losses.csv'), newline='') as text:
        return list(csv.DictReader(line for line in text if not line.startswith('#')))


UNKNOWN = 'Not explained yet.'


def reason_for(name, known):
    return next((line['why'] for line in known if fnmatch.fnmatchcase(name, line['pattern'])), UNKNOWN)


def target_lines(rows, of_passes):
    for verdict, target, value in targets.judge_all(rows):
        verdict, shown = ('not measured', '') if value is None else (verdict, f'{value:.3g}')
        yield [verdict, target['name'], shown, repeat.spread_text(target, passes.spread_of(target, of_passes)), targets.asked(target),
               target['kind'] + (f" to {target['baseline']}" if target['baseline'] else '')]


# What grows: group and workload (fnmatch), and what is fitted: time, or memory, whose rows count bytes, of all or of each element.
GROWTH = [('implicit', 'figure 2*', 'time'), ('splines', 'B-spline * distance', 'time'), ('batches', 'boxes *', 'time'),
          ('worlds', 'mesh distance', 'time'), ('worlds', 'set distance', 'time'), ('worlds', 'build mesh', 'time'),
          ('worlds', 'build mesh', 'memory each'), ('worlds', 'build points', 'memory each'), ('*', 'growth*', 'time'),
          ('*', 'memory*', 'memory')]


def sized(row, what):
    """The row with what is to be fitted in the place of its time; None where it has nothing of it, or counts nothing (growth distances)."""
    if not re.search(r'\d', row['parameter']):
        return None
    value = float((row['median_us'] if what == 'time' else row['nodes']) or 'nan')
    if what == 'memory each':
        value *= targets.size_of(row)
    return dict(row, median_us=str(value)) if value > 0.0 else None


def growth_lines(rows):
    """Every workload of the list whose parameters count something, three of them at least: its fitted exponent."""
    for group, workload, what in GROWTH:
        found = {}
        for row in rows:
            if fnmatch.fnmatchcase(row['group'], group) and fnmatch.fnmatchcase(row['workload'], workload) and sized(row, what):
                found.setdefault((row['group'], row['workload'], row['method']), []).append(sized(row, what))
        for (own, name, method), of in sorted(found.items()):
            if len({targets.size_of(row) for row in of}) >= (2 if 'threads' in name else 3):
                yield [own, name, method, what.split()[0], ', '.join(f'{targets.size_of(row):g}' for row in of), f'{targets.exponent(of):.2f}']


def losses(rows):
    """Workloads in which another method is faster than ours in the geometric mean, and by how much."""
    for group, workload in dict.fromkeys((row['group'], row['workload']) for row in rows):
        of = [row for row in rows if (row['group'], row['workload']) == (group, workload)]
        for method in dict.fromkeys(row['method'] for row in of):
            if targets.is_ours({'method': method}):
                continue
            values = targets.ratios(of, method)
            mean = targets.geometric_mean(values) if values else 1.0
            if mean < 0.95:
                yield group, workload, method, mean


def loss_lines(rows):
    known = reasons()
    for verdict, target, value in targets.judge_all(rows):
        why = reason_for(target['name'], known)
        if verdict == 'MISSED' and value is not None or verdict in ('within slack', 'above') and why != UNKNOWN:
            yield f"- **{target['name']}** ({verdict.lower()}). {why}"
    for group, workload, method, ratio in losses(rows):
        name = f'{group}/{workload}/{method}'
        yield f'- {group}, {workload}: **{method}** takes {short(ratio)} of our time. {reason_for(name, known)}'


def lods(rows):
    """What each model of a body settled."""
    found = {}
    for row in rows:
        if row['group'] == 'lod':
            found.setdefault(row['workload'], {})[row['parameter']] = row
    if not found:
        return ''
    kinds = ('sphere', 'hull', 'mesh')
    body = [[*name.rsplit(' ', 1), *(cell for kind in kinds for cell in (f"{100.0 * float(of[kind]['nodes']) / float(of[kind]['distance_queries']):.0f} %",
             microseconds(float(of[kind]['median_us'])) if of[kind]['median_us'] else ''))] for name, of in found.items()]
    return f'''
## What each model settles
Curves through scenes, an answer for each object and link (`bench/lod.py`): the share of the answers that each level of detail gave, and the
median of what they cost. A distance to 1e-6 is the mesh's own wherever the nearest body is one; verdicts seldom need it.

{table(['scene', 'query_type', *(word for kind in kinds for word in (kind, 'cost'))], body)}
'''


def second_run(out):
    return f'[{repeat.PAGE}]({repeat.PAGE}) holds a second run against this one.' if os.path.exists(os.path.join(out, repeat.PAGE)) else ''


def gallery(drawn):
    """What charts show, and the charts; those of the papers and of motions made smooth have pages of their own."""
    for pattern, text in CHARTS:
        names = [name for name in drawn if fnmatch.fnmatchcase(name, pattern)]
        if names:
            yield '\n\n'.join([f'**{text[0].upper()}{text[1:]}**', *(f'![{name.replace("_", " ")}]({name}.png)' for name in names)])


def page(figures, drawn, made, out):
    of_passes = passes.read_spread(out)
    return f'''# Charts

{made}

Trust ratios and counts, not microseconds. `results.csv` has every row. [choosing.md](choosing.md) says what follows from them for a planner,
[seeds.md](seeds.md) has the papers' own tables, [stability.md](stability.md) hard inputs: right, wrong, given up,
[hulls.md](hulls.md) robots' meshes beside their hulls, [optimise.md](optimise.md) motions of an arm made smooth and clear,
[contacts.md](contacts.md) first contacts beside Bullet and FCL, [pairs.md](pairs.md) and [peers.md](peers.md) standing pairs beside FCL and coal,
[speed.md](speed.md) goes through the queries beside the fastest.

[All charts](#all-charts), [targets](#targets), [growth](#growth), [where we lose](#where-we-lose).

## Targets
`bench/targets.csv`, held against this run, whose figures are the medians of {len(next(iter(of_passes.values()), [0]))} passes in fresh processes. The spread is what two runs
on the same machine may differ by: what the passes differ by (`spread.csv`), at least 20 % (exponents 0.1, tails 50 %). What is missed by no
more than that least is "within slack". {second_run(out)}

{table(['', 'target', 'figure', 'spread', 'asked', 'kind'], list(target_lines(figures.rows, of_passes)))}

## Growth
Time or memory against size: the exponent of a power, fitted by least squares to the logarithms. 1 is in proportion, 0 is not at all.

{table(['group', 'workload', 'method', 'of', 'sizes', 'exponent'], list(growth_lines(figures.rows)))}
{lods(figures.rows)}
## Where we lose
{chr(10).join(loss_lines(figures.rows)) or 'Nowhere in this run.'}

## All charts

{chr(10).join(f'{part}{chr(10)}' for part in gallery(drawn))}'''
