#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the bench programs, gathers their rows in results.csv, draws the charts, checks the targets. See scripts/bench."""
import argparse
import csv
import glob
import os
import shutil
import subprocess
import sys
import time

import charts
import pages
import passes
import repeat
import soundness
import targets

HERE = os.path.dirname(os.path.abspath(__file__))

PREFIX = 'curve_proximity_bench_'
NOT_GROUPS = {'core'}  # Google benchmark's: no rows of results.csv
# Groups that ask the command line or the Python package, where these are.
SCRIPTS = {'lod': 'lod.py', 'errors': 'errors.py', 'reactions': 'ros/reactions.py'}
TABLES = {'hulls.csv': 'hulls.py'}  # tables beside results.csv, of the command line too
MADE = 'made.txt'  # how the results came to be
PASSES, ROUNDS = 3, '3'
ONCE = {'ros', 'reactions', 'lod', 'errors', 'stability', 'optimise'}  # asked for counts, or too long: in the first pass only
LONG = {'fourier', 'implicit', 'robots', 'worlds'}  # these, too, where the run is to be quick
COLUMNS = ['group', 'workload', 'method', 'parameter', 'median_us', 'p95_us', 'nodes', 'distance_queries', 'error', 'unsound', 'failures']


def programs(folders):
    """The groups that can be run: name and command."""
    found = {os.path.basename(path)[len(PREFIX):]: [path] for folder in folders for path in glob.glob(os.path.join(folder, PREFIX + '*'))}
    found = {name: command for name, command in found.items() if name not in NOT_GROUPS and os.access(command[0], os.X_OK)}
    if shutil.which('cprox'):
        found.update({name: [sys.executable, os.path.join(HERE, script)] for name, script in SCRIPTS.items()})
    return dict(sorted(found.items()))


def run_tables(quick, out):
    """Each table into a file of its own. The names of the scripts that failed."""
    failed = []
    for name, script in TABLES.items():
        with open(os.path.join(out, name), 'w') as text:
            command = [sys.executable, os.path.join(HERE, script)] + (['--quick'] if quick else [])
            if subprocess.run(command, stdout=text).returncode != 0:
                failed.append(script)
    return failed


def run_group(command, flags, out):
    """Runs one program; its rows go on to `out` as they come. Returns its exit code."""
    process = subprocess.Popen(command + flags, stdout=subprocess.PIPE, text=True)
    for line in process.stdout:
        out.write(line)
        out.flush()
    return process.wait()


def read_results(path):
    with open(path, newline='') as text:
        return list(csv.DictReader(text))


def how_made(folder):
    with open(os.path.join(folder, MADE)) as text:
        return text.read().strip()


def measure(parser, arguments):
    """Runs the groups into results.csv, and notes how. The names of those that failed."""
    groups = programs(arguments.programs)
    unknown = [name for name in arguments.only or [] if name not in groups]
    if unknown:
        parser.error(f"no group {', '.join(unknown)}; there are {', '.join(groups)}")
    flags = ['--quick'] * arguments.quick + [f'--only {name}' for name in arguments.only or []] + ['--check'] * arguments.check
    with open(os.path.join(arguments.out, MADE), 'w') as text:
        text.write(pages.how_made(' '.join(['scripts/bench', *flags]), pages.commit_of(os.path.dirname(__file__))) + '\n')
    failed, files = [], []
    once = ONCE | LONG if arguments.quick else ONCE
    for number in range(PASSES):
        files.append(os.path.join(arguments.out, f'pass-{number + 1}.csv'))
        with open(files[-1], 'w') as out:
            out.write(','.join(COLUMNS) + '\n')
            for name in arguments.only or groups:
                if number == 0 or name not in once:
                    failed += [name] * (not timed_group(name, number, groups[name], arguments.quick, out))
    keep(files, arguments.out)
    if not arguments.only and shutil.which('cprox'):
        failed += run_tables(arguments.quick, arguments.out)
    return failed


def timed_group(name, number, command, quick, out):
    """One group of a pass, and how long it took. Whether it ended well."""
    print(f'pass {number + 1}, {name} ...', file=sys.stderr)
    begin = time.monotonic()
    flags = ['--quick'] if quick else [] if name in ONCE else ['--rounds', ROUNDS]
    code = run_group(command, flags, out)
    print(f'pass {number + 1}, {name}: {time.monotonic() - begin:.0f} s', file=sys.stderr)
    return code == 0


def keep(files, out):
    """The passes become one run; their own files have done their work."""
    measured = [read_results(path) for path in files]
    with open(os.path.join(out, 'results.csv'), 'w', newline='') as text:
        writer = csv.DictWriter(text, COLUMNS, lineterminator='\n')
        writer.writeheader()
        writer.writerows(passes.merge(measured))
    passes.write_spread(measured, out)
    for path in files:
        os.remove(path)


def main():
    parser = argparse.ArgumentParser(prog='scripts/bench', description=__doc__)
    parser.add_argument('--programs', action='append', help=argparse.SUPPRESS)
    parser.add_argument('--out', required=True, help='folder for results.csv and the charts')
    parser.add_argument('--quick', action='store_true', help='smaller problems, fewer rounds: within five minutes')
    parser.add_argument('--only', action='append', metavar='GROUP', help='this group only; may be given more than once')
    parser.add_argument('--pages', action='store_true', help='measure nothing: draw the charts and write the pages of DIR/results.csv again')
    parser.add_argument('--check', action='store_true', help='end with 1 where a target of bench/targets.csv is missed')
    parser.add_argument('--compare', metavar='OTHER', help="measure nothing: hold DIR's ratios and counts against another run's, in DIR/repeat.md")
    arguments = parser.parse_args()

    # Measure, unless an earlier run is to be looked at again.
    os.makedirs(arguments.out, exist_ok=True)
    earlier = arguments.pages or arguments.compare
    failed = [] if earlier else measure(parser, arguments)
    rows = read_results(os.path.join(arguments.out, 'results.csv'))
    made = how_made(arguments.out)
    drawn = charts.draw_all(rows, arguments.out, made)

    # Does another run say the same?
    differing = 0
    if arguments.compare:
        other = read_results(os.path.join(arguments.compare, 'results.csv'))
        differing = repeat.report(rows, other, (arguments.out, arguments.compare), (made, how_made(arguments.compare)))

    written = pages.write_all(rows, drawn, arguments.out, made)
    print(f"{len(rows)} rows in {arguments.out}/results.csv, {len(drawn)} charts and {', '.join(written)} beside it")
    for name in failed:
        print(f'FAILED: {name} ended with an error')
    missed = targets.report(rows, arguments.only) + soundness.report() if arguments.check else 0
    return 1 if failed or missed or differing else 0


if __name__ == '__main__':
    sys.exit(main())
