#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The example of an arm with NLopt, from a planner's path and from a straight one that is in contact: the path comes nearer than
10 mm before, and not after, which `cprox` confirms. The last line is the sum."""
import argparse
import os
import subprocess
import sys
import tempfile

DATA = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'data')
ROBOT, SRDF = (os.path.join(DATA, 'robots/panda/panda.' + kind) for kind in ('urdf', 'srdf'))
SCENE = os.path.join(DATA, 'scenes/mbm/bookshelf_thin_panda/scene0042.yaml')
PATH = os.path.join(DATA, 'trajectories/panda_bookshelf_thin_0042_rrt.yaml')

parser = argparse.ArgumentParser()
parser.add_argument('--push-out-arm', required=True)
parser.add_argument('--cprox', required=True)
arguments = parser.parse_args()
failed = 0


def check(what, holds, seen=''):
    global failed
    failed += not holds
    print(f"{'ok' if holds else 'FAILED'}: {what} {'' if holds else seen}")


def run(folder, start, options):
    before, after = (os.path.join(folder, name + '.yaml') for name in ('before', 'after'))
    done = subprocess.run([arguments.push_out_arm, *options, ROBOT, SRDF, SCENE, PATH, before, after], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=300)
    said = done.stdout.decode()
    print(said)
    check(f'from {start} the example ends well', done.returncode == 0, done.returncode)
    check('it converges', 'NLopt said 3' in said or 'NLopt said 4' in said, said)
    codes = [subprocess.run([arguments.cprox, 'tolerance', '--delta', '0.01', '--robot', ROBOT, '--srdf', SRDF, '--scene', SCENE, '--self',
                             '--trajectory', path], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120).returncode
             for path in (before, after)]
    check(f'{start} comes nearer than 10 mm', codes[0] == 1, codes)
    check('the result does not, proven', codes[1] == 0, codes)
    return said


with tempfile.TemporaryDirectory() as folder:
    run(folder, "the planner's path", [])
    check('the straight path is in contact', 'before: at least 0.0000 mm' in run(folder, 'the straight path', ['--straight']))
print(f'{9 - failed} passed, {failed} failed')
sys.exit(failed != 0)
