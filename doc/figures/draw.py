#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of doc/: /usr/bin/python3 doc/figures/draw.py [NAME ...], each as doc/figures/NAME.png."""
import csv
import io
import os
import subprocess
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Circle, FancyBboxPatch, Polygon, Rectangle

HERE = os.path.dirname(os.path.abspath(__file__))
BLUE, ORANGE, GREEN, RED, GREY = '#2a6db0', '#d9822b', '#3a8f4d', '#b83232', '#777777'
plt.rcParams.update({'font.size': 10, 'font.family': 'DejaVu Sans', 'axes.spines.top': False, 'axes.spines.right': False})


def canvas(width=8.0, height=3.2, n=1):
    """A figure of n drawings side by side, without axes."""
    figure, axes = plt.subplots(1, n, figsize=(width, height), squeeze=False)
    for a in axes[0]:
        a.set_aspect('equal')
        a.axis('off')
    return (figure, *axes[0])


def bezier(points, t):
    """Points of a Bézier curve by de Casteljau."""
    p = np.repeat(np.asarray(points, float)[None], len(t), 0)
    s = np.asarray(t)[:, None, None]
    while p.shape[1] > 1:
        p = (1 - s) * p[:, :-1] + s * p[:, 1:]
    return p[:, 0]


def arrow(axes, a, b, colour='black', style='->', **more):
    axes.annotate('', xy=b, xytext=a, arrowprops=dict(arrowstyle=style, color=colour, lw=1.3, shrinkA=0, shrinkB=0, **more))


def outline(axes, points, colour, alpha=0.25, **more):
    axes.add_patch(Polygon(points, closed=True, facecolor=colour, alpha=alpha, edgecolor='none'))
    axes.add_patch(Polygon(points, closed=True, fill=False, edgecolor=colour, lw=1.4, **more))


def flow(figure_size, boxes, arrows):
    """Boxes (name: (x, y, text, colour)) and arrows (from, to, label) between their nearest sides."""
    figure, axes = canvas(*figure_size)
    size = {}
    for name, (x, y, text, colour) in boxes.items():
        lines = text.split('\n')
        w, h = 0.115 * max(len(line) for line in lines) + 0.25, 0.27 * len(lines) + 0.2
        size[name] = (w, h)
        axes.add_patch(FancyBboxPatch((x - w / 2, y - h / 2), w, h, boxstyle='round,pad=0.02,rounding_size=0.08',
                                      facecolor=colour, alpha=0.18, edgecolor='none'))
        axes.add_patch(FancyBboxPatch((x - w / 2, y - h / 2), w, h, boxstyle='round,pad=0.02,rounding_size=0.08',
                                      fill=False, edgecolor=colour, lw=1.3))
        axes.text(x, y, text, ha='center', va='center', fontsize=9)
    for a, b, label in arrows:
        (xa, ya), (xb, yb) = boxes[a][:2], boxes[b][:2]
        (wa, ha), (wb, hb) = size[a], size[b]
        if abs(xb - xa) - (wa + wb) / 2 >= abs(yb - ya) - (ha + hb) / 2:
            s = np.sign(xb - xa)
            start, end = (xa + s * (wa / 2 + 0.04), ya), (xb - s * (wb / 2 + 0.06), yb)
        else:
            s = np.sign(yb - ya)
            start, end = (xa, ya + s * (ha / 2 + 0.04)), (xb, yb - s * (hb / 2 + 0.06))
        arrow(axes, start, end, GREY)
        if label:
            axes.text((start[0] + end[0]) / 2, (start[1] + end[1]) / 2 + 0.07, label, ha='center', va='bottom', fontsize=8,
                      color=GREY)
    xs = [x + s * size[n][0] / 2 for n, (x, _, _, _) in boxes.items() for s in (-1, 1)]
    ys = [y + s * size[n][1] / 2 for n, (_, y, _, _) in boxes.items() for s in (-1, 1)]
    axes.set_xlim(min(xs) - 0.1, max(xs) + 0.1)
    axes.set_ylim(min(ys) - 0.1, max(ys) + 0.1)
    return figure


