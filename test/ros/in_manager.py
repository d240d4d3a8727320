#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The server as a nodelet: it answers, and its manager outlives whatever becomes of it."""
import struct
import threading
import time
from xmlrpc.client import ServerProxy

import numpy
import rosgraph
import rospy
from curve_proximity.msg import CollisionObject, Curve
from curve_proximity.srv import ApplyScene, Distance, Tolerance, ToleranceResponse
from helpers import LINE, Call, Case, Server, body, raw_call, request_of_points, resident_mb, ring_and_shells, run, sphere, until
from nodelet.srv import NodeletList, NodeletLoad, NodeletUnload


class Nodelet(Case):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service('/manager/load_nodelet', 20)
        cls.load_nodelet = rospy.ServiceProxy('/manager/load_nodelet', NodeletLoad)
        cls.unload_nodelet = rospy.ServiceProxy('/manager/unload_nodelet', NodeletUnload)
        cls.list_nodelets = rospy.ServiceProxy('/manager/list', NodeletList)

    def load(self, name, **remapped):
        names = [['%s/%s' % (name, topic) for topic in remapped], list(remapped.values())]
        self.assertTrue(self.load_nodelet(name, 'curve_proximity/ProximityServer', *names, [], '').success)
        return Server(name)

    def test_it_answers_in_a_manager(self):
        server = self.load('/answering')
        server.replace(sphere('ball', 0.25))
        self.assertAlmostEqual(self.row(server.distance(LINE)).upper, 0.75, delta=2e-6)
        self.assertTrue(self.unload_nodelet('/answering').success)
        self.assertEqual(self.list_nodelets().nodelets, [])

    def test_two_servers_of_one_topic_each_know_what_they_have_lost(self):
        for name in ('/second', '/first'):
            self.addCleanup(self.unload_nodelet, name)
        servers = [self.load('/first'), self.load('/second', collision_object='/first/collision_object')]
        objects = self.publisher('/first/collision_object', CollisionObject, queue_size=0)
        points = numpy.random.RandomState(7).randn(50000, 3)
        points /= numpy.linalg.norm(points, axis=1)[:, None]
        objects.publish(body('large', 'polytope', vertices=points, position=(0, 0, 9)))  # the others wait meanwhile
        for i in range(3000):
            objects.publish(sphere('object %d' % i, 0.1, (0, 0, 5)))
        for server in servers:
            self.assertTrue(until(lambda: any(o.id == 'object 2999' for o in server.scene().objects), 60))
            row = server.tolerance(LINE, 0.1).results[0]
            self.assertEqual(row.status, 'unknown' if server.scene().scene.objects < 3001 else 'ok', row.message)

    def test_unloading_during_a_call_leaves_the_manager_alive(self):
        ring, balls, fields = ring_and_shells()
        for i in range(6):
            name = '/unloaded%d' % i
            server = self.load(name)
            server.replace(*balls)
            calls = [Call(lambda: Server(name).distance(ring, **fields)) for _ in range(2)]
            time.sleep(0.3 + 0.1 * i)
            self.assertTrue(all(call.is_alive() for call in calls), 'the call ended before the unload')
            begin = time.monotonic()
            self.assertTrue(self.unload_nodelet(name).success)
            for call in calls:
                call.join(10)
                self.assertFalse(call.is_alive(), 'the client is still waiting')
                self.assertLess(call.ended - begin, 5.0)
                if call.response is not None and call.response.success:
                    self.assertIn('stopped', {row.status for row in call.response.results})
            self.assertEqual(self.list_nodelets().nodelets, [])
        server = self.load('/afterwards')
        server.replace(sphere('ball', 0.25))
        self.assertTrue(server.distance(LINE).success)
        self.assertTrue(self.unload_nodelet('/afterwards').success)

    def test_what_a_request_takes_is_bounded_in_a_manager_too(self):
        """Without an account of all allocations: by what requests are going to take, and by the bytes that a count needs."""
        pid = ServerProxy(rosgraph.Master('/test').lookupNode('/manager')).getPid('/test')[2]
        self.set_param('/bounded', dict(memory_limit_mb=300))
        server = self.load('/bounded')
        server.replace(sphere('ball', 0.25), *[sphere('ball%d' % i, 0.1, (i, 0, -5)) for i in range(400)])
        before = resident_mb(pid)
        answer = server.distance([LINE] * 300, per_object=True)
        self.assertRegex(answer.message, 'too large: .* MB')
        for count in (1 << 20, 1 << 26, (1 << 32) - 1):  # a count of curves that no bytes follow
            self.assertIsNone(raw_call('/bounded/distance', Distance, struct.pack('<I', count) + b'\0' * 60))
        for points, word in ((2000000, 'too large'), (1000, None)):
            data = request_of_points(bytes(24 * points))
            answer = raw_call('/bounded/apply_scene', ApplyScene, data)
            self.assertEqual(answer.success, word is None, answer.message)
            self.assertIn(word or '', answer.message)
        self.assertLess(resident_mb(pid), before + 120)
        self.assertTrue(server.distance(LINE).success)
        self.assertTrue(self.unload_nodelet('/bounded').success)

    def test_a_wrong_parameter_fails_the_load_and_nothing_else(self):
        for kind, name, value in (('ProximityServer', 'epsilon', 'small'), ('TrajectoryGate', 'delta', -1.0), ('TrajectoryGate', 'delta', 'wide'),
                                  ('TrajectoryGate', 'queue_size', 0)):
            self.set_param('/wrong', {name: value})
            with self.assertRaises(rospy.ServiceException):
                if not self.load_nodelet('/wrong', 'curve_proximity/' + kind, [], [], [], '').success:
                    raise rospy.ServiceException('refused')
        self.assertEqual(self.list_nodelets().nodelets, [])

    def test_a_gate_whose_server_hangs_is_unloaded_all_the_same(self):
        asked, ending = threading.Event(), threading.Event()

        def hang(_):
            asked.set()
            ending.wait(60)
            return ToleranceResponse()
        service = rospy.Service('/hung/tolerance', Tolerance, hang)
        self.addCleanup(service.shutdown)
        self.addCleanup(ending.set)
        self.set_param('/hung_gate', dict(server='/hung'))
        self.assertTrue(self.load_nodelet('/hung_gate', 'curve_proximity/TrajectoryGate', [], [], [], '').success)
        self.publisher('/hung_gate/curve', Curve).publish(LINE)
        self.assertTrue(asked.wait(10))
        begin = time.monotonic()
        self.assertTrue(self.unload_nodelet('/hung_gate').success)
        self.assertLess(time.monotonic() - begin, 10.0)
        self.assertEqual(self.list_nodelets().nodelets, [])


if __name__ == '__main__':
    run('nodelet')
