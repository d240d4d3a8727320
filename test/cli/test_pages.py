# SPDX-License-Identifier: BSD-3-Clause
"""The commands of all pages: each runs, or stands in one table that says why not."""
import glob
import os
import re
import subprocess

from support import HERE, LIMIT, Case

ROOT = os.path.dirname(os.path.dirname(HERE))
PAGES = sorted(os.path.relpath(path, ROOT) for pattern in ('*.md', 'doc/**/*.md', 'examples/**/*.md', 'bench/**/*.md', 'test/**/*.md')
               for path in glob.glob(os.path.join(ROOT, pattern), recursive=True) if not path.endswith('doc/first-hour.md'))  # scripts/first_hour

NODE = 'needs a live node: the group ros asks one'
WORKSPACE = 'builds, installs or runs a workspace: scripts/test, and the groups install and demo, are such runs'
# What is not run, by how a command begins: why.
NOT_RUN = {
    'scripts/run cprox send': NODE, 'scripts/run roslaunch': NODE, 'scripts/run rosservice': NODE, 'scripts/run rosrun': NODE,
    'scripts/run /usr/bin/python3': 'an example that needs SciPy: the group python runs it',
    'scripts/setup': WORKSPACE, 'scripts/build': WORKSPACE, 'scripts/demo': WORKSPACE, 'scripts/test': WORKSPACE, 'scripts/moveit_beside': WORKSPACE,
    'scripts/debian': WORKSPACE, 'scripts/wheel': WORKSPACE, 'scripts/bench': 'takes minutes: the group bench reads what it writes',
}
PLUGINS = 'cprox constraints', 'scripts/run cprox constraints'


def commands(page):
    """(line, command) of each that begins with cprox or scripts/, indented or in a block between fences."""
    with open(os.path.join(ROOT, page)) as text:
        lines = text.read().split('\n')
    fenced, i = False, 0
    while i < len(lines):
        line, number = lines[i], i + 1
        i += 1
        if line.lstrip().startswith('```'):
            fenced = not fenced
            continue
        if not (fenced or line.startswith('    ')) or not re.match(r'(cprox|scripts/\w+)( |$)', line.strip()):
            continue
        command = line.strip()
        while (command.endswith('\\') or command.count('"') % 2) and i < len(lines):
            command = command.rstrip('\\') + (' ' if command.endswith('\\') else '\n') + lines[i].strip()
            i += 1
        yield number, command


class Pages(Case):
    def every_command_of_every_page_runs_or_says_why_not(self):
        os.mkdir(os.path.join(self.folder, 'bin'))
        os.symlink(os.environ['CPROX'], os.path.join(self.folder, 'bin', 'cprox'))
        path = os.path.join(self.folder, 'bin') + os.pathsep + os.environ['PATH']
        used, ran = set(), 0
        for page in PAGES:
            scratch = os.path.join(self.folder, page.replace('/', '_'))
            os.mkdir(scratch)
            for folder in ('examples', 'test', 'doc'):
                os.symlink(os.path.join(ROOT, folder), os.path.join(scratch, folder))
            for line, command in commands(page):
                with self.subTest(page=page, line=line, command=command):
                    reasons = [begin for begin in NOT_RUN if command == begin or command.startswith(begin + ' ')]
                    used.update(reasons)
                    script = re.match(r'scripts/\w+', command)
                    if script:
                        self.assertTrue(os.access(os.path.join(ROOT, script[0]), os.X_OK), 'there is no such script')
                    if reasons or (command.startswith(PLUGINS) and not os.environ['CPROX_NODE']):
                        continue
                    done = subprocess.run(['bash', '-c', re.sub(r'^scripts/run ', '', command).replace('/tmp/', scratch + '/')], cwd=scratch, env=dict(os.environ, PATH=path),
                                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=LIMIT)
                    self.assertIn(done.returncode, (0, 1, 3), done.stdout.decode())
                    ran += 1
        self.assertEqual(set(NOT_RUN) - used, set(), 'stands in the table, and on no page')
        self.assertGreater(ran, 20)
