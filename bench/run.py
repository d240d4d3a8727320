#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the bench programs, gathers their rows in results.csv, draws the charts, checks the targets. See scripts/bench."""
import argparse
import csv
import glob
import os
import subprocess
import sys

import charts
import targets

PREFIX = 'curve_proximity_bench_'
NOT_GROUPS = {'core', 'service'}  # Google benchmark's and the node's: no rows of results.csv
COLUMNS = ['group', 'workload', 'method', 'parameter', 'median_us', 'p95_us', 'nodes', 'probes', 'error', 'unsound', 'failures']


def programs(folder):
    """The groups that were built: name and program."""
    found = {os.path.basename(path)[len(PREFIX):]: path for path in glob.glob(os.path.join(folder, PREFIX + '*'))}
    return {name: path for name, path in sorted(found.items()) if name not in NOT_GROUPS and os.access(path, os.X_OK)}


def run_group(program, quick, out):
    """Runs one program; its rows go on to `out` as they come. Returns its exit code."""
    process = subprocess.Popen([program] + (['--quick'] if quick else []), stdout=subprocess.PIPE, text=True)
    for line in process.stdout:
        out.write(line)
        out.flush()
    return process.wait()


def read_results(path):
    with open(path, newline='') as text:
        return list(csv.DictReader(text))


def main():
    parser = argparse.ArgumentParser(prog='scripts/bench', description=__doc__)
    parser.add_argument('--programs', help=argparse.SUPPRESS)
    parser.add_argument('--out', required=True, help='folder for results.csv and the charts')
    parser.add_argument('--quick', action='store_true', help='smaller problems, fewer rounds: within five minutes')
    parser.add_argument('--only', action='append', metavar='GROUP', help='this group only; may be given more than once')
    parser.add_argument('--check', action='store_true', help='end with 1 where a target of bench/targets.csv is missed')
    arguments = parser.parse_args()

    groups = programs(arguments.programs)
    unknown = [name for name in arguments.only or [] if name not in groups]
    if unknown:
        parser.error(f"no group {', '.join(unknown)}; there are {', '.join(groups)}")
    os.makedirs(arguments.out, exist_ok=True)
    results = os.path.join(arguments.out, 'results.csv')
    failed = []
    with open(results, 'w') as out:
        out.write(','.join(COLUMNS) + '\n')
        for name in arguments.only or groups:
            print(f'{name} ...', file=sys.stderr)
            if run_group(groups[name], arguments.quick, out) != 0:
                failed.append(name)
    rows = read_results(results)
    drawn = charts.draw_all(rows, arguments.out)
    print(f'{len(rows)} rows in {results}, {len(drawn)} charts beside it')
    for name in failed:
        print(f'FAILED: group {name} ended with an error')
    missed = targets.report(rows, arguments.only) if arguments.check else 0
    return 1 if failed or missed else 0


if __name__ == '__main__':
    sys.exit(main())
