#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The objects of the Python package: pickling, notebooks, messages about wrong arguments, a scene's obstacles, joint limits."""
import copy
import math
import os
import pickle
import tempfile
import unittest
import warnings

import numpy

import cprox

RAIL = ('<robot name="r"><link name="rail"/><link name="cart"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>'
        '<link name="wheel"/><joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/>'
        '<limit lower="-2" upper="3" effort="1" velocity="1"/></joint><joint name="turn" type="continuous"><parent link="cart"/>'
        '<child link="wheel"/></joint></robot>')


def rail(folder):
    path = os.path.join(folder, 'rail.urdf')
    with open(path, 'w') as out:
        out.write(RAIL)
    return cprox.Robot.from_urdf(path)


def again(one):
    return pickle.loads(pickle.dumps(one))


def curves():
    line, points = [[0, 0, 1], [1, 0, 1]], numpy.random.default_rng(3).uniform(-1, 1, (4, 3))
    bezier = cprox.bezier(points)
    return [bezier, cprox.bspline(points, 2, [0, 0, 0, 1, 2, 2, 2]), cprox.polynomial(points, -1, 2), cprox.legendre(points),
            cprox.lagrange(points, [0, 1, 2, 3], 0, 3), cprox.trigonometric(points[:3], 0, 4), cprox.rational_bezier(points, [1, 2, 3, 4]),
            cprox.nurbs(points, [1, 2, 1, 1], 2, [0, 0, 0, 1, 2, 2, 2]), cprox.clothoid([0, 0, 0], 1, 2, 3, 0, 1),
            cprox.dubins([0, 0, 0], 0, [3, 1, 0], 1, .5), cprox.involute([0, 0, 0], 0, 1, 0, 2),
            cprox.pythagorean_hodograph([0, 0, 0], numpy.ones((3, 4))), bezier.restrict(.2, .7),
            cprox.piecewise([cprox.bezier(line), cprox.bezier([line[1], [2, 0, 0]], 1, 2)])]


class Pickling(unittest.TestCase):
    def test_curves_are_the_same_to_the_bit(self):
        for curve in curves():
            for other in (again(curve), again(again(curve)), copy.copy(curve)):
                self.assertEqual((curve.t0, curve.t1, curve.n_pieces), (other.t0, other.t1, other.n_pieces))
                t = numpy.linspace(curve.t0, curve.t1, 20)
                for derivative in (0, 1):
                    numpy.testing.assert_array_equal(curve(t, derivative), other(t, derivative))

    def test_an_array_that_changes_later_changes_no_curve(self):
        points = numpy.array([[0., 0, 0], [1, 0, 0]])
        curve = cprox.bezier(points)
        points[:] = 7
        numpy.testing.assert_array_equal(again(curve)(1.0), [1, 0, 0])

    def test_shapes_movers_and_obstacles_answer_alike(self):
        corners = numpy.random.default_rng(4).uniform(-.3, .3, (12, 3))
        shapes = [cprox.sphere(.2), cprox.box([.1, .2, .3]), cprox.superquadric([.1, .2, .3], [2, 3, 4]), cprox.polytope(corners),
                  cprox.mesh(corners, [[0, 1, 2], [3, 4, 5]]), cprox.point_cloud(corners, .01),
                  cprox.compound([cprox.sphere(.1), cprox.cone(.2, .1)], [numpy.eye(4), cprox.transform([.3, 0, 0])]),
                  cprox.implicit(planes=[[0, 0, 1, -.1]], quadrics=[[1, 0, 0, 1, 0, 1, 0, 0, 0, -1]])]
        tube = cprox.tube(curves()[0], [.01, .02])
        for mover in (tube, cprox.carried(cprox.box([.1, .1, .1]), curves()[0], .01)):
            for shape in shapes if mover is tube else shapes[:4]:
                obstacle = cprox.Obstacle(shape, cprox.transform([0, 2, 0], [0, 0, 1, 2]), .02)
                first, second = cprox.distance(mover, obstacle), cprox.distance(again(mover), again(obstacle))
                self.assertEqual((first.lower, first.upper, first.t), (second.lower, second.upper, second.t))
        many = [cprox.Obstacle(one, cprox.transform([0, i, 3])) for i, one in enumerate(shapes)] + [cprox.Obstacle.from_curve(curves()[0], .1)]
        first, second = (cprox.distance(curves()[0], one) for one in (cprox.Obstacles(many), again(cprox.Obstacles(many))))
        self.assertEqual((first.lower, first.upper, first.obstacle), (second.lower, second.upper, second.obstacle))

    def test_results_keep_all_that_they_hold(self):
        curve, ball = cprox.bezier([[-1, 0, 0], [1, 0, 0]]), cprox.Obstacle(cprox.sphere(.5), cprox.transform([0, 1, 0]))
        names = [name for name in dir(cprox.Result) if not name.startswith('_')]
        self.assertGreater(len(names), 14)
        for result in (cprox.distance(curve, ball), cprox.tolerance(curve, ball, .4), cprox.time_of_contact(curve, [ball])):
            for name in names:
                numpy.testing.assert_array_equal(getattr(result, name), getattr(again(result), name), name)
            self.assertEqual(repr(result), repr(again(result)))

    def test_a_robot_is_that_of_its_texts(self):
        with tempfile.TemporaryDirectory() as folder:
            robot = rail(folder)
            text = pickle.dumps(robot)
        other = pickle.loads(text)
        self.assertEqual((other.name, other.variables, other.limits), (robot.name, robot.variables, robot.limits))
        for link, pose in robot.link_poses({'slide': 1.25}).items():
            numpy.testing.assert_array_equal(other.link_poses({'slide': 1.25})[link], pose)

    def test_what_refers_to_a_scene_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = cprox.Scene(rail(folder))
        scene.add('ball', 'sphere', [.1])
        motion = cprox.Motion(scene, ['slide'], [0, 1], [[0], [1]])
        for one in (scene, motion, cprox.Movers(scene, {'a': motion}), scene.obstacles()):
            for call in (pickle.dumps, copy.deepcopy):
                with self.assertRaisesRegex(TypeError, r'^[^\n]*cannot be pickled[^\n]*$'):
                    call(one)


