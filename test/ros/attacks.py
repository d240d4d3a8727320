#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What one client can make the node hold: requests of honest form and hostile size, under a memory limit. The resident memory
never goes above the limit and 64 MB, and goes back afterwards. scripts/soak has these at full size."""
import os
import re
import socket
import struct
import time
import unittest

import numpy
import rosgraph
from curve_proximity.msg import ProximityQuery
from curve_proximity.srv import ApplyScene, ApplySceneRequest, DistanceRequest, Distance
from helpers import (LINE, Call, Node, Server, bezier, handshake, host_and_port, is_sanitized, raw_call, request_of_points, ring_and_shells, run,
                     serialized, sphere, until)

LIMIT_MB = 300
ROOM_MB = 64
AT_REST_MB = 45  # of a node that nobody has asked yet, at most


class Attacks(unittest.TestCase):
    def setUp(self):
        self.sanitized = is_sanitized(os.getpid())
        self.start(LIMIT_MB)
        if self.sanitized:  # the node counts the shadow, too, so its limit takes in what it takes more at rest
            extra = max(0.0, self.node.resident_mb(shadow=True) - AT_REST_MB)
            self.node.end()
            self.start(LIMIT_MB + int(extra))
        self.addCleanup(self.node.end)
        self.before = self.node.resident_mb()

    def start(self, limit_mb):
        self.node = Node('attacked', memory_limit_mb=limit_mb)
        self.server = Server('/attacked')
        self.server.replace(sphere('ball', 0.25))

    def assertHeld(self):
        self.assertTrue(self.node.alive(), self.node.output()[-2000:])
        row, = self.server.distance(LINE).results
        self.assertAlmostEqual(row.upper, 0.75, delta=2e-6)
        kept, wait = (100, 30) if self.sanitized else (40, 10)  # AddressSanitizer keeps what was freed, and its threads' caches
        self.assertTrue(until(lambda: self.node.resident_mb() < self.before + kept, wait), self.node.resident_mb() - self.before)
        if self.sanitized:  # the peak has the shadow of all that was freed
            return
        with open('/proc/%d/status' % self.node.process.pid) as status:
            peak, = re.findall(r'VmHWM:\s*(\d+)', status.read())
        self.assertLess(int(peak) / 1024, LIMIT_MB + ROOM_MB)

    def send(self, service, kind, data, copies=1):
        """The same bytes over as many connections at once; the answers, None where a connection was closed."""
        calls = [Call(lambda: raw_call('/attacked/' + service, kind, data)) for _ in range(copies)]
        for one in calls:
            one.join(60)
            self.assertIsNotNone(one.ended, 'a client still waits')
        return [one.response for one in calls]

    def test_one_request_with_a_long_id(self):
        self.server.apply(*[sphere('ball%d' % i, 0.1, (i, 0, -5)) for i in range(400)])
        curve = bezier(*((-1, 0, 1), (1, 0, 1)), id='x' * 900000)
        answer, = self.send('distance', Distance, serialized(DistanceRequest(ProximityQuery(curves=[curve], per_object=True))))
        self.assertFalse(answer.success)
        self.assertIn('max_name_length', answer.message)
        self.assertLess(len(answer.message), 300)
        answer, = self.send('apply_scene', ApplyScene, serialized(ApplySceneRequest(objects=[sphere('y' * 900000, 1.0)])))
        self.assertIn('max_name_length', answer.message)
        self.assertHeld()

    def test_millions_of_points_in_one_body(self):
        for copies, points in ((1, 5000000), (4, 1500000)):
            data = request_of_points(numpy.random.default_rng(1).random((points, 3)).tobytes())
            answers = self.send('apply_scene', ApplyScene, data, copies)
            for answer in answers:
                if answer is not None:
                    self.assertFalse(answer.success)
                    self.assertRegex(answer.message, 'too large|busy|memory')
            self.assertTrue(any(answers) or copies > 1)
        self.assertHeld()

    def test_a_flood_of_small_strings_and_claimed_counts(self):
        # two million empty names take 8 MB on the wire and 64 MB as strings
        data = serialized(DistanceRequest(ProximityQuery(curves=[LINE], objects=[''] * 2000000)))
        self.send('distance', Distance, data, 6)
        for count in (1 << 20, 1 << 26, (1 << 32) - 1):
            self.assertEqual(self.send('distance', Distance, struct.pack('<I', count) + b'\0' * 60, 3), [None] * 3)
        self.assertHeld()

    def test_a_small_request_with_a_large_answer(self):
        # 400 curves against each of 400 objects: 40 kB for more than half of the limit
        self.server.apply(*[sphere('ball%d' % i, 0.1, (i, 0, -5)) for i in range(400)])
        answer = self.server.distance([LINE] * 400, per_object=True)
        self.assertFalse(answer.success)
        self.assertRegex(answer.message, r'too large: .* \d+ MB, more than the \d+ MB')
        self.assertTrue(self.server.distance([LINE] * 3, per_object=True).success)
        self.assertHeld()

    def test_sixty_clients_with_long_curves(self):
        # each would keep some 15 MB: the message, the curve, what the search has grown to
        ring, balls, fields = ring_and_shells(shells=20)
        self.server.apply(*balls)
        request = serialized(DistanceRequest(ProximityQuery(curves=[ring], budget_ms=300, **fields)))
        answers, end = [], time.monotonic() + (16 if self.sanitized else 4)

        def ask():
            while time.monotonic() < end:
                answers.append(raw_call('/attacked/distance', Distance, request))
                time.sleep(0.02)
        calls = [Call(ask) for _ in range(60)]
        asked = 0
        while any(call.is_alive() for call in calls):
            row, = self.server.distance(LINE, objects=['ball']).results  # a small request is answered all the while
            self.assertAlmostEqual(row.upper, 0.75, delta=2e-6)
            asked += 1
        self.assertGreater(asked, 20)
        self.assertEqual([call.failure for call in calls], [None] * 60)
        came = [answer for answer in answers if answer is not None]  # as many messages at once as this are not let in
        self.assertEqual({answer.status for answer in came if not answer.success}, {Distance._response_class.BUSY})
        self.assertGreater(sum(answer.success for answer in came), 10)
        self.assertHeld()

    def test_connections_that_announce_gigabytes_and_send_little(self):
        address = host_and_port(rosgraph.Master('/test').lookupService('/attacked/distance'))
        opened = []
        for size in [900000000] * 8 + [50000000] * 8:
            connection = socket.create_connection(address, 5)
            connection.sendall(handshake(service='/attacked/distance', md5sum=Distance._md5sum) + struct.pack('<I', size))
            opened.append(connection)
        time.sleep(0.3)
        for connection in opened:
            connection.settimeout(5)
            try:
                connection.sendall(b'\1' * 20000000)
            except OSError:
                pass  # it was closed, or is not read
        self.assertTrue(self.server.distance(LINE).success)
        for connection in opened:
            connection.close()
        self.assertHeld()


if __name__ == '__main__':
    run('attacks')
