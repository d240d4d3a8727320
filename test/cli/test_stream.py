# SPDX-License-Identifier: BSD-3-Clause
"""Many rows: order, threads, progress, and runs that are ended early."""
import os
import pty
import random
import select
import signal
import subprocess
import time

from support import BOX_SCENE, DATA, HEADER, Case, bezier, cprox

SHELF = DATA + '/scenes/mbm/bookshelf_thin_panda/scene0001.yaml'


def random_curves(n, seed, degree=7):
    """Curves among the shelves: control points in a cube of 2 m."""
    rng = random.Random(seed)
    return [bezier(f'c{i}', *[[rng.uniform(-1, 1) for _ in range(3)] for _ in range(degree + 1)]) for i in range(n)]


class Threads(Case):
    def answers_do_not_depend_on_the_number_of_threads(self):
        # seed 3, 400 curves, one row in ten spoilt: the bad rows stand in their places, too
        curves = random_curves(400, 3)
        curves[::10] = [row.replace(',bezier,', ',nurbs,') for row in curves[::10]]
        path = self.file('curves.csv', '\n'.join(curves))
        answers = [cprox('distance', '--curves', path, '--scene', SHELF, '--threads', n, *more)
                   for n in (1, 2, 7) for more in ((), ('--per-object',))]
        for answer in answers:
            self.assertEqual(answer.code, 2)
            self.assertEqual(answer.err, answers[0].err)
        for answer in answers[2::2]:
            self.assertEqual(answer.without_times(), answers[0].without_times())
        for answer in answers[3::2]:
            self.assertEqual(answer.without_times(), answers[1].without_times())
        self.assertEqual([row['id'] for row in answers[0].rows], [f'c{i}' for i in range(400)])

    def ten_thousand_curves_are_answered(self):
        path = self.file('curves.csv', '\n'.join(random_curves(10000, 5)))
        answer = cprox('distance', '--curves', path, '--scene', SHELF)
        self.assertEqual((answer.code, answer.err, len(answer.rows)), (0, '', 10000))
        self.assertEqual({row['status'] for row in answer.rows}, {'ok'})

    def ten_thousand_bad_rows_are_told(self):
        path = self.file('curves.csv', 'x,bezier\n' * 10000)
        answer = cprox('distance', '--curves', path, '--scene', SHELF)
        self.assertEqual((answer.code, len(answer.rows), answer.err.count('\n')), (2, 10000, 10001))


class Streams(Case):
    def start(self, *words, **how):
        process = subprocess.Popen([os.environ['CPROX'], *map(str, words)], **{'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE, **how})
        self.addCleanup(self.end, process)
        return process

    @staticmethod
    def end(process):
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout, process.stderr):
            if stream:
                stream.close()

    def results_come_while_rows_are_still_arriving(self):
        scene = self.file('scene.yaml', BOX_SCENE)
        process = self.start('distance', '--curves', '/dev/stdin', '--scene', scene, stdin=subprocess.PIPE)
        self.assertEqual(process.stdout.readline().decode(), HEADER + '\n')
        for i in range(3):
            process.stdin.write((bezier(f'c{i}', (3, -4, 0), (3, 4, 0)) + '\n').encode())
            process.stdin.flush()
            ready, _, _ = select.select([process.stdout], [], [], 20)
            self.assertTrue(ready, 'no row within 20 s')
            self.assertTrue(process.stdout.readline().decode().startswith(f'c{i},curve,ok,'))
        process.stdin.close()
        self.assertEqual(process.wait(20), 0)

    def interrupted(self, number):
        """Ends a run that would take long after its first rows; returns its exit code, rows and error messages."""
        path, out = self.file('curves.csv', '\n'.join(random_curves(100000, 9))), f'{self.folder}/r{number}.csv'
        process = self.start('distance', '--curves', path, '--scene', SHELF, '--epsilon', '1e-12', '--per-object', '--out', out)
        begin = time.monotonic()
        while not os.path.exists(out) or os.path.getsize(out) < 100000:
            self.assertLess(time.monotonic() - begin, 60, 'no rows within 60 s')
            time.sleep(0.01)
        process.send_signal(number)
        begin = time.monotonic()
        code = process.wait(20)
        self.assertLess(time.monotonic() - begin, 5)
        with open(out) as text:
            return code, text.read(), process.stderr.read().decode()

    def an_interrupt_keeps_the_rows_so_far(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            code, text, err = self.interrupted(number)
            lines = text.splitlines()
            self.assertEqual(code, 130)
            self.assertEqual(lines[0], HEADER)
            self.assertTrue(text.endswith('\n'))
            self.assertNotIn('stopped', text)
            self.assertIn('interrupted', err)

            # a beginning of the whole, without a gap: all objects of every curve
            ids = [line.split(',', 1)[0] for line in lines[1:]]
            distinct = list(dict.fromkeys(ids))
            self.assertEqual(distinct, [f'c{i}' for i in range(len(distinct))])
            self.assertEqual({ids.count(name) for name in distinct[:50]}, {ids.count('c0')})
            self.assertIn(f'the first {len(distinct)} rows', err)

    def a_killed_run_keeps_what_it_had(self):
        code, text, _ = self.interrupted(signal.SIGKILL)
        self.assertEqual(code, -signal.SIGKILL)
        self.assertTrue(text.endswith('\n'))
        self.assertGreater(len(text), 100000)

    def a_terminal_sees_progress_and_a_file_does_not(self):
        path = self.file('curves.csv', '\n'.join(random_curves(20000, 13)))
        master, slave = pty.openpty()
        process = self.start('distance', '--curves', path, '--scene', SHELF, '--per-object', '--out', self.folder + '/r.csv', stderr=slave)
        os.close(slave)
        seen = b''
        begin = time.monotonic()
        while b' rows, ' not in seen and time.monotonic() - begin < 60:
            try:
                seen += os.read(master, 4096)
            except OSError:  # the other side has ended
                break
        process.kill()
        os.close(master)
        self.assertRegex(seen, rb'\d+ rows, \d+ %')
