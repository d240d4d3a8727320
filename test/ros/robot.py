#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Frames and links: what tf2 and joint states say of where things are, and what is told where they say nothing."""
import math
import time

import rospy
import tf2_ros
from curve_proximity.msg import AttachedCollisionObject, CollisionObject, LinkPadding, LinkScale
from helpers import Case, Server, bezier, box, joints, run, sphere, transform, until
from sensor_msgs.msg import JointState

EPSILON = 1e-9  # [m]


def vertical(x, y, **fields):
    """A vertical line from 0.4 to 0.6 m."""
    return bezier((x, y, 0.4), (x, y, 0.6), **fields)


class Robot(Case):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        cls.fixed = tf2_ros.StaticTransformBroadcaster()
        cls.moving = tf2_ros.TransformBroadcaster()

    def setUp(self):
        self.server.replace()

    def place(self, broadcaster, transforms):
        """Once the server has heard of them: what nobody has published is refused without a wait."""
        broadcaster.sendTransform(transforms)
        for placed in transforms if isinstance(transforms, list) else [transforms]:
            def unheard():
                message = self.server.distance(bezier((0, 0, 50), (0, 0, 51), frame=placed.child_frame_id)).message
                return "frame '%s'" % placed.child_frame_id in message and 'nobody has published' in message
            self.assertTrue(until(lambda: not unheard(), 10), placed.child_frame_id)

    def assertDistance(self, response, expected, link=None):
        row = self.succeeded(response).results[0]
        self.assertHolds(row.lower, row.upper, expected)
        if link:
            self.assertEqual(row.b, link)

    def test_01_links_without_a_transform_are_an_error_that_names_both_frames(self):
        # nothing has said yet where the arm is: it must not read as absent
        begin = time.monotonic()
        response = self.server.distance([vertical(1, 0)] * 50)
        self.assertLess(time.monotonic() - begin, 1.5, 'all curves of a request share one timeout')
        self.assertRefused(response, "'world'", '50 of 50')
        self.assertRegex(response.message, "'(base|arm|slider)'")
        # with joints the root link alone needs one
        self.assertIn("'base'", self.server.distance(vertical(1, 0), joint_state=joints(turn=0.0)).message)

    def test_02_objects_alone_need_no_robot(self):
        self.server.replace(sphere('ball', 0.25, (1, 0, 0.5)))
        self.assertDistance(self.server.distance(vertical(2, 0), objects=['ball']), 0.75, 'ball')

    def test_03_joint_states_place_the_links_and_tf2_the_root(self):
        self.place(self.fixed, [transform('world', 'base', (10, 0, 0))])
        self.assertDistance(self.server.distance(vertical(12, 0), joint_state=joints(turn=0.0)), 1.4, 'arm')
        # a quarter turn: the ball stands at (10, 0.5); the mimic joint takes the slider along to x = 10 + pi/2
        quarter = joints(turn=math.pi / 2)
        self.assertDistance(self.server.distance(vertical(10, 2), joint_state=quarter), 1.4, 'arm')
        low = bezier((10 + math.pi / 2, 0, -2), (10 + math.pi / 2, 0, -1))
        self.assertDistance(self.server.distance(low, joint_state=quarter), 0.45, 'slider')
        self.assertDistance(self.server.distance(vertical(12, 0), joint_state=quarter, links=['base']),
                            math.hypot(1.9, 0.3), 'base')

    def test_04_wrong_joint_states_are_refused_by_name(self):
        cases = [(joints(wrist=0.0), "'wrist'"), (joints(turn=math.nan), "'turn'"),
                 (JointState(name=['turn', 'turn'], position=[0, 0]), "'turn'"),
                 (JointState(name=['turn'], position=[]), '1 names and 0 positions')]
        for state, word in cases:
            self.assertRefused(self.server.distance(vertical(12, 0), joint_state=state), word)

    def test_05_unknown_links_are_refused_by_name(self):
        self.assertRefused(self.server.distance(vertical(12, 0), joint_state=joints(turn=0.0), links=['tail']), "'tail'")

    def test_06_link_padding_counts_and_is_kept(self):
        self.assertTrue(self.server.apply(link_padding=[LinkPadding('arm', 0.25)]).success)
        self.assertDistance(self.server.distance(vertical(12, 0), joint_state=joints(turn=0.0)), 1.15, 'arm')
        self.assertEqual([(p.link_name, p.padding) for p in self.server.scene().link_padding], [('arm', 0.25)])
        self.assertFalse(self.server.apply(link_padding=[LinkPadding('arm', -0.25)]).success)

    def test_07_per_object_rows_are_for_objects_and_links(self):
        self.server.replace(box('crate', (1, 1, 1), (14, 0, 0.5)))
        response = self.succeeded(self.server.distance(vertical(12, 0), joint_state=joints(turn=0.0), per_object=True))
        self.assertEqual(sorted(r.b for r in response.results), ['arm', 'base', 'crate', 'slider'])

    def test_08_tf2_and_joint_states_agree(self):
        self.place(self.fixed, [transform('world', 'base', (10, 0, 0)),
                                  transform('base', 'arm', (0, 0, 0.5), turn=0.7),
                                  transform('base', 'slider', (0.7, 0, -0.5))])
        lines = [vertical(10 + 2 * math.cos(a), 2 * math.sin(a)) for a in (0.0, 0.7, 2.0, 4.0)]
        by_joints = self.server.distance(lines, joint_state=joints(turn=0.7), per_object=True, epsilon=EPSILON)
        by_tf2 = self.server.distance(lines, per_object=True, epsilon=EPSILON)
        self.assertTrue(by_joints.success and by_tf2.success, by_tf2.message)
        self.assertEqual(len(by_joints.results), 12)
        for a, b in zip(by_joints.results, by_tf2.results):
            self.assertEqual(a.b, b.b)
            self.assertLess(abs(a.upper - b.upper), 2 * EPSILON)

    def test_09_curves_and_objects_come_from_their_frames(self):
        # both two metres up, one metre apart
        self.server.replace(sphere('ball', 0.25, (0, 0, 0), frame='shelf'))
        self.assertDistance(self.server.distance(bezier((1, -1, 0), (1, 1, 0), frame='shelf'), objects=['ball']), 0.75)
        self.assertDistance(self.server.distance(bezier((1, -1, 2), (1, 1, 2)), objects=['ball']), 0.75)
        self.assertEqual(self.server.scene().objects[0].pose.position.z, 2.0)
        self.assertEqual(self.server.scene().objects[0].header.frame_id, 'world')

    def test_10_the_stamp_picks_the_transform(self):
        now = rospy.Time.now()
        earlier = now - rospy.Duration(2)
        self.server.replace(sphere('ball', 0.25))
        for stamp, x in ((earlier - rospy.Duration(1), 3.0), (earlier, 3.0), (now, 5.0)):
            self.place(self.moving, transform('world', 'cart', (x, 0, 0), stamp))
            rospy.sleep(0.05)
        for stamp, x in ((earlier, 3.0), (now, 5.0), (earlier + rospy.Duration(1), 4.0), (rospy.Time(), 5.0)):
            line = bezier((0, -1, 0), (0, 1, 0), frame='cart', stamp=stamp)
            self.assertDistance(self.server.distance(line, objects=['ball']), x - 0.25)
        # two stamps of one frame in one request
        both = [bezier((0, -1, 0), (0, 1, 0), frame='cart', stamp=stamp) for stamp in (earlier, now)]
        rows = self.server.distance(both, objects=['ball']).results
        self.assertEqual([round(row.upper, 4) for row in rows], [2.75, 4.75])
        late = bezier((0, -1, 0), (0, 1, 0), frame='cart', stamp=now + rospy.Duration(100))
        response = self.server.distance([late, vertical(1, 0)], objects=['ball'])
        self.assertFalse(response.success)
        self.assertIn("'cart'", response.results[0].message)
        self.assertIn("'world'", response.results[0].message)
        self.assertEqual(response.results[1].status, 'ok')

    def test_11_what_a_link_carries_moves_with_it_and_is_put_down_where_it_is(self):
        held = AttachedCollisionObject(link_name='arm', object=sphere('held', 0.1, (1, 0, 0), frame='arm'))
        self.server.replace(attached_collision_objects=[held])
        self.assertDistance(self.server.distance(vertical(12, 0), joint_state=joints(turn=0.0)), 0.9, 'held')
        self.assertDistance(self.server.distance(vertical(10 + 2 * math.cos(0.7), 2 * math.sin(0.7))), 0.9, 'held')
        self.assertTrue(self.server.apply(link_scale=[LinkScale('arm', 2.0)]).success)
        self.assertDistance(self.server.distance(vertical(12, 0), joint_state=joints(turn=0.0)), 0.8, 'held')
        scene = self.server.scene()
        self.assertEqual([(o.link_name, o.object.id) for o in scene.attached_collision_objects], [('arm', 'held')])
        self.assertEqual([(s.link_name, s.scale) for s in scene.link_scale], [('arm', 2.0)])

        # put down where tf2 has the arm, at its own size
        down = AttachedCollisionObject(object=CollisionObject(id='held', operation=CollisionObject.REMOVE))
        self.assertTrue(self.server.apply(attached_collision_objects=[down]).success)
        scene = self.server.scene()
        self.assertEqual(scene.attached_collision_objects, [])
        self.assertAlmostEqual(scene.objects[0].pose.position.x, 10 + math.cos(0.7), places=9)
        self.assertDistance(self.server.distance(vertical(10 + 2 * math.cos(0.7), 2 * math.sin(0.7)), objects=['held']), 0.9)
        self.assertIn("'tail'", self.server.apply(attached_collision_objects=[
            AttachedCollisionObject(link_name='tail', object=sphere('b', 0.1, (1, 0, 0), frame='tail'))]).message)


if __name__ == '__main__':
    run('robot')
