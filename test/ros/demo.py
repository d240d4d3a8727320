#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""demo.launch as it is: the Panda by robot_state_publisher, parameters from config/defaults.yaml, markers."""
import math
import os
import tempfile

from helpers import ROOT, Case, Drawings, Server, bezier, box, joint_trajectory, joints, run, sphere, until
from draw_legend import clearance_colour  # helpers has put scripts/ on the path
from visualization_msgs.msg import Marker

READY = dict(panda_joint1=0.0, panda_joint2=-0.785, panda_joint3=0.0, panda_joint4=-2.356, panda_joint5=0.0,
             panda_joint6=1.571, panda_joint7=0.785, panda_finger_joint1=0.035)  # what demo.launch publishes
LINE = bezier((0.9, -0.5, 0.3), (0.9, 0.0, 0.8), (0.9, 0.5, 0.3), id='pass')


class Demo(Case):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        cls.server.replace(box('table', (1, 2, 0.1), (0.9, 0, -0.05)))
        # robot_state_publisher needs a moment
        until(lambda: cls.server.distance(LINE).success, 20)

    def test_markers_show_curve_closest_pair_scene_and_robot(self):
        drawn = Drawings()
        self.assertTrue(self.server.distance(LINE).success)
        shown = drawn.shown(lambda s: True, 'scene', 'robot', 'curves', 'pairs', 'labels')
        tube = next(m for m in shown['curves'] if m.type == Marker.LINE_STRIP)
        self.assertEqual(len(tube.points), len(tube.colors))
        self.assertGreater(len(tube.points), 100)
        self.assertTrue(all(math.isfinite(c) for p in tube.points for c in (p.x, p.y, p.z)))
        # the links are their mesh files, by a name that RViz finds on any working directory
        meshes = [m.mesh_resource for m in shown['robot'] if m.type == Marker.MESH_RESOURCE]
        self.assertEqual(len(meshes), 11)
        self.assertTrue(all(m.startswith('file:///') and os.path.isfile(m[7:]) for m in meshes))
        self.assertEqual({m.header.frame_id for markers in shown.values() for m in markers}, {'world'})

    def test_the_example_draws_the_clearance_of_each_link(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = os.path.join(folder, 'profile.png')
            motion = os.path.join(ROOT, 'test', 'data', 'trajectories', 'panda_bookshelf_tall_0001_rrt.yaml')
            self.assertRegex(self.output_of('client_profile.py', motion, picture), r'panda_hand +at least 0\.\d+ m, to table')
            with open(picture, 'rb') as stream:
                self.assertEqual(stream.read(4), b'\x89PNG')

    def test_a_trajectory_is_shown_at_its_closest_moment_and_swept(self):
        self.assertTrue(self.server.apply(sphere('post', 0.05, (0.45, 0.25, 0.5))).success)
        self.addCleanup(lambda: self.server.replace(box('table', (1, 2, 0.1), (0.9, 0, -0.05))))
        names = [n for n in READY if n.startswith('panda_joint')]
        trajectory = joint_trajectory(names, *[[state[n] for n in names] for state in (READY, dict(READY, panda_joint1=1.0))], times=(0, 2))
        drawn = Drawings()
        self.succeeded(self.server.distance([], trajectory=trajectory, joint_state=joints(panda_finger_joint1=0.035)))
        shown = drawn.shown(lambda s: True, 'robot', 'swept', 'sweep')
        links = shown['robot']
        self.assertEqual(len(links), 11)
        self.assertGreater(len({(m.color.r, m.color.g, m.color.b) for m in links}), 2)  # each in the colour of its clearance
        legend = [clearance_colour(0.0005 * i) for i in range(601)]
        for link in links:
            self.assertLess(min(math.dist(c, (link.color.r, link.color.g, link.color.b)) for c in legend), 0.01)
        self.assertEqual(len(shown['swept']) % 11, 0)


if __name__ == '__main__':
    run('demo')