def curve_bound():
    figure, axes = canvas(8, 3.4)
    box = np.array([(0.6, -0.9), (3.4, -0.9), (3.7, 0.1), (2.1, 0.62), (0.5, 0.1)])
    outline(axes, box, BLUE)
    control = np.array([(0.2, 2.1), (1.3, 1.25), (2.9, 1.15), (4.2, 2.3)])
    axes.plot(*control.T, 'o--', color=ORANGE, lw=0.9, ms=4)
    axes.plot(*bezier(control, np.linspace(0, 1, 100)).T, color=ORANGE, lw=2)
    n = np.array([0.03, 1.0]) / np.hypot(0.03, 1.0)
    h, least = (box @ n).max(), (control @ n).min()
    for value, colour, text in ((h, BLUE, r'$n\cdot x = h_B(n)$'), (least, ORANGE, r'$n\cdot x = \min_i\ n\cdot P_i$')):
        x = np.array([-0.8, 5.0])
        y = (value - n[0] * x) / n[1]
        axes.plot(x, y, color=colour, lw=1, ls=':')
        axes.text(5.05, y[1], text, va='center', color=colour)
    x = -0.55
    arrow(axes, (x, (h - n[0] * x) / n[1]), (x, (least - n[0] * x) / n[1]), 'black', '<->')
    axes.text(x - 0.1, (h + least) / 2, 'lower bound\nof the piece', ha='right', va='center')
    arrow(axes, (2.1, 0.62), tuple(np.array([2.1, 0.62]) + 0.38 * n))
    axes.text(2.2, 0.83, 'n')
    axes.text(1.9, -0.35, 'B', color=BLUE, fontsize=13)
    axes.text(3.55, 2.02, 'ψ', color=ORANGE, fontsize=13, ha='right')
    for i, p in enumerate(control):
        axes.text(p[0], p[1] + 0.12, f'$P_{i}$', color=ORANGE, ha='center')
    axes.set_xlim(-1.9, 6.9)
    axes.set_ylim(-1.0, 2.6)
    return figure


def batches():
    figure, left, right = canvas(9, 3.4, 2)
    hull = np.array([(-1.1, -0.5), (0.5, -0.8), (1.15, -0.1), (0.6, 0.65), (-0.9, 0.55)])
    for axes in (left, right):
        outline(axes, hull, BLUE)
        control = np.array([(-2.2, 1.9), (-0.9, 0.5), (0.7, 1.9), (2.4, 0.9)])
        axes.plot(*bezier(control, np.linspace(0, 1, 200)).T, color=ORANGE, lw=2)
        axes.set_xlim(-2.4, 2.6)
        axes.set_ylim(-1.6, 2.1)
    left.add_patch(Circle((-0.02, -0.02), 1.22, fill=False, ec=GREY, lw=1.2))
    left.add_patch(Circle((-0.2, -0.02), 0.59, fill=False, ec=GREEN, lw=1.2))
    knots = bezier(control, np.linspace(0, 1, 17))
    left.plot(*knots.T, '.-', color='black', lw=0.7, ms=4)
    for i in range(0, 16, 4):
        part = knots[i:i + 5]
        low, high = part.min(0), part.max(0)
        left.add_patch(Rectangle(low, *(high - low), fill=False, ec=RED, lw=0.9))
    left.text(0.9, -1.15, 'bounding sphere', color=GREY)
    left.text(-0.5, -0.05, 'inscribed\nball', color=GREEN, fontsize=8, va='center')
    left.text(1.3, 1.75, 'AABBs of four chords', color=RED, fontsize=9, ha='center')
    left.set_title('steps 1 and 2', fontsize=10)
    right.add_patch(Rectangle((-1.1, -0.8), 2.25, 1.45, fill=False, ec=GREY, lw=1.2))
    right.plot(*knots.T, '.-', color='black', lw=0.7, ms=4)
    best = knots[np.argmin(knots[:, 1] + 0 * knots[:, 0])]
    best = knots[7]
    arrow(right, (best[0], 0.65), tuple(best), 'black', '<->')
    right.text(best[0] + 0.08, 0.88, 'w', fontsize=11)
    right.text(1.2, -0.7, 'OBB', color=GREY)
    right.set_title('step 3', fontsize=10)
    return figure


