# SPDX-License-Identifier: BSD-3-Clause
"""Curves of every basis against formulas written here: dense samples of the formula, refined about the least of them."""
import math
import os
import random

from support import Case, cprox

REPO = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PAPERS = os.path.join(REPO, 'examples/papers/')
ROOT = math.sqrt(0.5)


GAUSS = [(0.0, 0.5688888888888889), (-0.5384693101056831, 0.47862867049936647), (0.5384693101056831, 0.47862867049936647),
         (-0.906179845938664, 0.23692688505618908), (0.906179845938664, 0.23692688505618908)]


def integral(f, t, panels=10):
    """The integral of f from 0 to t, by Gauss' rule with five nodes on each panel."""
    h = t / panels
    total = [0.0, 0.0, 0.0]
    for i in range(panels):
        for node, weight in GAUSS:
            total = [a + 0.5 * h * weight * b for a, b in zip(total, f((i + 0.5 + 0.5 * node) * h))]
    return total


def least(f, t0, t1, samples=100):
    """The least value of f on [t0, t1]: samples, then golden sections about each of the three lowest."""
    h = (t1 - t0) / samples
    values = [f(t0 + i * h) for i in range(samples + 1)]
    best = min(values)
    for i in sorted(range(samples + 1), key=values.__getitem__)[:3]:
        a, b = max(t0, t0 + (i - 1) * h), min(t1, t0 + (i + 1) * h)
        for _ in range(40):
            c, d = b - 0.6180339887498949 * (b - a), a + 0.6180339887498949 * (b - a)
            a, b = (a, d) if f(c) < f(d) else (c, b)
        best = min(best, f(0.5 * (a + b)))
    return best


def bernstein(points, weights, s):
    """A rational Bézier curve."""
    m = len(points) - 1
    b = [w * math.comb(m, i) * s**i * (1 - s)**(m - i) for i, w in enumerate(weights)]
    return [sum(w * p[k] for w, p in zip(b, points)) / sum(b) for k in range(3)]


def nurbs(points, weights, degree, knots, t):
    """By de Boor's algorithm in homogeneous coordinates."""
    span = max(i for i in range(degree, len(points)) if knots[i] <= t and knots[i] < knots[i + 1])
    d = [[w * x for x in p] + [w] for p, w in list(zip(points, weights))[span - degree:span + 1]]
    for r in range(1, degree + 1):
        for j in range(degree, r - 1, -1):
            low, high = knots[j + span - degree], knots[j + 1 + span - r]
            a = (t - low) / (high - low)
            d[j] = [(1 - a) * x + a * y for x, y in zip(d[j - 1], d[j])]
    return [x / d[degree][3] for x in d[degree][:3]]


def hodograph(preimage, s):
    """A i A* of the preimage at s."""
    m = len(preimage) - 1
    w, x, y, z = (sum(math.comb(m, i) * s**i * (1 - s)**(m - i) * q[k] for i, q in enumerate(preimage)) for k in range(4))
    return [w * w + x * x - y * y - z * z, 2 * (w * z + x * y), 2 * (x * z - w * y)]


def plus(a, b):
    return [x + y for x, y in zip(a, b)]


def clothoid(start, heading, curvature, rate, panels=10):
    turn = lambda s: heading + curvature * s + rate * s * s / 2
    return lambda t: plus(start, integral(lambda s: (math.cos(turn(s)), math.sin(turn(s)), 0.0), t, panels))


def involute(centre, heading, radius):
    def point(t):
        x, y = radius * (math.cos(t) + t * math.sin(t)), radius * (math.sin(t) - t * math.cos(t))
        c, s = math.cos(heading), math.sin(heading)
        return plus(centre, (c * x - s * y, s * x + c * y, 0.0))
    return point


def text(*numbers):
    return ','.join(repr(float(x)) for x in numbers)


def flat(points):
    return [x for p in points for x in p]


POINTS = [(1.0, -0.4, 0.3), (0.2, 1.1, -0.2), (-0.7, 0.9, 0.6), (-1.1, -0.3, 0.1), (0.4, -0.8, -0.5)]
WEIGHTS = [1.0, 0.4, 1.7, 0.8, 1.2]
KNOTS = [0, 0, 0, 0, 1.25, 2, 2, 2, 2]
PREIMAGE = [(1.0, 0.3, -0.2, 0.1), (0.6, 0.1, 0.4, 0.5), (0.9, -0.5, 0.2, -0.3)]

