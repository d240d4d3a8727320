#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Point clouds and octrees, published to the live node and sent to it; what cannot be used is told and changes nothing."""
import struct
import threading
import time

import numpy
import rospy
from curve_proximity.msg import Body, Octree
from foreign_types import octomap
from geometry_msgs.msg import Point
from helpers import Call, Case, Server, bezier, cloud, connected, run, thing, until
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import PointCloud2, PointField
from shape_msgs.msg import MeshTriangle

NODE = '/curve_proximity'
EPSILON = 1e-9                                   # [m] asked for in each query that is compared
RADIUS = 0.25                                    # [m] ~cloud_radius of the launch file
ABOVE = bezier((0, 0, 1), (2, 0, 1), id='above')  # a straight line one metre up, middle over (1, 0, 0)
PATIENCE = 20                                    # seconds for a message to arrive; a failure takes that long

# One cell of 0.5 m at the origin's corner, occupied: from the root the last child, then always the first, two bits each.
CELL = b'\x00\xc0' + b'\x03\x00' * 14 + b'\x02\x00'
FREE_CELL = CELL[:-2] + b'\x01\x00'


class TestCase(Case):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        cls.lines = []
        cls.log = rospy.Subscriber('/rosout', Log, lambda line: cls.lines.append(line.msg))
        cls.clouds = rospy.Publisher(NODE + '/cloud', PointCloud2, queue_size=1)
        cls.octomaps = rospy.Publisher(NODE + '/octomap', octomap.Octomap, queue_size=1)
        assert connected(cls.clouds, cls.octomaps, cls.log), 'the node does not subscribe, or has other message types than octomap_msgs'

    def setUp(self):
        self.server.replace()

    def answer(self, curve=ABOVE):
        return self.row(self.server.distance(curve, epsilon=EPSILON))

    def assertNearest(self, name, distance):
        """Soon the answer names the object, at that distance; the points of the tests are exact as floats."""
        row = until(lambda: [row for row in [self.answer()] if row.b == name and abs(row.upper - distance) < 1e-6], PATIENCE)
        self.assertTrue(row, 'still %s' % self.answer())
        self.assertHolds(row[0].lower, row[0].upper, distance, width=numpy.inf)  # 0 and more where it is unknown
        self.assertEqual(row[0].lod, 'mesh')

    def assertTold(self, *words):
        """Soon one line of the log holds all the words."""
        told = until(lambda: any(all(word in line for word in words) for line in list(self.lines)), PATIENCE)
        self.assertTrue(told, '%s is not in %s' % (words, self.lines[-5:]))

    def assertRefused(self, thing, *words):
        super().assertRefused(self.server.apply(thing), *words)


