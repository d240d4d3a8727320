# SPDX-License-Identifier: BSD-3-Clause
"""--certificate and check: what is written is proven by the program cprox_check, for these inputs and for no others."""
import os
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


class CertificateTest(Case):

    def write(self, verb, rows, scene, *more):
        """Asks with --certificate; the words of `check` for the same question."""
        self.certificates = os.path.join(self.folder, 'answers.cpc')
        answer = self.ask(verb, rows, scene, '--certificate', self.certificates, *more)
        self.assertEqual(answer.code, 0, answer.err)
        return answer

    def check(self, scene='scene.yaml', curves='curves.csv'):
        return cprox('check', self.certificates, '--curves', os.path.join(self.folder, curves),
                     '--scene', os.path.join(self.folder, scene))

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

    def a_certificate_of_another_question_is_refused(self):
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

    def rows_without_an_answer_claim_nothing(self):
        self.certificates = os.path.join(self.folder, 'answers.cpc')
        answer = self.ask('distance', [PASSING, 'bad,bezier,1,0,1,0,2,0,0'], BOX_SCENE, '--certificate', self.certificates)
        self.assertEqual(answer.code, 1)
        checked = self.check()
        self.assertEqual(checked.code, 1)
        self.assertIn('passing: proven', checked.out)
        self.assertIn('bad: nothing is claimed', checked.out)

    def curves_against_curves_are_proven(self):
        self.certificates = os.path.join(self.folder, 'pairs.cpc')
        first = self.file('a.csv', PASSING + '\n' + bezier('b', (0, 0, 0), (1, 1, 1), (2, 0, 0)) + '\n')
        second = self.file('b.csv', bezier('c', (0, -4, 1), (1, 4, 0)) + '\n' + bezier('d', (0, 1, 1), (1, -1, 0)) + '\n')
        question = ['--curves', first, '--against', second]
        asked = cprox('distance', *question, '--certificate', self.certificates)
        self.assertEqual(asked.code, 0, asked.err)
        checked = cprox('check', self.certificates, *question)
        self.assertEqual(checked.code, 0, checked.out + checked.err)
        self.assertEqual(checked.out.count('proven'), 2)

    def what_cannot_be_meant_is_refused_in_a_line(self):
        curves = self.file('curves.csv', PASSING + '\n')
        scene = self.file('scene.yaml', BOX_SCENE)
        self.assertRefused(cprox('check'), "'check' needs a file")
        self.assertRefused(cprox('check', 'nowhere.cpc', '--curves', curves, '--scene', scene), 'nowhere.cpc')
        self.assertRefused(cprox('distance', '--curves', curves, '--scene', scene, '--certificate', curves), '--certificate',
                           'is an input')
        self.assertRefused(cprox('distance', '--curves', curves, '--scene', scene, '--per-object', '--certificate',
                                 os.path.join(self.folder, 'x')), '--per-object')
