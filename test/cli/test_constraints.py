# SPDX-License-Identifier: BSD-3-Clause
"""Constraint providers from the command line, loaded as plugins without a master."""
import os

from support import HERE, Case, cprox

CURVES, PAIRS, GAP = (f'curve_proximity/{name}' for name in ('CurveDistance', 'SuperquadricDistance', 'FourierGap'))
BALL = '{type: sphere, dimensions: [0.25]}'


class Constraints(Case):
    def constraints(self, provider, cases, *more):
        return cprox('constraints', '--provider', provider, '--in', self.file('cases.yaml', 'cases:\n' + cases), *more)

    def a_curve_has_a_value_an_interval_and_gradients_by_its_points(self):
        answer = self.constraints(CURVES, f'''
- id: passing
  curve: {{basis: bezier, radius: 0.1, points: [[-1, 0, 1], [3, 0, 1]]}}
  b: {{bodies: [{BALL}], pose: {{position: [1, 0, 0]}}}}
''')
        self.assertEqual((answer.code, answer.err), (0, ''))
        row = answer.row('passing')
        self.assertEqual((row['provider'], row['status'], row['valid'], row['n']), (CURVES, 'ok', 'true', '2'))
        self.assertLessEqual(float(row['lower']), 0.65 + 1e-15)
        self.assertGreaterEqual(float(row['upper']), 0.65 - 1e-15)
        self.assertAlmostEqual(float(row['t']), 0.5, delta=1e-6)
        self.assertAlmostEqual(float(row['g0z']), 0.5, delta=1e-6)
        self.assertAlmostEqual(float(answer.out.splitlines()[1].split(',')[-1]), 0.5, delta=1e-6)
        self.assertAlmostEqual(float(row['gb_vz']), -1.0, delta=1e-6)
        self.assertAlmostEqual(float(row['b_z']), 0.25, delta=1e-6)

    def a_body_that_turns_on_its_way_is_a_robot_of_one_link(self):
        examples = os.path.join(os.path.dirname(os.path.dirname(HERE)), 'examples')
        scene = ('--scene', examples + '/turning/lens.yaml')
        tray = ('--robot', examples + '/turning/tray.urdf', '--trajectory', examples + '/turning/tray.yaml', *scene)
        for provider in ('curve_proximity/RobotDistance', 'curve_proximity/GrowthDistance'):
            checked = cprox('constraints', '--provider', provider, *tray, '--check-gradient').row('tray')
            self.assertEqual((checked['verdict'], checked['derivatives']), ('clear', '22'), checked)
        value = cprox('constraints', '--provider', 'curve_proximity/RobotDistance', *tray).row('tray')['value']
        body = self.file('body.yaml', 'id: tray\npose: {position: [0, 0, 0.05]}\nprimitives: [{type: box, dimensions: [0.4, 0.2, 0.02]}]\n')
        path = cprox('distance', '--path', examples + '/formats/path.yaml', '--body', body, *scene).row('path')
        # over a right angle a line of quaternions leads or lags slerp by at most 0.9 degrees: 3.6 mm at the tray's corners
        self.assertAlmostEqual(float(value), float(path['upper']), delta=0.0036)

    def pairs_of_superquadrics_and_gaps_are_answered_with_parameters(self):
        cases = '''
- id: two
  a: {bodies: [{type: superquadric, dimensions: [0.5, 0.5, 0.5, 2, 2, 2]}]}
  b: {bodies: [{type: ellipsoid, dimensions: [0.5, 0.5, 0.5]}], pose: {position: [3, 0, 0]}}
'''
        row = self.constraints(PAIRS, cases, '--parameters', 'margin: 0.25').row('two')
        self.assertAlmostEqual(float(row['value']), 1.75, delta=1e-8)
        self.assertEqual((row['n'], row['t']), ('0', ''))
        cases = cases.replace('superquadric, dimensions: [0.5, 0.5, 0.5, 2, 2, 2]', 'box, dimensions: [1, 1, 1]')
        row = self.constraints(GAP, cases.replace('[3,', '[0.7,'), '--parameters', 'mode: signal, samples: 9').row('two')
        self.assertEqual((row['lower'], row['a_x'], row['valid']), ('', '', 'true'))
        self.assertLess(float(row['touching_least']), float(row['touching_most']))
        self.assertIn('outwards', self.constraints(GAP, cases, '--parameters', 'mode: tuned').err)
        row = self.constraints(GAP, cases.replace('[3,', '[1.3,'), '--parameters', 'mode: guide, samples: 9').row('two')
        self.assertAlmostEqual(float(row['value']), 0.3, delta=1e-8)
        self.assertEqual((row['touching_least'], row['touching_most']), ('', ''))
        self.assertGreater(float(row['gb_vx']), 0.0)

    def a_gap_for_a_delta_is_made_of_every_kind_of_body_in_every_mode(self):
        corners = ', '.join(f'[{x}, {y}, {z}]' for x in (-0.4, 0.4) for y in (-0.3, 0.3) for z in (-0.35, 0.35))
        flat = '[[-0.5, -0.4, 0], [0.5, -0.4, 0], [0, 0.6, 0]]'
        both = {'sphere': 'dimensions: [0.5]', 'box': 'dimensions: [1, 0.8, 0.6]', 'ellipsoid': 'dimensions: [0.6, 0.5, 0.7]'}
        kinds = {2: {**both, 'polytope': f'vertices: {flat}'},
                 3: {**both, 'cylinder': 'dimensions: [1, 0.4]', 'capsule': 'dimensions: [0.6, 0.4]', 'cone': 'dimensions: [1, 0.5]',
                     'polytope': f'vertices: [{corners}]',
                     'mesh': 'mesh: {vertices: [[-0.5, -0.4, -0.3], [0.5, -0.4, -0.3], [0, 0.6, -0.3], [0, 0, 0.6]], '
                             'triangles: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]}'}}
        for dimension, bodies in kinds.items():
            cases = ''.join(f'- {{id: {kind}_{other}, a: {{bodies: [{{type: {kind}, {body}}}]}}, '
                            f'b: {{bodies: [{{type: {other}, {bodies[other]}}}], pose: {{position: [0.4, 0.1, 0]}}}}}}\n'
                            for kind, body in bodies.items() for other in dict.fromkeys((kind, 'box')))
            for mode in ('certified', 'signal'):
                with self.subTest(dimension=dimension, mode=mode):
                    answer = self.constraints(GAP, cases, '--parameters', f'mode: {mode}, dimension: {dimension}, delta: 0.95')
                    self.assertEqual((answer.code, answer.err), (0, ''))
                    for kind in bodies:
                        self.assertEqual(answer.row(f'{kind}_box')['status'], 'ok')
                        if mode == 'certified':
                            self.assertLess(float(answer.row(f'{kind}_{kind}')['upper']), 0.0)

    def objects_are_those_of_the_scene(self):
        scene = self.file('scene.yaml', '''
world:
  collision_objects:
    - {id: box, primitives: [{type: box, dimensions: [2, 2, 2]}], pose: {position: [5, 0, 0]}}
''')
        answer = self.constraints(CURVES, '''
- {id: there, curve: {basis: bezier, points: [[0, -4, 0], [0, 4, 0]]}, b: {id: box}}
- {id: moved, curve: {basis: bezier, points: [[0, -4, 0], [0, 4, 0]]}, b: {id: box, pose: {position: [3, 0, 0]}}}
- {id: none, curve: {basis: bezier, points: [[0, -4, 0], [0, 4, 0]]}, b: {id: ghost}}
''', '--scene', scene)
        self.assertEqual(answer.code, 2)
        self.assertAlmostEqual(float(answer.row('there')['value']), 4.0, delta=1e-8)
        self.assertAlmostEqual(float(answer.row('moved')['value']), 2.0, delta=1e-8)
        self.assertEqual(answer.row('none')['status'], 'invalid')
        self.assertIn("'ghost'", answer.err)

    def wrong_cases_are_rows_without_numbers_and_the_others_are_answered(self):
        good = f'a: {{bodies: [{BALL}]}}, b: {{bodies: [{BALL}], pose: {{position: [0, 2, 0]}}}}'
        answer = self.constraints(PAIRS, f'''
- {{id: negative, a: {{bodies: [{{type: sphere, dimensions: [-1]}}]}}, b: {{bodies: [{BALL}]}}}}
- {{id: curve, curve: {{basis: bezier, points: [[0, 0, 0], [1, 0, 0]]}}, b: {{bodies: [{BALL}]}}}}
- {{id: frame, a: {{bodies: [{BALL}], header: {{frame_id: elsewhere}}}}, b: {{bodies: [{BALL}]}}}}
- {{id: empty}}
- {{id: arm, trajectory: {{joint_names: []}}}}
- {{id: good, {good}}}
''')
        self.assertEqual(answer.code, 2)
        self.assertEqual(answer.row('curve')['status'], 'ok')  # as CurveDistance answers
        for name, word in (('negative', 'sphere'), ('frame', 'elsewhere'), ('empty', "'b'"),
                           ('arm', '--trajectory T.yaml')):
            self.assertEqual((answer.row(name)['status'], answer.row(name)['value']), ('invalid', ''))
            self.assertIn(word, [line for line in answer.err.splitlines() if f"'{name}'" in line][0])
        self.assertAlmostEqual(float(answer.row('good')['value']), 1.5, delta=1e-8)

    def wrong_providers_and_parameters_are_refused_by_name(self):
        case = f'- {{id: x, b: {{bodies: [{BALL}]}}}}\n'
        self.assertRefused(self.constraints('curve_proximity/Nonsense', case), '--provider curve_proximity/Nonsense', 'FourierGap')
        for text, word in (('mode: sure', 'parameter mode'), ('samples: 2.5', 'parameter samples'), ('sample: 9', 'no such parameter'),
                           ('samples: [1, two]', 'samples'), ('samples: {a: 1}', 'samples'), ('samples: [', '--parameters')):
            with self.subTest(text=text):
                self.assertRefused(self.constraints(GAP, case, '--parameters', text), word)
        self.assertRefused(cprox('constraints', '--in', 'x'), '--provider')
        self.assertRefused(cprox('constraints', '--provider', GAP), '--in')
        self.assertRefused(cprox('constraints', '--provider', GAP, '--in', self.file('list.yaml', '- 1')), "a list 'cases'")
        self.assertRefused(cprox('pairs', '--in', 'x', '--provider', GAP), "'pairs' takes no --provider")


