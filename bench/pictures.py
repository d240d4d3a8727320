#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of Lakshmanan et al. (2019) that show what a query does, with the Python package cprox: Fig. 6 (stages of a search), Fig. 8
(glyphs), §V-D (confidence regions). scripts/run /usr/bin/python3 bench/pictures.py [FOLDER] writes them; without a folder to doc/charts."""
import os
import sys

import cprox
import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.patches import Circle, Polygon  # noqa: E402
from matplotlib.path import Path  # noqa: E402
from matplotlib.textpath import TextPath  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
BLUE, ORANGE, GREY, RED = '#2b6cb0', '#dd7711', '#888888', '#c53030'


def flat(points):
    """Points of the plane, in space."""
    points = np.asarray(points, dtype=float)
    return np.column_stack([points, np.zeros(len(points))])


def casteljau(points, a, b):
    """The control points of [a, b]."""
    def halves(points, t):
        left, right = [points[0]], [points[-1]]
        while len(points) > 1:
            points = (1 - t) * points[:-1] + t * points[1:]
            left.append(points[0])
            right.append(points[-1])
        return np.array(left), np.array(right[::-1])
    return halves(halves(points, b)[0], a / b if b > 0 else 0)[1]


def hull_of(points):
    """The convex hull of points of the plane, in order."""
    points = sorted(map(tuple, points))

    def side(points):
        out = []
        for p in points:
            while len(out) > 1 and np.cross(np.subtract(out[-1], out[-2]), np.subtract(p, out[-2])) <= 0:
                out.pop()
            out.append(p)
        return out[:-1]
    return np.array(side(points) + side(points[::-1]))


def figure_6():
    """The hulls of the intervals that are still open when so many have been examined."""
    points = np.array([[0, 0], [0.3, 3.5], [1.0, -3.5], [1.7, 4.5], [2.4, -4.5], [3.2, 3.0], [3.4, 0.2]])
    corners = np.array([[1.0, 0.75], [2.1, 0.62], [2.3, 1.2], [1.3, 1.3]])
    curve, polygon = cprox.bezier(flat(points)), cprox.Obstacle(cprox.polygon(corners))
    least = cprox.distance(curve, polygon, epsilon=1e-10).upper
    figure, all_axes = plt.subplots(1, 4, figsize=(11, 2.9), sharex=True, sharey=True)
    breaks = [0.0, 1.0]
    for axes, stage in zip(all_axes, (0, 1, 2, 3)):
        while len(breaks) - 1 < 2 ** stage:
            breaks = sorted(set(breaks) | {0.5 * (a + b) for a, b in zip(breaks, breaks[1:])})
        drawn = 0
        axes.add_patch(Polygon(corners, color=GREY, alpha=0.6))
        for a, b in zip(breaks, breaks[1:]):
            control = casteljau(points, a, b)
            hull = cprox.Obstacle(cprox.polytope(flat(control)))
            if cprox.pair(hull, polygon).lower > least + 1e-9:
                continue  # it cannot hold the nearest point
            drawn += 1
            axes.add_patch(Polygon(hull_of(control), facecolor=ORANGE, edgecolor=ORANGE, alpha=0.35))
        t = np.linspace(0, 1, 300)
        axes.plot(*curve(t)[:, :2].T, color=BLUE)
        axes.set_title(f'{len(breaks) - 1} parts: {drawn} open', fontsize=10)
        axes.set_aspect('equal')
        axes.set_ylim(-1.0, 1.8)
        axes.axis('off')
    nearest = cprox.distance(curve, polygon, epsilon=1e-10)
    all_axes[-1].plot(*np.array([nearest.witness_mover, nearest.witness_obstacle])[:, :2].T, 'o-', color=RED, markersize=3)
    return figure


def contours(letter, x):
    """The closed outlines of a glyph as piecewise curves, and as points to draw."""
    path = TextPath((x, 0), letter, size=1.0)
    found, pieces, at, start = [], [], None, None
    vertices, codes = path.vertices, path.codes
    i = 0
    while i < len(codes):
        n = {Path.CURVE3: 2, Path.CURVE4: 3}.get(codes[i], 1)
        if codes[i] == Path.MOVETO:
            start = at = vertices[i]
        else:
            ends = [start] if codes[i] == Path.CLOSEPOLY else list(vertices[i:i + n])
            if np.linalg.norm(np.subtract(ends[-1], at)) > 1e-9:
                pieces.append(cprox.bezier(flat([at, *ends])))
                at = ends[-1]
            if codes[i] == Path.CLOSEPOLY and pieces:
                found.append(cprox.piecewise(pieces, ends=list(map(float, range(len(pieces) + 1))), gap=1e-9))
                pieces = []
        i += n
    return found


def figure_8():
    """Glyphs are Bézier curves end to end: the distance of each from the next."""
    letters, figure = 'RSS&9', plt.figure(figsize=(7, 2.2))
    axes = figure.add_subplot()
    x, glyphs = 0.0, []
    for letter in letters:
        glyphs.append(contours(letter, x))
        x += 0.85
    for outline in sum(glyphs, []):
        t = np.linspace(outline.t0, outline.t1, 400)
        axes.plot(*outline(t)[:, :2].T, color=BLUE)
    for left, right in zip(glyphs, glyphs[1:]):
        best = min((cprox.distance(a, cprox.Obstacle.from_curve(b), epsilon=1e-9) for a in left for b in right), key=lambda r: r.upper)
        ends = np.array([best.witness_mover, best.witness_obstacle])[:, :2]
        axes.plot(*ends.T, 'o-', color=RED, markersize=3)
        axes.annotate(f'{best.upper:.4f}\n{best.nodes} intervals', [ends[:, 0].mean(), -0.12], ha='center', va='top', fontsize=7, color=RED)
    axes.set_aspect('equal')
    axes.axis('off')
    return figure


def section_5d():
    """Two vehicles on one clock, each within a disc that grows with time."""
    first = cprox.bezier(flat([[0, 0], [1.2, 0.2], [2.0, 1.6], [3.4, 1.4]]))
    second = cprox.bezier(flat([[2.6, -0.6], [2.4, 0.6], [1.9, 2.2], [0.6, 2.2]]))
    radii = ([0.1, 0.1, 0.06], [0.08, 0.14])
    a, b = (cprox.tube(curve, radius) for curve, radius in zip((first, second), radii))
    found = cprox.distance(a, cprox.Obstacle.synchronized(b), epsilon=1e-9)
    figure, axes = plt.subplots(figsize=(5.5, 3.4))
    for curve, radius, colour in ((first, radii[0], BLUE), (second, radii[1], ORANGE)):
        t = np.linspace(0, 1, 200)
        axes.plot(*curve(t)[:, :2].T, color=colour)
        for moment in np.linspace(0, 1, 9):
            axes.add_patch(Circle(curve(moment)[:2], np.polyval(radius[::-1], moment), color=colour, alpha=0.15))
        axes.add_patch(Circle(curve(found.t)[:2], np.polyval(radius[::-1], found.t), fill=False, color=colour, linewidth=1.5))
    axes.plot(*np.array([found.witness_mover, found.witness_obstacle])[:, :2].T, 'o-', color=RED, markersize=3)
    axes.set_title(f'least distance {found.upper:.4f} m, at t = {found.t:.3f}, in {found.nodes} intervals', fontsize=10)
    axes.set_aspect('equal')
    axes.axis('off')
    return figure


def main():
    out = sys.argv[1] if len(sys.argv) > 1 else os.path.join(HERE, '..', 'doc', 'charts')
    os.makedirs(out, exist_ok=True)
    for name, draw in (('papers_figure_6', figure_6), ('papers_figure_8', figure_8), ('papers_section_5d', section_5d)):
        figure = draw()
        figure.savefig(os.path.join(out, name + '.png'), bbox_inches='tight', dpi=130, metadata={'Software': None})
        plt.close(figure)


if __name__ == '__main__':
    main()
