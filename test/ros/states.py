#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Questions that a user begins with: the robot as it stands, a group of its links, trajectories as planners make them, what
a hand carries without tf2; and what a wrong name is answered with."""
import math
import time

import rospy
from curve_proximity.msg import (AllowedContact, AttachedCollisionObject, Body, CollisionObject, Octree, Proximity, ProximityResults)
from helpers import Case, Node, Server, bezier, connected, heard, joint_trajectory, joints, run, sphere, thing, until
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

# A chain in the plane: two arms of a metre, turning about z, a ball at the end of each.
CHAIN = '''<robot name="chain">
  <link name="base"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="one" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-7" upper="7" effort="1" velocity="1"/></joint>
  <link name="upper"><collision><origin xyz="1 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="two" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-7" upper="7" effort="1" velocity="1"/></joint>
  <link name="lower"><collision><origin xyz="1 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
</robot>'''
SRDF = '''<robot name="chain"><virtual_joint name="ground" type="fixed" parent_frame="world" child_link="base"/>
  <group name="end"><link name="lower"/></group>
  <group name="all"><chain base_link="base" tip_link="upper"/><group name="end"/></group>
  <disable_collisions link1="base" link2="ghost" reason="Never"/></robot>'''


def trajectory(*rows, times=None):
    return joint_trajectory(['one', 'two'], *rows, times=times or [0.0] * len(rows))


class States(Case):
    @classmethod
    def setUpClass(cls):
        rospy.set_param('/robot_description', CHAIN)
        rospy.set_param('/robot_description_semantic', SRDF)
        cls.node = Node('chain', tf_timeout=0.3, state_rate=50.0, query_type='distance')
        cls.server = Server('/chain')
        cls.states = rospy.Publisher('/chain/joint_states', JointState, queue_size=5)
        assert connected(cls.states)
        time.sleep(3.2)  # by then the virtual joint counts without a wait for tf2

    @classmethod
    def tearDownClass(cls):
        cls.node.end()
        rospy.delete_param('/robot_description')
        rospy.delete_param('/robot_description_semantic')

    def setUp(self):
        self.server.replace(sphere('ball', 0.2, (2, 1, 0)))

    def rows(self, response):
        return {row.kind: row for row in self.succeeded(response).results}

    def test_the_robot_as_it_stands_in_the_scene_and_against_itself(self):
        rows = self.rows(self.server.distance([], robot_state=True, self_collision=True, joint_state=joints(one=0.0, two=0.0)))
        self.assertEqual((rows['environment'].id, rows['environment'].b, rows['environment'].a), ('state', 'ball', 'lower'))
        self.assertAlmostEqual(rows['environment'].upper, 1 - 0.3, delta=2e-6)
        self.assertAlmostEqual(rows['environment'].lower, 1 - 0.3, delta=2e-6)
        # base and lower are related by two joints, neighbours are not
        self.assertEqual({rows['self'].a, rows['self'].b}, {'base', 'lower'})
        self.assertAlmostEqual(rows['self'].upper, 2 - 0.2, delta=2e-6)
        folded = joints(one=0.3, two=math.pi)
        rows = self.rows(self.server.collision([], robot_state=True, self_collision=True, joint_state=folded))
        self.assertEqual((rows['self'].verdict, rows['environment'].verdict), ('violated', 'clear'))

    def test_a_trajectory_of_one_point_is_the_same_question(self):
        for pose in ((0.0, 0.0), (0.7, -0.4)):
            state = self.server.distance([], robot_state=True, self_collision=True, joint_state=joints(one=pose[0], two=pose[1]))
            point = self.server.distance([], trajectory=trajectory(pose), self_collision=True)
            rows, others = ([(r.kind, r.a, r.b, r.lower, r.upper) for r in answer.results] for answer in (state, point))
            self.assertEqual((len(rows), rows), (2, others))

    def test_the_current_joint_states_are_a_state_too_and_are_watched(self):
        self.states.publish(joints(one=0.0, two=0.0))

        def upper():  # NaN until the first joint states have come
            response = self.server.distance([], robot_state=True)
            return response.results[0].upper if response.success else math.nan
        self.assertTrue(until(lambda: abs(upper() - 0.7) < 1e-5, 20))
        results = heard('/chain/state_proximity', ProximityResults)
        self.assertTrue(until(lambda: results and results[-1].source == 'state' and abs(results[-1].results[0].upper - 0.7) < 1e-5, 20))
        self.assertEqual([row.kind for row in results[-1].results], ['environment', 'self'])
        self.states.publish(joints(two=math.pi / 2))  # lower's ball goes to (1, 1, 0)
        self.assertTrue(until(lambda: abs(upper() - (1 - 0.3)) < 1e-5, 20))
        self.assertTrue(until(lambda: results[-1].results[1].upper < 1.3, 20))  # self: sqrt(2) - 0.2
        line = bezier((2, 0.5, 0), (2, 0.6, 0))
        row, = self.server.distance(line, links=['lower'], current_joints=True).results
        self.assertAlmostEqual(row.upper, math.hypot(1, 0.4) - 0.1, delta=2e-6)
        self.assertAlmostEqual(self.server.distance([], robot_state=True, joint_state=joints(two=0.0)).results[0].upper, 0.7, delta=2e-6)

    def test_groups_and_links_narrow_the_question(self):
        self.server.replace(sphere('ball', 0.2, (1, 1, 0)))
        path = trajectory((0.0, 0.0), (0.2, 0.1))
        whole = self.rows(self.server.distance([], trajectory=path))['environment']
        self.assertEqual(whole.a, 'upper')
        end = self.rows(self.server.distance([], trajectory=path, group='end'))['environment']
        named = self.rows(self.server.distance([], trajectory=path, links=['lower']))['environment']
        self.assertEqual((end.a, end.upper, end.lower), ('lower', named.upper, named.lower))
        self.assertGreater(end.lower, whole.upper)
        everything = self.rows(self.server.distance([], trajectory=path, group='all'))['environment']
        self.assertEqual((everything.a, everything.upper), ('upper', whole.upper))
        # of a curve, the links of the group are what it is measured against
        row, = self.server.distance(bezier((2, 0, 1), (2, 0, 2)), group='end', joint_state=joints(one=0.0)).results
        self.assertEqual(row.b, 'lower')
        for fields, word in ((dict(group='ends'), "'end'"), (dict(links=['louer']), "'lower'")):
            self.assertRefused(self.server.distance([], trajectory=path, **fields), 'did you mean ' + word)

    def test_trajectories_without_times_and_with_repeated_points(self):
        rows = ((0.0, 0.0), (0.1, 0.3), (0.4, 0.1))
        timed = self.rows(self.server.distance([], trajectory=trajectory(*rows, times=[0, 1, 2])))['environment']
        untimed = self.rows(self.server.distance([], trajectory=trajectory(*rows)))['environment']
        self.assertEqual((timed.lower, timed.upper, timed.t), (untimed.lower, untimed.upper, untimed.t))
        self.assertIn('times are all 0', untimed.message)
        self.assertEqual(timed.message, '')
        repeated = trajectory(*(rows[:1] + rows[:2] + rows[1:]), times=[0, 0, 1, 1, 2])
        again = self.rows(self.server.distance([], trajectory=repeated))['environment']
        self.assertEqual((timed.lower, timed.upper, timed.t), (again.lower, again.upper, again.t))
        jump = trajectory(rows[0], rows[1], rows[2], times=[0, 1, 1])
        self.assertFalse(self.server.distance([], trajectory=jump).success)

    def test_the_way_from_the_present_state_counts(self):
        """The trajectory begins at one second, on the far side of a ball that only the way there meets."""
        self.server.replace(sphere('ball', 0.2, (2, 0, 0)))
        path = trajectory((1.5, 0.0), (1.6, 0.0), times=[1, 2])
        for position, verdict in ((1.5, 'clear'), (-1.5, 'violated')):
            answer = self.server.collision([], trajectory=path, joint_state=joints(one=position, two=0.0))
            self.assertEqual(self.rows(answer)['environment'].verdict, verdict)

    def test_contacts_are_allowed_by_pair_and_by_default(self):
        """What a pair says counts, else both defaults must agree. All that it can mean: scene.test_allowed."""
        path = trajectory((0.0, 0.0), (0.1, 0.0))
        links = ('base', 'upper', 'lower')
        pairs, defaults = [AllowedContact(link, 'ball', True) for link in links], [AllowedContact(link, '', True) for link in links]
        for contacts, b in (([], 'ball'), (pairs, ''), (defaults, ''), (defaults + [AllowedContact('ball', '', False)], 'ball'),
                            (pairs + [AllowedContact('ball', '', False)], '')):
            self.server.replace(sphere('ball', 0.2, (2, 1, 0)), allowed_contacts=contacts)
            row = self.rows(self.server.distance([], trajectory=path, objects=['ball']))['environment']
            self.assertEqual(row.b, b)

    def test_what_is_wrong_with_a_trajectory_is_told(self):
        elbow = trajectory((0.0, 0.0), (0.1, 0.0))
        elbow.joint_names = ['one', 'elbow']
        for bad, word in ((elbow, "'elbow'"), (trajectory((0.0, 0.0), times=[1]), 'one point'), (trajectory((0.0, 0.0), (0.1,)), 'point 1'),
                          (trajectory((0.0, math.nan), (0.1, 0.0)), 'not finite'), (JointTrajectory(points=elbow.points), 'no joints')):
            self.assertRefused(self.server.distance([], trajectory=bad), word)

    def test_a_failed_trajectory_has_rows_of_its_kinds(self):
        response = self.server.distance([], trajectory=trajectory((0.0, math.nan)), self_collision=True)
        self.assertFalse(response.success)
        self.assertEqual([(row.kind, row.status) for row in response.results],
                         [(Proximity.KIND_ENVIRONMENT, Proximity.STATUS_INVALID), (Proximity.KIND_SELF, Proximity.STATUS_INVALID)])

    def test_attaching_and_detaching_need_no_tf_where_joints_are_given(self):
        tool = AttachedCollisionObject(link_name='lower', object=sphere('tool', 0.1, (1, 0, 0), frame='upper'))
        here = joints(one=0.0, two=math.pi / 2)
        self.succeeded(self.server.apply(attached_collision_objects=[tool], joint_state=here))
        off = AttachedCollisionObject(object=CollisionObject(id='tool', operation=CollisionObject.REMOVE))
        self.succeeded(self.server.apply(attached_collision_objects=[off], joint_state=joints(one=math.pi / 2, two=math.pi / 2)))
        tool, = self.server.scene('tool').objects
        self.assertAlmostEqual(tool.pose.position.y, 1.0, delta=1e-9)  # where lower begins, as it was given
        self.assertAlmostEqual(tool.pose.position.x, 0.0, delta=1e-9)
        begin = time.monotonic()
        wrong = AttachedCollisionObject(link_name='Lower', object=sphere('tool', 0.1, frame='upper'))
        response = self.server.apply(attached_collision_objects=[wrong])
        self.assertIn("did you mean 'lower'", response.message)
        self.assertLess(time.monotonic() - begin, 0.25)  # there is nothing to wait for

    def test_an_octree_without_an_occupied_cell_is_an_empty_object(self):
        tree = Octree(binary=True, id=Octree.OCTREE, resolution=0.1)
        empty = thing('empty', bodies=[Body(type=Body.OCTREE, octree=tree)])
        self.succeeded(self.server.apply(empty, sphere('ball', 0.25)))
        row, = self.server.distance(bezier((-1, 5, 1), (1, 5, 1)), objects=['empty', 'ball']).results
        self.assertEqual(row.b, 'ball')
        self.assertEqual({o.id for o in self.server.scene().objects}, {'ball', 'empty'})

    def test_a_frame_that_nobody_has_published_is_refused_at_once(self):
        begin = time.monotonic()
        self.assertRefused(self.server.distance(bezier((0, 0, 5), (1, 0, 5), frame='wrold')), "'wrold'")
        self.assertLess(time.monotonic() - begin, 0.25)

    def test_the_srdfs_unknown_links_are_told_once_in_the_log_and_in_no_answer(self):
        self.assertEqual(self.node.output().count('ghost'), 1)
        self.server.replace()
        self.assertEqual(self.rows(self.server.distance([], trajectory=trajectory((0, 0), (0.1, 0), times=[0, 1])))['environment'].message,
                         'nothing was measured: there is no object')


if __name__ == '__main__':
    run('states')
