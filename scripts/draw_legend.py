#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the legend of the markers' colours, for scripts/rviz_picture:    draw_legend.py OUT.png"""
import math
import sys

STOPS = ((0.78, 0.10, 0.16), (0.96, 0.62, 0.20), (0.35, 0.72, 0.62), (0.10, 0.46, 0.56))
FAR = 0.3  # [m] from here on the last colour


def clearance_colour(clearance):
    """(r, g, b) of a clearance [m], as clearanceColour() in src/ros/markers/canvas.cpp gives it."""
    s = (len(STOPS) - 1) * math.sqrt(min(1.0, max(0.0, clearance / FAR)))
    i = min(len(STOPS) - 2, int(s))
    return tuple(a + (s - i) * (b - a) for a, b in zip(STOPS[i], STOPS[i + 1]))


def main():
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot
    figure = pyplot.figure(figsize=(3.2, 0.8), dpi=100)
    axes = figure.add_axes([0.05, 0.45, 0.86, 0.28])
    axes.imshow([[clearance_colour(FAR * i / 299) for i in range(300)]], aspect='auto', extent=(0, FAR, 0, 1))
    axes.set_yticks([])
    axes.set_xticks([0, 0.1, 0.2, 0.3], ['0', '0.1', '0.2', '≥ 0.3'])
    axes.tick_params(labelsize=8, length=2)
    axes.set_title('clearance [m]', fontsize=9, pad=3)
    figure.savefig(sys.argv[1], facecolor=(1, 1, 1, 0.8))


if __name__ == '__main__':
    main()
