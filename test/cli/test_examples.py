# SPDX-License-Identifier: BSD-3-Clause
"""The examples, run as the README tells, their results held against the command line."""
import os
import re
import subprocess

from support import DATA, LIMIT, Case, cprox

PANDA = os.path.join(DATA, 'robots/panda/panda.urdf'), os.path.join(DATA, 'robots/panda/panda.srdf')
SHELF = os.path.join(DATA, 'scenes/mbm/bookshelf_thin_panda/scene0017.yaml')
INTO_SHELF = os.path.join(DATA, 'trajectories/panda_bookshelf_thin_0017_rrt.yaml')


class Ompl(Case):
    def plan(self, runs, out):
        self.assertTrue(os.environ.get('CPROX_EXAMPLE_OMPL'), 'example_ompl was not built: is OMPL installed?')
        done = subprocess.run([os.environ['CPROX_EXAMPLE_OMPL'], *PANDA, SHELF, INTO_SHELF, str(runs), out, '2000'],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=LIMIT, universal_newlines=True)
        self.assertEqual((done.returncode, done.stderr), (0, ''), done.stdout)
        return done.stdout

    def planned_paths_are_proven_clear_and_the_command_line_agrees(self):
        out = os.path.join(self.folder, 'path.yaml')
        self.assertRegex(self.plan(2, out), re.compile(r'^2 of 2 paths proven clear', re.M))
        asked = ('--robot', PANDA[0], '--srdf', PANDA[1], '--scene', SHELF, '--trajectory', out)
        self.assertEqual([row['verdict'] for row in cprox('tolerance', '--delta', '0.001', *asked).rows], ['clear'])
        self.assertEqual([(row['kind'], row['verdict']) for row in cprox('collision', *asked, '--self').rows],
                         [('environment', 'clear'), ('self', 'clear')])

    def what_cannot_be_read_is_named(self):
        done = subprocess.run([os.environ['CPROX_EXAMPLE_OMPL'], *PANDA, '/nowhere.yaml', INTO_SHELF],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=LIMIT, universal_newlines=True)
        self.assertEqual((done.returncode, done.stderr), (1, '/nowhere.yaml cannot be read\n'))
