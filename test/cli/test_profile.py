# SPDX-License-Identifier: BSD-3-Clause
"""Profiles, nearest pairs and times of contact, of curves and of robots; standard input, headers, messages, exit codes."""
import math
import os
import subprocess

from support import BOX_SCENE, HEADER, LIMIT, PASSING, Answer, Case, bezier, cprox
from test_trajectory import SLIDE, SLIDER, WALL

VIOLATION = 'id,kind,status,verdict,enter_lower,enter_upper,leave_lower,leave_upper,upper,t,a,b,message'
PROFILE = 'id,kind,status,t0,t1,lower,upper,t,a_x,a_y,a_z,b_x,b_y,b_z,a,b,message'
TWO = '''
world:
  collision_objects:
    - {id: near, primitives: [{type: sphere, dimensions: [1]}], primitive_poses: [{position: [0, 0, 0]}]}
    - {id: far, primitives: [{type: sphere, dimensions: [1]}, {type: sphere, dimensions: [1]}],
       primitive_poses: [{position: [0, 0, 10]}, {position: [0, 0, 20]}]}
'''
# a ball of 0.5 along x = 3 t from -3 to 3, two metres above the centre of `near`
OVER = bezier('over', (-3, 0, 2), (3, 0, 2), radius=0.5)


def piped(text, *words):
    """Runs cprox with a text as its standard input."""
    done = subprocess.run([os.environ['CPROX'], *map(str, words)], input=text.encode(), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          timeout=LIMIT)
    return Answer(done.returncode, done.stdout.decode(), done.stderr.decode())


def robot_files(case, trajectory=SLIDE, scene=WALL):
    return ['--robot', case.file('robot.urdf', SLIDER), '--trajectory', case.file('go.yaml', trajectory),
            '--scene', case.file('scene.yaml', scene)]


