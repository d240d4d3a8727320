# SPDX-License-Identifier: BSD-3-Clause
"""--certificate and check: what is written is proven by the program cprox_check, for these inputs and for no others."""
import json
import math
import os
import random
import struct

from support import BOX_SCENE, PASSING, Case, bezier, cprox

SCENE = '''
world:
  collision_objects:
    - id: box
      primitives: [{type: box, dimensions: [2, 2, 2]}, {type: sphere, dimensions: [0.5]}]
      primitive_poses: [{position: [0, 0, 0], orientation: [0, 0, 0.3, 1]}, {position: [0, 0, 3]}]
    - id: floor
      planes: [{coef: [0, 0, 1, 4]}]
      plane_poses: [{position: [0, 0, 0]}]
'''
ROWS = [PASSING, bezier('through', (-3, 0, 0), (3, 0.1, 0)), bezier('tube', (3, 2, 1), (2, 4, 2), (3, 5, 0), radius=0.1),
        'circle,trigonometric,1,0,3,0,3,0,0,6,1,0,0,0,1,0',
        'spline,bspline,2,0,2,0,4,3,-2,0,3,0,1,4,1,0,3,3,0,0,0,0,1,2,2,2']


def ring(around=16, across=8, radius=0.3, tube=0.1):
    """The mesh of a torus about z, as YAML."""
    vertices, triangles = [], []
    for i in range(around):
        for j in range(across):
            u, v = 2 * math.pi * i / around, 2 * math.pi * j / across
            w = radius + tube * math.cos(v)
            vertices.append([w * math.cos(u), w * math.sin(u), tube * math.sin(v)])
            a, b = i * across + j, (i + 1) % around * across + j
            c, d = (i + 1) % around * across + (j + 1) % across, i * across + (j + 1) % across
            triangles += [[a, b, c], [a, c, d]]
    return f'{{type: mesh, vertices: {vertices}, triangles: {triangles}'


RING_SCENE = """
world:
  collision_objects:
    - {id: ring, bodies: [%s%s}]}
    - {id: post, primitives: [{type: sphere, dimensions: [0.1]}], primitive_poses: [{position: [0.9, 0, 0]}]}
"""


def without_proof(answer):
    return [{k: v for k, v in row.items() if k not in ('microseconds', 'proof')} for row in answer.rows]


