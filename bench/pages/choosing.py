# SPDX-License-Identifier: BSD-3-Clause
"""choosing.md: which method, which epsilon, which query, for which scene; every number from results.csv."""
import statistics

import targets
from pages.figures import OURS, microseconds, picture, short, table

ENTRIES = [
    ['a planner in C or C++', '`curve_proximity/cprox.h`, `core.hpp`, `motion.hpp`', 'no copy, no lock; [c-api.md](../c-api.md)'],
    ['scripts, learning, plots', 'Python `cprox`, no ROS', 'NumPy arrays, batches on all cores; [python.md](../python.md)'],
    ['files, datasets, reviews', 'the command line `cprox`', 'CSV, certificates, a report page; [command-line.md](../command-line.md)'],
    ['a robot that runs', 'the node or nodelet', 'scene and joints by topic, services, gate; [ros.md](../ros.md)'],
    ['MoveIt', "the node on move_group's scene", '[moveit.md](../moveit.md)'],
    ['an optimiser', 'a constraint provider', 'value and gradient; [constraint-providers.md](../constraint-providers.md)'],
]


# How many verdicts a row of results.csv sums up: bench/batches.c has 3 scenes of 1000 curves, bench/robots.c the answers of
# test/data/motion/cases.txt above 0.
BATCH_VERDICTS = 3000
ROBOT_PROBLEMS = 39


def superquadric_pairs(figures):
    """Our time over the pairs of objects, and that of a general solver where it was measured: medians over the pairs, and its failures."""
    rows = [row for row in figures.rows if (row['group'], row['workload']) == ('implicit', 'table I')]
    ours = [float(row['median_us']) for row in rows if row['method'] == targets.OURS]
    said = f'A pair takes {microseconds(statistics.median(ours))} (median over the {len(ours)} pairs of objects of [seeds.md](seeds.md)).'
    ratios = targets.ratios(rows, 'ipopt')
    if not ratios:
        return said
    failures = sum(int(row['failures']) for row in rows if row['method'] == 'ipopt')
    return (f'{said}\n  Ipopt, a general interior-point solver, takes {short(statistics.median(ratios))} times as long '
            f'(median over the same pairs; the least is {short(min(ratios))}). It fails in {failures} of the cases (200 a pair in a full run), ours in '
            f"{sum(int(row['failures']) for row in rows if row['method'] == targets.OURS)}.")


