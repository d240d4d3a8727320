# SPDX-License-Identifier: BSD-3-Clause
"""Curves as obstacles, on one clock with the mover or not, and tubes whose radius changes: values by formula."""
import math
import os

from support import DATA, Case, bezier, cprox

PAPERS = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), 'examples/papers')

CABLE = '{type: curve, curve: {basis: bezier, radius: 0.1, points: [[0, -1, 2], [0, 1, 2]]}}'
# along y through the origin, while the mover comes along x: both are at the origin at t = 0.5 and 1 of their lines
OTHER = 'curve: {basis: polynomial, degree: 1, radius: 0.1, points: [[0, -1, 0], [0, 2, 0]]%s}'
ALONG_X = bezier('x', (-1, 0, 0), (1, 0, 0), radius=0.2)
ROBOT = f'{DATA}/robots/panda/panda.urdf'


def scene(*bodies, more=''):
    return 'world:\n  collision_objects:\n' + ''.join(
        f'    - {{id: o{number}, bodies: [{body}]{more}}}\n' for number, body in enumerate(bodies))


class CurveObstacles(Case):
    def a_standing_curve_is_as_far_as_by_hand(self):
        answer = self.ask('distance', [ALONG_X], scene(CABLE))
        self.assertEqual((answer.code, answer.err), (0, ''))
        row = answer.row('x')
        self.assertAnswer(row, 2 - 0.1 - 0.2)
        self.assertEqual((row['a'], row['b']), ('x', 'o0'))
        for name, value in (('t', 0.5), ('t_b', 0.5)):
            self.assertAlmostEqual(float(row[name]), value, places=4)
        self.assertPoint(row, 'b', (0, 0, 1.9))
        self.assertEqual(answer.code, 0)

    def its_object_has_a_pose_and_a_padding(self):
        quarter = f'orientation: [{math.sqrt(0.5)}, 0, 0, {math.sqrt(0.5)}]'  # about x: z becomes -y
        answer = self.ask('distance', [ALONG_X], scene(CABLE, more=f', padding: 0.3, pose: {{position: [0, 0, 5], {quarter}}}'))
        self.assertAnswer(answer.row('x'), math.hypot(2, 4) - 0.1 - 0.2 - 0.3)

    def verdicts_profiles_contacts_and_nearest_pairs_take_it(self):
        self.assertEqual(self.ask('tolerance', [ALONG_X], scene(CABLE), '--delta', '1.69').row('x')['verdict'], 'clear')
        self.assertEqual(self.ask('tolerance', [ALONG_X], scene(CABLE), '--delta', '1.71').row('x')['verdict'], 'violated')
        up = bezier('up', (0, 0, 0), (0, 0, 4), radius=0.2)
        row = self.ask('time-of-contact', [up], scene(CABLE)).row('up')
        self.assertEqual(row['verdict'], 'violated')
        self.assertAlmostEqual(float(row['t_contact_lower']), (2 - 0.3) / 4, delta=1e-5)
        rows = self.ask('profile', [up], scene(CABLE), '--breaks', '0, 0.25, 1').rows
        self.assertAlmostEqual(float(rows[0]['upper']), 0.7, delta=1e-5)
        many = self.ask('nearest', [ALONG_X], scene(CABLE, *['{type: sphere, dimensions: [0.5], pose: {position: [0, 9, 0]}}'] * 9), '--pairs', '1')
        self.assertEqual([row['b'] for row in many.rows], ['o0'])

    def among_many_objects_it_is_found(self):
        far = [f'{{type: box, dimensions: [1, 1, 1], pose: {{position: [{9 + number}, 20, 0]}}}}' for number in range(12)]
        self.assertAnswer(self.ask('distance', [ALONG_X], scene(CABLE, *far)).row('x'), 1.7)
        self.assertAnswer(self.ask('distance', [ALONG_X], scene(*far, CABLE)).row('x'), 1.7)

    def on_one_clock_they_cross_at_other_times(self):
        """Standing, the lines cross; with the clock (t - 0.5, 2t - 1) ... the other is at (0, 2t - 1): |(2t - 1, -(2t - 1))| is 0 at 0.5.
        Shifted by a metre along y, both are never nearer than sqrt(1/2)."""
        met = self.ask('collision', [ALONG_X], scene(f'{{type: curve, synchronized: true, {OTHER % ""}}}')).row('x')
        self.assertEqual(met['verdict'], 'violated')
        body = f'{{type: curve, synchronized: true, {OTHER % ""}, pose: {{position: [0, 1, 0]}}}}'
        row = self.ask('distance', [ALONG_X], scene(body)).row('x')
        self.assertAnswer(row, math.sqrt(0.5) - 0.3)
        self.assertAlmostEqual(float(row['t']), 0.25, places=4)
        self.assertEqual(row['t'], row['t_b'])
        standing = body.replace('synchronized: true, ', '')
        self.assertEqual(self.ask('collision', [ALONG_X], scene(standing)).row('x')['verdict'], 'violated')

    def by_rows_of_two_files_it_is_the_same(self):
        other = 'other,polynomial,1,0,1,0.1,2,0,0,0,0,2,0'
        files = [self.file('a.csv', ALONG_X + '\n'), self.file('b.csv', other + '\n')]
        row = cprox('distance', '--curves', files[0], '--against', files[1], '--synchronized').row('x')
        self.assertAnswer(row, math.sqrt(0.5) - 0.3)
        row = cprox('collision', '--curves', files[0], '--against', files[1]).row('x')
        self.assertEqual(row['verdict'], 'violated')

    def curves_without_length_are_balls(self):
        """Points that stay where they are, as mover, obstacle or both, on one clock or not."""
        still = bezier('x', (0, 0, 0), (0, 0, 0), (0, 0, 0), radius=0.2)
        constant = 'x,polynomial,2,0,1,0.2,3,0,0,0,0,0,0,0,0,0'
        body = '{type: curve, %scurve: {basis: bezier, radius: 0.1, points: [[0, 0, 2], [0, 0, 2]]}}'
        for mover in (ALONG_X, still, constant):
            for clock in ('', 'synchronized: true, '):
                with self.subTest(mover=mover, clock=clock):
                    point = scene(body % clock)
                    self.assertAnswer(self.ask('distance', [mover], point).row('x'), 1.7)
                    self.assertEqual(self.ask('collision', [mover], point).row('x')['verdict'], 'clear')
                    self.assertEqual(self.ask('tolerance', [mover], point, '--delta', '1.71').row('x')['verdict'], 'violated')
                    self.assertEqual(self.ask('time-of-contact', [mover], point).row('x')['verdict'], 'clear')
                    self.assertAnswer(self.ask('distance', [mover], scene(body.replace('2]', '0]') % clock)).row('x'), 0)
            with self.subTest(mover=mover, obstacle='line'):
                self.assertAnswer(self.ask('distance', [mover], scene(CABLE)).row('x'), 1.7)

    def what_cannot_be_asked_is_told(self):
        short = bezier('short', (-1, 0, 0), (1, 0, 0), t1=2)
        answer = self.ask('distance', [short], scene(f'{{type: curve, synchronized: true, {OTHER % ""}}}'))
        self.assertFailedRow(answer, 'short', "on the mover's clock", '[0, 2]')
        for body, words in ((f'{{type: curve, {OTHER % ", radius_polynomial: [0.1]"}}}', 'must be synchronized'),
                            ('{type: curve, curve: {basis: bezier, points: [[0, 0, 0]]}}', 'curve:'),
                            ('{type: curve}', 'curve'), ('{type: curve, curve: {basis: loop, points: []}}', "'loop'")):
            with self.subTest(body=body):
                self.assertRefused(self.ask('distance', [ALONG_X], scene(body)), words)
        self.assertRefused(cprox('distance', '--curves', 'x', '--synchronized'), '--synchronized needs --against')
        trajectory = os.path.join(DATA, 'trajectories', 'panda_box_0001_rrt.yaml')
        answer = cprox('distance', '--robot', ROBOT, '--trajectory', trajectory, '--scene', self.file('s.yaml', scene(CABLE)))
        self.assertEqual(answer.code, 2)
        self.assertIn("object 'o0' is a curve", answer.err)


