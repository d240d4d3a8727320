# SPDX-License-Identifier: BSD-3-Clause
"""--second-opinion: FCL and libccd agree with the rows about the sample scenes, and what they cannot tell is said."""
import glob
import os

from support import BOX_SCENE, DATA, HEADER, PASSING, Case, cprox

EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(DATA)), 'examples')
FORMATS = os.path.join(EXAMPLES, 'formats')
COLUMNS = ('second_opinion', 'second_distance')
PEERS = ('fcl', 'libccd')


class SecondOpinion(Case):
    def assertAgrees(self, row):
        self.assertEqual(row['second_opinion'], 'agrees', row)
        self.assertAlmostEqual(float(row['second_distance']), max(0.0, float(row['upper'])), delta=1e-4)

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)
        return path

    def a_row_says_who_agrees_and_what_is_measured(self):
        curves, scene = self.write('c.csv', PASSING + '\n'), self.write('s.yaml', BOX_SCENE)
        plain = cprox('distance', '--curves', curves, '--scene', scene)
        self.assertEqual(plain.header, HEADER)
        for peer in PEERS:
            asked = cprox('distance', '--curves', curves, '--scene', scene, '--second-opinion', peer)
            self.assertEqual((asked.code, asked.err, asked.header), (0, '', ','.join((HEADER,) + COLUMNS)))
            self.assertAgrees(asked.rows[0])
            self.assertAlmostEqual(float(asked.rows[0]['second_distance']), 2.0, delta=1e-6)
            own = [{k: v for k, v in row.items() if k not in COLUMNS} for row in asked.without_times()]
            self.assertEqual(own, plain.without_times())

    def both_libraries_agree_about_the_sample_scenes(self):
        scenes = [path for places in ('robowflex_box/*.yaml', 'mbm/*/scene0001.yaml')
                  for path in sorted(glob.glob(os.path.join(DATA, 'scenes', places)))]
        self.assertGreater(len(scenes), 8)
        robot = os.path.join(DATA, 'robots', 'panda', 'panda.urdf')
        measured = 0
        for scene in scenes:
            for peer in PEERS:
                with self.subTest(scene=scene, peer=peer):
                    words = ['--robot', robot] if '_panda' in scene else []
                    answer = cprox('nearest', '--pairs', '5', '--curves', os.path.join(EXAMPLES, 'tool.csv'), '--scene', scene,
                                   '--second-opinion', peer, *words)
                    self.assertEqual(answer.code, 0, answer.err)
                    for row in answer.rows:
                        self.assertNotEqual(row['second_opinion'], 'disagrees', row)
                        measured += row['second_opinion'] == 'agrees'
        self.assertGreater(measured, 80)

    def robots_and_pairs_are_measured_again(self):
        arm = ['--robot', os.path.join(FORMATS, 'arm.urdf'), '--srdf', os.path.join(FORMATS, 'arm.srdf'), '--trajectory',
               os.path.join(FORMATS, 'trajectory.yaml'), '--scene', os.path.join(FORMATS, 'scene.yaml')]
        for peer in PEERS:
            robot = cprox('nearest', *arm, '--second-opinion', peer)
            self.assertEqual(robot.code, 0, robot.err)
            for row in robot.rows:
                if row['second_opinion'] == 'unknown':
                    self.assertRegex(row['message'], f'{peer} is not asked about (superquadric|implicit)s')
                else:
                    self.assertAgrees(row)
            self.assertIn('agrees', [row['second_opinion'] for row in robot.rows])
            pairs = self.write('pairs.yaml', '''
- {id: apart, a: {type: box, dimensions: [1, 1, 1]}, b: {type: sphere, dimensions: [0.5], pose: {position: [2, 0, 0]}}}
- {id: deep, a: {type: box, dimensions: [1, 1, 1]}, b: {type: cone, dimensions: [1, 0.5], pose: {position: [0.1, 0, 0]}}}
- {id: odd, a: {type: superquadric, dimensions: [1, 1, 1, 4, 4, 4]}, b: {type: sphere, dimensions: [0.5], pose: {position: [2, 0, 0]}}}
''')
            asked = cprox('pairs', '--in', pairs, '--second-opinion', peer)
            self.assertEqual(asked.code, 0, asked.err)
            self.assertAgrees(asked.row('apart'))
            self.assertAgrees(asked.row('deep'))
            self.assertEqual((asked.row('odd')['second_opinion'], asked.row('odd')['second_distance']), ('unknown', ''))
            self.assertIn('superquadric', asked.row('odd')['message'])

    def a_disagreement_is_a_warning_and_an_exit_code(self):
        """A flat cone of which FCL 0.7 is wrong by .1 mm; libccd agrees with us."""
        pairs = self.write('pairs.yaml', '''
- {id: flat, a: {type: cone, dimensions: [0.0032, 0.95]}, b: {type: sphere, dimensions: [0.00063], pose: {position: [0.9, -0.2, 0.4]}}}
''')
        asked = cprox('pairs', '--in', pairs, '--second-opinion', 'fcl')
        row = asked.row('flat')
        self.assertEqual((asked.code, row['second_opinion']), (3, 'disagrees'))
        self.assertIn('fcl disagrees: it measures 0.4009', row['message'])
        self.assertIn('warning: the second opinion disagrees in 1 of 1 rows', asked.err)
        asked = cprox('pairs', '--in', pairs, '--second-opinion', 'libccd')
        self.assertEqual((asked.code, asked.err), (0, ''))
        self.assertAgrees(asked.row('flat'))

    def what_has_no_pair_or_no_such_library_is_refused(self):
        files = ['--curves', 'c.csv', '--scene', 's.yaml']
        self.assertRefused(cprox('profile', *files, '--second-opinion', 'fcl'), "'profile' takes no --second-opinion")
        self.assertRefused(cprox('violations', *files, '--delta', '1', '--second-opinion', 'fcl'), 'takes no --second-opinion')
        self.assertRefused(cprox('distance', *files, '--second-opinion', 'bullet'), "'bullet'", 'fcl or libccd')
        self.assertRefused(cprox('distance', '--curves', 'c', '--against', 'd', '--second-opinion', 'fcl'), '--second-opinion')
        self.assertRefused(cprox('distance', '--scene', 's', '--movers', '--second-opinion', 'fcl'), '--second-opinion')
