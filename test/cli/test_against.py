# SPDX-License-Identifier: BSD-3-Clause
"""Curves against curves, row by row."""
import csv

from support import DATA, Case, bezier, cprox

LINE = bezier('line', (0, 0, 0), (4, 0, 0))
ABOVE = bezier('above', (1, -1, 2), (1, 1, 2), t0=10, t1=12)


class Against(Case):
    def against(self, query_type, first, second, *more):
        a, b = self.file('a.csv', '\n'.join(first) + '\n'), self.file('b.csv', '\n'.join(second) + '\n')
        return cprox(query_type, '--curves', a, '--against', b, *more)

    def a_pair_has_both_parameters_and_both_points(self):
        answer = self.against('distance', [LINE], [ABOVE])
        self.assertEqual((answer.code, answer.err), (0, ''))
        row = answer.row('line')
        self.assertEqual((row['kind'], row['a'], row['b'], row['status'], row['verdict']), ('curve_curve', 'line', 'above', 'ok', ''))
        self.assertLessEqual(float(row['lower']), 2)
        self.assertGreaterEqual(float(row['upper']), 2)
        for name, value in (('t', 0.25), ('t_b', 11), ('a_x', 1), ('a_z', 0), ('b_y', 0), ('b_z', 2)):
            self.assertAlmostEqual(float(row[name]), value, places=4)

    def radii_of_both_count(self):
        answer = self.against('distance', [bezier('a', (0, 0, 0), (4, 0, 0), radius=0.5)], [bezier('b', (1, -1, 2), (1, 1, 2), radius=0.25)])
        self.assertAlmostEqual(float(answer.row('a')['upper']), 1.25, places=9)

    def verdicts_are_given(self):
        self.assertEqual(self.against('tolerance', [LINE], [ABOVE], '--delta', '1.99').row('line')['verdict'], 'clear')
        self.assertEqual(self.against('tolerance', [LINE], [ABOVE], '--delta', '2.01').row('line')['verdict'], 'violated')
        thick = bezier('thick', (0, 0, 0), (4, 0, 0), radius=2.5)
        self.assertEqual(self.against('collision', [thick], [ABOVE]).row('thick')['verdict'], 'violated')
        self.assertEqual(self.against('collision', [LINE], [ABOVE]).row('line')['verdict'], 'clear')

    def a_bad_row_of_either_file_is_told_and_the_others_are_answered(self):
        answer = self.against('distance', [LINE, 'bad,bezier,1,0,1,0,2,0,0,0,1,1', LINE], [ABOVE, ABOVE, 'worse,bezier,9'])
        self.assertEqual(answer.code, 2)
        self.assertEqual([row['status'] for row in answer.rows], ['ok', 'invalid', 'invalid'])
        self.assertRegex(answer.err, r"a\.csv: row 2 \(line 2, id 'bad'\)")
        self.assertRegex(answer.err, r"b\.csv: row 3 \(line 3, id 'worse'\)")

    def a_file_that_ends_early_leaves_rows_unanswered(self):
        answer = self.against('distance', [LINE, LINE], [ABOVE])
        self.assertEqual((answer.code, [row['status'] for row in answer.rows]), (2, ['ok', 'invalid']))
        self.assertRegex(answer.err, r"a\.csv: row 2 .*b\.csv: has no row for it")
        answer = self.against('distance', [LINE], [ABOVE, ABOVE])
        self.assertEqual((answer.code, [row['b'] for row in answer.rows]), (2, ['above', 'above']))

    def options_of_scenes_are_refused(self):
        for words in (['--scene', 's'], ['--robot', 'r'], ['--per-object'], ['--max-lod', 'hull']):
            with self.subTest(words=words):
                self.assertRefused(self.against('distance', [LINE], [ABOVE], *words), '--against takes no ' + words[0])

    def reference_answers_lie_in_the_intervals(self):
        """curve_curve: long double's answers, which count within 1e-15 at this scale; answered to 1e-9."""
        first, second, expected = [], [], {}
        with open(DATA + '/reference/curve_curve_ref.csv', newline='') as text:
            for row in csv.reader(text):
                if not row[0].startswith('#'):
                    expected[row[0]] = float(row[1])
        with open(DATA + '/reference/curve_curve_inputs.csv', newline='') as text:
            for row in csv.reader(text):
                if row[0].startswith('#') or row[0] not in expected:
                    continue
                dim, order_a, order_b = int(row[2]), int(row[3]), int(row[4])
                numbers = [float(x) for x in row[5:]]
                points = [tuple(numbers[i:i + dim]) + (0.0,) * (3 - dim) for i in range(0, len(numbers), dim)]
                self.assertEqual(len(points), order_a + order_b + 2)
                first.append(bezier(row[0], *points[:order_a + 1]))
                second.append(bezier('of ' + row[0], *points[order_a + 1:]))
        answer = self.against('distance', first, second, '--epsilon', '1e-9')
        self.assertEqual((answer.code, answer.err), (0, ''))
        self.assertEqual(len(answer.rows), len(expected))
        for row in answer.rows:
            with self.subTest(id=row['id']):
                reference = expected[row['id']]
                self.assertLessEqual(float(row['lower']), reference + 1e-15)
                self.assertGreaterEqual(float(row['upper']), reference - 1e-15)
                self.assertEqual(row['status'], 'ok')
