#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The Panda along joint trajectories, asked through the live node."""
import itertools
import json
import math
import os
import unittest

import rospy
import yaml
from curve_proximity.msg import AllowedContact
from helpers import Server, bezier, body, joints, pose, run, solid, sphere, thing
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

DATA = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'data')
KINDS = {'box': 1, 'sphere': 2, 'cylinder': 3, 'cone': 4}
ARM = [f'panda_joint{i}' for i in range(1, 8)]
READY = [0, -0.785, 0, -2.356, 0, 1.571, 0.785]


def trajectory(*points, names=ARM):
    """Positions alone, a second apart."""
    rows = [JointTrajectoryPoint(positions=p, time_from_start=rospy.Duration(float(i))) for i, p in enumerate(points)]
    return JointTrajectory(joint_names=names, points=rows)


def read_trajectory(path):
    with open(path) as text:
        document = yaml.safe_load(text)
    rows = [JointTrajectoryPoint(positions=p['positions'], velocities=p['velocities'], time_from_start=rospy.Duration(p['time_from_start']))
            for p in document['joint_trajectory']['points']]
    still = document['fixed_joints']
    return (JointTrajectory(joint_names=document['joint_trajectory']['joint_names'], points=rows),
            JointState(name=list(still), position=list(still.values())))


def read_scene(path):
    """The primitives of a scene file, an object each, and the links that may touch."""
    with open(path) as text:
        document = yaml.safe_load(text)
    objects = []
    for entry in document['world']['collision_objects']:
        shapes = [solid('', KINDS[p['type']], p['dimensions']).primitives[0] for p in entry['primitives']]
        poses = [pose(p['position'], p['orientation']) for p in entry['primitive_poses']]
        objects.append(thing(entry['id'], primitives=shapes, primitive_poses=poses))
    matrix = document.get('allowed_collision_matrix', {'entry_names': [], 'entry_values': []})
    allowed = [AllowedContact(first=a, second=b, allowed=bool(value)) for a, row in zip(matrix['entry_names'], matrix['entry_values'])
               for b, value in zip(matrix['entry_names'], row) if a < b]
    return objects, allowed


