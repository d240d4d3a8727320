#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the markers hold: where their points are is computed here anew. What robots look like: demo.py."""
import math
import unittest

import rospy
from curve_proximity.msg import Body, Octree
from helpers import Drawings, Server, bezier, body, run, sphere, thing
from visualization_msgs.msg import Marker

LINE = bezier((-1, 0, 1), (1, 0, 1), id='line', radius=0.05)


def coordinates(points):
    return [(p.x, p.y, p.z) for p in points]


class Markers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server, cls.drawn = Server(), Drawings()

    def test_an_octree_is_its_occupied_cells(self):
        # two cells of 0.5 m beside each other at the origin's corner, and a block of 1 m: all eight children of its parent
        one = b'\x00\xc0' + b'\x03\x00' * 14
        for leaf, sizes in ((b'\x0a\x00', {0.5: [(0.25, 0.25, 0.25), (0.75, 0.25, 0.25)]}), (b'\xaa\xaa', {1.0: [(0.5, 0.5, 0.5)]})):
            tree = Octree(binary=True, id='OcTree', resolution=0.5, data=list(memoryview(one + leaf).cast('b')))
            self.server.replace(thing('map', bodies=[Body(type='octree', octree=tree)]))
            shown = self.drawn.shown(lambda s: {(m.type, m.scale.x) for m in s['scene']} == {(Marker.CUBE_LIST, x) for x in sizes}, 'scene')['scene']
            for marker in shown:
                self.assertEqual(marker.type, Marker.CUBE_LIST)
                self.assertEqual(sorted(coordinates(marker.points)), sizes[marker.scale.x])
                self.assertEqual(marker.scale.x, marker.scale.z)
                self.assertEqual(len(marker.colors), len(marker.points))

    def test_a_superquadric_is_its_surface(self):
        axes, exponents = (0.2, 0.3, 0.5), (2.0, 4.0, 6.0)
        self.server.replace(body('can', 'superquadric', (*axes, *exponents)))
        marker, = self.drawn.shown(lambda s: s['scene'][0].type == Marker.TRIANGLE_LIST, 'scene')['scene']
        self.assertEqual(marker.header.frame_id, 'world')
        self.assertGreater(len(marker.points), 1000)
        for p in coordinates(marker.points):
            value = sum(abs(x / a)**n for x, a, n in zip(p, axes, exponents))
            self.assertAlmostEqual(value, 1.0, delta=1e-9)

    def test_nothing_is_kept_for_who_comes_later(self):
        """What is drawn holds the scene of its time: without a listener there is neither. The scene itself is shown."""
        self.server.replace(sphere('ball', 0.1))
        self.server.distance(LINE)
        self.drawn.shown(lambda s: True, 'curves')
        self.drawn.subscriber.unregister()
        rospy.sleep(1.0)  # until the node knows
        self.server.distance(LINE)
        self.server.replace(sphere('ball', 0.1), sphere('other', 0.1, (0, 0, 3)))
        type(self).drawn = Drawings()
        self.drawn.shown(lambda s: len(s['scene']) == 2, 'scene')
        self.assertFalse([m for m in self.drawn.arrays[-1].markers if m.ns == 'curves'])
        self.server.distance(LINE)
        self.drawn.shown(lambda s: True, 'curves')

    def test_the_pair_is_the_answers_and_the_curve_has_the_colour_of_its_clearance(self):
        self.server.replace(sphere('ball', 0.25, (0.2, 0, 0.6)))
        row, = self.server.distance(LINE).results
        ends = [row.witness_a, row.witness_b]
        shown = self.drawn.shown(lambda s: any(m.points == ends for m in s['pairs']), 'pairs', 'labels', 'curves')
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
        self.drawn.shown(lambda s: len(s['scene']) == 1, 'pairs', 'scene', 'curves')
        self.assertTrue(self.server.apply(sphere('other', 0.1, (0.2, 0, 1.4))).success)
        self.drawn.shown(lambda s: len(s['scene']) == 2, 'scene', 'curves')
        self.assertFalse([m for m in self.drawn.arrays[-1].markers if m.ns in ('pairs', 'labels')])


if __name__ == '__main__':
    run('markers')