class Curves(Case):
    def assertContains(self, row, true, epsilon=1e-6):
        self.assertEqual(row['status'], 'ok', row)
        self.assertLessEqual(float(row['lower']), true + 1e-12, row)
        self.assertGreaterEqual(float(row['upper']), true - 1e-12, row)
        self.assertLessEqual(float(row['upper']) - float(row['lower']), epsilon, row)

    def a_profile_has_an_interval_for_each_part_of_the_curve(self):
        answer = self.ask('profile', [OVER], TWO, '--intervals', '6')
        self.assertEqual((answer.code, answer.err, answer.header, len(answer.rows)), (0, '', PROFILE, 6))
        for k, row in enumerate(answer.rows):
            x = min(abs(-3 + k), abs(-2 + k))  # the least |x| on the interval
            self.assertContains(row, math.hypot(x, 2) - 1.5)
            self.assertEqual((row['id'], row['kind'], row['a'], row['b']), ('over', 'curve', 'over', 'near'))
            self.assertTrue(float(row['t0']) <= float(row['t']) <= float(row['t1']))
            on_tube, on_ball = ([float(row[f'{side}_{axis}']) for axis in 'xyz'] for side in 'ab')
            self.assertAlmostEqual(math.dist(on_tube, on_ball), float(row['upper']), delta=1e-9)
            self.assertAlmostEqual(math.hypot(*on_ball), 1.0, delta=1e-9)
            self.assertAlmostEqual(math.dist(on_tube, (-3 + 6 * float(row['t']), 0, 2)), 0.5, delta=1e-9)
        self.assertEqual((float(answer.rows[0]['t0']), float(answer.rows[-1]['t1'])), (0.0, 1.0))

    def violations_are_the_intervals_within_delta(self):
        """A ball of .5 at x = -3 + 6 t, z = 2 is within .6 of a ball of 1 at the origin where |x| <= sqrt(2.1^2 - 4)."""
        answer = self.ask('violations', [OVER, bezier('off', (-3, 0, 50), (3, 0, 50))], TWO, '--delta', '0.6', '--resolution', '1e-6')
        self.assertEqual((answer.code, answer.err, answer.header), (1, '', VIOLATION))
        row, clear = answer.rows
        half = math.sqrt(2.1 ** 2 - 4) / 6
        names = ('enter_lower', 'enter_upper', 'leave_lower', 'leave_upper')
        enter_lower, enter_upper, leave_lower, leave_upper = (float(row[name]) for name in names)
        self.assertTrue(enter_lower <= 0.5 - half + 1e-12 and 0.5 - half <= enter_upper + 1e-12, row)
        self.assertTrue(leave_lower <= 0.5 + half + 1e-12 and 0.5 + half <= leave_upper + 1e-12, row)
        self.assertLess(max(enter_upper - enter_lower, leave_upper - leave_lower), 1e-4)
        self.assertEqual((row['verdict'], row['a'], row['b']), ('violated', 'over', 'near'))
        self.assertTrue(enter_upper <= float(row['t']) <= leave_lower)
        self.assertEqual((clear['id'], clear['verdict'], clear['enter_lower']), ('off', 'clear', ''))
        self.assertEqual(self.ask('violations', [OVER], TWO, '--delta', '0.4').code, 0)
        for words, part in ((['--delta', '-1'], '--delta'), ([], '--delta'), (['--delta', '1', '--resolution', '0'], '--resolution')):
            self.assertRefused(self.ask('violations', [OVER], TWO, *words), part)

    def a_profile_takes_the_breaks_that_it_is_given(self):
        answer = self.ask('profile', [OVER], TWO, '--breaks', '0.5, 0.75,1')
        self.assertEqual([(float(row['t0']), float(row['t1'])) for row in answer.rows], [(0.5, 0.75), (0.75, 1.0)])
        self.assertContains(answer.rows[1], math.hypot(1.5, 2) - 1.5)
        for wrong in ('0', '1, 0', '0, 0', '0, x', '0,,1', ''):
            self.assertRefused(self.ask('profile', [OVER], TWO, '--breaks', wrong), '--breaks')
        outside = self.ask('profile', [OVER], TWO, '--breaks', '0, 2')
        self.assertEqual((outside.code, [row['status'] for row in outside.rows]), (2, ['invalid']))
        self.assertIn('2', outside.rows[0]['message'])

    def clearance_beyond_a_horizon_is_only_bounded(self):
        whole = self.ask('profile', [OVER], TWO, '--intervals', '6')
        answer = self.ask('profile', [OVER], TWO, '--intervals', '6', '--horizon', '0.9')
        self.assertEqual((answer.code, [row['status'] for row in answer.rows]), (0, ['ok'] * 6))
        wide = 0
        for row, true in zip(answer.rows, whole.rows):
            self.assertLessEqual(float(row['lower']), float(true['upper']))
            self.assertGreaterEqual(float(row['upper']), float(true['lower']))
            if float(row['upper']) - float(row['lower']) > 1e-6:
                self.assertGreater(float(row['lower']), 0.9)
                wide += 1
        self.assertGreater(wide, 0)
        for wrong in ('-1', 'nan', 'x'):
            self.assertRefused(self.ask('profile', [OVER], TWO, '--horizon', wrong), '--horizon')

    def a_profile_of_each_object(self):
        answer = self.ask('profile', [OVER], TWO, '--intervals', '1', '--per-object')
        self.assertContains(answer.row('over', 'near'), 0.5)
        self.assertContains(answer.row('over', 'far'), 6.5)

    def only_the_objects_that_are_named_take_part(self):
        for command, more in (('distance', ()), ('profile', ('--intervals', '1')), ('nearest', ('--pairs', '1')), ('distance', ('--per-object',)),
                              ('profile', ('--intervals', '1', '--per-object'))):
            row, = self.ask(command, [OVER], TWO, '--objects', ' far ', *more).rows
            self.assertContains(row, 6.5)
            self.assertEqual(row['b'], 'far')
        self.assertEqual(self.ask('tolerance', [OVER], TWO, '--delta', '1', '--objects', 'far').code, 0)
        self.assertEqual(self.ask('violations', [OVER], TWO, '--delta', '1', '--objects', 'far').rows[0]['verdict'], 'clear')
        self.assertEqual(self.ask('tolerance', [OVER], TWO, '--delta', '1', '--objects', 'far, near').code, 1)
        answer = self.ask('distance', [OVER], TWO, '--objects', 'nera')
        self.assertEqual(answer.code, 2)
        self.assertIn("no object 'nera'", answer.err)
        for wrong in ('', 'near,', 'near,,far'):
            self.assertRefused(self.ask('distance', [OVER], TWO, '--objects', wrong), '--objects')
        self.assertRefused(self.ask('distance', [OVER], TWO, '--objects', 'near', '--certificate', 'c'), '--objects')

    def the_nearest_shapes_come_first(self):
        answer = self.ask('nearest', [OVER, PASSING], TWO)
        self.assertEqual((answer.code, answer.err, answer.header), (0, '', HEADER))
        self.assertEqual([(row['id'], row['b']) for row in answer.rows],
                         [('over', 'near'), ('over', 'far'), ('over', 'far'), ('passing', 'near'), ('passing', 'far'), ('passing', 'far')])
        for row, true in zip(answer.rows, (0.5, 6.5, 16.5)):
            self.assertContains(row, true)
        self.assertEqual(len(self.ask('nearest', [OVER], TWO, '--pairs', '2').rows), 2)
        self.assertEqual([row['b'] for row in self.ask('nearest', [OVER], TWO, '--within', '7').rows], ['near', 'far'])
        nothing = self.ask('nearest', [OVER], TWO, '--within', '0.1')
        self.assertEqual((nothing.code, nothing.rows, nothing.err), (0, [], ''))

    def the_time_of_contact_is_not_late(self):
        hit = bezier('hit', (-3, 0, 0), (3, 0, 0), t0=10, t1=16)
        answer = self.ask('time-of-contact', [hit, OVER], TWO)
        self.assertEqual((answer.code, answer.header), (1, HEADER + ',t_contact_lower'))
        row = answer.row('hit')
        self.assertEqual((row['verdict'], row['b']), ('violated', 'near'))
        self.assertLessEqual(float(row['t_contact_lower']), 12.0)
        self.assertAlmostEqual(float(row['t_contact_lower']), 12.0, delta=1e-5)
        self.assertAlmostEqual(float(row['t']), 12.0, delta=1e-5)
        row = answer.row('over')
        self.assertEqual((row['verdict'], float(row['t_contact_lower'])), ('clear', 1.0))
        self.assertEqual(self.ask('time-of-contact', [OVER], TWO).code, 0)

    def options_are_for_their_commands(self):
        for command, option in (('distance', '--pairs=3'), ('distance', '--intervals=3'), ('profile', '--within=1'), ('nearest', '--breaks=0,1'),
                                ('nearest', '--certificate=c'), ('profile', '--signed'), ('time-of-contact', '--signed'),
                                ('nearest', '--against=b'), ('time-of-contact', '--delta=1'), ('nearest', '--per-link')):
            with self.subTest(command=command, option=option):
                self.assertRefused(self.ask(command, [OVER], TWO, option), option.split('=')[0])


