#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Robots' meshes beside their hulls: hulls.py [--quick] [--cprox PROGRAM] [--epsilon E]

The least distance along every trajectory of test/data/reference/expected_hull_model.json, environment and self, once with every mesh as its convex
hull and once with the meshes themselves; a line each, distances in metres, times in microseconds (medians of three runs,
--quick: of one). `scripts/bench` keeps it as DIR/hulls.csv, and writes the page hulls.md from it.
"""
import argparse
import csv
import json
import os
import statistics
import subprocess
import sys

DATA = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'test', 'data')
LODS = ('hull', 'mesh')
ASKED = ('lower', 'upper', 'a', 'b', 'lod', 'microseconds')


def answers(program, epsilon, case, lod, repeats):
    """The rows of one trajectory by kind, with the median of their times."""
    name = os.path.basename(case['trajectory'])
    words = [program, 'distance', '--robot', f"{DATA}/{case['robot']}", '--scene', f"{DATA}/{case['scene']}", '--self', '--epsilon', epsilon,
             '--max-lod', lod, '--trajectory', f'{DATA}/trajectories/{name}']
    if case.get('srdf'):
        words += ['--srdf', f"{DATA}/{case['srdf']}"]
    runs = [subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True, text=True).stdout for _ in range(repeats)]
    rows = [{row['kind']: row for row in csv.DictReader(run.splitlines())} for run in runs]
    for kind, row in rows[0].items():
        row['microseconds'] = statistics.median(float(other[kind]['microseconds']) for other in rows)
    return rows[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--quick', action='store_true', help='one run of each')
    parser.add_argument('--cprox', default='cprox')
    parser.add_argument('--epsilon', default='1e-6')
    arguments = parser.parse_args()
    with open(os.path.join(DATA, 'reference', 'expected_hull_model.json')) as text:
        cases = json.load(text)['cases']
    out = csv.writer(sys.stdout, lineterminator='\n')
    out.writerow(['trajectory', 'kind', 'reference_lower', 'reference_upper', *(f'{lod}_{column}' for lod in LODS for column in ASKED)])
    for case in cases:
        found = {lod: answers(arguments.cprox, arguments.epsilon, case, lod, 1 if arguments.quick else 3) for lod in LODS}
        name = os.path.splitext(os.path.basename(case['trajectory']))[0]
        for expected in case['results']:
            kind = expected['kind']
            out.writerow([name, kind, expected['lower'], expected['upper'], *(found[lod][kind][column] for lod in LODS for column in ASKED)])
        sys.stdout.flush()


if __name__ == '__main__':
    main()
