# SPDX-License-Identifier: BSD-3-Clause
"""How rows are written: JSON, six digits on a terminal, all digits elsewhere; and what standard error has."""
import csv
import io
import json
import os
import pty
import shutil
import subprocess

from support import BOX_SCENE, HERE, PASSING, Case, bezier, cprox

EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(HERE)), 'examples')
ARM = ('--robot', 'formats/arm.urdf', '--trajectory', 'formats/trajectory.yaml', '--scene', 'formats/scene.yaml')
CURVES = ('--curves', 'tool.csv', '--scene', 'formats/scene.yaml')
COMMANDS = [('distance', *CURVES), ('tolerance', '--delta', '.05', *CURVES), ('collision', *CURVES), ('time-of-contact', *CURVES),
            ('profile', '--intervals', '7', *CURVES), ('violations', '--delta', '.2', *CURVES), ('nearest', '--pairs', '3', *CURVES),
            ('distance', *ARM, '--self', '--per-link'), ('violations', '--delta', '.2', *ARM), ('pairs', '--in', 'formats/pairs.yaml'),
            ('pairs', '--in', 'formats/pairs.yaml', '--second-opinion', 'fcl'), ('robust', '--errors', 'formats/errors.yaml', *ARM),
            ('speed', '--separation', 'formats/separation.yaml', '--objects', 'can', *ARM),
            ('margins', *ARM)]
TEXTS = {'id', 'kind', 'status', 'verdict', 'a', 'b', 'message', 'lod', 'proof', 'second_opinion', 'object', 'direction'}


def on_terminal(*words, cwd):
    """What cprox writes on a terminal."""
    master, slave = pty.openpty()
    done = subprocess.Popen([os.environ['CPROX'], *words], stdin=subprocess.DEVNULL, stdout=slave, stderr=subprocess.DEVNULL, cwd=cwd)
    os.close(slave)
    text = b''
    try:
        while True:
            block = os.read(master, 65536)
            if not block:
                break
            text += block
    except OSError:
        pass
    os.close(master)
    return done.wait(), text.decode().replace('\r\n', '\n')