# name: row up to the columns that restrict, the formula, t0, t1
CURVES = {
    'rational': (f'rational_bezier,4,-1,2,0,5,{text(*flat(POINTS), *WEIGHTS)}',
                 lambda t: bernstein(POINTS, WEIGHTS, (t + 1) / 3), -1.0, 2.0),
    'nurbs': (f'nurbs,3,0,2,0,5,{text(*flat(POINTS), *KNOTS, *WEIGHTS)}',
              lambda t: nurbs(POINTS, WEIGHTS, 3, KNOTS, t), 0.0, 2.0),
    'clothoid': (f'clothoid,0,-1.5,2.5,0,1,{text(0.2, -0.1, 0.4, 0.7, -0.5, 1.1)}',
                 clothoid((0.2, -0.1, 0.4), 0.7, -0.5, 1.1), -1.5, 2.5),
    'involute': (f'involute,0,-1,4,0,1,{text(0.1, 0.2, -0.3, 0.9, 0.3)}', involute((0.1, 0.2, -0.3), 0.9, 0.3), -1.0, 4.0),
    'hodograph': (f'pythagorean_hodograph,2,0,1,0,1,{text(-0.5, 0.1, 0.2, *flat(PREIMAGE))}',
                  lambda t: plus((-0.5, 0.1, 0.2), integral(lambda s: hodograph(PREIMAGE, s), t)), 0.0, 1.0),
    'bezier': (f'bezier,4,-1,2,0,5,{text(*flat(POINTS))}', lambda t: bernstein(POINTS, [1] * 5, (t + 1) / 3), -1.0, 2.0),
    'bspline': (f'bspline,3,0,2,0,5,{text(*flat(POINTS), *KNOTS)}', lambda t: nurbs(POINTS, [1] * 5, 3, KNOTS, t), 0.0, 2.0),
    'polynomial': (f'polynomial,2,-1,1,0,3,{text(*flat(POINTS[:3]))}',
                   lambda t: [a + b * t + c * t * t for a, b, c in zip(*POINTS[:3])], -1.0, 1.0),
    'legendre': (f'legendre,2,0,4,0,3,{text(*flat(POINTS[:3]))}',
                 lambda t: [a + b * (t / 2 - 1) + c * (1.5 * (t / 2 - 1)**2 - 0.5) for a, b, c in zip(*POINTS[:3])], 0.0, 4.0),
    'lagrange': (f'lagrange,2,0,3,0,3,{text(*flat(POINTS[:3]), 0, 1, 3)}',
                 lambda t: [a * (t - 1) * (t - 3) / 3 - b * t * (t - 3) / 2 + c * t * (t - 1) / 6
                            for a, b, c in zip(*POINTS[:3])], 0.0, 3.0),
    'trigonometric': (f'trigonometric,1,0,5,0,3,{text(*flat(POINTS[:3]))}',
                      lambda t: [a + b * math.cos(t) + c * math.sin(t) for a, b, c in zip(*POINTS[:3])], 0.0, 5.0),
}


def scene(centres):
    spheres = ''.join(f'\n    - id: ball{i}\n      primitives: [{{type: sphere, dimensions: [0.05]}}]\n'
                      f'      primitive_poses: [{{position: {list(c)}}}]' for i, c in enumerate(centres))
    return f'world:\n  collision_objects:{spheres}\n'


