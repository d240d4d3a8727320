#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A robot that nobody has configured starts with one launch line; a wrong configuration ends the launch; two servers of two
namespaces know nothing of each other."""
import os
import signal
import subprocess
import tempfile
import unittest

import rospy
from helpers import Node, Server, bezier, run, sphere, until

DATA = os.path.dirname(os.path.abspath(__file__)) + '/../data'
LINE = bezier((-1, 0, 1), (1, 0, 1))


class Robots(unittest.TestCase):
    def launch(self, *arguments):
        log = tempfile.NamedTemporaryFile('w+', suffix='.log')
        process = subprocess.Popen(['roslaunch', 'curve_proximity', *arguments], stdout=log, stderr=subprocess.STDOUT)

        def end():
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                process.wait(20)
        self.addCleanup(end)
        return process, log

    def test_a_robot_starts_with_one_line_and_answers(self):
        # Meshes with relative names, no SRDF, no tf2 but the root that the line names; a name of its own.
        process, log = self.launch('server.launch', 'name:=any', 'robot:=%s/robots/panda/panda.urdf' % DATA, 'root:=panda_link0')
        self.addCleanup(rospy.delete_param, '/robot_description')
        server = Server('/any')
        server.apply(sphere('ball', 0.1, (0.75, 0.1, 0.6)))
        response = until(lambda: (lambda r: r.success and r)(
            server.distance([], robot_state=True, joint_state=self.ready())), 15)
        self.assertTrue(response, open(log.name).read()[-2000:])
        self.assertEqual(response.results[0].b, 'ball')
        self.assertIsNone(process.poll())

        # A crash is not the end of it.
        pid = int(subprocess.check_output(['pgrep', '-P', subprocess.check_output(
            ['pgrep', '-P', str(process.pid), '-f', 'keep_running']).decode().split()[0]]).split()[0])
        os.kill(pid, signal.SIGKILL)
        scene = until(lambda: self.objects('/any'), 20)
        self.assertEqual(scene, ['ball'])

    @staticmethod
    def ready():
        from helpers import joints
        return joints(panda_joint2=-0.785, panda_joint4=-2.356, panda_joint6=1.571)

    @staticmethod
    def objects(name):
        try:
            return [o.id for o in Server(name, timeout=5).scene().objects]
        except (rospy.ServiceException, rospy.ROSException):
            return None

    def test_a_wrong_configuration_ends_the_launch(self):
        process, log = self.launch('server.launch', 'name:=wrong', 'scene:=/nowhere.yaml')
        process.wait(20)
        self.assertIn('scene_file', open(log.name).read())

    def test_two_servers_in_two_namespaces(self):
        for name in ('left', 'right'):
            node = Node('%s_server' % name)
            self.addCleanup(node.end)
        left, right = Server('/left_server'), Server('/right_server')
        left.replace(sphere('ball', 0.25))
        right.replace(sphere('other', 0.5))
        self.assertEqual((left.distance(LINE).results[0].b, right.distance(LINE).results[0].b), ('ball', 'other'))
        self.assertNotEqual(left.scene().scene.epoch, right.scene().scene.epoch)


if __name__ == '__main__':
    run('robots')