def fourier_value(box_a, box_b, x, n, offset):
    """V and the threshold of two squares by the formulas of doc/fourier.md, certified kernel, in units of L = 1."""
    N = (n - 1) // 2
    i = np.arange(N + 1)
    window = np.i0((2 + 0.7 * max(0.0, np.log2(n / 9))) * np.sqrt(1 - (2 * i / N - 1) ** 2))
    w = np.array([(window[:N + 1 - lag] * window[lag:]).sum() for lag in i])
    w /= w[0]
    k = np.arange(-N, N + 1)
    kx, ky = np.meshgrid(k, k)
    weight = w[abs(kx)] * w[abs(ky)]
    box = lambda h: (2 * h) ** 2 * np.sinc(2 * kx * h) * np.sinc(2 * ky * h)
    product = weight * box(box_a + offset) * box(box_b + offset)
    value = np.array([(product * np.cos(2 * np.pi * kx * at)).sum() for at in x])
    # the ball's transform, by Bessel's J1 as an integral
    q = 2 * np.pi * np.hypot(kx, ky) * offset
    phi = (np.arange(400) + 0.5) * np.pi / 400
    j1 = np.cos(phi[None, None] - q[..., None] * np.sin(phi)).mean(-1)
    disc = np.pi * offset ** 2 * np.where(q == 0, 1.0, 2 * j1 / np.where(q == 0, 1.0, q))
    return value / (weight * disc ** 2).sum()


def fourier():
    figure = plt.figure(figsize=(9, 3.3))
    axes = figure.add_axes([0.01, 0.05, 0.4, 0.88])
    axes.set_aspect('equal')
    axes.axis('off')
    v = np.array([(0, 0), (2, 0), (2, 0.6), (0.7, 0.6), (0.7, 2), (0, 2)])
    rho, loop = 0.25, []
    for i, p in enumerate(v):
        d, e = p - v[i - 1], v[(i + 1) % len(v)] - p
        m, n = np.array([d[1], -d[0]]) / np.hypot(*d), np.array([e[1], -e[0]]) / np.hypot(*e)
        turn = m[0] * n[1] - m[1] * n[0]
        if turn < 0:
            loop += [p + rho * m, p, p + rho * n]
            continue
        angle = np.arctan2(turn, m @ n)
        steps = int(np.ceil(angle / (np.pi / 8) - 1e-9))
        half = 0.5 * angle / steps
        for j in range(steps):
            c, s = np.cos((2 * j + 1) * half), np.sin((2 * j + 1) * half)
            loop.append(p + rho / np.cos(half) * np.array([c * m[0] - s * m[1], s * m[0] + c * m[1]]))
    outline(axes, v, BLUE)
    loop = np.array(loop + loop[:1])
    axes.plot(*loop.T, color=ORANGE, lw=1.4)
    axes.text(0.35, 0.95, 'F', color=BLUE, fontsize=14, ha='center')
    arrow(axes, (1.4, 0.6), (1.4, 0.85), GREY, '<->')
    axes.text(1.46, 0.72, 'ρ', va='center')
    axes.annotate('reflex corner:\nthe loop visits it', xy=(0.7, 0.6), xytext=(1.15, 1.45), color=ORANGE,
                  arrowprops=dict(arrowstyle='->', color=ORANGE), fontsize=9)
    axes.set_xlim(-0.4, 2.6)
    axes.set_ylim(-0.4, 2.4)

    axes = figure.add_axes([0.5, 0.17, 0.48, 0.74])
    h = 0.08
    for n, colour in ((17, GREY), (33, ORANGE), (65, BLUE)):
        clear = np.linspace(-0.06, 0.2, 260)
        axes.semilogy(clear, np.maximum(fourier_value(h, h, clear + 2 * h, n, 0.75 / n), 1e-3), color=colour, label=f'n_s = {n}')
    axes.axhline(1, color='black', lw=0.8)
    axes.axvline(0, color='black', lw=0.8, ls=':')
    axes.text(0.197, 1.15, 'may collide', ha='right', va='bottom', fontsize=9)
    axes.text(-0.057, 0.8, 'proven clear', va='top', fontsize=9)
    axes.set_xlabel('clearance of two squares, edge 0.16 L, face to face, in L')
    axes.set_ylabel('V/θ')
    axes.set_ylim(1e-2, 1e3)
    axes.legend(frameon=False)
    return figure


