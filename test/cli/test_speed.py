# SPDX-License-Identifier: BSD-3-Clause
"""cprox speed: a cart on a slide that drives at a wall, behind which persons may step forth."""
import json
import math

from support import Case, cprox
from test_trajectory import SLIDE, SLIDER, WALL

SEPARATION = 'person: {speed: 1.6, position: 0.05}\nrobot: {reaction_time: 0.1, stopping_time: 0.5}\nintrusion: 0.1\n'


class Speed(Case):
    def speed(self, separation, *more, objects='wall', scene=WALL, trajectory=SLIDE):
        return cprox('speed', '--separation', self.file('separation.yaml', separation), '--objects', objects, '--robot',
                     self.file('robot.urdf', SLIDER), '--trajectory', self.file('go.yaml', trajectory), '--scene',
                     self.file('scene.yaml', scene), *more)

    def limits_are_those_of_the_formula(self):
        """2.9 m ahead at t = 0, 0.9 m at t = 4, at 0.5 m/s: near the end a person has to be waited for."""
        answer = self.speed(SEPARATION, '--intervals', '400')
        self.assertEqual((answer.code, answer.err, len(answer.rows)), (0, '', 400))
        for row in answer.rows:
            k, t1, lower = float(row['override']), float(row['t1']), float(row['lower'])
            self.assertLessEqual(lower, 2.9 - 0.5 * t1 + 1e-9)
            # until it stands the cart goes k 0.1 + k² 0.25 [s] on, the person walks 0.1 + k 0.5 [s]
            stops = min(4.0, t1 + 0.1 * k + 0.25 * k * k)
            left = 2.9 - 0.5 * stops - 1.6 * (0.1 + 0.5 * k) - 0.15
            self.assertGreaterEqual(left, -1e-9)
            if k < 1 - 1e-9:
                self.assertLessEqual(left, 0.5 * 0.03)
        last = answer.rows[-1]
        self.assertAlmostEqual(float(last['override']), (0.9 - 0.15 - 0.16) / 0.8, places=3)
        self.assertEqual(last['override'], last['constant_override'])
        self.assertEqual(last['b'], 'wall')
        # 4 s at override k: the wall's persons come 1.6 m a second
        self.assertEqual(float(last['unwatched_override']), math.inf)

    def nobody_needs_to_watch_slow_persons(self):
        row = self.speed(SEPARATION.replace('1.6', '0.15'), '--intervals', '400').rows[0]
        self.assertAlmostEqual(float(row['unwatched_override']), 4 * 0.15 / (0.9 - 0.15 - 0.015), places=3)

    def a_robot_that_leaves_its_path_needs_its_speed(self):
        along = self.speed(SEPARATION, '--intervals', '50').rows[-1]
        free = self.speed(SEPARATION.replace('0.5}', '0.5, speed: 0.5}'), '--intervals', '50').rows[-1]
        k = float(free['override'])
        self.assertAlmostEqual(1.6 * 0.5 * k + 0.5 * (0.1 * k + 0.25 * k * k), 0.9 - 0.15 - 0.16, places=3)
        self.assertLess(k, float(along['override']))

    def json_has_the_same_table(self):
        rows = [json.loads(line) for line in self.speed(SEPARATION, '--json', '--intervals', '5').out.splitlines()]
        self.assertEqual([round(row['t1'], 9) for row in rows], [0.8, 1.6, 2.4, 3.2, 4.0])
        self.assertTrue(all(0 <= row['override'] <= 1 for row in rows))

    def what_is_left_out_has_no_speed(self):
        answer = self.speed(SEPARATION, scene=WALL.replace('world:', 'worldd: 1\nworld:'))
        self.assertEqual((answer.rows[0]['status'], float(answer.rows[0]['override'])), ('partial', 0.0))
        self.assertEqual(answer.code, 3)

    def what_is_wrong_is_said_in_one_line(self):
        for text, *words in (('', 'separation.yaml', 'empty'), ('person: {speed: 1}', 'robot'),
                             (SEPARATION.replace('speed: 1.6, ', ''), 'speed'), (SEPARATION.replace('1.6', '-1'), 'below 0'),
                             (SEPARATION.replace('stopping_time: 0.5', ''), 'stopping_time'),
                             (SEPARATION.replace('intrusion', 'intruson'), "'intruson'")):
            with self.subTest(text=text):
                self.assertRefused(self.speed(text), *words)
        self.assertRefused(cprox('speed', '--robot', 'r', '--trajectory', 't', '--objects', 'o'), '--separation')
        self.assertRefused(cprox('speed', '--robot', 'r', '--trajectory', 't', '--separation', 's'), '--objects')
        nobody = self.speed(SEPARATION, objects='nobody')
        self.assertEqual((nobody.code, nobody.rows[0]['status']), (2, 'invalid'))
        self.assertIn('nobody', nobody.err)
