#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How much each model of the scene's bodies settles, and what it costs: rungs.py [--curves N] [--cprox PROGRAM]

N random curves (seed 1) through each scene of test/data with its robot, one answer for each curve and object or link; a line a
scene and verb: how many answers each rung gave, and the median of their times in microseconds. Kept as DIR/rungs.csv it becomes a table of
the pages that `scripts/bench --pages --out DIR` writes.
"""
import argparse
import csv
import os
import random
import statistics
import subprocess
import tempfile

DATA = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'test', 'data')
PANDA, HUSKY, FANUC = (f'{DATA}/robots/{name}/{name}.urdf' for name in ('panda', 'husky', 'fanuc_m10ia'))
SCENES = {'bookshelf_tall': ('mbm/bookshelf_tall_panda/scene0001.yaml', PANDA), 'cage': ('mbm/cage_panda/scene0001.yaml', PANDA),
          'table_pick': ('mbm/table_pick_panda/scene0001.yaml', PANDA),
          'fanuc_bookshelves': ('converted/fanuc_bookshelves.yaml', FANUC), 'husky_table': ('converted/husky_table.yaml', HUSKY)}
VERBS = (('collision',), ('tolerance', '--delta', '0.05'), ('distance', '--epsilon', '1e-6'))
RUNGS = ('sphere', 'hull', 'mesh')


def curves(n, source):
    """Quintics with a ball of 2 cm, within 1.2 m of the scene's origin."""
    for i in range(n):
        points = [f'{source.uniform(-1.2, 1.2):.6f}' for _ in range(18)]
        yield ','.join([str(i), 'bezier', '5', '0', '1', '0.02', '6', *points])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--curves', type=int, default=100)
    parser.add_argument('--cprox', default='cprox')
    arguments = parser.parse_args()
    print('scene,verb,' + ','.join(f'{rung}_answers,{rung}_share,{rung}_median_us' for rung in RUNGS))
    with tempfile.NamedTemporaryFile('w', suffix='.csv') as rows:
        rows.write('\n'.join(curves(arguments.curves, random.Random(1))) + '\n')
        rows.flush()
        for name, (scene, robot) in SCENES.items():
            for verb in VERBS:
                words = [arguments.cprox, *verb, '--per-object', '--curves', rows.name, '--scene', f'{DATA}/scenes/{scene}']
                done = subprocess.run(words + ['--robot', robot], stdout=subprocess.PIPE, check=True, text=True)
                answers = list(csv.DictReader(done.stdout.splitlines()))
                fields = [name, verb[0]]
                for rung in RUNGS:
                    times = [float(row['microseconds']) for row in answers if row['rung'] == rung]
                    fields += [str(len(times)), f'{len(times) / len(answers):.3f}', f'{statistics.median(times):.1f}' if times else '']
                print(','.join(fields), flush=True)


if __name__ == '__main__':
    main()
