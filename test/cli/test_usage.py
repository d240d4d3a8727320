# SPDX-License-Identifier: BSD-3-Clause
"""What may be typed, and what is said of the rest."""
import os
import re
import shlex
import subprocess

from support import BOX_SCENE, HEADER, HERE, PASSING, Case, cprox


class Usage(Case):
    def help_lists_every_option_that_works_and_none_that_does_not(self):
        answer = cprox('--help')
        self.assertEqual((answer.code, answer.err), (0, ''))
        for word in ('distance', 'tolerance', 'collision', 'pairs', 'send', '--curves', '--scene', '--robot', '--srdf', '--state',
                     '--in', '--against', '--trajectory', '--self', '--signed', 'check', '--certificate', '--epsilon', '--delta', '--max-nodes', '--threads', '--per-object', '--max-lod', '--skipped',
                     '--out', '--node', '--version', 'constraints', '--provider', '--parameters', 'profile', 'nearest', 'time-of-contact',
                     '--per-link', '--intervals', '--breaks', '--horizon', '--pairs', '--within', '--movers', '--second-opinion', '--allow-empty'):
            self.assertIn(word, answer.out)

    COMMANDS = ('distance', 'tolerance', 'collision', 'time-of-contact', 'profile', 'violations', 'nearest', 'pairs', 'constraints',
                'robust', 'acm', 'sweep', 'speed', 'margins', 'report', 'send', 'check', 'certify', 'merge')

    def each_command_has_a_page_whose_examples_run(self):
        os.symlink(os.path.join(os.path.dirname(os.path.dirname(HERE)), 'examples'), os.path.join(self.folder, 'examples'))
        seen = set()
        for command in self.COMMANDS:
            answer = cprox(command, '--help')
            self.assertEqual((answer.code, answer.err), (0, ''))
            self.assertTrue(answer.out.startswith(f'cprox {command} '))
            self.assertLessEqual(max(len(line) for line in answer.out.splitlines() if not line.startswith('  cprox ')), 120)
            examples = re.findall('^  cprox (.*)$', answer.out.partition('\nExamples\n')[2].partition('\n\n')[0], re.M)
            self.assertGreaterEqual(len(examples), 2)
            for example in [] if command == 'send' else examples:
                with self.subTest(example=example):
                    done = cprox(*shlex.split(example), cwd=self.folder)
                    self.assertIn(done.code, (0, 1, 3), done.err)
            seen.update(re.findall('^  (--[a-z-]+)', answer.out.partition('\nOptions\n')[2], re.M))
        self.assertEqual(seen, set(re.findall('^  (--[a-z-]+)', cprox('--help').out.partition(' is one of\n')[2].partition('\n\n')[2], re.M)) - {'--help'})

    def the_page_of_a_command_has_its_options_alone(self):
        page = cprox('profile', '--help').out
        self.assertIn('--horizon', page)
        self.assertIn('id,kind,status,t0,t1', page)
        for word in ('--within', '--provider', '--dataset', '--synchronized'):
            self.assertNotIn(word, page.partition('\nOptions\n')[2])

    def a_shell_completes_commands_options_and_files(self):
        script = self.file('complete.bash', cprox('completion', 'bash').out + """
ask() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _cprox; echo "${COMPREPLY[*]}"; }
ask cprox ti
ask cprox nearest --wi
ask cprox distance --wi
ask cprox distance --curves a.c
""")
        done = subprocess.run(['bash', '--norc', script], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=True)
        self.assertEqual(done.stdout.decode(), 'time-of-contact\n--within\n\n\n')
        self.assertRefused(cprox('completion', 'fish'), 'bash')

    def zsh_completes_commands_and_options(self):
        """In a terminal of its own: its completion answers to keys alone."""
        script, asks = self.file('complete.zsh', cprox('completion', 'zsh').out), self.file('keys.zsh', '''
zmodload zsh/zpty && zpty shell zsh -f -i
out=
reach() { # reads until the word has come, half a minute at most
  for i in {1..300}; do
    while zpty -r -t shell line; do out+=$line; done
    [[ $out != *$1* ]] || return
    sleep 0.1
  done
}
zpty -w -n shell $'PS1=; source "'$1$'"; print re""ady\\n'
reach ready
zpty -w -n shell $'cprox time-o\\t --curv\\t'
reach --curves
print -rn -- $out
''')
        done = subprocess.run(['zsh', '-f', asks, script], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=True, timeout=60)
        self.assertRegex(re.sub(r'\x1b\[[0-9;?]*[a-zA-Z]', '', done.stdout.decode(errors='replace')), 'time-of-contact[ \x08]*--curves')

    def help_wins_over_everything_else(self):
        self.assertEqual(cprox('distance', '--nonsense', '--help').code, 0)

    def version_is_one_line(self):
        answer = cprox('--version')
        self.assertEqual(answer.code, 0)
        self.assertRegex(answer.out, r'^cprox \d+\.\d+\.\d+\n$')

    def words_that_are_not_known_are_refused(self):
        self.assertRefused(cprox(), 'no command')
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

    def lods_are_known_by_name(self):
        self.assertRefused(cprox('distance', '--curves', 'c', '--scene', 's', '--max-lod', 'finest'), '--max-lod', 'hull')

    def an_option_that_does_not_apply_is_refused(self):
        """Every command with every input and every option: what the command has is read, the rest is refused by name."""
        values = {'--curves': 'c', '--against': 'd', '--trajectory': 't', '--scene': 's', '--robot': 'r', '--srdf': 'q', '--state': 'j: 1',
                  '--certificate': 'f', '--in': 'i', '--provider': 'p', '--parameters': 'k: 1', '--node': '/n', '--epsilon': '1e-3',
                  '--delta': '1', '--max-nodes': '9', '--threads': '2', '--max-lod': 'hull', '--out': 'o', '--self': None,
                  '--replace': None, '--add': None, '--signed': None, '--per-object': None, '--skipped': None, '--per-link': None,
                  '--intervals': '9', '--breaks': '0, 1', '--horizon': '1', '--pairs': '2', '--within': '1', '--check-gradient': None, '--movers': None, '--synchronized': None,
                  '--second-opinion': 'fcl', '--links': 'l', '--objects': 'o', '--allow-empty': None, '--moving-links-only': None}
        run = {'--epsilon', '--max-nodes', '--threads', '--out'}
        rows = [('pairs', ['--in', 'i'], run | {'--max-lod', '--skipped', '--second-opinion'}),
                ('constraints', ['--in', 'i', '--provider', 'p'], {'--parameters', '--scene', '--robot', '--threads', '--out', '--check-gradient'}),
                ('constraints', ['--trajectory', 't', '--robot', 'r', '--provider', 'p'],
                 {'--parameters', '--scene', '--srdf', '--state', '--threads', '--out', '--check-gradient'}),
                ('send', ['s'], {'--node', '--replace', '--add'})]
        for command, own in (('distance', {'--signed'}), ('tolerance', {'--delta'}), ('collision', set())):
            start = ['--delta', '1'] if command == 'tolerance' else []
            rows += [(command, start + ['--curves', 'c', '--robot', 'r'],
                      run | own | {'--scene', '--srdf', '--state', '--certificate', '--per-object', '--max-lod', '--skipped', '--against', '--second-opinion', '--links', '--objects',
                       '--allow-empty'}),
                     (command, start + ['--curves', 'c', '--against', 'd'], run | own | {'--certificate', '--scene', '--robot', '--synchronized'}),
                     (command, start + ['--trajectory', 't', '--robot', 'r'], run | own | {
                         '--scene', '--srdf', '--state', '--certificate', '--per-object', '--per-link', '--max-lod', '--skipped', '--self', '--second-opinion',
                         '--links', '--objects', '--allow-empty', '--moving-links-only'})]
        for command, own in (('profile', {'--intervals', '--breaks', '--horizon', '--certificate'}), ('nearest', {'--pairs', '--within', '--signed'}), ('time-of-contact', {'--certificate'})):
            both = run | (set() if command == 'profile' else {'--second-opinion'}) | own | {
                '--scene', '--srdf', '--state', '--per-object', '--max-lod', '--skipped', '--links', '--objects', '--allow-empty'}
            rows += [(command, ['--curves', 'c', '--robot', 'r'], both),
                     (command, ['--trajectory', 't', '--robot', 'r'], both - {'--signed'} | {'--self', '--per-link', '--moving-links-only'})]
        rows += [('distance', ['--scene', 's', '--movers'], run | {'--certificate', '--max-lod', '--skipped', '--self', '--allow-empty', '--moving-links-only'})]
        for command, inputs, has in rows:
            for name, value in values.items():
                if name in inputs or name in ('--against', '--scene', '--robot') and '--curves' in inputs:
                    continue
                with self.subTest(command=command, inputs=inputs, option=name):
                    answer = cprox(command, *inputs, name, *([] if value is None else [value]))
                    self.assertEqual(answer.code, 2)
                    refused = name in answer.err and ('takes no' in answer.err or 'is for' in answer.err or 'needs' in answer.err)
                    self.assertEqual(refused, name not in has, answer.err)
