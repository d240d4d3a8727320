# SPDX-License-Identifier: BSD-3-Clause
"""Datasets: shards that are whole or not there, and one table however they are cut."""
import csv
import io
import json
import math
import os
import random
import signal
import subprocess
import threading
import time

from support import Case, cprox
from test_trajectory import SLIDE, SLIDER, WALL

COLUMNS = 'row,id,kind,status,verdict,lower,upper,t,a,b,lod,nodes,distance_queries,message'


def slide(to, swing=0.0):
    """A trajectory in the row itself."""
    return {'joint_trajectory': {'joint_names': ['slide', 'swing'], 'points': [
        {'positions': [0, 0], 'time_from_start': 0}, {'positions': [to, swing], 'time_from_start': {'secs': 2, 'nsecs': 0}}]}}


class Dataset(Case):
    def setUp(self):
        super().setUp()
        self.file('robot.urdf', SLIDER)
        self.file('go.yaml', SLIDE)
        for name, move in (('near', '3.5'), ('far', '5.5')):
            self.file(name + '.yaml', WALL.replace('3.5', move))

    def manifest(self, rows, name='data.jsonl'):
        return self.file(name, ''.join((row if isinstance(row, str) else json.dumps(row)) + '\n' for row in rows))

    @staticmethod
    def row(identifier, trajectory='go.yaml', scene='near.yaml', **more):
        return dict({'id': identifier, 'robot': 'robot.urdf', 'scene': scene, 'trajectory': trajectory}, **more)

    def many(self, n, seed=7):
        """n rows, some of which cannot be answered."""
        rng = random.Random(seed)
        rows = []
        for i in range(n):
            more = rng.choice([{'query': 'distance'}, {'query': 'collision', 'self': True}, {'query': 'tolerance', 'delta': 0.3}])
            rows.append(self.row(f'r{i}', slide(rng.uniform(1, 4), rng.uniform(-1, 1)), rng.choice(['near.yaml', 'far.yaml']), **more))
        for i in range(3, n, 17):
            rows[i] = rng.choice(['{"id": "torn', 'no json', {'id': f'r{i}', 'robot': 'robot.urdf'}, self.row(f'r{i}', 'none.yaml'),
                                  self.row(f'r{i}', scene='none.yaml'), self.row(f'r{i}', query='tolerance')])
        return self.manifest(rows)

    def certify(self, manifest, out, *more):
        return cprox('certify', '--dataset', manifest, '--out', os.path.join(self.folder, out), *more)

    def merged(self, out):
        answer = cprox('merge', os.path.join(self.folder, out))
        self.assertTrue(answer.out.startswith(COLUMNS), answer.err)
        return answer.out

    @staticmethod
    def table(text):
        lines = text.splitlines()
        return [dict(zip(lines[0].split(','), line.split(','))) for line in lines[1:]]

    def rows_are_answered_as_the_other_commands_answer_them(self):
        manifest = self.manifest([self.row('d'), self.row('c', slide(4), query='collision'), self.row('t', delta=0.91), self.row('u', delta=0.5),
                                  self.row('f', scene='far.yaml')])
        answer = self.certify(manifest, 'out')
        self.assertEqual(answer.code, 0, answer.err)
        rows = self.table(self.merged('out'))
        self.assertEqual([(row['row'], row['id'], row['kind'], row['status'], row['verdict'], row['b']) for row in rows],
                         [('0', 'd', 'environment', 'ok', '', 'wall'), ('1', 'c', 'environment', 'ok', 'violated', 'wall'),
                          ('2', 't', 'environment', 'ok', 'violated', 'wall'), ('3', 'u', 'environment', 'ok', 'clear', 'wall'),
                          ('4', 'f', 'environment', 'ok', '', 'post')])
        files = ('--robot', self.folder + '/robot.urdf', '--trajectory', self.folder + '/go.yaml', '--scene', self.folder + '/near.yaml')
        self.assertEqual(rows[0]['lower'], cprox('distance', *files).rows[0]['lower'])
        self.assertAlmostEqual(float(rows[4]['upper']), 2 - 0.25 - 0.1, places=5)

    def the_table_is_the_same_however_the_dataset_is_cut(self):
        manifest = self.many(150)
        tables = {}
        for n, threads in ((1, 1), (1, 2), (7, 2), (64, 1), (200, 2)):
            out = f'out-{n}-{threads}'
            answer = self.certify(manifest, out, '--shards', n, '--threads', threads)
            self.assertEqual(answer.code, 0, answer.err)
            self.assertEqual(len(os.listdir(os.path.join(self.folder, out))), n)
            tables[n, threads] = self.merged(out)
        self.assertEqual(len(set(tables.values())), 1)
        rows = self.table(tables[1, 1])
        self.assertEqual(sorted({int(row['row']) for row in rows}), list(range(150)))
        self.assertEqual(len([row for row in rows if row['status'] in ('failed', 'missing')]), len(range(3, 150, 17)))
        single = os.path.join(self.folder, 'single')
        for shard in (6, 0, 3, 5, 1, 4, 2):
            self.assertEqual(self.certify(manifest, 'single', '--shards', 7, '--shard', shard).code, 0)
        self.assertEqual(len(os.listdir(single)), 7)
        self.assertEqual(self.merged('single'), tables[1, 1])

    def a_robot_that_cannot_be_read_is_read_once_for_all_scenes(self):
        pipe = os.path.join(self.folder, 'broken.urdf')
        os.mkfifo(pipe)
        reads = []

        def write():
            while True:
                try:
                    file = os.open(pipe, os.O_WRONLY)  # waits for a reader, and does not create
                except FileNotFoundError:
                    return
                reads.append(os.write(file, b'<robot name="broken">'))
                os.close(file)
                time.sleep(0.1)  # until that reader is done
        writer = threading.Thread(target=write, daemon=True)
        writer.start()
        scenes = ['near.yaml', 'far.yaml', 'third.yaml']
        self.file('third.yaml', WALL)
        manifest = self.manifest([self.row(scene, scene=scene, robot='broken.urdf') for scene in scenes])
        self.assertEqual(self.certify(manifest, 'out').code, 0)
        rows = self.table(self.merged('out'))
        self.assertEqual([row['status'] for row in rows], ['failed'] * 3)
        self.assertEqual(len({row['message'] for row in rows}), 1)
        self.assertIn('broken.urdf', rows[0]['message'])
        self.assertEqual(len(reads), 1)

    def csv_and_json_lines_say_the_same(self):
        self.manifest([self.row('a', query='tolerance', delta=0.5), self.row('b, "b"', scene='far.yaml', self=True)], 'one.jsonl')
        self.file('two.csv', '# a comment\nid,robot,scene,trajectory,query,delta,self\r\na,robot.urdf,near.yaml,go.yaml,tolerance,0.5,\r\n'
                  '"b, ""b""",robot.urdf,far.yaml,go.yaml,,,true\r\n')
        for name in ('one.jsonl', 'two.csv'):
            self.assertEqual(self.certify(os.path.join(self.folder, name), name + '.out').code, 0)
        self.assertEqual(self.merged('one.jsonl.out'), self.merged('two.csv.out'))

    def a_trajectory_in_a_row_is_read_as_its_file_is(self):
        """A spline, and a key that nobody knows: in the row, in a file of JSON and in one of YAML."""
        spline = {'joint_spline': {'joint_names': ['slide'], 'degree': 1, 'knots': [0, 0, 2, 2], 'control_points': [[0], [3]]}}
        for name, of in (('spline', spline), ('odd', dict(slide(2), colour='red'))):
            self.file(name + '.json', json.dumps(of))
            self.file(name + '.yaml', '# YAML\n' + json.dumps(of))
            rows = [self.row('x', trajectory, self=True) for trajectory in (of, name + '.json', name + '.yaml')]
            self.assertEqual(self.certify(self.manifest(rows), name).code, 0)
            answers = [dict(row, row='', message=row['message'].replace('trajectory.', '')) for row in self.table(self.merged(name))]
            self.assertEqual(answers[0]['status'], {'spline': 'ok', 'odd': 'partial'}[name], answers[0])
            self.assertEqual(answers[:2], answers[2:4])
            self.assertEqual(answers[:2], answers[4:])

    def a_poison_row_is_a_row(self):
        poison = ['{', '[]', '"text"', '{"robot": [3], "trajectory": "go.yaml"}', '{"robot": "robot.urdf", "robot": "x"}', '\x00\x01', '{' * 300,
                  self.row('a', query='distanse'), self.row('b', delta=-1), self.row('c', delta=1, query='collision'), self.row('d', colour='red'),
                  self.row('e', {'joint_trajectory': {'joint_names': ['ghost'], 'points': [{'positions': [0], 'time_from_start': 0}]}}),
                  self.row('f', {'joint_trajectory': {'joint_names': ['slide'], 'points': []}}), self.row('g', '/'), self.row('h', scene='robot.urdf'),
                  dict(self.row('i'), robot='go.yaml'), '{"id": "j\\u0000\\ud83d\\ude00", "robot": "robot.urdf", "trajectory": "go.yaml"}']
        answer = self.certify(self.manifest([self.row('first'), *poison, self.row('last')]), 'out')
        self.assertEqual(answer.code, 0, answer.err)
        merged = cprox('merge', os.path.join(self.folder, 'out'))
        self.assertEqual(merged.code, 2)
        lines = merged.out.splitlines()
        self.assertEqual(len(lines), 1 + len(poison) + 2)
        self.assertEqual([line.split(',')[3] for line in lines[1:]], ['ok'] + ['failed'] * (len(poison) - 1) + ['empty', 'ok'])  # the last poison names no scene
        for name, word in (('a', 'distanse'), ('b', 'below 0'), ('c', 'tolerance'), ('d', 'colour'), ('e', 'ghost'), ('f', 'no points')):
            self.assertIn(word, [line for line in lines if line.split(',')[1] == name][0])

    def json_is_read_as_python_reads_it(self):
        """Seed 11, 2000 lines: rows with ids of all kinds, and the same with some bytes changed. Python's reader takes more than
        JSON, so it is told to refuse the rest."""
        rng = random.Random(11)

        def refuse(*_):
            raise ValueError

        def members(pairs):
            return dict(pairs) if len(pairs) == len({name for name, _ in pairs}) else refuse()

        def finite(text):
            return float(text) if math.isfinite(float(text)) else refuse()

        def read(line):
            value = json.loads(line.decode('utf-8-sig'), object_pairs_hook=members, parse_float=finite, parse_int=finite, parse_constant=refuse)
            json.dumps(value, ensure_ascii=False).encode()  # refuses half a surrogate pair
            return value

        def identifier():
            alphabet = 'a"\\\\/\b\f\t\u00e4\u07ff\u0800\ud7ff\ufffd\U00010000\U0010ffff{}[]'
            return rng.choice([lambda: ''.join(rng.choice(alphabet) for _ in range(rng.randrange(12))), lambda: rng.uniform(-9, 9),
                               lambda: rng.randrange(-10**18, 10**18), lambda: rng.choice([5e-324, 1e-310, 1.7e308, 0.1, -0.0, 1e22, 1e23]),
                               lambda: rng.random() * 10.0 ** rng.randrange(-320, 308)])()
        lines = []
        for i in range(2000):
            row = self.row(identifier(), rng.choice(['go.yaml', slide(rng.uniform(1, 4))]))
            line = bytearray(json.dumps(row, ensure_ascii=rng.random() < 0.5, indent=rng.choice([None, '\t'])).replace('\n', ' ').encode())
            for _ in range(rng.randrange(3) if i % 2 else 0):
                at = rng.randrange(len(line))
                line[at:at + rng.randrange(2)] = rng.choice([b'', b'"', b'\\', b'{', b']', b',', b':', b'e', b'.', b'-', b'0', b'\xc0\xaf', b'\xed\xa0\x80',
                                                             b'\xf4\x90\x80\x80', b'\x80', b'\x1f', b'\\ud800', b'\\u00', b'\\ud83d\\ude00', b'1e999', b'01'])
            lines.append(bytes(line))
        lines += [b'\xef\xbb\xbf{}', b'[1,]', b'{"a":1,}', b'truex', b'+1', b'.5', b'1.', b'{"id": 1} {}', b'"\\', b'[' * 65, b'nul', b'{"a"',
                  b'"\xe0\x80\xaf"', b'"\xf0\x8f\xbf\xbf"', b'"\xed\xa0\x80"', b'"\xf4\x90\x80\x80"', b'"\xf5\x80\x80\x80"', b'"\xc3"']
        path = os.path.join(self.folder, 'lines.jsonl')
        with open(path, 'wb') as out:
            out.write(b'\n'.join(lines))
        self.assertEqual(self.certify(path, 'out').code, 0)
        answers = {int(row['row']): row for row in csv.DictReader(io.StringIO(self.merged('out')))}
        self.assertEqual(sorted(answers), list(range(len(lines))))
        refused = 0
        for i, line in enumerate(lines):
            said = answers[i]['message']
            try:
                value = read(line)
            except (ValueError, UnicodeError):
                refused += 1
                self.assertIn('no JSON: ', said, line)
                self.assertRegex(said, r'\(character \d+\)$', line)
                continue
            self.assertNotIn('no JSON', said, line)
            if isinstance(value, dict) and isinstance(value.get('id'), str):
                self.assertEqual(answers[i]['id'], ''.join(c if c >= ' ' else ' ' for c in value['id']), line)
            elif isinstance(value, dict) and isinstance(value.get('id'), float):
                self.assertEqual(float(answers[i]['id']), value['id'], line)
        self.assertGreater(refused, 300)

    def a_whole_shard_is_skipped_and_a_torn_one_is_done_again(self):
        manifest = self.many(60)
        self.certify(manifest, 'out', '--shards', 5)
        wanted, folder = self.merged('out'), os.path.join(self.folder, 'out')
        again = self.certify(manifest, 'out', '--shards', 5)
        self.assertEqual((again.code, again.err.count('is whole: skipped')), (0, 5))
        path = os.path.join(folder, 'shard-00002-of-00005.csv')
        with open(path, 'rb') as file:
            whole = file.read()
        lines = whole.splitlines(keepends=True)
        for torn in (b'', whole[:-1], whole[:len(whole) // 2], b''.join(lines[:-1]), whole + b'x\n', whole.replace(b'ok', b'OK', 1), lines[0],
                     b''.join(lines[:7] + lines[8:]), b'x' * 1000):
            with open(path, 'wb') as file:
                file.write(torn)
            refused = cprox('merge', folder)
            self.assertEqual((refused.code, refused.out), (2, ''), refused.err)
            self.assertIn('shard-00002-of-00005.csv', refused.err)
            again = self.certify(manifest, 'out', '--shards', 5)
            self.assertEqual((again.code, again.err.count('is whole: skipped'), again.err.count('done again')), (0, 4, 1), again.err)
            self.assertEqual(self.merged('out'), wanted)

    def a_shard_of_other_inputs_is_done_again(self):
        manifest = self.manifest([self.row('a'), self.row('b', scene='far.yaml')])
        self.certify(manifest, 'out', '--shards', 2)
        for change in (lambda: self.file('go.yaml', SLIDE.replace('[2]', '[1]')), lambda: self.file('near.yaml', WALL.replace('3.5', '4.5')),
                       lambda: self.file('robot.urdf', SLIDER.replace('0.2 0.2 0.2', '0.4 0.2 0.2')),
                       lambda: self.manifest([self.row('a2'), self.row('b', scene='far.yaml')])):
            before = self.merged('out')
            change()
            answer = self.certify(manifest, 'out', '--shards', 2)
            self.assertIn('done again', answer.err)
            self.assertNotEqual(self.merged('out'), before)
        answer = self.certify(manifest, 'out', '--shards', 2, '--epsilon', '1e-3')
        self.assertEqual(answer.err.count('done again'), 2)

    def merge_refuses_what_does_not_belong_together(self):
        manifest = self.many(20)
        for out, n in (('a', 4), ('b', 5)):
            self.certify(manifest, out, '--shards', n)
        folder = os.path.join(self.folder, 'a')

        def refused(*words):
            answer = cprox('merge', folder)
            self.assertEqual((answer.code, answer.out), (2, ''))
            for word in words:
                self.assertIn(word, answer.err)

        os.rename(folder + '/shard-00001-of-00004.csv', self.folder + '/kept')
        refused('1 of 4 shards are missing: 1')
        os.rename(self.folder + '/kept', folder + '/shard-00001-of-00004.csv')
        with open(os.path.join(self.folder, 'b/shard-00000-of-00005.csv'), 'rb') as source, open(folder + '/stray.csv', 'wb') as stray:
            stray.write(source.read())
        refused('one of 4')
        self.certify(manifest, 'c', '--shards', 4, '--epsilon', '1e-3')
        with open(os.path.join(self.folder, 'c/shard-00000-of-00004.csv'), 'rb') as source, open(folder + '/stray.csv', 'wb') as stray:
            stray.write(source.read())
        refused('fingerprint')
        with open(folder + '/shard-00003-of-00004.csv', 'rb') as source, open(folder + '/stray.csv', 'wb') as stray:
            stray.write(source.read())
        self.assertEqual(self.merged('a'), self.merged('b'))  # twice the same is once
        self.file('near.yaml', WALL.replace('3.5', '4.5'))
        self.certify(manifest, 'd', '--shards', 4)
        os.remove(folder + '/stray.csv')
        with open(os.path.join(self.folder, 'd/shard-00001-of-00004.csv'), 'rb') as source, open(folder + '/shard-00001-of-00004.csv', 'wb') as other:
            other.write(source.read())
        refused('near.yaml')
        empty = cprox('merge', self.folder + '/nowhere')
        self.assertEqual((empty.code, empty.out), (2, ''))

    def a_run_that_is_killed_is_resumed(self):
        manifest, folder = self.many(3000), os.path.join(self.folder, 'killed')
        for number in (signal.SIGKILL, signal.SIGTERM):
            process = subprocess.Popen([os.environ['CPROX'], 'certify', '--dataset', manifest, '--out', folder, '--shards', '30'],
                                       stderr=subprocess.PIPE)
            limit = time.monotonic() + 60
            while not os.path.isdir(folder) or len([name for name in os.listdir(folder) if name.endswith('.csv')]) < 5:
                self.assertLess(time.monotonic(), limit)
                self.assertIsNone(process.poll(), 'it was done before it could be killed')
                time.sleep(0.002)
            process.send_signal(number)
            text = process.communicate(timeout=60)[1].decode()
            self.assertEqual(process.returncode, -number if number == signal.SIGKILL else 130)
            if number == signal.SIGTERM:
                self.assertIn('is to be done again', text)
                self.assertFalse([name for name in os.listdir(folder) if name.endswith('.part') and f'.{process.pid}.' in name])
            self.assertEqual(cprox('merge', folder).code, 2)
            for name in sorted(os.listdir(folder))[3:]:  # so that the next one has something to do
                os.remove(os.path.join(folder, name))
        self.assertEqual(self.certify(manifest, 'killed', '--shards', 30).code, 0)
        self.certify(manifest, 'whole')
        self.assertEqual(self.merged('killed'), self.merged('whole'))

    def progress_is_told_as_json(self):
        answer = self.certify(self.many(40), 'out', '--shards', 2, '--progress', 'json')
        told = [json.loads(line) for line in answer.err.splitlines() if line.startswith('{')]
        self.assertEqual([(line['shard'], line['shards'], line['rows'], line['done']) for line in told], [(0, 2, 20, 20), (1, 2, 20, 20)])
        self.assertEqual(set(told[0]), {'shard', 'shards', 'rows', 'done', 'rate', 'eta', 'violated', 'undecided', 'failed'})

    def a_dataset_that_cannot_be_read_is_refused(self):
        out = os.path.join(self.folder, 'out')
        self.assertRefused(self.certify('/nowhere.jsonl', 'out'), '/nowhere.jsonl')
        self.assertRefused(self.certify(self.file('bad.csv', 'id,colour\n'), 'out'), 'colour')
        self.assertRefused(cprox('certify', '--dataset', self.manifest([self.row('a')]), '--out', out, '--shards', 3, '--shard', 3), '--shard')
        empty = self.certify(self.manifest([]), 'out')
        self.assertEqual((empty.code, empty.err), (2, 'warning: the input has no rows\n'))
        self.assertRefused(self.certify(self.manifest([self.row('a')]), 'robot.urdf'), '--out')
