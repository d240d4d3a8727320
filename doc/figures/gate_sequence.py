#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws doc/images/gate.gif: a crane seen from above that swings past a crate, is asked about again and again, and stops.

    scripts/run /usr/bin/python3 doc/figures/gate_sequence.py

Each picture is an answer of `cprox tolerance` about what is left of the motion, in the scene as it is then: what
curve_proximity/TrajectoryGate asks the server about a motion that runs (doc/ros.md, Pipelines).
"""
import json
import os
import re
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib import animation, patches  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
DELTA, STEP, LAST, APPEARS = 0.1, 0.2, 8.0, 3.0  # [m], [s], [s], [s]
START, END, REACH, HOOK = -1.2, 1.2, 1.4, 0.08
CRATE, DRUM = (1.15, 0.75, 0.35), (0.2, -1.9, 0.3)  # x, y, half a side; x, y, radius
COLOURS = {'clear': '#10715f', 'violated': '#a8321a', 'undecided': '#8a6d00'}


def urdf():
    """The crane of doc/first-hour.md."""
    with open(os.path.join(os.path.dirname(HERE), 'first-hour.md')) as page:
        return re.search(r'```xml\n(<robot.*?</robot>\n)```', page.read(), re.S)[1]


def slew(t):
    return START + (END - START) * min(t, LAST) / LAST


def ask(folder, t):
    """The row of what is left at t."""
    objects = [{'id': 'drum', 'primitives': [{'type': 'cylinder', 'dimensions': [2, DRUM[2]]}], 'pose': {'position': [*DRUM[:2], 1]}}]
    if t >= APPEARS:
        objects.append({'id': 'crate', 'primitives': [{'type': 'box', 'dimensions': [2 * CRATE[2], 2 * CRATE[2], 2]}],
                        'pose': {'position': [*CRATE[:2], 1]}})
    points = [{'positions': [slew(t), 0.6], 'time_from_start': 0.0}, {'positions': [END, 0.6], 'time_from_start': LAST - t}]
    files = {'crane.urdf': urdf(), 'scene.yaml': json.dumps({'world': {'collision_objects': objects}}),
             'rest.yaml': json.dumps({'joint_trajectory': {'joint_names': ['slew', 'hoist'], 'points': points}})}
    for name, text in files.items():
        with open(os.path.join(folder, name), 'w') as out:
            out.write(text)
    done = subprocess.run(['cprox', 'tolerance', '--delta', str(DELTA), '--robot', 'crane.urdf', '--trajectory', 'rest.yaml', '--scene', 'scene.yaml',
                           '--json'], cwd=folder, stdout=subprocess.PIPE, check=False)
    return json.loads(done.stdout)


def main(path):
    figure, axes = plt.subplots(figsize=(4.4, 4.4), dpi=80)
    stopped, frames = None, []
    with tempfile.TemporaryDirectory() as folder:
        for t in np.arange(0.0, LAST, STEP):
            row = ask(folder, t) if stopped is None else frames[-1][1]
            frames.append((t if stopped is None else stopped, row, t >= APPEARS))
            if stopped is None and row['verdict'] != 'clear':
                stopped = t
            if stopped is not None and t > stopped + 3.0:
                break
    assert stopped is not None and frames[0][1]['verdict'] == 'clear', 'the gate does not stop this motion'

    def draw(frame):
        t, row, crate = frame
        colour = COLOURS[row['verdict']]
        axes.clear()
        axes.set(xlim=(-0.6, 2.0), ylim=(-2.3, 1.9), aspect='equal', xlabel='x [m]', ylabel='y [m]')
        axes.add_patch(patches.Circle(DRUM[:2], DRUM[2], color='#b0a890'))
        if crate:
            axes.add_patch(patches.Rectangle((CRATE[0] - CRATE[2], CRATE[1] - CRATE[2]), 2 * CRATE[2], 2 * CRATE[2], color='#b0a890'))
        rest = np.linspace(slew(t), END, 50)
        axes.plot(REACH * np.cos(rest), REACH * np.sin(rest), ':', color=colour, label='what is left')
        at = np.array([np.cos(slew(t)), np.sin(slew(t))])
        axes.plot(*np.array([-0.1 * at, 1.5 * at]).T, color='#26547c', linewidth=5, solid_capstyle='butt')
        axes.add_patch(patches.Circle(REACH * at, HOOK, color=colour, zorder=3))
        axes.add_patch(patches.Circle((0, 0), 0.1, color='#26547c'))
        said = 'clear: it goes on' if row['verdict'] == 'clear' else f"{row['verdict']}, {row['a']} and {row['b']}: it stops"
        axes.set_title(f't = {t:.1f} s, farther than {DELTA} m? {said}', fontsize=9, color=colour)

    animation.FuncAnimation(figure, draw, frames, init_func=lambda: None).save(path, writer=animation.PillowWriter(fps=2))
    print(f'{len(frames)} pictures, stopped at {stopped:.1f} s')


if __name__ == '__main__':
    main(sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(HERE), 'images', 'gate.gif'))
