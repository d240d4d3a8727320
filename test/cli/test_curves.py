# SPDX-License-Identifier: BSD-3-Clause
"""distance, tolerance and collision of curves against objects: values by hand, and rows that are wrong."""
import math
import random

from support import BOX_SCENE, HEADER, PASSING, Case, bezier

TWO_BOXES = BOX_SCENE + '''
    - id: far, away
      primitives: [{type: sphere, dimensions: [1]}]
      primitive_poses: [{position: [10, 0, 0]}]
'''


class Answers(Case):
    def the_header_is_the_one_that_the_manual_promises(self):
        answer = self.ask('distance', [PASSING], BOX_SCENE)
        self.assertEqual(answer.header, HEADER)
        self.assertEqual((answer.code, answer.err), (0, ''))

    def distance_is_an_interval_with_witnesses_and_parameter(self):
        row = self.ask('distance', [PASSING], BOX_SCENE).row('passing')
        self.assertAnswer(row, 2.0)
        self.assertEqual((row['kind'], row['verdict'], row['a'], row['b'], row['t_b']), ('curve', '', 'passing', 'box', ''))
        self.assertAlmostEqual(float(row['a_x']), 3.0, delta=1e-9)
        self.assertAlmostEqual(float(row['b_x']), 1.0, delta=1e-9)
        self.assertAlmostEqual(float(row['a_y']), -4 + 8 * float(row['t']), delta=1e-9)
        self.assertLessEqual(abs(float(row['a_y'])), 1 + 1e-5)
        self.assertEqual(row['lod'], 'hull')
        self.assertGreaterEqual(int(row['nodes']), 1)

    def numbers_carry_17_significant_digits(self):
        row = self.ask('distance', [bezier('c', (3, 0.1, 0), (5, 0.1, 0))], BOX_SCENE).row('c')
        self.assertEqual(row['a_y'], '0.10000000000000001')

    def epsilon_is_the_width_of_the_interval(self):
        curve = bezier('c', (3, -4, 0), (1.5, 1, 2), (3, 4, 0.5), (2, 2, 2))
        for epsilon in ('1e-2', '1e-10'):
            row = self.ask('distance', [curve], BOX_SCENE, '--epsilon', epsilon).row('c')
            self.assertEqual(row['status'], 'ok')
            self.assertLessEqual(float(row['upper']) - float(row['lower']), float(epsilon))

    def parameter_range_and_radius_are_those_of_the_row(self):
        row = self.ask('distance', [bezier('c', (3, 0, 0), (5, 0, 0), t0=10, t1=20, radius=0.5)], BOX_SCENE).row('c')
        self.assertAnswer(row, 1.5)
        self.assertAlmostEqual(float(row['t']), 10.0, delta=1e-6)
        self.assertPoint(row, 'a', (2.5, 0, 0))

    def a_bspline_is_answered(self):
        # clamped and of degree 1: the polygon (3,-4,0) (3,0,0) (5,0,0) itself
        row = 'b,bspline,1,0,2,0,3,3,-4,0,3,0,0,5,0,0,0,0,1,2,2'
        self.assertAnswer(self.ask('distance', [row], BOX_SCENE).row('b'), 2.0)

    def every_basis_is_answered(self):
        # (3, y, 0) with y from -4 to 4, written in each basis: 2 m from the face x = 1
        curves = ['p,polynomial,1,0,2,0,2,3,-4,0,0,4,0', 'l,legendre,1,0,2,0,2,3,0,0,0,4,0',
                  'g,lagrange,2,0,2,0,3,3,-4,0,3,0,0,3,4,0,0,1,2',
                  'c,trigonometric,1,0,3.141592653589793,0,3,3,0,0,0,4,0,0,0,0']
        answer = self.ask('distance', curves, BOX_SCENE)
        self.assertEqual(answer.err, '')
        for name in 'plgc':
            self.assertAnswer(answer.row(name), 2.0)

    def the_exit_code_tells_the_verdict(self):
        """0: all clear; 1: a verdict is violated; 2: a row has no answer; 3: undecided. The first of 2, 1, 3 that applies."""
        far = bezier('far', (-1, 0, 40), (1, 0, 40))
        bad = 'bad,bezier,1,0,1,0,2,0,0'
        box = BOX_SCENE
        for curves, delta, code in (([PASSING, far], '1.9', 0), ([PASSING, far], '2.1', 1), ([far, bad], '1.9', 2),
                                    ([PASSING, bad], '2.1', 2), ([PASSING], '2', 3), ([PASSING, far], '2', 3)):
            answer = self.ask('tolerance', curves, box, '--delta', delta)
            self.assertEqual(answer.code, code, (curves, delta, answer.out, answer.err))
        self.assertEqual(self.ask('collision', [PASSING, far], box).code, 0)
        self.assertEqual(self.ask('distance', [far, bad], box).code, 2)

    def a_tolerance_is_clear_or_violated(self):
        for delta, verdict in (('1.9', 'clear'), ('2.1', 'violated'), ('0', 'clear')):
            row = self.ask('tolerance', [PASSING], BOX_SCENE, '--delta', delta).row('passing')
            self.assertEqual((row['status'], row['verdict']), ('ok', verdict), row)
            self.assertLessEqual(float(row['lower']), 2.0)
            self.assertGreaterEqual(float(row['upper']), 2.0)

    def a_hit_violates_a_collision_and_touching_is_never_clear(self):
        curves = [PASSING, bezier('through', (-3, 0, 0), (3, 0.5, 0)), bezier('inside', (0, 0, 0), (0.5, 0, 0)),
                  bezier('touching', (1, -4, 0), (1, 4, 0))]
        answer = self.ask('collision', curves, BOX_SCENE)
        self.assertEqual(answer.row('passing')['verdict'], 'clear')
        self.assertEqual(answer.row('through')['verdict'], 'violated')
        self.assertEqual(answer.row('inside')['verdict'], 'violated')
        self.assertIn(answer.row('touching')['verdict'], ('violated', 'undecided'))
        self.assertEqual(float(answer.row('touching')['lower']), 0.0)

    def the_nearest_object_is_named_and_ids_with_commas_are_quoted(self):
        answer = self.ask('distance', [PASSING, bezier('near', (8, 0, 0), (7, 0, 0))], TWO_BOXES)
        self.assertEqual(answer.row('passing')['b'], 'box')
        self.assertAnswer(answer.row('near'), 1.0)
        self.assertEqual(answer.row('near')['b'], 'far, away')
        self.assertIn(',"far, away",', answer.out)

    def per_object_gives_a_row_for_each_curve_and_object(self):
        answer = self.ask('distance', [PASSING, bezier('near', (8, 0, 0), (7, 0, 0))], TWO_BOXES, '--per-object')
        self.assertEqual([(row['id'], row['b']) for row in answer.rows],
                         [('passing', 'box'), ('passing', 'far, away'), ('near', 'box'), ('near', 'far, away')])
        self.assertAnswer(answer.row('passing', 'far, away'), 6.0)
        self.assertAnswer(answer.row('near', 'box'), 6.0)

    def an_empty_world_proves_nothing(self):
        commands = [('distance',), ('collision',), ('tolerance', '--delta', '5'), ('time-of-contact',), ('profile', '--intervals', '1'),
                    ('nearest',), ('nearest', '--within', '1'), ('violations', '--delta', '5')]
        for scene in ('world: {collision_objects: []}', 'name: nothing'):
            for command, *options in commands:
                with self.subTest(scene=scene, command=command):
                    answer = self.ask(command, [PASSING], scene, *options)
                    row = answer.row('passing')
                    self.assertEqual((row['status'], row['upper'], row['b']), ('empty', 'inf', ''))
                    self.assertIn(row.get('lower'), ('0', None))
                    self.assertIn(row.get('verdict'), ('undecided', '', None))
                    self.assertEqual(answer.code, 3)
        answer = self.ask('collision', [PASSING], 'name: nothing')
        self.assertEqual([answer.row('passing')[name] for name in ('t', 'a_x', 'b_z')], ['', '', ''])
        self.assertIn('there is no object', answer.row('passing')['message'])
        self.assertIn('warning: 1 of 1 rows were measured against nothing', answer.err)

    def an_empty_world_is_clear_where_the_caller_says_so(self):
        answer = self.ask('distance', [PASSING], 'name: nothing', '--allow-empty')
        row = answer.row('passing')
        self.assertEqual((answer.code, row['status'], row['lower'], row['upper']), (0, 'ok', 'inf', 'inf'))
        for command, *options in (('collision',), ('tolerance', '--delta', '5'), ('violations', '--delta', '5')):
            answer = self.ask(command, [PASSING], 'name: nothing', '--allow-empty', *options)
            self.assertEqual((answer.code, answer.row('passing')['verdict']), (0, 'clear'))
        self.assertNotIn('nothing', self.ask('collision', [PASSING], BOX_SCENE).err)

    def without_any_curve_nothing_is_proven_clear(self):
        for query in ('distance', 'collision'):
            answer = self.ask(query, [], BOX_SCENE)
            self.assertEqual((answer.code, answer.out), (2, HEADER + '\n'))
            self.assertIn('warning: the input has no rows', answer.err)

    def a_budget_that_is_too_small_leaves_a_true_interval(self):
        # a wiggle about a sphere's equal-distance circle: one node cannot be enough for 1e-12
        curve = bezier('c', (3, -4, 0), (1.1, 1, 2), (3, 4, 0.5), (1.5, -2, 2), (2, 2, -3))
        full = self.ask('distance', [curve], BOX_SCENE, '--epsilon', '1e-12').row('c')
        row = self.ask('distance', [curve], BOX_SCENE, '--epsilon', '1e-12', '--max-nodes', '1').row('c')
        self.assertEqual(row['status'], 'budget')
        self.assertLessEqual(float(row['lower']), float(full['upper']))
        self.assertGreaterEqual(float(row['upper']), float(full['lower']))

    def intervals_contain_every_sampled_distance_of_random_curves(self):
        # seed 7; 200 curves of degree 1 to 9 in a cube of 4 m; 400 samples each; tolerance 1e-12: the samples' rounding
        rng = random.Random(7)
        curves = {f'r{i}': [[rng.uniform(-4, 4) for _ in range(3)] for _ in range(rng.randint(2, 10))] for i in range(200)}
        answer = self.ask('distance', [bezier(name, *points) for name, points in curves.items()], BOX_SCENE)
        for name, points in curves.items():
            row, n = answer.row(name), len(points) - 1
            least = math.inf
            for k in range(401):
                t = k / 400
                p = [sum(math.comb(n, i) * t**i * (1 - t)**(n - i) * q[axis] for i, q in enumerate(points)) for axis in range(3)]
                least = min(least, math.dist(p, [max(-1, min(1, x)) for x in p]))
            self.assertLessEqual(float(row['lower']), least + 1e-12, row)
            self.assertEqual(row['status'], 'ok')
            self.assertLessEqual(float(row['upper']) - float(row['lower']), 1e-6)


