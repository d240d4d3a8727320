#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Gradients by ~distance, against differences of distances that the service itself answers. Those by objects and among what moves are
held against differences by scene.test_motion_gradient and scene.test_movers; optimise.py compares the two messages."""
import copy
import math
import unittest

import rospy
from curve_proximity.srv import (ClearanceProfile, ClearanceProfileRequest, Tolerance, ToleranceRequest)
from helpers import Server, bezier, bspline, joint_trajectory, query, run, sphere, until

STEP = 1e-5  # the error of a central difference is about 1e-10 of the curvature, that of ~epsilon 1e-5
NEAR = 1e-4
ONLY = {'objects': ['ball']}
QUARTER = joint_trajectory(['turn'], [0.1], [1.2])


def three(v):
    return [v.x, v.y, v.z]


class Gradients(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        assert until(lambda: cls.server.distance([], trajectory=QUARTER).success, 20)

    def setUp(self):
        self.server.replace(sphere('ball', 0.25))

    def asked(self, curves, **fields):
        response = self.server.distance(curves, gradient=True, **fields)
        self.assertTrue(response.success, response.message)
        self.assertEqual(len(response.gradients), len(response.results))
        return response

    def difference(self, change, curve=None, trajectory=None, **fields):
        """The central difference of the distance by what `change` does to a copy of the curve or trajectory."""
        values = []
        for step in (STEP, -STEP):
            moved = copy.deepcopy(curve or trajectory)
            change(moved, step)
            asked = dict(fields, trajectory=moved) if trajectory else fields
            response = self.server.distance([moved] if curve else [], **asked)
            self.assertTrue(response.success, response.message)
            values.append(0.5 * (response.results[0].lower + response.results[0].upper))
        return (values[0] - values[1]) / (2.0 * STEP)

    def test_of_a_curve_by_its_control_points_its_radius_and_both_sides(self):
        self.server.replace(sphere('ball', 0.25, (0.3, -0.2, 0.1)))  # off the frame's origin: a turn about it counts
        for curve in (bezier((-1, 0.2, 1), (0.1, 0.4, 0.5), (1, -0.3, 1.2)),
                      bspline([(-1, 0, 1), (-0.2, 0.4, 0.6), (0.4, -0.2, 0.5), (1, 0, 1.5)], 2)):
            curve.radius = 0.05
            gradient, = self.asked([curve], **ONLY).gradients
            self.assertTrue(gradient.valid, gradient.message)
            self.assertEqual(len(gradient.points), len(curve.points))
            for i, of_point in enumerate(gradient.points):
                for axis, told in zip('xyz', three(of_point)):
                    def change(moved, step, i=i, axis=axis):
                        setattr(moved.points[i], axis, getattr(moved.points[i], axis) + step)
                    self.assertAlmostEqual(told, self.difference(change, curve, **ONLY), delta=NEAR)
            self.assertEqual(gradient.radius, -1.0)
            for k, told in enumerate(three(gradient.moving.linear)):
                self.assertAlmostEqual(told, sum(three(p)[k] for p in gradient.points), delta=1e-9)
                self.assertAlmostEqual(told, -three(gradient.obstacle.linear)[k], delta=1e-9)

            def turn(moved, step):
                for p in moved.points:
                    p.x, p.y = p.x * math.cos(step) - p.y * math.sin(step), p.x * math.sin(step) + p.y * math.cos(step)
            self.assertAlmostEqual(gradient.moving.angular.z, self.difference(turn, curve, **ONLY), delta=NEAR)
            self.assertGreater(abs(gradient.moving.angular.z), 0.01)

    def test_of_a_robot_by_the_points_of_its_trajectory_its_duration_and_its_base(self):
        self.server.replace(sphere('ball', 0.1, (0.1, 0.6, 0.9)))
        curved = copy.deepcopy(QUARTER)
        curved.points[0].velocities, curved.points[1].velocities = [0.3], [0.8]
        for trajectory in (QUARTER, curved):
            gradient, own = self.asked([], trajectory=trajectory, self_collision=True).gradients
            self.assertTrue(gradient.valid, gradient.message)
            self.assertEqual((gradient.joints, len(gradient.times)), (['turn'], 2))
            self.assertEqual(len(gradient.positions), 2)
            for i, told in enumerate(gradient.positions):
                def change(moved, step, i=i):
                    moved.points[i].positions = [moved.points[i].positions[0] + step]
                self.assertAlmostEqual(told, self.difference(change, trajectory=trajectory), delta=NEAR)
            self.assertEqual(len(gradient.velocities), 2 if trajectory is curved else 0)
            for i, told in enumerate(gradient.velocities):
                def faster(moved, step, i=i):
                    moved.points[i].velocities = [moved.points[i].velocities[0] + step]
                self.assertAlmostEqual(told, self.difference(faster, trajectory=trajectory), delta=NEAR)
            self.assertEqual(len(own.positions), 2)
            normal = three(self.asked([], trajectory=trajectory).results[0].normal)
            for told, n in zip(three(gradient.moving.linear), normal):
                self.assertAlmostEqual(told, n, delta=1e-6)

    def test_where_there_is_no_derivative_the_answer_says_why(self):
        line = bezier((-1, 0, 0.5), (1, 0, 0.5))
        self.server.replace(sphere('ball', 0.2, (0.5, 0, 0)), sphere('twin', 0.2, (-0.5, 0, 0)))
        response = self.asked([line], objects=['ball', 'twin'])
        self.assertFalse(response.gradients[0].valid)
        self.assertIn('equally near', response.gradients[0].message)
        self.assertAlmostEqual(response.results[0].lower, 0.3, delta=1e-9)
        gradient, = self.asked([line], **ONLY).gradients
        self.assertTrue(gradient.valid, gradient.message)

        through = self.asked([bezier((-1, 0, 0), (1, 0, 0))], **ONLY)
        self.assertEqual((through.gradients[0].valid, through.results[0].upper), (False, 0.0))
        self.assertNotEqual(through.gradients[0].message, '')

    def test_a_bad_row_has_a_gradient_that_is_not_valid_and_spoils_no_other(self):
        bad = bezier((0, 0, 0), (math.nan, 0, 0))
        good = bezier((-1, 0, 0.5), (1, 0, 0.6))
        response = self.server.distance([bad, good], gradient=True, **ONLY)
        self.assertFalse(response.success)
        self.assertEqual([gradient.valid for gradient in response.gradients], [False, True])
        many = self.server.distance([good] * 100 + [bad] + [good] * 100, gradient=True, **ONLY)
        self.assertEqual([gradient.valid for gradient in many.gradients], [True] * 100 + [False] + [True] * 100)
        self.assertEqual(self.server.distance([good], **ONLY).gradients, [])

    def test_where_no_gradient_is_given_it_is_refused(self):
        line = bezier((-1, 0, 0.5), (1, 0, 0.5))
        self.assertIn('per_object', self.server.distance([line], gradient=True, per_object=True).message)
        tolerance = rospy.ServiceProxy('/curve_proximity/tolerance', Tolerance)
        self.assertIn('gradient', tolerance(ToleranceRequest(query=query(line, gradient=True), delta=0.1)).message)
        profile = rospy.ServiceProxy('/curve_proximity/clearance_profile', ClearanceProfile)
        self.assertIn('gradient', profile(ClearanceProfileRequest(query=query(line, gradient=True))).message)


if __name__ == '__main__':
    run('gradients')
