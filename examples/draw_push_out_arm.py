#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what example_push_out_arm wrote: draw_push_out_arm.py ROBOT.urdf ROBOT.srdf SCENE.yaml BEFORE.yaml AFTER.yaml OUT.png.
The clearance over time as `cprox profile` certifies it, and the joints, before and after. Run it with scripts/run."""
import csv
import io
import subprocess
import sys

import numpy as np
import yaml
import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

INK, HIT, CLEAR = '#22303c', '#d6202b', '#2b7a78'
INTERVALS = 200


def clearance(robot, srdf, scene, trajectory):
    """Times and upper ends of the distance to the objects and of the robot to itself [mm]."""
    done = subprocess.run(['cprox', 'profile', '--robot', robot, '--srdf', srdf, '--scene', scene, '--trajectory', trajectory, '--self',
                           '--intervals', str(INTERVALS)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
    curves = {}
    for row in csv.DictReader(io.StringIO(done.stdout.decode())):
        curves.setdefault(row['kind'], []).append((float(row['t']), 1e3 * float(row['lower'])))
    return {kind: np.array(points) for kind, points in curves.items()}


def joints(path):
    """Times, and positions of all joints between the points by cubic Hermite polynomials."""
    with open(path) as text:
        points = yaml.safe_load(text)['joint_trajectory']['points']
    times, out = [], []
    for a, b in zip(points, points[1:]):
        h = b['time_from_start'] - a['time_from_start']
        p, v, q, w = (np.array(x) for x in (a['positions'], a['velocities'], b['positions'], b['velocities']))
        for s in np.linspace(0, 1, 20):
            times.append(a['time_from_start'] + s * h)
            out.append((2 * s**3 - 3 * s**2 + 1) * p + (s**3 - 2 * s**2 + s) * h * v + (3 * s**2 - 2 * s**3) * q + (s**3 - s**2) * h * w)
    return np.array(times), np.array(out)


def main(robot, srdf, scene, before, after, out):
    figure, axes = plt.subplots(2, 2, figsize=(10, 5.4), sharex=True, sharey='row')
    for column, path, colour, title in ((0, before, HIT, "before"), (1, after, CLEAR, 'after: smooth, more than 10 mm clear, proven')):
        found = clearance(robot, srdf, scene, path)
        axes[0, column].plot(*found['environment'].T, color=colour, label='to the objects')
        axes[0, column].plot(*found['self'].T, color=INK, linewidth=0.8, label='to itself')
        axes[0, column].axhline(10.0, color=INK, linestyle='--', linewidth=0.8)
        axes[0, column].set(ylim=(0, 60), title=title)
        axes[1, column].plot(*joints(path), color=colour, linewidth=0.9)
        axes[1, column].set(xlabel='time [s]')
    axes[0, 0].set(ylabel='clearance [mm]')
    axes[1, 0].set(ylabel='joints [rad]')
    axes[0, 1].legend(frameon=False)
    figure.tight_layout()
    figure.savefig(out, dpi=110)


if __name__ == '__main__':
    if len(sys.argv) != 7:
        sys.exit('usage: draw_push_out_arm.py ROBOT.urdf ROBOT.srdf SCENE.yaml BEFORE.yaml AFTER.yaml OUT.png')
    main(*sys.argv[1:])
