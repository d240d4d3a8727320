#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Errors of an execution, limits of the speed, margins, swept volumes and link pairs by service, against the library's answers."""
import math

import cprox
import numpy
import rospy
from curve_proximity.msg import Body, CollisionObject, ExecutionErrors
from helpers import ARM, Case, Server, bezier, cloud, joint_trajectory, joints, query, run, sphere, thing, until
from sensor_msgs.msg import PointCloud2

QUARTER = joint_trajectory(['turn'], [0.0], [math.pi / 2])  # in a second
BALL = (0.4, 0.9, 0.5)
ERRORS = {'every_joint': {'tracking': 0.01, 'speed': 0.02}, 'base': {'position': 0.002, 'rotation': 0.003},
          'objects': {'position': 0.004, 'rotation': 0.005}, 'sensor': 0.006, 'flex': 0.001, 'timing': 0.01}
PERSON = {'person_speed': 1.6, 'reaction_time': 0.05, 'stopping_time': 0.1, 'intrusion': 0.02}


def errors(**fields):
    return [ExecutionErrors(tracking=0.01, speed=0.02, base_position=0.002, base_rotation=0.003, object_position=0.004,
                            object_rotation=0.005, sensor=0.006, flex=0.001, timing=0.01, **fields)]


class Executions(Case):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        assert until(lambda: cls.server.distance([], trajectory=QUARTER).success, 20)
        cls.robot = cprox.Robot.from_urdf(ARM)

    def setUp(self):
        self.server.replace(sphere('ball', 0.2, BALL))
        self.scene = cprox.Scene(self.robot)
        self.scene.add('ball', 'sphere', [0.2], cprox.transform(BALL))
        self.motion = cprox.Motion(self.scene, ['turn'], [0.0, 1.0], [[0.0], [math.pi / 2]])

    def test_a_verdict_and_its_scale_hold_for_every_execution(self):
        for delta in (0.0, 0.05, 0.1):
            expected = self.motion.robust(ERRORS, delta=delta)
            row = self.row(self.server.tolerance([], delta, trajectory=QUARTER, errors=errors()))
            self.assertEqual((row.verdict, row.b), (expected['result'].verdict, expected['b']))
            self.assertEqual((row.certified_scale, row.refused_scale), (expected['certified_scale'], expected['refused_scale']))
            self.assertEqual((row.lower, row.upper), (expected['result'].lower, expected['result'].upper))
            plain = self.row(self.server.tolerance([], delta, trajectory=QUARTER))
            self.assertTrue(math.isnan(plain.certified_scale) and math.isnan(plain.refused_scale))
        least = min(self.motion.robust_profile([0.0, 1.0], ERRORS)['lower'])
        row = self.row(self.server.distance([], trajectory=QUARTER, errors=errors()))
        self.assertEqual((row.verdict, math.isnan(row.certified_scale)), ('', True))
        self.assertAlmostEqual(row.lower, least, delta=2e-6)

    def test_errors_of_one_joint_take_the_place_of_those_of_all(self):
        own = dict(ERRORS, joints={'turn': {'tracking': 0.05}})
        expected = self.motion.robust(own, delta=0.05)
        row = self.row(self.server.tolerance([], 0.05, trajectory=QUARTER, errors=errors(joints=['turn'], joint_tracking=[0.05])))
        self.assertEqual((row.lower, row.certified_scale), (expected['result'].lower, expected['certified_scale']))

    def test_the_robot_against_itself_has_a_row_with_its_scale(self):
        expected = self.motion.robust(ERRORS, self_collision=True)
        _, row = self.succeeded(self.server.collision([], trajectory=QUARTER, errors=errors(), self_collision=True)).results
        self.assertEqual((row.kind, row.verdict, row.certified_scale), ('self', expected['result'].verdict, expected['certified_scale']))

    def test_profiles_and_times_of_contact_hold_for_every_execution(self):
        profile, = self.succeeded(self.server.ask('clearance_profile', query=query(trajectory=QUARTER, errors=errors()), intervals=8)).profiles
        expected = self.motion.robust_profile(numpy.linspace(0, 1, 9), ERRORS)
        self.assertEqual(list(profile.lower), list(expected['lower']))
        self.assertAlmostEqual(profile.summary.lower, min(expected['lower']), delta=2e-6)

        near = (0.0, 0.5, 0.5)
        self.server.replace(sphere('ball', 0.1, near))
        plain = self.row(self.server.ask('time_of_contact', query=query(trajectory=QUARTER)))
        row = self.row(self.server.ask('time_of_contact', query=query(trajectory=QUARTER, errors=errors())))
        self.assertEqual((plain.verdict, row.verdict), ('violated', 'violated'))
        self.assertLess(row.t_contact_lower, plain.t_contact_lower - 0.01)  # late by .01 s, and off by joints and places
        self.assertGreater(row.t_contact_lower, 0.5)

    def test_limits_of_the_speed_are_those_of_the_library(self):
        asked = dict(query=query(trajectory=QUARTER, objects=['ball']), intervals=20, **PERSON)
        limits, = self.succeeded(self.server.ask('speed_limits', **asked)).limits
        constants = {'person': {'speed': 1.6}, 'robot': {'reaction_time': 0.05, 'stopping_time': 0.1}, 'intrusion': 0.02}
        expected = self.motion.speed_limits(constants, ['ball'], intervals=20)
        self.assertEqual(list(limits.overrides), list(expected['override']))
        self.assertEqual(list(limits.profile.lower), list(expected['lower']))
        self.assertEqual((limits.constant, limits.unwatched), (expected['constant_override'], expected['unwatched_override']))
        self.assertTrue(0 < limits.constant < 1, limits.constant)
        asked['query'].errors = errors()
        slower, = self.succeeded(self.server.ask('speed_limits', **asked)).limits
        self.assertLess(slower.constant, limits.constant)
        for name in ('person_speed', 'reaction_time', 'stopping_time'):  # no default of these is safe
            wrong = dict(query=query(trajectory=QUARTER, objects=['ball']), **dict(PERSON, **{name: 0.0}))
            self.assertRefused(self.server.ask('speed_limits', **wrong), name)
        self.assertRefused(self.server.ask('speed_limits', query=query(trajectory=QUARTER), **PERSON), 'objects')

    def test_margins_are_those_of_the_library(self):
        margins, = self.succeeded(self.server.ask('margins', query=query(trajectory=QUARTER), delta=0.01, within=0.5)).margins
        expected = self.motion.margins(within=0.5, delta=0.01)
        self.assertEqual((margins.summary.verdict, len(margins.free)), ('clear', 7))
        for i, row in enumerate(expected):
            self.assertEqual((margins.object[i], margins.direction[i], margins.free[i], margins.blocked[i], margins.a[i]),
                             (row['object'], row['direction'], row['free'], row['blocked'], row['a']))
        self.assertIn(True, [0 < blocked < 0.5 for blocked in margins.blocked])

    def test_a_swept_volume_is_an_obstacle_that_only_the_motion_meets(self):
        asked = dict(query=query(trajectory=QUARTER, links=['arm']), resolution=0.02, inside=True)
        volume, = self.succeeded(self.server.ask('swept_volume', **asked)).volumes
        expected = self.motion.sweep(0.02, inside=True, links=['arm'])
        self.assertEqual((volume.summary.status, volume.outside_cells, volume.inside_cells, volume.gap),
                         ('ok', len(expected.cells), expected.inside.sum(), expected.gap))
        self.assertEqual(bytes(b % 256 for b in volume.outside.data), expected.to_octomap().split(b'\ndata\n', 1)[1])
        self.assertGreater(volume.inside_cells, 100)
        # is a ball of a centimetre free of the arm for the whole motion?
        self.server.replace(thing('swept', bodies=[Body(type='octree', octree=volume.outside)]))
        for angle in numpy.linspace(0, math.pi / 2, 7):
            beside = 0.1 + 1.01 * volume.gap + 0.01
            for radius, verdict in ((0.5, 'violated'), (0.5 + beside, 'clear'), (0.5 - beside, 'clear')):
                x, y = radius * math.cos(angle), radius * math.sin(angle)
                row = self.row(self.server.collision(bezier((x, y, 0.5), (x, y, 0.501), radius=0.01), objects=['swept']))
                self.assertEqual(row.verdict, verdict, (angle, radius))

    def test_a_swept_volume_that_is_not_finished_has_no_cells(self):
        asked = dict(query=query(trajectory=QUARTER, links=['arm'], budget_ms=300.0), resolution=0.0025)
        volume, = self.server.ask('swept_volume', **asked).volumes
        self.assertEqual((volume.summary.status, volume.outside_cells, volume.gap, len(volume.outside.data)), ('stopped', 0, math.inf, 0))
        self.assertIn('budget_ms', volume.summary.message)
        self.assertRefused(self.server.ask('swept_volume', query=query(trajectory=QUARTER), resolution=1e-5), 'GB')
        self.assertRefused(self.server.ask('swept_volume', query=query(trajectory=QUARTER), resolution=-1.0), 'resolution')

    def test_pairs_of_links_are_those_of_the_library(self):
        pairs = self.succeeded(self.server.ask('collision_matrix')).pairs
        expected = self.robot.collision_matrix()
        self.assertEqual((len(pairs), len(expected)), (3, 3))
        for pair, row in zip(pairs, expected):
            self.assertEqual((pair.a, pair.b, pair.contact, pair.adjacent, pair.lower, pair.upper, dict(zip(pair.joints, pair.positions))),
                             (row['a'], row['b'], row['contact'], row['adjacent'], row['lower'], row['upper'], row['posture']))
        self.assertEqual({(pair.a, pair.b): pair.contact for pair in pairs},  # both slide or turn at heights of their own
                         {('arm', 'base'): 'never', ('arm', 'slider'): 'never', ('base', 'slider'): 'never'})
        self.assertEqual(len(self.succeeded(self.server.ask('collision_matrix', links=['slider'])).pairs), 2)
        self.assertRefused(self.server.ask('collision_matrix', links=['slidr']), 'slider')
        self.assertRefused(self.server.ask('collision_matrix', epsilon=-1.0), 'epsilon')
        late = self.succeeded(self.server.ask('collision_matrix', budget_ms=1e-6)).pairs
        self.assertEqual({pair.contact for pair in late}, {'undecided'})
        self.assertIn('budget_ms', late[0].message)

    def test_a_budget_ends_answers_about_errors_without_clear(self):
        for response in (self.server.tolerance([], 0.0, trajectory=QUARTER, errors=errors(), budget_ms=1e-6),
                         self.server.distance([], trajectory=QUARTER, errors=errors(), budget_ms=1e-6)):
            row, = response.results
            self.assertNotEqual(row.verdict, 'clear')
        asked = query(trajectory=QUARTER, objects=['ball'], budget_ms=1e-6)
        for name, fields, field in (('margins', {}, 'margins'), ('speed_limits', PERSON, 'limits')):
            found, = getattr(self.server.ask(name, query=asked, **fields), field)
            self.assertFalse(any(found.free) if field == 'margins' else any(found.overrides))

    def test_what_does_not_apply_is_said_in_one_line(self):
        line = bezier((-1, 0, 1), (1, 0, 1))
        def tolerance(*curves, **fields):
            return self.server.tolerance(list(curves), 0.0, **fields)
        self.assertRefused(tolerance(line, errors=errors()), 'errors', 'trajectories')
        self.assertRefused(tolerance(trajectory=QUARTER, errors=errors() * 2), 'errors')
        self.assertRefused(tolerance(trajectory=QUARTER, errors=errors(joints=['trn'], joint_tracking=[0.1])), "'turn'")
        self.assertRefused(tolerance(trajectory=QUARTER, errors=errors(joints=['turn'], joint_tracking=[0.1, 0.2])), 'numbers')
        self.assertRefused(tolerance(trajectory=QUARTER, errors=[ExecutionErrors(tracking=-0.1)]), '-0.1')
        self.assertRefused(tolerance(trajectory=QUARTER, errors=[ExecutionErrors(sensor=math.nan)]), 'sensor')
        self.assertRefused(self.server.distance([], trajectory=QUARTER, errors=errors(), gradient=True), 'errors', 'gradient')
        self.assertRefused(self.server.ask('margins', query=query(trajectory=QUARTER), within=-1.0), 'within')
        self.assertRefused(self.server.ask('margins', query=query(line, joint_state=joints(turn=0.0))), 'margins', 'robot')
        self.assertRefused(self.server.ask('swept_volume', query=query(line, joint_state=joints(turn=0.0))), 'swept volumes', 'robot')

    def test_what_is_not_known_leaves_nothing_certified_by_any_service(self):
        """What is dropped, left out or too old, on the way to each service: its status in each row, and no clear."""
        ball, named = sphere('ball', 0.2, BALL), dict(trajectory=QUARTER, objects=['ball', 'cloud'])
        broken = CollisionObject(id='broken', operation=CollisionObject.ADD)  # no shape: refused
        old = cloud([(0, 0, -3)], '', stamp=rospy.Time.now() - rospy.Duration(100))
        cases = {'dropped': ('unknown', {}, ('collision_object', CollisionObject, broken), dict(trajectory=QUARTER)),
                 'late': ('stale', dict(max_age=0.5), ('cloud', PointCloud2, old), named),
                 'blind': ('unknown', {}, ('cloud', PointCloud2, cloud([(math.nan, 0, 0)], '')), dict(trajectory=QUARTER))}
        for name, (status, parameters, said, asked) in cases.items():
            _, server = self.begin(name, **dict(dict(robot_description='/robot_description', max_age=0.0), **parameters))
            self.assertTrue(server.apply(ball).success)
            self.publisher(f'/{name}/{said[0]}', said[1]).publish(said[2])
            self.assertTrue(until(lambda: server.tolerance([], 0.0, trajectory=QUARTER).results[0].status == status, 20), name)
            self.expect_nothing_certified(server, name, status, asked)

    def expect_nothing_certified(self, server, name, status, asked):
        def call(which, **fields):
            return server.ask(which, query=query(**asked), **fields)
        row, = server.tolerance([], 0.0, errors=errors(), **asked).results
        self.assertEqual((row.status, row.verdict, row.lower, row.certified_scale), (status, 'undecided', 0.0, 0.0), name)
        margins, = call('margins').margins
        self.assertEqual((margins.summary.status, margins.summary.verdict, set(margins.free)), (status, 'undecided', {0.0}), name)
        if 'objects' in asked:  # it asks for names
            limits, = call('speed_limits', **PERSON).limits
            self.assertEqual((limits.profile.summary.status, set(limits.overrides), limits.constant), (status, {0.0}, 0.0), name)
        volume, = call('swept_volume', resolution=0.05).volumes
        self.assertEqual(volume.summary.status, 'ok', name)  # objects do not matter to it

    def test_joints_that_nobody_has_said_leave_nothing_certified(self):
        asked = dict(trajectory=joint_trajectory(['trn'], [0.0], [1.0]))
        self.assertRefused(self.server.tolerance([], 0.0, errors=errors(), **asked), 'trn')
        for name, objects, fields in (('margins', [], {}), ('swept_volume', [], {}), ('speed_limits', ['ball'], PERSON)):
            self.assertRefused(self.server.ask(name, query=query(objects=objects, **asked), **fields), 'trn')


if __name__ == '__main__':
    run('executions')