class Trajectory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()

    def rows(self, response):
        self.assertTrue(response.success, response.message)
        return {row.kind: row for row in response.results}

    def test_reference_answers_overlap(self):
        with open(DATA + '/reference/expected_hull_model.json') as text:
            cases = [case for case in json.load(text)['cases'] if case['robot'].endswith('panda.urdf')]
        self.assertEqual(len(cases), 21)
        hulls = Server('/hulls')
        for case in cases[::4]:
            objects, allowed = read_scene(f"{DATA}/{case['scene']}")
            hulls.replace(*objects, allowed_contacts=allowed)
            path, still = read_trajectory(f"{DATA}/trajectories/{os.path.basename(case['trajectory'])}")
            rows = self.rows(hulls.distance([], trajectory=path, joint_state=still, self_collision=True, epsilon=1e-6))
            for expected in case['results']:
                with self.subTest(trajectory=case['trajectory'], kind=expected['kind']):
                    row = rows[expected['kind']]
                    self.assertEqual(row.status, 'ok')
                    self.assertEqual(row.upper, math.inf)  # hulls bound from below
                    self.assertLessEqual(row.lower, expected['upper'] + 5e-9)
                    self.assertGreaterEqual(row.lower, expected['lower'] - 1e-6 - 5e-9)
                    if expected['lower'] > 0:
                        self.assertEqual({row.a, row.b}, set(expected['pair']))

    def test_a_superquadric_is_measured_from_a_curve_and_from_the_arm(self):
        # with all exponents 2 it is a ball, which is measured by another method
        path = trajectory(READY, [0.5] + READY[1:])
        line = bezier((0.2, -0.6, 0.9), (0.8, 0.1, 0.7))
        answers = []
        for ball in (sphere('thing', 0.1, (0.75, 0.1, 0.6)), body('thing', 'superquadric', [0.1, 0.1, 0.1, 2, 2, 2], position=(0.75, 0.1, 0.6))):
            self.server.replace(ball)
            rows = self.rows(self.server.distance([line], trajectory=path, objects=['thing'], epsilon=1e-7))
            self.assertEqual(rows['environment'].b, 'thing')
            answers.append(rows)
        for kind in ('curve', 'environment'):
            self.assertLessEqual(abs(answers[0][kind].upper - answers[1][kind].upper), 2e-7)
            self.assertLessEqual(answers[0][kind].lower, answers[1][kind].upper)
            self.assertLessEqual(answers[1][kind].lower, answers[0][kind].upper)
        self.assertGreater(answers[0]['environment'].upper, 0.01)

    def test_the_allowed_contacts_mean_what_moveit_msgs_says(self):
        # what is said of the pair counts, else what is said of both; a far ball is answered where the near one is allowed
        path = trajectory(READY, [0.5] + READY[1:])
        near, far = sphere('near', 0.1, (0.75, 0.1, 0.6)), sphere('far', 0.1, (3, 0, 0.6))
        links = [f'panda_link{i}' for i in range(8)] + ['panda_hand', 'panda_leftfinger', 'panda_rightfinger']
        for pair, a, b in itertools.product((None, False, True), repeat=3):
            contacts = [AllowedContact(link, 'near', pair) for link in links if pair is not None]
            contacts += [AllowedContact(link, '', a) for link in links if a is not None]
            contacts += [AllowedContact('near', '', b)] if b is not None else []
            said = [word for word in (a, b) if word is not None]
            expected = pair if pair is not None else bool(said) and all(said)
            with self.subTest(pair=pair, a=a, b=b):
                self.server.replace(near, far, allowed_contacts=contacts)
                row = self.rows(self.server.distance([], trajectory=path, objects=['near'])).get('environment')
                self.assertEqual(row.b == 'near', not expected)

    def test_verdicts_follow_the_distance(self):
        self.server.replace(sphere('ball', 0.1, (0.75, 0.1, 0.6)))
        path = trajectory(READY, [0.5] + READY[1:])
        distance = self.rows(self.server.distance([], trajectory=path))['environment'].upper
        self.assertEqual(self.rows(self.server.tolerance([], 0.99 * distance, trajectory=path))['environment'].verdict, 'clear')
        self.assertEqual(self.rows(self.server.tolerance([], 1.01 * distance, trajectory=path))['environment'].verdict, 'violated')
        self.assertEqual(self.rows(self.server.collision([], trajectory=path))['environment'].verdict, 'clear')

    def test_the_way_from_the_present_state_counts(self):
        # the trajectory begins at one second, on the far side of a ball that only the way there meets
        self.server.replace(sphere('ball', 0.1, (0.35, 0, 0.5)))
        path = trajectory([1.5] + READY[1:], [1.6] + READY[1:])
        for row in path.points:
            row.time_from_start += rospy.Duration(1)
        now = joints(**dict(zip(ARM, [-1.5] + READY[1:])))
        self.assertEqual(self.rows(self.server.collision([], trajectory=path))['environment'].verdict, 'clear')
        self.assertEqual(self.rows(self.server.collision([], trajectory=path, joint_state=now))['environment'].verdict, 'violated')

    def test_what_is_wrong_is_told_and_the_node_goes_on(self):
        good = trajectory(READY, [0.5] + READY[1:])
        late = trajectory(READY)
        late.points[0].time_from_start = rospy.Duration(1)
        for bad, word in ((trajectory([0], [1], names=['elbow']), "'elbow'"), (late, 'one point'),
                          (trajectory(READY, READY[:3]), 'point 1'), (trajectory([float('nan')] * 7, READY), 'not finite'),
                          (JointTrajectory(points=good.points), 'no joints')):
            response = self.server.distance([], trajectory=bad)
            self.assertFalse(response.success)
            self.assertIn(word, response.message)
        self.assertTrue(self.server.distance([], trajectory=good).success)


if __name__ == '__main__':
    run('trajectory')