def superellipse(p, a, b, n=400):
    t = np.linspace(0, 2 * np.pi, n)
    c, s = np.cos(t), np.sin(t)
    return np.c_[a * np.sign(c) * abs(c) ** (2 / p), b * np.sign(s) * abs(s) ** (2 / p)]


def implicit():
    figure, axes = canvas(8, 3.2)
    turn = lambda x, angle: x @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    a = turn(superellipse(5, 1.0, 0.7), 0.25)
    b = turn(superellipse(1.3, 1.2, 0.8), -0.3) + np.array([3.4, 0.5])
    outline(axes, a, BLUE)
    outline(axes, b, GREEN)
    distance = np.hypot(a[:, None, 0] - b[None, :, 0], a[:, None, 1] - b[None, :, 1])
    i, j = np.unravel_index(distance.argmin(), distance.shape)
    x, y = 0.93 * a[i] + 0.07 * a.mean(0), 0.95 * b[j] + 0.05 * b.mean(0)
    n = (y - x) / np.hypot(*(y - x))
    side = np.array([-n[1], n[0]])
    for body, sign, colour in ((a, 1, BLUE), (b, -1, GREEN)):
        p = body[(sign * body @ n).argmax()]
        foot = x + ((p - x) @ n) * n
        axes.plot(*np.array([foot - 1.3 * side, foot + 1.3 * side]).T, color=colour, ls=':', lw=1.2)
    ends = [((body[(s * body @ n).argmax()] - x) @ n) for body, s in ((a, 1), (b, -1))]
    base = x + 0.75 * side
    arrow(axes, tuple(base + ends[0] * n), tuple(base + ends[1] * n), 'black', '<->')
    axes.text(*(base + 0.5 * sum(ends) * n + 0.13 * side), 'lower', ha='center')
    axes.plot(*np.array([x, y]).T, 'o-', color=RED, ms=4, lw=1.2)
    axes.text(*(0.5 * (x + y) - 0.2 * side), '|e| = upper', color=RED, ha='center')
    axes.text(x[0] - 0.12, x[1] - 0.05, 'x', color=RED, ha='right')
    axes.text(y[0] + 0.12, y[1] - 0.05, 'y', color=RED)
    axes.text(-0.1, 0, 'A', color=BLUE, fontsize=13)
    axes.text(3.5, 0.45, 'B', color=GREEN, fontsize=13)
    axes.set_xlim(-1.4, 4.9)
    axes.set_ylim(-1.2, 1.75)
    return figure


