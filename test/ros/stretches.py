#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Nearest pairs, times of contact and clearance profiles by service, against distances that are computed by hand."""
import copy
import math

import rospy
from curve_proximity.msg import Clearance, Curve
from curve_proximity.srv import (ClearanceProfile, ClearanceProfileRequest, ListViolations, ListViolationsRequest,
                                 NearestPairs, NearestPairsRequest, TimeOfContact, TimeOfContactRequest)
from helpers import Case, Server, bezier, connected, joint_trajectory, query, run, service, sphere, until
from trajectory_msgs.msg import JointTrajectory

EPSILON = 1e-6  # [m] ~epsilon
LINE = bezier((-1, 0, 1), (1, 0, 1))
THROUGH = bezier((-1, 0, 0.1), (1, 0, 0.1))
QUARTER = joint_trajectory(['turn'], [0.0], [math.pi / 2])  # in a second
ONLY = {'objects': ['ball']}  # the arm is not asked about


class Stretches(Case):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        cls.services = {}
        for name, kind in (('nearest_pairs', NearestPairs), ('time_of_contact', TimeOfContact), ('clearance_profile', ClearanceProfile),
                           ('violations', ListViolations)):
            cls.services[name] = service(name, kind)
        assert until(lambda: cls.server.distance([], trajectory=QUARTER).success, 20)

    def setUp(self):
        self.server.replace(sphere('ball', 0.25), sphere('far', 0.1, (0, 0, -3)))

    def pairs(self, asked, **fields):
        return self.services['nearest_pairs'](NearestPairsRequest(query=asked, **fields))

    def contact(self, asked):
        return self.services['time_of_contact'](TimeOfContactRequest(query=asked))

    def profile(self, asked, **fields):
        return self.services['clearance_profile'](ClearanceProfileRequest(query=asked, **fields))

    def violations(self, asked, **fields):
        return self.services['violations'](ListViolationsRequest(query=asked, **fields))

    def good(self, response):
        self.assertTrue(response.success, response.message)
        lists = [name for name in ('profiles', 'violations') if hasattr(response, name)]
        return getattr(response, lists[0] if lists else 'results')

    def test_the_pairs_of_a_curve_come_nearest_first(self):
        rows = self.good(self.pairs(query(LINE, objects=['ball', 'far'])))
        self.assertEqual([row.b for row in rows], ['ball', 'far'])
        self.assertHolds(rows[0].lower, rows[0].upper, 0.75)
        self.assertHolds(rows[1].lower, rows[1].upper, 3.9)
        self.assertAlmostEqual(rows[0].witness_b.z, 0.25, delta=1e-5)
        self.assertTrue(math.isnan(rows[0].t_contact_lower))
        row, = self.good(self.pairs(query(LINE, objects=['ball', 'far']), count=1))
        self.assertEqual(row.b, 'ball')
        row, = self.good(self.pairs(query(LINE, objects=['ball', 'far']), within=1.0))
        self.assertEqual(row.b, 'ball')
        self.assertEqual(self.good(self.pairs(query(LINE, objects=['ball', 'far']), within=0.5)), [])
        rows = self.good(self.pairs(query([LINE, THROUGH], objects=['ball', 'far'])))
        self.assertEqual([(row.b, row.upper == 0.0) for row in rows], [('ball', False), ('far', False), ('ball', True), ('far', False)])

    def test_the_pairs_of_a_robot_are_of_links_and_objects_and_of_links(self):
        rows = self.good(self.pairs(query(trajectory=QUARTER, self_collision=True, **ONLY)))
        kinds = [row.kind for row in rows]
        self.assertEqual(kinds, ['environment'] * kinds.count('environment') + ['self'] * kinds.count('self'))
        environment = {row.a: row for row in rows if row.kind == 'environment'}
        self.assertEqual(set(environment), {'arm', 'base', 'slider'})
        self.assertHolds(environment['arm'].lower, environment['arm'].upper, math.sqrt(0.5) - 0.35)
        self.assertHolds(environment['slider'].lower, environment['slider'].upper, 0.5 - 0.3)
        own = [row for row in rows if row.kind == 'self']
        self.assertEqual([{row.a, row.b} for row in own], [{'arm', 'slider'}])

    def test_contact_is_never_said_too_late(self):
        row, = self.good(self.contact(query(THROUGH, **ONLY)))
        expected = (1.0 - math.sqrt(0.25**2 - 0.1**2)) / 2
        self.assertEqual((row.verdict, row.b), ('violated', 'ball'))
        self.assertLessEqual(row.t_contact_lower, expected + 1e-12)
        self.assertGreaterEqual(row.t, expected - 1e-12)
        self.assertLess(row.t - row.t_contact_lower, 1e-4)
        row, = self.good(self.contact(query(LINE, **ONLY)))
        self.assertEqual((row.verdict, row.t_contact_lower), ('clear', 1.0))

    def test_the_arm_meets_the_post_when_the_chord_says_so(self):
        self.server.replace(sphere('ball', 0.1, (0, 0.5, 0.5)))
        row, other = self.good(self.contact(query(trajectory=QUARTER, self_collision=True)))
        expected = (math.pi / 2 - 2 * math.asin(0.2)) / (math.pi / 2)
        self.assertEqual((row.kind, row.verdict, row.a, row.b), ('environment', 'violated', 'arm', 'ball'))
        self.assertLessEqual(row.t_contact_lower, expected + 1e-9)
        self.assertGreaterEqual(row.t, expected - 1e-9)
        self.assertLess(row.t - row.t_contact_lower, 1e-3)
        self.assertEqual((other.kind, other.verdict, other.t_contact_lower), ('self', 'clear', 1.0))

    def test_a_profile_has_the_least_distance_of_each_interval(self):
        def at(x):
            return math.sqrt(x * x + 1) - 0.25
        for asked in ({'intervals': 4}, {'breaks': [0, 0.25, 0.5, 0.75, 1]}):
            profile, = self.good(self.profile(query(LINE, **ONLY), **asked))
            self.assertEqual((list(profile.t0), list(profile.t1)), ([0, 0.25, 0.5, 0.75], [0.25, 0.5, 0.75, 1]))
            for lower, upper, expected in zip(profile.lower, profile.upper, (at(0.5), 0.75, 0.75, at(0.5))):
                self.assertHolds(lower, upper, expected)
            self.assertTrue(all(a <= t <= b for a, t, b in zip(profile.t0, profile.t, profile.t1)))
            self.assertEqual((set(profile.b), set(profile.converged), profile.link), ({'ball'}, {True}, ''))
            self.assertHolds(profile.summary.lower, profile.summary.upper, 0.75)
            self.assertAlmostEqual(profile.summary.witness_a.z, 1.0, delta=1e-9)
            for t, upper, on_line, on_ball in zip(profile.t, profile.upper, profile.witness_a, profile.witness_b):
                self.assertAlmostEqual(on_line.x, -1 + 2 * t, delta=1e-9)
                self.assertAlmostEqual(math.hypot(on_ball.x, on_ball.y, on_ball.z), 0.25, delta=1e-9)
                self.assertAlmostEqual(math.dist((on_line.x, on_line.y, on_line.z), (on_ball.x, on_ball.y, on_ball.z)), upper, delta=1e-9)
        profile, = self.good(self.profile(query(LINE, **ONLY)))
        self.assertEqual(len(profile.lower), 100)

    def test_clearance_beyond_a_horizon_is_only_bounded(self):
        profile, = self.good(self.profile(query(LINE, **ONLY), horizon=0.8))
        measured = [upper - lower <= EPSILON for lower, upper in zip(profile.lower, profile.upper)]
        self.assertTrue(all(near or lower > 0.8 for near, lower in zip(measured, profile.lower)))
        self.assertTrue(10 < measured.count(True) < 100)
        self.assertRefused(self.profile(query(LINE), horizon=-1.0), 'horizon')

    def assertEnds(self, found, *intervals):
        """found is within delta in just these intervals, and where it is not known it is so for no longer than asked."""
        self.assertEqual(list(found.verdict), ['violated'] * len(intervals))
        for i, (enter, leave) in enumerate(intervals):
            for lower, upper, expected in ((found.enter_lower[i], found.enter_upper[i], enter), (found.leave_lower[i], found.leave_upper[i], leave)):
                self.assertHolds(lower, upper, expected, 1e-4)

    def test_violations_begin_and_end_where_the_distance_says_so(self):
        self.server.replace(sphere('ball', 0.25, (-0.5, 0, 0.1)), sphere('other', 0.1, (0.5, 0, 0.1)))
        found, = self.good(self.violations(query(THROUGH, objects=['ball', 'other']), delta=0.05, resolution=1e-5))
        self.assertEqual((found.summary.verdict, list(found.b)), ('violated', ['ball', 'other']))
        self.assertEqual(list(found.a), [found.summary.a] * 2)
        self.assertEnds(found, (0.1, 0.4), (0.675, 0.825))
        found, = self.good(self.violations(query(LINE, **ONLY), delta=0.05))
        self.assertEqual((found.summary.verdict, list(found.verdict)), ('clear', []))

    def test_violations_of_a_motion(self):
        self.server.replace(sphere('ball', 0.1, (0, 0.5, 0.5)))
        found, = self.good(self.violations(query(trajectory=QUARTER), delta=0.1, resolution=1e-5))
        enter = (math.pi / 2 - 2 * math.asin(0.3)) / (math.pi / 2)
        self.assertEqual((list(found.a), list(found.b)), (['arm'], ['ball']))
        self.assertEnds(found, (enter, 1.0))

    def test_bad_questions_about_violations_are_refused(self):
        self.assertRefused(self.violations(query(LINE, **ONLY), delta=-1.0), 'delta')
        self.assertRefused(self.violations(query(LINE, **ONLY), delta=0.1, resolution=math.nan), 'resolution')
        response = self.violations(query([LINE, bezier((math.nan, 0, 0), (1, 0, 0))], **ONLY), delta=0.1)
        self.assertFalse(response.success)
        self.assertEqual([len(v.verdict) for v in response.violations], [0, 0])
        self.assertEqual(response.violations[0].summary.verdict, 'clear')

    def test_a_profile_for_each_link(self):
        post = sphere('ball', 0.1, (0, 0.5, 0.5))
        self.server.replace(post)
        profiles = self.good(self.profile(query(trajectory=QUARTER, self_collision=True), per_link=True, intervals=10))
        self.assertIn(('environment', 'base'), [(p.summary.kind, p.link) for p in profiles])  # it stands
        profiles = [p for p in profiles if p.link != 'base']
        self.assertEqual([(p.summary.kind, p.link) for p in profiles],
                         [('environment', 'arm'), ('environment', 'slider'), ('self', 'arm'), ('self', 'slider')])
        for i in range(10):
            # the arm's ball comes nearer all the time, the slider goes away
            turn = math.pi / 2 - (i + 1) * math.pi / 20
            arm = max(0.0, math.sin(turn / 2) - 0.2)
            self.assertHolds(profiles[0].lower[i], profiles[0].upper[i], arm)
            slider = math.hypot(i * math.pi / 20, math.sqrt(1.25)) - 0.15
            self.assertHolds(profiles[1].lower[i], profiles[1].upper[i], slider)
            self.assertEqual((profiles[1].a[i], profiles[1].b[i]), ('slider', 'ball'))
        together, own = self.good(self.profile(query(trajectory=QUARTER, self_collision=True), intervals=10))
        self.assertEqual([together.summary.kind, own.summary.kind], ['environment', 'self'])
        for i in range(10):
            self.assertHolds(together.lower[i], together.upper[i], min(profiles[0].upper[i], profiles[1].upper[i]))

    def test_a_profile_comes_as_numbers_that_a_plotter_draws(self):
        self.server.replace(sphere('ball', 0.1, (0, 0.5, 0.5)))
        told = {name: [] for name in ('environment', 'self', 'environment/arm', 'environment/slider', 'self/arm', 'self/slider', 'curve')}
        subscribers = [rospy.Subscriber('/curve_proximity/clearance/' + name, Clearance, messages.append) for name, messages in told.items()]
        motions = rospy.Publisher('/curve_proximity/trajectory', JointTrajectory, queue_size=5)
        curves = rospy.Publisher('/curve_proximity/curve', Curve, queue_size=5)
        self.assertTrue(connected(*subscribers, motions, curves))
        moved = copy.deepcopy(QUARTER)
        moved.header.stamp = rospy.Time(1000, 500000000)
        motions.publish(moved)
        self.assertTrue(until(lambda: all(len(told[name]) == 20 for name in told if name != 'curve'), 10), {k: len(v) for k, v in told.items()})
        arm = told['environment/arm']
        for i in range(10):
            expected = max(0.0, math.sin((math.pi / 2 - (i + 1) * math.pi / 20) / 2) - 0.2)
            for message, t in zip(arm[2 * i:2 * i + 2], (i / 10, (i + 1) / 10)):
                self.assertAlmostEqual(message.t, t, delta=1e-9)
                self.assertAlmostEqual(message.header.stamp.to_sec(), 1000.5 + t, delta=1e-6)
                self.assertHolds(message.lower, message.upper, expected)
                self.assertEqual((message.id, message.a, message.b), ('trajectory', 'arm', 'ball'))
        self.assertEqual({message.b for message in told['self/arm']}, {'slider'})
        for whole, *links in zip(told['environment'], arm, told['environment/slider']):
            self.assertHolds(whole.lower, whole.upper, min(link.upper for link in links))

        curves.publish(LINE)
        self.assertTrue(until(lambda: len(told['curve']) == 20, 10))
        self.assertGreater(told['curve'][0].header.stamp, rospy.Time(1000))  # the curve has no stamp: when it came
        for subscriber in subscribers:
            subscriber.unregister()

    def test_what_cannot_be_answered_is_refused_in_one_line(self):
        for ask in (self.pairs, self.contact, self.profile):
            self.assertRefused(ask(query(LINE, per_object=True)), 'per_object')
        self.assertRefused(self.pairs(query(LINE), within=-1.0), 'within')
        self.assertRefused(self.pairs(query(LINE), within=math.nan), 'within')
        self.assertRefused(self.pairs(query(LINE), count=100000), 'max_results')
        self.assertRefused(self.profile(query(LINE), intervals=4000000000), 'max_results')
        self.assertRefused(self.profile(query(LINE), intervals=4, breaks=[0, 1]), 'intervals or breaks')
        self.assertRefused(self.profile(query(LINE), breaks=[0.5]), 'breaks')
        self.assertRefused(self.profile(query(LINE), per_link=True), 'per_link')

        # of one curve: the others are answered
        bad = bezier((0, 0, 0), (math.nan, 0, 0))
        for response in (self.pairs(query([bad, LINE], **ONLY)), self.contact(query([bad, LINE], **ONLY))):
            self.assertRefused(response, '1 of 2 rows', 'not finite')
            self.assertEqual([row.status for row in response.results], ['invalid', 'ok'])
        for breaks in ([0, 2], [0.5, 0.5], [0, math.nan]):
            response = self.profile(query(LINE, **ONLY), breaks=breaks)
            self.assertRefused(response, '1 of 1 rows')
            profile, = response.profiles
            self.assertEqual((profile.summary.status, list(profile.lower)), ('invalid', []))
        response = self.profile(query([bad, LINE], **ONLY), intervals=3)
        self.assertEqual([(p.summary.status, len(p.lower)) for p in response.profiles], [('invalid', 0), ('ok', 3)])

    def test_nothing_to_measure_against_is_said(self):
        self.server.replace()
        row, = self.good(self.contact(query(trajectory=QUARTER)))
        self.assertEqual((row.verdict, row.status, row.upper, row.b), ('undecided', 'empty', math.inf, ''))
        response = self.pairs(query(trajectory=QUARTER))
        self.assertTrue(any('against nothing' in warning for warning in response.warnings), response.warnings)
        profile, = self.good(self.profile(query(trajectory=QUARTER), intervals=2))
        self.assertEqual((list(profile.lower), list(profile.b)), ([0] * 2, [''] * 2))


if __name__ == '__main__':
    run('stretches')
