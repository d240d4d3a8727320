# SPDX-License-Identifier: BSD-3-Clause
"""Runs cprox and reads what it says."""
import csv
import io
import os
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(os.path.dirname(os.path.dirname(HERE)), 'scripts'))
from free_port import free_port  # noqa: E402,F401 (for the test that starts a master)

DATA = os.path.join(os.path.dirname(HERE), 'data')
HEADER = ('id,kind,status,verdict,lower,upper,t,a_x,a_y,a_z,b_x,b_y,b_z,a,b,nodes,distance_queries,microseconds,t_b,lod,'
          'message')
NUMBERS = ('lower', 'upper', 't', 'a_x', 'a_y', 'a_z', 'b_x', 'b_y', 'b_z', 'nodes', 'distance_queries', 'microseconds', 't_b')
LIMIT = 120  # seconds for one call; a call that takes longer is a failure


class Answer:
    """What one call of cprox left: its exit code, its rows and its error messages."""

    def __init__(self, code, out, err):
        self.code, self.out, self.err = code, out, err
        self.rows = list(csv.DictReader(io.StringIO(out))) if out.startswith('id,') else []
        self.header = out.split('\n', 1)[0]

    def row(self, identifier, b=None):
        """The one row with this id (and this b)."""
        found = [row for row in self.rows if row['id'] == identifier and b in (None, row.get('b'))]
        if len(found) != 1:
            raise AssertionError(f'{len(found)} rows with id {identifier!r}, b {b!r}\n{self.out}\n{self.err}')
        return found[0]

    def code_of_verdicts(self):
        """The exit code that answered rows ask for: 1 where one is violated, 3 where one is undecided, else 0."""
        verdicts = {row['verdict'] for row in self.rows}
        return 1 if 'violated' in verdicts else 3 if 'undecided' in verdicts else 0

    def without_times(self):
        """The rows without the one column that differs from run to run."""
        return [{k: v for k, v in row.items() if k != 'microseconds'} for row in self.rows]


def cprox(*words, env=None, cwd=None):
    """Runs cprox to its end."""
    done = subprocess.run([os.environ['CPROX'], *map(str, words)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=LIMIT, cwd=cwd, env=dict(os.environ, **(env or {})))
    return Answer(done.returncode, done.stdout.decode(errors='replace'), done.stderr.decode(errors='replace'))


def bezier(identifier, *points, t0=0, t1=1, radius=0):
    """A row of CURVES.csv."""
    flat = [repr(float(x)) for point in points for x in point]
    return ','.join([identifier, 'bezier', str(len(points) - 1), str(t0), str(t1), str(radius), str(len(points)), *flat])


BOX_SCENE = '''
world:
  collision_objects:
    - id: box
      primitives: [{type: box, dimensions: [2, 2, 2]}]
      primitive_poses: [{position: [0, 0, 0], orientation: [0, 0, 0, 1]}]
'''

# passes the face x = 1 of the box at a distance of 2
PASSING = bezier('passing', (3, -4, 0), (3, 4, 0))


class Case(unittest.TestCase):
    """A test with a folder of its own."""

    maxDiff = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix='cprox-test-')
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def file(self, name, text):
        """Writes a file into the folder and returns its path."""
        path = os.path.join(self.folder, name)
        with open(path, 'wb') as out:
            out.write(text if isinstance(text, bytes) else text.encode())
        return path

    def ask(self, query_type, curves, scene, *more):
        """One of the queries about curves; `curves` and `scene` are the texts of the files."""
        lines = curves if isinstance(curves, str) else '\n'.join(curves) + '\n'
        return cprox(query_type, '--curves', self.file('curves.csv', lines), '--scene', self.file('scene.yaml', scene), *more)

    def pairs(self, text, *more):
        return cprox('pairs', '--in', self.file('pairs.yaml', text), *more)

    def assertAnswer(self, row, true, epsilon=1e-6, slack=1e-12):
        """The row's interval contains the true value and is no wider than epsilon.

        slack: the true value is a double that was computed here, 1e-12 is beyond its rounding at sizes of 1 to 10.
        """
        self.assertEqual(row['status'], 'ok', row)
        lower, upper = float(row['lower']), float(row['upper'])
        self.assertLessEqual(lower, true + slack, row)
        self.assertGreaterEqual(upper, true - slack, row)
        self.assertLessEqual(upper - lower, epsilon, row)

    def assertPoint(self, row, letter, point, tolerance=1e-5):
        for axis, value in zip('xyz', point):
            self.assertAlmostEqual(float(row[f'{letter}_{axis}']), value, delta=tolerance, msg=str(row))

    def assertRefused(self, answer, *words):
        """Exit code 2, nothing on standard output, one line on standard error that holds the words."""
        self.assertEqual(answer.code, 2, answer.err)
        self.assertEqual(answer.out, '')
        self.assertEqual(answer.err.count('\n'), 1, answer.err)
        for word in words:
            self.assertIn(word, answer.err)

    def assertFailedRow(self, answer, identifier, *words):
        """The row is there, invalid and without numbers, and a line on standard error holds the words."""
        row = answer.row(identifier)
        self.assertEqual(row['status'], 'invalid', row)
        self.assertEqual([row[name] for name in NUMBERS], [''] * len(NUMBERS), row)
        self.assertEqual(row['verdict'], '')
        lines = [line for line in answer.err.splitlines() if f"'{identifier}'" in line]
        self.assertEqual(len(lines), 1, answer.err)
        for word in words:
            self.assertIn(word, lines[0])
        self.assertEqual(answer.code, 2)
