#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""~evaluate_constraints on the live node: values, gradients, and what wrong requests, providers and parameters come to."""
import math

from curve_proximity.msg import ConstraintQuery
from geometry_msgs.msg import Pose
from helpers import Case, Server, bezier, box, mesh, plane, pose, run, sphere, thing

CURVES = 'curve_proximity/CurveDistance'


def query(*sides, providers=(), name='case', **fields):
    """sides: a, b and the curve."""
    return ConstraintQuery(id=name, providers=list(providers), **dict(zip(('a', 'b', 'curve'), sides)), **fields)


class Constraints(Case):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()

    def ask(self, *cases):
        return self.server.ask('evaluate_constraints', cases=list(cases))

    def rows(self, *cases):
        response = self.succeeded(self.ask(*cases))
        self.assertEqual(response.frame_id, 'world')
        return response.results

    def row(self, *arguments, **fields):
        row, = self.rows(query(*arguments, **fields))
        return row

    def refused(self, *arguments, **fields):
        response = self.ask(query(*arguments, **fields))
        self.assertFalse(response.success)
        self.assertEqual(response.results[0].status, 'invalid')
        self.assertTrue(math.isnan(response.results[0].value))
        self.assertIn(response.results[0].message, response.message)
        return response.results[0].message

    def test_a_curve_has_a_value_an_interval_and_gradients_by_its_points_and_by_the_pose(self):
        line = bezier((-1, 0, 1), (3, 0, 1), radius=0.1)
        row = self.row(b=sphere('', 0.25, (1, 0, 0)), curve=line, providers=[CURVES])
        self.assertAlmostEqual(row.value, 0.65, delta=1e-8)
        self.assertHolds(row.lower, row.upper, 0.65, math.inf, 1e-15)
        self.assertTrue(row.valid, row.message)
        self.assertAlmostEqual(row.t, 0.5, delta=1e-6)
        self.assertEqual([round(v.z, 6) for v in row.gradient_points], [0.5, 0.5])
        self.assertAlmostEqual(row.gradient_radius, -1.0)
        self.assertAlmostEqual(row.gradient_b.linear.z, -1.0, delta=1e-6)
        self.assertAlmostEqual(row.gradient_a.linear.z, 1.0, delta=1e-6)
        self.assertAlmostEqual(row.witness_b.z, 0.25, delta=1e-6)

    def test_a_body_rides_a_curve(self):
        row = self.row(a=box('', (0.2, 0.2, 0.4)), b=sphere('', 0.25, (1, 0, 0)), curve=bezier((-1, 0, 1), (3, 0, 1)),
                       providers=[CURVES])
        self.assertAlmostEqual(row.value, 0.55, delta=1e-6)

    def test_objects_of_the_scene_are_named_and_may_be_placed_elsewhere(self):
        self.server.replace(sphere('ball', 0.25, (1, 0, 0)), box('shelf', (1, 1, 1), (0, 9, 0), padding=0.1))
        row = self.row(a=sphere('', 0.25, (0, 0, 0)), b=thing('ball', (0, 0, 0)), providers=['pairs'])
        self.assertLess(row.value, 0.0)  # placed at the origin by the request
        row = self.row(a=sphere('', 0.25, (3, 0, 0)), b=thing('ball', pose=Pose()), providers=['pairs'])
        self.assertAlmostEqual(row.value, 1.5, delta=1e-8)
        row = self.row(b=thing('shelf', pose=Pose()), curve=bezier((-1, 7, 0), (1, 7, 0)), providers=[CURVES])
        self.assertAlmostEqual(row.value, 1.4, delta=1e-8)

    def test_what_is_fitted_has_an_interval_round_the_true_distance(self):
        row = self.row(a=box('', (0.4, 0.4, 0.4)), b=box('', (0.6, 0.6, 0.6), (2, 0, 0)), providers=['pairs'])
        self.assertHolds(row.lower, row.upper, 1.5, math.inf, 0)
        self.assertLess(row.lower, row.value + 1e-12)

    def test_a_gap_says_clear_only_where_it_is(self):
        far, near = self.rows(query(sphere('', 0.3), box('', (0.5, 0.5, 0.5), (0.9, 0, 0)), providers=['gap']),
                              query(sphere('', 0.3), box('', (0.5, 0.5, 0.5), (0.4, 0, 0)), providers=['gap']))
        self.assertLess(near.value, 0.0)
        self.assertGreater(far.value, near.value)
        self.assertGreater(near.gradient_b.linear.x, 0.0)
        self.assertLess(near.gradient_a.linear.x, 0.0)
        self.assertTrue(math.isnan(near.witness_a.x))

    def test_a_provider_of_another_package_is_asked_like_ours(self):
        row = self.row(sphere('', 0.5, (0, 0, 0)), sphere('', 0.5, (0, 3, 0)), providers=['balls'])
        self.assertAlmostEqual(row.value, 1.75, delta=1e-12)
        self.assertTrue(math.isnan(row.lower))
        self.assertAlmostEqual(row.gradient_b.linear.y, 1.0)

    def test_without_names_those_that_apply_are_asked_and_those_that_fail_do_not_spoil_the_others(self):
        response = self.ask(query(sphere('', 0.5), sphere('', 0.5, (0.6, 2, 0))))
        self.assertFalse(response.success)
        rows = {row.provider: row for row in response.results}
        self.assertEqual(len(rows), 7)
        truth = math.hypot(0.6, 2) - 1.0
        self.assertAlmostEqual(rows['pairs'].value, truth, delta=1e-8)
        self.assertAlmostEqual(rows['balls'].value, truth - 0.25, delta=1e-12)
        self.assertEqual(rows['gap'].status, 'ok')
        self.assertNotIn(CURVES, rows)
        self.assertIn("provider 'at_start' failed to load", rows['at_start'].message)
        self.assertIn('no exception', rows['at_start'].message)
        self.assertIn('no exception', rows['when_asked'].message)
        self.assertIn("provider 'other_headers' failed to load", rows['other_headers'].message)
        self.assertIn("built against this version of curve_proximity/constraint_provider.hpp", rows['other_headers'].message)
        self.assertIn("provider 'no_library' failed to load", rows['no_library'].message)
        self.assertIn('4 of 7 rows failed', response.message)

    def test_wrong_cases_are_told_by_name_and_the_others_are_answered(self):
        good = query(sphere('', 0.5), sphere('', 0.5, (0, 3, 0)), providers=['pairs'], name='good')
        bad = query(sphere('', -0.5), sphere('', 0.5), providers=['pairs'], name='bad')
        response = self.ask(good, bad, good)
        self.assertRefused(response, "case 1 ('bad')")
        self.assertEqual([row.status for row in response.results], ['ok', 'invalid', 'ok'])
        self.assertIn('a: shape 0: sphere', response.results[1].message)

        ball = sphere('', 0.5)
        self.assertIn("no provider 'nobody'", self.refused(ball, ball, providers=['nobody']))
        self.assertIn("no object 'ghost'", self.refused(ball, thing('ghost'), providers=['pairs']))
        self.assertIn('no shape', self.refused(ball, providers=['pairs']))
        self.assertIn('nowhere', self.refused(sphere('', 0.5, frame='nowhere'), ball, providers=['pairs']))
        self.assertIn('halfspace', self.refused(ball, plane('', (0, 0, 1, 0)), providers=['gap']))
        self.assertIn('identity', self.refused(sphere('', 0.5, (1, 0, 0)), ball, bezier((0, 0, 1), (1, 0, 1)), providers=[CURVES]))
        self.assertIn('basis', self.refused(b=ball, curve=bezier((0, 0, 1), (1, 0, 1), basis='catmull'), providers=[CURVES]))
        self.assertIn('finite', self.refused(ball, sphere('', 0.5, (float('nan'), 0, 0)), providers=['pairs']))
        self.assertIn('padding', self.refused(ball, sphere('', 0.5, padding=-1.0), providers=['pairs']))
        self.assertIn('norm is 0', self.refused(ball, sphere('', 0.5, pose=pose((1, 0, 0), (0, 0, 0, 0))), providers=['pairs']))
        self.assertIn('triangle', self.refused(ball, mesh('', [(0, 0, 0)], [(0, 1, 2)]), providers=['pairs']))

    def test_more_than_the_limits_is_refused(self):
        ball = sphere('', 0.5)
        self.assertRefused(self.ask(*[query(ball, ball, providers=['pairs'])] * 1001), '~max_curves')
        self.assertEqual(self.ask().results, [])

    def test_many_cases_of_one_pair_are_answered_in_one_call(self):
        rows = self.rows(*[query(box('', (0.4, 0.5, 0.6)), box('', (0.3, 0.3, 0.3), (0.3 + 0.001 * i, 0, 0)), providers=['gap'])
                           for i in range(500)])
        self.assertEqual(len(rows), 500)
        self.assertTrue(all(row.status == 'ok' for row in rows))


