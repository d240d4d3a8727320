# SPDX-License-Identifier: BSD-3-Clause
"""Robots along joint trajectories."""
import json
import math
import os
import re

from support import DATA, Case, cprox

# A slider of one joint that carries a bar of 0.2 along x; beside it a pole that nothing moves.
SLIDER = '''<robot name="slider">
  <link name="rail"/>
  <link name="cart"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="0 0 0.5"/><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
  <link name="hand"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="swing" type="revolute"><parent link="cart"/><child link="arm"/><origin xyz="0 0 0.2"/><axis xyz="0 1 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="wrist" type="revolute"><parent link="arm"/><child link="hand"/><origin xyz="0 0 1.2"/><axis xyz="0 1 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
</robot>'''
WALL = '''
world:
  collision_objects:
    - {id: wall, primitives: [{type: box, dimensions: [1, 4, 4]}], primitive_poses: [{position: [3.5, 0, 0]}]}
    - {id: post, primitives: [{type: sphere, dimensions: [0.25]}], primitive_poses: [{position: [0, 2, 0]}]}
'''
SLIDE = '''
joint_trajectory:
  joint_names: [slide]
  points:
    - {positions: [0], time_from_start: 0}
    - {positions: [2], time_from_start: {secs: 4, nsecs: 0}}
'''


