#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The Python client against the live node, and its example."""
from curve_proximity_client import Client, Failure, bezier, body, box, bspline, sphere
from helpers import Case, Node, run

LINE = bezier([(0, 0, 1), (2, 0, 1)], id='line')


class PythonClient(Case):
    @classmethod
    def setUpClass(cls):
        cls.client = Client(patience=20.0)

    def setUp(self):
        self.client.clear()

    def test_the_three_queries_have_answers(self):
        self.client.add(sphere('ball', 0.25, (1, 0, 0)), box('far', (1, 1, 1), (0, 9, 0)))
        row = self.client.distance(LINE, epsilon=1e-9)
        self.assertLessEqual(row.lower, 0.75)
        self.assertGreaterEqual(row.upper, 0.75)
        self.assertEqual((row.id, row.b), ('line', 'ball'))
        self.assertEqual(self.client.tolerance(LINE, 0.7).verdict, 'clear')
        self.assertTrue(self.client.is_clear(LINE, 0.74))
        self.assertFalse(self.client.is_clear(LINE, 0.75))
        self.assertEqual(self.client.collision(LINE).verdict, 'clear')
        both = self.client.distance([LINE, bspline([(0, 5, 0), (0, 6, 0), (0, 7, 0), (0, 8, 0)])])
        self.assertEqual([r.b for r in both], ['ball', 'far'])

    def test_contacts_pairs_and_profiles_have_answers(self):
        self.client.add(sphere('ball', 0.25, (1, 0, 0)), sphere('far', 0.5, (0, 0, 3)))
        row = self.client.time_of_contact(bezier([(0, 0, 0), (2, 0, 0)]), epsilon=1e-9)
        self.assertEqual(row.verdict, 'violated')
        self.assertLessEqual(row.t_contact_lower, 0.375)
        self.assertAlmostEqual(row.t, 0.375, delta=1e-6)
        self.assertEqual([pair.b for pair in self.client.nearest_pairs(LINE)], ['ball', 'far'])
        self.assertEqual([pair.b for pair in self.client.nearest_pairs(LINE, count=1)], ['ball'])
        self.assertEqual([pair.b for pair in self.client.nearest_pairs(LINE, within=1.0)], ['ball'])
        profile = self.client.clearance_profile(LINE, intervals=4)
        self.assertEqual(list(profile.t0), [0.0, 0.25, 0.5, 0.75])
        self.assertAlmostEqual(profile.upper[1], 0.75, delta=1e-5)
        self.assertEqual(profile.b[0], 'ball')
        self.assertEqual(len(self.client.clearance_profile([LINE, LINE], breaks=(0.0, 0.1, 1.0))[1].lower), 2)
        gradient = self.client.gradient(bezier([(0, 0, 1), (2, 0, 1.5)]), objects=['ball'])
        self.assertTrue(gradient.valid, gradient.message)
        self.assertAlmostEqual(sum(point.z for point in gradient.points), gradient.moving.linear.z, delta=1e-9)
        with self.assertRaises(Failure):
            self.client.distance(LINE, count=3)

    def test_objects_come_and_go(self):
        self.client.add(sphere('ball', 0.25), body('egg', 'ellipsoid', (0.1, 0.2, 0.3), (1, 0, 0)))
        self.client.remove('ball')
        self.assertEqual(self.client.distance(LINE).b, 'egg')
        self.client.clear()
        self.assertEqual(self.client.distance(LINE).upper, float('inf'))

    def test_constraints_have_values_and_gradients(self):
        self.client.add(sphere('ball', 0.25, (1, 0, 0)))
        value = self.client.constraint('curve_proximity/CurveDistance', 'ball', curve=LINE)
        self.assertAlmostEqual(value.value, 0.75, delta=1e-8)
        self.assertAlmostEqual(value.gradient_points[0].z, 0.5, delta=1e-4)
        value = self.client.constraint('curve_proximity/SuperquadricDistance', 'ball', sphere('', 0.5, (1, 2, 0)))
        self.assertAlmostEqual(value.value, 1.25, delta=1e-8)

    def test_what_is_refused_is_an_exception_with_the_nodes_message(self):
        for work, word in ((lambda: self.client.distance(bezier([(0, 0, 0)])), 'curve 0'),
                           (lambda: self.client.add(sphere('bad', -1.0)), "object 'bad'"),
                           (lambda: self.client.constraint('nobody', sphere('', 0.1), curve=LINE), "'nobody'"),
                           (lambda: bspline([(0, 0, 0)]), 'needs 4 points'),
                           (lambda: Client('/nowhere', patience=0.3).clear(), '/nowhere/apply_scene')):
            with self.assertRaises(Failure) as caught:
                work()
            self.assertIn(word, str(caught.exception))

    def test_a_restarted_node_is_found_again(self):
        client = Client('/mortal', patience=20.0)
        node = Node('mortal')
        try:
            client.add(sphere('ball', 0.25))
            node.end()
            node = Node('mortal')
            self.assertEqual(client.distance(LINE).b, '')  # the new one knows no ball
        finally:
            node.end()

    def test_the_example_runs(self):
        said = self.output_of('client.py')
        self.assertIn('yes, proven', said)
        self.assertIn('to ball at t', said)
        self.assertEqual(said.count('\n'), 8, said)

    def test_each_provider_is_climbed_to_a_proof(self):
        said = self.output_of('client_constraints.py')
        self.assertEqual(said.count(': proven after'), 3, said)


if __name__ == '__main__':
    run('python_client')
