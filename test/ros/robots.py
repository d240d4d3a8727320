#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A robot that nobody has configured starts with one launch line; a wrong configuration ends the launch; two servers of two
namespaces know nothing of each other."""
import math
import os
import signal
import subprocess
import tempfile

import rospy
import yaml
from curve_proximity.msg import CollisionObject
from helpers import LINE, Case, Node, Server, joints, run, sphere, until
from sensor_msgs.msg import JointState

DATA = os.path.dirname(os.path.abspath(__file__)) + '/../data'
NODES = DATA + '/../../nodes'
CONFIG = DATA + '/../../rviz/curve_proximity.rviz'


class Robots(Case):
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
        process, log = self.launch('server.launch', 'name:=any', 'robot:=%s/robots/panda/panda.urdf' % DATA, 'root:=panda_link0',
                                   'state_rate:=5.0')
        self.addCleanup(rospy.delete_param, '/robot_description')
        server = Server('/any')
        server.apply(sphere('ball', 0.1, (0.75, 0.1, 0.6)))
        response = until(lambda: (lambda r: r.success and r)(
            server.distance([], robot_state=True, joint_state=self.ready())), 15)
        self.assertTrue(response, open(log.name).read()[-2000:])
        self.assertEqual(response.results[0].b, 'ball')
        self.assertIsNone(process.poll())
        self.assertViewFits()

        # A crash is not the end of it.
        pid = int(subprocess.check_output(['pgrep', '-P', subprocess.check_output(
            ['pgrep', '-P', str(process.pid), '-f', 'keep_running']).decode().split()[0]]).split()[0])
        os.kill(pid, signal.SIGKILL)
        scene = until(lambda: self.objects('/any'), 20)
        self.assertEqual(scene, ['ball'])

    def assertViewFits(self):
        """RViz shows the robot as it stands, though nobody has asked, and looks at all of it."""
        self.publisher('/joint_states', JointState).publish(self.ready())
        printed = subprocess.check_output([NODES + '/show_in_rviz.py', CONFIG, '--server', 'any', '--print'], timeout=30)
        config = yaml.safe_load(printed)['Visualization Manager']
        self.assertIn('/any/markers', [display.get('Marker Topic') for display in config['Displays']])
        view = config['Views']['Current']
        middle = [view['Focal Point'][axis] for axis in 'XYZ']
        radius = view['Distance'] * math.sin(view['Field of View'] / 2)
        for point in ((0, 0, 0), (0, 0, 0.33), (0.75, 0.1, 0.6)):  # the base, the shoulder, the ball
            self.assertLess(math.dist(point, middle), radius)
        self.assertTrue(0.4 < radius < 1.2, radius)

    @staticmethod
    def ready():
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
        for name in ('left', 'right'):  # both are curve_proximity, each in its namespace
            rospy.set_param('/%s/curve_proximity/state_file' % name, '')
            node = Node('curve_proximity', environment=dict(os.environ, ROS_NAMESPACE='/' + name))
            self.addCleanup(node.end)
        left, right = Server('/left/curve_proximity'), Server('/right/curve_proximity')
        left.replace(sphere('ball', 0.25))
        right.replace(sphere('other', 0.5))
        self.assertEqual((left.distance(LINE).results[0].b, right.distance(LINE).results[0].b), ('ball', 'other'))
        self.assertNotEqual(left.scene().scene.epoch, right.scene().scene.epoch)
        # a topic is one server's, too
        self.publisher('/left/curve_proximity/collision_object', CollisionObject).publish(sphere('third', 0.1, (0, 0, 5)))
        self.assertTrue(until(lambda: len(left.scene().objects) == 2, 10))
        self.assertEqual([o.id for o in right.scene().objects], ['other'])


if __name__ == '__main__':
    run('robots')
