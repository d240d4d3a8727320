#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The Python package cprox: robots along trajectories, edges of planners, and an example."""
import math
import os
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy
import yaml

import cprox

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'data')


class Robots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = os.path.join(DATA, 'robots/panda')
        cls.robot = cprox.Robot.from_urdf(os.path.join(folder, 'panda.urdf'), srdf=os.path.join(folder, 'panda.srdf'))
        with open(os.path.join(DATA, 'trajectories/panda_box_0001_rrt.yaml')) as text:
            cls.file = yaml.safe_load(text)
        cls.joints = cls.file['joint_trajectory']['joint_names']
        points = cls.file['joint_trajectory']['points']
        cls.times = [p['time_from_start'] for p in points]
        cls.positions = [p['positions'] for p in points]
        cls.velocities = [p['velocities'] for p in points]

    def motion(self, scene):
        return cprox.Motion(scene, self.joints, self.times, self.positions, self.velocities,
                            rest=self.file['fixed_joints'])

    def test_errors_persons_and_moved_objects_are_asked_about(self):
        """A ball: each point of it is off by 1 cm, which costs 1 cm; it may be moved by the distance towards the robot."""
        scene = cprox.Scene(self.robot)
        scene.add('ball', 'sphere', [.1], cprox.transform([.6, .5, 1.2]))
        motion = self.motion(scene)
        least = motion.distance()['result'].upper
        robust = motion.robust({'sensor': .01}, delta=.001)
        self.assertEqual(robust['result'].verdict, 'clear')
        self.assertLessEqual(robust['certified_scale'], (least - .001) / .01 + 1e-9)
        self.assertGreater(robust['certified_scale'], .9 * (least - .001) / .01)
        profile = motion.robust_profile(numpy.linspace(*motion.domain, 5), {'sensor': .01})
        self.assertAlmostEqual(profile['lower'].min(), least - .01, places=5)
        for wrong in ({'sensors': 1}, {'every_joint': {'track': 1}}, {'joints': {'elbow': {'tracking': 1}}}):
            with self.assertRaises(ValueError):
                motion.robust(wrong)

        separation = {'person': {'speed': 1.6}, 'robot': {'reaction_time': 0, 'stopping_time': 1}, 'intrusion': .02}
        limits = motion.speed_limits(separation, ['ball'], intervals=200)
        self.assertEqual(limits['override'].min(), limits['constant_override'])
        self.assertTrue((limits['override'] <= (limits['lower'] - .02) / 1.6).all())
        self.assertAlmostEqual(limits['constant_override'], (least - .02) / 1.6, places=3)
        with self.assertRaisesRegex(ValueError, 'person has no .speed'):
            motion.speed_limits(dict(separation, person={}), ['ball'])

        margins = {row['direction']: row for row in motion.margins(within=2)}
        self.assertEqual(len(margins), 7)
        self.assertAlmostEqual(margins['any']['free'], least, places=5)
        for row in margins.values():
            self.assertGreaterEqual(row['free'], margins['any']['free'] - 1e-6)
            moved = cprox.Scene(self.robot)
            moved.add('ball', 'sphere', [.1], cprox.transform(numpy.array([.6, .5, 1.2]) + (row['free'] - 1e-6) * row['toward']))
            self.assertEqual(self.motion(moved).collision()['result'].verdict, 'clear')

    def test_the_distance_to_a_ball_is_no_more_than_that_of_any_sample(self):
        scene = cprox.Scene(self.robot)
        scene.add('ball', 'sphere', [.1], cprox.transform([.6, .5, 1.2]))
        self.assertEqual(scene.objects, ['ball'])
        motion = self.motion(scene)
        answer = motion.distance()
        self.assertEqual((answer['kind'], answer['b']), ('environment', 'ball'))
        origins = [pose[:3, 3] for t in numpy.linspace(*motion.domain, 200)
                   for link, pose in motion.link_poses(t).items() if link in ('panda_link4', 'panda_link6', 'panda_hand')]
        sampled = min(numpy.linalg.norm(p - [.6, .5, 1.2]) - .1 for p in origins)
        self.assertLessEqual(answer['result'].lower, sampled)
        self.assertEqual(motion.tolerance(answer['result'].lower / 2)['result'].verdict, 'clear')
        profile = motion.profile(numpy.linspace(*motion.domain, 11))
        self.assertAlmostEqual(profile['upper'].min(), answer['result'].upper, places=5)
        between = numpy.linalg.norm(profile['witness_a'] - profile['witness_b'], axis=1)
        numpy.testing.assert_allclose(between, profile['upper'], atol=1e-9)
        near = motion.profile(numpy.linspace(*motion.domain, 11), horizon=answer['result'].upper)
        self.assertTrue((near['lower'] <= profile['upper']).all())
        self.assertTrue(((near['upper'] - near['lower'] <= 1e-6) | (near['lower'] > answer['result'].upper)).all())
        self.assertIn('panda_link4', motion.links())
        self.assertIn('panda_link0', motion.links())
        self.assertNotIn('panda_link0', motion.links(moving_only=True))
        by_link = [motion.profile([*motion.domain], links=[link])['upper'][0] for link in motion.links()]
        self.assertAlmostEqual(min(by_link), answer['result'].upper, places=5)
        self.assertGreater(max(by_link), answer['result'].upper + .1)
        with self.assertRaisesRegex(ValueError, 'elbow'):
            motion.profile([*motion.domain], links=['elbow'])
        links = motion.links()
        for ask in (motion.distance, motion.gradient, lambda **names: motion.nearest_pairs(k=1, **names)[0]):
            found = ask(links=links[:1], objects=['ball'])
            self.assertEqual((found['a'], found['b']), (links[0], 'ball'))
            self.assertAlmostEqual(found['result'].upper, by_link[0], places=5)
        self.assertEqual(motion.tolerance(by_link[-1] - 1e-3, links=links[-1:])['result'].verdict, 'clear')
        self.assertEqual(motion.collision(links=links[-1:])['result'].verdict, 'clear')
        self.assertEqual(motion.violations(by_link[-1] - 1e-3, links=links[-1:]), [])
        with self.assertRaisesRegex(ValueError, 'bal'):
            motion.distance(objects=['bal'])
        pairs = motion.nearest_pairs(k=3)
        self.assertEqual(len(pairs), 3)
        self.assertAlmostEqual(pairs[0]['result'].upper, answer['result'].upper, places=5)

    def test_the_gradient_of_a_motion_is_that_of_differences(self):
        scene = cprox.Scene(self.robot)
        scene.add('ball', 'sphere', [.1], cprox.transform([.6, .5, 1.2]))
        positions, velocities = (numpy.array(rows[:4]) for rows in (self.positions, self.velocities))

        def moved(i=0, k=0, step=0.0, of=positions):
            rows = [array.copy() for array in (positions, velocities)]
            rows[0 if of is positions else 1][i, k] += step
            return cprox.Motion(scene, self.joints, self.times[:4], *rows)
        told = moved().gradient(epsilon=1e-11)
        self.assertTrue(told['valid'], told['reason'])
        self.assertEqual((told['positions'].shape, told['velocities'].shape, told['accelerations']), ((4, 7), (4, 7), None))
        step = 1e-6
        for name, of in (('positions', positions), ('velocities', velocities)):
            for i in range(4):
                for k in range(7):
                    high, low = (moved(i, k, s, of).distance(epsilon=1e-12)['result'].upper for s in (step, -step))
                    self.assertAlmostEqual(told[name][i, k], (high - low) / (2 * step), delta=1e-5)

    def test_what_moves_at_the_same_time_has_distances_and_gradients(self):
        """A ball crosses the arm's way, then a second arm stands beside it and moves as the first."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'scene.yaml')
            with open(path, 'w') as file:
                file.write('world: {collision_objects: [{id: ball, primitives: [{type: sphere, dimensions: [0.1]}], trajectory: {waypoints: ['
                           '{time: 0, pose: {position: [0.6, 0.9, 1.0]}}, {time: 1.0, pose: {position: [0.8, -0.4, 0.9]}}]}}]}')
            scene = cprox.Scene(self.robot)
            scene.load(path)
        n, alone, positions = 4, cprox.Scene(self.robot), numpy.array(self.positions[:4])
        times = numpy.linspace(0.0, 1.0, n)
        base = cprox.transform([1.5, 0.2, 0], [0, 0, 1, 0])

        def movers(i=0, k=0, step=0.0, late=0.0, last=1.0, second=False):
            rows = positions.copy()
            rows[i, k] += step
            motions = dict(first=cprox.Motion(alone, self.joints, last * times, rows))
            if second:
                motions['second'] = cprox.Motion(alone, self.joints, times, 0.8 * positions[::-1] + 0.1, base=base)
            return cprox.Movers(scene, motions, dict(first=late))
        for second in (False, True):
            objects = ['second'] if second else []
            told = movers(second=second).gradient('first', epsilon=1e-10, objects=objects)
            self.assertTrue(told['valid'], told['reason'])
            self.assertEqual(told['positions'].shape, (n, 7))
            self.assertEqual((told['b'].split('/')[0], movers(second=second).domain), ('second' if second else 'ball', [0.0, 1.0]))

            def least(**changed):
                return movers(second=second, **changed).distance('first', epsilon=1e-11, objects=objects)['result'].upper
            step = 1e-6
            for i in range(n):
                for k in range(7):
                    self.assertAlmostEqual(told['positions'][i, k], (least(i=i, k=k, step=step) - least(i=i, k=k, step=-step)) / (2 * step), delta=1e-4)
            if not second:
                self.assertAlmostEqual(told['start'], (least(late=step) - least(late=-step)) / (2 * step), delta=1e-4)
            self.assertAlmostEqual(told['duration'], (least(last=1 + step) - least(last=1 - step)) / (2 * step), delta=1e-4)
            self.assertAlmostEqual(told['result'].upper, least(), places=8)
            self.assertEqual(movers(second=second).tolerance(least() - 1e-4, 'first', objects=objects)['result'].verdict, 'clear')
            numpy.testing.assert_allclose(told['object_linear'], 0.0 if second else -told['base_linear'], atol=1e-12)
        self.assertLessEqual(movers(second=True).distance()['result'].upper, least() + 1e-5)
        # all motions at once: those of the pair as each by itself
        found = movers(second=True).gradients(epsilon=1e-10, links=['first'], objects=['second'])
        self.assertTrue(found['valid'], found['reason'])
        self.assertEqual(list(found['gradients']), ['first', 'second', 'ball'])
        for name, other in (('first', 'second'), ('second', 'first')):
            one, itself = found['gradients'][name], movers(second=True).gradient(name, epsilon=1e-10, objects=[other])
            self.assertAlmostEqual(itself['t'], found['t'], delta=1e-9)
            self.assertGreater(numpy.linalg.norm(one['positions']), 0.1)
            for key, number in one.items():
                if number is None:
                    self.assertIsNone(itself[key], key)
                else:
                    numpy.testing.assert_allclose(number, itself[key], atol=1e-7, err_msg=key)
        self.assertEqual((found['gradients']['ball']['positions'], found['gradients']['ball']['start']), (None, 0.0))
        numpy.testing.assert_array_equal(found['gradients']['ball']['object_linear'], 0.0)
        for wrong, words in ((lambda: movers().gradient('third'), "no motion 'third'"), (lambda: cprox.Movers(scene, {}, dict(x=1)), "starts name 'x'"),
                             (lambda: cprox.Movers(alone, {}), 'nothing moves'), (lambda: movers().distance('first', objects=['bal']), "'bal'")):
            with self.assertRaisesRegex(ValueError, words):
                wrong()

    def test_balls_on_rails_and_a_ball_that_flies_come_as_close_as_their_centres_say(self):
        """Two robots of two balls each, a ball that flies between them, a block: distances of centres at many times."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'rail.urdf')
            with open(path, 'w') as file:
                file.write('<robot name="rail"><link name="rail"/>' + ''.join(
                    f'<link name="{link}"><collision><geometry><sphere radius="{radius}"/></geometry></collision></link>'
                    f'<joint name="{joint}" type="prismatic"><origin xyz="{origin}"/><parent link="rail"/><child link="{link}"/>'
                    f'<axis xyz="{axis}"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>'
                    for link, radius, joint, origin, axis in (('ball', 0.1, 'slide', '0 0 0', '1 0 0'),
                                                              ('hook', 0.05, 'lift', '1 0 0.3', '0 0 1'))) + '</robot>')
            robot = cprox.Robot.from_urdf(path)
            path = os.path.join(folder, 'scene.yaml')
            with open(path, 'w') as file:
                file.write('world: {collision_objects: [{id: drone, primitives: [{type: sphere, dimensions: [0.2]}], trajectory: {waypoints: ['
                           '{time: 0, pose: {position: [1, -1, 0]}}, {time: 2, pose: {position: [1, 1, 0]}}]}}]}')
            flown = cprox.Scene(robot)
            flown.load(path)
        still, empty = cprox.Scene(robot), cprox.Scene(robot)
        for scene in (flown, still):
            scene.add('block', 'sphere', [0.1], cprox.transform([0, -0.6, 0]))
        motions = dict(left=cprox.Motion(empty, ['slide'], [0, 2], [[0], [2]]),
                       right=cprox.Motion(empty, ['slide'], [0, 2], [[2], [0]], base=cprox.transform([0, 0.5, 0])))
        radii = {'left/ball': 0.1, 'right/ball': 0.1, 'left/hook': 0.05, 'right/hook': 0.05, 'drone': 0.2, 'block': 0.1}

        def centre(name, t, late=0.0):
            slid = numpy.clip(t - late, 0, 2)
            return numpy.stack(numpy.broadcast_arrays(*{
                'left/ball': (slid, 0.0, 0.0), 'right/ball': (2 - slid, 0.5, 0.0), 'left/hook': (1.0, 0.0, 0.3),
                'right/hook': (1.0, 0.5, 0.3), 'drone': (1.0, numpy.clip(t, 0, 2) - 1, 0.0), 'block': (0.0, -0.6, 0.0)}[name] + (t,))[:3], -1)

        def apart(pair, t, late=0.0):
            return numpy.linalg.norm(centre(pair[0], t, late) - centre(pair[1], t), axis=-1) - radii[pair[0]] - radii[pair[1]]
        t = numpy.linspace(0, 2, 20001)
        movers, grounded = cprox.Movers(flown, motions), cprox.Movers(still, motions)
        numpy.testing.assert_allclose(movers.object_pose('drone', 0.5), cprox.transform([1, -0.5, 0]), atol=1e-12)

        # two that slide past each other, each pair by itself
        pairs = grounded.nearest_pairs(k=20, against='both')
        self.assertEqual({frozenset((p['a'], p['b'])) for p in pairs},
                         {frozenset(p) for p in (('left/ball', 'left/hook'), ('right/ball', 'right/hook'), ('left/ball', 'right/ball'),
                                                 ('left/ball', 'right/hook'), ('left/hook', 'right/ball'), ('left/hook', 'right/hook'), ('left/ball', 'block'),
                                                 ('right/ball', 'block'), ('left/hook', 'block'), ('right/hook', 'block'))})
        for pair in pairs:
            self.assertAlmostEqual(pair['result'].upper, apart((pair['a'], pair['b']), t).min(), delta=1e-5)
        self.assertEqual([p['result'].upper for p in pairs], sorted(p['result'].upper for p in pairs))
        self.assertEqual(len(grounded.nearest_pairs(k=20, within=0.36, against='both')), 3)
        for against, least in (('others', 0.3), ('objects', 0.4), ('movers', 0.15), ('both', 0.15)):
            found = grounded.distance(against=against)['result']
            self.assertTrue(found.lower <= least + 1e-9 and least - 1e-9 <= found.upper <= found.lower + 1e-6, (against, found))
            self.assertEqual([grounded.tolerance(least + step, against=against)['result'].verdict for step in (-1e-3, 1e-3)],
                             ['clear', 'violated'])
            self.assertEqual(grounded.collision(against=against)['result'].verdict, 'clear')
            self.assertEqual(grounded.time_of_contact(against=against)['result'].t_contact_lower, 2.0)
            self.assertAlmostEqual(grounded.profile([0, 2], against=against)['upper'][0], least, delta=1e-6)
            self.assertEqual(grounded.violations(least - 1e-3, against=against), [])
            self.assertEqual(len(grounded.violations(least + 1e-3, against=against, resolution=1e-6)), 1)
        self.assertAlmostEqual(cprox.Movers(still, motions, allowed=[('left', 'right')]).distance()['result'].upper, 0.4, delta=1e-5)

        # the ball that flies: it meets the ball on the left rail
        first = 1 - 0.3 / 2**0.5
        for ask in (movers, cprox.Movers(flown, motions, dict(left=0.0, right=0.0), dict(left=0.0))):
            contact = ask.time_of_contact('left')
            self.assertEqual((contact['a'], contact['b'], contact['result'].verdict), ('ball', 'drone', 'violated'))
            self.assertTrue(first - 1e-5 <= contact['result'].t_contact_lower <= first <= contact['result'].t + 1e-9 <= first + 1e-4)
        self.assertEqual(movers.collision('left')['result'].verdict, 'violated')
        self.assertEqual(movers.collision('left', links=['hook'])['result'].verdict, 'clear')
        breaks = numpy.linspace(0, 2, 9)
        for robot, links in (('left', []), ('right', []), ('right', ['hook']), ('', ['drone'])):
            profile = movers.profile(breaks, robot, links=links)
            asked = [n for n in radii if (n.split('/')[0] == robot if robot else n == 'drone') and (not links or n.split('/')[-1] in links)]
            both = [(a, b) for a in asked for b in radii if a != b and a.split('/')[0] != b.split('/')[0] and (a, b) != ('drone', 'block')]
            clear = numpy.minimum.reduce([apart(pair, t) for pair in both])
            if not robot:
                clear = numpy.minimum(clear, apart(('drone', 'block'), t))
            for i, (t0, t1) in enumerate(zip(breaks, breaks[1:])):
                least = max(0.0, clear[(t >= t0) & (t <= t1)].min())
                self.assertTrue(profile['lower'][i] - 1e-9 <= least <= profile['upper'][i] + 1e-4, (robot, links, i, least))
                self.assertTrue(t0 <= profile['t'][i] <= t1 and profile['upper'][i] - profile['lower'][i] <= 1e-6)
            self.assertEqual(len(profile['a']), 8)
        (near,) = movers.violations(0.5, 'left', resolution=1e-6, objects=['drone'], links=['ball'])
        for side, truth in (('enter', 1 - 0.8 / 2**0.5), ('leave', 1 + 0.8 / 2**0.5)):
            self.assertTrue(near[side + '_lower'] <= truth <= near[side + '_upper'] <= near[side + '_lower'] + 1e-5)

        # a start that is known to within .1 s, and none at all
        late = numpy.linspace(-0.1, 0.1, 401)[:, None]
        touching = (apart(('left/ball', 'drone'), t[None], late) <= 0).any(axis=0)
        about = cprox.Movers(flown, motions, tolerances=dict(left=0.1))
        self.assertEqual(about.domain, [-0.1, 2.1])
        contact = about.time_of_contact('left')['result']
        self.assertAlmostEqual(contact.t, t[touching][0], delta=2e-4)
        self.assertLessEqual(contact.t_contact_lower, t[touching][0])
        swept = cprox.Movers(flown, motions, tolerances=dict(right=numpy.inf)).distance(objects=['right'], links=['drone'])['result']
        self.assertTrue(swept.lower <= 0.0 <= swept.upper <= 1e-6)

        for wrong, words in ((lambda: movers.distance(against='all'), "got 'all'"),
                             (lambda: movers.profile([0, 1], 'left', against='movers'), "does not apply to robot 'left'"),
                             (lambda: movers.profile([1, 0]), 'break 1 is 0'), (lambda: movers.time_of_contact('third'), "no motion 'third'"),
                             (lambda: movers.violations(0.1, 'left', links=['elbow']), "'left/elbow'"),
                             (lambda: movers.nearest_pairs(objects=['bal']), "'bal'"), (lambda: movers.object_pose('left', 0), "'left'"),
                             (lambda: cprox.Movers(flown, motions, tolerances=dict(third=1)), "tolerances name 'third'")):
            with self.assertRaisesRegex(ValueError, words):
                wrong()

    def test_a_query_of_robots_hears_signals_while_it_runs(self):
        """The handler ends it when it is called a third time: after the query it would be called once."""
        scene = cprox.Scene(self.robot)
        scene.add('ball', 'sphere', [.1], cprox.transform([.6, .5, 1.2]))
        motion = self.motion(scene)
        movers = cprox.Movers(scene, dict(first=motion, second=cprox.Motion(scene, self.joints, self.times, self.positions,
                                                                            base=cprox.transform([1.5, 0, 0]))))
        breaks = numpy.linspace(*motion.domain, 1000001)
        for profile in (motion.profile, movers.profile):
            calls = []

            def handler(*_):
                calls.append(1)
                if len(calls) == 3:
                    raise KeyboardInterrupt
            before = signal.signal(signal.SIGALRM, handler)
            signal.setitimer(signal.ITIMER_REAL, .02, .02)
            try:
                with self.assertRaises(KeyboardInterrupt):
                    profile(breaks)
            finally:
                signal.setitimer(signal.ITIMER_REAL, 0)
                signal.signal(signal.SIGALRM, before)

    def test_rows_are_the_nearest_of_each_pair_between_breaks_with_their_gradients(self):
        scene = cprox.Scene(self.robot)
        scene.add('ball', 'sphere', [.1], cprox.transform([.6, .5, 1.2]))
        positions, velocities = (numpy.array(rows[:4]) for rows in (self.positions, self.velocities))

        def moved(step=0.0):
            return cprox.Motion(scene, self.joints, self.times[:4], positions + step, velocities)
        motion, breaks = moved(), [self.times[0], self.times[1], self.times[3]]
        rows = motion.rows(5.0, per_pair=2, breaks=breaks, epsilon=1e-11)
        n = len(rows['a'])
        self.assertGreater(n, len(motion.links(moving_only=True)))
        self.assertEqual({name: rows[name].shape for name in ('lower', 'valid', 'positions', 'velocities', 'witness_a', 'object_linear')},
                         {'lower': (n,), 'valid': (n,), 'positions': (n, 4, 7), 'velocities': (n, 4, 7), 'witness_a': (n, 3),
                          'object_linear': (n, 3)})
        self.assertIsNone(rows['accelerations'])
        self.assertEqual(set(rows['b']), {'ball'})
        for t0, t1 in zip(breaks, breaks[1:]):
            of = rows['t0'] == t0
            self.assertTrue(((t0 <= rows['t'][of]) & (rows['t'][of] <= t1) & (rows['t1'][of] == t1)).all())
            self.assertGreater(rows['upper'][of].min(), motion.profile([t0, t1])['lower'][0] - 1e-9)
        self.assertAlmostEqual(rows['upper'].min(), motion.distance()['result'].upper, places=5)
        self.assertTrue((numpy.abs(numpy.linalg.norm(rows['witness_a'] - rows['witness_b'], axis=1) - rows['upper']) < 1e-9).all())
        i = int(numpy.argmin(rows['upper']))
        self.assertTrue(rows['valid'][i], rows['reason'][i])
        step = numpy.random.default_rng(1).uniform(-1e-6, 1e-6, positions.shape)
        high, low = (moved(s * step).distance(epsilon=1e-12)['result'].upper for s in (1, -1))
        self.assertAlmostEqual(numpy.sum(rows['positions'][i] * step), (high - low) / 2, delta=1e-11)
        self.assertEqual((motion.rows(0.0)['positions'], motion.rows(0.0)['lower'].shape), (None, (0,)))
        with self.assertRaisesRegex(RuntimeError, 'more than 1 rows'):
            motion.rows(5.0, most=1)
        deep = cprox.Scene(self.robot)
        deep.add('block', 'box', [3, 3, 3])
        inside = cprox.Motion(deep, self.joints, self.times[:4], positions, velocities)
        self.assertLess(inside.rows(0.01, signed=True)['lower'].min(), -.1)
        self.assertEqual(inside.gradient(signed=True)['result'].upper, inside.distance(signed=True)['result'].upper)

    def test_scene_and_trajectory_files_are_what_they_say(self):
        path = os.path.join(DATA, 'scenes/mbm/box_panda/scene0001.yaml')
        scene = cprox.Scene(self.robot)
        scene.add('old', 'sphere', [1])
        scene.load(path)
        with open(path) as text:
            objects = yaml.safe_load(text)['world']['collision_objects']
        self.assertEqual(scene.objects, sorted(o['id'] for o in objects))
        loaded = cprox.Motion.from_file(scene, os.path.join(DATA, 'trajectories/panda_box_0001_rrt.yaml'))

        by_hand = cprox.Scene(self.robot)
        for o in objects:
            for shape, pose in zip(o['primitives'], o['primitive_poses']):
                by_hand.add(o['id'], shape['type'], shape['dimensions'], cprox.transform(pose['position'], pose['orientation']))
        ours, theirs = loaded.distance(), self.motion(by_hand).distance()
        self.assertEqual((ours['a'], ours['b']), (theirs['a'], theirs['b']))
        self.assertAlmostEqual(ours['result'].upper, theirs['result'].upper, delta=1e-9)
        self.assertEqual(loaded.domain, self.motion(by_hand).domain)

    def test_bad_files_are_told(self):
        scene = cprox.Scene(self.robot)
        with self.assertRaises(ValueError) as caught:
            scene.load('nowhere.yaml')
        self.assertIn('nowhere.yaml', str(caught.exception))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'bad.yaml')
            for text, words in (('world: {collision_objects: [{id: x, header: {frame_id: moon}, primitives: [{type: sphere, '
                                 'dimensions: [1]}], primitive_poses: [{position: [0, 0, 0]}]}]}', ['x', 'moon']),
                                ('world: {collision_objects: [{id: x, primitives: [{type: sphere, dimensions: [1, 2]}], '
                                 'primitive_poses: [{position: [0, 0, 0]}]}]}', ['x'])):
                with open(path, 'w') as out:
                    out.write(text)
                with self.assertRaises(ValueError) as caught:
                    scene.load(path)
                for word in words:
                    self.assertIn(word, str(caught.exception))
            self.assertEqual(scene.objects, [])
            with open(path, 'w') as out:
                out.write('{nmae: x, world: {collision_objects: []}}')
            with self.assertWarns(UserWarning) as warned:
                scene.load(path)
            self.assertIn('nmae', str(warned.warning))
            with self.assertRaises(ValueError) as caught:
                cprox.Motion.from_file(scene, path)
            self.assertIn('joint_trajectory', str(caught.exception))

    def test_what_moves_is_never_left_out_in_silence(self):
        scene = cprox.Scene(self.robot)
        ball = ('{id: ball, primitives: [{type: sphere, dimensions: [0.1]}], trajectory: {waypoints: [{time: 0, pose: {position: '
                '[0, 0, 9]}}, {time: 1, pose: {position: [0, 0, 8]}}]}}')
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'moving.yaml')
            for text, words in (('moving_robots: [{name: second, robot: a.urdf, trajectory: {joint_trajectory: {joint_names: [a], points: '
                                 '[{positions: [0], time_from_start: 0}]}}}]', 'second'), ('world: {collision_objects: [%s]}' % ball, '')):
                with open(path, 'w') as out:
                    out.write(text)
                if words:
                    with self.assertRaises(ValueError) as caught:
                        scene.load(path)
                    self.assertIn(words, str(caught.exception))
                else:
                    scene.load(path)
        motion = self.motion(scene)
        for ask in (motion.distance, motion.collision):
            with self.assertRaises(ValueError) as caught:
                ask()
            self.assertIn("object 'ball' moves along a trajectory", str(caught.exception))

    def test_a_certificate_proves_its_answer_and_no_other(self):
        scene = cprox.Scene(self.robot)
        scene.add('ball', 'sphere', [0.1], cprox.transform([0.6, 0.5, 1.2]))
        motion = self.motion(scene)
        least = motion.distance()['result'].lower
        self.assertGreater(least, 0.01)
        for delta, claim in ((0.5 * least, 'apart'), (None, 'apart')):
            proof = motion.certificate(delta=delta)
            self.assertEqual(proof['claim'], claim)
            self.assertIn('proven: farther than', cprox.check(proof))
        proof = motion.certificate(delta=0.5 * least)
        for record in (b'', proof['record'][:20], proof['record'][::-1]):
            with self.assertRaises(ValueError):
                cprox.check(dict(proof, record=record))
        other = cprox.Scene(self.robot)  # the same ball, nearer than the proof says
        other.add('ball', 'sphere', [0.1 + 0.75 * least], cprox.transform([0.6, 0.5, 1.2]))
        with self.assertRaisesRegex(ValueError, 'refused'):
            cprox.check(dict(proof, query=self.motion(other).certificate(delta=0.1 * least)['query']))
        with self.assertRaises(FileNotFoundError):
            cprox.check(proof, program='no_such_program')

    def test_a_certificate_of_a_curve_proves_its_answer_and_no_other(self):
        """One curve in each basis that has certificates, past a ball; 0.3 beside its centre and more."""
        line = numpy.array([[-1.0, 0.3, 0.0], [0.0, 0.35, 0.0], [1.0, 0.3, 0.2]])
        scene, larger = cprox.Scene(), cprox.Scene()
        scene.add('ball', 'sphere', [0.1])
        larger.add('ball', 'sphere', [0.2])
        curves = (cprox.bezier(line), cprox.bspline(line, 2, [0, 0, 0, 1, 1, 1]), cprox.polynomial(line, -1.0, 0.5),
                  cprox.legendre(line), cprox.lagrange(line, [0, 0.5, 1], 0, 1), cprox.trigonometric(line, 0, 1))
        for curve in curves:
            least = scene.distance(curve, radius=0.02)['result'].lower
            self.assertGreater(least, 0.01)
            for delta in (None, 0.5 * least):
                proof = scene.certificate(curve, delta, radius=0.02)
                self.assertEqual(proof['claim'], 'apart')
                self.assertIn('proven: farther than', cprox.check(proof))
            nearer = larger.certificate(curve, radius=0.02 + least)
            self.assertEqual(nearer['claim'], 'near')
            with self.assertRaisesRegex(ValueError, 'refused'):
                cprox.check(dict(proof, query=nearer['query']))
        self.assertEqual(scene.certificate(curves[0], 1.0)['claim'], 'near')
        for curve in (curves[0].restrict(0.0, 0.5), cprox.clothoid([0, 1, 0], 0.0, 0.1, 0.1, 0.0, 1.0)):
            with self.assertRaisesRegex(ValueError, 'no certificate'):
                scene.certificate(curve)

    def test_violations_are_where_the_profile_is_below_delta(self):
        scene = cprox.Scene(self.robot)
        scene.add('ball', 'sphere', [0.1], cprox.transform([0.6, 0.5, 1.2]))
        motion = self.motion(scene)
        breaks = numpy.linspace(*motion.domain, 301)
        profile = motion.profile(breaks, epsilon=1e-5)
        delta = float(numpy.median(profile['upper']))
        found = motion.violations(delta)
        self.assertTrue(found)
        for first, second in zip(found, found[1:]):
            self.assertLessEqual(first['leave_upper'], second['enter_lower'])
        for t0, t1, lower, upper in zip(breaks, breaks[1:], profile['lower'], profile['upper']):
            if lower > delta:
                self.assertFalse([v for v in found if v['enter_upper'] <= t1 and v['leave_lower'] >= t0
                                  and v['verdict'] == 'violated'], (t0, t1))
            if upper < delta:
                self.assertTrue([v for v in found if v['enter_lower'] <= t1 and v['leave_upper'] >= t0], (t0, t1))
        self.assertEqual(motion.violations(0.5 * motion.distance()['result'].lower), [])
        for bad in (-1.0, float('nan')):
            with self.assertRaises(ValueError):
                motion.violations(bad)
        with self.assertRaises(ValueError):
            motion.violations(delta, resolution=0.0)

    def test_self_collision_and_changes_of_the_scene(self):
        scene = cprox.Scene(self.robot)
        motion = self.motion(scene)
        nothing = motion.collision()
        self.assertEqual((nothing['status'], nothing['result'].lower, nothing['result'].verdict), ('empty', 0, 'undecided'))
        self.assertIn('no object', nothing['message'])
        meant = motion.collision(allow_empty=True)
        self.assertEqual((meant['status'], meant['result'].lower, meant['result'].verdict), ('ok', math.inf, 'clear'))
        self.assertEqual(motion.profile([0, 1])['gap'], 'empty')
        self.assertEqual([one['verdict'] for one in motion.violations(0.1)], ['undecided'])
        self.assertEqual([one['status'] for one in motion.nearest_pairs(within=0.1)], ['empty'])
        answer = motion.distance(self_collision=True)
        self.assertEqual(answer['kind'], 'self')
        self.assertGreater(answer['result'].lower, 0)
        scene.add('wall', 'box', [2, 2, 2], cprox.transform([0, 0, 1]))
        self.assertEqual(self.motion(scene).collision()['result'].verdict, 'violated')
        scene.move('wall', cprox.transform([0, 0, 9]))
        self.assertEqual(self.motion(scene).collision()['result'].verdict, 'clear')
        scene.remove('wall')
        self.assertEqual(scene.objects, [])
        with self.assertRaises(ValueError):
            scene.remove('wall')
        with self.assertRaises(ValueError) as caught:
            cprox.Motion(scene, ['elbow'], [0, 1], [[0], [1]])
        self.assertIn('elbow', str(caught.exception))


