#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""cprox from Python, a few lines each: a tube, many curves at once, a gradient, a Panda's clearance over time and its proof.

    python.py [PICTURE.png]

Needs the sourced workspace (doc/python.md). Writes the chart where it is told, else clearance.png in the working folder."""
import os
import sys

import matplotlib
import numpy

import cprox

matplotlib.use('Agg')
from matplotlib import pyplot  # noqa: E402

# a tube along a Bézier curve, past two obstacles
curve = cprox.bezier([[-1, 0, 0], [0, 1, 0.2], [1, 0, 0]])
obstacles = cprox.Obstacles([cprox.Obstacle(cprox.box([0.1, 1, 1]), cprox.transform([0.9, 1.2, 0])),
                             cprox.Obstacle(cprox.superquadric([0.3, 0.2, 0.2], [4, 4, 4]), cprox.transform([-1, 1, 0]))])
answer = cprox.distance(cprox.tube(curve, 0.1), obstacles)
print(f'tube: between {answer.lower:.9f} and {answer.upper:.9f} m, obstacle {answer.obstacle}, at t = {answer.t:.3f}')

# ten thousand curves at once, by all cores
many = numpy.random.default_rng(1).uniform(-3, 3, (10000, 4, 3))
verdicts = obstacles.tolerance_batch(many, delta=0.05)['verdict']
print(f'batch: {(verdicts == 0).sum()} of {len(many)} curves stay farther than 5 cm')

# the gradient by the point of the curve that is nearest
gradient = cprox.distance_gradient(curve, cprox.Obstacle(cprox.sphere(0.2), cprox.transform([0, 1, 0])))
print(f"gradient: {numpy.round(gradient['mover'], 3)} at t = {gradient['t']:.3f}, valid: {gradient['valid']}")

# a Panda along a cubic, and its clearance over time
folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../test/data/robots/panda')
robot = cprox.Robot.from_urdf(os.path.join(folder, 'panda.urdf'), srdf=os.path.join(folder, 'panda.srdf'))
scene = cprox.Scene(robot)
scene.add('shelf', 'box', [0.4, 1, 0.04], cprox.transform([0.7, 0, 0.75]))
joints = [f'panda_joint{i}' for i in range(1, 8)]
positions = [[0, -0.8, 0, -2.4, 0, 1.6, 0.8], [0.8, 0.1, 0, -2.2, 0, 2.2, 0.8], [1.4, 0.4, 0, -1.6, 0, 2.0, 0.8]]
velocities = [[0] * 7, [0.7, 0.6, 0, 0.4, 0, 0.2, 0], [0] * 7]
motion = cprox.Motion(scene, joints, [0, 1, 2], positions, velocities)
closest = motion.distance()
print(f"Panda: {closest['a']} comes within {closest['result'].upper * 1e3:.2f} mm of {closest['b']}"
      f" at {closest['result'].t:.2f} s")
for pair in motion.nearest_pairs(k=3):
    print(f"  {pair['a']} and {pair['b']}: {pair['result'].upper * 1e3:.2f} mm")

# a proof that it stays 2 cm clear, checked by a program that shares no code with the search
proof = motion.certificate(delta=0.02)
print(f"certificate of {len(proof['record'])} bytes: {cprox.check(proof)}")

# how close each link comes over time: bands between certified bounds
breaks = numpy.linspace(0, 2, 101)
for i, link in enumerate(motion.links()):
    profile = motion.profile(breaks, epsilon=1e-3, links=[link])
    lower, upper = (numpy.append(profile[name], profile[name][-1]) * 1e3 for name in ('lower', 'upper'))
    pyplot.fill_between(breaks, lower, upper, step='post', label=link, color=f'C{i}', linewidth=1.5)
pyplot.xlabel('time [s]')
pyplot.ylabel('certified clearance [mm]')
pyplot.legend(loc='center left', bbox_to_anchor=(1, 0.5))
picture = sys.argv[1] if len(sys.argv) > 1 else 'clearance.png'
pyplot.savefig(picture, bbox_inches='tight')
print(f'{picture}: the clearance of each link lies in its band')
