# SPDX-License-Identifier: BSD-3-Clause
"""What may be typed, and what is said of the rest."""
from support import BOX_SCENE, HEADER, PASSING, Case, cprox


class Usage(Case):
    def help_lists_every_option_that_works_and_none_that_does_not(self):
        answer = cprox('--help')
        self.assertEqual((answer.code, answer.err), (0, ''))
        for word in ('distance', 'tolerance', 'collision', 'pairs', 'send', '--curves', '--scene', '--robot', '--srdf', '--state',
                     '--in', '--against', '--trajectory', '--self', '--signed', 'check', '--certificate', '--epsilon', '--delta', '--max-nodes', '--threads', '--per-object', '--max-rung', '--skipped',
                     '--out', '--node', '--version', 'constraints', '--provider', '--parameters'):
            self.assertIn(word, answer.out)

    def help_wins_over_everything_else(self):
        self.assertEqual(cprox('distance', '--nonsense', '--help').code, 0)

    def version_is_one_line(self):
        answer = cprox('--version')
        self.assertEqual(answer.code, 0)
        self.assertRegex(answer.out, r'^cprox \d+\.\d+\.\d+\n$')

    def words_that_are_not_known_are_refused(self):
        self.assertRefused(cprox(), 'no verb')
        self.assertRefused(cprox('distanse'), "'distanse'", 'distance')
        self.assertRefused(cprox('distance', '--fast'), '--fast')
        self.assertRefused(cprox('distance', 'more.csv', '--curves', 'c', '--scene', 's'), "'more.csv'")
        self.assertRefused(cprox('pairs', '--curves', 'c.csv'), "'pairs' takes no --curves")

    def what_is_missing_or_given_twice_is_named(self):
        self.assertRefused(cprox('distance', '--scene', 's.yaml'), '--curves')
        self.assertRefused(cprox('distance', '--curves', 'c.csv'), '--scene')
        self.assertRefused(cprox('distance', '--curves'), '--curves needs a value')
        self.assertRefused(cprox('distance', '--curves', '--scene', 's'), '--curves needs a value')
        self.assertRefused(cprox('distance', '--curves', 'a', '--curves', 'b', '--scene', 's'), '--curves is given twice')
        self.assertRefused(cprox('distance', '--per-object=yes', '--curves', 'a', '--scene', 's'), '--per-object takes no value')
        self.assertRefused(cprox('tolerance', '--curves', 'a', '--scene', 's'), '--delta')
        self.assertRefused(cprox('distance', '--curves', 'a', '--scene', 's', '--state', 'j: 1'), '--state needs --robot')
        self.assertRefused(cprox('pairs'), '--in')
        self.assertRefused(cprox('send'), 'SCENE.yaml')

    def numbers_that_cannot_be_meant_are_refused(self):
        files = ['--curves', 'c', '--scene', 's']
        for name, values in (('--epsilon', ['0', '-1e-6', 'nan', 'inf', '1e-6x', '1e999']),
                             ('--delta', ['-0.1', 'nan', 'inf', 'wide']),
                             ('--max-nodes', ['0', '-5', '1.5', '4294967296', 'many']),
                             ('--threads', ['0', '-1', '1000', 'all'])):
            for value in values:
                with self.subTest(name=name, value=value):
                    self.assertRefused(cprox('tolerance', *files, '--delta', '1', name, value)
                                       if name != '--delta' else cprox('tolerance', *files, name, value), name, value)

    def rungs_are_known_by_name(self):
        self.assertRefused(cprox('distance', '--curves', 'c', '--scene', 's', '--max-rung', 'finest'), '--max-rung', 'hull')

    def an_option_that_changes_nothing_is_told(self):
        answer = self.ask('distance', [PASSING], BOX_SCENE, '--delta', '1')
        self.assertEqual(answer.code, 0)
        self.assertRegex(answer.err, '^warning: --delta')

    def complaints_stay_one_line_whatever_a_name_holds(self):
        scene = 'world: {collision_objects: [{id: "a\\nb\\e[2J", primitives: [{type: 9, dimensions: [1]}]}]}'
        answer = self.ask('distance', [PASSING], scene)
        self.assertRefused(answer, 'a b')
        self.assertNotIn('\x1b', answer.err)

    def files_that_cannot_be_read_are_named(self):
        scene, curves = self.file('scene.yaml', BOX_SCENE), self.file('curves.csv', PASSING)
        self.assertRefused(cprox('distance', '--curves', '/none.csv', '--scene', scene), '/none.csv')
        self.assertRefused(cprox('distance', '--curves', self.folder, '--scene', scene), self.folder, 'folder')
        self.assertRefused(cprox('distance', '--curves', curves, '--scene', '/none.yaml'), '/none.yaml')
        self.assertRefused(cprox('distance', '--curves', curves, '--scene', self.folder), self.folder, 'folder')
        self.assertRefused(cprox('distance', '--curves', curves, '--scene', scene, '--robot', '/none.urdf'), '/none.urdf')
        self.assertRefused(cprox('pairs', '--in', '/none.yaml'), '/none.yaml')
        self.assertRefused(cprox('send', '/none.yaml'), '/none.yaml')

    def an_output_that_cannot_be_written_is_named(self):
        self.assertRefused(self.ask('distance', [PASSING], BOX_SCENE, '--out', '/none/r.csv'), '/none/r.csv')

    def an_input_is_never_overwritten(self):
        curves = self.file('curves.csv', PASSING)
        scene = self.file('scene.yaml', BOX_SCENE)
        for path in (curves, scene):
            self.assertRefused(cprox('distance', '--curves', curves, '--scene', scene, '--out', path), path, 'input')
        with open(curves) as text:
            self.assertEqual(text.read(), PASSING)

    def a_disk_that_is_full_is_told(self):
        answer = self.ask('distance', [PASSING] * 1000, BOX_SCENE, '--out', '/dev/full')
        self.assertEqual(answer.code, 1)
        self.assertEqual(answer.err.count('\n'), 1, answer.err)
        self.assertIn('/dev/full', answer.err)

    def out_receives_what_standard_output_would(self):
        path = self.folder + '/r.csv'
        answer = self.ask('distance', [PASSING], BOX_SCENE, '--out', path)
        self.assertEqual((answer.code, answer.out), (0, ''))
        with open(path) as text:
            self.assertTrue(text.read().startswith(HEADER + '\npassing,curve,ok,,'))