class Edges(unittest.TestCase):
    """Straight motions between postures of the arm of examples/formats, among balls."""

    @classmethod
    def setUpClass(cls):
        folder = os.path.join(DATA, '..', '..', 'examples', 'formats')
        cls.robot = cprox.Robot.from_urdf(os.path.join(folder, 'arm.urdf'), srdf=os.path.join(folder, 'arm.srdf'))
        cls.scene = cprox.Scene(cls.robot)
        r = numpy.random.default_rng(1)
        for i in range(6):
            cls.scene.add(f'ball{i}', 'sphere', [.08], cprox.transform(r.uniform([-.9, -.9, .2], [.9, .9, .5])))
        cls.joints = ['shoulder', 'elbow']

    def verdicts(self, start, end, self_collision, delta):
        """Of each edge, by the queries of its motion: 0 clear, 1 violated, 2 undecided."""
        out = []
        for a, b in zip(start, end):
            motion = cprox.Motion(self.scene, self.joints, [0, 1], [a, b])
            found = [motion.tolerance(delta, self_collision=own)['result'].verdict for own in ([False, True] if self_collision else [False])]
            out.append(1 if 'violated' in found else 2 if 'undecided' in found else 0)
        return out

    def test_verdicts_are_those_of_each_edge_alone(self):
        r = numpy.random.default_rng(2)
        start, end = r.uniform(-2.5, 2.5, (2, 60, 2))
        for self_collision in (False, True):
            for delta in (0.0, 0.05):
                found = cprox.edges(self.scene, self.joints, start, end, delta, self_collision=self_collision)
                self.assertEqual(found.dtype, numpy.uint8)
                self.assertEqual(found.tolist(), self.verdicts(start, end, self_collision, delta))
                self.assertEqual(len(set(found.tolist())), 2)
        one = cprox.edges(self.scene, self.joints, start[0], end, 0.05)
        self.assertEqual(one.tolist(), self.verdicts([start[0]] * 60, end, True, 0.05))
        self.assertEqual(cprox.edges(self.scene, self.joints, numpy.empty((0, 2)), numpy.empty((0, 2))).shape, (0,))

    def test_verdicts_do_not_depend_on_how_the_ends_stand_in_memory(self):
        r = numpy.random.default_rng(3)
        start, end = r.uniform(-2.5, 2.5, (2, 500, 2))
        found = cprox.edges(self.scene, self.joints, start, end, 0.05)
        self.assertEqual(len(set(found.tolist())), 2)
        wide = numpy.zeros((500, 4))
        wide[:, ::2] = end
        for a, b in ((numpy.asfortranarray(start), end), (start, wide[:, ::2]), (start.tolist(), end.tolist())):
            self.assertEqual(cprox.edges(self.scene, self.joints, a, b, 0.05).tobytes(), found.tobytes())
        rows = numpy.arange(500)
        by_rows = cprox.edge_verdicts(self.scene, self.joints, numpy.concatenate((start, end)), numpy.stack((rows, rows + 500), 1),
                                      0.05, whole=True)
        self.assertEqual(by_rows.tobytes(), found.tobytes())
        turned = cprox.edges(self.scene, self.joints[::-1], start[:, ::-1], end[:, ::-1], 0.05, threads=3)
        self.assertEqual(turned.tobytes(), found.tobytes())

    def test_what_is_no_edge_is_refused(self):
        for edges, to in ((None, None), ([[0, 1]], [[1, 1], [2, 2]]), (None, [[1, 1]])):
            with self.assertRaisesRegex(ValueError, 'edges are rows of vertices, or None'):
                cprox.edge_verdicts(self.scene, self.joints, [[0, 0], [1, 1]], edges, 0, to=to)
        for start, end, words in (([[0, float('nan')]], [[1, 1]], 'nan|finite'), ([[0, 0]], [[1, float('inf')]], 'inf|finite'),
                                  ([[0, 0, 0]], [[1, 1, 1]], 'joints'), ([[[0, 0]]], [[[1, 1]]], 'shape'),
                                  ([[0, 0]] * 2, [[1, 1]] * 3, 'broadcast')):
            with self.assertRaisesRegex(ValueError, words):
                cprox.edges(self.scene, self.joints, start, end)
        with self.assertRaisesRegex(ValueError, 'knee'):
            cprox.edges(self.scene, ['shoulder', 'knee'], [[0, 0]], [[1, 1]])
        for edges, words in (([[0, 1.5]], 'edges must be whole numbers, got an array of float64'), ([[0, -1]], 'from 0 to'),
                             ([[0, 2]], 'vert')):
            with self.assertRaisesRegex(ValueError, words):
                cprox.edge_verdicts(self.scene, self.joints, [[0, 0], [1, 1]], edges, 0)
        with self.assertRaisesRegex(ValueError, 'known'):
            cprox.edge_verdicts(self.scene, self.joints, [[0, 0], [1, 1]], [[0, 1]], 0, known=[7])

    def test_nothing_to_measure_is_not_clear(self):
        empty = cprox.Scene(self.robot)
        self.assertEqual(cprox.edges(empty, self.joints, [[0, 0]], [[1, 1]], self_collision=False).tolist(), [2])
        self.assertEqual(cprox.edges(empty, self.joints, [[0, 0]], [[1, 1]], self_collision=False, allow_empty=True).tolist(), [0])

    def test_moving_only_leaves_out_what_stands_in_every_query(self):
        """The elbow turns; the upper arm stands 2 cm beside a ball."""
        scene = cprox.Scene(self.robot)
        scene.add('ball', 'sphere', [.1], cprox.transform([.3, -.15, .3]))
        motion = cprox.Motion(scene, self.joints, [0, 1], [[0, .5], [0, 1]])
        movers = cprox.Movers(scene, {'arm': motion})
        for one, prefix in ((motion, ''), (movers, 'arm/')):
            queries = [('distance', {}), ('time_of_contact', {}), ('tolerance', {'delta': .01}), ('collision', {}), ('gradient', {})]
            for name, words in queries:
                if one is movers and name == 'gradient':
                    words = {'robot': 'arm'}
                all_links, moving = (getattr(one, name)(moving_only=only, **words) for only in (False, True))
                self.assertNotIn('moving_only', all_links['message'], name)
                self.assertIn('moving_only', moving['message'], name)
                if name in ('distance', 'gradient'):
                    self.assertEqual([found['a'].split('/')[-1] for found in (all_links, moving)], ['upper', 'lower'], name)
                    self.assertGreater(moving['result'].lower, all_links['result'].upper + .1, name)
            for only, link in ((False, 'upper'), (True, 'lower')):
                self.assertEqual(one.profile([0, 1], moving_only=only)['a'], [prefix + link])
                self.assertEqual([pair['a'] for pair in one.nearest_pairs(k=1, moving_only=only)], [prefix + link])
                self.assertEqual(len(one.violations(.05, moving_only=only)), 0 if only else 1)
        self.assertEqual(movers.gradients(moving_only=True)['a'], 'arm/lower')
        self.assertEqual(set(motion.rows(9, moving_only=True)['a']), {'lower'})
        proof = motion.certificate(.05, moving_only=True)
        self.assertIn('farther than', cprox.check(proof))
        self.assertEqual((proof['claim'], motion.certificate(.05)['claim']), ('apart', 'near'))