class Clouds(TestCase):
    def test_a_published_cloud_changes_the_next_answer_and_the_next_cloud_replaces_it(self):
        self.assertEqual(self.answer().b, '')
        self.clouds.publish(cloud([(1, 0, 0), (5, 5, 5)]))
        self.assertNearest('cloud', 1 - RADIUS)
        self.clouds.publish(cloud([(0, 0, -1)]))
        self.assertNearest('cloud', 2 - RADIUS)
        self.assertEqual(len(self.server.scene().objects), 1)

    def test_a_cloud_stands_where_its_frame_does(self):
        self.clouds.publish(cloud([(1, 0, -2.5)], frame='camera'))
        self.assertNearest('cloud', 1.5 - RADIUS)

    def test_every_layout_of_floats_is_read(self):
        for i, fields in enumerate((dict(kind='d'), dict(order='>'), dict(order='>', kind='d'), dict(padding=5),
                                    dict(padding=3, width=2), dict(names='yxz'))):
            depth = 0.5 * (i + 1)
            self.clouds.publish(cloud([(0, 0, -depth)] * 4, **fields))
            self.assertNearest('cloud', 1 + depth - RADIUS)

    def test_points_that_are_not_finite_are_left_out(self):
        nan, inf = float('nan'), float('inf')
        self.clouds.publish(cloud([(nan, 0, 1), (1, 0, 0), (1, inf, 1), (nan, nan, nan)]))
        self.assertNearest('cloud', 1 - RADIUS)

    def test_a_cloud_without_points_takes_the_object_away(self):
        for nothing in (PointCloud2(), cloud([(float('nan'), 0, 0)])):
            self.clouds.publish(cloud([(1, 0, 0)]))
            self.assertNearest('cloud', 1 - RADIUS)
            self.clouds.publish(nothing)
            self.assertTrue(until(lambda: self.answer().b == '', PATIENCE))

    def test_a_cloud_that_cannot_be_used_is_told_and_leaves_the_object_as_it_was_and_unknown(self):
        self.clouds.publish(cloud([(1, 0, 0)]))
        self.assertNearest('cloud', 1 - RADIUS)
        near = [(1, 0, 1), (1, 0, 1)]

        def broken(**fields):
            out = cloud(near)
            for name, value in fields.items():
                setattr(out, name, value)
            return out

        integers = cloud(near)
        integers.fields[2].datatype = PointField.UINT16
        beyond = cloud(near)
        beyond.fields[1].offset = 9
        for bad, words in ((cloud(near, names='xyq'), ("no field 'z'", 'x, y, q')),
                           (integers, ("'z'", 'datatype 4', 'float32')),
                           (beyond, ("'y'", 'byte 13', 'point_step is 12')),
                           (broken(point_step=0), ("'x'", 'point_step is 0')),
                           (broken(width=3), ('24 bytes', '3 points')),
                           (broken(height=2, row_step=8), ('row_step is 8', '24')),
                           (broken(height=2 ** 32 - 1, width=2 ** 32 - 1, row_step=2 ** 32 - 1), ('row_step',)),
                           (cloud(near, frame='nowhere'), ("'nowhere'", "'world'"))):
            with self.subTest(words=words):
                self.clouds.publish(bad)
                self.assertTold('~cloud', 'what is there now is unknown', *words)
                self.assertNearest('cloud', 1 - RADIUS)
                self.assertEqual(self.answer().status, 'unknown')
        self.clouds.publish(cloud([(1, 0, 0)]))
        self.assertTrue(until(lambda: self.answer().status == 'ok', PATIENCE))

    def test_a_cloud_beyond_the_limit_is_refused_with_the_bytes_that_it_would_need(self):
        self.clouds.publish(cloud(numpy.zeros((10 ** 7, 3))))
        self.assertTold('10000000 points need up to', 'bytes, above the limit of %d' % (64 << 20))
        self.assertEqual(self.answer().b, '')

    def test_a_cloud_is_a_body_of_the_scene(self):
        def scan(cloud, dimensions=(RADIUS,), frame='camera'):
            out = thing('scan', bodies=[Body(type='points', dimensions=dimensions, cloud=cloud)])
            out.header.frame_id = frame
            return out

        self.server.replace(scan(cloud([(1, 0, -2.5)], frame='camera')))
        self.assertNearest('scan', 1.5 - RADIUS)
        self.server.replace(self.server.scene().objects[0])  # what it says of itself makes it again
        self.assertNearest('scan', 1.5 - RADIUS)
        self.assertRefused(scan(cloud([], frame='camera')), "'scan'", 'no vertices')
        self.assertRefused(scan(cloud([(1, 2, 3)], frame='world')), "'scan'", "'world'", "'camera'")
        self.assertRefused(scan(cloud([(1, 2, 3)], names='abc')), "'scan'", "no field 'x'")
        self.assertRefused(scan(cloud([(1, 2, 3)]), dimensions=(-1,)), 'not below 0')
        self.assertRefused(thing('ball', bodies=[Body(type='sphere', dimensions=[1], cloud=cloud([(1, 2, 3)]))]), 'no cloud')
        self.assertNearest('scan', 1.5 - RADIUS)

    def test_clouds_of_100000_points_30_times_a_second_and_queries_meanwhile_agree_with_one_of_them(self):
        # seed 16; two clouds whose nearest point is 0.75 and 1.25 below the line: no answer may lie between
        random = numpy.random.RandomState(16)
        points = random.uniform((-2, -2, -5), (4, 2, -2), (100000, 3))
        both = []
        for depth in (0.0, -0.5):
            points[500] = (1, 0, depth)
            both.append(cloud(points))
        self.clouds.publish(both[0])
        self.assertNearest('cloud', 1 - RADIUS)

        answers, stop = [], threading.Event()

        def ask():
            server = Server()
            while not stop.is_set():
                row = server.distance(ABOVE, epsilon=EPSILON).results[0]
                answers.append(row.upper)

        asking = Call(ask)

        def changes():
            return sum(abs(a - b) > 0.1 for a, b in zip(answers, answers[1:]))

        rate, sent, end = rospy.Rate(30), 0, time.monotonic() + 60
        while sent < 90 or (changes() <= 10 and time.monotonic() < end):  # a slow machine sees fewer of them
            for one in both:
                self.clouds.publish(one)
                rate.sleep()
                sent += 1
        stop.set()
        asking.join()
        self.assertIsNone(asking.failure)
        self.assertNearest('cloud', 1.5 - RADIUS)
        for value in answers:
            self.assertTrue(min(abs(value - (1 - RADIUS)), abs(value - (1.5 - RADIUS))) < 1e-6, value)
        print('%d answers, %d changes seen of %d clouds' % (len(answers), changes(), sent))
        self.assertGreater(changes(), 10)


