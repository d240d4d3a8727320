#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Asks a running node from Python: how close, is it clear, and which way to push.

    scripts/run roslaunch curve_proximity demo.launch rviz:=false     # or any other node
    scripts/run python3 examples/client.py [NODE]
"""
import sys

import rospy
from curve_proximity_client import Client, Failure, box, bspline, sphere


def main(node):
    client = Client(node)
    client.add(sphere('ball', 0.25, (0, 0, 0.2)), box('wall', (0.1, 4, 4), (2, 0, 0)))
    path = bspline([(-1, -1, 0.6), (-0.5, -0.3, 0.5), (0, 0, 0.55), (0.5, 0.3, 0.5), (1, 1, 0.6)], radius=0.05)

    row = client.distance(path, objects=['ball', 'wall'])
    print('%.6f <= distance <= %.6f m, to %s at t = %.3f' % (row.lower, row.upper, row.b, row.t))
    print('more than 2 cm clear everywhere: %s' % ('yes, proven' if client.is_clear(path, 0.02, objects=['ball', 'wall']) else 'no'))

    try:
        answer = client.constraint('curve_proximity/CurveDistance', 'ball', curve=path)
        print('to gain most clearance, move the control points by a multiple of')
        for g in answer.gradient_points:
            print('  %+.3f %+.3f %+.3f' % (g.x, g.y, g.z))
    except Failure as failure:
        print(failure)


if __name__ == '__main__':
    rospy.init_node('curve_proximity_example', anonymous=True)
    main(rospy.myargv(sys.argv)[1] if len(rospy.myargv(sys.argv)) > 1 else '/curve_proximity')
