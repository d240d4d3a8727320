# SPDX-License-Identifier: BSD-3-Clause
"""cprox robust: a cart on a slide in front of a wall, whose losses are known in closed form."""
import json
import math
import os
import re

from support import Case, cprox
from test_trajectory import SLIDE, SLIDER, WALL

GAP = 0.9  # [m] at t = 4, where the cart is fastest and farthest


class Robust(Case):
    def robust(self, errors, *more, scene=WALL, trajectory=SLIDE, name='errors.yaml'):
        words = ['robust', '--errors', self.file(name, errors), '--robot', self.file('robot.urdf', SLIDER), '--trajectory',
                 self.file('go.yaml', trajectory)]
        return cprox(*words, *(['--scene', self.file('scene.yaml', scene)] if scene else []), *more)

    def each_bound_costs_what_its_formula_says(self):
        # the cart goes 2 m in 4 s
        for errors, loss in (('joints: {slide: {tracking: 0.3}}', 0.3), ('joints: {slide: {speed: 0.2}}', 0.1),
                             ('joints: {slide: {tracking: 0.3, speed: 0.2}}', 0.4), ('sensor: 0.25', 0.25),
                             ('base: {position: 0.3}', 0.3), ('objects: {position: 0.15}', 0.15), ('flex: 0.2', 0.2),
                             ('{sensor: 0.1, flex: 0.1, objects: {position: 0.1}}', 0.3)):
            for delta in (0.0, 0.2):
                with self.subTest(errors=errors, delta=delta):
                    answer = self.robust(errors, '--delta', delta)
                    self.assertEqual((answer.code, answer.err), (0, ''))
                    row = answer.row('go')
                    self.assertEqual((row['status'], row['verdict']), ('ok', 'clear'))
                    self.assertIn(row['b'], ('wall', ''))  # '': bounding spheres alone have decided
                    self.assertGreater(float(row['lower']), delta)
                    self.assertLessEqual(float(row['lower']), GAP - loss + 1e-9)
                    certified, refused = float(row['certified_scale']), float(row['refused_scale'])
                    self.assertLessEqual(certified, (GAP - delta) / loss * (1 + 1e-9))
                    self.assertGreaterEqual(refused, (GAP - delta) / loss * (1 - 1e-9))
                    self.assertGreaterEqual(certified, 0.9 * refused)

    def the_verdict_is_that_of_all_executions(self):
        for tracking, delta, verdict, code in ((0.89, 0, 'clear', 0), (0.91, 0, 'undecided', 3), (0.1, 0.79, 'clear', 0),
                                               (0.1, 0.81, 'undecided', 3), (0.1, 0.91, 'violated', 1)):
            answer = self.robust(f'joints: {{slide: {{tracking: {tracking}}}}}', '--delta', delta)
            self.assertEqual((answer.row('go')['verdict'], answer.code), (verdict, code), (tracking, delta))
            if verdict == 'violated':
                self.assertEqual(float(answer.row('go')['certified_scale']), 0.0)

    def a_motion_that_is_late_as_a_whole_costs_nothing(self):
        row = self.robust('timing: 1').row('go')
        self.assertEqual((row['verdict'], float(row['certified_scale'])), ('clear', math.inf))

    def asked(self, command, errors, *more, scene=WALL, trajectory=SLIDE):
        return cprox(command, '--errors', self.file('errors.yaml', errors), '--robot', self.file('robot.urdf', SLIDER),
                     '--trajectory', self.file('go.yaml', trajectory), '--scene', self.file('scene.yaml', scene), *more)

    def a_profile_is_that_of_all_executions(self):
        """The cart goes 0.5 m/s from 2.9 m before the wall; what is late or early is where it was or will be."""
        for errors, loss, timing in (('sensor: 0.25', 0.25, 0), ('joints: {slide: {tracking: 0.1, speed: 0.2}}', 0.2, 0),
                                     ('{flex: 0.1, timing: 0.3}', 0.1, 0.3)):
            answer = self.asked('profile', errors, '--intervals', '8', '--objects', 'wall')
            self.assertEqual((answer.code, answer.err, len(answer.rows)), (0, '', 8))
            for row in answer.rows:
                least = 2.9 - 0.5 * min(4, float(row['t1']) + timing) - loss
                self.assertLessEqual(float(row['lower']), least + 1e-9, row)
                self.assertGreaterEqual(float(row['lower']), least - 1e-5, row)
                self.assertEqual(row['b'], 'wall')

    def no_execution_touches_before_the_time_of_contact(self):
        """At 1 m/s into the wall, at t = 2.9 without errors; at 0.5 m/s the wall is not reached."""
        crash = SLIDE.replace('[2]', '[4]')
        for errors, first in (('sensor: 0.25', 2.65), ('joints: {slide: {tracking: 0.1, speed: 0.2}}', 2.6), ('timing: 0.4', 2.5),
                              ('{base: {position: 0.2}, timing: 0.1}', 2.6)):
            row = self.asked('time-of-contact', errors, trajectory=crash).row('go')
            self.assertEqual(row['verdict'], 'violated')
            self.assertAlmostEqual(float(row['t']), 2.9, places=5)
            self.assertLessEqual(float(row['t_contact_lower']), first + 1e-9, errors)
            self.assertGreaterEqual(float(row['t_contact_lower']), first - 1e-3, errors)
        row = self.asked('time-of-contact', 'sensor: 0.89').row('go')
        self.assertEqual((row['verdict'], float(row['t_contact_lower'])), ('clear', 4))
        answer = self.asked('time-of-contact', 'sensor: 0.91')
        self.assertEqual((answer.code, answer.row('go')['verdict']), (3, 'undecided'))
        self.assertAlmostEqual(float(answer.row('go')['t_contact_lower']), (2.9 - 0.91) / 0.5, places=3)

    def a_report_has_bands_down_to_what_is_certified(self):
        """Each link's band: above the profile without errors, below what the errors leave of it."""
        page = os.path.join(self.folder, 'page.html')
        self.assertEqual(self.asked('report', 'sensor: 0.25', '--intervals', '8', '--objects', 'wall', '--out', page).code, 0)
        with open(page, encoding='utf-8') as file:
            data = json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', file.read(), re.S).group(1))
        self.assertTrue(data['errors'])
        self.assertIn('errors.yaml', data['inputs'][-1]['file'])
        bands = {profile['name']: profile for profile in data['profiles']}
        for lower, upper, end in zip(bands['cart']['lower'], bands['cart']['upper'], bands['cart']['t'][1:]):
            self.assertAlmostEqual(upper, 2.9 - 0.5 * end, places=5)
            self.assertAlmostEqual(lower, upper - 0.25, places=5)

    def limits_of_the_speed_hold_for_all_executions(self):
        separation = self.file('separation.yaml', 'person: {speed: 1.6}\nrobot: {reaction_time: 0.1, stopping_time: 0.5}\n')
        rows = self.asked('speed', 'sensor: 0.25', '--separation', separation, '--objects', 'wall').rows
        self.assertAlmostEqual(float(rows[-1]['override']), (0.9 - 0.25 - 0.16) / 0.8, places=3)

    def the_robot_itself_has_a_row(self):
        answer = self.robust('every_joint: {tracking: 1e-4}', '--self')
        self.assertEqual([row['kind'] for row in answer.rows], ['environment', 'self'])

    def what_is_left_out_is_never_certified(self):
        answer = self.robust('sensor: 0.1', scene=WALL.replace('world:', 'worldd: 1\nworld:'))
        row = answer.row('go')
        self.assertEqual((answer.code, row['status'], row['verdict'], float(row['certified_scale'])), (3, 'partial', 'undecided', 0.0))

    def what_is_wrong_is_said_in_one_line(self):
        for errors, *words in (('', 'errors.yaml', 'empty'), ('sensor: -1', 'errors.yaml', 'sensor (line 1)', 'below 0'),
                               ('sensor: .inf', 'sensor', '.inf'), ('senser: 1', "'senser'", "'sensor'"),
                               ('every_joint: {track: 1}', "'track'"), ('every_joint: 1', 'every_joint', 'map'),
                               ('base: {turn: 1}', "'turn'"), ('[1]', 'map')):
            with self.subTest(errors=errors):
                self.assertRefused(self.robust(errors), *words)
        unknown = self.robust('joints: {slyde: {tracking: 1}}')
        self.assertEqual((unknown.code, unknown.row('go')['status']), (2, 'invalid'))
        self.assertIn("no joint 'slyde' that moves by itself (did you mean 'slide'?)", unknown.err)
        self.assertRefused(cprox('robust', '--robot', 'r', '--trajectory', 't'), '--errors')
        self.assertRefused(cprox('robust', '--robot', 'r', '--errors', 'e'), '--trajectory')
        self.assertRefused(self.robust('sensor: 1', '--moving-links-only'), '--moving-links-only')
        self.assertRefused(self.asked('profile', 'sensor: 1', '--per-link'), '--per-link')
        self.assertRefused(self.asked('time-of-contact', 'sensor: 1', '--certificate', 'p'), '--errors', '--certificate')
        self.assertRefused(cprox('profile', '--curves', 'c', '--scene', 's', '--errors', 'e'), '--trajectory')
