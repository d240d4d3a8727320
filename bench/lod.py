#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The group `lod`: how much each model of the scene's bodies settles, and what it costs: lod.py [--quick] [--cprox PROGRAM]

Random curves (seed 1) through each scene of test/data with its robot, one answer for each curve and object or link. A row a scene, query and
level of detail: `nodes` is the number of answers that the level of detail gave, `distance queries` that of all, the times are those of its answers.
"""
import argparse
import csv
import os
import random
import subprocess
import tempfile

DATA = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'test', 'data')
PANDA, HUSKY, FANUC = (f'{DATA}/robots/{name}/{name}.urdf' for name in ('panda', 'husky', 'fanuc_m10ia'))
SCENES = {'bookshelf_tall': ('mbm/bookshelf_tall_panda/scene0001.yaml', PANDA), 'cage': ('mbm/cage_panda/scene0001.yaml', PANDA),
          'table_pick': ('mbm/table_pick_panda/scene0001.yaml', PANDA),
          'fanuc_bookshelves': ('converted/fanuc_bookshelves.yaml', FANUC), 'husky_table': ('converted/husky_table.yaml', HUSKY)}
QUERY_TYPES = (('collision',), ('tolerance', '--delta', '0.05'), ('distance', '--epsilon', '1e-6'))
LODS = ('sphere', 'hull', 'mesh')
VERDICTS = (0, 1, 3)  # the exit codes of cprox where every row is answered: clear, violated, undecided


def curves(n, source):
    """Quintics with a ball of 2 cm, within 1.2 m of the scene's origin."""
    for i in range(n):
        points = [f'{source.uniform(-1.2, 1.2):.6f}' for _ in range(18)]
        yield ','.join([str(i), 'bezier', '5', '0', '1', '0.02', '6', *points])


def answers_of(cprox, query_type, rows, scene, robot):
    """What the command line says of each curve and object or link, and how many of them failed."""
    words = [cprox, *query_type, '--per-object', '--curves', rows, '--scene', f'{DATA}/scenes/{scene}', '--robot', robot]
    done = subprocess.run(words, stdout=subprocess.PIPE, text=True)
    if done.returncode not in VERDICTS:
        raise subprocess.CalledProcessError(done.returncode, words)
    answers = list(csv.DictReader(done.stdout.splitlines()))
    return answers, sum(row['status'] not in ('ok', 'undecided') for row in answers)


def quantile(values, q):
    return f'{sorted(values)[int(q * (len(values) - 1) + 0.5)]:.4g}' if values else ''


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--quick', action='store_true', help='fewer curves')
    parser.add_argument('--cprox', default='cprox')
    arguments = parser.parse_args()
    with tempfile.NamedTemporaryFile('w', suffix='.csv') as rows:
        rows.write('\n'.join(curves(20 if arguments.quick else 100, random.Random(1))) + '\n')
        rows.flush()
        for name, (scene, robot) in SCENES.items():
            for query_type in QUERY_TYPES:
                answers, failed = answers_of(arguments.cprox, query_type, rows.name, scene, robot)
                for lod in LODS:
                    times = [float(row['microseconds']) for row in answers if row['lod'] == lod]
                    print(f'lod,{name} {query_type[0]},curve_proximity {lod},{lod},{quantile(times, 0.5)},{quantile(times, 0.95)},'
                          f'{len(times)},{len(answers)},,0,{failed if lod == LODS[0] else 0}', flush=True)


if __name__ == '__main__':
    main()
