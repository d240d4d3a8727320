#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trajectories in by topic, results out, and the gate behind them, all in one nodelet manager."""
import math
import time

import rospy
from curve_proximity.msg import AttachedCollisionObject, CollisionObject, Curve, ProximityResults
from helpers import (Case, Server, bezier, box, connected, fingerprint, free_flight, heard, joint_trajectory, mesh, path, run, serialized,
                     sphere, transform, until)
from nav_msgs.msg import Path
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, MultiDOFJointTrajectory

LINE = ((-1, 0, 1), (1, 0, 1))


class Topics(Case):
    TYPES = {'curve': Curve, 'trajectory': JointTrajectory, 'multi_dof_trajectory': MultiDOFJointTrajectory, 'path': Path}

    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        cls.results, cls.passed = heard('/curve_proximity/proximity', ProximityResults), []
        cls.publishers = {topic: rospy.Publisher('/curve_proximity/' + topic, kind, queue_size=200)
                          for topic, kind in cls.TYPES.items()}
        cls.objects = rospy.Publisher('/curve_proximity/collision_object', CollisionObject, queue_size=200)
        passed = [rospy.Subscriber('/gate/clear_' + topic, kind, cls.passed.append) for topic, kind in cls.TYPES.items()]
        cls.carried = rospy.Publisher('/curve_proximity/attached_collision_object', AttachedCollisionObject, queue_size=20)
        cls.transforms = rospy.Publisher('/tf', TFMessage, queue_size=10)
        # the manager listens to each publisher once, for the server and the gate
        assert connected(*cls.publishers.values(), cls.objects, cls.carried, *passed)
        time.sleep(0.5)

    def setUp(self):
        self.server.replace(sphere('ball', 0.25))
        self.settled()  # what the gate lets pass of the test before this one may still be on its way
        del self.results[:], self.passed[:]

    def ask(self, topic, message, seconds=5):
        """Sends one message; its answer."""
        before = len(self.results)
        self.publishers[topic].publish(message)
        self.assertTrue(until(lambda: len(self.results) > before, seconds), 'no answer')
        return self.results[before]

    @classmethod
    def ask_service(cls, curves=(), **fields):
        return cls.server.tolerance(list(curves), 0.05, **fields)

    def move(self):
        """The frame moving, not a fixed one, is where the world is, now."""
        self.transforms.publish(TFMessage([transform('world', 'moving', stamp=rospy.Time.now())]))

    def settled(self):
        """What the gate has let pass once everything is through."""
        time.sleep(0.3)
        return len(self.passed)

    def test_a_curve_is_answered_with_its_id_stamp_and_fingerprint(self):
        curve = bezier(*LINE, id='one', stamp=rospy.Time(12, 34))
        answer = self.succeeded(self.ask('curve', curve))
        self.assertEqual((answer.source, answer.id, answer.header.stamp), ('curve', 'one', rospy.Time(12, 34)))
        self.assertEqual((answer.header.frame_id, answer.query_type, answer.delta), ('world', 'tolerance', 0.05))
        self.assertEqual(answer.fingerprint, fingerprint(curve))
        row, = answer.results
        self.assertEqual((row.id, row.verdict), ('one', 'clear'))
        self.assertLessEqual(row.lower, 0.75)

    def test_the_gate_lets_pass_what_is_clear_and_nothing_else(self):
        clear = [bezier(*LINE, id='clear%d' % i) for i in range(5)]
        hits = [bezier((-1, 0, 0.1 * i), (1, 0, 0.1 * i), id='hit%d' % i) for i in range(3)]  # 0.05 and less away
        even = bezier((-1, 0, 0.3), (1, 0, 0.3), id='even')  # just as far away as is asked: within epsilon of either verdict
        self.assertEqual(self.ask('curve', even).results[0].verdict, 'undecided')
        wrong = [bezier((0, 0, 5), id='wrong'), bezier(*LINE, id='lost', frame='nowhere')]
        for curve in clear[:2] + hits + wrong + clear[2:]:
            self.ask('curve', curve)  # all of them with the same stamp, 0
        self.assertEqual(self.settled(), 5)
        self.assertEqual([c.id for c in self.passed], [c.id for c in clear])
        self.assertEqual([c.points for c in self.passed], [c.points for c in clear])

    def test_a_path_is_the_natural_spline_through_its_poses(self):
        # A ball of path_radius 0.1 along a straight line of poses, one of them twice: the spline is that line.
        straight = path((-1, 0, 1), (0.5, 0, 1), (0.5, 0, 1), (1, 0, 1))
        row, = self.ask('path', straight).results
        self.assertEqual((row.id, row.verdict), ('path', 'clear'))
        # Against points just off the spline's own: the natural spline through (0, 0), (1, 1), (2, 0) is z = 3x/2 - x^3/2 over
        # the first chord, by its symmetry; delta is 0.05 and the radius 0.1.
        bend = path((0, 0, 0), (1, 0, 1), (2, 0, 0))
        for offset, verdict in ((0.16, 'clear'), (0.14, 'violated')):
            self.server.replace(sphere('point', 1e-9, (0.5, offset, 1.5 * 0.5 - 0.5 * 0.5**3)))
            row, = self.ask('path', bend).results
            self.assertEqual(row.verdict, verdict, offset)

    def test_paths_that_are_none_fail_with_a_reason(self):
        for message, word in ((path(), 'no poses'), (path((0, 0, math.nan), (1, 0, 0)), 'finite'),
                              (path((0, 0, 0), (1, 0, 0), frame='nowhere'), 'nowhere')):
            self.assertRefused(self.ask('path', message), word)
        mixed = path((0, 0, 0), (1, 0, 0))
        mixed.poses[1].header.frame_id = 'shelf'
        self.assertIn("'shelf'", self.ask('path', mixed).message)
        self.assertEqual(self.settled(), 0)

    def test_one_pose_is_a_point(self):
        self.assertEqual(self.ask('path', path((0, 0, 1))).results[0].verdict, 'clear')
        self.assertEqual(self.ask('path', path((0, 0, 0.3))).results[0].verdict, 'violated')

    def test_joint_trajectories_move_the_robot(self):
        # The arm stands 10 m above the ball.
        answer = self.succeeded(self.ask('trajectory', joint_trajectory(['turn'], [0.0], [1.0])))
        self.assertEqual((answer.results[0].kind, answer.results[0].verdict), ('environment', 'clear'))
        for message, word in ((joint_trajectory(['none'], [0.0], [1.0]), 'none'), (JointTrajectory(), 'no joints')):
            self.assertRefused(self.ask('trajectory', message), word)
        self.assertEqual(self.settled(), 2)  # a message without points is a stop, which passes

    def test_a_flight_of_no_robots_joint_is_its_translation(self):
        answer = self.succeeded(self.ask('multi_dof_trajectory', free_flight('drone', (-1, 0, 1), (0, 0, 1), (1, 0, 1))))
        self.assertEqual((answer.results[0].id, answer.results[0].verdict), ('drone', 'clear'))
        answer = self.ask('multi_dof_trajectory', free_flight('drone', (-1, 0, 0), (1, 0, 0)))
        self.assertEqual(answer.results[0].verdict, 'violated')
        answer = self.ask('multi_dof_trajectory', free_flight('drone', (0, 0, 0), (1, 0, 0), times=[1, 1]))
        self.assertIn('time', answer.message)
        self.assertEqual(self.settled(), 1)

    def test_services_answer_what_topics_do(self):
        asked = dict(curves=bezier(*LINE, id='one'), paths=path((-1, 0, 1), (0, 0, 0.7), (1, 0, 1)),
                     trajectories=joint_trajectory(['turn'], [0.0], [1.0]),
                     multi_dof_trajectories=free_flight('drone', (-1, 0, 1), (0, 0, 0.6), (1, 0, 1)))
        rows = []
        for topic, (name, message) in zip(('curve', 'path', 'trajectory', 'multi_dof_trajectory'), asked.items()):
            by_topic = self.ask(topic, message)
            by_service = self.ask_service(self_collision=topic == 'trajectory', **{name: [message]})
            self.assertTrue(by_topic.success and by_service.success, by_topic.message + by_service.message)
            same = [[(r.id, r.kind, r.verdict, r.lower, r.upper, r.b) for r in answer.results] for answer in (by_topic, by_service)]
            self.assertEqual(same[0], same[1])
            rows += same[1]
        whole = self.ask_service(self_collision=True, **{name: [message] for name, message in asked.items()})
        self.assertEqual([(r.id, r.kind, r.verdict, r.lower, r.upper, r.b) for r in whole.results], rows)
        several = self.ask_service(paths=[asked['paths'], path()])
        self.assertEqual([(r.id, r.status) for r in several.results], [('path/0', 'ok'), ('path/1', 'invalid')])
        self.assertIn('no poses', several.message)

    def test_what_comes_too_fast_is_dropped_oldest_first_and_counted(self):
        late = rospy.Time.now() + rospy.Duration(1000)  # a transform of then is waited for, for ~tf_timeout
        self.move()
        self.assertTrue(until(lambda: self.ask('curve', bezier(*LINE, frame='moving')).success, 5))
        before = self.ask('path', path((0, 0, 9))).dropped
        for attempt in range(10):  # on a machine that stands still for ~tf_timeout they do not come too fast
            del self.results[:]
            self.publishers['curve'].publish(bezier(*LINE, id='slow', frame='moving', stamp=late))
            for i in range(40):
                self.publishers['curve'].publish(bezier((0, 0, 5 + i), (1, 0, 5 + i), id='fast%d' % i))
            self.assertTrue(until(lambda: self.results and self.results[-1].id == 'fast39', 20))
            dropped = self.results[-1].dropped - before
            self.assertEqual(len(self.results) + dropped, 41)
            self.assertEqual([r.id for r in self.results[-5:]], ['fast%d' % i for i in range(35, 40)])
            before += dropped
            if dropped > 0:
                break
        self.assertGreater(dropped, 0)

    def test_objects_come_by_topic(self):
        self.server.replace()
        self.objects.publish(sphere('ball', 0.25, frame='shelf'))
        self.assertTrue(until(lambda: self.server.scene().objects, 5))
        self.assertEqual(self.server.scene().objects[0].pose.position.z, 2)
        self.objects.publish(sphere('bad', -1.0))
        self.objects.publish(sphere('lost', 1.0, frame='nowhere'))
        self.objects.publish(CollisionObject(id='ball', operation=CollisionObject.REMOVE))
        self.assertTrue(until(lambda: not self.server.scene().objects, 5))

    def test_what_a_link_carries_comes_by_topic(self):
        self.server.replace()
        self.carried.publish(AttachedCollisionObject(link_name='arm', object=sphere('tool', 0.1, frame='arm')))
        held = until(lambda: self.server.scene().attached_collision_objects, 5)
        self.assertEqual([(o.link_name, o.object.id) for o in held], [('arm', 'tool')])
        self.carried.publish(AttachedCollisionObject(link_name='none', object=sphere('lost', 0.1, frame='arm')))
        self.carried.publish(AttachedCollisionObject(object=CollisionObject(operation=CollisionObject.REMOVE)))
        self.assertTrue(until(lambda: not self.server.scene().attached_collision_objects, 5))
        self.assertEqual([o.id for o in self.server.scene().objects], ['tool'])

    def test_an_empty_frame_is_the_fixed_one_and_a_stamp_in_the_future_is_an_error_only_where_it_matters(self):
        self.server.replace(box('box', (1, 1, 1)))
        later = rospy.Time.now() + rospy.Duration(1000)
        self.assertTrue(self.ask('path', path((0, 0, 9), (1, 0, 9))).success)
        on_shelf = bezier(*LINE, id='later', frame='shelf', stamp=later)  # shelf is fixed in the world, and so is the arm's base
        self.succeeded(self.ask('curve', on_shelf))
        self.move()
        self.assertTrue(until(lambda: self.ask('curve', bezier(*LINE, frame='moving')).success, 5))
        answer = self.ask('curve', bezier(*LINE, id='later', frame='moving', stamp=later))
        self.assertRefused(answer, "'moving'")
        self.assertEqual(answer.header.stamp, later)

    def test_a_mesh_of_a_hundred_megabytes_is_taken_in_or_refused_and_the_server_goes_on(self):
        n = 2000000
        vertices = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        big = mesh('big', vertices, [(0, 1, 2)])
        big.meshes[0].vertices = big.meshes[0].vertices * (n // 4)
        big.meshes[0].triangles = big.meshes[0].triangles * n
        self.assertGreater(len(serialized(big)), 70e6)
        self.objects.publish(big)
        self.objects.publish(sphere('after', 0.25))
        self.assertTrue(until(lambda: any(o.id == 'after' for o in self.server.scene('after').objects), 60, 0.5))
        self.assertTrue(self.ask('curve', bezier((5, 5, 5), (6, 6, 6)), 20).success)


if __name__ == '__main__':
    run('topics')