class CertificateTest(Case):

    def write(self, query_type, rows, scene, *more):
        """Asks with --certificate; the words of `check` for the same query."""
        self.certificates = os.path.join(self.folder, 'answers.cpc')
        answer = self.ask(query_type, rows, scene, '--certificate', self.certificates, *more)
        self.assertEqual(answer.code, answer.code_of_verdicts(), answer.err)
        return answer

    def check(self, *more, scene='scene.yaml', curves='curves.csv'):
        return cprox('check', self.certificates, '--curves', os.path.join(self.folder, curves),
                     '--scene', os.path.join(self.folder, scene), *more)

    def every_answer_of_a_distance_is_proven(self):
        answer = self.write('distance', ROWS, SCENE)
        checked = self.check()
        self.assertEqual(checked.code, 0, checked.out + checked.err)
        lines = checked.out.splitlines()
        self.assertEqual(len(lines), len(ROWS), checked.out)
        for line, row in zip(lines, answer.rows):
            self.assertTrue(line.startswith(row['id'] + ': proven: '), line)
            if float(row['lower']) > 0:
                claimed = float(line.split('farther than ')[1].split(' m')[0])
                self.assertAlmostEqual(claimed, float(row['lower']), delta=1.001e-6)  # epsilon

    def verdicts_are_proven_either_way(self):
        self.write('tolerance', ROWS, SCENE, '--delta', '0.5')
        checked = self.check()
        self.assertEqual(checked.code, 0, checked.out + checked.err)
        self.assertIn('passing: proven: farther than 0.5 m everywhere', checked.out)
        self.assertIn('through: proven: not farther than 0.5', checked.out)
        self.write('collision', ROWS, SCENE)
        checked = self.check()
        self.assertEqual(checked.code, 0, checked.out + checked.err)
        self.assertIn('through: proven: not farther than 0 m', checked.out)

    def times_of_contact_are_proven_from_both_sides(self):
        rows = [PASSING, bezier('through', (-3, 0, 0), (3, 0.1, 0)), bezier('tube', (-3, 0, 3), (3, 0, 3), radius=0.1)]
        answer = self.write('time-of-contact', rows, SCENE)
        self.assertEqual([row['proof'] for row in answer.rows], ['apart', 'before', 'before'], answer.err)
        self.assertEqual(without_proof(answer), without_proof(self.ask('time-of-contact', rows, SCENE)))
        checked = self.check()
        self.assertEqual(checked.code, 0, checked.out + checked.err)
        self.assertIn('passing: proven: farther than 0 m everywhere', checked.out)
        for name in ('through', 'tube'):
            line = next(line for line in checked.out.splitlines() if line.startswith(name + ': proven: farther than 0 m before '))
            before, by = float(line.split(' before ')[1].split(',')[0]), float(line.split(' by ')[1].split()[0])
            row = answer.row(name)
            self.assertAlmostEqual(before, float(row['t_contact_lower']), delta=1e-9)
            self.assertAlmostEqual(by, float(row['t']), delta=1e-9)
            self.assertLessEqual(before, by)
        self.assertEqual([json.loads(line)['proof'] for line in self.check('--json').out.splitlines()], ['apart', 'before', 'before'])
        self.file('nearer.yaml', SCENE.replace('[2, 2, 2]', '[2.001, 2, 2]').replace('[0.5]', '[0.501]'))
        checked = self.check(scene='nearer.yaml')
        self.assertEqual((checked.code, checked.out.count('refused')), (1, 2), checked.out)

    def each_interval_of_a_profile_is_proven(self):
        """`through` is inside the box in the middle: near there, apart elsewhere."""
        rows = [PASSING, bezier('through', (-3, 0, 0), (3, 0.1, 0))]
        self.certificates = os.path.join(self.folder, 'answers.cpc')
        plain = self.ask('profile', rows, SCENE, '--intervals', '6')
        answer = self.ask('profile', rows, SCENE, '--intervals', '6', '--certificate', self.certificates)
        self.assertEqual((answer.code, answer.rows, answer.err), (0, plain.rows, plain.err))
        checked = self.check()
        self.assertEqual(checked.code, 0, checked.out)
        for line, name in zip(checked.out.splitlines(), ('passing', 'through')):
            self.assertTrue(line.startswith(name + ': proven: '), line)
            claims = line.partition(': proven: ')[2].rpartition(' (')[0].split('; ')
            mine = [row for row in answer.rows if row['id'] == name]
            self.assertEqual(len(claims), len(mine))
            for claim, row in zip(claims, mine):
                self.assertEqual(claim.startswith('farther than '), float(row['lower']) > 0, claim)
                if float(row['lower']) > 0:
                    delta, part = claim.split('farther than ')[1].split(' m from ')
                    self.assertAlmostEqual(float(delta), float(row['lower']), delta=1.001e-6)  # epsilon
                    self.assertEqual([float(t) for t in part.split(' to ')], [float(row['t0']), float(row['t1'])])
        self.assertEqual([json.loads(line)['proof'] for line in self.check('--json').out.splitlines()], ['parts', 'parts'])
        self.file('nearer.yaml', SCENE.replace('[2, 2, 2]', '[2.001, 2, 2]'))
        checked = self.check(scene='nearer.yaml')
        self.assertEqual(checked.code, 1, checked.out)
        self.assertIn('through: refused: part ', checked.out)

    def what_lies_between_violations_and_each_of_them_is_proven(self):
        rows = [PASSING, bezier('through', (-3, 0, 0), (3, 0.1, 0))]
        answer = self.write('violations', rows, SCENE, '--delta', '0.3', '--resolution', '1e-6')
        plain = self.ask('violations', rows, SCENE, '--delta', '0.3', '--resolution', '1e-6')
        self.assertEqual((answer.rows, answer.err), (plain.rows, plain.err))
        checked = self.check()
        self.assertEqual(checked.code, 0, checked.out)
        clear, through = checked.out.splitlines()
        self.assertTrue(clear.startswith(f'passing: proven: farther than {0.3:.17g} m from 0 to 1 '), clear)
        claims = through.partition(': proven: ')[2].split('; ')
        self.assertEqual([claim.startswith('not ') for claim in claims], [False, True, False], through)
        row = answer.row('through')
        until = float(claims[0].split(' to ')[1])
        after = float(claims[2].split(' m from ')[1].split(' to ')[0])
        self.assertLessEqual(until, float(row['enter_lower']))
        self.assertGreaterEqual(after, float(row['leave_upper']))
        self.assertLess(max(float(row['enter_lower']) - until, after - float(row['leave_upper'])), 1e-3)
        self.file('nearer.yaml', SCENE.replace('[2, 2, 2]', '[2.01, 2, 2]'))
        self.assertIn('through: refused: part 1 of 3', self.check(scene='nearer.yaml').out)

    def a_certificate_of_another_query_is_refused(self):
        self.write('distance', [PASSING], BOX_SCENE)
        self.file('larger.yaml', BOX_SCENE.replace('[2, 2, 2]', '[2.001, 2, 2]'))
        checked = self.check(scene='larger.yaml')
        self.assertEqual(checked.code, 1)
        self.assertIn('passing: refused: a direction does not separate its part', checked.out)
        self.file('two.yaml', SCENE)
        self.assertIn('another number of targets', self.check(scene='two.yaml').out)

    def a_tampered_certificate_is_refused(self):
        self.write('distance', [PASSING], BOX_SCENE)
        with open(self.certificates, 'rb') as file:
            data = file.read()
        raised = data[:12] + struct.pack('<d', 2.5) + data[20:]
        for name, bad in (('raised', raised), ('cut', data[:-1]), ('longer', data + b'\0'), ('empty', b'')):
            with open(self.certificates, 'wb') as file:
                file.write(bad)
            checked = self.check()
            self.assertEqual(checked.code, 1, name + checked.out)
            self.assertIn('refused', checked.out, name)

    def as_json_a_row_says_the_same(self):
        bad = 'bad,bezier,1,0,1,0,2,0,0'
        self.certificates = os.path.join(self.folder, 'answers.cpc')
        self.ask('tolerance', [*ROWS[:2], bad], SCENE, '--delta', '0.5', '--certificate', self.certificates)
        lines, checked = self.check().out.splitlines(), self.check('--json')
        self.assertEqual(checked.code, 1)
        rows = [json.loads(line) for line in checked.out.splitlines()]
        self.assertEqual([(row['id'], row['proof']) for row in rows], [('passing', 'apart'), ('through', 'near'), ('bad', 'none')])
        self.assertEqual(rows[0]['delta'], 0.5)
        self.assertIsNone(rows[2]['delta'])
        for line, row in zip(lines, rows):
            self.assertTrue(line.endswith(row['message']), line)
        with open(self.certificates, 'ab') as file:
            file.write(b'\0')
        self.assertEqual(json.loads(self.check('--json').out.splitlines()[-1])['proof'], 'refused')

    def rows_without_an_answer_claim_nothing(self):
        self.certificates = os.path.join(self.folder, 'answers.cpc')
        answer = self.ask('distance', [PASSING, 'bad,bezier,1,0,1,0,2,0,0'], BOX_SCENE, '--certificate', self.certificates)
        self.assertEqual(answer.code, 2)
        checked = self.check()
        self.assertEqual(checked.code, 1)
        self.assertIn('passing: proven', checked.out)
        self.assertIn('bad: nothing is claimed', checked.out)

    def curves_against_curves_are_proven(self):
        self.certificates = os.path.join(self.folder, 'pairs.cpc')
        first = self.file('a.csv', PASSING + '\n' + bezier('b', (0, 0, 0), (1, 1, 1), (2, 0, 0)) + '\n')
        second = self.file('b.csv', bezier('c', (0, -4, 1), (1, 4, 0)) + '\n' + bezier('d', (0, 1, 1), (1, -1, 0)) + '\n')
        query = ['--curves', first, '--against', second]
        asked = cprox('distance', *query, '--certificate', self.certificates)
        self.assertEqual(asked.code, 0, asked.err)
        checked = cprox('check', self.certificates, *query)
        self.assertEqual(checked.code, 0, checked.out + checked.err)
        self.assertEqual(checked.out.count('proven'), 2)

    def what_moves_on_one_clock_and_grows_is_proven(self):
        self.certificates = os.path.join(self.folder, 'pairs.cpc')
        grows = 'g,bezier,1,0,1,0.1 0.2 -0.1,2,0,0,2,4,0,2'
        first = self.file('curves.csv', PASSING + '\n' + grows + '\n')
        second = self.file('b.csv', bezier('c', (0, -4, 1), (1, 4, 0)) + '\n' + grows.replace('4,0,2', '4,0,-2') + '\n')
        query = ['--curves', first, '--against', second, '--synchronized']
        asked = cprox('distance', *query, '--certificate', self.certificates)
        self.assertEqual([row['proof'] for row in asked.rows], ['apart', 'near'], asked.err)
        checked = cprox('check', self.certificates, *query)
        self.assertEqual((checked.code, checked.out.count('proven')), (0, 2), checked.out + checked.err)
        apart = cprox('check', self.certificates, *query[:-1])
        self.assertEqual(apart.code, 1, apart.out)
        answer = self.write('tolerance', [grows], BOX_SCENE, '--delta', '0.1')
        self.assertEqual(answer.rows[0]['proof'], 'apart', answer.err)
        self.assertEqual(self.check().code, 0)

    def a_proof_changes_no_answer(self):
        """40 curves (seed 11) about and through a ring, as a surface and as a solid, every query and model."""
        chance = random.Random(11)
        rows = [bezier(f'c{i}', *[[chance.uniform(-0.5, 0.5) for _ in range(3)] for _ in range(4)], radius=0.01) for i in range(40)]
        self.certificates = os.path.join(self.folder, 'answers.cpc')
        for solid in ('', ', solid: true'):
            scene = RING_SCENE % (ring(), solid)
            for query_type, more in (('distance', []), ('tolerance', ['--delta', '0.05']), ('collision', []),
                               ('distance', ['--max-lod', 'hull']), ('distance', ['--max-lod', 'sphere'])):
                plain = self.ask(query_type, rows, scene, *more)
                proven = self.ask(query_type, rows, scene, '--certificate', self.certificates, *more)
                self.assertEqual((plain.code, proven.code), (plain.code_of_verdicts(),) * 2, proven.err)
                self.assertEqual(without_proof(plain), without_proof(proven))
                for line, row in zip(self.check().out.splitlines(), proven.rows):
                    said = {'apart': ': proven: farther than', 'near': ': proven: not farther than', 'none': ': nothing is claimed'}
                    self.assertIn(said[row['proof']], line)

    def a_line_through_the_hole_of_a_ring_is_not_near(self):
        hole, far = bezier('hole', (0, 0, -1), (0, 0, 1), radius=0.02), bezier('far', (0, 0, 0.5), (0.1, 0, 0.9))
        for solid in ('', ', solid: true'):
            for query_type, more in (('distance', []), ('collision', []), ('tolerance', ['--delta', '0.1'])):
                answer = self.write(query_type, [hole, far], RING_SCENE % (ring(), solid), *more)
                self.assertGreater(float(answer.row('hole')['lower']), 0.17 if query_type == 'distance' else 0.0)
                self.assertEqual([row['proof'] for row in answer.rows], ['apart', 'apart'], answer.err)
                checked = self.check()
                self.assertEqual(checked.code, 0)
                self.assertIn('hole: proven: farther than', checked.out)
                self.assertIn('far: proven: farther than', checked.out)

    def points_are_near_and_apart(self):
        scene = BOX_SCENE + '    - {id: cloud, bodies: [{type: points, dimensions: [0.1], vertices: [[3, 0, 1.2], [9, 9, 9]]}]}\n'
        rows = [PASSING, bezier('other', (3, -4, 1), (3, 4, 1))]
        answer = self.write('tolerance', rows, scene, '--delta', '0.15')
        self.assertEqual([row['proof'] for row in answer.rows][1], 'near', answer.err)
        self.assertIn('other: proven: not farther than', self.check().out)

    def superquadrics_are_near_and_apart(self):
        scene = BOX_SCENE + '    - {id: odd, bodies: [{type: superquadric, dimensions: [1, 1, 1, 3, 3, 1.5], pose: {position: [8, 0, 1]}}]}\n'
        answer = self.write('distance', [PASSING, bezier('other', (8, -4, 1), (8, 4, 1))], scene)
        self.assertEqual([row['proof'] for row in answer.rows], ['apart', 'near'], answer.err)
        self.assertEqual(self.check().code, 0)

    def what_has_no_certificates_is_named(self):
        rows = [PASSING, bezier('other', (3, -4, 1), (3, 4, 1))]
        for body, kind in (('{type: superellipsoid, dimensions: [1, 1, 1, 1, 2]}', 'support'),
                           ('{type: superellipsoid, dimensions: [1, 2, 1, 0.5, 1]}', 'support')):
            scene = BOX_SCENE + f'    - {{id: odd, bodies: [{body}]}}\n'
            plain = self.ask('distance', rows, scene)
            answer = self.write('distance', rows, scene)
            said = f"warning: object 'odd' is of a kind that has no certificates: {kind}; no row can be proven"
            self.assertIn(said, answer.err)
            self.assertEqual([row['proof'] for row in answer.rows], ['none', 'none'])
            self.assertEqual(without_proof(plain), without_proof(answer))
            checked = self.check()
            self.assertEqual((checked.code, checked.out), (1, 'passing: nothing is claimed\nother: nothing is claimed\n'))
            self.assertEqual(checked.err, said + '\n')

    def a_scene_that_cannot_be_read_is_said_in_one_line(self):
        self.write('distance', [PASSING], BOX_SCENE)
        self.file('broken.yaml', 'world: {collision_objects: [{id: box, primitives: 3}]}')
        checked = self.check(scene='broken.yaml')
        self.assertEqual((checked.code, checked.out, len(checked.err.splitlines())), (2, '', 1), checked.err)

    def what_cannot_be_meant_is_refused_in_a_line(self):
        curves = self.file('curves.csv', PASSING + '\n')
        scene = self.file('scene.yaml', BOX_SCENE)
        self.assertRefused(cprox('check'), "'check' needs a file")
        self.assertRefused(cprox('check', 'nowhere.cpc', '--curves', curves, '--scene', scene), 'nowhere.cpc')
        self.assertRefused(cprox('distance', '--curves', curves, '--scene', scene, '--certificate', curves), '--certificate',
                           'is an input')
        self.assertRefused(cprox('distance', '--curves', curves, '--scene', scene, '--per-object', '--certificate',
                                 os.path.join(self.folder, 'x')), '--per-object')
