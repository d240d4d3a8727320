#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Proven link pairs beside random states: which pairs can touch and are never seen to, so that sampling disables them.

    scripts/run bench/link_samples.py [--samples N] [--seed S] [--out FILE]

Writes a table, doc/charts/link_pairs.md by default. MoveIt's setup assistant draws 10,000 states. Each joint is drawn evenly within
its limits, a continuous one within a turn. Adjacent links are left out. Whether links touch at a state is another query than that over the limits
(Motion.nearest_pairs() of a motion of one state)."""
import argparse
import math
import os
import random
import tempfile

import cprox
import errors

HERE = os.path.dirname(os.path.abspath(__file__))
PANDA = os.path.join(errors.ROBOTS, 'panda', 'panda.urdf')


def two_pandas(folder):
    """The file of two Pandas .7 m apart."""
    path = os.path.join(folder, 'two_pandas.urdf')
    with open(path, 'w', encoding='utf-8') as out:
        out.write(errors.mounted('<robot name="two_pandas"><link name="table"/></robot>', 'table',
                                 (('left', 'panda/panda.urdf', '0 0.35 0'), ('right', 'panda/panda.urdf', '0 -0.35 0'))))
    return path


def drawn(robot, rng):
    out = []
    for name in robot.variables:
        low, high = robot.limits[name]
        out.append(rng.uniform(low, high) if math.isfinite(low) and math.isfinite(high) else rng.uniform(-math.pi, math.pi))
    return out


def row_of(name, path, samples, seed):
    robot, rng = cprox.Robot.from_urdf(path), random.Random(seed)
    scene, proven, adjacent = cprox.Scene(robot), {}, set()
    for pair in robot.collision_matrix():
        if pair['adjacent']:
            adjacent.add(frozenset((pair['a'], pair['b'])))
        proven.setdefault(pair['contact'], set()).add(frozenset((pair['a'], pair['b'])))
    seen = set()
    for _ in range(samples):
        state = cprox.Motion(scene, robot.variables, [0.0], [drawn(robot, rng)])
        for pair in state.nearest_pairs(k=1000, within=0.0, self_collision=True, allow_empty=True):
            if pair['result'].upper <= 0.0:
                seen.add(frozenset((pair['a'], pair['b'])))
    contradictions = len(seen & proven.get('never', set()))
    missed = sorted(' and '.join(sorted(pair)) for pair in proven.get('possible', set()) - seen - adjacent)
    counts = [len(proven.get(which, ())) for which in ('never', 'possible', 'always', 'undecided')]
    print(name, counts, len(seen), contradictions, missed, flush=True)
    return f"| {name} | {' | '.join(map(str, counts))} | {contradictions} | {len(missed)}{': ' if missed else ''}{', '.join(missed)} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--samples', type=int, default=10000)
    parser.add_argument('--seed', type=int, default=4611)
    parser.add_argument('--only', help='the robot of this name')
    parser.add_argument('--out', default=os.path.join(os.path.dirname(HERE), 'doc', 'charts', 'link_pairs.md'))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        robots = (('Panda', PANDA), ('UR5', os.path.join(errors.ROBOTS, 'ur5', 'ur5.urdf')),
                  ('Fanuc M-10iA', os.path.join(errors.ROBOTS, 'fanuc_m10ia', 'fanuc_m10ia.urdf')), ('two Pandas', two_pandas(folder)))
        rows = [row_of(name, path, arguments.samples, arguments.seed) for name, path in robots
                if not arguments.only or arguments.only == name]
    with open(arguments.out, 'w', encoding='utf-8') as out:
        out.write(f"""# Link pairs: proven, and by {arguments.samples} random states

`bench/link_samples.py --samples {arguments.samples} --seed {arguments.seed}` writes this page. See
[collision-matrix.md](../collision-matrix.md).

| robot | never | possible | always | undecided | never, but seen to touch | possible and not adjacent, but not seen to touch |
|---|---|---|---|---|---|---|
""" + '\n'.join(rows) + '\n')


if __name__ == '__main__':
    main()
