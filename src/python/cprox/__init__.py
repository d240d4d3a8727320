# SPDX-License-Identifier: BSD-3-Clause
"""Certified proximity queries of continuous motions, for NumPy.

Shapes, curves and obstacles are immutable; any number of threads may share them. Queries release the GIL. Lengths are
in metres, angles in radians, poses are homogeneous matrices of shape (4, 4). A failed call is a ValueError.

    import cprox
    curve = cprox.bezier([[-1, 0, 0], [0, 1, 0], [1, 0, 0]])
    wall = cprox.Obstacle(cprox.box([0.1, 1, 1]), cprox.transform([0, 2, 0]))
    answer = cprox.distance(cprox.tube(curve, 0.2), wall)
    print(answer.lower, answer.upper, answer.t)
"""
from ._cprox import *  # noqa: F401,F403
from ._cprox import __version__  # noqa: F401
