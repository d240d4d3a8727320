#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Nodelet managers that end while queries run."""
import signal
import subprocess
import tempfile
import time

from actionlib_msgs.msg import GoalStatus
from curve_proximity.msg import Curve, QueryAction, QueryGoal
from helpers import ActionClient, Call, Case, Server, bezier, executable, query, ring_and_shells, run, until


class Managers(Case):
    def start(self, *arguments):
        """A program whose output is kept."""
        process = subprocess.Popen(arguments, stdout=self.log, stderr=subprocess.STDOUT)
        self.addCleanup(lambda: (process.poll() is None and process.kill(), process.wait()))
        return process

    def setUp(self):
        self.log = tempfile.NamedTemporaryFile()
        self.addCleanup(self.log.close)

    def manager(self):
        """A manager with a server and a gate."""
        nodelet = executable('nodelet', 'nodelet')
        manager = self.start(nodelet, 'manager', '__name:=stopped_manager')
        for name, kind in (('stopped_server', 'ProximityServer'), ('stopped_gate', 'TrajectoryGate')):
            self.start(nodelet, 'load', 'curve_proximity/' + kind, 'stopped_manager', '__name:=' + name)
        return manager

    def output(self):
        with open(self.log.name) as log:
            return log.read()

    def test_a_manager_that_is_stopped_while_queries_run_ends_without_a_crash(self):
        manager = self.manager()
        server = Server('/stopped_server')
        ring, balls, fields = ring_and_shells()
        server.replace(*balls)

        # a service, the topic and the action, all at work
        call = Call(lambda: server.distance(ring, **fields))
        client = ActionClient('/stopped_server/query', QueryAction)
        client.send_goal(QueryGoal(query_type='distance', query=query([ring] * 100, **fields)))
        topic = self.publisher('/stopped_server/curve', Curve, queue_size=100)
        for i in range(50):
            topic.publish(bezier((0, 0, 1), (1, 0, 1)))
            topic.publish(Curve(basis='bspline', degree=3, points=ring.points, knots=ring.knots))
        self.assertTrue(until(lambda: client.get_state() == GoalStatus.ACTIVE, 5))
        time.sleep(0.5)

        begin = time.monotonic()
        manager.send_signal(signal.SIGINT)
        call.join(10)
        self.assertIsNotNone(call.ended, 'the client is still waiting')
        self.assertLess(call.ended - begin, 6.0)
        self.assertTrue(until(lambda: manager.poll() is not None, 15), 'the manager does not end')
        self.assertGreaterEqual(manager.returncode, 0, 'it died of a signal:\n' + self.output())


if __name__ == '__main__':
    run('managers')