class Reading(unittest.TestCase):
    def test_a_verdict_is_there_where_one_was_asked(self):
        curve, ball = cprox.bezier([[-1, 0, 0], [1, 0, 0]]), cprox.Obstacle(cprox.sphere(.5), cprox.transform([0, 1, 0]))
        waves, box = cprox.trigonometric(numpy.random.default_rng(5).normal(size=(21, 3)), 0, 6), cprox.Obstacle(cprox.box([.1, .1, .1]))
        obstacles = cprox.Obstacles([ball])
        for none in (cprox.distance(curve, ball), obstacles.nearest(curve, 1)[0], cprox.pair(ball, ball), cprox.distance_gradient(curve, ball)['result'],
                     cprox.translating_distance(ball, ball, [0, 0, 0], [1, 0, 0], 1)):
            self.assertIsNone(none.verdict)
            self.assertNotIn('undecided', repr(none))
            self.assertNotIn('verdict', none._repr_html_())
        for word, asked in (('clear', cprox.collision(curve, ball)), ('violated', cprox.tolerance(curve, ball, .6)), ('clear', cprox.time_of_contact(curve, ball)),
                            ('undecided', cprox.tolerance(waves, box, cprox.distance(waves, box).upper - 1e-8, max_nodes=1))):
            self.assertEqual(asked.verdict, word)
            self.assertIn(word, repr(asked))
            self.assertIn(word, asked._repr_html_())
        points = [[[-1, 0, 0], [1, 0, 0]]]
        self.assertNotIn('verdict', obstacles.distance_batch(points))
        self.assertEqual(obstacles.tolerance_batch(points, .1)['verdict'].tolist(), [0])
        with tempfile.TemporaryDirectory() as folder:
            scene = cprox.Scene(rail(folder))
        scene.add('ball', 'sphere', [.1], cprox.transform([0, 1, 0]))
        motion = cprox.Motion(scene, ['slide'], [0, 1], [[0], [1]])
        movers = cprox.Movers(scene, {'a': motion})
        for one in (motion, scene, movers):
            arguments = [cprox.bezier([[-1, 0, 3], [1, 0, 3]])] if one is scene else []
            self.assertIsNone(one.distance(*arguments)['result'].verdict)
            self.assertIsNone(one.nearest_pairs(*arguments)[0]['result'].verdict)
            self.assertEqual({one.collision(*arguments)['result'].verdict, one.tolerance(*arguments, delta=.01)['result'].verdict,
                              one.time_of_contact(*arguments)['result'].verdict}, {'clear'})
        self.assertIsNone(motion.gradient()['result'].verdict)

    def test_the_level_of_detail_is_named(self):
        triangles = cprox.Obstacle(cprox.mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1]], [[0, 1, 2], [1, 2, 3]]))
        over = cprox.bezier([[.2, .2, .1], [.8, .8, .5]])
        self.assertEqual(cprox.distance(over, triangles).lod, 'mesh')
        self.assertEqual(cprox.distance(over, triangles, max_lod='sphere').lod, 'sphere')
        self.assertEqual(cprox.collision(cprox.bezier([[50, 0, 0], [50, 1, 0]]), triangles).lod, 'sphere')

    def test_joint_limits_are_those_of_the_urdf(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(rail(folder).limits, {'slide': (-2, 3), 'turn': (-math.inf, math.inf)})

    def test_poses_beyond_the_motion_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            motion = cprox.Motion(cprox.Scene(rail(folder)), ['slide'], [0, 1], [[0], [1]])
        self.assertEqual(motion.link_poses(1)['cart'][0, 3], 1)
        for t in (99, -1e-9, math.nan):
            with self.assertRaisesRegex(ValueError, 'domain'):
                motion.link_poses(t)

    def test_wrong_arguments_are_named(self):
        curve, ball = cprox.bezier([[-1, 0, 0], [1, 0, 0]]), cprox.Obstacle(cprox.sphere(.5))
        robotless = cprox.Scene()
        for words, call in (('got <cprox', lambda: cprox.distance(curve, cprox.sphere(1))), ("got 'wall'", lambda: cprox.distance(curve, 'wall')),
                            ('3 \\(int\\)', lambda: cprox.distance(3, ball)), ('None', lambda: cprox.distance(curve, [ball, None])),
                            ('Scene', lambda: cprox.distance(curve, robotless)), ("'a lot'", lambda: cprox.distance(curve, ball, epsilon='a lot')),
                            ("'x'", lambda: cprox.sphere('x')), ('\\[0, 0\\]', lambda: robotless.distance([0, 0])), ('record', lambda: cprox.check({'a': 1})),
                            ('list', lambda: cprox.check([]))):
            with self.assertRaisesRegex(TypeError, words):
                call()
        for words, call in (('radius', lambda: cprox.tube(curve, -1)), ('radius', lambda: cprox.tube(curve, math.nan)),
                            ('margin', lambda: cprox.Obstacle(cprox.sphere(1), margin=-1)), ('finite', lambda: cprox.transform([0, 0, math.nan])),
                            ('radius', lambda: cprox.Obstacle.from_curve(curve, -1))):
            with self.assertRaisesRegex(ValueError, words):
                call()


class SceneObstacles(unittest.TestCase):
    def test_they_are_what_the_scene_measures(self):
        random = numpy.random.default_rng(5)
        scene = cprox.Scene()
        for i in range(30):
            kind, dimensions = [('box', [.3, .4, .5]), ('sphere', [.2]), ('cylinder', [.5, .1])][i % 3]
            scene.add(f'o{i:02}', kind, dimensions, cprox.transform(random.uniform(-3, 3, 3), random.normal(size=4)), padding=.01 * (i % 2))
        obstacles = scene.obstacles()
        self.assertEqual((len(obstacles), obstacles.names), (30, scene.objects))
        for _ in range(40):
            tube = random.uniform(-3, 3, (4, 3))
            first, second = scene.distance(cprox.bezier(tube), epsilon=1e-9), cprox.distance(cprox.bezier(tube), obstacles, epsilon=1e-9)
            self.assertAlmostEqual(first['result'].upper, second.upper, delta=4e-9)
            if second.lower > 0:
                self.assertEqual(first['b'], obstacles.names[second.obstacle])
        scene.remove('o00')
        self.assertEqual((len(obstacles), len(scene.obstacles())), (30, 29))
        del scene
        self.assertEqual(len(obstacles.nearest(cprox.bezier(tube), 30)), 30)

    def test_they_are_all_of_it_or_none(self):
        with self.assertRaisesRegex(ValueError, 'no object'):
            cprox.Scene().obstacles()
        ball = 'world: {collision_objects: [{id: a, %s, primitives: [{type: 2, dimensions: [1]}]%s}]}'
        pose = 'pose: {position: {x: %s, y: 0, z: 0}, orientation: {x: 0, y: 0, z: 0, w: 1}}'
        moves = 'trajectory: {waypoints: [{time: 0, %s}, {time: 1, %s}]}' % (pose % 0, pose % 1)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'scene.yaml')
            for text, why in ((ball % (pose % 0, ''), None), (ball % (pose % 0, ', sollid: true'), 'sollid'), (ball % (moves, ''), "'a' moves")):
                scene = cprox.Scene()
                with open(path, 'w') as out:
                    out.write(text)
                with warnings.catch_warnings():
                    warnings.simplefilter('ignore')
                    scene.load(path)
                if why is None:
                    self.assertEqual(scene.obstacles().names, ['a'])
                    continue
                with self.assertRaisesRegex(ValueError, 'not all of the scene.*' + why):
                    scene.obstacles()


if __name__ == '__main__':
    outcome = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromModule(__import__('__main__')))
    failed = len(outcome.failures) + len(outcome.errors)
    print(f'{outcome.testsRun - failed} passed, {failed} failed')
    raise SystemExit(failed > 0 or outcome.testsRun == 0)
