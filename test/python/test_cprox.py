#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The Python package cprox: curves against bodies and scenes, answers against dense samples in NumPy, arrays in and out, files."""
import math
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import numpy

import cprox

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'data')


def de_casteljau(points, t):
    """Points of a Bézier curve at parameters t (n,)."""
    rows = [numpy.outer(numpy.ones_like(t), p) for p in numpy.asarray(points, float)]
    while len(rows) > 1:
        rows = [(1 - t)[:, None] * a + t[:, None] * b for a, b in zip(rows, rows[1:])]
    return rows[0]


def box_distance(p, size):
    """Distances of points (n, 3) from a box about the origin."""
    return numpy.linalg.norm(numpy.maximum(numpy.abs(p) - numpy.asarray(size) / 2, 0), axis=1)


class Curves(unittest.TestCase):
    def test_distances_are_those_of_dense_samples(self):
        random = numpy.random.default_rng(1)
        t = numpy.linspace(0, 1, 20001)
        for _ in range(50):
            points, size = random.uniform(-2, 2, (5, 3)), random.uniform(.1, 1, 3)
            answer = cprox.distance(cprox.bezier(points), cprox.Obstacle(cprox.box(size)))
            sampled = box_distance(de_casteljau(points, t), size).min()
            self.assertLessEqual(answer.lower, sampled + 1e-12)
            self.assertGreater(answer.upper, sampled - 2e-3)
            self.assertLessEqual(answer.upper - answer.lower, 1e-6)
            apart = numpy.linalg.norm(answer.witness_mover - answer.witness_obstacle)
            self.assertAlmostEqual(apart, answer.upper, places=9)

    def test_a_radius_may_change(self):
        """Coefficients of 1, t, t²; against samples, which are above the least distance by less than 1e-6 here."""
        points, other = [[-1, 0, 2], [0, 1, 2], [1, 0, 2]], [[-1, 1, 3], [0, -1, 4], [1, 1, 3]]
        t = numpy.linspace(0, 1, 20001)
        tube, radii = cprox.tube(cprox.bezier(points), [.1, .2, .3]), .1 + .2 * t + .3 * t * t
        answer = cprox.distance(tube, cprox.Obstacle(cprox.box([1, 1, 1])))
        sampled = (box_distance(de_casteljau(points, t), [1, 1, 1]) - radii).min()
        self.assertLessEqual(answer.lower, sampled)
        self.assertAlmostEqual(answer.upper, sampled, delta=2e-6)
        moving = cprox.tube(cprox.bezier(other), [.05, .1])
        answer = cprox.distance(tube, cprox.Obstacle.synchronized(moving))
        apart = numpy.linalg.norm(de_casteljau(points, t) - de_casteljau(other, t), axis=1)
        self.assertAlmostEqual(answer.upper, (apart - radii - .05 - .1 * t).min(), delta=2e-6)
        with self.assertRaises(ValueError):
            cprox.tube(cprox.bezier(points), [[.1]])

    def test_sets_by_their_distance_hold_dense_samples(self):
        random = numpy.random.default_rng(7)
        t = numpy.linspace(0, 1, 4001)
        for k in range(10):
            centres, radii = random.uniform(-.4, .4, (3, 3)), random.uniform(.05, .2, 3)

            def exact(p):
                return (numpy.linalg.norm(numpy.atleast_2d(p)[:, None] - centres, axis=2) - radii).min(axis=1)

            error = 0 if k % 2 else .01
            shape = cprox.distance_function(lambda p: exact(p)[0] + error * numpy.sin(40 * p[0]), [0, 0, 0], 1,
                                            lipschitz=1 + 40 * error, error=error)
            points = random.uniform(-1, 1, (4, 3))
            answer = cprox.distance(cprox.bezier(points), cprox.Obstacle(shape))
            sampled = max(exact(de_casteljau(points, t)).min(), 0)
            self.assertLessEqual(answer.lower, sampled + 1e-12)
            self.assertGreaterEqual(answer.upper, sampled - 1e-3)
            self.assertLessEqual(answer.upper - answer.lower, 1e-6 + 4 * error)

            axes = [numpy.arange(-1, 1.05, .1)] * 3
            z, y, x = numpy.meshgrid(*axes, indexing='ij')
            values = exact(numpy.stack([x, y, z], axis=-1).reshape(-1, 3)).reshape(x.shape)
            grid = cprox.distance_grid(values, .1)
            answer = cprox.distance(cprox.bezier(points), cprox.Obstacle(grid, cprox.transform([-1, -1, -1])))
            self.assertLessEqual(answer.lower, sampled + 1e-12)
            self.assertGreaterEqual(answer.upper, sampled - 1e-3)

        ground = cprox.height_field([[0, 0, 0], [0, .3, 0]], [1, 2], floor=-1)
        answer = cprox.distance(cprox.bezier([[.5, 1, .6], [1.5, 1, .6]]), cprox.Obstacle(ground))
        self.assertGreater(answer.lower, .4)  # above the slope's middle, at .15
        self.assertLess(answer.upper, .45)

    def test_convex_shapes_translate_grow_and_deform(self):
        box, here = cprox.Obstacle(cprox.box([1, 1, 1])), cprox.transform([4, 3, 0])
        other = cprox.Obstacle(cprox.box([1, 1, 1]), here)
        answer = cprox.translating_distance(box, other, [1, 0, 0], [-1, 0, 0], 5)
        self.assertAlmostEqual(answer.upper, 2, places=6)  # past each other, 3 - 1 apart
        contact = cprox.translating_contact(box, cprox.Obstacle(cprox.box([1, 1, 1]), cprox.transform([4, 0, 0])),
                                            [1, 0, 0], [0, 0, 0], 5)
        self.assertLessEqual(contact.t_contact_lower, 3)
        self.assertAlmostEqual(contact.t, 3, places=5)
        growth = cprox.growth_distance(box, other)
        self.assertLessEqual(growth['lower'], 4)
        self.assertGreaterEqual(growth['upper'], 4 - 1e-12)
        self.assertLess(growth['upper'], 4 + 1e-5)
        slopes = cprox.growth_gradient(box, other)  # faces are parallel: by positions alone
        self.assertEqual((slopes['valid'], slopes['valid_position']), (False, True))
        self.assertIn('more than one point', slopes['reason'])
        numpy.testing.assert_allclose(slopes['b_position'], [1, 0, 0], atol=1e-12)
        turned = cprox.Obstacle(cprox.box([1, 1, 1]), cprox.transform([4, 3, 0], [.2, .4, .4, .8]))
        self.assertTrue(cprox.growth_gradient(box, turned)['valid'])

        # a ball of .5 comes down over a box of 1: (z of its centre) / 1 at the end
        ball, fall = cprox.Obstacle(cprox.sphere(.5)), cprox.bezier([[0, 0, 4], [.1, 0, 3]])
        along = cprox.growth_along(ball, fall, box)
        self.assertEqual((along['status'], along['valid'], along['t']), ('ok', True, 1))
        self.assertLessEqual(along['lower'], 3)
        self.assertAlmostEqual(along['upper'], 3, places=5)
        numpy.testing.assert_allclose(along['a_position'], [0, 0, 1], atol=1e-9)

        # Table III: both bodies scaled by .5, 3, .67 are the superquadrics of the scaled semi-axes
        scale = numpy.array([.5, 3, .67])
        axes, exponents, pose = [.3, .2, .4], [4, 6, 3], cprox.transform([3, 2.5, 1])
        round_one = cprox.superquadric(axes, exponents)
        flat = cprox.deformed(round_one, numpy.diag(scale))
        anew = cprox.superquadric(scale * axes, exponents)
        a, b = (cprox.pair(cprox.Obstacle(s), cprox.Obstacle(s, pose)) for s in (flat, anew))
        self.assertAlmostEqual(a.upper, b.upper, places=6)
        pointed = cprox.deformed(round_one, numpy.eye(3), exponents=[2, 2, 2])
        ball = cprox.pair(cprox.Obstacle(pointed), cprox.Obstacle(cprox.point([1, 0, 0])))
        self.assertAlmostEqual(ball.upper, .7, places=6)
        planes = [[1, 0, 0, -.5], [-1, 0, 0, -.5], [0, 1, 0, -.5], [0, -1, 0, -.5], [0, 0, 1, -.5], [0, 0, -1, -.5]]
        cube = cprox.pair(cprox.Obstacle(cprox.implicit(planes=planes)), other)
        self.assertAlmostEqual(cube.upper, numpy.hypot(3, 2), places=6)
        with self.assertRaisesRegex(ValueError, 'superquadric or implicit'):
            cprox.deformed(cprox.box([1, 1, 1]), numpy.eye(3))
        with self.assertRaisesRegex(ValueError, '3, 3'):
            cprox.deformed(round_one, numpy.eye(2))

    def test_distance_functions_that_lie_are_refused(self):
        def raises(p):
            raise RuntimeError('mine')

        for function, words in ((lambda p: 2 * p[0], 'Lipschitz|lies within'), (lambda p: float('nan'), 'answered nan'),
                                (raises, 'raised RuntimeError: mine'), (lambda p: 'word', "must return a number, got 'word'")):
            with self.assertRaisesRegex(ValueError, words):
                cprox.distance_function(function, [0, 0, 0], 1)
        with self.assertRaisesRegex(ValueError, 'n_z, n_y, n_x'):
            cprox.distance_grid([[1, 2]], 1)
        with self.assertRaisesRegex(ValueError, 'neighbour'):
            cprox.distance_grid([[[0, 0], [0, 0]], [[0, 0], [0, 3]]], 1)
        with self.assertRaisesRegex(ValueError, 'height at'):
            cprox.height_field([[0, 0], [0, float('nan')]], [1, 1])

    def test_a_distance_function_may_ask_for_distances(self):
        """The union of a ball and a box by cprox's own distances at a point, and with a large query inside: the same answers
        as of the union by its formula."""
        ball, box = cprox.Obstacle(cprox.sphere(.5)), cprox.Obstacle(cprox.box([.6, .6, .6]))
        wild = cprox.bezier(numpy.random.default_rng(1).uniform(-2, 2, (40, 3)))
        cloud = cprox.Obstacle(cprox.point_cloud(numpy.random.default_rng(2).uniform(-2, 2, (2000, 3))))

        def plain(p):
            return float(min(max(numpy.linalg.norm(p) - .5, 0), box_distance(numpy.array([p]), [.6, .6, .6])[0]))

        def composed(p):
            at = cprox.bezier([p, p])
            return min(cprox.distance(at, one, epsilon=1e-9).upper for one in (ball, box))

        def heavy(p):
            cprox.distance(wild, cloud, epsilon=1e-9)
            return plain(p)

        for function in (composed, heavy):
            for seed in range(3):
                curve = cprox.bezier(numpy.random.default_rng(seed).uniform(-1.5, 1.5, (6, 3)) + [0, 0, 1.2])
                wanted, got = (cprox.distance(curve, cprox.Obstacle(cprox.distance_function(f, [0, 0, 0], 1., error=1e-8)),
                                              epsilon=1e-3) for f in (plain, function))
                self.assertEqual(got.status, wanted.status)
                self.assertLessEqual(got.lower, wanted.upper + 1e-7)
                self.assertGreaterEqual(got.upper, wanted.lower - 1e-7)

    def test_a_signal_handler_may_ask_for_distances(self):
        cloud = cprox.Obstacle(cprox.point_cloud(numpy.random.default_rng(2).uniform(-2, 2, (20000, 3))))
        curve = cprox.bezier(numpy.random.default_rng(3).uniform(-2, 2, (30, 3)))
        wanted, handled = cprox.distance(curve, cloud, epsilon=1e-9), []

        def handler(*_):
            handled.append(cprox.distance(cprox.bezier([[0, 0, 0], [1, 1, 1]]), cloud).upper)

        before = signal.signal(signal.SIGALRM, handler)
        signal.setitimer(signal.ITIMER_REAL, .001, .001)
        try:
            until = time.monotonic() + 20
            while len(handled) < 20 and time.monotonic() < until:
                got = cprox.distance(curve, cloud, epsilon=1e-9)
                self.assertEqual((got.lower, got.upper), (wanted.lower, wanted.upper))
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
        self.assertEqual(len(set(handled)), 1)

    def test_what_a_callback_raises_reaches_the_caller(self):
        calls = [0]

        def raising(error):
            def function(p):
                calls[0] += 1
                if calls[0] > 270:  # not while the shape is made
                    raise error
                return float(numpy.linalg.norm(p) - .5)
            return function

        line = cprox.bezier([[-1, 1, 0], [1, 1, 0]])
        for error in (KeyError('mine'), KeyboardInterrupt(), SystemExit(3)):
            for ask in (lambda o: cprox.distance(line, o), lambda o: cprox.distance(line, [o]),
                        lambda o: cprox.Obstacles([o]).distance_batch([[[-1, 1, 0], [1, 1, 0]]] * 3, threads=2)):
                calls[0] = 0
                obstacle = cprox.Obstacle(cprox.distance_function(raising(error), [0, 0, 0], .6))
                if isinstance(error, Exception):
                    with self.assertRaisesRegex(ValueError, "a distance function raised KeyError: 'mine'") as caught:
                        ask(obstacle)
                    self.assertIs(caught.exception.__cause__, error)
                else:
                    with self.assertRaises(type(error)):
                        ask(obstacle)
                self.assertEqual(cprox.distance(line, cprox.Obstacle(cprox.sphere(.5))).status, 'ok')

    def test_numbers_out_of_range_are_named(self):
        line, ball = cprox.bezier([[-1, 1, 0], [1, 1, 0]]), cprox.Obstacle(cprox.sphere(.5))
        for number in (-1, 2.5, 2 ** 32, 2 ** 70, float('nan')):
            with self.assertRaisesRegex(ValueError, '^max_nodes must be a whole number from 0 to 4294967295, got [^\n]*$'):
                cprox.distance(line, ball, max_nodes=number)
        with self.assertRaisesRegex(ValueError, 'triangles must be whole numbers, got an array of float64'):
            cprox.mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2.]])
        for ask, words in ((lambda: cprox.distance('line', ball), r"a Curve or a Mover, got 'line' \(str\)"),
                           (lambda: cprox.distance(line, 7), r'got 7 \(int\)'),
                           (lambda: cprox.distance(line, ball, epsilon='small'), r"epsilon must be a number, got 'small'"),
                           (lambda: cprox.distance(line, ball, max_nodes='many'), r"max_nodes .* got 'many' \(str\)")):
            with self.assertRaisesRegex(TypeError, words):
                ask()

    def test_convex_functions_are_the_bodies_that_they_describe(self):
        """An ellipsoid beside its own kind, a smooth box that ends where its function is 0, a disc in the plane."""
        axes = numpy.array([.5, .4, .3])

        def ellipsoid(p):
            p = numpy.array(p)
            return (p / axes) @ (p / axes) - 1, 2 * p / axes ** 2, numpy.diag(2 / axes ** 2)

        random = numpy.random.default_rng(9)
        same = cprox.Obstacle(cprox.ellipsoid(axes))
        shape = cprox.Obstacle(cprox.convex_function(ellipsoid, [0, 0, 0], 1))
        for _ in range(10):
            curve = cprox.bezier(random.uniform(-1.5, 1.5, (3, 3)))
            one, other = cprox.distance(curve, shape), cprox.distance(curve, same)
            self.assertLessEqual(max(one.lower, other.lower), min(one.upper, other.upper))
            self.assertLessEqual(one.upper - one.lower, 1e-5)

        sharp, faces = 20., numpy.vstack([numpy.eye(3), -numpy.eye(3)])

        def smooth_box(p):
            weights = numpy.exp(sharp * (faces @ p - 1))
            value, weights = numpy.log(weights.sum()) / sharp, weights / weights.sum()
            slope = weights @ faces
            return value, slope, sharp * ((faces.T * weights) @ faces - numpy.outer(slope, slope))

        box = cprox.Obstacle(cprox.convex_function(smooth_box, [.1, 0, 0], 3))
        answer = cprox.distance(cprox.bezier([[2, 0, 0], [3, 0, 0]]), box)
        at = 2 - answer.upper
        self.assertLessEqual(smooth_box([at, 0, 0])[0], 1e-9)
        self.assertGreaterEqual(smooth_box([at + 1e-5, 0, 0])[0], 0)
        self.assertLess(at, 1)

        def disc(p):
            return p[0] ** 2 + p[1] ** 2 - .25, [2 * p[0], 2 * p[1], 0], numpy.diag([2., 2, 0])

        flat = cprox.Obstacle(cprox.convex_function(disc, [0, 0, 0], 1, planar=True))
        answer = cprox.distance(cprox.bezier([[-2, 1, 0], [2, 1, 0]]), flat)
        self.assertAlmostEqual(answer.upper, .5, places=6)

    def test_functions_that_are_not_convex_are_refused(self):
        def raises(p):
            raise RuntimeError('mine')

        def saddle(p):
            return p[0] ** 2 - p[1] ** 2 + p[2] ** 2 - .1, [2 * p[0], -2 * p[1], 2 * p[2]], numpy.diag([2., -2, 2])

        def ring(p):
            v = numpy.dot(p, p) - .75
            return v * v - .7, 4 * v * numpy.array(p), 4 * v * numpy.eye(3) + 8 * numpy.outer(p, p)

        for function, words in ((raises, 'raised RuntimeError: mine'), (lambda p: 1., 'must return a value, a gradient'),
                                (saddle, 'within the radius'), (ring, 'not convex.* at least'),
                                (lambda p: (0., [0, 0], numpy.eye(3)), 'must return a value, a gradient')):
            with self.assertRaisesRegex(ValueError, words):
                cprox.convex_function(function, [0, 0, 0], 1.5)

    def test_curves_are_evaluated_for_numbers_and_arrays(self):
        points = numpy.array([[0, 0, 0], [1, 2, 0], [2, 0, 1], [3, 1, 1.]])
        curve = cprox.bezier(points, 2, 4)
        t = numpy.linspace(2, 4, 7)
        numpy.testing.assert_allclose(curve(t), de_casteljau(points, (t - 2) / 2), atol=1e-12)
        self.assertEqual(curve(3.).shape, (3,))
        numpy.testing.assert_allclose(curve(2., derivative=1), 3 * (points[1] - points[0]) / 2)
        spline = cprox.bspline(points, 2, [0, 0, 0, 1, 2, 2, 2])
        self.assertEqual((spline.t0, spline.t1, spline.n_pieces), (0, 2, 2))

    def test_named_and_rational_curves_are_their_formulas(self):
        t = numpy.linspace(0, 2, 9)
        root = numpy.sqrt(.5)
        points = [[1, 0, 0], [1, 1, 0], [0, 1, 0]]
        arc = cprox.rational_bezier(points, [1, root, 1], 0, 2)
        numpy.testing.assert_allclose(numpy.linalg.norm(arc(t), axis=1), 1, atol=1e-12)
        nurbs = cprox.nurbs(points, [1, root, 1], 2, [0, 0, 0, 2, 2, 2])
        numpy.testing.assert_allclose(nurbs(t), arc(t), atol=1e-12)
        with self.assertRaisesRegex(Exception, 'weight 1 is -1'):
            cprox.rational_bezier(points, [1, -1, 1])
        unwound = cprox.involute([1, 2, 3], numpy.pi / 2, .5, 0, 2)
        x, y = .5 * (numpy.cos(t) + t * numpy.sin(t)), .5 * (numpy.sin(t) - t * numpy.cos(t))
        numpy.testing.assert_allclose(unwound(t), numpy.stack([1 - y, 2 + x, 3 + 0 * t], axis=1), atol=1e-12)
        # the preimage 1 + 2 s k: dpsi/ds = (1 - 4 s^2, 4 s, 0)
        hodograph = cprox.pythagorean_hodograph([0, 0, 1], [[1, 0, 0, 0], [1, 0, 0, 2]], 0, 2)
        s = t / 2
        numpy.testing.assert_allclose(hodograph(t), numpy.stack([s - 4 / 3 * s**3, 2 * s**2, 1 + 0 * s], axis=1), atol=1e-12)
        legendre = cprox.legendre([[0, 0, 0], [1, 0, 0], [0, 1, 0]], 0, 2)
        x = t - 1
        numpy.testing.assert_allclose(legendre(t), numpy.stack([x, 1.5 * x * x - .5, 0 * x], axis=1), atol=1e-12)
        lagrange = cprox.lagrange([[0, 0, 0], [1, 1, 0], [2, 0, 0]], [0, 1, 2], 0, 2)
        numpy.testing.assert_allclose(lagrange(t), numpy.stack([t, t * (2 - t), 0 * t], axis=1), atol=1e-12)
        self.assertAlmostEqual(cprox.dubins([0, 0, 0], 0, [0, 2, 0], numpy.pi, 1, 'lsl').t1, numpy.pi, places=9)
        with self.assertRaisesRegex(Exception, "'xyz' is no word"):
            cprox.dubins([0, 0, 0], 0, [1, 0, 0], 0, 1, word='xyz')

    def test_a_restricted_curve_keeps_its_parameters(self):
        points = numpy.array([[0, 0, 0], [1, 2, 0], [2, 0, 1], [3, 1, 1.]])
        for curve in (cprox.bezier(points, 0, 3), cprox.legendre(points, 0, 3), cprox.clothoid([0, 0, 0], .1, .2, .3, 0, 3),
                      cprox.rational_bezier(points, [1, 2, .5, 1], 0, 3)):
            part = curve.restrict(.7, 2.2)
            self.assertEqual((part.t0, part.t1), (.7, 2.2))
            t = numpy.linspace(.7, 2.2, 11)
            numpy.testing.assert_allclose(part(t), curve(t), atol=1e-12)
            with self.assertRaisesRegex(Exception, 'leaves the curve'):
                curve.restrict(1, 4)

    def test_arrays_of_other_types_and_orders_are_copied(self):
        points = numpy.asfortranarray(numpy.arange(12).reshape(4, 3)[::-1].astype(numpy.float32))
        numpy.testing.assert_allclose(cprox.bezier(points)(0.), points[0])

    def test_a_tube_and_a_carried_shape_are_thick(self):
        curve, wall = cprox.bezier([[-1, 0, 0], [1, 0, 0]]), cprox.Obstacle(cprox.box([1, 1, 1]), cprox.transform([0, 2, 0]))
        self.assertAlmostEqual(cprox.distance(curve, wall).upper, 1.5)
        self.assertAlmostEqual(cprox.distance(cprox.tube(curve, .25), wall).upper, 1.25)
        self.assertAlmostEqual(cprox.distance(cprox.carried(cprox.box([.2, .4, .2]), curve), wall).upper, 1.3)

    def test_verdicts_time_of_contact_and_signed_distances(self):
        curve = cprox.bezier([[-2, 0, 0], [2, 0, 0]])
        ball = cprox.Obstacle(cprox.sphere(.5))
        self.assertEqual(cprox.collision(curve, ball).verdict, 'violated')
        self.assertEqual(cprox.tolerance(curve, cprox.Obstacle(cprox.sphere(.5), cprox.transform([0, 1, 0])), .4).verdict,
                         'clear')
        contact = cprox.time_of_contact(curve, ball)
        self.assertLessEqual(contact.t_contact_lower, .375)
        self.assertAlmostEqual(contact.t, .375, places=5)
        self.assertAlmostEqual(cprox.distance(curve, ball, signed=True).upper, -.5, places=5)
        self.assertAlmostEqual(cprox.pair(ball, cprox.Obstacle(cprox.sphere(.5), cprox.transform([3, 0, 0]))).upper, 2)

    def test_mixed_obstacles_nearest_and_profile(self):
        random = numpy.random.default_rng(2)
        shapes = [cprox.sphere(.2), cprox.box([.3, .2, .1]), cprox.cylinder(.4, .1), cprox.superquadric([.2, .1, .3], [4, 4, 4]),
                  cprox.mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])]
        obstacles = [cprox.Obstacle(s, cprox.transform(random.uniform(-5, 5, 3), random.normal(size=4)), margin=.01)
                     for s in shapes * 20]
        many, curve = cprox.Obstacles(obstacles), cprox.bezier(random.uniform(-3, 3, (4, 3)))
        self.assertEqual(len(many), 100)
        answer = cprox.distance(curve, many)
        self.assertAlmostEqual(answer.upper, min(cprox.distance(curve, o).upper for o in obstacles), places=5)
        nearest = many.nearest(curve, 3)
        self.assertEqual(nearest[0].obstacle, answer.obstacle)
        self.assertEqual(sorted(n.upper for n in nearest), [n.upper for n in nearest])
        profile = many.profile(curve, numpy.linspace(0, 1, 33))
        self.assertEqual(profile['lower'].shape, (32,))
        self.assertAlmostEqual(profile['upper'].min(), answer.upper, places=5)
        self.assertTrue((profile['lower'] <= profile['upper']).all())
        between = numpy.linalg.norm(profile['witness_mover'] - profile['witness_obstacle'], axis=1)
        numpy.testing.assert_allclose(between, profile['upper'], atol=1e-9)
        horizon = float(numpy.median(profile['upper']))
        near = many.profile(curve, numpy.linspace(0, 1, 33), horizon=horizon)
        measured = near['upper'] - near['lower'] <= 1e-6
        self.assertTrue((measured | (near['lower'] > horizon)).all())
        self.assertTrue(4 < measured.sum() < 32)
        self.assertTrue((near['lower'] <= profile['upper']).all() and (profile['lower'] <= near['upper']).all())

    def test_a_batch_answers_as_single_queries_do(self):
        random = numpy.random.default_rng(3)
        obstacles = cprox.Obstacles([cprox.Obstacle(cprox.box([1, 1, 1]), cprox.transform(p)) for p in
                                     random.uniform(-10, 10, (30, 3))])
        points = random.uniform(-10, 10, (500, 1, 3)) + random.uniform(-1, 1, (500, 4, 3))
        for threads in (1, 3):
            batch = obstacles.distance_batch(points, radius=.1, threads=threads)
            for i in range(0, 500, 25):
                one = cprox.distance(cprox.tube(cprox.bezier(points[i]), .1), obstacles)
                self.assertLessEqual(abs(batch['upper'][i] - one.upper), 2e-6)
        verdicts = obstacles.tolerance_batch(points, .5, radius=.1)['verdict']
        self.assertTrue(((verdicts == 0) == (batch['lower'] > .5))[numpy.abs(batch['upper'] - .5) > 1e-5].all())

    def test_gradients_are_those_of_differences(self):
        points, few = numpy.array([[-1, .3, 0], [0, 1, .5], [1, 0, .2]]), numpy.array([[.1, -.2, 0], [-.3, -.1, .1], [0, .1, -.2]])
        for body in (cprox.sphere(.2), cprox.mesh(few, [[0, 1, 2]]), cprox.point_cloud(few, .05)):
            obstacle = cprox.Obstacle(body)
            gradient = cprox.distance_gradient(cprox.bezier(points), obstacle, epsilon=1e-12)
            self.assertTrue(gradient['valid'], gradient['reason'])
            t, step = gradient['t'], 1e-6
            weights = [(1 - t) ** 2, 2 * t * (1 - t), t * t]
            for i in range(3):
                for k in range(3):
                    moved = [points.copy(), points.copy()]
                    moved[0][i, k] -= step
                    moved[1][i, k] += step
                    low, high = (cprox.distance(cprox.bezier(m), obstacle, epsilon=1e-12).upper for m in moved)
                    self.assertAlmostEqual((high - low) / (2 * step), weights[i] * gradient['mover'][k], places=6)

    def test_gradients_by_the_numbers_of_a_curve_are_those_of_differences(self):
        ball = cprox.Obstacle(cprox.sphere(0.3), cprox.transform([0.4, 0.9, 0.1]))
        points = numpy.array([[-1, 0, 0], [0, 0.5, 0], [1, 0, 0.1]], float)
        curves = {
            'clothoid': (lambda v: cprox.clothoid([-0.5, 0, 0], *v, 0, 1.5), [0.1, 0.3, 0.2]),
            'dubins': (lambda v: cprox.dubins([v[3], v[4], 0], v[0], [v[5], v[6], 0], v[1], v[2]),
                       [0.3, -1.2, 0.25, -1.0, 0.1, 1.0, 0.2]),
            'involute': (lambda v: cprox.involute([0, 0, 0], *v, 0, 3), [-1.0, 0.3]),
            'pythagorean_hodograph': (lambda v: cprox.pythagorean_hodograph([-0.5, 0, 0], numpy.reshape(v, (2, 4))),
                                      [1, 0.1, 0, 0.2, 0.9, 0, 0.1, 0.3]),
            'rational_bezier': (lambda v: cprox.rational_bezier(points, v), [1.0, 2.0, 0.7]),
            'nurbs': (lambda v: cprox.nurbs(points, v, 2, [0, 0, 0, 1, 1, 1]), [1.0, 2.0, 0.7])}
        for name, (make, values) in curves.items():
            found = cprox.distance_gradient(make(values), ball, epsilon=1e-12)
            self.assertTrue(found['valid'], found['reason'])
            columns = make(values).jacobian(found['t'])
            self.assertEqual(columns.shape, (len(values), 3))
            for i, by in enumerate(columns @ found['mover']):
                moved = [numpy.array(values, float), numpy.array(values, float)]
                moved[0][i] -= 1e-6
                moved[1][i] += 1e-6
                low, high = (cprox.distance(make(m), ball, epsilon=1e-12).upper for m in moved)
                self.assertAlmostEqual((high - low) / 2e-6, by, places=6, msg=f'{name} {i}')
        with self.assertRaisesRegex(ValueError, 'no Jacobian'):
            cprox.bezier(points).jacobian(0.5)


