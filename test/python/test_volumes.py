#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a robot passes through, and which of its links can touch, beside samples in time and in joint values."""
import math
import os
import tempfile
import unittest

import numpy

import cprox

# A rod of 1 mm that turns about z, .1 to .9 m from the axis, and a drum that it passes by.
ROD = ('<robot name="r"><link name="drum"><collision><geometry><cylinder radius="0.05" length="0.2"/></geometry></collision></link>'
       '<link name="rod"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.001 0.001"/></geometry></collision></link>'
       '<joint name="turn" type="revolute"><parent link="drum"/><child link="rod"/><axis xyz="0 0 1"/>'
       '<limit lower="-3" upper="3" effort="1" velocity="1"/></joint></robot>')
ANGLE, RESOLUTION = 2.0, 0.01


def keys(cells):
    """A number for each cell of a few metres."""
    return ((cells[:, 0] + 1000) * 2000 + cells[:, 1] + 1000) * 2000 + cells[:, 2] + 1000


def cells_at(angles, along):
    """The cells of points of the rod's middle line at these angles."""
    x, y = numpy.outer(numpy.cos(angles), along).ravel(), numpy.outer(numpy.sin(angles), along).ravel()
    return numpy.unique(keys(numpy.floor(numpy.stack([x, y, numpy.full_like(x, 1e-4)], 1) / RESOLUTION).astype(int)))


class Volumes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        path = os.path.join(cls.folder.name, 'rod.urdf')
        with open(path, 'w') as out:
            out.write(ROD)
        cls.robot = cprox.Robot.from_urdf(path)
        cls.motion = cprox.Motion(cprox.Scene(cls.robot), ['turn'], [0.0, 1.0], [[0.0], [ANGLE]])
        cls.volume = cls.motion.sweep(RESOLUTION, links=['rod'])

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_thin_link_is_not_lost_where_samples_in_time_lose_it(self):
        passed = cells_at(numpy.linspace(0, ANGLE, 4001), numpy.linspace(0.1, 0.9, 801))
        self.assertTrue(numpy.isin(passed, keys(self.volume.cells.astype(int))).all())
        for samples, least in ((20, 0.7), (50, 0.4), (100, 0.1)):  # states of the motion, with a point every millimetre
            seen = cells_at(numpy.linspace(0, ANGLE, samples), numpy.linspace(0.1, 0.9, 801))
            self.assertGreater(1 - len(seen) / len(passed), least, samples)

    def test_no_cell_is_farther_than_the_gap_from_what_the_rod_passes_through(self):
        # the rod passes through a sector of a ring of 1 mm
        corners = self.volume.cells[:, None, :] + numpy.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
        x, y, z = numpy.moveaxis(corners * RESOLUTION, -1, 0)
        radius, angle = numpy.hypot(x, y), numpy.arctan2(y, x)
        aside = radius * numpy.maximum(0, numpy.maximum(-angle, angle - ANGLE))
        beyond = numpy.maximum(0, numpy.maximum(0.1 - radius, radius - 0.9))
        away = numpy.sqrt(aside ** 2 + beyond ** 2 + numpy.maximum(0, abs(z) - 5e-4) ** 2) - 1e-3
        self.assertLessEqual(away.max(), self.volume.gap)
        self.assertLess(self.volume.gap, 2.3 * RESOLUTION)

    def test_links_and_threads(self):
        whole = self.motion.sweep(RESOLUTION)
        self.assertGreater(len(whole.cells), len(self.volume.cells))
        drum = self.motion.sweep(RESOLUTION, links=['drum'])
        numpy.testing.assert_array_equal(numpy.unique(keys(whole.cells.astype(int))), numpy.union1d(
            keys(self.volume.cells.astype(int)), keys(drum.cells.astype(int))))
        numpy.testing.assert_array_equal(self.motion.sweep(RESOLUTION, links=['rod'], threads=1).cells, self.volume.cells)
        with self.assertRaisesRegex(ValueError, "no link 'rodd'.*'rod'"):
            self.motion.sweep(RESOLUTION, links=['rodd'])
        for wrong, why in ((0, 'resolution'), (-1, 'resolution'), (math.nan, 'resolution'), (1e-9, 'GB')):
            with self.assertRaisesRegex((ValueError, MemoryError), why):
                self.motion.sweep(wrong)

    def test_what_is_inside_is_filled_and_files_have_the_same_cells(self):
        volume = self.motion.sweep(RESOLUTION, inside=True, links=['drum'])
        middles = (volume.cells + 0.5) * RESOLUTION
        depth = numpy.minimum(0.05 - numpy.hypot(middles[:, 0], middles[:, 1]), 0.1 - abs(middles[:, 2]))
        half = RESOLUTION * math.sqrt(3) / 2
        self.assertTrue((depth[volume.inside] >= half).all())
        self.assertTrue(volume.inside[depth >= 1.01 * half].all())
        self.assertGreater(volume.inside.sum(), 100)
        self.assertTrue(volume.to_octomap().startswith(b'# Octomap OcTree binary file'))
        self.assertEqual((len(volume.to_stl()) - 84) % 50, 0)
        self.assertLess(len(volume.to_stl(inside_only=True)), len(volume.to_stl()))

    def test_a_cover_is_an_obstacle_of_a_scene(self):
        # is a ball beside the robot's way free of it for the whole motion?
        path = os.path.join(self.folder.name, 'swept.bt')
        with open(path, 'wb') as out:
            out.write(self.volume.to_octomap())
        scene = cprox.Scene()
        scene.add('swept', 'octree', resource=path)
        for angle in numpy.linspace(0.1, ANGLE - 0.1, 9):
            at = numpy.array([0.6 * math.cos(angle), 0.6 * math.sin(angle), 0.0])
            for height, verdict in ((0.04, 'violated'), (0.05 + 1e-3 + self.volume.gap, 'clear')):
                curve = cprox.bezier([at + [0, 0, height], at + [0, 0, height + 1e-3]])
                self.assertEqual(scene.collision(curve, radius=0.05)['result'].verdict, verdict, (angle, height))

    def test_pairs_of_links_agree_with_samples(self):
        pair, = self.robot.collision_matrix()
        self.assertEqual((pair['a'], pair['b'], pair['contact'], pair['adjacent']), ('drum', 'rod', 'never', True))
        self.assertGreater(pair['lower'], 0)
        self.assertLessEqual(pair['lower'], 0.05)
        with self.assertRaisesRegex(ValueError, "no link 'drums'"):
            self.robot.collision_matrix(links=['drums'])


if __name__ == '__main__':
    outcome = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromModule(__import__('__main__')))
    failed = len(outcome.failures) + len(outcome.errors)
    print(f'{outcome.testsRun - failed} passed, {failed} failed')
    raise SystemExit(failed > 0 or outcome.testsRun == 0)