class RowText(Case):
    def json_says_what_csv_says(self):
        for words in COMMANDS:
            with self.subTest(words=words):
                table, other = cprox(*words, cwd=EXAMPLES), cprox(*words, '--json', cwd=EXAMPLES)
                self.assertEqual((table.code, table.err), (other.code, other.err))
                rows = [json.loads(line, parse_constant=self.fail) for line in other.out.splitlines()]
                self.assertEqual(len(rows), len(table.rows))
                self.assertGreater(len(rows), 0)
                for said, row in zip(table.rows, rows):
                    self.assertEqual(list(said), list(row))
                    for name, field in said.items():
                        if name == 'microseconds':
                            continue
                        value = row[name]
                        if field == '':
                            self.assertIsNone(value, name)
                        elif name in TEXTS or 'inf' in field:
                            self.assertEqual(value, field, name)
                        else:
                            self.assertEqual((type(value) in (int, float), value), (True, float(field)), name)

    def json_keeps_any_name(self):
        names = ['17', 'a "quoted", name', 'tab\there', 'Bär', 'inf', 'true']
        lines = [bezier('"' + name.replace('"', '""') + '"', (3, -4, 0), (3, 4, 0)) for name in names]
        answer = self.ask('distance', lines, BOX_SCENE, '--json')
        self.assertEqual([json.loads(line)['id'] for line in answer.out.splitlines()], names)
        bad = self.ask('distance', ['x,bezier,1,0,1,0,2,1'], BOX_SCENE, '--json')
        row = json.loads(bad.out)
        self.assertEqual((bad.code, row['status'], row['lower']), (2, 'invalid', None))
        self.assertIn('column', row['message'])
        empty = self.ask('collision', [PASSING], 'world: {collision_objects: []}', '--allow-empty', '--json')
        self.assertEqual((empty.code, json.loads(empty.out)['upper']), (0, 'inf'))

    def merged_datasets_are_json_too(self):
        folder = os.path.join(self.folder, 'examples')
        shutil.copytree(EXAMPLES, folder)
        self.assertEqual(cprox('certify', '--dataset', 'formats/dataset.jsonl', '--out', 'results', cwd=folder).code, 0)
        table, other = cprox('merge', 'results', cwd=folder), cprox('merge', 'results', '--json', cwd=folder)
        rows = [json.loads(line) for line in other.out.splitlines()]
        said = list(csv.DictReader(io.StringIO(table.out)))
        self.assertEqual([(row['id'], str(row['row']), row['verdict'] or '') for row in rows], [(row['id'], row['row'], row['verdict']) for row in said])

    def a_terminal_has_six_digits_and_bounds_on_their_side(self):
        for words in COMMANDS[:9]:
            piped = cprox(*words, cwd=EXAMPLES)
            code, text = on_terminal(*words, cwd=EXAMPLES)
            self.assertEqual(code, piped.code)
            rows = list(csv.DictReader(io.StringIO(text)))
            self.assertEqual(len(rows), len(piped.rows))
            for exact, short in zip(piped.rows, rows):
                self.assertEqual(list(exact), list(short))
                for name, field in exact.items():
                    if name in TEXTS or name == 'microseconds' or field in ('', 'inf', '-inf', 'nan'):
                        self.assertTrue(field == short[name] or name == 'microseconds')
                        continue
                    value, shown = float(field), float(short[name])
                    if name.endswith('lower'):
                        self.assertLessEqual(shown, value, name)
                    elif name.endswith('upper'):
                        self.assertGreaterEqual(shown, value, name)
                    self.assertAlmostEqual(shown, value, delta=1.01e-5 * abs(value))
                    self.assertLessEqual(len(short[name].lstrip('-').replace('.', '').lstrip('0').partition('e')[0]), 6, short[name])
        path = os.path.join(self.folder, 'out.csv')
        on_terminal('distance', *CURVES, '--out', path, cwd=EXAMPLES)
        with open(path) as text:
            self.assertRegex(text.read(), r'\d\.\d{12}')

    def quiet_leaves_errors_alone(self):
        scene = BOX_SCENE + '\nsollid: true\n'
        loud, quiet = self.ask('distance', [PASSING], scene), self.ask('distance', [PASSING], scene, '--quiet')
        self.assertIn('sollid', loud.err)
        self.assertEqual((quiet.err, quiet.code, quiet.without_times()), ('', loud.code, loud.without_times()))
        self.assertRefused(cprox('distance', '--curves', 'nowhere.csv', '--scene', 'nowhere.yaml', '--quiet'), 'nowhere')

    def more_is_said_with_v(self):
        answer = self.ask('tolerance', [PASSING], BOX_SCENE, '--delta', '2.5', '-v')
        for words in ('timing: ', 'skipped: nothing', '1 rows of the input: 1 violated, 0 undecided, 0 not covered, 0 failed'):
            self.assertIn(words, answer.err)
        self.assertEqual(answer.code, 1)
        self.assertRefused(self.ask('distance', [PASSING], BOX_SCENE, '--quiet', '-v'), 'exclude each other')

    def what_is_not_covered_is_an_error_with_strict(self):
        scene = BOX_SCENE + '\nsollid: true\n'
        for query in (('distance',), ('tolerance', '--delta', '1'), ('profile', '--intervals', '3'), ('violations', '--delta', '1'), ('nearest',),
                      ('time-of-contact',)):
            lenient, strict = (self.ask(query[0], [PASSING], scene, *query[1:], *more) for more in ([], ['--strict']))
            self.assertEqual((lenient.code, strict.code), (3, 2), query)
            self.assertIn('partial', strict.out)
            self.assertIn('do not cover all that was given', strict.err)
            self.assertEqual(self.ask(query[0], [PASSING], BOX_SCENE, *query[1:], '--strict').code, 0)
        nothing = self.ask('tolerance', [PASSING], 'world: {collision_objects: []}', '--delta', '1', '--strict')
        self.assertEqual(nothing.code, 3)

    def the_manual_page_has_what_the_help_has(self):
        page = cprox('man')
        self.assertEqual((page.code, page.err), (0, ''))
        plain = page.out.replace('\\-', '-').replace('\\e', '\\')
        text = ' '.join(plain.split())
        for line in cprox('--help').out.splitlines():
            for word in line.split():
                if word.startswith('--'):
                    self.assertIn(word.strip('",:;()[]\'.'), text)
        self.assertIn('.SS violations', plain)
        if shutil.which('groff'):
            done = subprocess.run(['groff', '-man', '-Tascii', '-ww', '-K', 'utf-8'], input=page.out.encode(), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.assertEqual([line for line in done.stderr.decode().splitlines() if "can't find special" not in line and 'special character' not in line], [])
