#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Each service against distances computed by hand; what is wrong is told by name, and the next call is answered."""
import math

from curve_proximity.msg import AllowedContact, Body, CollisionObject, LinkPadding, PairQuery, SceneState
from geometry_msgs.msg import Pose, Vector3
from helpers import (BOX, CONE, CYLINDER, SPHERE, Case, Server, bezier, body, box, bspline, implicit, mesh, plane, point, pose,
                     run, solid, sphere, thing)

EPSILON = 1e-9  # [m] asked for in each query that is compared
ABOVE = bezier((0, 0, 1), (2, 0, 1), id='above')  # a straight line one metre up, middle over (1, 0, 0)


class TestCase(Case):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()

    def setUp(self):
        self.server.replace(sphere('ball', 0.25, (1, 0, 0)))  # 0.75 m below the middle of ABOVE

    def assertContains(self, row, true_distance):
        """The interval contains the true value (to the rounding of the value written here) and is narrow."""
        self.assertHolds(row.lower, row.upper, true_distance, EPSILON, 1e-15)

    def distance(self, curve=ABOVE, **fields):
        return self.row(self.server.distance(curve, epsilon=EPSILON, **fields))


class Answers(TestCase):
    def test_distance_gives_interval_points_parameter_normal_and_the_nearest_object(self):
        self.server.replace(sphere('ball', 0.25, (1, 0, 0)), box('far', (1, 1, 1), (0, 9, 0)))
        response = self.server.distance(ABOVE, epsilon=EPSILON)
        row = self.row(response)
        self.assertContains(row, 0.75)
        self.assertEqual((row.id, row.kind, row.a, row.b, row.status, row.verdict, row.message),
                         ('above', 'curve', 'above', 'ball', 'ok', '', ''))
        self.assertEqual(response.frame_id, 'world')
        self.assertAlmostEqual(row.t, 0.5, delta=1e-4)
        for value, expected in ((row.witness_a, (1, 0, 1)), (row.witness_b, (1, 0, 0.25)), (row.normal, (0, 0, 1))):
            for got, want in zip((value.x, value.y, value.z), expected):
                self.assertAlmostEqual(got, want, delta=2e-4)
        self.assertGreater(row.distance_queries, 0)
        self.assertGreater(row.microseconds, 0)

    def test_tolerance_is_granted_below_the_distance_and_denied_above(self):
        self.assertEqual(self.row(self.server.tolerance(ABOVE, 0.7499)).verdict, 'clear')
        self.assertEqual(self.row(self.server.tolerance(ABOVE, 0.7501)).verdict, 'violated')
        self.assertIn(self.row(self.server.tolerance(ABOVE, 0.75)).verdict, ('violated', 'undecided'))

    def test_collision_tells_a_hit_from_a_miss(self):
        self.assertEqual(self.row(self.server.collision(ABOVE)).verdict, 'clear')
        through = bezier((0, 0, 0.1), (2, 0, 0.1))
        hit = self.row(self.server.collision(through))
        self.assertEqual((hit.verdict, hit.lower, hit.b), ('violated', 0.0, 'ball'))
        self.assertEqual(self.row(self.server.distance(through)).upper, 0.0)

    def test_every_kind_of_shape_is_measured(self):
        # each stands about the origin; the true distance is that of the line above at height 2
        line = bezier((-1, 0, 2), (1, 0, 2))
        corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        cases = [
            (solid('s', BOX, [1, 2, 3]), 0.5), (solid('s', SPHERE, [0.5]), 1.5),
            (solid('s', CYLINDER, [3, 0.4]), 0.5), (solid('s', CONE, [3, 0.4]), 0.5),
            (plane('s', [0, 0, 2, -1]), 1.5), (mesh('s', corners, [(0, 1, 3), (4, 5, 7)]), 1.0),
            (body('s', 'point', vertices=[(0, 0, 0.5)]), 1.5), (body('s', 'sphere', [0.5]), 1.5),
            (body('s', 'box', [1, 2, 3]), 0.5), (body('s', 'capsule', [1, 0.5]), 1.0),
            (body('s', 'cylinder', [3, 0.4]), 0.5), (body('s', 'cone', [3, 0.4]), 0.5),
            (body('s', 'ellipsoid', [1, 1, 0.5]), 1.5), (body('s', 'halfspace', [0, 0, 2, -1]), 1.5),
            (body('s', 'polytope', vertices=corners), 1.0),
            (body('s', 'polygon', vertices=[(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]), 2.0),
            (body('s', 'superquadric', [1, 1, 0.5, 4, 1.5, 8]), 1.5),
            (implicit('s', [[(0.5, 0, 0, 0, 4), (0, 0.5, 0, 0, 4), (0, 0, 0.5, 0, 4)]], [(0, 0, 2, -1)]), 1.5),
            (implicit('s', planes=[(0, 0, 1, -1), (0, 0, -1, -1)], quadrics=[(1, 0, 0, 1, 0, 0, 0, 0, 0, -1)]), 1.0)]
        for thing_, true_distance in cases:
            with self.subTest(thing_.bodies or thing_.primitives or thing_.planes or 'mesh'):
                self.server.replace(thing_)
                self.assertContains(self.distance(line), true_distance)

    def test_ground_and_grids_of_distances_are_bodies(self):
        line = bezier((-1, 0, 2), (1, 0, 2))
        self.server.replace(body('ground', 'height_field', [1, 1, 3, 3, -1], (), (-1, -1, 0), [0, 0, 0, 0, .5, 0, 0, 0, 0]))
        self.assertContains(self.distance(line), 1.5)
        values = [math.sqrt(x * x + y * y + z * z) for z in (-1, 0, 1) for y in (-1, 0, 1) for x in (-1, 0, 1)]
        self.server.replace(body('point', 'distance_grid', [1, 3, 3, 3], (), (-1, -1, -1), values))
        row = self.distance(line)
        self.assertLessEqual(row.lower, 2.0)
        self.assertGreaterEqual(row.upper, 2.0)
        values[0] = 9.0
        self.assertRefused(self.server.apply(body('point', 'distance_grid', [1, 3, 3, 3], values=values)), 'neighbour')

    def test_what_does_not_apply_is_refused_and_named(self):
        self.assertRefused(self.server.collision(ABOVE, self_collision=True), 'self_collision')

    def test_poses_of_object_and_shape_are_chained(self):
        # the object is turned by 90 degrees about z, so its shape at (1, 0, 0) stands at (3, 1, 0)
        s = math.sqrt(0.5)
        turned = sphere('ball', 0.5, (3, 0, 0), primitive_poses=[pose((1, 0, 0))])
        turned.pose.orientation.z = turned.pose.orientation.w = 2 * s  # not normalised
        self.server.replace(turned)
        self.assertContains(self.distance(bezier((3, 1, -2), (3, 1, -1))), 0.5)

    def test_padding_radius_and_curve_range_count(self):
        self.server.replace(sphere('ball', 0.25, (1, 0, 0), padding=0.1))
        self.assertContains(self.distance(), 0.65)
        self.assertContains(self.distance(bezier((0, 0, 1), (2, 0, 1), radius=0.2)), 0.45)
        # half of a spline along x is as far from the ball as its end at (1, 0, 1) says
        self.server.replace(sphere('ball', 0.25, (2, 0, 1)))
        spline = bspline([(i / 4.0, 0, 1) for i in range(9)], 1, t0=0.0, t1=0.5)
        self.assertContains(self.distance(spline), 0.75)

    def test_per_object_gives_a_row_for_each_pair_and_names_it(self):
        self.server.replace(sphere('a', 0.25, (1, 0, 0)), sphere('b', 0.5, (1, 0, 0)), sphere('c', 0.125, (1, 0, 0)))
        response = self.succeeded(self.server.distance([ABOVE, bezier((0, 0, 2), (2, 0, 2), id='top')], per_object=True, epsilon=EPSILON))
        rows = {(r.a, r.b): r for r in response.results}
        self.assertEqual(len(response.results), 6)
        for name, radius in (('a', 0.25), ('b', 0.5), ('c', 0.125)):
            self.assertContains(rows['above', name], 1 - radius)
            self.assertContains(rows['top', name], 2 - radius)

    def test_named_objects_alone_are_measured(self):
        self.server.replace(sphere('near', 0.25, (1, 0, 0)), sphere('far', 0.25, (1, 0, -1)))
        self.assertEqual(self.distance(objects=['far']).b, 'far')
        self.assertContains(self.distance(objects=['far']), 1.75)


class Scene(TestCase):
    def test_objects_are_added_moved_appended_and_removed(self):
        self.assertTrue(self.server.apply(thing('ball', (1, 0, -1), operation=CollisionObject.MOVE)).success)
        self.assertContains(self.distance(), 1.75)

        self.assertTrue(self.server.apply(sphere('ball', 0.5, operation=CollisionObject.APPEND)).success)
        self.assertContains(self.distance(), 1.5)
        self.assertEqual(len(self.server.scene('ball').objects[0].primitives), 2)

        self.assertTrue(self.server.apply(sphere('ball', 0.125, (1, 0, 0))).success)
        self.assertContains(self.distance(), 0.875)

        self.assertTrue(self.server.apply(thing('ball', operation=CollisionObject.REMOVE)).success)
        self.assertEqual(self.server.scene().objects, [])

        self.server.replace(sphere('a', 1), sphere('b', 1))
        self.assertTrue(self.server.apply(thing('', operation=CollisionObject.REMOVE)).success)
        self.assertEqual(self.server.scene().objects, [])

    def test_what_get_scene_returns_builds_the_same_scene_again(self):
        corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        self.server.replace(
            solid('box', BOX, [1, 2, 3], (5, 0, 0), padding=0.05), solid('cone', CONE, [1, 0.5], (0, 5, 0)),
            mesh('mesh', corners, [(0, 1, 3), (4, 5, 7)], (0, 0, 8)), plane('floor', [0, 0, 1, 4]),
            body('capsule', 'capsule', [1, 0.2], position=(3, 3, 3)),
            body('hull', 'polytope', vertices=corners, position=(-4, 0, 0)),
            body('can', 'superquadric', [1, 1, 2, 2, 2, 16], position=(-9, 0, 0)),
            implicit('lens', planes=[(0, 0, 1, -0.5)], quadrics=[(1, 0, 0, 1, 0, 1, 0, 0, 0, -1)], position=(0, -9, 0)),
            allowed_contacts=[AllowedContact('cone', 'box', True)])
        first = self.server.scene()
        self.assertEqual(first.frame_id, 'world')
        self.assertEqual([(c.first, c.second, c.allowed) for c in first.allowed_contacts], [('box', 'cone', True)])

        def rows():
            return [(row.b, row.lower, row.upper) for row in self.server.distance(ABOVE, per_object=True, epsilon=EPSILON).results]
        before = rows()
        self.assertEqual(len(before), 8)

        self.server.replace(*first.objects, allowed_contacts=first.allowed_contacts)
        again = self.server.scene()
        self.assertEqual(again.scene.version, first.scene.version + 1)
        again.scene = first.scene = SceneState()  # it has NaN
        self.assertEqual(again, first)
        self.assertEqual(rows(), before)
        self.assertEqual([o.id for o in self.server.scene('cone', 'box').objects], ['cone', 'box'])

    def test_a_faulty_object_does_not_spoil_the_others(self):
        self.server.replace()
        response = self.server.apply(sphere('good', 0.25, (1, 0, 0)), sphere('bad', -1), sphere('also', 0.1, (9, 9, 9)))
        self.assertRefused(response, "'bad'")
        self.assertEqual([o.id for o in self.server.scene().objects], ['also', 'good'])


class BadInput(TestCase):
    """Whatever is refused here, the node answers the next call."""

    def tearDown(self):
        self.assertContains(self.distance(objects=['ball']), 0.75)

    def test_curves_are_refused_with_a_reason(self):
        nan, inf = math.nan, math.inf
        straight = [(0, 0, 1), (1, 0, 1), (2, 0, 1)]
        cases = [
            (bezier((0, 0, nan), (1, 0, 1)), 'point'), (bezier((0, 0, inf), (1, 0, 1)), 'point'),
            (bezier(), 'point'), (bezier((0, 0, 1)), 'point'),
            (bezier((0, 0, 1), (1, 0, 1), degree=5), 'degree'),
            (bezier((0, 0, 1), (1, 0, 1), radius=-0.1), 'radius'),
            (bezier((0, 0, 1), (1, 0, 1), radius=nan), 'radius'),
            (bezier((0, 0, 1), (1, 0, 1), t0=1.0, t1=0.5), 't0'),
            (bezier((0, 0, 1), (1, 0, 1), t0=nan, t1=1.0), 'range'),
            (bezier((0, 0, 1), (1, 0, 1), basis='fourier'), "'fourier'"),
            (bspline(straight, 1, knots=[0, 0, 0.7, 0.5, 1]), 'knot'), (bspline(straight, 1, knots=[0, 0, 1]), 'knot'),
            (bspline(straight, 0), 'degree'), (bspline(straight, 2, knots=[0, 0, 0, nan, 1, 1]), 'knot'),
            (bspline(straight, 3, knots=[0] * 7), 'point'),
            (bezier(*[(i, 0, 1) for i in range(100)]), 'point')]
        for curve, word in cases:
            with self.subTest(word, curve=str(curve)[-200:]):
                response = self.server.distance(curve)
                self.assertRefused(response, word, '1 of 1')
                row, = response.results
                self.assertEqual(row.status, 'invalid')
                self.assertIn(word, row.message)
                self.assertTrue(math.isnan(row.lower) and math.isnan(row.upper))

    def test_one_bad_curve_does_not_spoil_the_others(self):
        response = self.server.distance([ABOVE, bezier((0, 0, 1), id='short'), ABOVE], epsilon=EPSILON)
        self.assertRefused(response, '1 of 3', 'curve 1', "'short'")
        self.assertEqual([r.status for r in response.results], ['ok', 'invalid', 'ok'])
        self.assertContains(response.results[2], 0.75)

    def test_objects_are_refused_by_name(self):
        nan = math.nan
        upright = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
        cases = [
            (solid('odd', BOX, [0, 1, 1]), ''), (solid('odd', BOX, [1, 1]), 'dimension'),
            (solid('odd', SPHERE, [-1]), ''), (solid('odd', SPHERE, [nan]), ''), (solid('odd', SPHERE, []), 'dimension'),
            (solid('odd', 17, [1, 1, 1]), '17'), (solid('odd', CYLINDER, [0, 1]), ''),
            (body('odd', 'teapot', [1]), "'teapot'"), (body('odd', 'capsule', [1, 0]), ''),
            (body('odd', 'polytope'), 'vert'), (body('odd', 'polytope', vertices=[(0, 0, nan)]), ''),
            (body('odd', 'halfspace', [0, 0, 0, 1]), ''), (body('odd', 'mesh'), ''),
            (mesh('odd', upright, [(0, 1, 7)]), 'vertex 7'), (mesh('odd', upright, [(0, 1, 2**32 - 1)]), 'vertex'),
            (mesh('odd', upright, []), 'triangle'), (mesh('odd', upright[:2] + [(0, nan, 0)], [(0, 1, 2)]), ''),
            (mesh('odd', [], []), ''), (plane('odd', [0, 0, 0, 1]), ''),
            (sphere('odd', 1, primitive_poses=[pose(orientation=(0, 0, 0, 0))]), 'norm is 0'),
            (sphere('odd', 1, primitive_poses=[pose(), pose()]), 'poses'),
            (sphere('odd', 1, (nan, 0, 0)), 'finite'), (sphere('odd', 1, padding=-0.1), 'padding'),
            (sphere('odd', 1, padding=nan), 'padding'), (sphere('odd', 1, operation=9), 'operation 9'),
            (thing('odd', operation=CollisionObject.MOVE), 'odd'),
            (thing('odd', operation=CollisionObject.REMOVE), 'odd'), (sphere('odd', 1, pose=pose((1, 2, 3), (0, 0, 0, 0))), 'norm is 0')]
        for object_, word in cases:
            with self.subTest(word, object=str(object_)[:400]):
                self.assertRefused(self.server.apply(object_), "'odd'", word)
        self.assertFalse(self.server.apply(sphere('', 1)).success)
        self.assertEqual([o.id for o in self.server.scene().objects], ['ball'])

    def test_an_unset_pose_is_the_identity(self):
        self.assertTrue(self.server.apply(sphere('other', 0.5, pose=Pose())).success)
        self.assertContains(self.distance(bezier((0, 0, 1), (0, 1, 1)), objects=['other']), 0.5)

    def test_missing_mesh_files_are_refused(self):
        for resource in ('file:///nowhere/none.stl', 'package://no_such_package/a.stl', 'http://localhost/a.stl', ''):
            with self.subTest(resource):
                odd = thing('odd', bodies=[Body(type='mesh', resource=resource)])
                self.assertRefused(self.server.apply(odd), "'odd'", resource)

    def test_queries_are_refused_with_a_reason(self):
        for epsilon in (-1e-6, math.nan, math.inf):
            self.assertRefused(self.server.distance(ABOVE, epsilon=epsilon), 'epsilon')
        for delta in (-0.1, math.nan, math.inf):
            self.assertRefused(self.server.tolerance(ABOVE, delta), 'delta')
        self.assertRefused(self.server.distance(ABOVE, objects=['ghost']), "'ghost'")
        self.assertRefused(self.server.distance(ABOVE, links=['arm']), "'arm'", 'no robot')
        self.assertRefused(self.server.scene('ghost'), "'ghost'")
        self.assertRefused(self.server.apply(link_padding=[LinkPadding('arm', 0.1)]), "'arm'")

    def test_an_unknown_frame_is_told_with_both_frames(self):
        self.assertRefused(self.server.distance(bezier((0, 0, 1), (1, 0, 1), frame='nowhere')), "'nowhere'", "'world'")
        self.assertRefused(self.server.apply(sphere('odd', 1, frame='nowhere')), "'odd'", "'nowhere'", "'world'")

    def test_too_much_is_refused_with_limit_and_count(self):
        self.assertRefused(self.server.distance([ABOVE] * 10001), 'max_curves', '10000', '10001')
        point_ = point((0, 0, 1))
        long = bspline([(0, 0, 1)] * 3, 2)
        long.points = [point_] * 100001
        self.assertRefused(self.server.distance(long), 'max_control_points', '100000', '100001')
        self.server.replace(sphere('ball', 0.25, (1, 0, 0)), sphere('b', 1, (9, 9, 9)), sphere('c', 1, (9, 9, 9)))
        self.assertRefused(self.server.distance([ABOVE] * 7000, per_object=True), 'max_results', '20000', '21000')


class Curves(TestCase):
    """Curves as obstacles, and tubes whose radius changes."""

    def cable(self, **fields):
        """One metre beside the middle of ABOVE, along y: from (1, -1, 2) to (1, 1, 2)."""
        return thing('cable', bodies=[Body(type='curve', curve=bezier((1, -1, 2), (1, 1, 2), radius=0.1), **fields)])

    def test_a_curve_of_the_scene_is_an_obstacle(self):
        self.server.replace(self.cable())
        row = self.distance()
        self.assertContains(row, 0.9)
        self.assertEqual(row.b, 'cable')
        self.assertAlmostEqual(row.t_b, 0.5, delta=1e-4)
        self.assertEqual(self.row(self.server.tolerance(ABOVE, 0.89)).verdict, 'clear')
        kept = self.server.scene('cable').objects[0]
        self.assertEqual((kept.bodies[0].type, len(kept.bodies[0].curve.points), kept.bodies[0].curve.radius), ('curve', 2, 0.1))
        self.server.replace(kept)
        self.assertContains(self.distance(), 0.9)
        self.server.replace(sphere('ball', 0.25, (1, 0, 0)))
        self.assertTrue(math.isnan(self.distance().t_b))

    def test_on_one_clock_both_radii_may_change(self):
        cable = self.cable(synchronized=True)
        cable.bodies[0].curve.radius_polynomial = [0.2]
        self.server.replace(cable)
        tube = bezier((0, 0, 1), (2, 0, 1), radius=0.1)
        tube.radius_polynomial = [0.1]
        # at t the centres are (2t - 1, -(2t - 1), -1) apart: least the radii 0.2 + 0.3 t
        least = min(math.hypot(math.sqrt(2) * (2 * t - 1), 1) - 0.2 - 0.3 * t for t in (0.5 + 1e-5 * i for i in range(20000)))
        row = self.row(self.server.distance(tube, epsilon=EPSILON))
        self.assertLessEqual(row.lower, least)
        self.assertAlmostEqual(row.upper, least, delta=1e-8)
        self.assertEqual(row.t, row.t_b)
        alone = bezier((0, 0, 1), (2, 0, 1))
        alone.t1 = 2.0
        self.assertRefused(self.server.distance(alone), "on the mover's clock")

    def test_what_is_no_obstacle_is_told(self):
        bad = self.cable()
        bad.bodies[0].curve.radius_polynomial = [0.2]
        self.assertRefused(self.server.apply(bad), "'cable'", 'must be synchronized')
        self.assertRefused(self.server.apply(thing('c', bodies=[Body(type='curve')])), "'c'")
        wrong = Body(type='sphere', dimensions=[1], curve=bezier((0, 0, 0), (1, 0, 0)))
        self.assertRefused(self.server.apply(thing('c', bodies=[wrong])), 'takes no curve')


class MeasurePairs(TestCase):
    def measure(self, *pairs, **fields):
        return self.server.ask('measure_pairs', pairs=list(pairs), **fields)

    def pair(self, ask='', x=3.0, **fields):
        ball = Body(type='sphere', dimensions=[1])
        return PairQuery(id=ask or 'pair', ask=ask, a=ball, b=ball, pose_b=pose((x, 0, 0)), **fields)

    def test_every_question_is_answered_by_hand(self):
        aside = Vector3(0, 1, 0)
        rows = self.succeeded(self.measure(
            self.pair(), self.pair(x=1.5), self.pair('growth', 6.0), self.pair('translating_distance', velocity_b=aside, duration=2.0),
            self.pair('translating_contact', velocity_b=Vector3(-1, 0, 0), duration=2.0), epsilon=EPSILON)).results
        for row, value in zip(rows, (1, -0.5, 3, 1)):
            self.assertContains(row, value)
        contact = rows[4]
        self.assertEqual((contact.kind, contact.verdict), ('translating_contact', 'violated'))
        self.assertLessEqual(contact.t_contact_lower, 1)
        self.assertAlmostEqual(contact.t_contact_lower, 1, delta=1e-6)
        self.assertEqual([row.kind for row in rows[:3]], ['pair', 'pair', 'growth'])

    def test_deformed_bodies_are_measured(self):
        round_ = Body(type='superquadric', dimensions=[1, 1, 1, 2, 2, 2], linear=[0.5, 0, 0, 0, 3, 0, 0, 0, 0.67], translation=[1, 0, 0])
        row = self.measure(PairQuery(a=round_, b=Body(type='point'), pose_b=pose((4, 0, 0))), epsilon=EPSILON).results[0]
        self.assertContains(row, 2.5)

    def test_what_is_wrong_fails_alone(self):
        rows = self.measure(self.pair(), self.pair('nearness'), self.pair(duration=1.0), PairQuery(id='empty', a=Body(type='sphere', dimensions=[1])))
        self.assertRefused(rows, "pair 1 ('nearness')")
        self.assertEqual([row.status for row in rows.results], ['ok', 'invalid', 'invalid', 'invalid'])
        self.assertFalse(self.measure(epsilon=-1).success)


class Large(TestCase):
    def test_a_spline_of_100000_control_points_is_answered(self):
        # a straight line in many pieces
        n = 100000
        row = self.distance(bspline([(2.0 * i / (n - 1), 0, 1) for i in range(n)], 3))
        self.assertContains(row, 0.75)

    def test_10000_curves_in_one_request_are_answered(self):
        curves = [bezier((0, 0, 1 + i * 1e-3), (2, 0, 1 + i * 1e-3)) for i in range(10000)]
        response = self.succeeded(self.server.distance(curves, epsilon=EPSILON))
        self.assertEqual(len(response.results), 10000)
        for i in (0, 17, 9999):
            self.assertContains(response.results[i], 1 + i * 1e-3 - 0.25)

    def test_many_curves_in_one_request_are_answered_as_one_by_one(self):
        """Rows keep their order, and a curve that fails keeps its row."""
        curves = [bezier((0, 0.1 * (i % 7), 1 + i * 1e-2), (2, 0, 1 + i * 1e-3), id='c%d' % i) for i in range(600)]
        curves[77] = bezier(id='c77')
        curves[200] = bezier((0, 0, 1), (1, 0, 1), id='c200', frame='nowhere')
        together = self.server.distance(curves, per_object=True)
        self.assertRefused(together, "curve 77 ('c77')")
        rows = [row for curve in curves for row in self.server.distance(curve, per_object=True).results]
        self.assertEqual([(r.id, r.b, r.status, repr(r.lower), repr(r.upper), repr(r.t)) for r in together.results],
                         [(r.id, r.b, r.status, repr(r.lower), repr(r.upper), repr(r.t)) for r in rows])


if __name__ == '__main__':
    run('answers')