class SceneCurves(unittest.TestCase):
    """Curves against a scene: the same as the core says of its objects one by one."""

    def setUp(self):
        self.random = numpy.random.default_rng(12)
        self.scene, self.obstacles = cprox.Scene(), {}
        for i in range(30):
            place = cprox.transform(self.random.uniform(-3, 3, 3))
            kind, dimensions, shape = [('box', [.3, .4, .5], cprox.box([.3, .4, .5])), ('sphere', [.2], cprox.sphere(.2)),
                                       ('cylinder', [.5, .1], cprox.cylinder(.5, .1))][i % 3]
            self.scene.add(f'o{i:02}', kind, dimensions, place, padding=.01 * (i % 2))
            self.obstacles[f'o{i:02}'] = cprox.Obstacle(shape, place, .01 * (i % 2))

    def curves(self):
        for seed in range(40):
            points = self.random.uniform(-2, 2, (6, 3))
            yield (cprox.bezier(points), cprox.bspline(points, 3, [0, 0, 0, 0, 1, 2, 3, 3, 3, 3]), cprox.legendre(points / 3),
                   cprox.rational_bezier(points, [1, 2, 1, .5, 1, 1]))[seed % 4]

    def test_distances_and_verdicts_are_those_of_its_objects(self):
        seen = set()
        for curve in self.curves():
            tube = cprox.tube(curve, .05)
            each = {name: cprox.distance(tube, one).upper for name, one in self.obstacles.items()}
            nearest = min(each, key=each.get)
            got = self.scene.distance(curve, radius=.05)
            self.assertAlmostEqual(got['result'].upper, each[nearest], delta=2e-6)
            self.assertLessEqual(got['result'].lower, each[nearest])
            self.assertEqual((got['a'], got['status']), ('curve', 'ok'))
            if each[nearest] > 0:
                self.assertEqual(got['b'], nearest)
            seen.add(each[nearest] > 0)
            delta = self.random.uniform(0, .5)
            for answer, limit in ((self.scene.tolerance(curve, delta, radius=.05), delta), (self.scene.collision(curve, radius=.05), 0)):
                if abs(each[nearest] - limit) > 2e-6 or limit == 0:
                    self.assertEqual(answer['result'].verdict, 'clear' if each[nearest] > limit else 'violated')
            wanted = cprox.time_of_contact(tube, list(self.obstacles.values()))
            contact = self.scene.time_of_contact(curve, radius=.05)
            self.assertEqual(contact['result'].verdict, wanted.verdict)
            if wanted.verdict == 'violated':
                self.assertAlmostEqual(contact['result'].t, wanted.t, delta=1e-4)
            rows = self.scene.nearest_pairs(curve, 3, radius=.05)
            numpy.testing.assert_allclose([row['result'].upper for row in rows], sorted(each.values())[:3], atol=2e-6)
            some = self.scene.distance(curve, radius=.05, objects=['o03', 'o04'])
            self.assertAlmostEqual(some['result'].upper, min(each['o03'], each['o04']), delta=2e-6)
        self.assertEqual(seen, {True, False})

    def test_profiles_and_violations_are_where_the_distance_is(self):
        for curve in list(self.curves())[:8]:
            breaks = numpy.linspace(curve.t0, curve.t1, 9)
            profile = self.scene.profile(curve, breaks)
            for i, (lower, upper) in enumerate(zip(profile['lower'], profile['upper'])):
                part = self.scene.distance(curve.restrict(breaks[i], breaks[i + 1]))['result']
                self.assertLessEqual(lower, part.upper + 1e-12)
                self.assertGreaterEqual(upper, part.lower - 1e-12)
            delta = .3
            inside = [(v['enter_upper'], v['leave_lower']) for v in self.scene.violations(curve, delta)]
            outside = [(v['enter_lower'], v['leave_upper']) for v in self.scene.violations(curve, delta)]
            for t in numpy.linspace(curve.t0, curve.t1, 200):
                at = min(cprox.pair(cprox.Obstacle(cprox.point(), cprox.transform(curve(t))), one).upper for one in self.obstacles.values())
                if any(a <= t <= b for a, b in inside):
                    self.assertLessEqual(at, delta + 1e-9)
                if not any(a <= t <= b for a, b in outside):
                    self.assertGreater(at, delta)

    def test_the_robot_of_the_scene_stands_in_the_way(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'rail.urdf')
            with open(path, 'w') as out:
                out.write('<robot name="r"><link name="rail"/><link name="cart"><collision><geometry><sphere radius="0.1"/></geometry>'
                          '</collision></link><joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/>'
                          '<origin xyz="0 1.1 0"/><axis xyz="1 0 0"/><limit lower="-20" upper="20"/></joint></robot>')
            scene = cprox.Scene(cprox.Robot.from_urdf(path))
        line = cprox.bezier([[-9, 0, 0], [9, 0, 0]])
        for x, distance in ((0, 1), (-3, 1), (12, math.hypot(1.1, 3) - .1)):
            got = scene.distance(line, positions={'slide': x})
            self.assertAlmostEqual(got['result'].upper, distance, delta=1e-6)
            self.assertEqual((got['b'], got['kind']), ('cart', 'curve'))
        self.assertEqual(scene.tolerance(line, .9)['result'].verdict, 'clear')
        self.assertEqual(scene.tolerance(line, 1.1)['result'].verdict, 'violated')
        for words, ask in (('slyde', lambda: scene.distance(line, positions={'slyde': 1})), ("'wheel'", lambda: scene.distance(line, links=['wheel'])),
                           ('has no robot', lambda: self.scene.distance(line, positions={'slide': 1})),
                           ('radius', lambda: scene.distance(line, radius=-1)), ("'nothing'", lambda: self.scene.distance(line, objects=['nothing']))):
            with self.assertRaisesRegex(ValueError, words):
                ask()
        with self.assertRaises(TypeError):
            scene.distance([[0, 0, 0], [1, 1, 1]])

    def test_nothing_to_measure_is_not_clear(self):
        line = cprox.bezier([[-9, 0, 0], [9, 0, 0]])
        for got in (cprox.Scene().collision(line), cprox.Scene().tolerance(line, .1)):
            self.assertEqual((got['result'].verdict, got['status']), ('undecided', 'empty'))
        self.assertEqual(cprox.Scene().collision(line, allow_empty=True)['result'].verdict, 'clear')