class Robots(Case):
    def violations_of_a_robot_end_with_its_motion(self):
        """The cart goes from 0 to 2 in 4 s, its front from .1 to 2.1; the wall begins at 3: within 1 from t = 3.8 on."""
        words = robot_files(self)
        answer = cprox('violations', *words, '--self', '--delta', '1', '--resolution', '1e-5')
        self.assertEqual((answer.code, answer.rows[1]['status'], answer.rows[1]['verdict']), (1, 'ok', 'clear'))
        row, clear = answer.rows
        self.assertEqual((row['kind'], row['verdict'], row['b']), ('environment', 'violated', 'wall'))
        self.assertTrue(float(row['enter_lower']) <= 3.8 + 1e-9 and 3.8 - 1e-9 <= float(row['enter_upper']), row)
        self.assertLess(float(row['enter_upper']) - float(row['enter_lower']), 1e-4)
        self.assertEqual((float(row['leave_lower']), float(row['leave_upper'])), (4.0, 4.0))
        self.assertEqual((clear['kind'], clear['verdict']), ('self', 'clear'))

    def the_depth_of_an_overlap_is_negative(self):
        """The cart is a cube of .2 whose top passes the centre of a ball of .3: the way out is .3 long."""
        ball = ('world: {collision_objects: [{id: ball, primitives: [{type: sphere, dimensions: [0.3]}],'
                ' primitive_poses: [{position: [1, 0, 0.1]}]}]}')
        words = robot_files(self, scene=ball)
        row, = cprox('distance', *words, '--signed').rows
        self.assertEqual((row['status'], row['b']), ('ok', 'ball'))
        self.assertLessEqual(float(row['lower']), -0.3 + 1e-9)
        self.assertAlmostEqual(float(row['upper']), -0.3, delta=1e-6)
        self.assertEqual(float(cprox('distance', *words).rows[0]['upper']), 0.0)
        self.assertIn("'nearest' takes no --signed with --trajectory", cprox('nearest', *words, '--signed').err)

    def a_profile_follows_the_motion(self):
        wall = '\n'.join(line for line in WALL.splitlines() if 'post' not in line)
        answer = cprox('profile', *robot_files(self, scene=wall), '--intervals', '4')
        self.assertEqual((answer.code, answer.err, len(answer.rows)), (0, '', 4))
        for k, row in enumerate(answer.rows):  # the cart's face is at 0.1 + t / 2, the wall at 3
            self.assertLessEqual(float(row['lower']), 2.4 - 0.5 * k + 1e-12)
            self.assertAlmostEqual(float(row['upper']), 2.4 - 0.5 * k, delta=1e-6)
            self.assertEqual((row['id'], row['kind'], row['b'], float(row['t1'])), ('go', 'environment', 'wall', k + 1.0))

    def each_link_has_rows_of_its_own(self):
        files = robot_files(self)
        answer = cprox('distance', *files, '--per-link')
        self.assertEqual({row['a']: round(float(row['upper']), 5) for row in answer.rows}, {'cart': 0.9, 'arm': 0.95, 'hand': 0.9})
        answer = cprox('profile', *files, '--per-link', '--intervals', '2')
        self.assertEqual([row['a'] for row in answer.rows], ['arm', 'arm', 'cart', 'cart', 'hand', 'hand'])
        answer = cprox('nearest', *files, '--per-link', '--pairs', '1')
        self.assertEqual(sorted(row['a'] for row in answer.rows), ['arm', 'cart', 'hand'])
        answer = cprox('tolerance', '--delta', '0.92', *files, '--per-link')
        self.assertEqual({row['a']: row['verdict'] for row in answer.rows}, {'cart': 'violated', 'arm': 'clear', 'hand': 'violated'})
        answer = cprox('profile', *files, '--per-object', '--intervals', '1')
        self.assertEqual(sorted(row['b'] for row in answer.rows), ['post', 'wall'])

    def only_the_links_and_objects_that_are_named_take_part(self):
        files = robot_files(self)
        for names, true in (('cart', 0.9), ('arm', 0.95), ('arm, hand', 0.9)):
            row, = cprox('distance', *files, '--links', names).rows
            self.assertAlmostEqual(float(row['upper']), true, delta=1e-6)
            self.assertIn(row['a'], names)
        self.assertEqual([row['a'] for row in cprox('distance', *files, '--links', 'arm,hand', '--per-link').rows], ['arm', 'hand'])
        self.assertEqual([row['b'] for row in cprox('nearest', *files, '--links', 'cart', '--objects', 'post').rows], ['post'])
        self.assertEqual({row['b'] for row in cprox('profile', *files, '--objects', 'post', '--intervals', '3').rows}, {'post'})
        self.assertEqual(cprox('tolerance', '--delta', '0.92', *files, '--links', 'arm').code, 0)
        self.assertEqual(cprox('tolerance', '--delta', '0.92', *files, '--links', 'arm,cart').code, 1)
        both = cprox('distance', *files, '--self', '--objects', 'post')
        self.assertEqual([(row['kind'], row['status'], row['b'] == 'post') for row in both.rows], [('environment', 'ok', True), ('self', 'ok', False)])
        for option, name in (('--links', 'crat'), ('--objects', 'psot')):
            answer = cprox('distance', *files, option, name)
            self.assertEqual(answer.code, 2)
            self.assertIn(name, answer.err)

    def the_robot_against_itself_is_asked_about_too(self):
        fold = SLIDE.replace('[slide]', '[slide, swing, wrist]').replace('[0]', '[0, 0, 0]').replace('[2]', '[0.5, 0.1, 3]')
        files = robot_files(self, fold)
        whole = [row for row in cprox('distance', *files, '--self').rows if row['kind'] == 'self'][0]
        answer = cprox('profile', *files, '--self', '--intervals', '8')
        parts = [row for row in answer.rows if row['kind'] == 'self']
        self.assertEqual(len(parts), 8)
        self.assertAlmostEqual(min(float(row['upper']) for row in parts), float(whole['upper']), delta=2e-6)
        per_link = [row for row in cprox('distance', *files, '--self', '--per-link').rows if row['kind'] == 'self']
        self.assertEqual({row['a'] for row in per_link}, {whole['a'], whole['b']})
        contact = cprox('time-of-contact', *files, '--self')
        self.assertEqual([(row['kind'], row['verdict']) for row in contact.rows], [('environment', 'clear'), ('self', 'clear')])

    def pairs_are_of_links_and_objects(self):
        answer = cprox('nearest', *robot_files(self), '--pairs', '4')
        self.assertEqual({(row['a'], row['b']) for row in answer.rows[:3]}, {('cart', 'wall'), ('hand', 'wall'), ('arm', 'wall')})
        self.assertEqual(answer.rows[3]['b'], 'post')

    def the_time_of_contact_is_in_seconds(self):
        answer = cprox('time-of-contact', *robot_files(self, SLIDE.replace('[2]', '[4]')))
        row = answer.row('go')
        self.assertEqual((answer.code, row['verdict'], row['b']), (1, 'violated', 'wall'))
        self.assertLessEqual(float(row['t_contact_lower']), 2.9 + 1e-12)
        self.assertAlmostEqual(float(row['t_contact_lower']), 2.9, delta=1e-5)


