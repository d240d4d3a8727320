#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""~evaluate_constraints about trajectories of the Panda: values, gradients by waypoints, and rows for optimisers."""
import copy
import math

import rospy
from curve_proximity.msg import CollisionObject, ConstraintQuery, RobotTrajectory
from helpers import Case, Server, bezier, box, joints, moving, pose, run, sphere, waypoint
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

ARM = [f'panda_joint{i}' for i in range(1, 8)]
POSES = [[-0.6, 0.1, 0.1, -1.9, 0.1, 2.0, 0.5], [0.1, 0.5, 0.2, -1.6, -0.2, 2.2, 0.8], [0.7, 0.2, -0.1, -2.1, 0.2, 1.8, 0.3]]
SPEEDS = [[0.2, 0.1, -0.1, 0.1, 0.0, -0.1, 0.2], [0.5, -0.2, 0.1, -0.1, 0.2, 0.1, -0.1], [0.1, -0.1, 0.2, 0.0, 0.1, 0.2, 0.0]]


def trajectory(velocities=True, **fields):
    """Three points, 0.8 s apart."""
    return JointTrajectory(joint_names=ARM, points=[
        JointTrajectoryPoint(positions=list(q), velocities=list(v) if velocities else [], time_from_start=rospy.Duration(0.8 * i))
        for i, (q, v) in enumerate(zip(POSES, SPEEDS))], **fields)


def query(path, *providers, name='case', **fields):
    return ConstraintQuery(id=name, providers=list(providers), trajectory=path, **fields)


