#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Starts RViz with a view of all that a server shows: the robot, and the objects near it.

    show_in_rviz.py CONFIG.rviz [--server /curve_proximity] [--frame world] [--wait 10] [RVIZ'S ARGUMENTS ...]

Waits for the markers of the server, takes their box, and turns CONFIG's camera to it; RViz then runs in this process's place.
Without markers the view is that of CONFIG."""
import argparse
import math
import os
import sys
import tempfile
import time

import rospy
import yaml
from visualization_msgs.msg import Marker, MarkerArray

LINK = 0.1  # [m] what a mesh extends beyond its origin: its file is not read
FAR, LARGE = 2.0, 3.0  # what is farther from the robot or larger than it, by these factors, is not made room for


def turned(q, v):
    """A vector turned by a quaternion."""
    u, w = (q.x, q.y, q.z), q.w
    c = (u[1] * v[2] - u[2] * v[1] + w * v[0], u[2] * v[0] - u[0] * v[2] + w * v[1], u[0] * v[1] - u[1] * v[0] + w * v[2])
    return tuple(v[i] + 2 * (u[(i + 1) % 3] * c[(i + 2) % 3] - u[(i + 2) % 3] * c[(i + 1) % 3]) for i in range(3))


def box_of(marker):
    """(lowest, highest) of a marker in its frame; None where it has no extent."""
    at, q = marker.pose.position, marker.pose.orientation
    if marker.points:
        corners = [(p.x, p.y, p.z) for p in marker.points]
    else:
        mesh = marker.type == Marker.MESH_RESOURCE
        half = (LINK,) * 3 if mesh else (marker.scale.x / 2, marker.scale.y / 2, marker.scale.z / 2)
        corners = [tuple(s * h for s, h in zip(signs, half))
                   for signs in ((a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1))]
    corners = [turned(q, c) if q.w or q.x or q.y or q.z else c for c in corners]
    corners = [(c[0] + at.x, c[1] + at.y, c[2] + at.z) for c in corners]
    return tuple(map(min, zip(*corners))), tuple(map(max, zip(*corners)))


def union(boxes):
    lows, highs = zip(*boxes)
    return tuple(map(min, zip(*lows))), tuple(map(max, zip(*highs)))


def size(box):
    return math.dist(*box)


def centre(box):
    return tuple((a + b) / 2 for a, b in zip(*box))


def view_of(markers):
    """(middle, radius) of a ball to look at; None of nothing."""
    shown = [m for m in markers if m.action == Marker.ADD and m.type != Marker.TEXT_VIEW_FACING]
    robot = [box_of(m) for m in shown if m.ns not in ('scene', 'sides', 'levels')]
    others = [box_of(m) for m in shown if m.ns in ('scene', 'sides', 'levels')]
    if not robot and not others:
        return None
    box = union(robot or others)
    if robot:
        reach = size(box)
        near = [b for b in others if size(b) <= LARGE * reach and math.dist(centre(b), centre(box)) <= FAR * reach]
        box = union([box] + near)
    return centre(box), size(box) / 2


def turn_to(config, middle, radius, floor):
    """The camera of a configuration looks at a ball, from where it looks now; the ground lies below it."""
    view = config['Visualization Manager']['Views']['Current']
    view['Distance'] = radius / math.sin(view['Field of View'] / 2)
    view['Focal Point'] = dict(zip('XYZ', middle))
    for display in config['Visualization Manager']['Displays']:
        if display['Class'] == 'rviz/Grid':
            cells = max(4, 2 * math.ceil(2 * radius / display['Cell Size'] / 2))
            display['Plane Cell Count'] = min(cells, 200)
            display['Offset'] = {'X': middle[0], 'Y': middle[1], 'Z': min(0.0, floor)}


def markers_of(topic, patience):
    """The last array that came, at once where it shows a robot; [] where none came in time."""
    received = []
    subscriber = rospy.Subscriber(topic, MarkerArray, received.append)
    end = time.monotonic() + patience
    while time.monotonic() < end and not rospy.is_shutdown():
        if received and any(m.ns == 'robot' for m in received[-1].markers):
            break
        time.sleep(0.1)
    subscriber.unregister()
    return received[-1].markers if received else []


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('config')
    parser.add_argument('--server', default='curve_proximity')
    parser.add_argument('--frame')
    parser.add_argument('--wait', type=float, default=10.0)
    parser.add_argument('--print', action='store_true', help='prints the configuration instead of starting RViz')
    options, others = parser.parse_known_args()
    rospy.init_node('show_in_rviz', anonymous=True)
    with open(options.config) as text:
        config = yaml.safe_load(text)
    topic = rospy.resolve_name(options.server + '/markers')
    for display in config['Visualization Manager']['Displays']:
        if display['Class'] == 'rviz/MarkerArray':
            display['Marker Topic'] = topic
    if options.frame:
        config['Visualization Manager']['Global Options']['Fixed Frame'] = options.frame
    markers = markers_of(topic, options.wait)
    found = view_of(markers)
    if found:
        turn_to(config, *found, floor=union([box_of(m) for m in markers if m.action == Marker.ADD])[0][2])
    rospy.signal_shutdown('RViz takes over')
    if options.print:
        return yaml.safe_dump(config, sys.stdout)
    path = os.path.join(tempfile.mkdtemp(prefix='curve_proximity_'), 'view.rviz')
    with open(path, 'w') as text:
        yaml.safe_dump(config, text)
    os.execvp('rviz', ['rviz', '-d', path] + others)


if __name__ == '__main__':
    main()
