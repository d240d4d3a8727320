# SPDX-License-Identifier: BSD-3-Clause
"""The examples of doc/formats.md: its commands, run as they stand there, and distances that were worked out by hand."""
import math
import os
import re
import shlex
import subprocess

from support import HERE, LIMIT, Answer, Case, cprox

REPO = os.path.dirname(os.path.dirname(HERE))
FILES = 'examples/formats/'
WORLD = ('--scene', FILES + 'scene.yaml')
ARM = ('--robot', FILES + 'arm.urdf', '--srdf', FILES + 'arm.srdf', '--trajectory', FILES + 'trajectory.yaml')


def run(*words):
    """cprox from the top of the checkout, as the page is written."""
    done = subprocess.run([os.environ['CPROX'], *words], cwd=REPO, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=LIMIT)
    return Answer(done.returncode, done.stdout.decode(), done.stderr.decode())


class Formats(Case):
    def every_command_of_the_page_runs_without_a_warning(self):
        with open(os.path.join(REPO, 'doc/formats.md'), encoding='utf-8') as page:
            text = page.read().replace('\\\n', ' ')
        commands = re.findall(r'^    cprox (.*)$', text, re.M)
        self.assertEqual(len(commands), 19)
        for command in commands:
            with self.subTest(command=command):
                answer = run(*shlex.split(command.replace('/tmp/', self.folder + '/')))
                verdicts = answer.code_of_verdicts() if 'verdict' in answer.header.split(',') else 0
                self.assertEqual(answer.code, verdicts, answer.err)
                told = 'shard 0 of 1: 2 of 2 rows' if command.startswith('certify') else ''
                self.assertTrue(answer.err.startswith(told) and (told or not answer.err), answer.err)
        for name, rows in (('cprox-results', ['ok', 'ok', 'ok']), ('cprox-results-csv', ['ok', 'ok'])):
            merged = cprox('merge', os.path.join(self.folder, name)).out.splitlines()
            self.assertEqual([line.split(',')[3] for line in merged[1:]], rows)

    def every_example_is_linked_on_the_page_or_by_another_example(self):
        with open(os.path.join(REPO, 'doc/formats.md'), encoding='utf-8') as page:
            linked = set(re.findall(r'\(\.\./examples/formats/([^)]*)\)', page.read()))
        files = set(os.listdir(os.path.join(REPO, FILES)))
        self.assertEqual(linked | {'ramp.obj'}, files)

    def curves_of_every_basis_are_where_the_file_says(self):
        answer = run('distance', '--curves', FILES + 'curves.csv', *WORLD, '--per-object')
        floor = {'line': 1.0, 'throw': 0.98, 'pass': 1.0, 'round': 0.99, 'arc': 1.0, 'half': 1.0, 'spiral': 1.0,
                 'drive': 0.9, 'unwound': 1.0, 'bend': 0.95, 'end': 1.0}
        for name, height in floor.items():
            self.assertAnswer(answer.row(name, 'floor'), height)
        sheet = {'round': math.hypot(0.3, 0.4) - 0.01, 'pass': math.hypot(0.3, 0.4)}  # its upper edge: y = 1.8, z = 0.6
        for name, gap in sheet.items():
            self.assertAnswer(answer.row(name, 'sheet'), gap)

    def shapes_of_every_kind_are_where_the_file_says(self):
        rows = run('distance', '--curves', FILES + 'curves.csv', *WORLD, '--per-object')
        self.assertEqual({row['b'] for row in rows.rows}, {'can', 'floor', 'ramp', 'sheet', 'pebble', 'lens', 'wedge'})
        # the line y = 0, z = 1: the can's top is at z = 0.34, its axis at y = 0.9; padding 0.01
        self.assertAnswer(rows.row('line', 'can'), math.hypot(0.9 - 0.03, 1 - 0.34) - 0.01)
        self.assertAnswer(rows.row('line', 'pebble'), 1 - 0.1 - 0.2 - 0.2 - 0.05)  # the capsule's upper end
        # the lens: a circle of radius 0.6 about x at y = -1.2, z = 0.5
        self.assertAnswer(rows.row('line', 'lens'), math.hypot(1.2, 0.5) - 0.6)
        # the line x = y = z of the wedge: its vertex at z = 0.3
        self.assertAnswer(rows.row('line', 'wedge'), math.hypot(0.5, 0.7))
        # the ramp's upper edge: y from -1.5 to -1, z = 0.5
        self.assertAnswer(rows.row('line', 'ramp'), math.hypot(1.0, 0.5))

    def the_arm_moves_as_the_file_says(self):
        answer = run('profile', *ARM, *WORLD, '--per-link', '--intervals', '12')
        self.assertEqual((answer.code, answer.err), (0, ''))
        self.assertEqual({row['a'] for row in answer.rows}, {'base', 'upper', 'lower'})
        self.assertEqual([float(answer.rows[0]['t0']), float(answer.rows[-1]['t1'])], [0.0, 3.0])
        ball = run('nearest', *ARM, *WORLD, '--pairs', '1').rows[0]
        least = min(float(row['upper']) for row in answer.rows)
        self.assertAlmostEqual(least, float(ball['upper']), delta=2e-6)

    def movers_pass_each_other_as_the_file_says(self):
        scene = ('--scene', FILES + 'movers.yaml')
        # where the box has turned by 45 degrees its edge is 0.1 sqrt(2) from its axis; the shelf ends at y = -1.45
        row = run('distance', *scene, '--movers').row('movers')
        self.assertAnswer(row, 0.15 - 0.1 * math.sqrt(2))
        self.assertEqual((row['a'], row['b']), ('box', 'shelf'))
        self.assertEqual(run('time-of-contact', *scene, '--movers').row('movers')['verdict'], 'clear')
        self.assertIn(run('distance', *ARM, *scene).row('trajectory')['b'], ('second/lower', 'shelf', 'box'))

    def the_tray_rides_as_the_files_say(self):
        # at the start its lower edge is at x = 0 .. 0.4, y = -0.5, z = 0.59; the lens: a circle of 0.6 about x at y = -1.2, z = 0.5
        row = run('distance', '--path', FILES + 'path.yaml', '--body', FILES + 'body.yaml', *WORLD).row('path')
        self.assertAnswer(row, math.hypot(0.7, 0.09) - 0.6 - 0.01)
        self.assertEqual((row['a'], row['b']), ('tray', 'lens'))
        self.assertAlmostEqual(float(row['t']), 0.0, delta=1e-3)

    def pairs_are_as_far_as_the_file_says(self):
        answer = run('pairs', '--in', FILES + 'pairs.yaml')
        self.assertAnswer(answer.row('balls'), 1.0)
        self.assertAnswer(answer.row('overlap'), -0.2)
        self.assertAnswer(answer.row('ramp_and_point'), 1.0)

    def curves_as_obstacles_are_as_far_as_the_files_say(self):
        # the line y = 0, z = 1 and the cable at y = 0.5, whose height is 1.2 + 1 - 4 s (1 - s) between 1.2 and 2.2: at s = 1/2
        answer = run('distance', '--curves', FILES + 'curves.csv', '--scene', FILES + 'cable.yaml')
        self.assertAnswer(answer.row('line'), math.hypot(0.5, 0.2) - 0.01 - 0.005)
        row = run('distance', '--curves', FILES + 'crossing.csv', '--scene', FILES + 'crossing.yaml').row('vehicle')
        self.assertEqual((row['b'], row['t']), ('other', row['t_b']))

    def cases_have_the_value_that_the_file_says(self):
        answer = run('constraints', '--provider', 'curve_proximity/CurveDistance', '--in', FILES + 'cases.yaml', *WORLD)
        self.assertAlmostEqual(float(answer.row('along')['value']), 0.45, delta=1e-6)