class Optimise(Case):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()

    def setUp(self):
        self.server.replace(box('table', (0.5, 1.2, 0.05), (0.6, 0, 0.1)), sphere('lamp', 0.12, (0.55, 0.25, 0.85)))

    def results(self, *cases):
        return self.succeeded(self.server.ask('evaluate_constraints', cases=list(cases))).results

    def refused(self, case):
        response = self.server.ask('evaluate_constraints', cases=[case])
        self.assertFalse(response.success)
        self.assertEqual(response.results[0].status, 'invalid')
        self.assertEqual(response.results[0].rows, [])
        return response.results[0].message

    def test_links_are_sides_by_joint_values(self):
        """Against ~distance about the same link, which measures its triangles: exact, and by the hull never more."""
        state = JointState(name=ARM, position=POSES[0])
        line = bezier((0.5, -0.9, 0.5), (0.9, 0.3, 1.0), radius=0.01)
        link = CollisionObject(id='panda_link5')
        true = self.server.distance(line, links=['panda_link5'], joint_state=state, epsilon=1e-9).results[0]
        self.assertEqual(true.b, 'panda_link5')
        exact, hull = self.results(*(ConstraintQuery(id=name, providers=[name], b=link, curve=line, joint_state=state)
                                     for name in ('mesh', 'curve_proximity/CurveDistance')))
        self.assertAlmostEqual(exact.value, true.upper, delta=1e-8)
        self.assertLessEqual(hull.lower, true.upper + 1e-9)
        self.assertGreater(true.upper, 0.0)
        other = self.results(ConstraintQuery(providers=['mesh'], b=link, curve=line, joint_state=JointState(name=ARM, position=POSES[2])))[0]
        self.assertNotAlmostEqual(other.value, exact.value, delta=1e-3)
        link.pose.orientation.w = 1.0
        self.assertIn('is on the robot', self.refused(ConstraintQuery(providers=['mesh'], b=link, curve=line, joint_state=state)))
        self.assertIn('no link of that name', self.refused(ConstraintQuery(providers=['mesh'], b=CollisionObject(id='panda_link55'), curve=line)))

    def assertGradient(self, row, **fields):
        """Value and gradient are those of ~distance, which scene.test_motion_gradient holds against differences."""
        response = self.succeeded(self.server.distance([], trajectory=trajectory(), gradient=True, epsilon=1e-9, **fields))
        answer, gradient, (least,) = response.results[0], response.gradients[0], row.rows
        self.assertTrue(row.valid, row.message)
        self.assertAlmostEqual(row.value, answer.upper, delta=1e-8)
        self.assertEqual((least.kind, least.a, least.b), ('environment', answer.a, answer.b))
        for told, true in ((least.gradient_positions, gradient.positions), (least.gradient_velocities, gradient.velocities)):
            self.assertEqual((len(told), len(true)), (21, 21))
            for one, other in zip(told, true):
                self.assertAlmostEqual(one, other, delta=1e-6)
        self.assertEqual(len(least.gradient_accelerations), 0)
        self.assertAlmostEqual(least.gradient_duration, gradient.duration, delta=1e-6)
        self.assertAlmostEqual(least.gradient_start, gradient.start, delta=1e-6)
        self.assertGreater(max(map(abs, least.gradient_positions)), 0.01)
        return least

    def test_the_gradient_is_that_of_the_distance(self):
        row, = self.results(query(trajectory(), 'exact'))
        self.assertEqual((row.joints, [round(t, 9) for t in row.times]), (ARM, [0.0, 0.8, 1.6]))
        self.assertGradient(row)

    def test_the_value_is_the_distance_that_the_node_answers(self):
        row, = self.results(query(trajectory(), 'scene'))
        answer = self.server.distance([], trajectory=trajectory()).results[0]
        self.assertAlmostEqual(row.value, answer.upper - 0.02, delta=1e-5)
        self.assertLessEqual(row.lower, answer.upper - 0.02)
        self.assertGreaterEqual(row.upper + 0.02, answer.lower)
        self.assertEqual((row.rows[0].kind, row.rows[0].a, row.rows[0].b), ('environment', answer.a, answer.b))
        self.assertAlmostEqual(row.t, answer.t, delta=1e-2)
        self.assertAlmostEqual(row.witness_a.z, row.rows[0].witness_a.z)
        # A step of the nearest object is the opposite of one of the robot.
        self.assertAlmostEqual(row.gradient_a.linear.z, -row.gradient_b.linear.z, delta=1e-9)

    def test_rows_are_those_of_all_pairs_within_the_horizon_nearest_first(self):
        least, rows = self.results(query(trajectory(), 'least', 'rows'))
        self.assertGreater(len(rows.rows), 1)
        values = [row.value for row in rows.rows]
        self.assertEqual(values, sorted(values))
        self.assertAlmostEqual(values[0], least.value, delta=1e-5)
        self.assertAlmostEqual(rows.value, least.value, delta=1e-5)
        for row in rows.rows:
            self.assertLessEqual(row.lower, 0.3)
            self.assertTrue(row.t0 <= row.t <= row.t1)
            self.assertEqual(len(row.gradient_positions), 21)
            self.assertTrue(row.valid or row.message)

    def test_among_what_moves_the_gradient_is_that_of_the_distance(self):
        """A lamp crosses the arm's way and a second Panda moves beside it."""
        lamp = moving(sphere('lamp', 0.12), waypoint(0, (0.4, 0.9, 0.7)), waypoint(1.6, (0.9, -0.3, 0.7)))
        second = RobotTrajectory(name='second', trajectory=trajectory(velocities=False))
        second.base.pose = pose((1.6, 0.1, 0), (0, 0, 1, 0))
        for others in ([], [second]):
            self.server.replace(*([] if others else [lamp]))
            row, = self.results(query(trajectory(), 'exact', moving_robots=others))
            least = self.assertGradient(row, moving_robots=others)
            self.assertEqual(least.b.split('/')[0], 'second' if others else 'lamp')
            self.assertNotEqual(least.gradient_start, 0.0)
        self.server.replace(lamp)
        both, = self.results(query(trajectory(), 'least'))
        self.assertEqual({one.kind for one in both.rows}, {'environment', 'self'})
        self.assertIn('a horizon is not available', self.refused(query(trajectory(), 'near')))
        self.assertIn("there is no 'panda2'", self.refused(query(trajectory(), 'exact', moving_robots=[RobotTrajectory(robot='panda2', name='x')])))
        self.assertIn('beside a trajectory', self.refused(ConstraintQuery(a=sphere('', 0.1), b=sphere('', 0.1), moving_robots=[second])))

    def test_beyond_the_horizon_there_is_no_row_and_the_horizon_is_the_value(self):
        self.server.replace(sphere('far', 0.1, (9, 9, 9)))
        row, = self.results(query(trajectory(), 'near'))
        self.assertEqual((row.value, row.lower, row.rows, row.valid), (0.25, 0.25, [], True))
        self.assertEqual(row.upper, math.inf)

    def test_points_are_read_as_in_other_queries(self):
        late = trajectory()
        for point in late.points:
            point.time_from_start += rospy.Duration(1.0)
        late.points.append(copy.deepcopy(late.points[-1]))  # a repeated point
        row, = self.results(query(late, 'least', joint_state=joints(**dict(zip(ARM, POSES[0])))))
        self.assertEqual([round(t, 9) for t in row.times], [0.0, 1.0, 1.8, 2.6])
        self.assertEqual(len(row.rows[0].gradient_positions), 28)
        state = trajectory(velocities=False)
        del state.points[1:]
        row, = self.results(query(state, 'least'))
        self.assertEqual(list(row.times), [0.0])
        self.assertEqual(len(row.rows[0].gradient_positions), 7)

    def test_wrong_cases_are_told_by_one_line(self):
        def changed(**fields):
            path = trajectory()
            for key, value in fields.items():
                setattr(path, key, value)
            return path
        self.assertIn("'elbow'", self.refused(query(changed(joint_names=['elbow'] + ARM[1:]), 'least')))
        self.assertIn('7', self.refused(query(changed(joint_names=ARM + ['panda_finger_joint1']), 'least')))
        self.assertIn('point', self.refused(query(changed(points=[]), 'least')))
        bad = trajectory()
        bad.points[1].positions[2] = math.nan
        self.assertIn('finite', self.refused(query(bad, 'least')))
        bad = trajectory()
        bad.points[2].time_from_start = rospy.Duration(0.1)
        self.assertIn('is not after point 1', self.refused(query(bad, 'least')))
        self.assertIn('two sides', self.refused(query(trajectory(), 'least', b=sphere('', 0.1))))
        self.assertIn('two sides', self.refused(query(trajectory(), 'least', curve=bezier((0, 0, 0), (1, 0, 0)))))
        self.assertIn('joint_state', self.refused(query(trajectory(), 'least', joint_state=JointState(name=['x']))))
        self.assertIn('joint_state', self.refused(ConstraintQuery(
            providers=['least'], a=sphere('', 0.1), b=sphere('', 0.1), joint_state=joints(panda_joint1=0.0))))

    def test_without_names_those_about_trajectories_are_asked(self):
        self.assertEqual({row.provider for row in self.results(query(trajectory()))}, {'least', 'exact', 'scene', 'near', 'rows'})

    def test_providers_about_something_else_say_so(self):
        for name in ('curve_proximity/CurveDistance', 'balls'):
            self.assertIn('not for joint trajectories', self.refused(query(trajectory(), name)))
        two = ConstraintQuery(providers=['least'], a=sphere('', 0.1), b=sphere('', 0.1, (1, 0, 0)))
        self.assertIn('RobotDistance is about joint trajectories', self.refused(two))

    def test_in_contact_the_value_is_proven_and_no_gradient_is(self):
        through = trajectory(velocities=False)
        through.points[1].positions = [0.0, 1.4, 0.0, -0.6, 0.0, 2.0, 0.8]
        row, = self.results(query(through, 'scene'))
        self.assertAlmostEqual(row.value, -0.02)
        self.assertFalse(row.valid)
        self.assertTrue(row.message)


if __name__ == '__main__':
    run('optimise')