class ChangingRadius(Case):
    """r(t) = 0.1 + 0.2 t + 0.3 t^2 along a line one metre above a box: least where r is most, at the end."""

    GROWS = 'grows,bezier,1,0,1,0.1 0.2 0.3,2,-0.5,0,2,0.5,0,2'
    BOX = scene('{type: box, dimensions: [2, 2, 2]}')

    def distances_are_less_the_radius_there(self):
        row = self.ask('distance', [self.GROWS], self.BOX).row('grows')
        self.assertAnswer(row, 1 - 0.6)
        self.assertAlmostEqual(float(row['t']), 1, places=4)
        self.assertEqual(self.ask('tolerance', [self.GROWS], self.BOX, '--delta', '0.39').row('grows')['verdict'], 'clear')
        self.assertEqual(self.ask('tolerance', [self.GROWS], self.BOX, '--delta', '0.41').row('grows')['verdict'], 'violated')
        wide = self.GROWS.replace('0.1 0.2 0.3', '0.1 1')
        self.assertEqual(self.ask('collision', [wide], self.BOX).row('grows')['verdict'], 'violated')

    def among_many_objects_the_largest_radius_counts(self):
        far = [f'{{type: sphere, dimensions: [0.5], pose: {{position: [{number}, 9, 0]}}}}' for number in range(12)]
        near = '{type: sphere, dimensions: [0.5], pose: {position: [0.5, 0, 3]}}'  # touched by the tube's end alone
        row = self.ask('distance', [self.GROWS.replace('0.1 0.2 0.3', '0.1 0.3')], scene(*far, near)).row('grows')
        self.assertEqual(row['b'], 'o12')
        self.assertAnswer(row, 0.5 - 0.4)

    def both_may_change_on_one_clock(self):
        """Confidence regions: 2 m apart all the time, radii 0.1 + 0.5 t and 0.2 + 0.1 t."""
        other = '{type: curve, synchronized: true, curve: {basis: bezier, radius: 0.2, radius_polynomial: [0.1], points: [[-0.5, 0, 4], [0.5, 0, 4]]}}'
        row = self.ask('distance', [self.GROWS.replace('0.1 0.2 0.3', '0.1 0.5')], scene(other)).row('grows')
        self.assertAnswer(row, 2 - 0.6 - 0.3)

    def a_curve_that_stands_is_nearest_where_the_radius_is_most(self):
        """A cable of 0.1 m, 2 m above the tube's end."""
        cable = '{type: curve, curve: {basis: bezier, radius: 0.1, points: [[-2, 0, 4], [2, 0, 4]]}}'
        row = self.ask('distance', [self.GROWS], scene(cable)).row('grows')
        self.assertAnswer(row, 2 - 0.1 - 0.6)
        self.assertAlmostEqual(float(row['t']), 1, places=4)

    def the_papers_prediction_grows_until_it_touches(self):
        """examples/papers: (t - 2)^2 + 1 = (0.35 + 0.35 t)^2 at the pillar; the fence is reached at t = 3.714."""
        files = ['--curves', f'{PAPERS}/prediction.csv', '--scene', f'{PAPERS}/prediction.yaml']
        answer = cprox('distance', *files)
        self.assertAnswer(answer.row('sure'), 1 - 0.25 - 0.1)
        self.assertEqual(float(answer.row('growing')['upper']), 0)
        answer = cprox('time-of-contact', *files)
        self.assertEqual(answer.row('sure')['verdict'], 'clear')
        row = answer.row('growing')
        self.assertEqual((row['verdict'], row['b']), ('violated', 'pillar'))
        a, b, c = 1 - 0.35**2, -4 - 2 * 0.35**2, 5 - 0.35**2
        self.assertAlmostEqual(float(row['t']), (-b - math.sqrt(b * b - 4 * a * c)) / (2 * a), places=5)

    def what_cannot_be_asked_is_told(self):
        down = self.GROWS.replace('0.1 0.2 0.3', '0.1 -1')
        self.assertFailedRow(self.ask('distance', [down], self.BOX), 'grows', 'radius', 'must be 0 or more')
        self.assertFailedRow(self.ask('distance', [self.GROWS.replace('0.1 0.2', '0.1 x')], self.BOX), 'grows', "'x' is not a finite number")
