#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Which targets of the group fourier turn red where the sum of a gap is broken on purpose. Run by hand.

  /usr/bin/python3 bench/fourier/broken.py [--build DIR] [--fast]
    --build   keeps the copy of the sources and its build (default: a folder of the cache)
    --fast    without the planning problems and their targets: they take most of the time

A copy of the sources is changed, never the checkout. Each fault is one text in one file. First all targets are held against
the sum as it is, by a quick run. The table has a row for each target of bench/targets.csv, and names the faults that turn it
red. Ends with 1 where a target is red without a fault, or red under none.
"""
import argparse
import csv
import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
REPO = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.dirname(HERE))
import run  # noqa: E402
import targets  # noqa: E402

SUM, QUERY = 'src/fourier/sum.c', 'src/fourier/query.c'
ADD, CALL = 'v += 2.0 * add_up(sum.v);', '  gap_sum(&job);'
SLOPE = 'job->position = vec_scale(2.0 * gap->inverse, x);'
FAULTS = (  # what is wrong, the file, the text that stands there once, what takes its place
    ('1.3 times its terms', SUM, ADD, 'v += 2.6 * add_up(sum.v);'),
    ('half of its terms', SUM, ADD, 'v += add_up(sum.v);'),
    ('the opposite sign', SUM, ADD, 'v -= 2.0 * add_up(sum.v);'),
    ('a gradient of the opposite sign', SUM, SLOPE, SLOPE.replace('2.0', '-2.0')),
    ('three times the work', QUERY, CALL, 3 * CALL),
)
WORKLOADS = ('dots', 'over-reach', 'box value and gradient', 'planning')


def copied(tree):
    """The sources and the benches, and none of the documents."""
    listed = subprocess.run(['git', '-C', REPO, 'ls-files', '-z', '--', '.', ':!doc'], stdout=subprocess.PIPE, check=True)
    for name in listed.stdout.decode().split('\0')[:-1]:
        source, to = os.path.join(REPO, name), os.path.join(tree, name)
        if os.path.isfile(source) and not (os.path.exists(to) and open(to, 'rb').read() == open(source, 'rb').read()):
            os.makedirs(os.path.dirname(to), exist_ok=True)
            shutil.copy(source, to)


def red_targets(build, log, workloads):
    """The names of all targets that the workloads can judge, and of those that are not met."""
    subprocess.run(['make', '-C', build, '-j2', 'curve_proximity_bench_fourier'], stdout=log, stderr=log, check=True)
    program, lines = os.path.join(build, 'bench', 'curve_proximity_bench_fourier'), []
    for workload in workloads:
        done = subprocess.run([program, '--quick', '--only', workload], stdout=subprocess.PIPE, stderr=log, text=True)
        lines += done.stdout.splitlines()  # a sum that is broken may end the program: rows are missing then
    rows = list(csv.DictReader(lines, fieldnames=run.COLUMNS))
    judged = [(verdict, target['name']) for verdict, target, _ in targets.judge_all(rows, {'fourier'})
              if target['group'] == 'fourier' and not target['workload'].startswith('smooth')
              and ('planning' in workloads or not target['workload'].startswith('planning'))]
    return [name for _, name in judged], {name for verdict, name in judged if verdict == 'MISSED'}


def main():
    cache = os.environ.get('XDG_CACHE_HOME', os.path.expanduser('~/.cache'))
    parser = argparse.ArgumentParser(description=__doc__.split('\n', 1)[0])
    parser.add_argument('--build', default=os.path.join(cache, 'curve_proximity', 'broken'))
    parser.add_argument('--fast', action='store_true')
    asked = parser.parse_args()
    workloads = WORKLOADS[:3] if asked.fast else WORKLOADS
    tree, build = os.path.join(asked.build, 'tree'), os.path.join(asked.build, 'build')
    os.makedirs(build, exist_ok=True)
    copied(tree)
    with open(os.path.join(asked.build, 'log'), 'w', encoding='utf-8') as log:
        subprocess.run(['cmake', '-S', tree, '-B', build, '-DCPROX_ROS=OFF', '-DCPROX_BENCH=ON', '-DCMAKE_BUILD_TYPE=Release'],
                       stdout=log, stderr=log, check=True)
        names, red = red_targets(build, log, workloads)
        by = {name: [] for name in names}
        for heading, file, old, new in FAULTS:
            path = os.path.join(tree, file)
            with open(path, encoding='utf-8') as source:
                whole = source.read()
            if whole.count(old) != 1:
                sys.exit(f'{file} does not have this once: {old}')
            try:
                with open(path, 'w', encoding='utf-8') as source:
                    source.write(whole.replace(old, new))
                for name in red_targets(build, log, workloads)[1]:
                    by[name].append(heading)
            finally:
                with open(path, 'w', encoding='utf-8') as source:
                    source.write(whole)
            print(f'{heading}: {sum(heading in faults for faults in by.values())} red', file=sys.stderr, flush=True)
    print('| target | red by |\n|---|---|')
    for name in names:
        print(f'| {name} | {"red without a fault" if name in red else ", ".join(by[name]) or "none"} |')
    blind = [name for name in names if name in red or not by[name]]
    print(f'{len(names) - len(blind)} of {len(names)} targets turn red by a broken sum and only by one')
    return len(blind) > 0


if __name__ == '__main__':
    sys.exit(main())