class Bases(Case):
    def assertCurves(self, part):
        """Distances of each curve from two spheres; part: of [t0, t1], the part that is asked about, or None."""
        draw = random.Random(23)
        centres = [[round(draw.uniform(-2, 2), 3) for _ in range(3)] for _ in range(2)]
        rows = [f'{name},{row}' + ('' if part is None else f',{text(*part(t0, t1))}')
                for name, (row, _, t0, t1) in CURVES.items()]
        answer = self.ask('distance', rows, scene(centres), '--per-object')
        self.assertEqual(answer.err, '')
        for name, (_, f, t0, t1) in CURVES.items():
            a, b = (t0, t1) if part is None else part(t0, t1)
            for i, c in enumerate(centres):
                with self.subTest(curve=name, ball=i):
                    true = max(0.0, least(lambda t: math.dist(f(t), c), a, b) - 0.05)
                    row = answer.row(name, f'ball{i}')
                    self.assertAnswer(row, true, slack=1e-9)
                    if true > 0:
                        t = float(row['t'])
                        self.assertTrue(a <= t <= b, (t, a, b))
                        self.assertAlmostEqual(math.dist(f(t), c) - 0.05, float(row['upper']), delta=1e-9)

    def curves_of_every_basis_are_as_far_as_their_formulas(self):
        self.assertCurves(None)

    def two_more_columns_restrict_every_basis_without_changing_its_parameter(self):
        self.assertCurves(lambda t0, t1: (t0 + 0.31 * (t1 - t0), t0 + 0.62 * (t1 - t0)))

    def dubins_paths_are_turns_and_lines(self):
        half = f'half,dubins,0,0,0,0.1,2,{text(0, 0, 1, 0, 2, 1, 0, math.pi, 1)}'     # half a circle about (0, 1, 1)
        line = f'line,dubins,0,0,0,0,2,{text(-3, 0, 1, 3, 0, 1, 0, 0, 1)}'
        loop = f'loop,dubins_rlr,0,0,0,0,2,{text(0, 0, 1, 0.5, 0, 1, 0, 0, 1)}'
        answer = self.ask('distance', [half, line, loop], scene([(3, 1, 1), (0, 1, 1), (0, 0.5, 3)]), '--per-object')
        self.assertAnswer(answer.row('half', 'ball0'), 2.0 - 0.15)
        self.assertAnswer(answer.row('half', 'ball1'), 1.0 - 0.15)
        self.assertAnswer(answer.row('line', 'ball2'), math.hypot(0.5, 2) - 0.05)
        self.assertEqual(answer.row('loop', 'ball0')['status'], 'ok')
        far = self.ask('distance', [f'far,dubins_rlr,0,0,0,0,2,{text(-9, 0, 1, 9, 0, 1, 0, 0, 1)}'], scene([(3, 1, 1)]))
        self.assertEqual((far.code, far.row('far')['status']), (2, 'invalid'))

    def a_piecewise_curve_is_its_pieces_end_to_end(self):
        rows = ['path,piecewise,0,0,0,0.1,2', ',bezier,1,0,1,0,2,-1,-1,0,0,-1,0',
                f',rational_bezier,2,1,2,0,3,0,-1,0,1,-1,0,1,0,0,1,{ROOT!r},1', 'next,bezier,1,0,1,0,2,5,0,0,6,0,0']
        answer = self.ask('distance', rows, scene([(0, 0, 0), (-0.5, -3, 0)]), '--per-object')
        self.assertEqual([row['id'] for row in answer.rows], ['path'] * 2 + ['next'] * 2)
        self.assertAnswer(answer.row('path', 'ball0'), 1.0 - 0.15)   # the arc's radius
        self.assertAnswer(answer.row('path', 'ball1'), 2.0 - 0.15)
        rows[0] = 'path,piecewise,0,0,0,0.1,2,1.25,2'                 # the arc alone, without its beginning
        restricted = self.ask('distance', rows, scene([(0, 0, 0), (-0.5, -3, 0)]), '--per-object')
        self.assertAnswer(restricted.row('path', 'ball0'), 1.0 - 0.15)
        start = bernstein([(0, -1, 0), (1, -1, 0), (1, 0, 0)], [1, ROOT, 1], 0.25)
        self.assertAnswer(restricted.row('path', 'ball1'), math.dist(start, (-0.5, -3, 0)) - 0.15)

    def what_does_not_fit_is_said_in_the_row(self):
        for row, words in (('c,clothoid,0,0,1,0,1,0,0,0,1,2', 'has 13'), ('c,clothoid,3,0,1,0,1,0,0,0,1,2,3', 'no degree'),
                           ('c,dubins,0,0,1,0,2,0,0,0,1,1,0,0,0,1', 'range of its own'),
                           ('c,rational_bezier,1,0,1,0,2,0,0,0,1,0,0,1,-1', 'weight 1 is -1'),
                           ('c,nurbs,2,0,1,0,2,0,0,0,1,0,0', 'at least 3 points'),
                           ('c,bezier,1,0,1,0,2,0,0,0,1,0,0,0.5,1.5', 'leaves the curve\'s range [0, 1]'),
                           ('c,bezier,1,0,1,0,2,0,0,0,1,0,0,0.5,0.5', 'is not below'),
                           ('c,piecewise,0,0,0,0,2\n,bezier,1,0,1,0,2,0,0,0,1,0,0', 'followed by'),
                           ('c,piecewise,0,0,0,0,1\n,piecewise,0,0,0,0,0', 'cannot be piecewise'),
                           ('c,piecewise,0,0,0,0,2\n,bezier,1,0,1,0,2,0,0,0,1,0,0\n,bezier,1,1,2,0,2,2,0,0,3,0,0', 'do not join'),
                           ('c,dubins_xyz,0,0,0,0,2,0,0,0,1,1,0,0,0,1', "'dubins_xyz'")):
            with self.subTest(row=row):
                answer = self.ask('distance', [row], scene([(0, 0, 3)]))
                self.assertEqual(answer.code, 2, answer.out)
                self.assertIn(words, answer.row('c')['message'] + answer.err)

    def a_gap_between_pieces_is_allowed_where_the_row_says_so(self):
        rows = ['c,piecewise,0,0,0,0,2,1.5', ',bezier,1,0,1,0,2,0,0,0,1,0,0', ',bezier,1,1,2,0,2,2,0,0,3,0,0']
        self.assertAnswer(self.ask('distance', rows, scene([(1.5, 0, 0)])).row('c'), 0.5 - 0.05)

    def bases_that_the_checker_does_not_read_leave_no_certificate(self):
        answer = self.ask('distance', ['c,' + CURVES['clothoid'][0]], scene([(0, 0, 3)]), '--certificate',
                          os.path.join(self.folder, 'c.cert'))
        self.assertEqual(answer.code, 2)
        self.assertIn('a clothoid curve has no certificate', answer.row('c')['message'] + answer.err)