class Fast(Case):
    def test_of_clouds_of_a_million_points_at_19_hz_the_newest_is_taken_in(self):
        """None waits but the newest: when the last has been sent, one is being taken in, one waits, and the last comes."""
        _, server = self.begin('fast')
        publisher = self.publisher('/fast/cloud', PointCloud2, queue_size=1)
        points = numpy.random.RandomState(19).uniform((-2, -2, -9), (4, 2, -8), (10 ** 6, 3))
        points[0] = 1, 0, 0
        message, last, step = cloud(points), 57, 0.05
        data = bytearray(message.data)
        seen, going = [], True

        def ask():
            while going:
                seen.append(round((server.distance(ABOVE).results[0].upper - 1) / step))
        publisher.publish(message)
        self.assertTrue(until(lambda: server.scene().objects, PATIENCE))
        asking = Call(ask)
        rate = rospy.Rate(19)
        for i in range(last + 1):
            struct.pack_into('<3f', data, 0, 1, 0, -i * step)  # the point below the line
            message.data = bytes(data)
            publisher.publish(message)
            rate.sleep()
        sent = len(seen)
        self.assertTrue(until(lambda: seen[-1:] == [last], PATIENCE), seen[-5:])
        going = False
        asking.join(PATIENCE)
        self.assertIsNone(asking.failure)
        print('%d of %d clouds seen, %d since the last was sent' % (len(set(seen)), last + 1, len(set(seen[sent:]))))
        self.assertEqual(seen, sorted(seen))
        self.assertLessEqual(len(set(seen[sent:])), 4, seen[sent:])


class Octrees(TestCase):
    def octomap(self, data, resolution=0.5, frame='', **fields):
        out = octomap.Octomap(binary=True, id='OcTree', resolution=resolution, data=list(memoryview(data).cast('b')), **fields)
        out.header.frame_id = frame
        return out

    def test_a_published_octomap_changes_the_next_answer(self):
        self.octomaps.publish(self.octomap(CELL))
        self.assertNearest('<octomap>', 0.5)
        self.octomaps.publish(self.octomap(CELL, frame='camera'))
        self.assertNearest('<octomap>', 1.0)
        for nothing in (b'', FREE_CELL):
            self.octomaps.publish(self.octomap(CELL))
            self.assertNearest('<octomap>', 0.5)
            self.octomaps.publish(self.octomap(nothing))
            self.assertTrue(until(lambda: self.answer().b == '', PATIENCE))

    def test_an_octomap_that_cannot_be_used_is_told_and_leaves_the_object_as_it_was_and_unknown(self):
        self.octomaps.publish(self.octomap(CELL))
        self.assertNearest('<octomap>', 0.5)
        other = self.octomap(CELL)
        other.id = 'Quadtree'
        for bad, words in ((self.octomap(CELL[:-1]), ('cut short',)), (self.octomap(b'\xff' * 200), ('deeper',)),
                           (self.octomap(CELL, resolution=0.0), ('resolution',)), (other, ("'Quadtree'",)),
                           (self.octomap(CELL, frame='nowhere'), ("'nowhere'",))):
            with self.subTest(words=words):
                self.octomaps.publish(bad)
                self.assertTold('~octomap', *words)
                self.assertNearest('<octomap>', 0.5)
                self.assertEqual(self.answer().status, 'unknown')

    def test_an_octree_is_a_body_of_the_scene(self):
        def map_of(**fields):
            return thing('map', bodies=[Body(type='octree', **fields)])

        octree = Octree(binary=True, id='OcTree', resolution=0.5, data=list(memoryview(CELL).cast('b')))
        self.server.replace(map_of(octree=octree))
        self.assertNearest('map', 0.5)
        self.server.replace(self.server.scene().objects[0])
        self.assertNearest('map', 0.5)
        self.assertRefused(map_of(), "'map'", 'neither a file nor bytes')
        self.assertRefused(map_of(resource='/nowhere.bt'), "'map'", "'/nowhere.bt'", 'no file')
        self.assertRefused(map_of(octree=octree, resource='/nowhere.bt'), 'give one of the two')


class Meshes(TestCase):
    # three plates of a U that opens upwards
    VERTICES = [(x, y, z) for z in (1, 0) for x in (-1, 1) for y in (-1, 1)]
    TRIANGLES = [(0, 1, 4), (1, 5, 4), (2, 3, 6), (3, 7, 6), (4, 5, 6), (5, 7, 6)]

    def bracket(self, **fields):
        return thing('bracket', bodies=[Body(type='mesh', vertices=[Point(*v) for v in self.VERTICES],
                                             triangles=[MeshTriangle(vertex_indices=t) for t in self.TRIANGLES], **fields)])

    def test_a_mesh_that_is_none_is_refused(self):
        bad = self.bracket()
        bad.bodies[0].triangles[5].vertex_indices = (0, 1, 8)
        self.assertRefused(bad, "'bracket'", 'vertex 8')
        bad.bodies[0].triangles = []
        self.assertRefused(bad, "'bracket'", 'no triangle')
        bad = self.bracket()
        bad.bodies[0].vertices[3].y = float('nan')
        self.assertRefused(bad, "'bracket'", 'not finite')
        self.assertRefused(thing('ball', bodies=[Body(type='sphere', dimensions=[1], solid=True)]), 'solid')


if __name__ == '__main__':
    run('worlds')
