#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Certified clearance of all executions beside sampled executions, of the Panda's saved motions. It needs cprox alone:
/usr/bin/python3 bench/robust_executions.py --cprox PROGRAM [--samples N] [--seed S] [--out FOLDER] writes robust_executions.png and
robust_band.png into doc/charts and prints a table. Each joint is off by a constant of at most TRACKING, most often by all of it."""
import argparse
import copy
import csv
import io
import json
import os
import random
import subprocess
import sys
import tempfile

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import yaml  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(os.path.dirname(HERE), 'test', 'data')
PANDA = os.path.join(DATA, 'robots', 'panda')
TRACKING = 0.005  # rad
BAND = 'panda_bookshelf_small_0001_rrt'
BLUE, ORANGE, GREY, RED = '#2b6cb0', '#dd7711', '#888888', '#c53030'


def run(program, *words, codes=(0, 1, 3)):
    done = subprocess.run([program, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode not in codes:
        sys.exit(f'{" ".join(words)}: {done.stderr}')
    return list(csv.DictReader(io.StringIO(done.stdout)))


def off(trajectory, rng):
    """An execution: each joint is off by a constant all the way."""
    out = copy.deepcopy(trajectory)
    error = [TRACKING * (rng.choice((-1, 1)) if rng.random() < 0.8 else rng.uniform(-1, 1))
             for _ in out['joint_trajectory']['joint_names']]
    for point in out['joint_trajectory']['points']:
        point['positions'] = [q + e for q, e in zip(point['positions'], error)]
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--cprox', required=True)
    parser.add_argument('--samples', type=int, default=200)
    parser.add_argument('--seed', type=int, default=4610)
    parser.add_argument('--out', default=os.path.join(os.path.dirname(HERE), 'doc', 'charts'))
    arguments = parser.parse_args()
    rng = random.Random(arguments.seed)
    folder = tempfile.TemporaryDirectory(prefix='cprox-executions-')
    errors = os.path.join(folder.name, 'errors.yaml')
    with open(errors, 'w', encoding='ascii') as file:
        file.write(f'every_joint: {{tracking: {TRACKING}}}\n')

    # all executions at once, and the motion itself
    motions, certified, rows = {}, {}, []
    for name in sorted(os.listdir(os.path.join(DATA, 'trajectories'))):
        path = os.path.join(DATA, 'trajectories', name)
        with open(path, encoding='utf-8') as file:
            trajectory = yaml.safe_load(file)
        if not trajectory['robot'].startswith('robots/panda/'):
            continue
        name = name[:-len('.yaml')]
        scene = os.path.join(DATA, trajectory.pop('scene'))
        words = ['--robot', os.path.join(PANDA, 'panda.urdf'), '--srdf', os.path.join(PANDA, 'panda.srdf'), '--scene', scene,
                 '--trajectory', path, '--quiet']
        trajectory.pop('robot')
        motions[name] = (words, trajectory)
        certified[name] = float(run(arguments.cprox, 'profile', '--errors', errors, '--intervals', '1', *words)[0]['lower'])
        row = {'robot': words[1], 'srdf': words[3], 'scene': scene, 'query': 'distance'}
        rows.append(dict(row, id=f'{name}/itself', trajectory=trajectory))
        rows += [dict(row, id=f'{name}/{i}', trajectory=off(trajectory, rng)) for i in range(arguments.samples)]

    # each execution by itself
    manifest, results = os.path.join(folder.name, 'rows.jsonl'), os.path.join(folder.name, 'results')
    with open(manifest, 'w', encoding='utf-8') as file:
        file.writelines(json.dumps(row) + '\n' for row in rows)
    run(arguments.cprox, 'certify', '--dataset', manifest, '--out', results, '--quiet')
    least, itself, contradictions, count = {}, {}, 0, 0
    for row in run(arguments.cprox, 'merge', results):
        name, which = row['id'].split('/')
        if which == 'itself':
            itself[name] = float(row['upper'])
            continue
        count += 1
        contradictions += float(row['upper']) < certified[name]
        least[name] = min(least.get(name, 1e9), float(row['upper']))
    for name in sorted(least):
        print(f'{name:40s} itself {1e3 * itself[name]:7.2f} mm, least sampled {1e3 * least[name]:7.2f}, certified {1e3 * certified[name]:7.2f}')
    print(f'{count} executions, {contradictions} contradictions (seed {arguments.seed})')

    figure, axes = plt.subplots(figsize=(5.5, 4.2))
    most = 1.05e3 * max(itself.values())
    axes.plot([0, most], [0, most], color=GREY, lw=0.8)
    for name in least:
        axes.plot(1e3 * certified[name], 1e3 * itself[name], '.', color=GREY)
        axes.plot(1e3 * certified[name], 1e3 * least[name], 'o', color=BLUE)
    axes.plot([], [], '.', color=GREY, label='the motion itself')
    axes.plot([], [], 'o', color=BLUE, label=f'least of {arguments.samples} sampled executions')
    axes.set_xlabel('certified for every execution [mm]')
    axes.set_ylabel('clearance [mm]')
    axes.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(os.path.join(arguments.out, 'robust_executions.png'), dpi=110)

    # one motion over time
    words, trajectory = motions[BAND]

    def profile(*more):
        found = run(arguments.cprox, 'profile', '--intervals', '80', *words, *more)
        return [[float(row[column]) for row in found] for column in ('t0', 't1', 'lower', 'upper')]

    figure, axes = plt.subplots(figsize=(7, 3.6))
    for _ in range(30):
        path = os.path.join(folder.name, 'sample.yaml')
        with open(path, 'w', encoding='utf-8') as file:
            yaml.safe_dump(off(trajectory, rng), file)
        sample = list(words)
        sample[sample.index('--trajectory') + 1] = path
        found = run(arguments.cprox, 'profile', '--intervals', '80', *sample)
        axes.step([float(row['t0']) for row in found], [1e3 * float(row['upper']) for row in found], where='post', color=GREY, lw=0.5)
    starts, _, _, upper = profile()
    axes.step(starts, [1e3 * value for value in upper], where='post', color=BLUE, lw=1.5, label='the motion itself')
    starts, _, lower, _ = profile('--errors', errors)
    axes.step(starts, [1e3 * value for value in lower], where='post', color=RED, lw=1.5, label='certified for every execution')
    axes.fill_between(starts, 0, [1e3 * value for value in lower], step='post', color=RED, alpha=0.12)
    axes.plot([], [], color=GREY, lw=0.5, label='30 sampled executions')
    axes.set_xlabel('time [s]')
    axes.set_ylabel('clearance [mm]')
    axes.set_ylim(0, 80)  # what is far does not matter
    axes.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(os.path.join(arguments.out, 'robust_band.png'), dpi=110)


if __name__ == '__main__':
    main()