def robot_bounds():
    figure, axes = canvas(8, 3.6)
    def arm(q1, q2, colour, alpha, lw):
        a = 1.5 * np.array([np.cos(q1), np.sin(q1)])
        b = a + 1.2 * np.array([np.cos(q1 + q2), np.sin(q1 + q2)])
        axes.plot(*np.array([(0, 0), a, b]).T, 'o-', color=colour, alpha=alpha, lw=lw, ms=4)
        return a, b
    for d in (-0.16, 0.16):
        a, b = arm(0.35 + d, 0.5 + 1.3 * d, BLUE, 0.3, 3)
        axes.add_patch(Circle(b, 0.3, ec=BLUE, fill=False, alpha=0.35))
    a, b = arm(0.35, 0.5, BLUE, 1.0, 4)
    axes.add_patch(Circle(b, 0.3, fc=BLUE, ec=BLUE, alpha=0.25))
    axes.add_patch(Circle(b, 0.3 + 0.16 * 1.7 + 0.21 * 1.3 + 0.25, ec=ORANGE, fill=False, ls='--', lw=1.2))
    for start, name, off in (((0, 0), r'lever arm $r^\circ_1$', (-0.95, 0.28)), (tuple(a), r'$r^\circ_2$', (0.12, -0.22))):
        d = b - np.array(start)
        end = tuple(b + 0.3 * d / np.hypot(*d))
        axes.plot(*np.array([start, end]).T, color=GREY, lw=1, ls=':')
        axes.text((start[0] + end[0]) / 2 + off[0], (start[1] + end[1]) / 2 + off[1], name, color=GREY)
    axes.text(b[0] + 1.05, b[1] + 0.75, r'ball of the part, enlarged by' + '\n' + r'the motion bound $\Sigma_k\,del_k\,r^\circ_k$',
              color=ORANGE, va='center')
    outline(axes, np.array([(4.2, 0.0), (5.3, 0.0), (5.3, 0.75), (4.2, 0.75)]), RED)
    axes.text(4.75, 0.37, 'obstacle', color=RED, ha='center', va='center')
    axes.text(-0.1, -0.22, 'axis 1', ha='center')
    axes.text(a[0] + 0.05, a[1] - 0.25, 'axis 2', ha='center')
    axes.set_xlim(-0.6, 6.4)
    axes.set_ylim(-0.4, 2.7)
    return figure


def time_of_contact():
    figure, axes = plt.subplots(figsize=(8, 2.9))
    t = np.linspace(0, 10, 500)
    f = lambda t: 1.5 - 0.27 * t + 0.22 * np.sin(1.1 * t + 0.4)
    axes.plot(t, f(t), color=BLUE)
    contact = t[np.argmax(f(t) <= 0)]
    edges = [0, 1.6, 2.8, 4.0, 4.8, contact - 0.45, contact - 0.18, contact - 0.04]
    for a, b in zip(edges, edges[1:]):
        lower = max(f(np.linspace(a, b, 50)).min() - 0.05 * (b - a), 0.015)
        axes.add_patch(Rectangle((a, 0), b - a, lower, fc=GREEN, alpha=0.3, ec=GREEN))
    axes.axhline(0, color='black', lw=0.8)
    axes.plot([contact], [0], 'o', color=RED)
    axes.annotate('contact: t_contact_lower is proven free before,\nt is a time at which contact is proven',
                  xy=(contact, 0), xytext=(contact + 0.3, 0.95), arrowprops=dict(arrowstyle='->'))
    axes.text(0.2, 0.2, 'intervals proven free, from left to right', color=GREEN, fontsize=9)
    axes.set_xlabel('t')
    axes.set_ylabel('distance')
    axes.set_xlim(0, 9.5)
    axes.set_ylim(-0.45, 1.8)
    axes.set_yticks([0])
    axes.set_xticks([])
    figure.tight_layout()
    return figure


