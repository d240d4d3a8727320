# SPDX-License-Identifier: BSD-3-Clause
"""cprox margins: objects that are moved, by closed forms and by the query tolerance about scenes in which they are."""
import copy
import math
import os
import random

import yaml

from support import DATA, Case, cprox
from test_trajectory import SLIDE, SLIDER, WALL

AXES = {'+x': (1, 0, 0), '-x': (-1, 0, 0), '+y': (0, 1, 0), '-y': (0, -1, 0), '+z': (0, 0, 1), '-z': (0, 0, -1)}


class Margins(Case):
    def margins(self, *more, scene=WALL, trajectory=SLIDE):
        answer = cprox('margins', '--robot', self.file('robot.urdf', SLIDER), '--trajectory', self.file('go.yaml', trajectory),
                       '--scene', self.file('scene.yaml', scene), *more)
        return answer, {(row['object'], row['direction']): row for row in answer.rows}

    def between(self, row, true):
        free, blocked = float(row['free']), float(row['blocked'])
        self.assertLessEqual(free, true + 1e-9, row)
        self.assertGreaterEqual(blocked, true - 1e-9, row)
        self.assertLessEqual(blocked - free, max(1e-4, 0.0101 * free), row)

    def a_wall_may_come_as_near_as_the_cart_leaves_it(self):
        """The cart's hand reaches x = 2.1, the wall begins at 3; the post of .25 is 2 beside its way, as is the wall's end."""
        answer, rows = self.margins('--within', '5')
        self.assertEqual((answer.code, answer.err, len(rows)), (0, '', 14))
        for direction in ('any', '-x'):
            self.between(rows['wall', direction], 0.9)
        for direction in ('+x', '+y', '+z', '-z'):
            self.assertEqual((float(rows['wall', direction]['free']), float(rows['wall', direction]['blocked'])), (5, math.inf))
        # the post is 2 beside the way: the cart's side is at y = .1
        self.between(rows['post', '-y'], 2 - 0.25 - 0.1)
        self.assertEqual(float(rows['post', '+y']['free']), 5)
        self.assertAlmostEqual(float(rows['wall', '-x']['t']), 4, places=1)

    def a_clearance_that_is_asked_for_is_kept(self):
        for delta in (0.05, 0.3, 0.89):
            answer, rows = self.margins('--delta', delta)
            self.assertEqual(answer.code, 0)
            self.between(rows['wall', '-x'], 0.9 - delta)
            self.between(rows['wall', 'any'], 0.9 - delta)
        answer, rows = self.margins('--delta', '0.91')
        self.assertEqual((answer.code, float(rows['wall', '-x']['free']), float(rows['wall', '+y']['blocked'])), (1, 0, 0))

    def a_ball_that_comes_at_a_slant_is_met_where_the_formula_says(self):
        """A ball of .2 at (3, .15, 0) that goes to -x meets the hand, a ball of .1 that ends at x = 2, beside its middle."""
        ball = ('world: {collision_objects: [{id: ball, primitives: [{type: sphere, dimensions: [0.2]}], '
                'primitive_poses: [{position: [3, %s, 1.4]}]}]}')
        for y in (0.0, 0.15, 0.25, 0.29):
            _, rows = self.margins('--within', '2', scene=ball % y)
            self.between(rows['ball', '-x'], 1 - math.sqrt(0.09 - y * y))
        _, rows = self.margins('--within', '4', scene=ball % 0.5)
        self.assertEqual((float(rows['ball', '-x']['free']), float(rows['ball', '-x']['blocked'])), (4, math.inf))
        # 1 cm beside the hand for 2 m: that takes too many steps, and the row says so
        row = self.margins('--within', '4', scene=ball % 0.31)[1]['ball', '-x']
        self.assertEqual((row['status'], float(row['blocked'])), ('precision', math.inf))
        self.assertGreater(float(row['free']), 1)

    def what_is_left_out_is_never_free(self):
        answer, rows = self.margins(scene=WALL.replace('world:', 'worldd: 1\nworld:'))
        self.assertEqual((rows['wall', '+x']['status'], float(rows['wall', '+x']['free'])), ('partial', 0))
        self.assertEqual(answer.code, 3)

    def tolerance_says_the_same_of_objects_that_are_moved(self):
        """A Panda in the bookshelf, four of its objects (seed 4605): just within free, at blocked, and anywhere within any."""
        robot = os.path.join(DATA, 'robots', 'panda')
        scene_file = os.path.join(DATA, 'scenes', 'mbm', 'bookshelf_small_panda', 'scene0001.yaml')
        words = ['--robot', os.path.join(robot, 'panda.urdf'), '--srdf', os.path.join(robot, 'panda.srdf'), '--trajectory',
                 os.path.join(DATA, 'trajectories', 'panda_bookshelf_small_0001_rrt.yaml')]
        with open(scene_file) as stream:
            scene = yaml.safe_load(stream)
        names = sorted(thing['id'] for thing in scene['world']['collision_objects'])
        rng = random.Random(4605)
        names = rng.sample(names, 4)
        answer = cprox('margins', *words, '--scene', scene_file, '--objects', ', '.join(names), '--within', '0.5')
        self.assertIn(answer.code, (0, 1), answer.err)
        self.assertEqual(len(answer.rows), 7 * len(names))

        def verdict(name, way):
            moved = copy.deepcopy(scene)
            for thing in moved['world']['collision_objects']:
                for pose in thing['primitive_poses'] if thing['id'] == name else []:
                    pose['position'] = [p + w for p, w in zip(pose['position'], way)]
            text = cprox('collision', *words, '--objects', name, '--scene', self.file('moved.yaml', yaml.safe_dump(moved)))
            return text.rows[0]['verdict']

        asked = 0
        for row in answer.rows:
            free, blocked, name = float(row['free']), float(row['blocked']), row['object']
            way = [float(row[axis]) for axis in 'xyz']
            if row['direction'] == 'any':
                length = rng.uniform(0, free)
                way = [rng.gauss(0, 1) for _ in range(3)]
                size = math.hypot(*way)
                way = [w / size for w in way]
                self.assertEqual(verdict(name, [w * length for w in way]), 'clear', row)
            else:
                self.assertEqual(tuple(way), AXES[row['direction']])
                self.assertEqual(verdict(name, [w * free * (1 - 1e-6) for w in way]), 'clear', row)
            if blocked < 1 and row['direction'] != 'any':
                asked += 1
                self.assertEqual(verdict(name, [w * (blocked + 1e-9) for w in way]), 'violated', row)
        self.assertGreater(asked, 3)

    def what_is_wrong_is_said_in_one_line(self):
        self.assertRefused(cprox('margins', '--robot', 'r', '--trajectory', 't'), '--scene')
        self.assertRefused(cprox('margins', '--robot', 'r', '--trajectory', 't', '--scene', 's', '--within', '0'), '--within')
        answer, _ = self.margins('--objects', 'wal')
        self.assertEqual((answer.code, answer.rows[0]['status']), (2, 'invalid'))
