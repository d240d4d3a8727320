#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the markers hold: where their points are is computed here anew. What robots look like: demo.py."""
import math
import struct
import unittest

import rospy
from curve_proximity.msg import Body, Octree
from helpers import Server, bezier, body, connected, run, sphere, thing, until
from visualization_msgs.msg import Marker, MarkerArray

LINE = bezier((-1, 0, 1), (1, 0, 1), id='line', radius=0.05)


def coordinates(points):
    return [(p.x, p.y, p.z) for p in points]


class Markers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        cls.arrays = []
        cls.listen()

    @classmethod
    def listen(cls):
        cls.subscriber = rospy.Subscriber('/curve_proximity/markers', MarkerArray, cls.arrays.append)
        assert connected(cls.subscriber)

    def shown(self, condition, *spaces):
        """The markers of the first array from now on in which those of these namespaces meet the condition, by namespace."""
        def look():
            for array in self.arrays[-3:]:
                found = {space: [m for m in array.markers if m.ns == space] for space in spaces}
                if all(found.values()) and condition(found):
                    return found
        found = until(look, 10)
        self.assertTrue(found, [(m.ns, m.type) for a in self.arrays[-1:] for m in a.markers])
        return found

    def scene_of(self, object_, kind):
        self.server.replace(object_)
        shown = self.shown(lambda s: len(s['scene']) >= 1 and s['scene'][0].type == kind, 'scene')['scene']
        self.assertEqual({m.header.frame_id for m in shown}, {'world'})
        return shown

    def test_an_octree_is_its_occupied_cells(self):
        # two cells of 0.5 m beside each other at the origin's corner, and a block of 1 m: all eight children of its parent
        one = b'\x00\xc0' + b'\x03\x00' * 14
        for leaf, sizes in ((b'\x0a\x00', {0.5: [(0.25, 0.25, 0.25), (0.75, 0.25, 0.25)]}), (b'\xaa\xaa', {1.0: [(0.5, 0.5, 0.5)]})):
            data = list(struct.unpack('%db' % len(one + leaf), one + leaf))
            map_ = thing('map', bodies=[Body(type='octree', octree=Octree(binary=True, id='OcTree', resolution=0.5, data=data))])
            self.server.replace(map_)
            shown = self.shown(lambda s: {(m.type, m.scale.x) for m in s['scene']} == {(Marker.CUBE_LIST, x) for x in sizes}, 'scene')['scene']
            for marker in shown:
                self.assertEqual(marker.type, Marker.CUBE_LIST)
                self.assertEqual(sorted(coordinates(marker.points)), sizes[marker.scale.x])
                self.assertEqual(marker.scale.x, marker.scale.z)
                self.assertEqual(len(marker.colors), len(marker.points))

    def test_a_superquadric_is_its_surface(self):
        axes, exponents = (0.2, 0.3, 0.5), (2.0, 4.0, 6.0)
        marker, = self.scene_of(body('can', 'superquadric', (*axes, *exponents)), Marker.TRIANGLE_LIST)
        self.assertGreater(len(marker.points), 1000)
        for p in coordinates(marker.points):
            value = sum(abs(x / a)**n for x, a, n in zip(p, axes, exponents))
            self.assertAlmostEqual(value, 1.0, delta=1e-9)

    def test_nothing_is_kept_for_who_comes_later(self):
        """What is drawn holds the scene of its time: without a listener there is neither. The scene itself is shown."""
        self.server.replace(sphere('ball', 0.1))
        self.server.distance(LINE)
        self.shown(lambda s: True, 'curves')
        self.subscriber.unregister()
        rospy.sleep(1.0)  # until the node knows
        self.server.distance(LINE)
        self.server.replace(sphere('ball', 0.1), sphere('other', 0.1, (0, 0, 3)))
        del self.arrays[:]
        self.listen()
        self.shown(lambda s: len(s['scene']) == 2, 'scene')
        self.assertFalse([m for m in self.arrays[-1].markers if m.ns == 'curves'])
        self.server.distance(LINE)
        self.shown(lambda s: True, 'curves')

    def test_the_pair_is_the_answers_and_the_curve_has_the_colour_of_its_clearance(self):
        self.server.replace(sphere('ball', 0.25, (0.2, 0, 0.6)))
        row, = self.server.distance(LINE).results
        ends = [row.witness_a, row.witness_b]
        shown = self.shown(lambda s: any(m.points == ends for m in s['pairs']), 'pairs', 'labels', 'curves')
        line = next(m for m in shown['pairs'] if m.type == Marker.LINE_LIST)
        self.assertEqual(line.points, ends)
        self.assertEqual([m.text for m in shown['labels']], ['100.0 mm'])
        tube = next(m for m in shown['curves'] if m.type == Marker.LINE_STRIP)
        self.assertEqual(tube.scale.x, 0.1)  # as thick as it is
        for p in coordinates(tube.points):
            self.assertAlmostEqual(math.hypot(p[1], p[2] - 1), 0, delta=1e-9)
        # redder where it is nearer than at both ends
        side = [(p.x, c.r / (c.r + c.g + c.b)) for p, c in zip(tube.points, tube.colors)]
        redness = dict(side)
        nearest, first, last = (redness[min(redness, key=lambda x: abs(x - at))] for at in (0.2, -1.0, 1.0))
        self.assertGreater(nearest, first + 0.1)
        self.assertGreater(nearest, last + 0.1)

    def test_a_pair_of_another_scene_is_not_shown(self):
        self.server.replace(sphere('ball', 0.25, (0.2, 0, 0.6)))
        self.server.distance(LINE)
        self.shown(lambda s: len(s['scene']) == 1, 'pairs', 'scene', 'curves')
        self.assertTrue(self.server.apply(sphere('other', 0.1, (0.2, 0, 1.4))).success)
        self.shown(lambda s: len(s['scene']) == 2, 'scene', 'curves')
        self.assertFalse([m for m in self.arrays[-1].markers if m.ns in ('pairs', 'labels')])


if __name__ == '__main__':
    run('markers')