def convex_pairs():
    figure, left, right = canvas(9, 3.2, 2)
    a = np.array([(0, 0), (1.5, 0.1), (1.8, 1.0), (0.7, 1.6), (-0.2, 0.9)])
    b = np.array([(-0.5, -0.4), (0.6, -0.5), (0.4, 0.6)])
    from matplotlib.path import Path  # noqa: F401
    def hull(points):
        points = sorted(map(tuple, points))
        def half(points):
            out = []
            for p in points:
                while len(out) > 1 and np.cross(np.subtract(out[-1], out[-2]), np.subtract(p, out[-2])) <= 0:
                    out.pop()
                out.append(p)
            return out
        return np.array(half(points)[:-1] + half(points[::-1])[:-1])
    for axes, shift, title in ((left, np.array([3.1, 0.5]), 'apart: φ = distance'),
                               (right, np.array([1.2, 0.75]), 'overlapping: −φ = depth')):
        m = hull((a[:, None] - (b + shift)[None]).reshape(-1, 2))
        outline(axes, m, BLUE, 0.15)
        angles = np.linspace(0, 2 * np.pi, 7200)
        u = np.c_[np.cos(angles), np.sin(angles)]
        phi = (m @ u.T).min(0)
        best, value = u[phi.argmax()], phi.max()
        side = np.array([-best[1], best[0]])
        line = value * best + np.linspace(-1.5, 1.5, 2)[:, None] * side
        axes.plot(*line.T, color=ORANGE, ls=':', lw=1.4)
        arrow(axes, (0, 0), tuple(value * best), RED, '<->')
        axes.plot(0, 0, 'o', color='black')
        axes.text(0.02, 0.15, '0', ha='center')
        axes.text(*(m.mean(0)), 'M = A − B', color=BLUE, ha='center')
        axes.text(*(0.5 * value * best - 0.28 * side), '|φ|', color=RED, ha='center', va='center')
        axes.set_title(title, fontsize=10)
        axes.set_xlim(min(m[:, 0].min(), 0) - 0.5, max(m[:, 0].max(), 0) + 0.7)
        axes.set_ylim(min(m[:, 1].min(), 0) - 0.4, max(m[:, 1].max(), 0) + 0.4)
    return figure


def non_convex():
    figure, *all_axes = canvas(9, 2.6, 3)
    shape = np.array([(0, 0), (2, 0), (2, 0.5), (0.5, 0.5), (0.5, 1.5), (2, 1.5), (2, 2), (0, 2)])
    hull = np.array([(0, 0), (2, 0), (2, 2), (0, 2)])
    for axes, title in zip(all_axes, ('sphere', 'hull', 'mesh')):
        axes.set_title(f'level of detail: {title}', fontsize=10)
        outline(axes, shape, BLUE, 0.3 if title == 'mesh' else 0.12)
        if title == 'sphere':
            axes.add_patch(Circle((1, 1), np.sqrt(2), fc=ORANGE, alpha=0.18))
            axes.add_patch(Circle((1, 1), np.sqrt(2), fill=False, ec=ORANGE))
        if title == 'hull':
            outline(axes, hull, ORANGE, 0.18)
        axes.plot([1.3, 3.7], [0.98, 1.9] if title != 'mesh' else [0.98, 1.9], color=GREEN, lw=2)
        axes.text(3.7, 1.95, 'curve', color=GREEN, ha='right', va='bottom')
        if title == 'mesh':
            for box in ((0, 0, 2, 0.5), (0, 0.5, 0.5, 1.0), (0, 1.5, 2, 0.5)):
                axes.add_patch(Rectangle(box[:2], *box[2:], fill=False, ec=RED, lw=0.9, ls='--'))
            axes.text(2.1, 0.2, 'AABBs of the BVH', color=RED, fontsize=8)
        axes.set_xlim(-0.6, 4.2)
        axes.set_ylim(-0.6, 2.6)
    return figure


def rounding():
    figure, axes = plt.subplots(figsize=(8, 1.9))
    axes.axis('off')
    axes.set_xlim(0, 10)
    axes.set_ylim(-1.1, 1.3)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.add_patch(Rectangle((2.0, -0.22), 6.2, 0.44, fc=GREEN, alpha=0.2, ec='none'))
    for x, text, colour, up in ((2.0, 'lower', GREEN, -1), (3.1, 'computed bound', BLUE, 1), (5.2, 'true distance', RED, -1),
                                (7.1, 'computed distance', BLUE, 1), (8.2, 'upper', GREEN, -1)):
        axes.plot([x, x], [-0.3, 0.3], color=colour, lw=2)
        axes.text(x, 0.45 if up > 0 else -0.45, text, ha='center', va='bottom' if up > 0 else 'top', color=colour)
    for a, b in ((3.1, 2.0), (7.1, 8.2)):
        arrow(axes, (a, 0), (b, 0))
    axes.text(2.55, 0.07, 'rounding', ha='center', fontsize=8)
    axes.text(7.65, 0.07, 'rounding', ha='center', fontsize=8)
    return figure