class Inputs(Case):
    def a_file_may_be_standard_input(self):
        scene, curves = self.file('scene.yaml', TWO), self.file('curves.csv', OVER + '\n')
        wanted = cprox('distance', '--curves', curves, '--scene', scene).without_times()
        for text, words in ((OVER + '\n', ('--curves', '-', '--scene', scene)), (TWO, ('--curves', curves, '--scene', '-'))):
            answer = piped(text, 'distance', *words)
            self.assertEqual((answer.code, answer.without_times()), (0, wanted), answer.err)
        files = robot_files(self)
        answer = piped(SLIDE, 'distance', *['-' if word.endswith('go.yaml') else word for word in files])
        self.assertEqual((answer.code, answer.rows[0]['id']), (0, 'stdin'), answer.err)
        pair = '- {id: p, a: {type: sphere, dimensions: [1]}, b: {type: sphere, dimensions: [1], pose: {position: [3, 0, 0]}}}'
        self.assertAnswer(piped(pair, 'pairs', '--in', '-').row('p'), 1.0)
        self.assertRefused(piped('', 'distance', '--curves', '-', '--scene', '-'), 'only one')

    def a_header_row_is_no_curve(self):
        header = 'id,basis,degree,t0,t1,radius,n,x0,y0,z0,x1,y1,z1'
        for line in (header, header.replace('id,basis', '"id","basis"'), 'id , basis ,degree'):
            answer = self.ask('distance', [line, PASSING, line, OVER], BOX_SCENE)
            self.assertEqual((answer.code, [row['id'] for row in answer.rows]), (0, ['passing', 'over']), answer.err)
        answer = self.ask('distance', ['id,bezier,1,0,1,0,2,3,0,0,3,1,0'], BOX_SCENE)
        self.assertEqual([row['id'] for row in answer.rows], ['id'])

    def a_row_says_why_it_has_no_answer(self):
        answer = self.ask('distance', ['bad,bezier,1,0,1,0,2,x,0,0,3,1,0', PASSING], BOX_SCENE)
        self.assertIn('column 8 (x0)', answer.row('bad')['message'])
        self.assertEqual(answer.row('passing')['message'], '')
        answer = self.ask('profile', ['bad,bezier,1,0,1,0,2,x,0,0,3,1,0', PASSING], BOX_SCENE)
        self.assertIn('column 8 (x0)', answer.row('bad')['message'])
        self.assertEqual((answer.code, len(answer.rows)), (2, 101))

    def the_exit_code_is_one_rule_for_all_commands(self):
        bad, hit = 'bad,bezier,1,0,1,0,2,x,0,0,3,1,0', bezier('hit', (-3, 0, 0), (3, 0, 0))
        clear, wrong, proof = self.file('c.csv', PASSING + '\n'), self.file('w.csv', hit + '\n'), os.path.join(self.folder, 'p')
        for command in ('distance', 'collision', 'profile', 'nearest', 'time-of-contact'):
            with self.subTest(command=command):
                verdict = command in ('collision', 'time-of-contact')
                self.assertEqual(self.ask(command, [PASSING], BOX_SCENE).code, 0)
                self.assertEqual(self.ask(command, [PASSING, hit], BOX_SCENE).code, 1 if verdict else 0)
                self.assertEqual(self.ask(command, [hit, bad], BOX_SCENE).code, 2)
                nothing = self.ask(command, [], BOX_SCENE)
                self.assertEqual((nothing.code, nothing.err), (2, 'warning: the input has no rows\n'))
        scene = self.file('scene.yaml', BOX_SCENE)
        self.assertEqual(cprox('distance', '--curves', clear, '--scene', scene, '--certificate', proof).code, 0)
        self.assertEqual(cprox('check', proof, '--curves', clear, '--scene', scene).code, 0)
        self.assertEqual(cprox('check', proof, '--curves', wrong, '--scene', scene).code, 1)
        self.assertEqual(cprox('check', proof, '--curves', self.file('none.csv', ''), '--scene', scene).code, 2)
        for words in (('pairs', '--in'), ('constraints', '--provider', 'curve_proximity/CurveDistance', '--in')):
            answer = cprox(*words, self.file('empty.yaml', '[]' if words[0] == 'pairs' else 'cases: []'))
            self.assertEqual((answer.code, answer.err), (2, 'warning: the input has no rows\n'))
