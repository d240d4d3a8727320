#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The example with NLopt: the spline collides before, and is clear after, which `cprox` confirms. The last line is the sum."""
import argparse
import csv
import io
import os
import subprocess
import sys
import tempfile

SCENE = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'data/scenes/mbm/bookshelf_tall_panda/scene0001.yaml')

parser = argparse.ArgumentParser()
parser.add_argument('--push-out', required=True)
parser.add_argument('--cprox', required=True)
arguments = parser.parse_args()
failed = 0


def check(what, holds, seen=''):
    global failed
    failed += not holds
    print(f"{'ok' if holds else 'FAILED'}: {what} {'' if holds else seen}")


with tempfile.TemporaryDirectory() as folder:
    curves = os.path.join(folder, 'curves.csv')
    done = subprocess.run([arguments.push_out, SCENE, curves], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300)
    print(done.stdout.decode())
    check('the example ends well', done.returncode == 0, done.returncode)
    answer = subprocess.run([arguments.cprox, 'distance', '--curves', curves, '--scene', SCENE], stdout=subprocess.PIPE, timeout=120)
    rows = {row['id']: row for row in csv.DictReader(io.StringIO(answer.stdout.decode()))}
    check('the straight spline hits something', float(rows['before']['upper']) == 0.0, rows)
    check('the other keeps its 10 mm, less the tolerance that NLopt was given', float(rows['after']['lower']) >= 0.01 - 1e-5, rows)
print(f'{3 - failed} passed, {failed} failed')
sys.exit(failed != 0)
