#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How the node ends, and what it holds while it lives."""
import os
import signal
import time

from curve_proximity.msg import ConstraintQuery, ProximityQuery
from curve_proximity.srv import Distance, DistanceRequest, EvaluateConstraints, EvaluateConstraintsRequest
from helpers import Call, Case, RawClient, bezier, cpu_seconds, framed, ring_and_shells, run, serialized, sphere, until

LINE = bezier((-1, 0, 1), (1, 0, 1))
CALLS = int(os.environ.get('CURVE_PROXIMITY_CALLS', 20000))  # of the memory test


class Lifetime(Case):
    def test_sigint_during_a_long_query_is_answered_or_fails_promptly(self):
        node, server = self.begin('ending', budget_ms=60000)
        ring, balls, fields = ring_and_shells()
        server.replace(*balls)
        call = Call(lambda: server.distance(ring, **fields))
        time.sleep(0.5)
        self.assertTrue(call.is_alive(), 'the query was not long')
        begin = time.monotonic()
        node.process.send_signal(signal.SIGINT)
        call.join(10)
        self.assertIsNotNone(call.ended, 'the client is still waiting')
        self.assertLess(call.ended - begin, 2.0)
        if call.response is not None:
            self.assertIn('stopped', {row.status for row in call.response.results})
        self.assertEqual(node.wait(5), 0, node.output())

    def test_work_ends_when_its_client_is_gone(self):
        node, server = self.begin('left', budget_ms=600000)
        ring, balls, fields = ring_and_shells()
        server.replace(*balls)
        case = ConstraintQuery(providers=['curve_proximity/CurveDistance'], b=sphere('ball', 0.5), curve=ring)
        for name, kind, request in (('distance', Distance, DistanceRequest(ProximityQuery(curves=[ring], **fields))),
                                    ('evaluate_constraints', EvaluateConstraints, EvaluateConstraintsRequest(cases=[case] * 10))):
            client = RawClient('/left/' + name, kind)
            begin = cpu_seconds(node.process.pid)
            client.connection.sendall(framed(serialized(request)))
            assert until(lambda: cpu_seconds(node.process.pid) > begin + 0.3, 30), 'the call was not long'
            client.close()
            left = cpu_seconds(node.process.pid)
            time.sleep(2)
            with self.subTest(name):
                self.assertLess(cpu_seconds(node.process.pid), left + 0.3)

    def test_memory_is_flat_over_many_calls(self):
        node, server = self.begin('lasting')
        server.replace(*[sphere('ball%d' % i, 0.1, (i, 0, 0)) for i in range(30)])

        def call(times):
            for i in range(times):
                self.assertTrue(server.distance(LINE).success)
                if i % 100 == 0:
                    self.assertTrue(server.apply(sphere('moving', 0.1, (0, i, 0))).success)
                    server.distance(bezier((0, 0, 1)))
        call(2000)
        before = node.resident_mb()
        call(CALLS)
        # one leaked response of 200 bytes a call would be 4 MB
        self.assertLess(node.resident_mb() - before, 3.0)


if __name__ == '__main__':
    run('lifetime')
