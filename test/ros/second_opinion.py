#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""With ~second_opinion another library measures each row's pair again; disagreement is logged once a pair, and counted."""
import os
import tempfile

import rospy
from curve_proximity.msg import Body
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from helpers import Case, Server, bezier, body, heard, run, sphere, status_of, thing, until
from rosgraph_msgs.msg import Log

LINE = bezier((-1, 0, 1), (1, 0, 1), id='line')
FACET = 'facet normal 0 0 1\nouter loop\nvertex -1 -1 {z}\nvertex 1 -1 {z}\nvertex 0 1 {z}\nendloop\nendfacet\n'


class SecondOpinion(Case):
    @classmethod
    def setUpClass(cls):
        cls.server, cls.seen, cls.lines = Server(), heard('/diagnostics', DiagnosticArray), []
        log = rospy.Subscriber('/rosout', Log, lambda line: cls.lines.append((line.level, line.msg)))
        assert until(log.get_num_connections, 8), 'the node has no log'

    def queries(self, condition):
        return status_of(self.seen, 'queries', lambda _, values: condition(values))

    def asked(self):
        return self.row(self.server.distance(LINE))

    def test_1_rows_say_that_it_agrees(self):
        self.server.replace(sphere('ball', 0.25))
        row = self.asked()
        self.assertEqual((row.second_opinion, row.message), ('agrees', ''))
        self.assertAlmostEqual(row.second_distance, 0.75, delta=1e-5)
        _, values = self.queries(lambda v: int(v['rows with a second opinion']) > 0)
        self.assertEqual(values['second opinions that disagree, ever'], '0')

    def test_2_rows_say_what_it_does_not_know(self):
        self.server.replace(body('odd', 'superquadric', (0.5, 0.5, 0.5, 4, 4, 4)))
        row = self.asked()
        self.assertEqual(row.second_opinion, 'unknown')
        self.assertIn('superquadric', row.message)
        self.assertNotEqual(row.second_distance, row.second_distance)

    def test_3_disagreement_is_told_and_counted(self):
        """The node has read the mesh at z = 0; before the peer reads it the file says z = 0.5."""
        with tempfile.NamedTemporaryFile('w', suffix='.stl', delete=False) as file:
            self.addCleanup(os.remove, file.name)
        for z in (0.0, 0.5):
            with open(file.name, 'w', encoding='ascii') as out:
                out.write('solid s\n' + FACET.format(z=z) + 'endsolid s\n')
            if z == 0.0:
                self.server.replace(thing('sheet', bodies=[Body(type='mesh', resource='file://' + file.name)]))
        row = self.asked()
        self.assertEqual(row.second_opinion, 'disagrees', row.message)
        self.assertAlmostEqual(row.second_distance, 0.5, delta=1e-5)
        self.assertRegex(row.message, r'fcl disagrees: it measures 0\.(5|4999)\S* m at t = \S+, and lower is (1|0\.9999\S*) m; '
                                      r'its accuracy is \S+e-05 m$')
        self.assertAlmostEqual(row.upper, 1.0, delta=1e-5)
        status, _ = self.queries(lambda v: int(v['second opinions that disagree, ever']) > 0)
        self.assertEqual((status.level, status.message),
                         (DiagnosticStatus.WARN, 'second opinions disagree: the log says of what'))
        # Again, and again: one line says the row, the pair, both figures and the accuracy.
        for _ in range(2):
            self.asked()
        self.queries(lambda v: int(v['second opinions that disagree, ever']) == 3)

        def logged():
            return [line for line in list(self.lines) if 'disagrees' in line[1]]
        self.assertTrue(until(logged, 8))
        self.assertEqual(logged(), [(Log.WARN, "'line' and 'sheet': " + row.message)])


if __name__ == '__main__':
    run('second_opinion')
