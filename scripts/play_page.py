#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Plays a page of tasks, such as doc/first-hour.md, as its reader would: play_page.py PAGE [TASK...]

A task is a heading `## N. …`. In it

    File `/tmp/first_hour/NAME`:    before a block between fences: the block is written to that file
    an indented block               commands, run by one bash that stops at the first error
    a block ```text                 lines that the commands before it print, perhaps within longer ones; … is anything

A block whose command is roslaunch runs until its task ends, once it has printed its lines. /tmp/first_hour is a folder
of its own. Prints a line a task with its seconds; the last line is `N passed, N failed`, a case being a task.
"""
import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from free_port import free_port

REPO = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FOLDER = '/tmp/first_hour'
LIMIT = 300  # [s] for a task
PATIENCE = 60  # [s] for the lines of what goes on running


class Wrong(Exception):
    """What the page says is not so."""


def steps(lines):
    """('file', path, text), ('run', commands) and ('print', lines) of a task, in their order."""
    i, said = 0, ''
    while i < len(lines):
        line = lines[i]
        if line.startswith('```'):
            end = lines.index('```', i + 1)
            block, named = lines[i + 1:end], re.search(r'File `([^`]+)`:$', said)
            if named:
                yield 'file', named[1], '\n'.join(block) + '\n'
            elif line == '```text':
                yield 'print', block
            else:
                raise Wrong(f'the block {block[0]!r} is no file, and not what a command prints')
            i, said = end, ''
        elif line.startswith('    '):
            end = next((k for k in range(i, len(lines)) if not lines[k].startswith('    ')), len(lines))
            yield 'run', '\n'.join(text[4:] for text in lines[i:end])
            i, said = end - 1, ''
        elif line:
            said = line
        i += 1


def tasks(page):
    """(number, title, lines) of each."""
    with open(page) as text:
        parts = re.split(r'^## (.+)\n', text.read(), flags=re.M)
    for heading, body in zip(parts[1::2], parts[2::2]):
        numbered = re.fullmatch(r'(\d+)\. (.+)', heading)
        if numbered:
            yield int(numbered[1]), numbered[2], body.split('\n')


def missing(wanted, printed):
    """The lines that were not printed."""
    return [line for line in wanted if not re.search('.*'.join(map(re.escape, line.strip().split('…'))), printed)]


class Player:
    """Runs the steps of one task."""

    def __init__(self, environment):
        self.environment, self.processes = environment, []
        self.deadline = time.monotonic() + LIMIT

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            for sign, patience in ((signal.SIGINT, 10), (signal.SIGKILL, 3)):
                try:
                    os.killpg(process.pid, sign)
                    process.wait(patience)
                except (ProcessLookupError, subprocess.TimeoutExpired):
                    pass

    def printed(self):
        self.log.seek(0)
        return self.log.read().decode(errors='replace')

    def wait_until(self, done):
        while not done() and time.monotonic() < self.deadline:
            time.sleep(0.05)

    def run(self, commands):
        self.log = tempfile.TemporaryFile()
        process = subprocess.Popen(['bash', '-e', '-o', 'pipefail', '-c', commands], cwd=REPO, env=self.environment,
                                   stdin=subprocess.DEVNULL, stdout=self.log, stderr=subprocess.STDOUT, start_new_session=True)
        self.processes.append(process)
        if re.match(r'(scripts/run )?roslaunch ', commands):
            return
        self.wait_until(lambda: process.poll() is not None)
        if process.poll() != 0:
            end = f'exit code {process.poll()}' if process.poll() is not None else f'no end within {LIMIT} s of the task'
            raise Wrong(f'{commands}\n{end}; it printed\n{self.printed()[-3000:]}')

    def compare(self, wanted):
        patience = time.monotonic() + PATIENCE
        self.wait_until(lambda: self.processes[-1].poll() is not None or not missing(wanted, self.printed()) or time.monotonic() > patience)
        absent = missing(wanted, self.printed())
        if absent:
            raise Wrong('not printed:\n' + '\n'.join(absent) + f'\nbut\n{self.printed()[-3000:]}')

    def play(self, kind, *words):
        if kind == 'run':
            self.run(*words)
        elif kind == 'print':
            self.compare(*words)
        else:
            with open(words[0], 'w') as out:
                out.write(words[1])


def main():
    parser = argparse.ArgumentParser(prog='scripts/first_hour')
    parser.add_argument('page')
    parser.add_argument('tasks', nargs='*', type=int, help='these alone, by their numbers')
    arguments = parser.parse_args()
    folder = tempfile.mkdtemp(prefix='first_hour.')
    environment = dict(os.environ, ROS_MASTER_URI=f'http://localhost:{free_port()}', ROS_HOSTNAME='localhost',
                       ROSCONSOLE_STDOUT_LINE_BUFFERED='1')
    listed = list(tasks(arguments.page))
    unknown = set(arguments.tasks) - {number for number, _, _ in listed}
    if unknown or not listed:
        parser.error(f'{arguments.page} has the tasks {[number for number, _, _ in listed]}')
    failed = played = 0
    try:
        for number, title, lines in listed:
            lines = [line.replace(FOLDER, folder) for line in lines]
            begin, wrong = time.monotonic(), ''
            wanted = not arguments.tasks or number in arguments.tasks
            try:
                with Player(environment) as player:
                    for kind, *words in steps(lines):
                        if wanted or kind == 'file':  # the files of all tasks are there for those behind them
                            player.play(kind, *words)
            except Wrong as error:
                wrong = str(error)
            if not wanted:
                continue
            played, failed = played + 1, failed + bool(wrong)
            print(f"{'FAILED' if wrong else 'ok'}: {number}. {title}: {time.monotonic() - begin:.1f} s", flush=True)
            if wrong:
                print(wrong, flush=True)
    finally:
        shutil.rmtree(folder)
    print(f'{played - failed} passed, {failed} failed')
    return 1 if failed else 0


if __name__ == '__main__':
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # what was started ends
    sys.exit(main())