ROBOT = 'curve_proximity/RobotDistance'


class Trajectories(Case):
    """A slider that comes down on a table, from 1.5 m to 0.7 m and up to 1.1 m: a ball of 0.1 m, so 0.6 m at t = 1."""

    def inputs(self):
        robot = self.file('slider.urdf', '''
<robot name="slider">
  <link name="base"/>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="tool"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <link name="tool"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
</robot>''')
        scene = self.file('scene.yaml', '''
world:
  collision_objects:
    - {id: table, primitives: [{type: box, dimensions: [2, 2, 0.2]}], pose: {position: [0, 0, -0.1]}}
    - {id: ceiling, primitives: [{type: box, dimensions: [2, 2, 0.2]}], pose: {position: [0, 0, 2.1]}}
''')
        path = self.file('t.yaml', '''
joint_trajectory:
  joint_names: [lift]
  points:
    - {positions: [1.5], velocities: [0.0], time_from_start: 0}
    - {positions: [0.7], velocities: [0.0], time_from_start: 1}
    - {positions: [1.1], velocities: [0.1], time_from_start: 3}
''')
        return '--robot', robot, '--scene', scene, '--trajectory', path

    def constraints(self, *more, provider=ROBOT):
        return cprox('constraints', '--provider', provider, *self.inputs(), *more)

    def the_least_distance_has_a_gradient_by_every_point(self):
        answer = self.constraints('--parameters', 'margin: 0.05')
        self.assertEqual((answer.code, answer.err), (0, ''))
        row = answer.row('t')
        self.assertEqual((row['status'], row['valid'], row['kind'], row['a'], row['b']), ('ok', 'true', 'environment', 'tool', 'ceiling'))
        self.assertAlmostEqual(float(row['value']), 0.35, delta=1e-5)
        self.assertLessEqual(float(row['lower']), 0.35)
        self.assertAlmostEqual(float(row['t']), 0.0, delta=1e-9)
        self.assertEqual([round(float(row[name]), 6) for name in ('q0_lift', 'q1_lift', 'q2_lift', 'v0_lift', 'v2_lift')], [-1, 0, 0, 0, 0])
        self.assertEqual((float(row['ga_vz']), float(row['gb_vz'])), (-1, 1))
        self.assertNotIn('a0_lift', row)

    def rows_are_those_of_pairs_within_the_horizon(self):
        answer = self.constraints('--parameters', 'horizon: 0.62')
        self.assertEqual((answer.code, answer.err), (0, ''))
        self.assertEqual([(row['b'], round(float(row['value']), 4), round(float(row['t']), 4)) for row in answer.rows],
                         [('ceiling', 0.4, 0), ('table', 0.6, 1)])
        self.assertEqual((float(answer.rows[1]['t0']), float(answer.rows[0]['t1'])), (0, 1))
        answer = self.constraints('--parameters', 'horizon: 0.3')
        row = answer.row('t')
        self.assertEqual((answer.code, float(row['value']), float(row['upper']), row['kind'], row['q0_lift']), (0, 0.3, float('inf'), '', ''))

    def a_robot_that_stands_still_is_as_near_with_a_horizon_as_without(self):
        for height, value in ((0.05, 0.0), (0.4, 0.3)):
            words = list(self.inputs())
            words[5] = self.file('t.yaml', 'joint_trajectory: {joint_names: [lift], points: ['
                                 + ', '.join(f'{{positions: [{height}], time_from_start: {t}}}' for t in range(3)) + ']}')
            for parameters in ('margin: 0', 'horizon: 0.5', 'horizon: 0.5, smoothing: 1.0e-6'):
                row = cprox('constraints', '--provider', ROBOT, *words, '--parameters', parameters).rows[0]
                self.assertAlmostEqual(float(row['value']), value, delta=1e-5, msg=parameters)
                self.assertLessEqual(float(row['lower']), value)
                self.assertEqual((row['a'], row['b']), ('tool', 'table'))
            growth = cprox('constraints', '--provider', 'curve_proximity/GrowthDistance', *words).rows[0]
            self.assertEqual(float(growth['value']) < 0.0, value == 0.0)

    def gradients_are_held_against_differences(self):
        answer = self.constraints('--check-gradient')
        self.assertEqual((answer.code, answer.err), (0, ''))
        row = answer.row('t')
        self.assertEqual((row['verdict'], row['derivatives']), ('clear', '7'))
        self.assertLess(float(row['misfit']), 1e-4)
        self.assertEqual(self.constraints('--check-gradient', '--parameters', 'horizon: 0.3').code, 0)

    def a_provider_whose_gradient_is_wrong_is_told(self):
        answer = self.constraints('--check-gradient', provider='faulty_provider/WrongGradient')
        row = answer.row('t')
        self.assertEqual((answer.code, answer.err, row['verdict'], row['derivative']), (1, '', 'violated', 'position 0 lift'))
        self.assertEqual((float(row['gradient']), round(float(row['difference']), 6)), (1.5, 3.0))

    def among_what_moves_the_gradient_is_by_the_trajectory_and_its_start(self):
        """A ball falls towards the tool, which rises, and goes up again."""
        words = list(self.inputs())
        words[5] = self.file('t.yaml', 'joint_trajectory: {joint_names: [lift], points: [{positions: [0.2], time_from_start: 0}, '
                             '{positions: [0.4], time_from_start: 1}, {positions: [0.1], time_from_start: 3}]}')
        words[3] = self.file('scene.yaml', """
world:
  collision_objects:
    - id: ball
      primitives: [{type: sphere, dimensions: [0.1]}]
      trajectory: {waypoints: [{time: 0, pose: {position: [0, 0, 1.9]}}, {time: 0.5, pose: {position: [0, 0, 0.9]}}, {time: 3, pose: {position: [0, 0, 1.9]}}]}
""")
        answer = cprox('constraints', '--provider', ROBOT, *words)
        self.assertEqual((answer.code, answer.err), (0, ''))
        row = answer.row('t')
        self.assertEqual((row['status'], row['valid'], row['kind'], row['a'], row['b']), ('ok', 'true', 'environment', 'tool', 'ball'))
        # at .5 s the ball is at .9 and the tool at .3, which goes up at .2 m/s
        self.assertAlmostEqual(float(row['value']), 0.4, delta=1e-5)
        self.assertAlmostEqual(float(row['t']), 0.5, delta=1e-6)
        told = {name: float(row[name]) for name in ('q0_lift', 'q1_lift', 'q2_lift', 'g_start', 'g_duration', 'ga_vz', 'gb_vz')}
        for name, true in (('q0_lift', -0.5), ('q1_lift', -0.5), ('q2_lift', 0), ('g_start', 0.2), ('g_duration', 0.1 / 3), ('ga_vz', -1), ('gb_vz', 1)):
            self.assertAlmostEqual(told[name], true, delta=1e-6, msg=name)
        checked = cprox('constraints', '--provider', ROBOT, *words, '--check-gradient')
        self.assertEqual((checked.code, checked.row('t')['verdict'], checked.row('t')['derivatives']), (0, 'clear', '4'), checked.err)
        self.assertIn('a horizon is not available', cprox('constraints', '--provider', ROBOT, *words, '--parameters', 'horizon: 0.5').err)
        self.assertIn('nothing moves beside the robot', cprox('constraints', '--provider', 'faulty_provider/WrongGradient', *words).err)

    def what_is_wrong_is_told_by_one_line(self):
        self.assertIn('not for joint trajectories', self.constraints(provider=CURVES).err)
        self.assertEqual(self.constraints(provider=CURVES).code, 2)
        self.assertIn('RobotDistance is about joint trajectories', cprox(
            'constraints', '--provider', ROBOT, '--in',
            self.file('cases.yaml', f'cases:\n- {{id: x, a: {{bodies: [{BALL}]}}, b: {{bodies: [{BALL}]}}}}')).err)
        self.assertRefused(self.constraints('--in', 'x'), '--trajectory takes no --in')
        self.assertRefused(self.constraints('--parameters', 'against: walls'), 'environment, self, whole')
        self.assertRefused(self.constraints('--parameters', 'horizon: -1'), 'parameter horizon')
        self.assertRefused(cprox('constraints', '--provider', CURVES, '--in', 'x', '--state', 'y'), '--state needs --robot')
        self.assertRefused(cprox('constraints', '--provider', ROBOT, '--trajectory', 'x'), '--trajectory needs --robot')


