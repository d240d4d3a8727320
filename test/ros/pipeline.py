#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""pipeline.launch as it is: a trajectory that clears the bookshelf by 2.66 mm passes a gate of 2 mm; with a box in its way it does
not, and once that is gone it does again."""
import time
import unittest

import rospy
from curve_proximity.msg import ProximityResults
from helpers import Server, box, run, until
from trajectory_msgs.msg import JointTrajectory


class Pipeline(unittest.TestCase):
    def test_only_what_is_certified_passes(self):
        passed, results = [], []
        rospy.Subscriber('/gate/clear_trajectory', JointTrajectory, passed.append)
        rospy.Subscriber('/curve_proximity/proximity', ProximityResults, results.append)
        self.assertTrue(until(lambda: len(passed) >= 2, 30), results[-1:])
        environment, itself = results[-1].results
        self.assertEqual((environment.kind, environment.verdict, itself.kind, itself.verdict),
                         ('environment', 'clear', 'self', 'clear'))
        self.assertEqual(passed[-1].joint_names[0], 'panda_joint1')

        server = Server()
        self.assertTrue(server.apply(box('wall', (0.2, 0.2, 0.2), (0.31, 0, 0.6))).success)
        self.assertTrue(until(lambda: results[-1].results[0].verdict == 'violated', 10), results[-1].results[0])
        time.sleep(0.5)
        before = len(passed)
        time.sleep(1.0)
        self.assertEqual(len(passed), before)
        self.assertTrue(server.apply(box('wall', (0.2, 0.2, 0.2), (9, 9, 9))).success)
        self.assertTrue(until(lambda: len(passed) > before + 1, 10))


if __name__ == '__main__':
    run('pipeline')