def certificates():
    figure, axes = canvas(8, 3.0)
    box = np.array([(1.6, -0.6), (3.6, -0.6), (3.6, 0.4), (1.6, 0.4)])
    outline(axes, box, BLUE)
    control = np.array([(-0.3, -0.3), (1.2, 2.5), (3.4, 2.0), (5.8, -0.4)])
    cuts = [0, 0.24, 0.5, 0.78, 1]
    normals = np.array([(-1, 0.25), (-0.35, 1), (0.1, 1), (1, 0.45)])
    for i, (a, b) in enumerate(zip(cuts, cuts[1:])):
        p = bezier(control, np.linspace(a, b, 50))
        axes.plot(*p.T, lw=2.5, color=(ORANGE, GREEN)[i % 2])
        n = normals[i] / np.hypot(*normals[i])
        foot = box[(box @ n).argmax()]
        side = np.array([-n[1], n[0]])
        axes.plot(*np.array([foot - 0.9 * side, foot + 0.9 * side]).T, ls=':', lw=1.1, color=(ORANGE, GREEN)[i % 2])
        arrow(axes, tuple(foot), tuple(foot + 0.45 * n), (ORANGE, GREEN)[i % 2])
        axes.text(*(p[25] + 0.22 * n), f'interval {i + 1}', ha='center', fontsize=8)
        axes.text(*(foot + 0.52 * n), f'$n_{i + 1}$', ha='center', va='center', fontsize=9)
    axes.set_xlim(-0.9, 6.4)
    axes.set_ylim(-0.8, 2.3)
    return figure


def ros():
    return flow((9, 3.0), {
        'planner': (0.9, 2.3, 'planner, rosservice', GREY),
        'sensors': (0.9, 1.15, 'clouds, octrees,\nCollisionObjects', GREY),
        'robot': (0.9, 0.0, 'robot_description,\ntf2, joint states', GREY),
        'node': (5.1, 1.15, 'curve_proximity_node\n(or a nodelet)\nscene snapshot, worker threads', BLUE),
        'rviz': (9.0, 2.3, 'RViz: markers', GREEN),
        'out': (9.0, 1.15, 'Proximity results', GREEN),
        'diag': (9.0, 0.0, 'diagnostics', GREEN),
    }, [('planner', 'node', 'services, action'), ('sensors', 'node', 'topics'), ('robot', 'node', ''),
        ('node', 'rviz', ''), ('node', 'out', ''), ('node', 'diag', '')])


def command_line():
    return flow((9, 2.4), {
        'curves': (0.9, 1.8, 'CURVES.csv or\nrobot + trajectory', GREY),
        'scene': (0.9, 0.5, 'SCENE.yaml', GREY),
        'cprox': (4.1, 1.15, 'cprox QUERY', BLUE),
        'csv': (7.0, 1.8, 'results.csv,\nexit code', GREEN),
        'proof': (7.0, 0.5, 'certificate', GREEN),
        'check': (9.7, 0.5, 'cprox_check:\nproven or not', ORANGE),
    }, [('curves', 'cprox', ''), ('scene', 'cprox', ''), ('cprox', 'csv', ''), ('cprox', 'proof', ''), ('proof', 'check', '')])