class Gradients(Case):
    """--check-gradient of providers about sides and curves."""

    def check(self, provider, cases, *more):
        return cprox('constraints', '--provider', provider, '--in', self.file('cases.yaml', 'cases:\n' + cases), '--check-gradient', *more)

    def those_that_agree_are_clear(self):
        answer = self.check(CURVES, f'''
- id: passing
  curve: {{basis: bezier, radius: 0.1, points: [[-1, 0.1, 1], [1, 0.2, 0.6], [3, 0, 1]]}}
  b: {{bodies: [{{type: ellipsoid, dimensions: [0.3, 0.2, 0.25]}}], pose: {{position: [1, 0, 0]}}}}
''')
        self.assertEqual((answer.code, answer.err), (0, ''))
        self.assertEqual((answer.row('passing')['verdict'], answer.row('passing')['derivatives']), ('clear', '22'))
        answer = self.check(PAIRS, f'''
- {{id: two, a: {{bodies: [{BALL}]}}, b: {{bodies: [{{type: superquadric, dimensions: [0.3, 0.4, 0.2, 2, 3, 4]}}], pose: {{position: [1, 0.4, 0.2]}}}}}}
''')
        self.assertEqual((answer.code, answer.row('two')['verdict'], answer.row('two')['derivatives']), (0, 'clear', '12'))

    def gradients_of_rational_curves_by_their_points_agree(self):
        """Weights, knots and a restriction pass through the message Curve."""
        answer = self.check(CURVES, f'''
- id: arc
  curve: {{basis: rational_bezier, radius: 0.1, points: [[-1, 0.1, 1], [1, 0.2, 0.6], [3, 0, 1]], parameters: [1, 2.5, 0.7]}}
  b: {{bodies: [{{type: ellipsoid, dimensions: [0.3, 0.2, 0.25]}}], pose: {{position: [1, 0, 0]}}}}
- id: nurbs
  curve: {{basis: nurbs, degree: 2, points: [[-1, 0.1, 1], [1, 0.2, 0.6], [3, 0, 1]], knots: [0, 0, 0, 4, 4, 4],
           parameters: [1, 2.5, 0.7], restrict_t0: 1, restrict_t1: 3.5}}
  b: {{bodies: [{{type: ellipsoid, dimensions: [0.3, 0.2, 0.25]}}], pose: {{position: [1, 0, 0]}}}}
''')
        self.assertEqual((answer.code, answer.err), (0, ''))
        self.assertEqual([(row['verdict'], row['derivatives']) for row in answer.rows], [('clear', '25'), ('clear', '24')])

    def gradients_by_what_defines_a_curve_agree(self):
        cases = '''
- id: drive
  a: {bodies: [{type: sphere, dimensions: [0.05]}]}
  curve: {basis: dubins, points: [[-1, 0, 0], [1, 0.2, 0]], parameters: [0.3, -0.6, 0.3]}
  b: {bodies: [{type: sphere, dimensions: [0.25]}], pose: {position: [0.2, 0.9, 0.1]}}
- id: unwound
  a: {bodies: [{type: sphere, dimensions: [0.05]}]}
  curve: {basis: involute, t0: 0.2, t1: 3, points: [[0, 0, 0]], parameters: [-1.0, 0.3]}
  b: {bodies: [{type: box, dimensions: [0.4, 0.4, 0.4]}], pose: {position: [0.4, 1.6, 0.1]}}
- id: bend
  a: {bodies: [{type: sphere, dimensions: [0.05]}]}
  curve: {basis: pythagorean_hodograph, degree: 1, points: [[-0.5, 0, 0]], parameters: [1, 0.1, 0, 0.2, 0.9, 0, 0.1, 0.3]}
  b: {bodies: [{type: sphere, dimensions: [0.25]}], pose: {position: [0.2, 0.9, 0.1]}}
'''
        for provider in (CURVES, GAP):
            rows = self.check(provider, cases).rows
            self.assertEqual([(row['id'], row['verdict'], row['derivatives']) for row in rows],
                             [('drive', 'clear', '19'), ('unwound', 'clear', '19'), ('bend', 'clear', '23')], provider)

    def where_there_is_no_gradient_nothing_is_decided(self):
        answer = self.check(CURVES, f'''
- id: along
  curve: {{basis: bezier, points: [[-1, 0, 1], [1, 0, 1]]}}
  b: {{bodies: [{{type: box, dimensions: [9, 9, 1]}}]}}
''')
        self.assertEqual((answer.code, answer.row('along')['verdict'], answer.row('along')['derivatives']), (3, 'undecided', '0'))
        self.assertIn('not valid', answer.row('along')['message'])
