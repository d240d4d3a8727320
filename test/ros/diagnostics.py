#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the server tells of itself on /diagnostics, and what may be changed while it runs."""
import time

import rospy
from curve_proximity.msg import Curve
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from dynamic_reconfigure.client import Client
from helpers import LINE, Case, Server, bezier, cloud, heard, ring_and_shells, run, sphere, status_of, transform
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage

ONLY_OBJECTS = dict(objects=['ball'])


class Diagnostics(Case):
    @classmethod
    def setUpClass(cls):
        cls.server, cls.seen = Server(), heard('/diagnostics', DiagnosticArray)

    def setUp(self):
        self.server.replace(sphere('ball', 0.25))

    def status(self, name, condition):
        """From now on."""
        del self.seen[:]
        return status_of(self.seen, name, condition)

    def test_rates_and_times_of_requests(self):
        def ask(*_):
            for _ in range(50):
                self.server.distance(LINE, **ONLY_OBJECTS)
        ask()
        status, values = self.status('queries', lambda s, v: ask() or (s.level == 0 and float(v['requests per second']) > 10))
        self.assertEqual(status.level, DiagnosticStatus.OK)
        self.assertGreater(float(values['mean time of a request [us]']), 0)
        self.assertLessEqual(float(values['mean time of a request [us]']), float(values['longest time of a request [us]']))
        self.status('queries', lambda s, v: s.message == 'idle')

    def test_failed_and_undecided_rows_are_counted(self):
        def fail(*_):
            self.assertFalse(self.server.distance(bezier((0, 0, 1)), **ONLY_OBJECTS).success)
        status, values = self.status('queries', lambda s, v: fail() or int(v['failed rows']) > 0)
        self.assertEqual((status.level, values['failed requests']), (DiagnosticStatus.WARN, values['failed rows']))

        def ask(*_):  # 0.75 m away, and asked about 0.75 m
            self.assertEqual(self.server.tolerance(LINE, 0.75, **ONLY_OBJECTS).results[0].verdict, 'undecided')
        status, values = self.status('queries', lambda s, v: ask() or int(v['undecided rows']) > 0)
        self.assertEqual(status.level, DiagnosticStatus.WARN)

    def say_where(self, frame, parent):
        """The node hears of a frame that no transform connects with the fixed one."""
        self.publisher('/tf', TFMessage).publish(TFMessage([transform(parent, frame, stamp=rospy.Time.now())]))
        time.sleep(0.3)

    def test_dropped_messages_are_told(self):
        publisher = self.publisher('/curve_proximity/curve', Curve, queue_size=200)
        self.say_where('island', 'sea')
        for i in range(100):
            publisher.publish(bezier((0, 0, 1), (1, 0, 1), frame='island'))  # each waits ~tf_timeout for that frame
        status, values = self.status('queries', lambda s, v: int(v['messages dropped']) > 50)
        self.assertEqual(status.level, DiagnosticStatus.WARN)

    def test_how_old_what_sensors_see_is_and_whether_it_is_known(self):
        publisher = self.publisher('/curve_proximity/cloud', PointCloud2)
        self.addCleanup(self.server.replace)
        status, values = self.status('sensors', lambda s, v: publisher.publish(cloud([(0, 0, 1)])) or 'cloud: age [s]' in v)
        self.assertEqual((status.level, status.message), (DiagnosticStatus.OK, 'listening'))
        self.assertLess(float(values['cloud: age [s]']), 1.5)
        publisher.publish(cloud([(0, 0, 1)], 'nowhere'))
        status, _ = self.status('sensors', lambda s, v: v.get('cloud') == 'unknown')
        self.assertEqual(status.level, DiagnosticStatus.WARN)

    def test_epsilon_budget_and_threads_change_while_it_runs(self):
        client = Client('/curve_proximity', timeout=10)
        before = client.get_configuration()
        self.assertEqual((before['epsilon'], before['threads']), (1e-6, 4))
        curve, _, _ = ring_and_shells(shells=1, n=50)  # all but at the same distance from the ball

        def width():
            row, = self.server.distance(curve, **ONLY_OBJECTS).results
            return row.upper - row.lower, row.nodes
        fine = width()
        self.assertLessEqual(fine[0], 1e-6)
        client.update_configuration({'epsilon': 0.1, 'threads': 1})
        self.assertLess(width()[1], fine[1])
        client.update_configuration({'epsilon': 1e-6, 'threads': 3})
        self.assertEqual(width(), fine)
        ring, balls, fields = ring_and_shells()
        self.server.replace(*balls)
        client.update_configuration({'budget_ms': 200.0})
        response = self.server.distance(ring, objects=[b.id for b in balls], **fields)
        self.assertIn('~budget_ms = 200', ' '.join(row.message for row in response.results))
        client.update_configuration({'budget_ms': before['budget_ms'], 'threads': 4})


if __name__ == '__main__':
    run('diagnostics')