def c_api():
    return flow((9, 2.6), {
        'curve': (0.9, 2.0, 'cprox_curve,\ncprox_motion', BLUE),
        'body': (0.9, 0.5, 'cprox_body,\ncprox_obstacles', BLUE),
        'mover': (3.6, 2.0, 'mover: what moves', GREY),
        'obstacle': (3.6, 0.5, 'obstacle: body,\npose, margin', GREY),
        'query': (6.6, 1.25, 'query with options\nand a workspace', ORANGE),
        'result': (9.6, 1.25, 'lower ≤ distance ≤ upper,\nverdict, t, witness points', GREEN),
    }, [('curve', 'mover', ''), ('body', 'obstacle', ''), ('mover', 'query', ''), ('obstacle', 'query', ''),
        ('query', 'result', '')])


def scenes():
    return flow((9, 2.8), {
        'yaml': (0.9, 2.2, 'SCENE.yaml', GREY),
        'topic': (0.9, 1.1, 'CollisionObject\nmessages', GREY),
        'mesh': (0.9, 0.0, 'mesh files', GREY),
        'reader': (3.7, 0.0, 'mesh reader\n(own process)', ORANGE),
        'scene': (6.1, 1.1, 'scene: objects, links,\nallowed pairs, margins', BLUE),
        'snap': (9.3, 1.1, 'immutable snapshot\nper query', GREEN),
    }, [('yaml', 'scene', ''), ('topic', 'scene', ''), ('mesh', 'reader', ''), ('reader', 'scene', ''), ('scene', 'snap', '')])


def python():
    return flow((9, 2.4), {
        'numpy': (0.9, 1.1, 'your program,\nNumPy arrays', GREY),
        'package': (3.6, 1.1, 'package cprox\n(pybind11)', ORANGE),
        'scene': (6.4, 2.0, 'scene classes:\nURDF, meshes, motions', BLUE),
        'core': (9.4, 1.1, 'libcprox', BLUE),
    }, [('numpy', 'package', ''), ('package', 'scene', ''), ('package', 'core', ''), ('scene', 'core', '')])


def bookshelf():
    """The clearance of a saved plan, and under errors: asks cprox (scripts/run /usr/bin/python3 doc/figures/draw.py bookshelf)."""
    root = os.path.dirname(os.path.dirname(HERE))
    words = ['cprox', 'profile', '--intervals', '72', '--robot', 'test/data/robots/panda/panda.urdf', '--srdf',
             'test/data/robots/panda/panda.srdf', '--scene', 'test/data/scenes/mbm/bookshelf_tall_panda/scene0001.yaml',
             '--trajectory', 'test/data/trajectories/panda_bookshelf_tall_0001_rrt.yaml']
    figure, axes = plt.subplots(figsize=(8, 3))
    for more, colour, label in (([], BLUE, 'the plan'),
                                (['--errors', 'examples/bookshelf/errors.yaml'], ORANGE, 'its worst execution')):
        text = subprocess.run(words + more, cwd=root, check=True, capture_output=True, text=True).stdout
        rows = list(csv.DictReader(io.StringIO(text)))
        times = [float(rows[0]['t0'])] + [float(row['t1']) for row in rows]
        axes.stairs([1000 * float(row['lower']) for row in rows], times, baseline=None, color=colour, lw=1.5, label=label)
    axes.set_yscale('log')
    axes.set_xlabel('time [s]')
    axes.set_ylabel('clearance [mm]')
    axes.legend(frameon=False)
    return figure


def main():
    drawings = {name: value for name, value in globals().items()
                if callable(value) and name in ('curve_bound', 'batches', 'fourier', 'implicit', 'robot_bounds', 'time_of_contact',
                                                'convex_pairs', 'non_convex', 'rounding', 'certificates', 'ros', 'command_line',
                                                'c_api', 'scenes', 'python', 'bookshelf')}
    for name in sys.argv[1:] or drawings:
        figure = drawings[name]()
        figure.savefig(os.path.join(HERE, name + '.png'), dpi=100, bbox_inches='tight', pad_inches=0.08)
        plt.close(figure)


if __name__ == '__main__':
    main()