class Rows(Case):
    """Whatever a row holds, the others are answered."""

    def what_is_no_row_is_skipped(self):
        text = '\ufeff# a comment\r\n\r\n' + PASSING + ',,\r\n   \r\n#' + PASSING + '\r\n' + PASSING.replace('passing', 'last')
        answer = self.ask('distance', text, BOX_SCENE)
        self.assertEqual([row['id'] for row in answer.rows], ['passing', 'last'])
        self.assertEqual((answer.code, answer.err), (0, ''))

    def a_file_without_rows_has_a_header_as_its_answer(self):
        answer = self.ask('distance', '# nothing\n', BOX_SCENE)
        self.assertEqual((answer.code, answer.out), (2, HEADER + '\n'))

    def ids_may_be_quoted_and_come_back_the_same(self):
        answer = self.ask('distance', [PASSING.replace('passing', '"a ""b"", c"')], BOX_SCENE)
        self.assertEqual(answer.rows[0]['id'], 'a "b", c')
        self.assertEqual(answer.rows[0]['a'], 'a "b", c')

    def numbers_may_be_written_in_any_usual_way(self):
        text = 'c,bezier,1, 0 ,+1,0.,2,3e0,-4.0E0,0,+3,.4e1,1e-400'
        self.assertAnswer(self.ask('distance', [text], BOX_SCENE).row('c'), 2.0)

    def a_bad_row_is_told_with_its_number_and_reason_and_the_others_are_answered(self):
        head = 'bad,bezier,1,0,1,0,2,'
        bad = {
            head + '3,-4,0,3,4,zero': ['column 13 (z1)', "'zero'"],
            head + '3,-4,nan,3,4,0': ['column 10 (z0)', "'nan'"],
            head + '3,-4,0,inf,4,0': ['column 11 (x1)', "'inf'"],
            head + '3,,0,3,4,0': ['column 9 (y0)', "''"],
            head + '3,-4,0,3,4,0x10': ['z1'],
            head + '3,-4,0,3,4,1e999': ['z1'],
            head + '3,-4,0,3,4,1 2': ['z1'],
            head + '3,-4,0,3,4': ['12 columns', '13'],
            head + '3,-4,0,3,4,0,7': ['14 columns', '13'],
            'bad,bezier,1,0,1,0,99999999999,3,4,0': ['n is 99999999999'],
            'bad,bezier,1,0,1,0,-2,3,-4,0,3,4,0': ['column 7 (n)'],
            'bad,bezier,2,0,1,0,2,3,-4,0,3,4,0': ['degree 2', '3 points', 'n is 2'],
            'bad,bezier,0,0,1,0,1,3,-4,0': ['degree'],
            'bad,bezier,1.5,0,1,0,2,3,-4,0,3,4,0': ['column 3 (degree)'],
            'bad,bezier,1,1,0,0,2,3,-4,0,3,4,0': ['t0'],
            'bad,bezier,1,0,0,0,2,3,-4,0,3,4,0': ['t0'],
            'bad,bezier,1,0,1,-0.5,2,3,-4,0,3,4,0': ['radius'],
            'bad,bezier,61,0,1,0,62,' + ','.join(['1'] * 186): ['60'],
            'bad,catmull,1,0,1,0,2,3,-4,0,3,4,0': ['catmull', 'bezier'],
            'bad,legendre,2,0,1,0,2,3,-4,0,3,4,0': ['degree 2', '3 points', 'n is 2'],
            'bad,trigonometric,1,0,1,0,2,3,-4,0,3,4,0': ['degree 1', '3 points', 'n is 2'],
            'bad,trigonometric,0,0,1,0,1,3,-4,0': ['no terms'],
            'bad,lagrange,1,0,1,0,2,3,-4,0,3,4,0,0.5,0.5': ['nodes 0 and 1 are both 0.5'],
            'bad,lagrange,1,0,1,0,2,3,-4,0,3,4,0': ['13 columns', '15'],
            'bad,bspline,1,0,1,0,2,3,-4,0,3,4,0,0,0,1': ['16 columns', '17'],
            'bad,bspline,1,0,1,0,2,3,-4,0,3,4,0,0,0,1,0.5': ['knot'],
            'bad,bspline,1,0,1,0,2,3,-4,0,3,4,0,0,0,1,x': ['column 17 (knot3)'],
            'bad,bspline,2,0,1,0,2,3,-4,0,3,4,0,0,0,1,1,1': ['at least 3 points'],
            'bad,bspline,1,0,3,0,2,3,-4,0,3,4,0,0,0,1,1': ['t1'],
            'bad': ['1 columns'],
            'bad,,,': ['1 columns'],
        }
        for text, words in bad.items():
            with self.subTest(text=text[:60]):
                answer = self.ask('distance', ['# comment', PASSING, text, PASSING.replace('passing', 'after')], BOX_SCENE)
                self.assertFailedRow(answer, 'bad', 'row 2 (line 3', *words)
                self.assertAnswer(answer.row('passing'), 2.0)
                self.assertAnswer(answer.row('after'), 2.0)
                self.assertEqual([row['id'] for row in answer.rows], ['passing', 'bad', 'after'])

    def a_quote_that_does_not_end_is_a_bad_row(self):
        answer = self.ask('distance', [PASSING, '"open,bezier,1'], BOX_SCENE)
        self.assertEqual([row['status'] for row in answer.rows], ['ok', 'invalid'])
        self.assertIn('quote', answer.err)

    def bytes_that_are_no_text_do_no_harm(self):
        rng = random.Random(11)
        noise = bytes(rng.randrange(256) for _ in range(20000))
        answer = self.ask('distance', (PASSING + '\n').encode().decode() + noise.decode('latin-1'), BOX_SCENE)
        self.assertAnswer(answer.row('passing'), 2.0)
        self.assertEqual(answer.code, 2)

    def a_long_curve_is_quick(self):
        # 100,000 control points of a cubic B-spline that runs along y = 5: 4 m from the box. Limit 10 s, measured: below 2 s
        n, degree = 100000, 3
        points = ','.join(f'{-50 + i * 1e-3},5,{0.5 * math.sin(i * 1e-2)!r}' for i in range(n))
        knots = ','.join(str(k) for k in range(n + degree + 1))
        answer = self.ask('distance', [f'long,bspline,{degree},{degree},{n},0,{n},{points},{knots}'], BOX_SCENE)
        self.assertAnswer(answer.row('long'), 4.0)