class Trajectory(Case):
    def robot(self, query_type, trajectory, *more, urdf=SLIDER, scene=WALL, srdf=None):
        words = [query_type, '--robot', self.file('robot.urdf', urdf), '--trajectory', self.file('go.yaml', trajectory)]
        if scene:
            words += ['--scene', self.file('scene.yaml', scene)]
        if srdf:
            words += ['--srdf', self.file('robot.srdf', srdf)]
        return cprox(*words, *more)

    def a_joint_spline_is_a_bspline_of_the_joint_values(self):
        """Degree 2 through 0, 4, 0 over [0, 2]: the cart reaches x = 2 at t = 1, the wall's face is at x = 3."""
        spline = ('joint_spline: {joint_names: [slide], degree: 2, knots: [0, 0, 0, 2, 2, 2], '
                  'control_points: [[0], [4], [0]]}')
        row = self.robot('distance', spline).rows[0]
        self.assertAnswer(row, 3 - 2 - 0.1)
        self.assertAlmostEqual(float(row['t']), 1.0, delta=1e-3)
        for wrong, words in (('knots: [0, 0, 0, 2, 2]', 'need 6 knots, got 5'), ('degree: 0', 'at least 1'),
                             ('degree: 3', 'at least 4 control points'), ('knots: [0, 0, 0, -2, 2, 2]', 'knot')):
            key = wrong.split(':')[0]
            text = spline.replace({'knots': 'knots: [0, 0, 0, 2, 2, 2]', 'degree': 'degree: 2'}[key], wrong)
            answer = self.robot('distance', text)
            self.assertNotEqual(answer.code, 0, wrong)
            self.assertIn(words, answer.err + answer.out, wrong)
        both = spline + '\njoint_trajectory: {joint_names: [slide], points: []}'
        self.assertIn('both a joint_trajectory and a joint_spline', self.robot('distance', both).err)

    def the_environment_row_names_link_object_and_time(self):
        answer = self.robot('distance', SLIDE)
        self.assertEqual((answer.code, answer.err), (0, ''))
        row = answer.row('go')
        self.assertAnswer(row, 3 - 2 - 0.1)
        self.assertEqual((row['kind'], row['b']), ('environment', 'wall'))
        self.assertIn(row['a'], ('cart', 'hand'))  # both reach 0.1 ahead
        self.assertAlmostEqual(float(row['t']), 4.0, places=5)
        self.assertAlmostEqual(float(row['b_x']), 3.0, places=5)

    def links_that_the_motion_does_not_move_count(self):
        """A ball of 0.1 in the middle of the arm, while the wrist alone moves, or nothing at all."""
        ball = ('world: {collision_objects: [{id: ball, primitives: [{type: sphere, dimensions: [0.1]}], '
                'primitive_poses: [{position: [0, 0, 0.7]}]}]}')
        wrist = SLIDE.replace('[slide]', '[wrist]')
        for trajectory in (wrist, wrist.replace('[2]', '[0]')):
            answer = self.robot('collision', trajectory, scene=ball)
            self.assertEqual((answer.code, answer.row('go')['verdict'], answer.row('go')['a']), (1, 'violated', 'arm'))
            row = self.robot('time-of-contact', trajectory, scene=ball).row('go')
            self.assertEqual((row['verdict'], float(row['t'])), ('violated', 0.0))
            row = self.robot('nearest', trajectory, '--pairs', '1', scene=ball).rows[0]
            self.assertEqual((row['a'], float(row['upper'])), ('arm', 0.0))
            for row in self.robot('profile', trajectory, '--intervals', '3', scene=ball).rows:
                self.assertEqual(float(row['upper']), 0.0)

    def links_that_stand_are_left_out_where_that_is_asked_for_and_the_row_says_so(self):
        ball = ('world: {collision_objects: [{id: ball, primitives: [{type: sphere, dimensions: [0.1]}], '
                'primitive_poses: [{position: [0, 0, 0.7]}]}]}')
        wrist = SLIDE.replace('[slide]', '[wrist]')
        answer = self.robot('distance', wrist, '--moving-links-only', scene=ball)
        self.assertEqual(answer.row('go')['a'], 'hand')
        self.assertAnswer(answer.row('go'), 1.4 - 0.1 - 0.7 - 0.1)
        self.assertIn('moving_only', answer.row('go')['message'])
        self.assertRefused(cprox('distance', '--scene', self.file('scene.yaml', ball), '--moving-links-only', '--curves',
                                 self.file('c.csv', 'id,basis,radius,points\n')), '--moving-links-only')

    def what_is_inside_of_a_closed_mesh_of_a_link_is_in_contact(self):
        """A cube of 0.4 as a mesh, round a ball of 0.05; without one of its triangles it is a surface, 0.15 away."""
        corners = [(x, y, z) for x in (-.2, .2) for y in (-.2, .2) for z in (-.2, .2)]
        faces = [(0, 1, 3), (0, 3, 2), (4, 7, 5), (4, 6, 7), (0, 5, 1), (0, 4, 5), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
                 (1, 7, 3), (1, 5, 7)]
        ball = ('world: {collision_objects: [{id: ball, primitives: [{type: sphere, dimensions: [0.05]}], '
                'primitive_poses: [{position: [0, 0, 0]}]}]}')
        urdf = SLIDER.replace('<box size="0.2 0.2 0.2"/>', '<mesh filename="cube.obj"/>')
        creep = SLIDE.replace('[2]', '[0.01]')
        for n, expected in ((12, 0.0), (11, 0.14)):
            self.file('cube.obj', ''.join('v %g %g %g\n' % c for c in corners) +
                      ''.join('f %d %d %d\n' % tuple(i + 1 for i in f) for f in faces[:n]))
            for links in ((), ('--links', 'cart')):
                answer = self.robot('distance', creep, *links, urdf=urdf, scene=ball)
                self.assertAnswer(answer.row('go'), expected)
            words = 'a mesh of it is not closed: its surface alone counts'
            told = self.robot('distance', creep, '--skipped', urdf=urdf, scene=ball)
            self.assertEqual(words in told.err + told.out, n == 11)

    def verdicts_are_given(self):
        self.assertEqual(self.robot('tolerance', SLIDE, '--delta', '0.89').row('go')['verdict'], 'clear')
        self.assertEqual(self.robot('tolerance', SLIDE, '--delta', '0.91').row('go')['verdict'], 'violated')
        self.assertEqual(self.robot('collision', SLIDE).row('go')['verdict'], 'clear')
        self.assertEqual(self.robot('collision', SLIDE.replace('[2]', '[3]')).row('go')['verdict'], 'violated')

    def certificates_are_proven_by_the_checker_and_by_no_other_query(self):
        file = os.path.join(self.folder, 'proof.cpc')
        swing = SLIDE.replace('[slide]', '[slide, swing]').replace('[0]', '[0, 0]').replace('[2]', '[2, 0.5]')
        for query_type, more, said in (('distance', [], 'proven: farther than'), ('tolerance', ['--delta', '0.1'], 'proven: farther than 0.1'),
                                 ('tolerance', ['--delta', '3'], 'proven: not farther than 3 m'), ('collision', [], 'proven: farther than 0 m')):
            asked = self.robot(query_type, swing, '--self', '--certificate', file, *more)
            self.assertEqual((asked.code, asked.err), (asked.code_of_verdicts(), ''))
            checked = self.robot('check', swing, file, '--self')
            self.assertEqual(checked.code, 0, checked.out + checked.err)
            lines = checked.out.splitlines()
            self.assertEqual([line.split(':')[0] for line in lines], ['go.environment', 'go.self'])
            for line, row in zip(lines, asked.rows):
                self.assertIn(said, line)
                if query_type == 'distance':
                    self.assertAlmostEqual(float(line.split('farther than ')[1].split(' m')[0]), float(row['lower']), delta=1.001e-6)

        for query_type, more in (('profile', ['--intervals', '3']), ('violations', ['--delta', '1', '--resolution', '1e-5'])):
            plain, asked = self.robot(query_type, swing, '--self', *more), self.robot(query_type, swing, '--self', '--certificate', file, *more)
            self.assertEqual((asked.code, asked.rows, asked.err), (plain.code, plain.rows, ''))
            checked = self.robot('check', swing, file, '--self')
            self.assertEqual((checked.code, checked.out.count(': proven: ')), (0, 2), checked.out + checked.err)
            for line in checked.out.splitlines() if query_type == 'profile' else []:
                self.assertEqual(line.count('; '), 2, line)

        # it goes farther than the query that was proven
        self.robot('tolerance', swing, '--certificate', file, '--delta', '0.3')
        for trajectory, code in ((swing, 0), (swing.replace('[2, 0.5]', '[2.5, 0.5]'), 1)):
            checked = self.robot('check', trajectory, file)
            self.assertEqual(checked.code, code, checked.out + checked.err)
        self.assertIn('go.environment: refused: a pair is not settled', checked.out)

    def proofs_of_meshes_change_no_answer(self):
        """A slider that goes through a window: the mesh of a frame, and the same as a solid."""
        file = os.path.join(self.folder, 'proof.cpc')
        corners = [[0, y, z] for s in (1, 3) for y, z in ((-s, -s), (s, -s), (s, s), (-s, s))]
        vertices = [[x, y, z] for x in (0.8, 1.2) for _, y, z in corners]
        triangles = []
        for k in range(4):
            n = (k + 1) % 4
            quads = [(k, 4 + k, 4 + n, n), (8 + n, 12 + n, 12 + k, 8 + k), (n, 8 + n, 8 + k, k), (4 + k, 12 + k, 12 + n, 4 + n)]
            triangles += [t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])]
        for solid in ('', ', solid: true'):
            scene = ('world: {collision_objects: [{id: window, bodies: [{type: mesh, vertices: %s, triangles: %s%s}]}]}'
                     % (vertices, triangles, solid))
            urdf = SLIDER.replace('size="0.1 0.1 1"', 'size="0.1 0.1 0.2"').replace('xyz="0 0 1.2"', 'xyz="0 0 0.4"')
            for query_type, more in (('distance', []), ('collision', []), ('tolerance', ['--delta', '0.01'])):
                plain = self.robot(query_type, SLIDE, *more, scene=scene, urdf=urdf)
                asked = self.robot(query_type, SLIDE, '--certificate', file, *more, scene=scene, urdf=urdf)
                self.assertEqual((plain.code, asked.code), (plain.code_of_verdicts(),) * 2, asked.err)
                self.assertEqual([{k: v for k, v in row.items() if k not in ('microseconds', 'proof')} for row in asked.rows],
                                 plain.without_times()[0:len(asked.rows)])
                self.assertIn(asked.rows[0]['proof'], ('apart', 'near'), asked.err)
                checked = self.robot('check', SLIDE, file, scene=scene, urdf=urdf)
                self.assertEqual(checked.code, 0, checked.out + checked.err)
                self.assertIn('go.environment: proven', checked.out)
            short = SLIDE.replace('[2]', '[0.3]')
            asked = self.robot('distance', short, '--certificate', file, scene=scene, urdf=urdf)
            self.assertEqual(asked.rows[0]['proof'], 'apart', asked.err)
            checked = self.robot('check', short, file, scene=scene, urdf=urdf)
            self.assertEqual(checked.code, 0, checked.out + checked.err)

    def each_object_has_a_row_of_its_own_when_asked(self):
        answer = self.robot('distance', SLIDE, '--per-object')
        self.assertEqual([row['b'] for row in answer.rows], ['post', 'wall'])
        self.assertAnswer(answer.rows[0], 2 - 0.1 - 0.25)  # the cart's side at its start, level with the post

    def self_pairs_need_two_joints_between_them_and_one_that_moves(self):
        swing = '''
joint_trajectory:
  joint_names: [swing]
  points: [{positions: [0], time_from_start: 0}, {positions: [0.5], time_from_start: 1}]
'''
        answer = self.robot('distance', swing, '--self', '--skipped')
        row = [row for row in answer.rows if row['kind'] == 'self'][0]
        self.assertEqual({row['a'], row['b']}, {'cart', 'hand'})
        # at the end the hand's middle is 1.2 from the swing's axis, 0.1 above the cart's top, and beyond its edge
        self.assertAnswer(row, math.hypot(1.2 * math.sin(0.5) - 0.1, 0.1 + 1.2 * math.cos(0.5)) - 0.1)
        self.assertIn("links 'arm' and 'cart'", answer.err.replace("'cart' and 'arm'", "'arm' and 'cart'"))
        off = '<robot name="slider"><disable_collisions link1="cart" link2="hand" reason="Never"/></robot>'
        row = [row for row in self.robot('distance', swing, '--self', srdf=off).rows if row['kind'] == 'self'][0]
        self.assertEqual((row['status'], row['lower'], row['b']), ('empty', '0', ''))

    def joints_that_do_not_move_have_their_values_in_the_order_of_precedence(self):
        bent = SLIDE + 'fixed_joints: {swing: 1.5707963267948966}\n'  # the hand's middle is 1.2 ahead
        self.assertAnswer(self.robot('distance', bent).row('go'), 0.0)
        self.assertAnswer(self.robot('distance', bent.replace('[2]', '[1]')).row('go'), 3 - 1 - 1.2 - 0.1, slack=1e-9)
        self.assertAnswer(self.robot('distance', bent, '--state', 'swing: 0').row('go'), 3 - 2 - 0.1)

    def allowed_pairs_are_left_out(self):
        scene = WALL + 'allowed_collision_matrix: {default_entry_names: [wall], default_entry_values: [true]}\n'
        answer = self.robot('distance', SLIDE, scene=scene)
        self.assertEqual(answer.row('go')['b'], 'post')

    def an_entry_of_the_matrix_wins_over_defaults_and_two_defaults_must_agree(self):
        names, values = 'default_entry_names', 'default_entry_values'
        no, said = '[false, false, false, NO]', '[NO, NO, NO, false]'
        entries = f'entry_names: [cart, arm, hand, wall], entry_values: [{no}, {no}, {no}, {said}], '
        for matrix, nearest in ((entries.replace('NO', 'false') + f'{names}: [wall], {values}: [true]', 'wall'),
                                (entries.replace('NO', 'true') + f'{names}: [wall], {values}: [false]', 'post'),
                                (f'{names}: [wall, cart, hand], {values}: [true, false, false]', 'wall'),
                                (f'{names}: [wall, cart, hand], {values}: [true, true, true]', 'post')):
            with self.subTest(matrix=matrix):
                answer = self.robot('distance', SLIDE, scene=WALL + 'allowed_collision_matrix: {' + matrix + '}\n')
                self.assertEqual(answer.row('go')['b'], nearest)

    def objects_that_a_link_carries_ride_along(self):
        # a ball of 0.1 half a metre ahead of the cart, given in the frame of the link, and of the scene
        held = ('robot_state:\n  attached_collision_objects: [{link_name: cart, touch_links: [TOUCH], object: {id: held, header: {frame_id: FRAME}, '
                'primitives: [{type: 2, dimensions: [0.1]}], primitive_poses: [{position: [0.5, 0, 0]}]}}]\n')
        for frame in ('cart', 'rail'):
            row = self.robot('distance', SLIDE, scene=WALL + held.replace('FRAME', frame).replace('TOUCH', '')).row('go')
            self.assertAnswer(row, 3 - 2 - 0.5 - 0.1)
            self.assertEqual((row['a'], row['b']), ('held', 'wall'))
        padded = WALL + held.replace('FRAME', 'cart').replace('TOUCH', '') + 'link_padding: [{link_name: cart, padding: 0.05}]\n'
        self.assertAnswer(self.robot('distance', SLIDE, scene=padded).row('go'), 0.35)

        # against the arm, from which a single joint parts it
        swing = SLIDE.replace('[slide]', '[swing]').replace('[2]', '[1]')
        for touch, expected in (('', {'held', 'arm'}), ('arm', {'held', 'hand'})):
            scene = WALL + held.replace('FRAME', 'cart').replace('TOUCH', touch)
            row = [row for row in self.robot('distance', swing, '--self', scene=scene).rows if row['kind'] == 'self'][0]
            self.assertEqual({row['a'], row['b']}, expected)

    def they_ride_a_base_that_moves_and_turns(self):
        """The base comes down by 5 m and turns by a right angle about z: a ball half a metre ahead of the cart is to its left then."""
        turn = '0, 0, %r, %r' % (math.sqrt(0.5), math.sqrt(0.5))
        names = ', '.join('free/' + part for part in ('trans_x', 'trans_y', 'trans_z', 'rot_x', 'rot_y', 'rot_z', 'rot_w'))
        landing = ('virtual_joint: {name: free, type: floating, parent_frame: world, child_link: rail}\n'
                   f'joint_trajectory: {{joint_names: [{names}], points: [\n'
                   '  {positions: [0, 0, 10, 0, 0, 0, 1], time_from_start: 0},\n'
                   f'  {{positions: [0, 0, 5, {turn}], time_from_start: 1}}]}}\n')
        scene = ('robot_state: {attached_collision_objects: [{link_name: cart, object: {id: held, header: {frame_id: cart}, '
                 'primitives: [{type: 2, dimensions: [0.1]}], primitive_poses: [{position: [0.5, 0, 0]}]}}]}\n'
                 'world: {collision_objects: [{id: mark, primitives: [{type: 2, dimensions: [0.25]}], '
                 'primitive_poses: [{position: [0, 2, 5]}]}]}\n')
        row = self.robot('distance', landing, scene=scene).row('go')
        self.assertAnswer(row, 2 - 0.5 - 0.1 - 0.25)
        self.assertEqual((row['a'], row['b'], float(row['t'])), ('held', 'mark', 1.0))

    def a_link_scale_enlarges_a_link_before_its_padding(self):
        scene = WALL + 'link_scale: [{link_name: cart, scale: 2}]\nlink_padding: [{link_name: cart, padding: 0.01}]\n'
        row = self.robot('distance', SLIDE, scene=scene).row('go')
        self.assertAnswer(row, 3 - 2 - 0.2 - 0.01)
        self.assertEqual(row['a'], 'cart')
        self.assertRefused(self.robot('distance', SLIDE, scene=scene.replace('scale: 2', 'scale: 0')), 'above 0')
        self.assertRefused(self.robot('distance', SLIDE, scene=scene.replace('cart', 'carr')), "'carr'")

    def what_is_wrong_is_one_line(self):
        for text, words in ((SLIDE.replace('[slide]', '[slyde]'), ("'slyde'",)),
                            (SLIDE.replace('[2]', '[2, 3]'), ('point 1', '2 positions')),
                            (SLIDE.replace('[2]', '[.nan]'), ('go.yaml',)),
                            (SLIDE.replace('secs: 4', 'secs: 0'), ('point 1', 'not after')),
                            (SLIDE.replace('[slide]', '[slide, slide]').replace('[0]', '[0, 0]').replace('[2]', '[2, 2]'), ("'slide'", 'twice')),
                            (SLIDE.replace('[slide]', "['']"), ("''",)),
                            (SLIDE.replace('[2], ', '[2], velocities: [1, 1], '), ('point 1', '2 velocities', '1 joints')),
                            (SLIDE.replace('[0], ', '[0], accelerations: [.inf], '), ('go.yaml',)),
                            (SLIDE.replace('[2]', '[]'), ('point 1', '0 positions')),
                            (SLIDE.replace('secs: 4', 'secs: -1'), ('point 1', 'not after')),
                            ('interpolation: quintic\n' + SLIDE, ('point 0', 'velocities')),
                            ('interpolation: spline\n' + SLIDE, ("'spline'",)),
                            ('joint_trajectory: {joint_names: [slide], points: [{positions: [1], time_from_start: 1}]}', ('one point',)),
                            ('joint_trajectory: {joint_names: [], points: []}', ('no joints',)),
                            ('[1, 2]', ('go.yaml',))):
            with self.subTest(text=text):
                self.assertRefused(self.robot('distance', text), *words)
        self.assertRefused(cprox('distance', '--trajectory', 't.yaml'), '--robot')
        self.assertRefused(cprox('distance', '--robot', 'r.urdf', '--self'), '--trajectory')
        self.assertRefused(self.robot('distance', SLIDE, '--curves', 'c.csv'), '--trajectory takes no --curves')

    def robots_that_are_none_are_one_line(self):
        no_shapes = re.sub('<collision>.*?</collision>', '', SLIDER)
        loop = SLIDER.replace('</robot>', '<joint name="back" type="fixed"><parent link="hand"/><child link="rail"/></joint></robot>')
        twice = SLIDER.replace('</robot>', '<joint name="back" type="fixed"><parent link="hand"/><child link="arm"/></joint></robot>')
        ring = SLIDER.replace('name="swing" type="revolute">', 'name="swing" type="revolute"><mimic joint="wrist"/>')
        ring = ring.replace('name="wrist" type="revolute">', 'name="wrist" type="revolute"><mimic joint="swing"/>')
        mesh = SLIDER.replace('<sphere radius="0.1"/>', '<mesh filename="hand.stl"/>')
        for urdf, words in ((no_shapes, ('no collision geometry',)), (loop, ('tree',)), (twice, ("'arm'", 'child of two joints')), (ring, ("'swing'", 'ring'))):
            with self.subTest(words=words):
                self.assertRefused(self.robot('distance', SLIDE, urdf=urdf), *words)
        for text, words in (('solid hand\nendsolid hand\n', ("'hand'", 'hand.stl')),
                            ('solid hand\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 nan 0\nendloop\nendfacet\nendsolid hand\n', ("'hand'",))):
            with self.subTest(words=words):
                self.file('hand.stl', text)
                self.assertRefused(self.robot('distance', SLIDE, urdf=mesh), *words)

    def what_is_doubtful_is_answered_with_a_warning_that_names_it(self):
        far = SLIDER.replace('lower="-9" upper="9"', 'lower="-1" upper="1.5"', 1)
        answer = self.robot('distance', SLIDE, urdf=far)
        self.assertEqual(answer.code, 0)
        self.assertAnswer(answer.row('go'), 3 - 2 - 0.1)
        self.assertIn("joint 'slide' goes to 2, above its upper limit 1.5", answer.err)
        # between its points a cubic goes farther than at any of them: by 4/27 v T on each side
        swing = SLIDE.replace('[0], ', '[0], velocities: [3], ').replace('[2], ', '[0], velocities: [3], ')
        answer = self.robot('distance', swing, urdf=far)
        self.assertIn("joint 'slide' goes to -1.1547, below its lower limit -1", answer.err)
        self.assertNotIn('above', answer.err)

        srdf = '<robot name="other"><disable_collisions link1="cart" link2="leg"/></robot>'
        answer = self.robot('distance', SLIDE, '--self', '--allow-empty', srdf=srdf)  # the slide moves no pair of its own
        self.assertEqual(answer.code, 0)
        self.assertIn("'leg'", answer.err)

    def meshes_are_never_nearer_than_their_hulls(self):
        with open(DATA + '/reference/expected_hull_model.json') as text:
            cases = json.load(text)['cases']
        for case in cases[1::8]:
            answer = cprox('distance', '--robot', f"{DATA}/{case['robot']}", '--scene', f"{DATA}/{case['scene']}", '--trajectory',
                           f"{DATA}/trajectories/{os.path.basename(case['trajectory'])}")
            expected = [result for result in case['results'] if result['kind'] == 'environment'][0]
            row = answer.rows[0]
            with self.subTest(trajectory=case['trajectory']):
                self.assertEqual(row['status'], 'ok', answer.err)
                self.assertGreaterEqual(float(row['upper']), expected['lower'] - 5e-9)

    def certificates_of_real_robots_are_proven(self):
        with open(DATA + '/reference/expected_hull_model.json') as text:
            cases = json.load(text)['cases']
        file = os.path.join(self.folder, 'proof.cpc')
        robots = set()
        for case in cases:
            if case['robot'] in robots or min(result['lower'] for result in case['results']) == 0.0:
                continue
            robots.add(case['robot'])
            query = ['--robot', f"{DATA}/{case['robot']}", '--scene', f"{DATA}/{case['scene']}",
                        '--trajectory', f"{DATA}/trajectories/{os.path.basename(case['trajectory'])}"]
            query += ['--srdf', f"{DATA}/{case['srdf']}"] if case.get('srdf') else []
            query += ['--self'] if len(case['results']) == 2 else []
            with self.subTest(trajectory=case['trajectory']):
                asked = cprox('distance', *query, '--certificate', file)
                self.assertEqual(asked.code, 0, asked.err)
                self.assertEqual({row['proof'] for row in asked.rows}, {'apart'})
                checked = cprox('check', file, *query)
                self.assertEqual(checked.code, 0, checked.out + checked.err)
                self.assertEqual(checked.out.count('proven: farther than'), len(case['results']), checked.out)
        self.assertEqual(len(robots), 3)

    def reference_answers_overlap(self):
        """Robots, scenes and splines of test/data, meshes by their hulls, against certified answers of another program, at 1e-6; what was sampled is never
        below our lower bound (5e-9: the digits of the file)."""
        with open(DATA + '/reference/expected_hull_model.json') as text:
            cases = json.load(text)['cases']
        self.assertEqual(len(cases), 23)
        for case in cases:
            words = ['distance', '--robot', f"{DATA}/{case['robot']}", '--scene', f"{DATA}/{case['scene']}", '--self', '--epsilon', '1e-6',
                     '--max-lod', 'hull',
                     '--trajectory', f"{DATA}/trajectories/{os.path.basename(case['trajectory'])}"]
            if case.get('srdf'):
                words += ['--srdf', f"{DATA}/{case['srdf']}"]
            answer = cprox(*words)
            for expected in case['results']:
                with self.subTest(trajectory=case['trajectory'], kind=expected['kind']):
                    row = [row for row in answer.rows if row['kind'] == expected['kind']][0]
                    self.assertEqual(row['status'], 'ok', answer.err)
                    lower, upper = float(row['lower']), float(row['upper'])
                    self.assertTrue(upper == math.inf or upper - lower <= 1e-6, upper)  # hulls bound from below
                    self.assertLessEqual(lower, expected['upper'] + 5e-9)
                    self.assertGreaterEqual(lower, expected['lower'] - 1e-6 - 5e-9)
                    self.assertLessEqual(lower, expected['sampled_min_step_0p001rad'] + 5e-9)
                    if expected['lower'] > 0:
                        self.assertEqual({row['a'], row['b']}, set(expected['pair']))
