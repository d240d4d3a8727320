# SPDX-License-Identifier: BSD-3-Clause
"""The reference answers, asked through the command line."""
import csv
import glob

import reference_to_inputs
from support import DATA, Case, cprox

COUNTS = {'curve_point': 113, 'curve_polygon': 102, 'curve3d': 100, 'curve3d-box': 60, 'edge': 40}


class Reference(Case):
    """Every interval contains the reference and is no wider than 1e-9 max(1, largest coordinate), or the status says
    precision. The reference was computed in long double and rounded to a double: it counts within 4 of its last places and
    within the slack that reference_to_inputs.py works out (long double's rounding, and that of quaternions)."""

    def setUp(self):
        super().setUp()
        reference_to_inputs.convert(DATA + '/reference', self.folder)

    def check(self, row, reference, slack, epsilon):
        lower, upper = float(row['lower']), float(row['upper'])
        slack += 4 * 2.0**-52 * abs(reference)
        self.assertLessEqual(lower, reference + slack, row)
        self.assertGreaterEqual(upper, reference - slack, row)
        if row['status'] != 'precision':
            self.assertEqual(row['status'], 'ok', row)
            self.assertLessEqual(upper - lower, epsilon, row)

    def check_file(self, name):
        """Asks all batches of one file; every row of the file must have been seen."""
        seen = 0
        for folder in glob.glob(f'{self.folder}/{name}-[0-9]*'):
            with open(folder + '/epsilon') as text:
                epsilon = float(text.read())
            answer = cprox('distance', '--curves', folder + '/curves.csv', '--scene', folder + '/scene.yaml', '--per-object',
                           '--epsilon', repr(epsilon))
            self.assertEqual((answer.code, answer.err), (0, ''))
            with open(folder + '/expected.csv', newline='') as text:
                for expected in csv.DictReader(text):
                    with self.subTest(id=expected['id']):
                        self.check(answer.row(expected['id'], expected['id']), float(expected['d_ref']), float(expected['slack']), epsilon)
                    seen += 1
        self.assertEqual(seen, COUNTS[name])

    def points(self):
        self.check_file('curve_point')

    def polygons(self):
        self.check_file('curve_polygon')

    def boxes_as_hulls(self):
        self.check_file('curve3d')

    def boxes_as_boxes(self):
        self.check_file('curve3d-box')

    def hard_cases(self):
        self.check_file('edge')

    def static_pairs_that_are_apart(self):
        with open(self.folder + '/static_pairs/expected.csv', newline='') as text:
            expected = [row for row in csv.DictReader(text) if row['kind'] == 'sep']
        self.assertEqual(len(expected), 19)
        answer = cprox('pairs', '--in', self.folder + '/static_pairs/pairs.yaml', '--epsilon', '1e-9')
        self.assertEqual((answer.code, answer.err), (0, ''))
        for row in expected:
            with self.subTest(id=row['id']):
                found, slack = answer.row(row['id']), float(row['slack'])
                if found['status'] == 'overlap':
                    # nearer than what writing the pose with a quaternion may move it: both answers are true ones
                    self.assertLessEqual(float(row['d_ref']), slack, found)
                    self.assertEqual(float(found['upper']), 0.0)
                    continue
                self.check(found, float(row['d_ref']), slack, 1e-9 * max(1.0, float(row['scale'])))

    def static_pairs_that_overlap_are_never_called_apart(self):
        with open(self.folder + '/static_pairs/expected.csv', newline='') as text:
            expected = [row for row in csv.DictReader(text) if row['kind'] == 'pen']
        answer = cprox('pairs', '--in', self.folder + '/static_pairs/pairs.yaml', '--epsilon', '1e-9')
        for row in expected:
            with self.subTest(id=row['id']):
                self.assertLessEqual(float(answer.row(row['id'])['lower']), float(row['d_ref']) + float(row['slack']) + 1e-15)
