#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Each constraint provider in the loop of a planner: steps along its gradient until its value is as wanted, and proven.

    scripts/run roslaunch curve_proximity demo.launch rviz:=false     # or any other node
    scripts/run python3 examples/client_constraints.py [NODE]
"""
import sys

import numpy as np
import rospy
from curve_proximity_client import Client, bezier, box, sphere

CURVES, PAIRS, GAP = (f'curve_proximity/{name}' for name in ('CurveDistance', 'SuperquadricDistance', 'FourierGap'))
STEPS = 60


def numbers(vector):
    return np.array([vector.x, vector.y, vector.z])


def climb(name, x, wanted, ask):
    """x moves along the gradient by what is missing; ask(x) returns the answer and the gradient by x."""
    for step in range(STEPS):
        answer, gradient = ask(x)
        if answer.lower >= wanted:
            print(f'{name}: proven after {step} steps: {answer.lower:.4f} is at least {wanted:g}')
            return x
        slope = float(np.sum(gradient * gradient))
        if slope == 0.0:
            break
        x = x + min(1.0, (1.05 * wanted + 1e-6 - answer.value) / slope) * gradient
    print(f'{name}: not reached in {STEPS} steps')
    return x


def main(node):
    client = Client(node)
    client.add(box('obstacle', (0.4, 0.3, 0.5)))

    # A path through the obstacle: its inner control points move.
    ends = np.array([[-1.0, 0.0, 0.0], [1.0, 0.1, 0.0]])

    def path(inner):
        points = np.vstack([ends[:1], inner, ends[1:]])
        answer = client.constraint(CURVES, 'obstacle', curve=bezier([tuple(p) for p in points], radius=0.05))
        return answer, np.array([numbers(g) for g in answer.gradient_points])[1:-1]
    climb('CurveDistance', np.array([[-0.4, 0.05, 0.02], [0.4, 0.03, 0.05]]), 0.1, path)

    # A gripper beside it: its place moves.
    def beside(provider):
        def ask(place):
            answer = client.constraint(provider, 'obstacle', sphere('', 0.1, tuple(place)))
            return answer, numbers(answer.gradient_a.linear)
        return ask
    climb('SuperquadricDistance', np.array([0.22, 0.1, 0.05]), 0.05, beside(PAIRS))
    climb('FourierGap', np.array([0.25, 0.2, 0.1]), 0.01, beside(GAP))


if __name__ == '__main__':
    rospy.init_node('curve_proximity_example', anonymous=True)
    main(rospy.myargv(sys.argv)[1] if len(rospy.myargv(sys.argv)) > 1 else '/curve_proximity')
