#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Objects and further robots that move: by message, beside each other, in the scene and in pictures. That distances, times and
profiles are true is held against references of their own by scene.test_movers, cli.test_movers and attack.movers."""
import math

import rospy
from curve_proximity.msg import AttachedCollisionObject, Body, CollisionObject, LinkPadding, ProximityResults, RobotTrajectory
from helpers import (Case, Drawings, Server, bezier, box, free_flight, heard, joint_trajectory, joints, moving, path, pose, query, run,
                     sphere, turned, until, waypoint)
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from visualization_msgs.msg import Marker

READY = dict(panda_joint1=0.0, panda_joint2=0.4, panda_joint3=0.0, panda_joint4=-1.4, panda_joint5=0.0, panda_joint6=1.8,
             panda_joint7=0.785, panda_finger_joint1=0.02, panda_finger_joint2=0.02)


def swing(begin, end, stamp=0.0):
    """In two seconds."""
    names = [name for name in READY if name != 'panda_finger_joint2']
    message = joint_trajectory(names, *[[dict(READY, panda_joint1=value)[n] for n in names] for value in (begin, end)], times=(0.0, 2.0))
    message.header.stamp = rospy.Time.from_sec(stamp)
    return message


def other(trajectory, x=1.6, robot='other', name='right'):
    out = RobotTrajectory(name=name, robot=robot, trajectory=trajectory)
    out.base.pose = pose((x, 0, 0), (0, 0, 1, 0))
    return out


class Movers(Case):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        until(lambda: cls.server.distance([], robot_state=True, joint_state=joints(**READY)).success, 20)

    def setUp(self):
        self.server.replace()

    @staticmethod
    def fall(**fields):
        """A box that falls by 2 m in 0.8 s, turning by 120 degrees about x."""
        return moving(box('box', (0.2, 0.1, 0.3)), waypoint(0, (0, 2, 3)), waypoint(0.8, (0, 2, 1), turned(math.radians(120), (1, 0, 0))), **fields)

    def test_a_further_robot_may_be_of_the_servers_own_model(self):
        first, second = swing(-0.8, 0.8, stamp=1000.0), swing(-0.8, 0.8, stamp=1000.75)
        rows = []
        for robot in ('other', ''):
            rows.append(self.row(self.server.distance([], trajectory=first, moving_robots=[other(second, robot=robot)], epsilon=1e-5)))
        self.assertEqual((rows[0].id, rows[0].kind, rows[0].b.split('/')[0]), ('trajectory', 'environment', 'right'))
        self.assertEqual(rows[0].upper, math.inf)  # ~max_lod is hull: it bounds from below
        self.assertEqual(*[(row.a, row.b, row.lower, row.upper, row.t) for row in rows])

    def test_what_moves_and_parts_of_its_time_have_proofs(self):
        """A record of parts of a profile and of violations. The parts are checked by test_certificate and cli.test_movers."""
        self.server.replace(self.fall(), sphere('ball', 0.1, (0, 3, 2.5)))
        row, = self.server.distance([], movers=True, certificate=True).results
        self.assertTrue(row.certificate.startswith(b'CPC1') and row.problem_fingerprint, row.message)
        curve = bezier([0, 2.6, 0], [0, 2.6, 4])
        for asked in (dict(movers=True, certificate=True), dict(curves=[curve], joint_state=joints(**READY), certificate=True)):
            if 'curves' in asked:
                self.server.replace(sphere('ball', 0.1, (0, 3, 2.5)))
            with self.subTest(movers='movers' in asked):
                profile, = self.server.ask('clearance_profile', query=query(**asked), intervals=3).profiles
                self.assertEqual(bytes(profile.summary.certificate)[:8], b'CPCP' + bytes((3, 0, 0, 0)), profile.summary.message)
                found, = self.server.ask('violations', query=query(**asked), delta=1.0).violations
                self.assertTrue(found.summary.certificate.startswith(b'CPCP') and found.summary.problem_fingerprint,
                                found.summary.message)
                refused = self.server.ask('nearest_pairs', query=query(**asked), count=3)
                self.assertIn('certificate does not apply', refused.message)

    def test_it_is_shown_at_the_moment_of_closest_approach(self):
        self.server.replace(self.fall(), sphere('ball', 0.1, (0, 3, 2.5)))
        drawings = Drawings()
        row, = self.server.distance([], movers=True).results
        self.assertTrue(0.0 < row.t < 0.4, row.t)
        shown = drawings.shown(lambda s: [m.type for m in s['movers']] == [Marker.CUBE], 'movers', 'movers_way', 'pairs')
        self.assertAlmostEqual(shown['movers'][0].pose.position.z, 3 - 2.5 * row.t, delta=1e-6)

    def test_the_robot_and_what_moves_beside_it_are_shown_at_one_moment(self):
        """At the first one: of hulls no distance is measured."""
        self.server.replace(self.fall())
        drawings = Drawings()
        row = self.row(self.server.distance([], trajectory=swing(-0.8, 0.8)))
        self.assertTrue(row.upper == math.inf and row.t > 0.0, (row.upper, row.t))
        shown = drawings.shown(lambda s: True, 'movers', 'robot')
        self.assertAlmostEqual(shown['movers'][0].pose.position.z, 3, delta=1e-6)
        self.assertLess(min(abs(m.pose.orientation.z - math.sin(-0.4)) for m in shown['robot']), 1e-6)

    def test_the_scene_keeps_what_moves(self):
        state = self.server.replace(self.fall(start=rospy.Time(1234, 567), turning='screw')).scene
        self.assertEqual(state.objects, 1)
        kept, = self.server.scene('box').objects
        self.assertEqual((kept.trajectory.start, kept.trajectory.turning), (rospy.Time(1234, 567), 'screw'))
        self.assertEqual([w.time for w in kept.trajectory.waypoints], [0.0, 0.8])
        self.assertAlmostEqual(kept.trajectory.waypoints[1].pose.orientation.x, math.sin(math.radians(60)), delta=1e-15)
        again = self.server.replace(*self.server.scene().objects)
        self.assertEqual(again.scene.objects, 1)
        self.assertTrue(self.server.apply(CollisionObject(id='box', operation=CollisionObject.REMOVE)).success)
        self.assertEqual(len(self.server.scene().objects), 0)

    def least(self, *things):
        """The least distance between the two things, which both move."""
        self.server.replace(*things)
        response = self.succeeded(self.server.distance([], movers=True, self_collision=True))
        row, = [row for row in response.results if {row.a, row.b} == {'a', 'b'}]
        return row

    def test_starts_are_known_to_a_tolerance(self):
        """Two balls cross at a right angle, one of them a second after the other: so late by s they come within |1 + s| / sqrt 2."""
        a = moving(sphere('a', 0.1), waypoint(0, (-1, 0, 3)), waypoint(2, (1, 0, 3)))

        def b(**fields):
            return moving(sphere('b', 0.1), waypoint(1, (0, -1, 3)), waypoint(3, (0, 1, 3)), **fields)
        for tolerance, expected in ((0.0, 1.0), (0.25, 0.75), (0.5, 0.5)):
            row = self.least(a, b(start_tolerance=tolerance))
            self.assertHolds(row.lower, row.upper, expected / math.sqrt(2) - 0.2, 1.01e-6)
        self.assertEqual(self.least(a, b(any_time=True)).upper, 0.0)
        kept, = self.server.scene('b').objects
        self.assertTrue(kept.trajectory.any_time)
        self.assertRefused(self.server.apply(b(start_tolerance=-1.0)), "object 'b'", 'start_tolerance')

    def test_a_body_rides_a_path(self):
        """A box of .2 x .2 x .6 past a ball of .25: upright, and turned so that its length points at the ball."""
        self.server.replace(sphere('ball', 0.25, (0, 3, 3)))
        carried = box('carried', (0.2, 0.2, 0.6))
        lying = (0, math.sqrt(0.5), 0, math.sqrt(0.5))  # its z axis is x
        for orientation, half in (((0, 0, 0, 1), 0.3), (lying, 0.1)):
            way = path((-1, 3, 4), (1, 3, 4), frame='world', orientations=[orientation] * 2)
            row = self.row(self.server.distance([], paths=[way], body=carried, objects=['ball']))
            self.assertEqual((row.kind, row.a, row.b), ('movers', 'carried', 'ball'))
            self.assertHolds(row.lower, row.upper, 1.0 - half - 0.25, 1.01e-6)
        self.assertRefused(self.server.distance(bezier((0, 0, 0), (1, 0, 0)), body=carried), 'body applies to paths')
        file = 'package://curve_proximity/test/data/robots/panda/meshes/link7.stl'
        for resource, found in ((file, True), (file + 'x', False)):
            mesh = CollisionObject(id='mesh', bodies=[Body(type='mesh', resource=resource)])
            response = self.server.distance([], paths=[way], body=mesh, objects=['ball'])
            self.assertEqual(response.success, found, response.message)

    def test_a_body_on_a_path_of_one_pose_is_measured_against_what_stands_and_moves_at_all_times(self):
        way = path((0, 3, 4), frame='world', orientations=[turned(0)])
        falling = moving(sphere('falling', 0.1), waypoint(0, (0, 3, 8)), waypoint(9, (0, 3, 5)))
        for things, b, expected in (((sphere('ball', 0.25, (0, 3, 3)), falling), 'ball', 0.45),
                                    ((sphere('ball', 0.25, (0, 3, 2)), falling), 'falling', 0.6)):
            self.server.replace(*things)
            row = self.row(self.server.distance([], paths=[way], body=box('carried', (0.2, 0.2, 0.6))))
            self.assertEqual((row.a, row.b), ('carried', b))
            self.assertAlmostEqual(row.upper, expected, delta=2e-6)

    def hold(self, link, at):
        """A ball of .1 that the link carries, at a place in its frame."""
        tool = AttachedCollisionObject(link_name=link, object=sphere('tool', 0.1, at, frame=link))
        self.succeeded(self.server.apply(attached_collision_objects=[tool]))

    def assertDistance(self, response, a, expected):
        row = self.row(response)
        self.assertEqual((row.a, row.b), (a, 'ball'))
        self.assertHolds(row.lower, row.upper, expected, 1.01e-6, 1e-9)
        return row

    def test_what_a_link_carries_rides_a_path(self):
        """A tool .4 ahead of its link: the path is the link's, and lets the tool point to and fro."""
        self.server.replace(sphere('ball', 0.25, (0, 3, 3)))
        self.hold('panda_hand', (0, 0, 0.4))
        for orientation, height in (((0, 0, 0, 1), 1.4), ((1, 0, 0, 0), 0.6)):
            way = path((-1, 3, 4), (1, 3, 4), frame='world', orientations=[orientation] * 2)
            row = self.assertDistance(self.server.distance([], paths=[way], body=CollisionObject(id='tool'), objects=['ball']), 'tool',
                                      height - 0.25 - 0.1)
            self.assertEqual((row.kind, row.id), ('movers', 'path'))
        self.server.apply(link_padding=[LinkPadding('panda_hand', 0.05)])
        self.assertDistance(self.server.distance([], paths=[way], body=CollisionObject(id='tool'), objects=['ball']), 'tool', 0.2)
        self.assertRefused(self.server.distance([], paths=[way], body=CollisionObject(id='took')), "no link carries an object 'took'", "'tool'")

    def test_what_a_link_carries_rides_a_floating_base(self):
        """The base turns by 120 degrees about z: the tool, 2 m ahead of it, comes over the ball on the way, and goes on."""
        self.server.replace(sphere('ball', 0.25, (math.sqrt(3), 1, 2)))
        self.hold('panda_link0', (2, 0, 0))
        flight = free_flight('virtual_joint', (0, 0, 3), (0, 0, 3), orientations=(turned(0), turned(math.radians(120))))
        asked = dict(multi_dof_trajectories=[flight], joint_state=joints(**READY), objects=['ball'])
        row = self.assertDistance(self.server.distance([], **asked), 'tool', 1 - 0.25 - 0.1)
        self.assertEqual(row.kind, 'environment')
        self.assertTrue(0.2 < row.t < 0.35, row.t)  # after 30 of 120 degrees

    def test_a_body_rides_what_comes_by_topic(self):
        """~path_body, a ball of .1 that is .5 above its origin: upside down along a path, and while it turns over on the spot."""
        received = heard('/curve_proximity/proximity', ProximityResults)
        self.server.replace(sphere('ball', 0.25, (0, 3, 3)))
        way = path((-1, 3, 4), (1, 3, 4), frame='world', orientations=[(1, 0, 0, 0)] * 2)
        flight = free_flight('drone', (0, 3, 4), (0, 3, 4), orientations=[turned(math.radians(angle), (1, 0, 0)) for angle in (100, 240)])
        for topic, message, name in (('path', way, 'path'), ('multi_dof_trajectory', flight, 'drone')):
            del received[:]
            self.publisher('/curve_proximity/' + topic, type(message)).publish(message)
            self.assertTrue(until(lambda: received, 10))
            row = self.assertDistance(received[0], 'lamp', 1 - 0.5 - 0.1 - 0.25)
            self.assertEqual((row.kind, row.id), ('movers', name))
            field = 'paths' if topic == 'path' else 'multi_dof_trajectories'
            self.assertDistance(self.server.distance([], **{field: [message]}), 'lamp', 1 - 0.5 - 0.1 - 0.25)

    def test_stamps_of_poses_put_a_body_on_the_clock_of_what_moves(self):
        """It and the ball go past each other half way, at 1003 s; by the stamp of the header a quarter of a metre later."""
        self.server.replace(moving(sphere('ball', 0.25), waypoint(1, (1, 3, 5)), waypoint(5, (-1, 3, 5)), start=rospy.Time(1000)))
        way = path((-1, 3, 4), (1, 3, 4), frame='world', orientations=[turned(0)] * 2)
        way.header.stamp = rospy.Time(1000)
        for at, stamp in zip(way.poses, (1001, 1005)):
            at.header.stamp = rospy.Time(stamp)
        row = self.assertDistance(self.server.distance([], paths=[way], body=sphere('pea', 0.1)), 'pea', 1 - 0.25 - 0.1)
        self.assertAlmostEqual(row.witness_a.x, 0.0, delta=1e-2)
        for at in way.poses:
            at.header.stamp = rospy.Time(0)
        way.poses[1].header.stamp = rospy.Time(4)
        row = self.assertDistance(self.server.distance([], paths=[way], body=sphere('pea', 0.1)), 'pea', 1 - 0.25 - 0.1)
        self.assertAlmostEqual(row.witness_a.x, 0.25, delta=1e-2)  # the header's, where the first pose has none

    def test_a_body_along_a_path_is_shown_where_it_comes_closest(self):
        """A crank with a knob at its end turns from 0 to 90 degrees: the ball is 2 m away, in the direction of 30 degrees."""
        direction = math.radians(30)
        self.server.replace(sphere('ball', 0.25, (2 * math.cos(direction), 3 + 2 * math.sin(direction), 4)))
        crank = box('crank', (0.2, 0.1, 0.1), primitive_poses=[pose(), pose((0.5, 0, 0))])
        crank.primitives += sphere('knob', 0.1).primitives
        way = path((0, 3, 4), (0, 3, 4), frame='world', orientations=[turned(0), turned(math.radians(90))])
        drawings = Drawings()
        # the scene is another one than in earlier drawings
        self.assertTrue(until(lambda: drawings.arrays and 'movers' not in {m.ns for m in drawings.arrays[-1].markers}, 10))
        row = self.row(self.server.distance([], paths=[way], body=crank, objects=['ball']))
        markers = drawings.shown(lambda s: True, 'movers')['movers']
        self.assertAlmostEqual(row.upper, 2 - 0.5 - 0.1 - 0.25, delta=2e-6)
        self.assertAlmostEqual(row.t, 1 / 3, delta=3e-3)
        self.assertIn('its stamps are all the same: t counts its poses', row.message)
        drawn = {m.type: m for m in markers}
        self.assertEqual((len(markers), set(drawn)), (2, {Marker.CUBE, Marker.SPHERE}))
        angle = row.t * math.radians(90)
        for marker, (x, y) in ((drawn[Marker.CUBE], (0, 3)), (drawn[Marker.SPHERE], (0.5 * math.cos(angle), 3 + 0.5 * math.sin(angle)))):
            at = marker.pose.position
            for told, true in ((at.x, x), (at.y, y), (at.z, 4)):
                self.assertAlmostEqual(told, true, delta=1e-9)
        turn = drawn[Marker.CUBE].pose.orientation
        self.assertAlmostEqual(abs(turn.z), math.sin(angle / 2), delta=1e-9)
        self.assertAlmostEqual(abs(turn.w), math.cos(angle / 2), delta=1e-9)

    def test_stamps_that_do_not_overlap_are_refused_by_how_much(self):
        ball = moving(sphere('ball', 0.1), waypoint(0, (2, 2, 0.5)), waypoint(1, (2, 3, 0.5)), start=rospy.Time(990))
        self.server.replace(ball)
        ask = self.server.distance
        self.assertRefused(ask([], trajectory=swing(-0.8, 0.8, stamp=1000.0)), "object 'ball'", 'stale: it ends 9 s before')
        self.assertRefused(ask([], trajectory=swing(-0.8, 0.8, stamp=900.0)), "object 'ball'", 'it begins 88 s after')
        self.assertTrue(ask([], trajectory=swing(-0.8, 0.8, stamp=990.5)).success)
        self.server.replace()
        late = other(swing(-0.8, 0.8, stamp=1002.5))
        self.assertRefused(ask([], trajectory=swing(-0.8, 0.8, stamp=1000.0), moving_robots=[late]), "robot 'right'", 'it begins 0.5 s after')

    def test_bad_movers_are_refused_by_name(self):
        half_turn = moving(sphere('ball', 0.1), waypoint(0, (0, 0, 0)), waypoint(1, (0, 0, 1), (0, 0, 1, 0)))
        for thing, because in ((moving(sphere('ball', 0.1), waypoint(1, (0, 0, 0)), waypoint(1, (0, 0, 1))), 'waypoint 1 at 1 s'),
                               (moving(sphere('ball', 0.1), waypoint(0, (0, 0, 0)), waypoint(1, (0, 0, 1), (0, 0, 0, 0))), 'waypoint 1: '),
                               (moving(sphere('ball', 0.1), waypoint(math.nan, (0, 0, 0))), 'waypoint 0: the time is not finite'),
                               (moving(sphere('ball', 0.1, (0, 0, 1)), waypoint(0, (0, 0, 0))), 'a pose and a trajectory'),
                               (moving(sphere('ball', 0.1), waypoint(0, (0, 0, 0)), turning='fast'), "'fast' is none of slerp, screw"),
                               (half_turn, 'half a turn')):
            response = self.server.apply(thing)
            self.assertRefused(response, "object 'ball'", because)
        self.assertEqual(len(self.server.scene().objects), 0)
        ask = lambda *robots: self.server.distance([], trajectory=swing(-0.8, 0.8), moving_robots=list(robots))
        self.assertRefused(ask(other(swing(-0.8, 0.8), robot='otter')), "there is no 'otter' in ~robots", "'other'")
        self.assertRefused(ask(other(swing(-0.8, 0.8)), other(swing(-0.8, 0.8))), "two movers are named 'right'")
        self.assertRefused(ask(other(swing(-0.8, 0.8), name='panda')), "two movers are named 'panda'")
        self.assertRefused(ask(other(swing(-0.8, 0.8), name='a/b')), "it contains '/'")
        self.assertRefused(ask(other(JointTrajectory(joint_names=['elbow'], points=[JointTrajectoryPoint(positions=[0])]))), "robot 'right'", 'elbow')

    def test_clearance_over_time_beside_another_panda(self):
        beside = dict(trajectory=swing(-0.8, 0.8, stamp=1000.0), moving_robots=[other(swing(-0.8, 0.8, stamp=1000.75))])
        self.server.replace(moving(sphere('ball', 0.1), waypoint(0, (0.4, 2, 0.5)), waypoint(2, (0.4, 1, 0.5))), box('table', (1, 1, 0.1), (0, 3, 0)))
        whole, = self.server.distance([], **beside).results
        self.assertEqual(whole.b.split('/')[0], 'right')

        profile, = self.server.ask('clearance_profile', query=query(**beside), intervals=8).profiles
        self.assertAlmostEqual(min(profile.lower), whole.lower, delta=2e-6)
        self.assertEqual((profile.t0[0], profile.t1[-1], profile.summary.b), (0.0, 2.0, whole.b))
        for i in range(8):
            a, b = profile.witness_a[i], profile.witness_b[i]
            self.assertAlmostEqual(math.dist((a.x, a.y, a.z), (b.x, b.y, b.z)), profile.lower[i], delta=3e-6)
        links = self.server.ask('clearance_profile', query=query(**beside), intervals=4, per_link=True).profiles
        self.assertIn('panda_hand', [one.link for one in links])
        self.assertAlmostEqual(min(min(one.lower) for one in links), whole.lower, delta=2e-6)

        rows = self.server.distance([], per_object=True, **beside).results
        self.assertEqual([row.b.split('/')[0] for row in rows], ['table', 'ball', 'right'])
        self.assertAlmostEqual(rows[2].upper, whole.upper, delta=2e-6)
        row, = self.server.distance([], trajectory=swing(-0.8, 0.8, stamp=1000.0), objects=['ball']).results
        self.assertEqual((row.b, round(row.upper, 5)), ('ball', round(rows[1].upper, 5)))

        pairs = self.server.ask('nearest_pairs', query=query(**beside), count=5).results
        self.assertEqual(len(pairs), 5)
        self.assertEqual((pairs[0].a, pairs[0].b), (whole.a, whole.b))
        self.assertAlmostEqual(pairs[0].upper, whole.upper, delta=2e-6)
        self.assertEqual([row.upper for row in pairs], sorted(row.upper for row in pairs))

    @staticmethod
    def many(count):
        return [moving(sphere('ball%d' % i, 0.1), waypoint(0.001 * i, (i, 2, 0.5)), waypoint(2 + 0.001 * i, (i, 3, 0.5))) for i in range(count)]

    def test_what_takes_too_much_memory_is_refused(self):
        self.server.replace(*self.many(200))
        self.assertTrue(self.server.distance([], movers=True).success)
        self.assertTrue(self.server.distance([], trajectory=swing(-0.8, 0.8)).success)
        long = moving(sphere('long', 0.1), *[waypoint(0.001 * i, (0.001 * i, 2, 0.5)) for i in range(20000)])
        self.server.replace(long)
        self.assertRefused(self.server.distance([], movers=True), 'too large', '~max_request_mb')
        self.assertRefused(self.server.distance([], trajectory=swing(-0.8, 0.8)), 'too large')

    def test_a_budget_ends_the_joining_of_many(self):
        self.server.replace(*self.many(100))
        self.assertRefused(self.server.distance([], movers=True, budget_ms=1e-6), 'stopped while the movers were being joined')
        self.assertTrue(self.server.distance([], movers=True, budget_ms=60000).success)

    def test_what_does_not_know_movers_says_so(self):
        self.server.replace(moving(sphere('ball', 0.1), waypoint(0, (2, 2, 0.5)), waypoint(1, (2, 3, 0.5))), box('table', (1, 1, 0.1), (3, 0, 0)))
        moves = "object 'ball' moves along a trajectory"
        line = bezier((0, 0, 2), (1, 0, 2))
        self.assertRefused(self.server.distance(line, joint_state=joints(**READY)), moves)
        self.assertTrue(self.server.distance(line, objects=['table'], joint_state=joints(**READY)).success)
        self.assertRefused(self.server.distance([], movers=True, gradient=True), 'gradients among what moves are by a trajectory')
        self.assertRefused(self.server.distance(line, moving_robots=[other(swing(0, 1))]), 'moving_robots')
        self.assertTrue(self.server.distance([], robot_state=True, joint_state=joints(**READY)).success)
        self.assertRefused(self.server.apply(CollisionObject(id='ball', operation=CollisionObject.MOVE, pose=pose())), 'it moves along a trajectory')


if __name__ == '__main__':
    run('movers')
