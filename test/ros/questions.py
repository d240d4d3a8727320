#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Gradients, nearest pairs, times of contact, profiles and violations by service: the library's answers, to the last bit. That these
are true is held against references of their own by the groups core and scene."""
import copy
import itertools
import math

import cprox
import numpy
import rospy
from curve_proximity.msg import Clearance, Curve
from helpers import ARM, Case, Server, bezier, bspline, heard, joint_trajectory, query, run, sphere, until
from trajectory_msgs.msg import JointTrajectory

LINE = [(-1, 0.2, 1), (0.1, 0.4, 0.5), (1, -0.3, 1.2)]
THROUGH = [(-1, 0, 0.1), (1, 0, 0.1)]
QUARTER = joint_trajectory(['turn'], [0.0], [math.pi / 2])  # in a second
BAD = bezier((0, 0, 0), (math.nan, 0, 0))
BALLS = {'above': ((0.1, 0.6, 0.9), 0.1), 'ball': ((0, 0.5, 0.5), 0.1), 'far': ((0.3, -0.2, -2.0), 0.25), 'near': ((0.3, -0.2, 0.1), 0.25)}
BREAKS = numpy.linspace(0, 1, 9)
EVERY_LINK = ('environment', ''), ('environment', 'arm'), ('environment', 'slider'), ('self', ''), ('self', 'arm'), ('self', 'slider')


def numbers(points):
    return [[p.x, p.y, p.z] for p in points]


class Questions(Case):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        assert until(lambda: cls.server.distance([], trajectory=QUARTER).success, 20)
        cls.robot = cprox.Robot.from_urdf(ARM)

    def setUp(self):
        self.place(*BALLS)

    def place(self, *names):
        """These balls are the scene, here and there."""
        self.server.replace(*[sphere(name, BALLS[name][1], BALLS[name][0]) for name in names])
        self.scene, alone = cprox.Scene(self.robot), cprox.Scene()
        for scene, name in itertools.product((self.scene, alone), names):
            scene.add(name, 'sphere', [BALLS[name][1]], cprox.transform(BALLS[name][0]))
        self.alone = alone  # curves are asked about beside the objects
        self.motion = cprox.Motion(self.scene, ['turn'], [0.0, 1.0], [[0.0], [math.pi / 2]])

    def ask(self, which, *curves, **fields):
        of_query = {name: fields.pop(name) for name in ('self_collision', 'objects', 'per_object') if name in fields}
        trajectory = None if curves else QUARTER
        asked = [curve if isinstance(curve, Curve) else bezier(*curve) for curve in curves]
        return self.server.ask(which, query=query(asked, trajectory=trajectory, **of_query), **fields)

    def good(self, response):
        return getattr(self.succeeded(response), 'profiles', None) or getattr(response, 'violations', None) or response.results

    def curves(self, ask, *points, **fields):
        """What the library says of each curve, and the objects alone."""
        return [ask(cprox.bezier(p), **fields) for p in points]

    def assertRows(self, rows, expected):
        self.assertEqual([(row.b, row.lower, row.upper, row.t) for row in rows],
                         [(e['b'], e['result'].lower, e['result'].upper, e['result'].t) for e in expected])
        for row, e in zip(rows, expected):
            self.assertEqual(numbers([row.witness_a, row.witness_b, row.normal]),
                             [list(e['result'].witness_mover), list(e['result'].witness_obstacle), list(e['result'].normal)])

    def test_pairs_come_nearest_first(self):
        objects = list(BALLS)
        for fields, options in (({}, {}), (dict(count=1), dict(k=1)), (dict(within=1.0), dict(within=1.0)), (dict(within=0.1), dict(within=0.1))):
            expected = self.curves(self.alone.nearest_pairs, LINE, THROUGH, **options)
            self.assertRows(self.good(self.ask('nearest_pairs', LINE, THROUGH, objects=objects, **fields)), sum(expected, []))
            expected = self.motion.nearest_pairs(**options) + self.motion.nearest_pairs(self_collision=True, **options)
            self.assertRows(self.good(self.ask('nearest_pairs', self_collision=True, **fields)), expected)

    def test_contact_is_never_said_too_late(self):
        rows = self.good(self.ask('time_of_contact', LINE, THROUGH, objects=list(BALLS)))
        expected = self.curves(self.alone.time_of_contact, LINE, THROUGH)
        rows += self.good(self.ask('time_of_contact', self_collision=True))
        expected += [self.motion.time_of_contact(self_collision=own) for own in (False, True)]
        self.assertRows(rows, expected)
        self.assertEqual([(row.verdict, row.t_contact_lower) for row in rows], [(e['result'].verdict, e['result'].t_contact_lower) for e in expected])
        self.assertEqual([row.verdict for row in rows], ['clear', 'violated', 'violated', 'clear'])

    def assertProfile(self, profile, expected):
        for name in ('lower', 'upper', 't', 'a', 'b'):
            if name != 'a' or profile.link:
                self.assertEqual(list(getattr(profile, name)), list(expected[name]), name)
        self.assertEqual((list(profile.t0), list(profile.t1)), (list(BREAKS[:-1]), list(BREAKS[1:])))
        for name in ('witness_a', 'witness_b'):
            self.assertEqual(numbers(getattr(profile, name)), expected[name].tolist())

    def test_a_profile_has_the_least_distance_of_each_interval(self):
        for fields, options in ((dict(intervals=8), {}), (dict(breaks=BREAKS), {}), (dict(intervals=8, horizon=0.6), dict(horizon=0.6))):
            found = self.good(self.ask('clearance_profile', LINE, THROUGH, objects=list(BALLS), **fields))
            self.assertEqual(len(found), 2)
            for profile, expected in zip(found, self.curves(self.alone.profile, LINE, THROUGH, breaks=BREAKS, **options)):
                self.assertProfile(profile, expected)
            profiles = self.good(self.ask('clearance_profile', self_collision=True, per_link=True, **fields))
            profiles += self.good(self.ask('clearance_profile', self_collision=True, **fields))
            found = {(profile.summary.kind, profile.link): profile for profile in profiles}
            for kind, link in EVERY_LINK:
                self.assertProfile(found[kind, link], self.motion.profile(BREAKS, self_collision=kind == 'self', links=[link] if link else [], **options))
        self.assertEqual(len(self.good(self.ask('clearance_profile', LINE, objects=['near']))[0].lower), 100)

    def test_violations_begin_and_end_where_the_library_says(self):
        for delta, resolution in ((0.1, 1e-5), (0.3, 1e-3), (0.0, 1e-3)):
            asked = dict(delta=delta, resolution=resolution)
            found = list(self.good(self.ask('violations', LINE, THROUGH, objects=list(BALLS), **asked)))
            expected = self.curves(self.alone.violations, LINE, THROUGH, **asked)
            found += self.good(self.ask('violations', self_collision=True, **asked))
            expected += [self.motion.violations(self_collision=own, **asked) for own in (False, True)]
            self.assertEqual(len(found), len(expected))
            for violations, of in zip(found, expected):
                for name in ('enter_lower', 'enter_upper', 'leave_lower', 'leave_upper', 'verdict', 'upper', 't', 'b'):
                    self.assertEqual(list(getattr(violations, name)), [one[name] for one in of], name)
                self.assertEqual(violations.summary.verdict, 'violated' if of else 'clear')

    def test_gradients_are_those_of_the_library(self):
        trajectory = copy.deepcopy(QUARTER)
        for velocities in ([], [0.3, 0.8]):
            for point, velocity in zip(trajectory.points, velocities):
                point.velocities = [velocity]
            motion = cprox.Motion(self.scene, ['turn'], [0.0, 1.0], [[0.0], [math.pi / 2]], numpy.array([velocities]).T if velocities else None)
            for objects in (['above'], ['above', 'far']):
                response = self.succeeded(self.server.distance([], trajectory=trajectory, objects=objects, gradient=True))
                gradient, of = response.gradients[0], motion.gradient(objects=objects)
                self.assertEqual((gradient.valid, of['valid'], gradient.joints, list(gradient.times)), (True, True, ['turn'], [0.0, 1.0]))
                self.assertEqual(list(gradient.positions), of['positions'].ravel().tolist())
                self.assertEqual(list(gradient.velocities), of['velocities'].ravel().tolist() if velocities else [])
                self.assertEqual(gradient.duration, of['duration'])
                self.assertEqual(numbers([gradient.moving.linear, gradient.moving.angular, gradient.obstacle.linear, gradient.obstacle.angular]),
                                 [of[name].tolist() for name in ('base_linear', 'base_angular', 'object_linear', 'object_angular')])

    def test_gradients_of_a_curve_are_by_its_control_points_its_radius_and_both_sides(self):
        centre, radius = BALLS['near']
        ball = cprox.Obstacle(cprox.sphere(radius), cprox.transform(centre))
        for asked in bezier(*LINE, radius=0.05), bspline(LINE + [(1, 0, 1.5)], 2, radius=0.05):
            def made(points):
                return cprox.bspline(points, 2, asked.knots) if asked.knots else cprox.bezier(points)
            response = self.succeeded(self.server.distance(asked, objects=['near'], gradient=True))
            row, gradient = response.results[0], response.gradients[0]
            points = numpy.array(numbers(asked.points))
            of = cprox.distance_gradient(cprox.tube(made(points), 0.05), ball)
            weights = [made(numpy.outer(one, [1, 0, 0]))(of['t'])[0] for one in numpy.eye(len(points))]
            self.assertEqual((gradient.valid, gradient.radius), (True, -1.0))
            turn = numpy.cross(numbers([row.witness_a])[0], of['mover'])  # about the frame's origin
            for found, expected in ((gradient.points, numpy.outer(weights, of['mover'])), ([gradient.moving.linear], [of['mover']]),
                                    ([gradient.obstacle.linear], [-of['mover']]), ([gradient.moving.angular], [turn])):
                self.assertLess(numpy.abs(numpy.array(numbers(found)) - expected).max(), 1e-9)

    def test_where_there_is_no_derivative_the_answer_says_why(self):
        self.server.replace(sphere('ball', 0.2, (0.5, 0, 0)), sphere('twin', 0.2, (-0.5, 0, 0)))
        for curve, objects, word in ((bezier((-1, 0, 0.5), (1, 0, 0.5)), ['ball', 'twin'], 'equally near'), (bezier((-1, 0, 0), (1, 0, 0)), ['ball'], '')):
            gradient, = self.succeeded(self.server.distance(curve, objects=objects, gradient=True)).gradients
            self.assertFalse(gradient.valid)
            self.assertTrue(gradient.message)
            self.assertIn(word, gradient.message)
        many = self.server.distance([bezier(*LINE)] * 100 + [BAD] + [bezier(*LINE)] * 100, objects=['ball'], gradient=True)
        self.assertFalse(many.success)
        self.assertEqual([gradient.valid for gradient in many.gradients], [True] * 100 + [False] + [True] * 100)
        self.assertEqual(self.server.distance(bezier(*LINE), objects=['ball']).gradients, [])

    def test_a_profile_comes_as_numbers_that_a_plotter_draws(self):
        names = 'environment', 'self', 'environment/arm', 'environment/slider', 'self/arm', 'self/slider', 'curve'
        told = {name: heard('/curve_proximity/clearance/' + name, Clearance) for name in names}
        motions, curves = (self.publisher('/curve_proximity/' + name, kind) for name, kind in (('trajectory', JointTrajectory), ('curve', Curve)))
        moved = copy.deepcopy(QUARTER)
        moved.header.stamp = rospy.Time(1000, 500000000)
        motions.publish(moved)
        curves.publish(bezier(*LINE))
        self.assertTrue(until(lambda: all(len(messages) == 16 for messages in told.values()), 10), {k: len(v) for k, v in told.items()})
        for kind, link in EVERY_LINK:
            expected = self.motion.profile(BREAKS, self_collision=kind == 'self', links=[link] if link else [])
            messages = told[kind + '/' + link if link else kind]
            for i, message in enumerate(messages):
                self.assertEqual((message.id, message.t, message.lower, message.upper, message.a, message.b),
                                 ('trajectory', BREAKS[(i + 1) // 2], *[expected[name][i // 2] for name in ('lower', 'upper', 'a', 'b')]))
                self.assertAlmostEqual(message.header.stamp.to_sec(), 1000.5 + message.t, delta=1e-6)
        self.assertGreater(told['curve'][0].header.stamp, rospy.Time(1001))  # the curve has no stamp: when it came

    def test_what_cannot_be_answered_is_refused_in_one_line(self):
        for which, fields, *words in (
                ('nearest_pairs', dict(per_object=True), 'per_object'), ('time_of_contact', dict(per_object=True), 'per_object'),
                ('clearance_profile', dict(per_object=True), 'per_object'), ('nearest_pairs', dict(within=-1.0), 'within'),
                ('nearest_pairs', dict(within=math.nan), 'within'), ('nearest_pairs', dict(count=100000), 'max_results'),
                ('clearance_profile', dict(intervals=4000000000), 'max_results'), ('clearance_profile', dict(horizon=-1.0), 'horizon'),
                ('clearance_profile', dict(intervals=4, breaks=[0, 1]), 'intervals or breaks'), ('clearance_profile', dict(breaks=[0.5]), 'breaks'),
                ('clearance_profile', dict(per_link=True), 'per_link'), ('violations', dict(delta=-1.0, objects=['ball']), 'delta'),
                ('violations', dict(delta=0.1, resolution=math.nan, objects=['ball']), 'resolution'),
                *[('clearance_profile', dict(breaks=breaks, objects=['ball']), '1 of 1 rows') for breaks in ([0, 2], [0.5, 0.5], [0, math.nan])]):
            self.assertRefused(self.ask(which, LINE, **fields), *words)
        line = bezier(*LINE)
        self.assertRefused(self.server.distance(line, gradient=True, per_object=True), 'per_object')
        for which, fields in (('clearance_profile', {}), ('violations', dict(delta=0.1))):
            self.assertRefused(self.server.ask(which, query=query(line, gradient=True), **fields), 'gradient')

        # of one curve: the others are answered
        for which, fields in (('nearest_pairs', dict(count=1)), ('time_of_contact', {}), ('clearance_profile', dict(intervals=3)),
                              ('violations', dict(delta=0.1))):
            response = self.ask(which, BAD, LINE, objects=['ball'], **fields)
            self.assertRefused(response, '1 of 2 rows', 'not finite')
            rows = getattr(response, 'results', None) or [one.summary for one in getattr(response, 'profiles', None) or response.violations]
            self.assertEqual([row.status for row in rows], ['invalid', 'ok'])

    def test_nothing_to_measure_against_is_said(self):
        self.server.replace()
        row, = self.good(self.ask('time_of_contact'))
        self.assertEqual((row.verdict, row.status, row.upper, row.b), ('undecided', 'empty', math.inf, ''))
        response = self.ask('nearest_pairs')
        self.assertTrue(any('against nothing' in warning for warning in response.warnings), response.warnings)
        profile, = self.good(self.ask('clearance_profile', intervals=2))
        self.assertEqual((list(profile.lower), list(profile.b)), ([0] * 2, [''] * 2))


if __name__ == '__main__':
    run('questions')