class WrongProviders(Case):
    def test_each_stops_the_node_which_names_the_parameter(self):
        gap = 'curve_proximity/FourierGap'
        cases = [('all of them', '~constraint_providers: a list'),
                 ([7], '~constraint_providers[0]'),
                 ([CURVES, 'curve_proximity/Nonsense'], "~constraint_providers[1] ('curve_proximity/Nonsense')"),
                 ([CURVES, CURVES], 'given twice'),
                 ([{'name': 'x'}], '~constraint_providers[0]: type'),
                 ([{'name': 3, 'type': gap}], '~constraint_providers[0]: name'),
                 ([{'type': gap, 'parameter': {}}], '~constraint_providers[0]: parameter'),
                 ([{'type': gap, 'parameters': 'fast'}], '~constraint_providers[0]: parameters'),
                 ([{'type': gap, 'parameters': {'mode': 'fast'}}], 'parameter mode'),
                 ([{'type': gap, 'parameters': {'samples': 'many'}}], 'parameter samples: a whole number'),
                 ([{'type': gap, 'parameters': {'samples': [1, 'two']}}], 'parameter samples: a list holds numbers alone'),
                 ([{'type': gap, 'parameters': {'sample': 9}}], 'parameter sample: there is no such parameter'),
                 ([{'name': 'mine', 'type': 'example_provider/Balls', 'parameters': {'margin': -1}}],
                  "~constraint_providers[0] ('mine'): parameter margin: -1 is not at least 0")]
        for providers, word in cases:
            with self.subTest(providers=providers):
                self.assertIn(word, self.stopped(constraint_providers=providers))

    def test_a_plugin_that_fails_is_told_by_name_and_the_node_serves(self):
        node, server = self.begin('faulty', constraint_providers=[{'name': 'mine', 'type': 'faulty_provider/NoLibrary'}])
        self.assertTrue(server.scene().success)
        self.assertIn("constraint provider 'mine' (faulty_provider/NoLibrary) failed to load", node.output())

    def test_without_providers_the_service_says_so(self):
        _, server = self.begin('bare', constraint_providers=[])
        self.assertRefused(server.ask('evaluate_constraints', cases=[query()]), '~constraint_providers')


if __name__ == '__main__':
    run('constraints')