def segment(p, a, b):
    d, w = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, p)]
    s = min(1.0, max(0.0, sum(x * y for x, y in zip(d, w)) / sum(x * x for x in d)))
    return math.dist(p, [x + s * y for x, y in zip(a, d)])


class FigureEleven(Case):
    """The pairs of Fig. 11 of Lakshmanan et al. 2019, from examples/papers, against their formulas."""

    def a_to_c_are_as_far_from_the_polygon_as_their_formulas(self):
        polygon = [(2, 0.2), (2.9, -0.1), (3.2, 0.7), (2.6, 1.3), (2.1, 0.9)]
        sides = list(zip(polygon, polygon[1:] + polygon[:1]))
        heart = lambda t: (1.2 * math.sin(t)**3, 1.2 * (13 * math.cos(t) - 5 * math.cos(2 * t) - 2 * math.cos(3 * t)
                                                        - math.cos(4 * t)) / 16)
        epicycloid = lambda t: (0.24 * (4 * math.cos(t) - math.cos(4 * t)), 0.24 * (4 * math.sin(t) - math.sin(4 * t)))
        spiral = clothoid((0, 0, 0), 0, 0, 1, 30)
        answer = cprox('distance', '--curves', PAPERS + 'figure_11.csv', '--scene', PAPERS + 'figure_11.yaml')
        self.assertEqual((answer.code, answer.err), (0, ''))
        turn = 2 * math.pi
        for name, f, t0 in (('heart', heart, 0), ('epicycloid', epicycloid, 0), ('spiral', spiral, -turn)):
            true = least(lambda t: min(segment(f(t)[:2], a, b) for a, b in sides), t0, turn)
            self.assertAnswer(answer.row(name), true, slack=1e-8)

    def d_to_f_are_as_far_apart_as_their_formulas(self):
        answer = cprox('distance', '--curves', PAPERS + 'figure_11_first.csv', '--against', PAPERS + 'figure_11_second.csv')
        self.assertEqual((answer.code, answer.err), (0, ''))
        first = involute((0, 0, 0), 0, 1)
        second = involute((-14.5, 1, 0), 0, 1)
        fish = lambda t: (math.cos(t) - math.sin(t)**2 / math.sqrt(2), math.cos(t) * math.sin(t), 0.0)
        lissajous = lambda t: (2.6 + math.sin(3 * t), 0.4 + math.sin(2 * t), 0.0)
        turn = 2 * math.pi
        for name, a, b, t1 in (('involute', first, second, 6.0), ('fish', fish, lissajous, turn)):
            row = answer.row(name)
            self.assertEqual(row['status'], 'ok')
            grid = 150
            ours = [a(t1 * i / grid) for i in range(grid + 1)]
            theirs = [b(t1 * i / grid) for i in range(grid + 1)]
            sampled = min(math.dist(p, q) for p in ours for q in theirs)
            self.assertLessEqual(float(row['lower']), sampled)
            self.assertGreater(float(row['upper']), sampled - 0.4)
            t, s = float(row['t']), float(row['t_b'])
            self.assertAlmostEqual(math.dist(a(t), b(s)), float(row['upper']), delta=1e-9)
        self.assertEqual(answer.row('bezier')['status'], 'ok')
