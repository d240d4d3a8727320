#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what example_push_out wrote: draw_push_out.py SCENE.yaml CURVES.csv OUT.png, the spline before and after beside each other."""
import csv
import sys

import numpy as np
import yaml
import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # noqa: E402

INK, SHELF, CAN, HIT, CLEAR = '#22303c', '#b9a88f', '#7d9fb8', '#d6202b', '#2b7a78'


def rotation(q):
    x, y, z, w = np.asarray(q, float) / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def faces(primitive):
    """The faces of a box or a cylinder about the origin."""
    size = primitive['dimensions']
    if primitive['type'] == 'box':
        x, y, z = np.asarray(size) / 2
        corner = {(i, j, k): np.array([i * x, j * y, k * z]) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)}
        return [np.array([corner[tuple(np.insert(c, axis, side))] for c in ((-1, -1), (-1, 1), (1, 1), (1, -1))])
                for axis in range(3) for side in (-1, 1)]
    height, radius = size
    angle = np.linspace(0, 2 * np.pi, 25)
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(angle.shape, height / 2)], 1)
    low = ring * [1, 1, -1]
    return [ring, low] + [np.array([ring[i], ring[i + 1], low[i + 1], low[i]]) for i in range(24)]


def spline(row):
    """Points along a cubic B-spline, by de Boor's recurrence."""
    n = int(row[6])
    points = np.array(row[7:7 + 3 * n], float).reshape(n, 3)
    knots = np.array(row[7 + 3 * n:], float)
    out = []
    for t in np.linspace(0, 1, 200):
        k = min(max(np.searchsorted(knots, t, 'right') - 1, 3), n - 1)
        d = [points[j + k - 3].copy() for j in range(4)]
        for r in range(1, 4):
            for j in range(3, r - 1, -1):
                a = (t - knots[j + k - 3]) / (knots[j + 1 + k - r] - knots[j + k - 3])
                d[j] = (1 - a) * d[j - 1] + a * d[j]
        out.append(d[3])
    return np.array(out), points, float(row[5])


def tube(path, radius):
    """Quads round a polyline."""
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    side = np.cross(along, [0, 0, 1.0])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, along)
    angle = np.linspace(0, 2 * np.pi, 13)
    rings = path[:, None] + radius * (np.cos(angle)[:, None] * side[:, None] + np.sin(angle)[:, None] * up[:, None])
    return [[rings[i, k], rings[i + 1, k], rings[i + 1, k + 1], rings[i, k + 1]]
            for i in range(len(path) - 1) for k in range(12)]


def main(scene, curves, out):
    with open(scene) as text:
        objects = yaml.safe_load(text)['world']['collision_objects']
    with open(curves, newline='') as text:
        rows = list(csv.reader(text))
    figure = plt.figure(figsize=(11, 5.2))
    for number, (row, colour, title) in enumerate(zip(rows, (HIT, CLEAR), ('before: through a can', 'after: 10 mm clear, proven'))):
        path, points, radius = spline(row)
        axes = figure.add_subplot(1, 2, number + 1, projection='3d', computed_zorder=False)
        for thing in objects:
            for primitive, pose in zip(thing['primitives'], thing['primitive_poses']):
                turn, at = rotation(pose['orientation']), np.asarray(pose['position'])
                can = primitive['type'] == 'cylinder'
                wall = not can and primitive['dimensions'][2] > 1
                if not wall and not 0.2 < at[2] < 0.5:
                    continue  # the boards and cans of the other storeys would hide the way
                axes.add_collection3d(Poly3DCollection([f @ turn.T + at for f in faces(primitive)], facecolor=CAN if can else SHELF,
                                                       edgecolor=INK, linewidth=0.15, alpha=0.95 if can else 0.12 if wall else 0.35, zorder=2 if can else 1))
        axes.add_collection3d(Poly3DCollection(tube(path, radius), facecolor=colour, edgecolor='none', alpha=0.7, zorder=3))
        axes.plot(*points.T, 'o--', color=INK, markersize=2.5, linewidth=0.5, zorder=4)
        axes.set(xlim=(0.05, 0.75), ylim=(0.35, 1.25), zlim=(0.25, 0.65), title=title)
        axes.set_box_aspect((0.7, 0.9, 0.4), zoom=1.15)
        axes.view_init(elev=68, azim=-115)
        axes.set_axis_off()
    figure.subplots_adjust(left=0, right=1, bottom=0, top=0.94, wspace=0)
    figure.savefig(out, dpi=110)


if __name__ == '__main__':
    if len(sys.argv) != 4:
        sys.exit('usage: draw_push_out.py SCENE.yaml CURVES.csv OUT.png')
    main(*sys.argv[1:])
