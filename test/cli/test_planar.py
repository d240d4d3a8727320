# SPDX-License-Identifier: BSD-3-Clause
"""Planar queries: curves with z = 0 against polygons in the plane, as scenes and as pairs have them."""
import os
import re

from support import DATA, Case, bezier, cprox

SQUARE = '[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]'


def thing(body, pose='{}', name='thing'):
    return f'    - {{id: {name}, bodies: [{body}], body_poses: [{pose}]}}\n'


def scene(*things):
    return 'world:\n  collision_objects:\n' + ''.join(things)


def square(pose='{}', name='thing'):
    return thing(f'{{type: polygon, vertices: {SQUARE}}}', pose, name)


def reference(name):
    with open(f'{DATA}/reference/{name}') as text:
        return [line.strip().split(',') for line in text if line.strip() and not line.startswith('#')]


class Planar(Case):
    def a_polygon_has_an_inside_to_curves_in_its_plane(self):
        inside = bezier('inside', (-0.5, 0, 0), (0.5, 0.1, 0))
        beside = bezier('beside', (2, -3, 0), (2, 3, 0))
        above = bezier('above', (-0.5, 0, 0.25), (0.5, 0, 0.25))
        answer = self.ask('distance', [inside, beside, above], scene(square()))
        self.assertEqual(answer.err, '')
        self.assertAnswer(answer.row('inside'), 0)
        self.assertAnswer(answer.row('beside'), 1)
        self.assertAnswer(answer.row('above'), 0.25)
        self.assertEqual(self.ask('collision', [inside], scene(square())).row('inside')['verdict'], 'violated')
        self.assertEqual(self.ask('collision', [beside], scene(square())).row('beside')['verdict'], 'clear')
        row = self.ask('distance', [inside], scene(square()), '--signed').row('inside')
        self.assertAnswer(row, -21 / 22)  # deepest where it is as far from the upper as from the left edge

    def its_pose_turns_and_tilts_it(self):
        turned = '{position: [5, 0, 0], orientation: [0, 0, 1, 0]}'
        self.assertAnswer(self.ask('distance', [bezier('c', (0, -2, 0), (0, 2, 0))], scene(square(turned))).row('c'), 4, slack=1e-9)
        tilted = '{position: [5, 0, 0], orientation: [0, 1, 0, 1]}'
        row = self.ask('distance', [bezier('c', (0, -2, 0), (0, 2, 0))], scene(square(tilted))).row('c')
        self.assertAnswer(row, 5, epsilon=1e-6 + 2e-9, slack=2e-9)

    def what_is_no_polygon_is_refused_by_name(self):
        for vertices, words in (('[[0, 0, 0], [1, 0, 0]]', ['3 vertices']), ('[[0, 0, 0], [1, 0, 0.5], [0, 1, 0]]', ['vertex 1', 'z = 0.5']),
                                ('[[0, 0, 0], [4, 0, 0], [1, 1, 0], [0, 4, 0]]', ['not convex']), ('[]', ['no vertices'])):
            with self.subTest(vertices=vertices):
                self.assertRefused(self.ask('distance', [bezier('c', (0, 0, 0), (1, 0, 0))],
                                            scene(thing(f'{{type: polygon, vertices: {vertices}}}'))), "'thing'", *words)
        self.assertRefused(self.ask('distance', [bezier('c', (0, 0, 0), (1, 0, 0))],
                                    scene(thing(f'{{type: polygon, dimensions: [1], vertices: {SQUARE}}}'))), 'polygon', 'dimensions')

    def polygons_stand_in_pairs(self):
        polygon = f'{{type: polygon, vertices: {SQUARE}}}'
        answer = self.pairs(f'- {{id: ball, a: {polygon}, b: {{type: sphere, dimensions: [0.5], pose: {{position: [0, 0, 2]}}}}}}\n'
                            f'- {{id: two, a: {polygon}, b: {{type: polygon, vertices: {SQUARE}, pose: {{position: [4, 0, 0]}}}}}}\n')
        self.assertEqual(answer.err, '')
        self.assertAnswer(answer.row('ball'), 1.5)
        self.assertAnswer(answer.row('two'), 2)

    def answers_of_polygons_leave_proofs(self):
        curves = self.file('curves.csv', bezier('beside', (2, -3, 0), (2, 3, 0)) + '\n')
        world, proof = self.file('scene.yaml', scene(square())), os.path.join(self.folder, 'proof')
        for query_type, said in (('distance', 'proven: farther than'), ('collision', 'proven: farther than 0 m')):
            self.assertEqual(cprox(query_type, '--curves', curves, '--scene', world, '--certificate', proof).code, 0)
            checked = cprox('check', proof, '--curves', curves, '--scene', world)
            self.assertEqual(checked.code, 0, checked.err)
            self.assertIn(said, checked.out)

    def the_first_papers_replanning_curves_are_all_decided(self):
        """1000 quintic curves past two polygons of 20 sides: every verdict and every distance as the reference has it."""
        vertices = {}
        for number, x, y in reference('replan_obstacles.csv'):
            vertices.setdefault(number, []).append(f'[{x}, {y}, 0]')
        world = scene(*(thing(f'{{type: polygon, vertices: [{", ".join(v)}]}}', '{}', f'obstacle{k}') for k, v in vertices.items()))
        rows, curves = reference('replan_curves.csv'), []
        for identifier, points, *_ in rows:
            flat = re.split(';', points)
            curves.append(bezier(f'c{identifier}', *((float(x), float(y), 0.0) for x, y in zip(flat[::2], flat[1::2]))))
        far = self.ask('tolerance', curves, world, '--delta', '0.03')
        hit = self.ask('collision', curves, world)
        exact = self.ask('distance', curves, world)
        self.assertEqual((far.err, hit.err, exact.err), ('', '', ''))
        undecided = sum(row['verdict'] == 'undecided' for row in far.rows + hit.rows)
        self.assertEqual((len(rows), len(hit.rows), undecided), (1000, 1000, 0))
        spent = sum(row['status'] != 'ok' for row in far.rows + hit.rows + exact.rows)
        self.assertEqual(spent, 0)
        for (_, _, one, two, kind), t, c, d in zip(rows, far.rows, hit.rows, exact.rows):
            self.assertEqual((t['verdict'], c['verdict']), ('clear' if kind == '1' else 'violated', 'violated' if kind == '3' else 'clear'), t)
            least = min(float(one), float(two))
            self.assertLessEqual(float(d['lower']), least + 1e-10, d)
            self.assertGreaterEqual(float(d['upper']), least - 1e-10, d)
            self.assertLessEqual(float(d['upper']) - float(d['lower']), 1e-6, d)