class Gaps(unittest.TestCase):
    """The truth is the exact distance of the bodies' convex parts."""

    def parts(self):
        arm, foot = cprox.transform([-0.3, 0.55, 0.0]), cprox.transform()
        solid = cprox.Solid.union([cprox.Solid.box([0.3, 0.8, 0.6]), cprox.Solid.box([0.9, 0.25, 0.6])], [arm, foot])
        return solid, [(cprox.box([0.3, 0.8, 0.6]), arm), (cprox.box([0.9, 0.25, 0.6]), foot)]

    def pose(self, rng, reach):
        q = rng.normal(size=4)
        return cprox.transform(rng.uniform(-reach, reach, 3), q / numpy.linalg.norm(q))

    def test_clear_is_never_said_of_an_overlap(self):
        rng = numpy.random.default_rng(871)
        solid, boxes = self.parts()
        gap = cprox.FourierGap(solid, cprox.Solid.ellipsoid([0.5, 0.3, 0.4]), samples=9)
        other = cprox.ellipsoid([0.5, 0.3, 0.4])
        counts = {'apart': 0, 'overlapping': 0}
        for _ in range(200):
            pose = self.pose(rng, 1.2)
            distance = min(cprox.pair(cprox.Obstacle(box, at), cprox.Obstacle(other, pose)).upper for box, at in boxes)
            answers = gap.test(pose), gap.evaluate(pose)
            for answer in answers:
                self.assertEqual(answer['status'], 'ok')
                if distance < 0.0:
                    self.assertNotIn(answer['verdict'], ('clear', 'far'))
            counts['overlapping'] += distance < 0.0
            counts['apart'] += answers[0]['verdict'] in ('clear', 'far')
            if answers[0]['verdict'] == 'far':
                self.assertLessEqual(answers[0]['clearance'], distance + 1e-9)
        self.assertGreater(min(counts.values()), 20)
        self.assertTrue(gap.guaranteed and gap.samples == 9)

    def test_gradients_are_those_of_differences_one_by_one_and_many_at_once(self):
        rng = numpy.random.default_rng(872)
        solid, _ = self.parts()
        for mode in ('certified', 'signal'):
            gap = cprox.FourierGap(solid, cprox.Solid.of(cprox.cone(0.7, 0.4)), samples=9, mode=mode)
            poses = numpy.array([self.pose(rng, 0.4) for _ in range(20)])
            values, gradients = gap.evaluate_many(poses)
            for pose, value, gradient in zip(poses, values, gradients):
                answer = gap.evaluate(pose)
                self.assertEqual(answer['value'], value)
                numpy.testing.assert_array_equal(answer['gradient'], gradient)
                metres = gap.length * (value if mode == 'signal' else -math.log(value))
                self.assertAlmostEqual(answer['metres'], metres, delta=1e-12)
                step, h = rng.normal(size=6), 1e-4
                turned = [pose.copy(), pose.copy()]
                for sign, moved in zip((1, -1), turned):
                    w = sign * h * step[3:]
                    angle = numpy.linalg.norm(w)
                    k = numpy.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]]) / angle
                    moved[:3, :3] = (numpy.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k) @ pose[:3, :3]
                    moved[:3, 3] += sign * h * step[:3]
                ahead, behind = gap.evaluate_many(numpy.array(turned))[0]
                slope = gradient @ step
                self.assertAlmostEqual((ahead - behind) / (2 * h), slope, delta=1e-5 * (1 + abs(slope) + abs(value)))
        self.assertLess(gap.touching_least, gap.touching_most)

    def test_solids_have_their_measure_in_the_plane_and_in_space(self):
        corners = [[0, 0], [1, 0], [1, 0.4], [0.4, 0.4], [0.4, 1], [0, 1]]
        cells = numpy.zeros((3, 2, 4), dtype=bool)
        cells[0, 1, 2] = cells[2, 0, 3] = True
        tetrahedron = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
        for solid, dimension, measure in (
                (cprox.Solid.ball(0.5, 2), 2, math.pi / 4), (cprox.Solid.ball(0.5), 3, math.pi / 6),
                (cprox.Solid.box([1, 2]), 2, 2), (cprox.Solid.ellipsoid([1, 2]), 2, 2 * math.pi),
                (cprox.Solid.cylinder(2, 0.5), 3, math.pi / 2), (cprox.Solid.capsule(2, 0.5, 2), 2, 2 + math.pi / 4),
                (cprox.Solid.polygon(corners), 2, 0.64), (cprox.Solid.grid(cells, [0, 0, 0], 0.5), 3, 0.25),
                (cprox.Solid.mesh(*tetrahedron), 3, 1 / 6)):
            self.assertEqual(solid.dimension, dimension)
            self.assertAlmostEqual(solid.measure, measure, delta=1e-9)
        round_cone = cprox.Solid.of(cprox.cone(0.7, 0.4)).measure / (math.pi * 0.16 * 0.7 / 3)
        self.assertTrue(1.0 < round_cone < 1.5, round_cone)

    def test_gaps_lead_more_starts_of_the_example_near_the_best(self):
        example = os.path.join(DATA, '..', '..', 'examples', 'place_part.py')
        done = subprocess.run([sys.executable, example, '8'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        alone, led = (line.split(': ')[1].replace(',', '').split() for line in done.stdout.splitlines())
        self.assertEqual((alone[2], led[2], led[0]), ('8', '8', '8'), done.stdout)
        self.assertGreater(int(led[4]), int(alone[4]), done.stdout)

    def test_what_cannot_be_is_refused_with_what_it_would_cost(self):
        ball = cprox.Solid.ball(0.5)
        with self.assertRaisesRegex(ValueError, 'bytes'):
            cprox.FourierGap(ball, cprox.Solid.box([1, 1, 1]), samples=1025, memory_limit=1 << 20)
        for words, call in (('none of', lambda: cprox.FourierGap(ball, ball, mode='sure')),
                            ('corners', lambda: cprox.Solid.polygon([[0, 0, 0]])),
                            ('size', lambda: cprox.Solid.box([1])), ('poses', lambda: cprox.Solid.union([ball], [])),
                            ('bounded', lambda: cprox.Solid.of(cprox.halfspace([0, 0, 1], 0))),
                            ('shape', lambda: cprox.FourierGap(ball, ball, samples=9).evaluate_many(numpy.eye(4))),
                            ('dimension', lambda: cprox.FourierGap(ball, cprox.Solid.ball(1, 2)))):
            with self.assertRaisesRegex(ValueError, words):
                call()


class Errors(unittest.TestCase):
    def refused(self, error, part, call, *arguments, **options):
        with self.assertRaises(error) as caught:
            call(*arguments, **options)
        self.assertIn(part, str(caught.exception))

    def test_what_is_wrong_is_said(self):
        curve, ball = cprox.bezier([[0, 0, 0], [1, 0, 0]]), cprox.Obstacle(cprox.sphere(1))
        self.refused(ValueError, 'radius', cprox.sphere, -1)
        self.refused(ValueError, 'shape (n, 3)', cprox.bezier, [[0, 0], [1, 1]])
        self.refused(ValueError, '', cprox.bezier, [[0, 0, numpy.nan]])
        self.refused(ValueError, 'rigid', cprox.Obstacle, cprox.sphere(1), 2 * numpy.eye(4))
        self.refused(ValueError, 'epsilon', cprox.distance, curve, ball, epsilon=numpy.inf)
        self.refused(TypeError, 'tolerence', cprox.distance, curve, ball, tolerence=1)
        self.refused(TypeError, 'Curve', cprox.distance, 3, ball)
        self.refused(ValueError, 'vertex 7', cprox.mesh, [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 7]])
        self.refused(ValueError, 'not closed', cprox.mesh, [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], solid=True)
        self.refused(ValueError, 'index', cprox.Obstacles, [ball], index='tree')
        self.refused(ValueError, 'curve 1', cprox.Obstacles([ball]).distance_batch,
                     [[[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [numpy.inf, 0, 0]]])
        self.refused(ValueError, 'nowhere.urdf', cprox.Robot.from_urdf, 'nowhere.urdf')


class Threads(unittest.TestCase):
    def test_queries_release_the_interpreter(self):
        obstacles = cprox.Obstacles([cprox.Obstacle(cprox.sphere(.1), cprox.transform([i, 0, 0])) for i in range(50)])
        points = numpy.random.default_rng(4).uniform(0, 50, (20000, 6, 3))
        counted, done = 0, threading.Event()

        def work():
            obstacles.distance_batch(points, threads=1)
            done.set()
        worker = threading.Thread(target=work)
        worker.start()
        while not done.is_set():
            counted += 1
            time.sleep(1e-4)
        worker.join()
        self.assertGreater(counted, 2)

    def test_ctrl_c_ends_a_query(self):
        waves = cprox.trigonometric(numpy.random.default_rng(5).normal(size=(101, 3)), 0, 6)
        cloud = cprox.point_cloud(numpy.random.default_rng(6).normal(size=(2000, 3)) * 20)
        signal.setitimer(signal.ITIMER_REAL, .05)
        before = signal.signal(signal.SIGALRM, signal.default_int_handler)
        try:
            with self.assertRaises(KeyboardInterrupt):
                for _ in range(1000):
                    cprox.distance(waves, cprox.Obstacle(cloud), epsilon=0, max_nodes=1000000000)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)


class Files(unittest.TestCase):
    """Parts of files that would go missing: they are used, refused or warned of."""
    ARM = ('<robot name="m" version="1.1"><link name="base"><collision><geometry><box size="0.4 0.4 0.4"/></geometry></collision></link>'
           '<link name="l"><collision><origin xyz="0 0 0.5"/><geometry><box size="0.1 0.1 0.4"/></geometry></collision></link>'
           '<joint name="j" type="%s"><parent link="base"/><child link="l"/><axis xyz="0 0 1"/><limit lower="-4" upper="%s"/></joint>%s</robot>')
    SRDF = '<robot name="m"><virtual_joint name="w" type="planar" parent_frame="world" child_link="base"/></robot>'
    MOVE = 'joint_trajectory: {joint_names: [j], points: [{positions: [%g], time_from_start: 0}, {positions: [%g], time_from_start: 2}]}\n'
    BASE = ('multi_dof_joint_trajectory: {joint_names: [w], points: [{transforms: [{translation: [0, 0, 0]}], time_from_start: 0}, '
            '{transforms: [{translation: [6, 0, 0]}], time_from_start: 2}]}\n')

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def file(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, 'w') as out:
            out.write(text)
        return path

    def robot(self, joint='revolute', upper='4', more=''):
        return cprox.Robot.from_urdf(self.file('m.urdf', self.ARM % (joint, upper, more)), srdf=self.file('m.srdf', self.SRDF))

    def scene(self, *robot):
        return cprox.Scene(self.robot(*robot))

    def test_a_base_moves_by_its_poses(self):
        scene = self.scene()
        scene.add('b', 'sphere', [.1], cprox.transform([3, 0, 0]))
        with warnings.catch_warnings():
            warnings.simplefilter('error')
            motion = cprox.Motion.from_file(scene, self.file('t.yaml', self.MOVE % (0, .5) + self.BASE))
        self.assertAlmostEqual(motion.link_poses(1)['base'][0, 3], 3)
        self.assertEqual(motion.collision()['result'].verdict, 'violated')

    def test_a_scene_puts_the_base_where_it_says(self):
        scene = self.scene()
        scene.load(self.file('s.yaml', 'robot_state: {multi_dof_joint_state: {joint_names: [w], transforms: [{translation: [3, 0, 0]}]}}\n'
                             'world: {collision_objects: [{id: b, pose: {position: [3.1, 0, 0.5]}, primitives: [{type: 2, dimensions: [0.1]}]}]}'))
        motion = cprox.Motion.from_file(scene, self.file('t.yaml', self.MOVE % (0, .5)))
        self.assertAlmostEqual(motion.link_poses(0)['base'][0, 3], 3)
        self.assertEqual(motion.collision()['result'].verdict, 'violated')
        elsewhere = cprox.Motion(scene, ['j'], [0, 1], [[0], [1]], base=cprox.transform([0, 0, 0]))
        self.assertAlmostEqual(elsewhere.link_poses(0)['base'][0, 3], 0)
        for base, verdict in ((None, 1), (cprox.transform([0, 0, 0]), 0)):
            self.assertEqual(cprox.edges(scene, ['j'], [0], [1], self_collision=False, base=base).tolist(), [verdict])

    def test_the_cause_of_a_refusal_is_told(self):
        for more, words in (('<xacro:hand/>', 'this is xacro: expand it first'), ('<link name="other"/>', 'Two root links found')):
            with self.assertRaisesRegex(ValueError, words):
                self.robot('revolute', '4', more)
        with self.assertRaisesRegex(ValueError, "joint 'j': limit upper='x' is not one finite number"):
            self.robot('revolute', 'x')
        with self.assertRaisesRegex(ValueError, 'line 3: a second document'):
            cprox.Motion.from_file(self.scene(), self.file('t.yaml', self.MOVE % (0, 1) + '---\n' + self.MOVE % (0, 2)))
        with self.assertRaisesRegex(ValueError, "'joint_trajectory' stands twice"):
            cprox.Motion.from_file(self.scene(), self.file('t.yaml', self.MOVE % (0, 1) + self.MOVE % (0, 2)))

    def test_unknown_elements_of_a_urdf_are_warned_of(self):
        with self.assertWarnsRegex(UserWarning, '<loop_joint> .* is not known'):
            self.robot('revolute', '4', '<loop_joint/>')

    def test_misspelt_attributes_and_children_of_a_joint_are_not_clear(self):
        scene_file = self.file('s.yaml', 'world: {collision_objects: [{id: b, pose: {position: [3, 0, 0]}, primitives: [{type: 2, '
                               'dimensions: [0.1]}]}]}')
        for old, new, words in (('<axis xyz=', '<axis xzy=', "attribute 'xzy' of <axis>"),
                                ('<parent link="base"/>', '<parent link="base"><x/></parent>', '<x> .*is not known'),
                                ('<axis xyz="0 0 1"/>', '<axis xyz="0 0 1"><y/></axis>', '<y> .*is not known'),
                                ('upper=', 'uper=', "attribute 'uper' of <limit>")):
            text = (self.ARM % ('revolute', '4', '')).replace(old, new)
            self.assertIn(new, text)
            with self.assertWarnsRegex(UserWarning, words):
                robot = cprox.Robot.from_urdf(self.file('m.urdf', text))
            scene = cprox.Scene(robot)
            scene.load(scene_file)
            answer = cprox.Motion(scene, ['j'], [0, 1], [[0], [1]]).collision()
            self.assertEqual((answer['status'], answer['result'].verdict), ('partial', 'undecided'), new)

    def test_the_unit_of_a_mesh_file_is_told(self):
        corners = ' '.join(f'{x} {y} {z}' for x in (-50, 50) for y in (-50, 50) for z in (-50, 50))
        faces = '0 1 3 0 3 2 4 6 7 4 7 5 0 4 5 0 5 1 2 3 7 2 7 6 0 2 6 0 6 4 1 5 7 1 7 3'
        path = self.file('c.dae', (
            '<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="0.01"/>'
            '</asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="24">%s</float_array>'
            '<technique_common><accessor source="#a" count="8" stride="3"/></technique_common></source><vertices id="v"><input '
            'semantic="POSITION" source="#p"/></vertices><triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>%s</p>'
            '</triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry '
            'url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>')
            % (corners, faces))
        scene = self.scene()
        with self.assertWarnsRegex(UserWarning, "c.dae': its unit is '0.01' m"):
            scene.add('cube', 'mesh', resource=path, pose=cprox.transform([3, 0, 0]))
        loaded = self.scene()
        with self.assertWarnsRegex(UserWarning, "c.dae': its unit is '0.01' m"):
            loaded.load(self.file('s.yaml', 'world: {collision_objects: [{id: cube, meshes: [{resource: c.dae}], pose: {position: [3, 0, 0]}}]}'))
        for one in (scene, loaded):
            self.assertAlmostEqual(cprox.Motion(one, ['j'], [0, 1], [[0], [1]]).distance()['result'].upper, 2.3)

    def test_a_continuous_joint_goes_the_long_way_with_a_warning(self):
        scene, path = self.scene('continuous'), self.file('t.yaml', self.MOVE % (3.1, -3.1))
        with self.assertWarnsRegex(UserWarning, "continuous joint 'j' turns by -6.2 rad from point 0 to point 1"):
            self.assertAlmostEqual(cprox.Motion.from_file(scene, path).link_poses(1)['l'][0, 0], 1)
        with warnings.catch_warnings():
            warnings.simplefilter('error')
            short = cprox.Motion.from_file(scene, path, shortest_way=True)
            given = cprox.Motion(scene, ['j'], [0, 2], [[3.1], [-3.1]], shortest_way=True)
        for motion in (short, given):
            self.assertAlmostEqual(motion.link_poses(1)['l'][0, 0], -1)

    def test_an_edge_goes_the_long_way_with_a_warning(self):
        # a corner of the bar, sqrt(2) * .05 m from the axis, passes the ball only on the long way
        scene = self.scene('continuous')
        scene.add('post', 'sphere', [.01], cprox.transform([.0757, 0, .5]))
        with self.assertWarnsRegex(UserWarning, "edge 1: continuous joint 'j' turns by -6.2 rad"):
            self.assertEqual(cprox.edges(scene, ['j'], [[0.5], [3.1]], [[0.6], [-3.1]], self_collision=False).tolist(), [0, 1])
        with warnings.catch_warnings():
            warnings.simplefilter('error')
            self.assertEqual(cprox.edges(scene, ['j'], [[0.5], [3.1]], [[0.6], [-3.1]], shortest_way=True,
                                         self_collision=False).tolist(), [0, 0])


if __name__ == '__main__':
    outcome = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromModule(__import__('__main__')))
    failed = len(outcome.failures) + len(outcome.errors)
    print(f'{outcome.testsRun - failed} passed, {failed} failed')
    raise SystemExit(failed > 0 or outcome.testsRun == 0)
