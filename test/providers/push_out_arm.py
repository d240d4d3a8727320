#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The example of an arm with NLopt: the path comes nearer than 10 mm before, and not after, which `cprox` confirms. The last line
is the sum."""
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


with tempfile.TemporaryDirectory() as folder:
    before, after = (os.path.join(folder, name + '.yaml') for name in ('before', 'after'))
    done = subprocess.run([arguments.push_out_arm, ROBOT, SRDF, SCENE, PATH, before, after], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=300)
    print(done.stdout.decode())
    check('the example ends well', done.returncode == 0, done.returncode)
    codes = [subprocess.run([arguments.cprox, 'tolerance', '--delta', '0.01', '--robot', ROBOT, '--srdf', SRDF, '--scene', SCENE, '--self',
                             '--trajectory', path], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120).returncode
             for path in (before, after)]
    check("the planner's path comes nearer than 10 mm", codes[0] == 1, codes)
    check('the other one does not, proven', codes[1] == 0, codes)
print(f'{3 - failed} passed, {failed} failed')
sys.exit(failed != 0)