class Examples(unittest.TestCase):
    def test_an_arm_is_pushed_out_by_scipy_and_proven_clear(self):
        files = [os.path.join(DATA, name) for name in ('robots/panda/panda.urdf', 'robots/panda/panda.srdf',
                                                       'scenes/mbm/bookshelf_thin_panda/scene0042.yaml',
                                                       'trajectories/panda_bookshelf_thin_0042_rrt.yaml')]
        example = os.path.join(DATA, '..', '..', 'examples', 'push_out_arm.py')
        with tempfile.TemporaryDirectory() as folder:
            picture = os.path.join(folder, 'arm.png')
            for options, least in (([], '8.6'), (['--straight'], '0.0')):
                done = subprocess.run([sys.executable, example, *options, *files, picture], stdout=subprocess.PIPE,
                                      stderr=subprocess.STDOUT, timeout=300, text=True)
                self.assertEqual(done.returncode, 0, done.stdout)
                before, after, end = done.stdout.splitlines()
                self.assertTrue(before.startswith(f'before: at least {least}') and before.endswith('no'), before)
                self.assertTrue(after.endswith('more than 10 mm everywhere: proven'), after)
                self.assertIn('terminated successfully', end)
                self.assertGreater(os.path.getsize(picture), 10000)


if __name__ == '__main__':
    outcome = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromModule(__import__('__main__')))
    failed = len(outcome.failures) + len(outcome.errors)
    print(f'{outcome.testsRun - failed} passed, {failed} failed')
    raise SystemExit(failed > 0 or outcome.testsRun == 0)
