# SPDX-License-Identifier: BSD-3-Clause
"""Signed distances of pairs whose values are known by hand."""
import math

from support import HEADER, Case

HALF = math.sqrt(0.5)


def pair(identifier, a, b):
    return f'- {{id: {identifier}, a: {a}, b: {b}}}\n'


def at(x, y=0, z=0, orientation=''):
    return f'pose: {{position: [{x}, {y}, {z}]{orientation and ", orientation: " + str(orientation)}}}'


UNIT_BALL = '{type: sphere, dimensions: [1]}'


class Pairs(Case):
    def distances_are_those_by_hand(self):
        cases = {
            'point_point': ('{type: point}', f'{{type: point, {at(3, 4)}}}', 5),
            'point_vertex': ('{type: point, vertices: [[0, 0, 1]]}', f'{{type: point, {at(0, 0, 3)}}}', 2),
            'sphere_sphere': (UNIT_BALL, f'{{type: sphere, dimensions: [0.5], {at(3)}}}', 1.5),
            'box_sphere': ('{type: box, dimensions: [2, 4, 6]}', f'{{type: sphere, dimensions: [0.5], {at(3, 4, 5)}}}', math.sqrt(12) - 0.5),
            'box_box': ('{type: box, dimensions: [2, 2, 2]}',
                        f'{{type: box, dimensions: [2, 2, 2], {at(4, 0, 0, [0, 0, math.sin(math.pi / 8), math.cos(math.pi / 8)])}}}', 3 - math.sqrt(2)),
            'capsule_point': ('{type: capsule, dimensions: [4, 1]}', f'{{type: point, {at(0, 0, 5)}}}', 2),
            'cylinder_point': ('{type: cylinder, dimensions: [4, 1]}', f'{{type: point, {at(4, 0, 6)}}}', 5),
            'cone_tip': ('{type: cone, dimensions: [2, 1]}', f'{{type: point, {at(0, 0, 3)}}}', 2),
            'cone_base': ('{type: cone, dimensions: [2, 1]}', f'{{type: point, {at(0, 0, -3)}}}', 2),
            'ellipsoid_point': ('{type: ellipsoid, dimensions: [1, 2, 3]}', f'{{type: point, {at(0, 0, 5)}}}', 2),
            'halfspace_ball': ('{type: halfspace, dimensions: [0, 0, 2, 4]}', UNIT_BALL, 1),
            'polytope_ball': ('{type: polytope, vertices: [[2, -1, -1], [2, 1, -1], [2, 0, 2], [3, 0, 0]]}', UNIT_BALL, 1),
            'segment_segment': ('{type: polytope, vertices: [[-1, 0, 0], [1, 0, 0]]}', '{type: polytope, vertices: [[0, -1, 2], [0, 0, 2], [0, 1, 2]]}', 2),
            'polygon_point': ('{type: polytope, vertices: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]}', f'{{type: point, {at(0.3, 0.4, -1.5)}}}', 1.5),
            'mesh_ball': ('{type: mesh, mesh: {vertices: [[2, -1, -1], [2, 1, -1], [2, 0, 2], [3, 0, 0]], '
                          'triangles: [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]}}', UNIT_BALL, 1),
        }
        answer = self.pairs(''.join(pair(name, a, b) for name, (a, b, _) in cases.items()), '--epsilon', '1e-9')
        self.assertEqual((answer.code, answer.err, answer.header), (0, '', HEADER))
        self.assertEqual([row['id'] for row in answer.rows], list(cases))
        for name, (_, _, distance) in cases.items():
            with self.subTest(name=name):
                row = answer.row(name)
                self.assertAnswer(row, distance, epsilon=1e-9)
                self.assertEqual((row['kind'], row['verdict'], row['t'], row['t_b'], row['a'], row['b']), ('pair', '', '', '', name, name))

                # the witnesses are as far apart as the upper bound says
                points = [[float(row[f'{letter}_{axis}']) for axis in 'xyz'] for letter in 'ab']
                self.assertAlmostEqual(math.dist(*points), float(row['upper']), delta=1e-9)

    def a_mesh_is_its_surface_unless_it_is_to_be_solid_or_a_hull(self):
        # a tetrahedron about the origin, its walls 1 away; the point stands inside
        corners, faces = '[[3, 0, 0], [0, 3, 0], [0, 0, 3], [-1, -1, -1]]', '[[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]'
        mesh = f'{{type: mesh, %smesh: {{vertices: {corners}, triangles: {faces}%s}}}}'
        row = self.pairs(pair('m', mesh % ('', ''), '{type: point}')).row('m')
        self.assertEqual(row['lod'], 'mesh')
        self.assertGreater(float(row['lower']), 0.3)
        row = self.pairs(pair('m', mesh % ('', ', solid: true'), '{type: point}')).row('m')
        self.assertLessEqual(float(row['upper']), 0)
        row = self.pairs(pair('m', mesh % ('', ''), '{type: point}'), '--max-lod', 'hull').row('m')
        self.assertEqual(row['lod'], 'hull')
        self.assertLess(float(row['lower']), -0.3)
        self.assertEqual(float(row['upper']), math.inf)  # a hull bounds from below

    def clouds_octrees_and_meshes_are_bodies_also_against_each_other(self):
        cloud = '{type: points, dimensions: [0.5], vertices: [[3, 0, 0], [0, 9, 0]]}'
        self.assertAnswer(self.pairs(pair('c', cloud, UNIT_BALL)).row('c'), 1.5)
        mesh = 'type: mesh, mesh: {vertices: [[2, 0, 0], [3, 1, 0], [3, 0, 1]], triangles: [[0, 1, 2]]}'
        self.assertAnswer(self.pairs(pair('mm', f'{{{mesh}}}', f'{{{mesh}, {at(-4)}}}')).row('mm'), 9.5 ** 0.5)  # a corner and the far edge
        self.assertFailedRow(self.pairs(pair('o', '{type: octree, resource: none.bt}', UNIT_BALL)), 'o', 'octree', 'none.bt')

    def witness_a_lies_on_a_and_b_on_b(self):
        row = self.pairs(pair('p', f'{{type: sphere, dimensions: [1], {at(-2)}}}', f'{{type: sphere, dimensions: [0.5], {at(3)}}}')).row('p')
        self.assertPoint(row, 'a', (-1, 0, 0))
        self.assertPoint(row, 'b', (2.5, 0, 0))

    def overlap_has_a_lower_bound_that_is_not_above_the_depth(self):
        row = self.pairs(pair('p', UNIT_BALL, f'{{type: sphere, dimensions: [1], {at(0.5)}}}')).row('p')
        self.assertIn(row['status'], ('overlap', 'ok'))
        self.assertLessEqual(float(row['lower']), -1.5 + 1e-9)
        self.assertLessEqual(float(row['upper']), 0.0)

    def a_list_of_yaml_blocks_is_a_list_too(self):
        text = ('- id: p\n  a:\n    type: box\n    dimensions: [2, 2, 2]\n  b:\n    type: sphere\n    dimensions: [1]\n'
                '    pose:\n      position: {x: 5, y: 0, z: 0}\n      orientation: {x: 0, y: 0, z: 0, w: 1}\n')
        self.assertAnswer(self.pairs(text).row('p'), 3)

    def an_empty_list_has_a_header_as_its_answer(self):
        answer = self.pairs('[]')
        self.assertEqual((answer.code, answer.out), (2, HEADER + '\n'))

    def quaternions_are_checked(self):
        answer = self.pairs(pair('zero', UNIT_BALL, f'{{type: point, {at(3, 0, 0, [0, 0, 0, 0])}}}')
                            + pair('long', UNIT_BALL, f'{{type: point, vertices: [[3, 0, 0]], {at(0, 0, 0, [0, 0, 3, 3])}}}'))
        self.assertFailedRow(answer, 'zero', 'norm is 0')
        self.assertAnswer(answer.row('long'), 2)
        self.assertPoint(answer.row('long'), 'b', (0, 3, 0))
        self.assertRegex(answer.err, 'warning: .*norm')

    def implicit_bodies_are_measured(self):
        ball = '{type: implicit, quadrics: [[1, 0, 0, 1, 0, 1, 0, 0, 0, -1]]'
        cube = '{type: implicit, planes: [[1, 0, 0, -1], [-1, 0, 0, -1], [0, 1, 0, -1], [0, -1, 0, -1], [0, 0, 1, -1], [0, 0, -1, -1]]'
        can = '{type: implicit, terms: [[[1, 0, 0, 0, 2], [0, 1, 0, 0, 2], [0, 0, 1, 0, 16]]], planes: [[0, 0, 1, -0.5]]'
        answer = self.pairs(pair('round', '{type: superquadric, dimensions: [1, 2, 3, 2, 2, 2]}', f'{{type: point, {at(0, 0, 5)}}}')
                            + pair('squares', cube + '}', f'{cube}, {at(4)}}}')
                            + pair('mixed', ball + '}', f'{{type: box, dimensions: [2, 2, 2], {at(3)}}}')
                            + pair('cut', can + '}', f'{ball}, {at(0, 0, 4)}}}'))
        for name, distance in (('round', 2), ('squares', 2), ('mixed', 1), ('cut', 2.5)):
            self.assertAnswer(answer.row(name), distance)

    def a_bad_pair_fails_alone(self):
        good = f'{{type: point, {at(3)}}}'
        bad = {
            '{type: superquadric, dimensions: [1, 1, 1, 4, 4]}': ['superellipsoid', '6 dimensions'],
            '{type: superquadric, dimensions: [1, 1, 1, 4, 0.5, 4]}': ['exponents.y is 0.5'],
            '{type: implicit, planes: [[1, 0, 0, -1]]}': ['unbounded'],
            '{type: implicit, planes: [[1, 0, 0]]}': ['[b1, b2, b3, c]'],
            '{type: implicit, terms: [[[1, 0, 0, 0]]]}': ['[a, b, c, d, n]'],
            '{type: implicit, quadrics: [[1, 0, 0, 1, 0, -1, 0, 0, 0, -1]]}': ['not convex'],
            '{type: implicit}': ['no terms'],
            '{type: ball, dimensions: [1]}': ["'ball' is unknown"],
            '{dimensions: [1]}': ["'type'"],
            '{type: sphere}': ['sphere'],
            '{type: sphere, dimensions: [1, 2]}': ['sphere'],
            '{type: sphere, dimensions: [-1]}': ['sphere'],
            '{type: sphere, dimensions: [.nan]}': ['.nan'],
            '{type: box, dimensions: [1, 0, 1]}': ['box'],
            '{type: halfspace, dimensions: [0, 0, 0, 1]}': ['normal'],
            '{type: polytope, vertices: []}': ['vert'],
            '{type: polytope, vertices: [[1, 2]]}': ['[x, y, z]'],
            '{type: polytope, vertices: [[1, 2, .inf]]}': ['.inf'],
            '{type: point, vertices: [[1, 2, 3], [4, 5, 6]]}': ['point'],
            '{type: mesh, mesh: none.stl}': ['none.stl'],
            '{type: sphere, dimensions: [1], pose: {position: [1, 2, x]}}': ["'x'"],
            'sphere': ['map'],
            '[]': ['map'],
        }
        text = ''.join(pair(f'bad{i}', body, good) + pair(f'good{i}', UNIT_BALL, good) for i, body in enumerate(bad))
        answer = self.pairs(text)
        for i, (body, words) in enumerate(bad.items()):
            with self.subTest(body=body):
                self.assertFailedRow(answer, f'bad{i}', f'row {2 * i + 1} ', *words)
                self.assertAnswer(answer.row(f'good{i}'), 2)
        self.assertIn(f'{len(bad)} of {2 * len(bad)} rows failed', answer.err)

    def convex_bodies_grow_and_translate(self):
        box = '{type: box, dimensions: [1, 1, 1]'
        placed = box + ', pose: {position: [4, 3, 0]}}'
        text = ''.join(entry[:-2] + more + '}\n' for entry, more in (
            (pair('grow', box + '}', placed), ', ask: growth'),
            (pair('pass', box + '}', placed), ', ask: translating_distance, velocity_a: [1, 0, 0], velocity_b: [-1, 0, 0], duration: 5'),
            (pair('touch', box + '}', placed), ', ask: translating_contact, velocity_b: [-4, -3, 0], duration: 2'),
            (pair('apart', box + '}', placed), ', ask: translating_contact, velocity_b: [4, 3, 0], duration: 2')))
        answer = self.pairs(text)
        self.assertEqual((answer.code, answer.err), (1, ''))  # they touch: a verdict is violated
        grow, passing, touch, apart = (answer.row(name) for name in ('grow', 'pass', 'touch', 'apart'))
        self.assertEqual([row['kind'] for row in answer.rows],
                         ['growth', 'translating_distance', 'translating_contact', 'translating_contact'])
        self.assertLessEqual(float(grow['lower']), 4)
        self.assertLess(abs(float(grow['upper']) - 4), 1e-5)
        self.assertEqual(passing['verdict'], 'clear')
        self.assertLess(abs(float(passing['upper']) - 2), 1e-6)
        # the boxes' x ranges meet last: 4 - 4 t = 1
        self.assertLessEqual(float(touch['t_contact_lower']), .75)
        self.assertLess(abs(float(touch['t']) - .75), 1e-6)
        self.assertEqual((touch['verdict'], apart['verdict']), ('violated', 'clear'))
        self.assertEqual((grow['t_contact_lower'], passing['t_contact_lower'], apart['t_contact_lower']), ('', '', '2'))

    def what_is_asked_wrongly_is_told(self):
        for more, words in ((', ask: growth, duration: 5', 'duration'), (', ask: meet', "'meet'"), (', ask: translating_contact', "'duration'"),
                            (', ask: translating_distance, duration: -1', 'duration is -1'), (', velocity_a: [1, 0, 0]', 'velocity_a')):
            with self.subTest(more=more):
                self.assertFailedRow(self.pairs(pair('p', UNIT_BALL, UNIT_BALL)[:-2] + more + '}\n'), 'p', words)

    def two_halfspaces_have_no_distance(self):
        self.assertFailedRow(self.pairs(pair('h', '{type: halfspace, dimensions: [0, 0, 1, 0]}', '{type: halfspace, dimensions: [0, 0, -1, 1]}')), 'h', 'halfspace')

    def entries_that_are_no_pairs_fail_alone(self):
        answer = self.pairs('- 5\n- {id: half, a: ' + UNIT_BALL + '}\n- {a: ' + UNIT_BALL + ', b: ' + UNIT_BALL + '}\n' + pair('p', UNIT_BALL, f'{{type: point, {at(3)}}}'))
        self.assertEqual([row['status'] for row in answer.rows], ['invalid', 'invalid', 'invalid', 'ok'])
        self.assertFailedRow(answer, 'half', "'b'")
        self.assertIn("'id'", answer.err)

    def a_file_that_is_no_list_is_refused(self):
        for text in ('a: 1', '5', '[1', ''):
            answer = self.pairs(text)
            self.assertRefused(answer, 'pairs.yaml')

    def unknown_keys_are_told_once_each(self):
        answer = self.pairs(pair('p', '{type: sphere, dimensions: [1], colour: red}', f'{{type: point, colour: red, {at(3)}}}') * 3)
        self.assertEqual((answer.code, {row['status'] for row in answer.rows}), (3, {'partial'}))
        self.assertLessEqual(answer.err.count('colour'), 2, answer.err)

    def deformed_bodies_are_those_made_anew(self):
        """x -> A x + b of a superquadric, and other exponents; Table III's scales of Objects I and III."""
        diamond = '{type: superquadric, dimensions: [1, 0.7, 1.5, 1.3333333333333333, 1.4, 1.1538461538461537]'
        cuboid = '{type: superquadric, dimensions: [1, 1, 1.5, 8.444444444444445, 14.2, 13.76923076923077]'
        rows = self.pairs(
            pair('deformed', diamond + ', deform: {linear: [1, 0, 0, 0, 0.5, 0, 0, 0, 2]}}',
                 cuboid + ', deform: {linear: [0.5, 0, 0, 0, 3, 0, 0, 0, 0.67], translation: [0, 0, 1]}, ' + at(5, 1, 0) + '}')
            + pair('anew', '{type: superquadric, dimensions: [1, 0.35, 3, 1.3333333333333333, 1.4, 1.1538461538461537]}',
                   '{type: superquadric, dimensions: [0.5, 3, 1.005, 8.444444444444445, 14.2, 13.76923076923077], ' + at(5, 1, 1) + '}')
            + pair('exponents', diamond + ', deform: {exponents: [2, 2, 2]}}', '{type: point, ' + at(4) + '}')
            + pair('ball', '{type: ellipsoid, dimensions: [1, 0.7, 1.5]}', '{type: point, ' + at(4) + '}'), '--epsilon', '1e-9')
        self.assertEqual(rows.err, '')
        for one, other in (('deformed', 'anew'), ('exponents', 'ball')):
            self.assertAlmostEqual(float(rows.row(one)['upper']), float(rows.row(other)['upper']), delta=1e-8)
        wrong = self.pairs(pair('x', '{type: box, dimensions: [1, 1, 1], deform: {linear: [1, 0, 0, 0, 1, 0, 0, 0, 2]}}', UNIT_BALL))
        self.assertFailedRow(wrong, 'x', 'box cannot be deformed')
        wrong = self.pairs(pair('x', cuboid + ', deform: {linear: [1, 2]}}', UNIT_BALL))
        self.assertFailedRow(wrong, 'x', 'nine numbers')
        wrong = self.pairs(pair('x', cuboid + ', deform: {linear: [0, 0, 0, 0, 0, 0, 0, 0, 0]}}', UNIT_BALL))
        self.assertFailedRow(wrong, 'x', 'deformed:')
