#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Nothing is clear by accident: which scene an answer is about, how old its data is, and what a restart leaves."""
import math
import os
import signal
import statistics
import tempfile
import time

import rospy
from curve_proximity.msg import AttachedCollisionObject, CollisionObject, ConstraintQuery, ProximityResults, RobotTrajectory
from dynamic_reconfigure.client import Client as Reconfigure
from foreign_types import moveit
from geometry_msgs.msg import PoseStamped
from helpers import (ARM, LINE, Case, Node, Server, bezier, cloud, heard, joint_trajectory, joints, pose, run, sphere, thing,
                     transform, until)
from planning_scene import diff, matrix
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage



def written(path):
    """Is the scene of a node's state file its latest?"""
    return os.path.exists(path) and open(path, 'rb').readline() == b'written\n'


def seen(*points, age=0.0, frame=''):
    return cloud(points, frame, stamp=rospy.Time.now() - rospy.Duration(age))


TOPICS = dict(attached_collision_object=AttachedCollisionObject, cloud=PointCloud2, collision_object=CollisionObject, joint_states=JointState)
BALL, ABOVE = sphere('ball', 0.25), sphere('ball', 0.1, (0, 0, 9))  # LINE is clear of the first, the arm of the second


class Known(Case):
    def launch(self, name, *topics, scene=(BALL,), **parameters):
        """A node, its services, and publishers of its topics."""
        node, server = self.begin(name, **parameters)
        server.replace(*scene)
        return (node, server, *[self.publisher('/%s/%s' % (name, topic), TOPICS[topic]) for topic in topics])

    def becomes(self, server, *expected, **fields):
        """Soon the one row about LINE has this verdict and this status; the row."""
        def asked():
            return server.tolerance(LINE, 0.1, **fields).results[0]
        rows = until(lambda: [row for row in [asked()] if (row.verdict, row.status) == expected], 5)
        self.assertTrue(rows, asked())
        return rows[0]

    def test_every_answer_says_which_scene_it_is_about_and_a_request_may_demand_one(self):
        _, server = self.begin('versions')
        nothing = server.tolerance(LINE, 0.1)
        self.assertEqual((nothing.results[0].verdict, nothing.results[0].status, nothing.scene.objects), ('undecided', 'empty', 0))
        self.assertIn('nothing', nothing.warnings[0])
        applied = server.apply(BALL)
        answer = self.succeeded(server.distance(LINE, scene_epoch=applied.scene.epoch, scene_version=applied.scene.version))
        self.assertEqual((answer.scene.epoch, answer.scene.version, answer.scene.objects, answer.scene.links),
                         (applied.scene.epoch, applied.scene.version, 1, 0))
        self.assertEqual((answer.warnings, answer.scene.sensors), ([], []))
        self.assertLess(abs(answer.scene.epoch.to_sec() - rospy.Time.now().to_sec()), 60)
        for fields, word in ((dict(scene_version=applied.scene.version + 1), 'scene_version'),
                             (dict(scene_epoch=rospy.Time(5)), 'scene_epoch')):
            self.assertRefused(server.distance(LINE, **fields), word)
        self.assertEqual(server.scene().scene.version, applied.scene.version)

    def test_a_cloud_without_a_point_makes_its_object_unknown_and_an_old_one_stale(self):
        _, server, clouds = self.launch('seeing', 'cloud', max_age=0.6)

        def row(**fields):
            return self.row(server.tolerance(LINE, 0.1, **fields))

        clouds.publish(seen((0, 0, -3)))
        self.assertTrue(until(lambda: server.scene().scene.sensors, 5))
        self.assertEqual(row().verdict, 'clear')
        clouds.publish(seen((math.nan, 0, 0)))
        self.assertTrue(until(lambda: server.scene().scene.sensors[0].unknown, 5))
        response = server.tolerance(LINE, 0.1)
        unknown = self.row(response)
        self.assertEqual((unknown.verdict, unknown.status, unknown.lower), ('undecided', 'unknown', 0.0))
        self.assertIn("'cloud'", unknown.message)
        self.assertIn("'cloud'", response.warnings[0])
        self.assertEqual({o.id for o in server.scene().objects}, {'ball', 'cloud'})  # it keeps its last shape
        self.assertEqual(row(objects=['ball']).verdict, 'clear')  # it is not about the cloud
        self.assertFalse(server.apply(sphere('cloud', -1.0)).success)  # what fails takes nothing from the sensor
        self.assertEqual(row().status, 'unknown')
        distance = server.distance(LINE).results[0]
        self.assertEqual((distance.lower, distance.status), (0.0, 'unknown'))
        clouds.publish(seen((0, 0, -3)))
        self.becomes(server, 'clear', 'ok')
        stale = self.becomes(server, 'undecided', 'stale')
        self.assertEqual(stale.lower, 0.0)
        self.assertIn('max_age', stale.message)
        clouds.publish(seen((0, 0, -3), age=100))  # the stamp counts, too
        self.assertTrue(until(lambda: server.scene().scene.sensors[0].age > 99, 5))
        self.assertEqual(row().status, 'stale')
        server.apply(thing('cloud', operation=CollisionObject.REMOVE))  # somebody says so
        self.assertEqual(row().verdict, 'clear')

    def test_with_empty_cloud_clears_the_object_goes(self):
        _, server = self.begin('clearing', empty_cloud_clears=True)
        clouds = self.publisher('/clearing/cloud', PointCloud2)
        clouds.publish(seen((0, 0, -3)))
        self.assertTrue(until(lambda: server.scene().objects, 5))
        clouds.publish(seen())
        self.assertTrue(until(lambda: not server.scene().objects, 5))
        self.assertEqual(server.tolerance(LINE, 0.1).results[0].status, 'empty')

    def test_with_allow_empty_nothing_is_an_answer(self):
        _, server = self.begin('allowing', allow_empty=True)
        row, = server.tolerance(LINE, 0.1).results
        self.assertEqual((row.status, row.verdict, row.lower), ('ok', 'clear', math.inf))

    def test_joint_states_and_their_age(self):
        self.set_robot()
        _, server, states = self.launch('jointed', 'joint_states', scene=(ABOVE,), max_age=0.5, fixed_frame='base', state_rate=20.0)
        states.publish(joints(turn=0.0))
        fresh = until(lambda: (lambda r: r.success and r)(server.tolerance([], 0.01, robot_state=True)), 5)
        self.assertEqual((fresh.results[0].id, fresh.results[0].kind, fresh.results[0].verdict),
                         ('state', 'environment', 'clear'))
        self.assertLess(fresh.scene.joint_state_age, 0.5)
        stale = until(lambda: (lambda r: r.results[0].status == 'stale' and r)(server.tolerance([], 0.01, robot_state=True)), 5)
        self.assertEqual(stale.results[0].verdict, 'undecided')
        self.assertGreater(stale.scene.joint_state_age, 0.5)
        told = heard('/jointed/state_proximity', ProximityResults)
        self.assertTrue(until(lambda: told, 10))
        self.assertEqual({(row.status, row.verdict) for row in told[-1].results}, {('stale', 'undecided')})

    def test_a_robot_that_has_not_told_of_itself_for_some_seconds_is_stale_by_default(self):
        self.set_robot()
        _, server, states = self.launch('silent', 'joint_states', scene=(ABOVE,), max_age=None, fixed_frame='base')
        for age, expected in ((4.0, ('undecided', 'stale')), (0.0, ('clear', 'ok'))):
            states.publish(JointState(header=Header(stamp=rospy.Time.now() - rospy.Duration(age)), name=['turn'], position=[0.0]))
            self.assertTrue(until(lambda: [(r.verdict, r.status) for r in server.tolerance([], 0.01, robot_state=True).results] == [expected], 5))

    def test_transforms_and_their_age(self):
        _, server = self.launch('placed', max_age=0.5)
        transforms = self.publisher('/tf', TFMessage)
        line = bezier((-1, 0, 1), (1, 0, 1), frame='moving')

        transforms.publish(TFMessage([transform('world', 'moving', stamp=rospy.Time.now())]))
        fresh = until(lambda: (lambda r: r.success and r)(server.tolerance(line, 0.1)), 5)
        self.assertEqual((fresh.results[0].verdict, fresh.results[0].status), ('clear', 'ok'))
        self.assertLess(fresh.scene.transform_age, 0.5)
        stale = until(lambda: (lambda r: r.results[0].status == 'stale' and r)(server.tolerance(line, 0.1)), 5)
        self.assertEqual((stale.results[0].verdict, stale.results[0].lower), ('undecided', 0.0))
        self.assertIn('transform', stale.results[0].message)
        self.assertGreater(stale.scene.transform_age, 0.5)
        self.assertEqual(server.tolerance(LINE, 0.1).results[0].verdict, 'clear')  # it needs no transform

    def test_constraints_say_what_they_rest_on(self):
        _, server = self.begin('constrained', constraint_providers=['curve_proximity/CurveDistance'], max_age=0.5)

        def evaluate(**fields):
            return server.ask('evaluate_constraints', **fields)
        transforms = self.publisher('/tf', TFMessage)
        scene = server.replace(BALL).scene
        cases = [ConstraintQuery(id='fixed', b=CollisionObject(id='ball'), curve=LINE),
                 ConstraintQuery(id='moving', b=CollisionObject(id='ball'), curve=bezier((-1, 0, 1), (1, 0, 1), frame='carried'))]
        transforms.publish(TFMessage([transform('world', 'carried', stamp=rospy.Time.now())]))
        demand = dict(scene_epoch=scene.epoch, scene_version=scene.version)
        fresh = until(lambda: (lambda r: r.success and r)(evaluate(cases=cases, **demand)), 5)
        self.assertEqual([(r.id, r.status) for r in fresh.results], [('fixed', 'ok'), ('moving', 'ok')])
        self.assertLess(fresh.scene.transform_age, 0.5)
        stale = until(lambda: (lambda r: r.results[1].status == 'stale' and r)(evaluate(cases=cases)), 5)
        self.assertEqual([(r.id, r.status) for r in stale.results], [('fixed', 'ok'), ('moving', 'stale')])
        self.assertAlmostEqual(stale.results[1].value, 0.75, delta=1e-6)
        self.assertTrue(math.isnan(stale.results[1].lower) and math.isnan(stale.results[1].upper))
        self.assertIn('max_age', stale.warnings[0])
        self.assertFalse(evaluate(cases=cases, scene_version=scene.version + 100).success)

    def test_the_scene_survives_a_crash_and_a_lost_one_is_said(self):
        folder = tempfile.mkdtemp()
        path = folder + '/kept.scene'
        node, server = self.begin('kept', state_file=path)
        clouds = self.publisher('/kept/cloud', PointCloud2)
        before = server.replace(BALL, sphere('other', 0.1, (5, 5, 5), padding=0.01)).scene
        clouds.publish(seen((0, 0, -3)))
        self.assertTrue(until(lambda: server.scene().scene.sensors, 5))
        self.assertTrue(until(lambda: written(path) and b'cloud' in open(path, 'rb').read(), 5))
        again, server = self.crash(node, 'kept', state_file=path)
        scene = server.scene()
        self.assertEqual({o.id for o in scene.objects}, {'ball', 'other'})
        answer = server.distance(LINE, objects=['ball'])
        self.assertAlmostEqual(answer.results[0].upper, 0.75, delta=2e-6)
        self.assertNotEqual(answer.scene.epoch, before.epoch)
        self.assertEqual(answer.warnings, [])
        self.assertEqual(server.tolerance(LINE, 0.1).results[0].status, 'unknown')  # the cloud has not come yet

        # the file is cut short: what is lost is said, in every answer until there is a scene again
        with open(path, 'r+b') as file:
            file.truncate(os.path.getsize(path) - 10)
        _, server = self.crash(again, 'kept', state_file=path)
        self.assertEqual(server.scene().objects, [])
        self.assertTrue(any('lost' in w for w in server.distance(LINE).warnings))
        server.replace(BALL)
        self.assertFalse(any('lost' in w for w in server.distance(LINE).warnings))  # of the cloud nothing is known yet

    def test_a_change_that_was_not_written_yet_when_the_server_died_is_not_forgotten(self):
        path = tempfile.mkdtemp() + '/kept.scene'
        node, server = self.launch('hasty', state_file=path)
        self.assertTrue(until(lambda: written(path), 5))
        self.assertTrue(server.apply(sphere('on_line', 0.25, (0, 0, 1))).success)  # and at once:
        again, server = self.crash(node, 'hasty', state_file=path)
        row, = server.tolerance(LINE, 0.1).results
        self.assertEqual((row.status, row.verdict), ('unknown', 'undecided'))
        self.assertIn('lost', row.message)
        self.assertTrue(server.apply(sphere('other', 0.1, (5, 5, 5))).success)  # one object is no scene
        self.assertEqual(server.tolerance(LINE, 0.1).results[0].status, 'unknown')
        self.assertEqual(server.tolerance(LINE, 0.1, objects=['ball']).results[0].status, 'unknown')  # it may have moved
        self.assertTrue(until(lambda: written(path), 5))
        node, server = self.crash(again, 'hasty', state_file=path)  # nor does another crash bring back what is lost
        self.assertIn('lost', server.tolerance(LINE, 0.1).results[0].message)
        server.replace(BALL)
        self.assertEqual(server.tolerance(LINE, 0.1).results[0].verdict, 'clear')

    def test_an_object_that_was_refused_before_a_crash_is_unknown_after_it(self):
        path = tempfile.mkdtemp() + '/kept.scene'
        node, server, objects = self.launch('stubborn', 'collision_object', state_file=path, tf_timeout=0.05)
        objects.publish(sphere('post', 0.1, (0, 0, 1), frame='nowhere'))
        self.becomes(server, 'undecided', 'unknown')
        self.assertTrue(until(lambda: written(path), 5))
        _, server = self.crash(node, 'stubborn', state_file=path, tf_timeout=0.05)
        row, = server.tolerance(LINE, 0.1).results
        self.assertEqual(row.status, 'unknown')
        self.assertIn("object 'post' is not used", row.message)
        self.assertTrue(server.apply(sphere('post', 0.1, (0, 0, 5))).success)
        self.assertEqual(server.tolerance(LINE, 0.1).results[0].verdict, 'clear')

    def test_a_matrix_that_replaces_the_srdfs_pairs_does_so_after_a_crash(self):
        ball = '<collision><geometry><sphere radius="0.2"/></geometry></collision>'
        slide = '<joint name="%s" type="prismatic"><parent link="%s"/><child link="%s"/><axis xyz="%s"/>' \
                '<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>'
        self.set_param('/two_balls', '<robot name="two"><link name="base">%s</link><link name="slide"/><link name="tip">%s</link>%s%s</robot>' %
                        (ball, ball, slide % ('x', 'base', 'slide', '1 0 0'), slide % ('y', 'slide', 'tip', '0 1 0')))
        self.set_param('/two_balls_semantic', '<robot name="two"><disable_collisions link1="base" link2="tip" reason="Never"/></robot>')
        with_robot = dict(state_file=tempfile.mkdtemp() + '/kept.scene', robot_description='/two_balls',
                          robot_description_semantic='/two_balls_semantic', fixed_frame='base')
        node, server = self.launch('matrix', scene=(sphere('far', 0.1, (9, 9, 9)),), **with_robot)
        away = joint_trajectory(['x', 'y'], (0.1, 0.1), (0.2, 0.1))

        def violated(of):
            return [row.verdict for row in of.collision([], trajectory=away, self_collision=True).results].count('violated')

        self.assertEqual(violated(server), 0)
        scenes = self.publisher('/matrix/planning_scene', moveit.PlanningScene)
        scene = diff()
        scene.allowed_collision_matrix = matrix(['base', 'tip'], [])
        scenes.publish(scene)
        self.assertTrue(until(lambda: violated(server) == 1, 5))
        self.assertTrue(until(lambda: written(with_robot['state_file']), 5))
        _, server = self.crash(node, 'matrix', **with_robot)
        self.assertEqual([o.id for o in server.scene().objects], ['far'])
        self.assertEqual(violated(server), 1)

    def test_a_scene_that_began_with_another_robot_is_not_taken_over(self):
        path = tempfile.mkdtemp() + '/kept.scene'
        node, server = self.launch('second', state_file=path)
        self.assertTrue(until(lambda: written(path), 5))
        self.set_robot()
        node, server = self.crash(node, 'second', state_file=path, fixed_frame='base')
        self.assertEqual(server.scene().objects, [])
        self.assertIn('another scene file, robot', node.output())

    def set_robot(self, more=''):
        with open(ARM) as text:
            self.set_param('/robot_description', text.read().replace('</robot>', more + '</robot>'))

    def test_what_is_expected_and_has_not_come_is_unknown(self):
        _, server = self.launch('expecting', expected_sensors=['cloud'], ask_planning_scene=True)
        row, = server.tolerance(LINE, 0.1).results
        self.assertEqual((row.status, row.verdict), ('unknown', 'undecided'))
        self.assertIn('no planning scene has come', row.message)
        self.assertIn("'cloud'", row.message)
        self.assertEqual([(s.id, s.unknown) for s in server.scene().scene.sensors], [('cloud', True)])

    def test_an_object_by_topic_that_cannot_be_used_is_unknown_until_it_can(self):
        _, server, objects = self.launch('refusing', 'collision_object')
        objects.publish(sphere('post', 0.1, (0, 0, 1), frame='nowhere'))
        self.assertIn("object 'post' is not used", self.becomes(server, 'undecided', 'unknown').message)
        self.assertEqual(server.tolerance(LINE, 0.1, objects=['ball']).results[0].verdict, 'clear')
        objects.publish(sphere('post', 0.1, (0, 0, 5)))
        self.becomes(server, 'clear', 'ok')

    def test_what_may_have_gone_proves_no_contact(self):
        """The last shape of a sensor that sees nothing any more, and an object whose next version was refused."""
        post = sphere('post', 0.1, (0, 0, 1))
        _, server, objects, clouds = self.launch('moved', 'collision_object', 'cloud', scene=(post,), tf_timeout=0.05)
        self.becomes(server, 'violated', 'ok')
        objects.publish(sphere('post', 0.1, (0, 0, 5), frame='nowhere'))
        self.becomes(server, 'undecided', 'unknown')
        objects.publish(sphere('post', 0.1, (0, 0, 5)))
        self.becomes(server, 'clear', 'ok')
        clouds.publish(seen((0, 0, 1)))
        self.becomes(server, 'violated', 'ok')
        clouds.publish(seen((math.nan, 0, 0)))
        self.becomes(server, 'undecided', 'unknown')
        server.replace(post)  # the cloud's last shape is gone: it can only be missing
        self.becomes(server, 'violated', 'unknown')

    def test_any_number_of_refused_objects_takes_no_more_room_and_is_no_more_clear(self):
        _, server = self.launch('flooded', scene=(ABOVE,))
        objects = self.publisher('/flooded/collision_object', CollisionObject, queue_size=0)

        def send(radius):
            """More objects than are kept one by one, and fewer at once than may wait."""
            for begin in range(0, 1200, 400):
                for i in range(begin, begin + 400):
                    objects.publish(sphere('object %d' % i, radius, (0, 0, 5)))
                objects.publish(sphere('last', 0.1, (0, 0, 5 + radius + begin)))
                self.assertTrue(until(lambda: [o.pose.position.z for o in server.scene().objects if o.id == 'last'] == [5 + radius + begin], 30))

        def status(names):
            return server.tolerance(LINE, 0.1, objects=names).results[0].status
        send(-1.0)
        self.assertEqual((status([]), status(['ball'])), ('unknown', 'unknown'))  # it may be any of them
        send(0.1)
        self.assertEqual((server.scene().scene.objects, status(['ball'])), (1202, 'unknown'))
        server.replace(ABOVE)
        self.assertEqual(status([]), 'ok')

    def test_objects_that_were_lost_because_too_many_came_at_once_are_unknown(self):
        _, server = self.launch('overrun', scene=(ABOVE,))
        objects = self.publisher('/overrun/collision_object', CollisionObject, queue_size=0)
        for i in range(3000):
            objects.publish(sphere('object %d' % i, 0.1, (0, 0, 5)))
        self.assertTrue(until(lambda: any(o.id == 'object 2999' for o in server.scene().objects), 60))
        row = server.tolerance(LINE, 0.1).results[0]
        there = server.scene().scene.objects
        self.assertTrue((row.status == 'unknown' and 'were lost' in row.message) if there < 3001 else row.status == 'ok', (there, row))

    def test_a_carried_object_that_is_refused_is_unknown_wherever_the_robot_is_asked_about(self):
        self.set_robot()
        _, server, carried = self.launch('carrying', 'attached_collision_object', scene=(ABOVE,), fixed_frame='base', tf_timeout=0.05)
        turning = joint_trajectory(['turn'], (0.0,), (0.5,))

        def statuses():
            rows = server.tolerance([], 0.01, trajectory=turning, self_collision=True, objects=['ball']).results
            return {(row.kind, row.status) for row in rows}

        self.assertEqual(statuses(), {('environment', 'ok'), ('self', 'ok')})
        for frame, status in (('nowhere', 'unknown'), ('arm', 'ok')):
            carried.publish(AttachedCollisionObject(link_name='arm', object=sphere('tool', 0.05, (0.5, 0, 0.2), frame=frame)))
            self.assertTrue(until(lambda: statuses() == {('environment', status), ('self', status)}, 5), statuses())

    def test_what_is_unknown_stays_so_when_it_is_moved(self):
        _, server, objects, clouds = self.launch('pushed', 'collision_object', 'cloud', scene=(BALL, sphere('post', 0.1, (0, 0, 4))), tf_timeout=0.05)
        clouds.publish(seen((0, 0, -3)))
        self.assertTrue(until(lambda: server.tolerance(LINE, 0.1).results[0].verdict == 'clear' and server.scene().scene.sensors, 5))
        clouds.publish(seen((math.nan, 0, 0)))
        objects.publish(sphere('post', 0.1, (0, 0, 1), frame='nowhere'))
        for name, word in (('cloud', 'sensor'), ('post', 'not used')):
            self.assertTrue(until(lambda: word in server.tolerance(LINE, 0.1, objects=[name]).results[0].message, 5))
            self.assertTrue(server.apply(thing(name, (0, 0, 5), operation=CollisionObject.MOVE)).success)
            self.assertEqual(server.tolerance(LINE, 0.1, objects=[name]).results[0].status, 'unknown')

    def test_a_cloud_that_is_refused_is_unknown_also_where_none_was_before(self):
        _, server, clouds = self.launch('frameless', 'cloud', tf_timeout=0.05)
        on_line = seen((0, 0, 1), frame='nowhere')
        clouds.publish(on_line)
        self.becomes(server, 'undecided', 'unknown')
        clouds.publish(seen((0, 0, -3)))
        self.becomes(server, 'clear', 'ok')
        clouds.publish(on_line)
        self.becomes(server, 'undecided', 'unknown')

    def test_a_scene_that_is_emptied_knows_nothing_of_what_sensors_see(self):
        _, server, clouds = self.launch('emptied', 'cloud')
        for emptied in lambda: server.replace(BALL), lambda: server.apply(thing('', operation=CollisionObject.REMOVE), BALL):
            clouds.publish(seen((0, 0, -3)))
            self.assertTrue(until(lambda: any(not s.unknown for s in server.scene().scene.sensors), 5))
            self.assertTrue(emptied().success)
            self.assertEqual(server.tolerance(LINE, 0.1).results[0].status, 'unknown')

    def test_a_cloud_of_hardly_a_valid_point_is_one_of_none(self):
        _, server, clouds = self.launch('covered', 'cloud')
        clouds.publish(seen((0, 0, -30), *[(math.nan, 0, 0)] * 999))
        self.assertTrue(until(lambda: server.scene().scene.sensors, 5))
        self.assertEqual(server.tolerance(LINE, 0.1).results[0].status, 'unknown')
        clouds.publish(seen(*[(0, 0, -30)] * 100, *[(math.nan, 0, 0)] * 900))
        self.becomes(server, 'clear', 'ok')

    def test_joints_that_nobody_has_told_are_unknown(self):
        self.set_robot('<joint name="lift" type="prismatic"><parent link="arm"/><child link="hand"/><axis xyz="0 0 1"/>'
                       '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint><link name="hand"/>')
        turning, whole = joint_trajectory(['turn'], (0.0,), (0.5,)), joint_trajectory(['turn', 'lift'], (0.0, 0.0), (0.5, 0.0))
        _, server, states = self.launch('untold', 'joint_states', scene=(ABOVE,), fixed_frame='base',
                                        constraint_providers=['curve_proximity/RobotDistance'])

        def row(curves=(), **fields):
            return self.row(server.tolerance(curves, 0.01, **fields))

        def constraint(**fields):
            one, = server.ask('evaluate_constraints', cases=[ConstraintQuery(**fields)]).results
            return one.status
        self.assertEqual(row(trajectory=whole, current_joints=True).verdict, 'clear')
        for fields in (dict(current_joints=True), {}, dict(joint_state=joints(turn=0.3))):
            self.assertEqual((row(trajectory=turning, **fields).status, row(trajectory=turning, **fields).verdict), ('unknown', 'undecided'))
            self.assertIn("where joint 'lift' is was not told", row(trajectory=turning, **fields).message)
            self.assertEqual(row(trajectory=turning, **dict(fields, joint_state=joints(lift=0.0))).verdict, 'clear')
        self.assertEqual(row(LINE, joint_state=joints(turn=0.0)).status, 'unknown')  # curves meet links there
        self.assertEqual(row(LINE, joint_state=joints(turn=0.0, lift=0.0)).verdict, 'clear')
        self.assertEqual([constraint(trajectory=of) for of in (turning, whole)], ['unknown', 'ok'])

        def beside(**fields):
            other = RobotTrajectory(name='other', base=PoseStamped(pose=pose((9, 0, 0))), trajectory=turning, **fields)
            return dict(trajectory=whole, moving_robots=[other])
        for fields, status in (({}, 'unknown'), (dict(joint_state=joints(lift=0.0)), 'ok')):
            self.assertEqual((row(**beside(**fields)).status, constraint(**beside(**fields))), (status, status))
            self.assertEqual("robot 'other': where joint 'lift'" in row(**beside(**fields)).message, status == 'unknown')
            self.assertEqual(self.row(server.tolerance([], 0.01, movers=True, moving_robots=beside(**fields)['moving_robots'])).status, status)
        states.publish(joints(turn=0.0))
        self.assertEqual(until(lambda: [r.status for r in server.tolerance([], 0.01, robot_state=True).results], 5), ['unknown'])
        self.assertEqual(row(LINE, current_joints=True).status, 'unknown')
        self.assertEqual(constraint(trajectory=turning, current_joints=True), 'unknown')

        def hold(link):
            tool = sphere('tool', 0.05, (0.5, 0, 0.2), frame='base')
            return server.apply(attached_collision_objects=[AttachedCollisionObject(link_name=link, object=tool)])
        self.assertRefused(hold('hand'), "'hand'", "where joint 'lift' is was not told")
        self.succeeded(hold('arm'))  # lift does not move it
        states.publish(joints(lift=0.0))
        self.assertTrue(until(lambda: row(robot_state=True).verdict == 'clear', 5))
        self.assertEqual(row(LINE, current_joints=True).verdict, 'clear')
        self.assertEqual(constraint(trajectory=turning, current_joints=True), 'ok')
        self.assertEqual(row(trajectory=turning).status, 'unknown')  # the request does not ask for the current joints
        _, assuming = self.launch('assuming', scene=(ABOVE,), fixed_frame='base', assumed_joints=['lift'])
        for fields in (dict(current_joints=True), {}):
            self.assertEqual(assuming.tolerance([], 0.01, trajectory=turning, **fields).results[0].verdict, 'clear')

    def test_a_planar_joint_is_known_by_all_of_its_variables(self):
        self.set_robot('<joint name="drive" type="planar"><parent link="arm"/><child link="cart"/><axis xyz="0 0 1"/></joint>'
                       '<link name="cart"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>')
        turning, names = joint_trajectory(['turn'], (0.0,), (0.5,)), ('drive/x', 'drive/y', 'drive/theta')
        _, server = self.launch('driven', scene=(ABOVE,), fixed_frame='base')
        for n in range(4):
            response = server.tolerance([], 0.01, trajectory=turning, joint_state=joints(**dict.fromkeys(names[:n], 0.0)))
            self.assertEqual(self.row(response).status, 'unknown' if n < 3 else 'ok')
            self.assertEqual("'drive'" in self.row(response).message, n < 3)
        driving = joint_trajectory(['turn', *names], (0.0, 0.0, 0.0, 0.0), (0.5, 1.0, 0.0, 0.0))
        self.assertEqual(self.row(server.tolerance([], 0.01, trajectory=driving)).verdict, 'clear')
        _, assuming = self.launch('parked', scene=(ABOVE,), fixed_frame='base', assumed_joints=['drive'])
        self.assertEqual(self.row(assuming.tolerance([], 0.01, trajectory=turning)).verdict, 'clear')

    def test_a_request_that_asks_nothing_is_an_error(self):
        _, server = self.launch('asked')
        answer = server.tolerance([], 0.1)
        self.assertRefused(answer, 'nothing is asked')
        self.assertEqual(answer.results, [])

    def test_a_scene_that_a_restart_has_lost_is_said_and_never_clear(self):
        node, server = self.launch('forgetful')
        self.assertEqual(server.tolerance(LINE, 0.1).results[0].verdict, 'clear')
        self.assertTrue(until(lambda: rospy.has_param('/forgetful/last_scene'), 5))
        node, server = self.crash(node, 'forgetful')
        self.assertEqual(server.scene().objects, [])
        for answer in (server.tolerance(LINE, 0.1), server.collision(LINE)):
            row, = answer.results
            self.assertEqual((row.status, row.verdict, row.lower), ('unknown', 'undecided', 0.0))
            self.assertIn('lost', row.message)
            self.assertEqual(len([w for w in answer.warnings if 'lost' in w]), 1)
        row, = server.distance(LINE).results
        self.assertEqual((row.status, row.lower), ('unknown', 0.0))

        # from the next whole scene on nothing is lost any more
        self.assertTrue(server.apply(BALL).success)
        self.assertEqual(server.tolerance(LINE, 0.1).results[0].status, 'unknown')
        server.replace(BALL)
        answer = server.tolerance(LINE, 0.1)
        self.assertEqual((answer.results[0].status, answer.results[0].verdict), ('ok', 'clear'))
        self.assertEqual(answer.warnings, [])

    def crash(self, node, name, **parameters):
        """The node dies, and another one of its name takes its place, as by a respawn: the master keeps parameters."""
        node.process.send_signal(signal.SIGKILL)
        node.wait(5)
        kept = rospy.get_param('/%s/last_scene' % name)
        again = Node(name, **parameters, last_scene=kept)
        self.addCleanup(again.end)
        return again, Server('/' + name)

    def test_dynamic_reconfigure_refuses_what_makes_no_sense(self):
        _, server = self.launch('tuned')
        client = Reconfigure('/tuned', timeout=10)
        for name, value in (('epsilon', math.nan), ('budget_ms', math.nan), ('delta', math.nan), ('epsilon', -1.0),
                            ('budget_ms', -5.0), ('delta', -1.0), ('threads', 0), ('threads', 1000), ('max_nodes', -3)):
            kept = client.get_configuration()[name]
            self.assertEqual(client.update_configuration({name: value})[name], kept, (name, value))
        times = []
        for threads in (256, 1, 64, 1, 256, 4):
            begin = time.monotonic()
            self.assertEqual(client.update_configuration({'threads': threads})['threads'], threads)
            times.append(time.monotonic() - begin)
        self.assertLess(statistics.median(times), 0.2)
        row, = server.distance(LINE).results
        self.assertEqual(row.status, 'ok')
        self.assertEqual(client.update_configuration({'epsilon': 1e-3})['epsilon'], 1e-3)


if __name__ == '__main__':
    run('known')
