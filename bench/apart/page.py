#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes peers.csv and peers.md: ours beside libraries that scripts/bench_peers built.

    bench/apart/page.py RESULTS PEERS OUT [--quick]

RESULTS: the folder of bench/run.py. PEERS: a line for each peer: name, version, commit. OUT: where both files go."""
import csv
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..'))
import pages  # noqa: E402
import run  # noqa: E402
from pages.figures import table  # noqa: E402

METHODS = {'coal': 'coal', 'tight-inclusion': 'Tight-Inclusion'}
OURS, SCRATCH = 'curve_proximity', ' from scratch'
# Heading, group, workloads, what its times are divided by, columns after the query.
SECTIONS = [
    ('Distance of bodies apart', 'pairs', ['simple apart', 'apart'], 1, [OURS, 'FCL', 'coal']),
    ('Do bodies apart touch?', 'pairs', ['verdict simple apart', 'verdict apart'], 1, [OURS, 'FCL', 'coal']),
    ('Do bodies touch that overlap?', 'pairs', ['verdict simple overlapping', 'verdict overlapping'], 1, [OURS, 'FCL', 'coal']),
    ('A sequence of poses, for each pose', 'pairs', ['sequence of 100 poses'], 100,
     [OURS, OURS + SCRATCH, 'coal', 'coal' + SCRATCH]),
    ('Distance of meshes', 'pairs', ['meshes apart', 'meshes close'], 1, [OURS, 'FCL', 'coal']),
    ('Do meshes touch?', 'pairs', ['verdict meshes apart', 'verdict meshes close', 'verdict meshes crossing'], 1, [OURS, 'FCL', 'coal']),
    ('Do a vertex and a face, or two edges, meet in a step?', 'pairs', ['CCD miss', 'CCD hit'], 1, [OURS, 'Tight-Inclusion']),
]


def cell(row, divisor):
    """The time, and how many answers were wrong."""
    if row is None:
        return '–'
    microseconds = float(row['median_us']) / divisor
    time = f'{microseconds:.0f}' if microseconds >= 100.0 else f'{microseconds:.3g}'
    return f"{time} ({row['unsound']} wrong)" if int(row['unsound']) else time


def section(rows, heading, group, workloads, divisor, methods):
    by_key = {(row['workload'], row['parameter'], row['method']): row for row in rows if row['group'] == group}
    lines = []
    for workload in workloads:
        for parameter in dict.fromkeys(row['parameter'] for row in rows if (row['group'], row['workload']) == (group, workload)):
            kind = re.sub('verdict |CCD ', '', workload) if re.search('meshes|CCD', workload) else ''  # else the heading says it
            name = ', '.join(filter(None, [kind, re.sub(r' \d+ cases$', '', parameter)]))
            lines.append([name, *(cell(by_key.get((workload, parameter, method)), divisor) for method in methods)])
    return f"## {heading}\n\n{table(['query', *(m.replace(OURS, 'ours') for m in methods)], lines)}\n" if lines else ''


def main():
    results, peers, out, *quick = sys.argv[1:]
    rows = run.read_results(os.path.join(results, 'results.csv'))
    with open(peers) as text:
        found = {METHODS[name]: (version, commit) for name, version, commit in (line.split() for line in text)}
    ours = pages.commit_of(os.path.dirname(os.path.abspath(__file__)))
    with open(os.path.join(out, 'peers.csv'), 'w', newline='') as text:
        writer = csv.DictWriter(text, [*run.COLUMNS, 'version', 'commit'], lineterminator='\n')
        writer.writeheader()
        for row in rows:
            version, commit = found.get(row['method'].replace(SCRATCH, ''), ('', ours if row['method'].startswith(OURS) else ''))
            writer.writerow({**row, 'version': version, 'commit': commit})
    made = pages.how_made(' '.join(['scripts/bench_peers', *quick]), ours)
    names = ', '.join(f'{name} {version} ({commit})' for name, (version, commit) in found.items())
    sections = '\n'.join(filter(None, (section(rows, *one) for one in SECTIONS)))
    with open(os.path.join(out, 'peers.md'), 'w') as text:
        text.write(pages.wrapped(f'''# Beside {' and '.join(found)}

Ours beside {names}, which `scripts/bench_peers` builds from public source, and FCL of Debian. {made} [peers.csv](peers.csv) has every row.

Times are medians in microseconds; all methods answer the same problems in turns, in one process. Trust the ratios. "Wrong" counts, of ours, intervals without
the truth and wrong verdicts. Of the others, which give no interval, it counts wrong verdicts, distances that are off by more than a thousandth and 1e-9 of the sizes, and times of impact that are late.
coal runs by its defaults (GJK to 1e-6), Tight-Inclusion by what its authors suggest (tolerance 1e-6, 1e6 steps). Both are compiled by -O3.

{sections}'''))
    print(f'wrote peers.csv and peers.md in {out}')


if __name__ == '__main__':
    main()
