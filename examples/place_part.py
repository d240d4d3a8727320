#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Places a part as near to its goal in a bracket as the bracket allows, from random poses, most of them in contact: once by the
signed distance alone, once led by Fourier gaps from coarse to fine. Prints how many starts of each end near the best.

  place_part.py [STARTS]

The part is an L of two boxes, the bracket four boxes. The goal is a third of a metre inside the bracket. The objective has a
penalty for overlaps, whose weight grows; SciPy's L-BFGS-B minimises it. The distance ends both ways, and judges both."""
import sys

import cprox
import numpy
from scipy.optimize import minimize

BRACKET = [((-0.8, -0.3, -0.6), (0.8, 0.0, 0.6)), ((-0.8, 0.0, -0.6), (-0.5, 0.9, 0.6)), ((0.5, 0.0, -0.6), (0.8, 0.9, 0.6)),
           ((-0.8, -0.3, -0.9), (0.8, 0.9, -0.6))]
PART = [((-0.4, -0.3, -0.4), (0.4, 0.0, 0.4)), ((-0.4, 0.0, -0.4), (-0.1, 0.5, 0.4))]
GOAL, WEIGHTS = numpy.array([0.0, -0.05, 0.0, 0.0, 0.0, 0.0]), numpy.array([1.0, 1.0, 1.0, 0.1, 0.1, 0.1])
LEAST = 0.05  # of V/t: below this its logarithm is continued by the tangent


def boxes(corners):
    """Size and pose of each box."""
    return [(numpy.subtract(high, low), cprox.transform(numpy.add(low, high) / 2)) for low, high in corners]


def solid(corners):
    sizes, poses = zip(*boxes(corners))
    return cprox.Solid.union([cprox.Solid.box(size) for size in sizes], list(poses))


def skew(r):
    return numpy.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])


def pose_at(x):
    """The pose, and the matrix that takes a step of the rotation vector to a turn in the axes of the world."""
    pose, k, a = numpy.eye(4), skew(x[3:]), numpy.linalg.norm(x[3:])
    c, s = ((1 - numpy.cos(a)) / a**2, (a - numpy.sin(a)) / a**3) if a > 1e-4 else (0.5, 1 / 6)
    turns = numpy.eye(3) + c * k + s * k @ k
    pose[:3, :3] = numpy.eye(3) + turns @ k
    pose[:3, 3] = x[:3]
    return pose, turns


class Distance:
    """The least signed distance of all pairs of boxes [m], negative in an overlap."""

    def __init__(self):
        self.bracket = [cprox.Obstacle(cprox.box(size), pose) for size, pose in boxes(BRACKET)]
        self.part = [(cprox.box(size), pose) for size, pose in boxes(PART)]

    def __call__(self, pose):
        answers = [cprox.pair(b, cprox.Obstacle(box, pose @ at)) for b in self.bracket for box, at in self.part]
        least = min(answers, key=lambda answer: answer.upper)
        return least.upper, -least.normal, numpy.cross(least.witness_obstacle - pose[:3, 3], -least.normal)


class Gap:
    """A certified gap in metres: -length log(V/t)."""

    def __init__(self, samples):
        self.gap = cprox.FourierGap(solid(BRACKET), solid(PART), samples=samples)

    def __call__(self, pose):
        answer = self.gap.evaluate(pose)
        v = max(answer['value'], LEAST)
        value = -self.gap.length * (numpy.log(v) + min(answer['value'] / LEAST - 1.0, 0.0))
        gradient = -self.gap.length / v * answer['gradient']
        return value, gradient[:3], gradient[3:]


def solve(x, freedom, weight):
    def cost(x):
        pose, turns = pose_at(x)
        value, linear, angular = freedom(pose)
        off = x - GOAL
        total, gradient = (WEIGHTS * off * off).sum(), 2 * WEIGHTS * off
        if value < 0.0:
            total += weight * value * value
            gradient += 2 * weight * value * numpy.concatenate([linear, turns.T @ angular])
        return total, gradient
    return minimize(cost, x, jac=True, method='L-BFGS-B', options={'maxiter': 100}).x


def main():
    starts = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    distance = Distance()
    leading = [Gap(samples) for samples in (9, 17, 33)]
    ways = {'signed distance': [(distance, w) for w in (10, 100, 1e3, 1e4, 1e6)],
            'gaps, then distance': [(gap, w) for gap in leading for w in (10, 100)] + [(distance, w) for w in (1e3, 1e4, 1e6)]}
    costs = {}
    for name, stages in ways.items():
        rng = numpy.random.default_rng(83)
        costs[name] = []
        for _ in range(starts):
            x = numpy.concatenate([rng.uniform(-1.2, 1.2, 3), rng.uniform(-1.5, 1.5, 3)])
            for freedom, weight in stages:
                x = solve(x, freedom, weight)
            free = distance(pose_at(x)[0])[0] >= -1e-3
            costs[name].append((WEIGHTS * (x - GOAL)**2).sum() if free else numpy.inf)
    best = min(min(found) for found in costs.values())
    for name, found in costs.items():
        print(f'{name}: {sum(numpy.isfinite(found))} of {starts} free, {sum(numpy.array(found) <= 1.1 * best)} near the best')


if __name__ == '__main__':
    main()
