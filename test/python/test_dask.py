#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Datasets on Dask workers: nothing is lost, whatever is killed. And what is made of a table: arrays, histograms, manifests."""
import csv
import glob
import json
import os
import signal
import stat
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
CPROX = os.environ.get('CPROX', 'cprox')
ROWS, SHARDS, SEED = 60, 6, 3
sys.path.insert(0, HERE)

import cprox  # noqa: E402
import cprox_dask  # noqa: E402
import dataset_campaign  # noqa: E402


def table_of(folder):
    done = subprocess.run([CPROX, 'merge', folder], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if not done.stdout:
        raise AssertionError(done.stderr.decode())
    return done.stdout


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.manifest = os.path.join(cls.place.name, 'edges.jsonl')
        dataset_campaign.write_edges(cls.manifest, ROWS, SEED)
        alone = os.path.join(cls.place.name, 'alone')
        subprocess.run([CPROX, 'certify', '--dataset', cls.manifest, '--out', alone, '--threads', '1'], check=True)
        cls.truth = table_of(alone)

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def out(self):
        return os.path.join(self.place.name, self.id().rsplit('.', 1)[-1])


class Workers(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        from distributed import Client, LocalCluster
        cls.cluster = LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
        cls.client = Client(cls.cluster)

    @classmethod
    def tearDownClass(cls):
        cls.client.close()
        cls.cluster.close()
        super().tearDownClass()

    def program(self, before):
        """cprox, with lines of a shell before it that see the shard's number as $shard, and whether it is only marked."""
        path = self.out() + '.sh'
        with open(path, 'w') as script:
            script.write('#!/bin/sh\nshard=; marked=\nfor word; do\n'
                         '  [ "$last" != --shard ] || shard=$word\n  [ "$word" != --failed ] || marked=1\n  last=$word\ndone\n'
                         f'{before}\nexec "{CPROX}" "$@"\n')
        os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
        return path

    def test_a_shard_that_crashes_three_times_is_named_and_marked(self):
        told = []
        program = self.program(f'if [ "$shard" = 3 ] && [ -z "$marked" ]; then echo x >> {self.out()}.tries; kill -SEGV $$; fi')
        failures = cprox_dask.certify(self.client, self.manifest, self.out(), SHARDS, program, progress=lambda *done: told.append(done))
        self.assertEqual([(failure.shard, failure.attempts) for failure in failures], [(3, 3)])
        self.assertIn('signal 11', failures[0].message)
        with open(self.out() + '.tries') as tries:
            self.assertEqual(len(tries.readlines()), 3)
        self.assertEqual(told[-1], (SHARDS, SHARDS))
        lines, truth = table_of(self.out()).splitlines(), self.truth.splitlines()
        first, last = 1 + 3 * ROWS // SHARDS, 1 + 4 * ROWS // SHARDS
        self.assertEqual(lines[:first] + lines[last:], truth[:first] + truth[last:])
        for line in lines[first:last]:
            self.assertRegex(line.decode(), r'^\d+,edge\d+,,failed,.*given up after 3 attempts: signal 11')

    def test_a_shard_that_stalls_is_tried_again(self):
        once = self.out() + '.once'
        program = self.program(f'if [ "$shard" = 2 ] && [ ! -e {once} ]; then touch {once}; exec sleep 100; fi')
        failures = cprox_dask.certify(self.client, self.manifest, self.out(), SHARDS, program, timeout=20.0)
        self.assertEqual(failures, [])
        self.assertTrue(os.path.exists(once))
        self.assertEqual(table_of(self.out()), self.truth)

    def test_torn_and_lost_shards_alone_are_done_again(self):
        self.assertEqual(cprox_dask.certify(self.client, self.manifest, self.out(), SHARDS, CPROX), [])
        shards = sorted(glob.glob(os.path.join(self.out(), 'shard-*.csv')))
        before = [os.stat(path).st_mtime_ns for path in shards]
        os.remove(shards[1])
        os.truncate(shards[4], os.path.getsize(shards[4]) - 30)
        self.assertEqual(cprox_dask.certify(self.client, self.manifest, self.out(), SHARDS, CPROX), [])
        changed = [i for i, path in enumerate(shards) if os.stat(path).st_mtime_ns != before[i]]
        self.assertEqual(changed, [1, 4])
        self.assertEqual(table_of(self.out()), self.truth)

    def test_no_run_takes_up_a_task_of_another_one(self):
        with unittest.mock.patch.object(self.client, 'submit', wraps=self.client.submit) as submit:
            for _ in range(5):
                self.assertEqual(cprox_dask.certify(self.client, self.manifest, self.out(), 2, CPROX), [])
        keys = [call.kwargs['key'] for call in submit.call_args_list]
        self.assertEqual((len(keys), len(set(keys))), (10, 10))

    def test_a_disk_that_is_full_is_an_error_and_the_run_goes_on_later(self):
        """A limit of file sizes stands for the disk; test/python/dataset_faults.py fills a real one."""
        full = self.out() + '.full'
        program = self.program(f'[ "$shard" = 2 ] && [ -e {full} ] && trap "" XFSZ && ulimit -f 1')
        with open(full, 'w'):
            pass
        with self.assertRaisesRegex(RuntimeError, 'shard 2: exit code 2: .*writing failed: File too large; it cannot be marked'):
            cprox_dask.certify(self.client, self.manifest, self.out(), SHARDS, program)
        os.remove(full)
        self.assertEqual(cprox_dask.certify(self.client, self.manifest, self.out(), SHARDS, program), [])
        self.assertEqual(table_of(self.out()), self.truth)

    def test_another_worker_verifies_random_rows(self):
        self.client.run(sys.path.append, HERE)
        counts = dataset_campaign.recheck(self.client, self.manifest, self.truth.decode(), 6, SEED, CPROX)
        self.assertEqual(sum(counts.values()), 6)
        self.assertGreater(counts['clear'], 0)
        other = self.truth.replace(b',clear,', b',violated,')
        with self.assertRaisesRegex(RuntimeError, 'is violated in the table, clear on tcp'):
            dataset_campaign.recheck(self.client, self.manifest, other.decode(), 6, SEED, CPROX)

    def test_a_dataset_that_cannot_be_read_is_an_error(self):
        with self.assertRaisesRegex(RuntimeError, 'shard 0: exit code 2: .*none.jsonl.* cannot be marked'):
            cprox_dask.certify(self.client, os.path.join(self.place.name, 'none.jsonl'), self.out(), 1, CPROX, attempts=2)


class Cuts(Case):
    def test_any_number_of_workers_and_shards_gives_the_same_table(self):
        for workers, shards in ((1, 1), (4, 7)):
            out = f'{self.out()}-{workers}'
            self.assertEqual(dataset_campaign.certify_on_cluster(self.manifest, out, shards, workers, CPROX), ([], 0))
            self.assertEqual(table_of(out), self.truth)


class Killed(Case):
    def test_a_worker_killed_midway_loses_nothing(self):
        failures, killed = dataset_campaign.certify_on_cluster(self.manifest, self.out(), SHARDS, 2, CPROX, SHARDS // 2)
        self.assertEqual((failures, killed), ([], 1))
        self.assertEqual(table_of(self.out()), self.truth)

    def test_a_driver_killed_midway_is_resumed(self):
        command = [sys.executable, '-m', 'cprox_dask', self.manifest, '--out', self.out(), '--shards', str(ROWS), '--workers', '2',
                   '--cprox', CPROX]
        driver = subprocess.Popen(command, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        whole = os.path.join(self.out(), 'shard-*.csv')
        while len(glob.glob(whole)) < 3:
            self.assertIsNone(driver.poll())
            time.sleep(0.01)
        os.killpg(driver.pid, signal.SIGKILL)
        driver.wait()
        self.assertLess(len(glob.glob(whole)), ROWS)
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f'{ROWS} of {ROWS} shards', done.stderr)
        self.assertEqual(table_of(self.out()), self.truth)


class Tables(Case):
    def setUp(self):
        self.results = os.path.join(self.place.name, 'results.csv')
        with open(self.results, 'wb') as out:
            out.write(self.truth)

    def run_module(self, *words):
        return subprocess.run([sys.executable, '-m', 'cprox.dataset', *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True)

    def test_arrays_are_the_columns(self):
        out = os.path.join(self.place.name, 'results.npz')
        self.assertEqual(self.run_module('npz', self.results, out).returncode, 0)
        with open(self.results, newline='') as stream:
            lines = list(csv.DictReader(stream))
        with np.load(out) as arrays:
            self.assertEqual(arrays['row'].tolist(), list(range(ROWS)))
            self.assertEqual(arrays['verdict'].tolist(), [line['verdict'] for line in lines])
            self.assertEqual(arrays['lower'].tolist(), [float(line['lower']) for line in lines])
            self.assertEqual(arrays['nodes'].dtype, np.int64)

    def test_the_histogram_counts_every_row_once(self):
        bins, picture = os.path.join(self.place.name, 'bins.csv'), os.path.join(self.place.name, 'bins.png')
        done = self.run_module('summary', self.results, '--csv', bins, '--png', picture, '--bins', '7')
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(bins) as stream:
            lines = list(csv.DictReader(stream))
        self.assertEqual(len(lines), 7)
        for verdict in ('clear', 'violated'):
            n = self.truth.decode().count(f',{verdict},')
            self.assertGreater(n, 0)
            self.assertEqual(sum(int(line[verdict]) for line in lines), n)
            self.assertIn(f'{n} {verdict}', done.stdout)
        with open(picture, 'rb') as stream:
            self.assertEqual(stream.read(4), b'\x89PNG')

    def test_the_report_is_one_page_of_what_the_table_says(self):
        out = os.path.join(self.place.name, 'report.html')
        done = self.run_module('report', self.results, '--out', out)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(out, encoding='utf-8') as stream:
            page = stream.read()
        with open(self.results, newline='') as stream:
            lines = list(csv.DictReader(stream))
        nearest = min((line for line in lines if line['upper'] not in ('', 'inf')), key=lambda line: float(line['upper']))
        for words in (f'<td>lines</td><td class="number">{ROWS}</td>', f"<td>{nearest['id']}</td>", 'data:image/png;base64,', '<p>None.</p>'):
            self.assertIn(words, page)
        self.assertNotRegex(page, r'(src|href)="(?!data:)')
        broken = os.path.join(self.place.name, 'broken.csv')
        with open(broken, 'w') as stream:
            stream.write(','.join(lines[0]) + '\n0,<b>,,failed,,,,,,,,,,no <such> robot\n')
        self.assertEqual(self.run_module('report', broken, '--out', out).returncode, 0)
        with open(out, encoding='utf-8') as stream:
            page = stream.read()
        self.assertIn('no &lt;such&gt; robot', page)
        self.assertIn('No line met anything.', page)

    def test_edges_in_many_scenes_are_a_bit_matrix(self):
        scenes = sorted({scene for scene, _ in dataset_campaign.postures()})[:3]
        vertices = np.concatenate([np.array(saved[:4]) for _, saved in dataset_campaign.postures()[:3]])
        rng = np.random.default_rng(5)
        edges = rng.integers(0, len(vertices), (21, 2))
        roadmap, out = os.path.join(self.place.name, 'roadmap.npz'), os.path.join(self.place.name, 'matrix.npz')
        np.savez(roadmap, joints=dataset_campaign.JOINTS, vertices=vertices, edges=edges)
        panda = os.path.join(dataset_campaign.DATA, 'robots', 'panda', 'panda')
        words = ['--robot', panda + '.urdf', '--srdf', panda + '.srdf', '--roadmap', roadmap, '--delta', '0.01', '--out', out, '--scene']
        done = self.run_module('edges', *words, *scenes, '--self')
        self.assertEqual(done.returncode, 0, done.stderr)
        with np.load(out) as matrix:
            self.assertEqual((matrix['scenes'].tolist(), int(matrix['edges'])), (scenes, 21))
            self.assertEqual(matrix['clear'].dtype, np.uint8)
            clear, undecided = (np.unpackbits(matrix[name], axis=1, count=21) for name in ('clear', 'undecided'))
        robot = cprox.Robot.from_urdf(panda + '.urdf', panda + '.srdf')
        seen = set()
        for i, path in enumerate(scenes):
            scene = cprox.Scene(robot)
            scene.load(path)
            for k, (a, b) in enumerate(edges):
                motion = cprox.Motion(scene, dataset_campaign.JOINTS, [0, 1], vertices[[a, b]])
                verdicts = [motion.tolerance(0.01, self_collision=own)['result'].verdict for own in (False, True)]
                expected = 'clear' if verdicts == ['clear'] * 2 else verdicts[1] if verdicts[1] != 'clear' else verdicts[0]
                told = 'clear' if clear[i, k] else 'undecided' if undecided[i, k] else 'violated'
                self.assertEqual(told, expected, (path, k))
                seen.add(told)
        self.assertLessEqual({'clear', 'violated'}, seen)

        bad = os.path.join(self.place.name, 'bad.yaml')
        with open(bad, 'w') as stream:
            stream.write('world: [')
        done = self.run_module('edges', *words, bad, scenes[0])
        self.assertEqual(done.returncode, 2)
        self.assertIn(f'cprox.dataset: {bad}: ', done.stderr)
        with np.load(out) as matrix:
            row = matrix['scenes'].tolist().index(bad)  # rows are sorted by their files, wherever those are
            self.assertTrue(np.unpackbits(matrix['undecided'][row], count=21).all())
            self.assertFalse(matrix['clear'][row].any())
            self.assertEqual([bool(why) for why in matrix['failed']], [i == row for i in range(2)])
        np.savez(roadmap, joints=dataset_campaign.JOINTS, vertices=vertices)
        done = self.run_module('edges', *words, scenes[0])
        self.assertEqual((done.returncode, done.stderr), (2, f'cprox.dataset: {roadmap}: has no array edges\n'))

    def test_no_table_is_an_error(self):
        done = self.run_module('npz', self.manifest, os.path.join(self.place.name, 'no.npz'))
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r'^cprox.dataset: .*edges.jsonl: is no table of cprox merge')

    def test_a_manifest_has_every_trajectory_with_every_scene(self):
        examples = os.path.join(os.path.dirname(os.path.dirname(HERE)), 'examples', 'formats')
        folder = os.path.join(self.place.name, 'paths')
        os.makedirs(folder)
        for name in ('a', 'b'):
            os.symlink(os.path.join(examples, 'trajectory.yaml'), os.path.join(folder, name + '.yaml'))
        manifest = os.path.join(self.place.name, 'product.jsonl')
        done = self.run_module('manifest', '--robot', examples + '/arm.urdf', '--srdf', examples + '/arm.srdf', '--scene', examples + '/scen?.yaml',
                               '--trajectory', folder, '--delta', '0.05', '--self', '--relative-to', self.place.name)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual([row['id'] for row in rows], ['scene:paths/a', 'scene:paths/b'])
        self.assertEqual(rows[0]['trajectory'], 'paths/a.yaml')
        with open(manifest, 'w') as out:
            out.write(done.stdout)
        subprocess.run([CPROX, 'certify', '--dataset', manifest, '--out', self.out()], check=True)
        answers = list(csv.DictReader(table_of(self.out()).decode().splitlines()))
        self.assertEqual([line['status'] for line in answers], ['ok'] * 4)
        done = self.run_module('manifest', '--robot', 'r', '--trajectory', folder + '/none*')
        self.assertEqual((done.returncode, done.stderr), (2, f'cprox.dataset: {folder}/none*: names no file\n'))

    def test_the_public_problems_become_edges(self):
        """Those of them that test/data has, laid out as VAMP lays out all of them."""
        data, resources, out = dataset_campaign.DATA, os.path.join(self.place.name, 'resources'), os.path.join(self.place.name, 'problems')
        panda = os.path.join(resources, 'panda')
        os.makedirs(panda + '/problems')
        for name in ('panda.urdf', 'panda.srdf', 'meshes'):
            os.symlink(os.path.join(data, 'robots', 'panda', name), os.path.join(panda, name))
        os.symlink(os.path.join(data, 'scenes', 'mbm', 'box_panda'), panda + '/problems/box_panda')
        script = os.path.join(os.path.dirname(os.path.dirname(HERE)), 'examples', 'datasets', 'public_problems.py')
        done = subprocess.run([sys.executable, script, resources, out], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual((done.returncode, done.stderr), (0, "6 edges; 0 problems have no goal that is a posture of the start's joints\n"))
        with open(os.path.join(out, 'edges.jsonl')) as stream:
            rows = [json.loads(line) for line in stream]
        self.assertEqual([row['id'] for row in rows], [f'box_panda/{number}/{kind}' for number in ('0001', '0017', '0042') for kind in ('straight', 'smoothed')])
        ends = [[row['trajectory']['joint_trajectory']['points'][i]['positions'] for i in (0, -1)] for row in rows[:2]]
        self.assertEqual(ends[0], ends[1])
        self.assertEqual((ends[0][0][1], ends[0][1][1]), (-0.785, 1.7628))
        subprocess.run([CPROX, 'certify', '--dataset', os.path.join(out, 'edges.jsonl'), '--out', self.out()], check=True)
        answers = list(csv.DictReader(table_of(self.out()).decode().splitlines()))
        self.assertEqual([line['status'] for line in answers], ['ok'] * 6)


if __name__ == '__main__':
    program = unittest.main(exit=False, verbosity=2)
    result = program.result
    bad = len(result.failures) + len(result.errors) + len(result.skipped)
    print(f'{max(result.testsRun - bad, 0)} passed, {bad} failed')
    sys.exit(1 if bad or not result.testsRun else 0)