def page(figures, out):
    polytope, order = 'polytope 3-D distance', 'order 15 eps '
    loose, tight = (figures.time('curves', polytope, order + e) for e in ('1e-02', '1e-10'))
    growth = short(figures.number('curves', polytope, order + '1e-14') / figures.number('curves', polytope, order + '1e-02'))
    clear = figures.time('curves', 'polytope 3-D tolerance clear', 'order 15 delta 0.50 d')
    near = figures.time('curves', 'polytope 3-D tolerance clear', 'order 15 delta 0.99 d')
    distance = figures.time('curves', polytope, order + '1e-06')
    batch = ('batches', 'boxes {}', '100 obstacles')
    tolerance_batch, distance_batch = (figures.time(batch[0], batch[1].format(query_type), batch[2]) for query_type in ('tolerance', 'distance'))
    missed = figures.row('batches', 'boxes collision', '100 obstacles', 'FCL at 100 points')['unsound']
    robot = figures.time('robots', 'environment', 'epsilon 1e-06')
    robot_loose = figures.time('robots', 'environment', 'epsilon 0.001')
    robot_clear, robot_near = (figures.time('robots', 'tolerance', f'delta {part} D') for part in ('0.5', '0.99'))
    sampled = figures.row('robots', 'tolerance', 'delta 1.01 D', 'sampling .05')['unsound']
    superquadrics = superquadric_pairs(figures)
    few, many = (figures.time('worlds', 'set distance', f'targets {n}') for n in (10, 10000))
    proofs = [[name, *(figures.time('certificates', workload, 'delta 0.9 d', method=method) for method in (OURS, f'{OURS} with certificate', 'cprox_check'))]
              for name, workload in (('curve and polytope', 'Bezier and polytope'), ('robot along a trajectory', 'robot trajectory'))]
    return f'''# Choosing

A guide of five minutes for motion planning. All times are medians over the problems of a group, of one run ([README.md](README.md) says of which), on one core; what
counts is how they relate.

## Which entry
{table(['for', 'take', 'because'], ENTRIES)}

## Which query
- **Only "is it farther than Δ?"**: ask `tolerance`. Against a 3-D polytope, for a curve of order 15, it takes {clear} when Δ is half of the distance, {near} when it is
  99 % of it; the distance itself to 1e-6 takes {distance}. The farther Δ is from the distance, the cheaper.
- **Only "does it hit?"**: ask `collision`: a tolerance with Δ = 0.
- **When does it hit?** `cprox_time_of_contact`: never late.
- **How close, where, and in which direction?** `distance`.
- **A gradient for an optimiser?** A constraint provider: by curve distance where curves are what you optimise, by superquadrics where the gradient must be smooth
  between bodies, by Fourier gaps where bodies may overlap and must be pushed apart.

## Which epsilon
An answer to 1e-2 m takes {loose}, to 1e-10 m {tight}; to 1e-14 it takes {growth} times what 1e-2 takes. A smaller ε costs almost nothing for
curves. Keep the default of 1e-6 m.

{picture(out, 'work_precision_polytope', 'Time against accuracy: curves of order 15 against polytopes')}

## Robots
Arms along joint splines against a scene take {robot_loose} for the distance to 1e-3, {robot} to 1e-6 (medians over the reference cases). The verdict "farther than Δ"
takes {robot_clear} where Δ is half of the distance, {robot_near} where it is 99 % of it. States every .05 rad gave {sampled} wrong verdicts of {ROBOT_PROBLEMS} where Δ is
1 % above the distance. Ask for the distance only if you need the number.

{picture(out, 'robots_verdicts', 'Verdicts of arms along joint splines over delta')}

## Which model
- Boxes, spheres, capsules, cylinders, cones, polytopes: give them as they are; they are closed forms or support functions.
- Meshes: leave them meshes. Their hull answers first, the triangles only where the hull cannot decide (`max_lod` stops at the hull).
- Superquadrics and implicit bodies: certified to 1e-8. {superquadrics}
- What a sensor sees: point clouds and octrees, rebuilt at sensor rate.
- Many obstacles: one set of them, not a loop. A curve's distance to 10 boxes takes {few}, to 10,000 of the same density {many}.

## One or many
A batch of a thousand quintics against a hundred boxes takes {tolerance_batch} for all tolerances, {distance_batch} for all distances. Sampling a hundred points of each
curve gave {missed} wrong verdicts of {BATCH_VERDICTS} about the same collisions: three scenes of a thousand curves. No ε makes up for that.

{picture(out, 'batches_rate_collision', 'Collision verdicts a second over the number of obstacles')}

## A certificate?
Take one where somebody else must believe the answer: `cprox_check` proves it again by arithmetic of its own. It costs, at Δ = 90 % of the distance (medians):

{table(['', 'the verdict', 'with its certificate', 'the check'], proofs)}

## Where others are faster
[speed.md](speed.md) goes through the queries one by one.

- Whether two boxes or cylinders that overlap by little touch, and whether meshes of 20,000 triangles cross: FCL, which bounds no rounding.
- The same pair of boxes or capsules again and again, a little moved: coal with its cached guess, to 1e-6 and without a bound.
- First contacts of two convex bodies at constant speed: the casts of Bullet and FCL, some of which are late or miss ([contacts.md](contacts.md)).
- The nearest point of a cubic to a point: SISL, without a bound.

## When an answer is not `ok`
`undecided` means within ε of the limit: count it as unsafe, or ask for a smaller ε. `budget` means that the interval is true but wide: a continuum of nearest points (an
arc about a point at its centre) does that; raise `max_nodes` only if you need the width. `precision` means that double arithmetic ends there.
'''
