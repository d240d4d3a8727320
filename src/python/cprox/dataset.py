# SPDX-License-Identifier: BSD-3-Clause
"""Datasets of trajectories: manifests for `cprox certify`, and the table that `cprox merge` makes of its shards.

    python3 -m cprox.dataset manifest --robot arm.urdf --scene 'scenes/*.yaml' --trajectory trajectories/ --delta 0.02 > data.jsonl
    python3 -m cprox.dataset summary results.csv --csv histogram.csv --png histogram.png
    python3 -m cprox.dataset npz results.csv results.npz
"""
import argparse
import collections
import csv
import glob
import itertools
import json
import math
import os
import sys

import numpy as np

FLOATS = ('lower', 'upper', 't')
INTEGERS = ('row', 'nodes', 'distance_queries')
VERDICTS = ('clear', 'violated', 'undecided')


# ------------------------------------------------------------------------------------------------------------ manifests
def files(patterns, endings=('.yaml', '.yml', '.json')):
    """The files that patterns name, sorted, each once: a pattern is a file, a folder (all files in it with these endings), or
    has *, ? or ** for what glob.glob() finds. ValueError where one names none."""
    found = []
    for pattern in patterns:
        if os.path.isdir(pattern):
            these = [path for ending in endings for path in glob.glob(os.path.join(glob.escape(pattern), '*' + ending))]
        else:
            these = [path for path in glob.glob(pattern, recursive=True) if os.path.isfile(path)]
        if not these:
            raise ValueError(f'{pattern}: names no file')
        found += these
    return sorted(set(found))


def manifest(robot, scenes, trajectories, srdf=None, query=None, delta=None, self=False, relative_to='.'):
    """The rows of a manifest, each a dict: every trajectory with every scene, scene by scene. Paths become relative to the
    folder in which the manifest will stand. No scenes: each trajectory once, without one."""
    names = ['/'.join(os.path.splitext(os.path.normpath(path))[0].split(os.sep)[-2:]) for path in trajectories]
    rows = []
    for scene, (path, name) in itertools.product(list(scenes) or [None], zip(trajectories, names)):
        row = {'id': name if scene is None else f'{os.path.splitext(os.path.basename(scene))[0]}:{name}',
               'robot': os.path.relpath(robot, relative_to), 'trajectory': os.path.relpath(path, relative_to)}
        for key, value in (('srdf', srdf), ('scene', scene)):
            if value is not None:
                row[key] = os.path.relpath(value, relative_to)
        row.update((key, value) for key, value in (('query', query), ('delta', delta)) if value is not None)
        if self:
            row['self'] = True
        rows.append(row)
    return rows


# -------------------------------------------------------------------------------------------------------------- results
def read(path):
    """The columns of a table of `cprox merge`, by name: arrays with an entry a line. Numbers that a line does not have are NaN,
    and -1 where they are integers. ValueError where the file is no such table."""
    with open(path, newline='') as stream:
        lines = csv.reader(stream)
        header = next(lines, [])
        if not {'row', 'id', 'status', 'verdict', *FLOATS, *INTEGERS} <= set(header):
            raise ValueError(f'{path}: is no table of cprox merge: its first line is {",".join(header)!r}')
        columns = [[] for _ in header]
        for line in lines:
            if len(line) != len(header):
                raise ValueError(f'{path}:{lines.line_num}: has {len(line)} fields, the header {len(header)}')
            for column, field in zip(columns, line):
                column.append(field)

    def array(name, fields):
        if name in FLOATS:
            return np.array([float(field or 'nan') for field in fields], dtype=np.float64)
        if name in INTEGERS:
            return np.array([int(field or -1) for field in fields], dtype=np.int64)
        return np.array(fields, dtype=np.str_)
    return {name: array(name, fields) for name, fields in zip(header, columns)}


def histogram(table, bins=20):
    """How the clearance of the answered rows is distributed: the edges [m], one more than bins, and for each verdict ('' where
    none was asked for) the number of rows whose lower bound lies in each bin. The last bin holds what is above the 99th
    percentile, too. Rows that met nothing have no clearance and are left out."""
    lower = table['lower']
    finite = np.isfinite(lower)
    if not finite.any():
        return np.zeros(bins + 1), {}
    most = float(np.quantile(lower[finite], 0.99)) or float(lower[finite].max()) or 1.0
    edges = np.linspace(min(0.0, float(lower[finite].min())), most, bins + 1)
    counts = {}
    for verdict in sorted(set(table['verdict'][finite].tolist())):
        chosen = np.minimum(lower[finite & (table['verdict'] == verdict)], edges[-1])
        counts[verdict] = np.histogram(chosen, edges)[0]
    return edges, counts


def summary(table):
    """Counts of lines: of all, by verdict, by status."""
    verdicts, statuses = collections.Counter(table['verdict'].tolist()), collections.Counter(table['status'].tolist())
    counts = {'lines': len(table['row']), **{verdict: verdicts[verdict] for verdict in VERDICTS}}
    return {**counts, **{status: statuses[status] for status in sorted(statuses)}}


def write_histogram(path, edges, counts):
    """As CSV: a line a bin."""
    with open(path, 'w', newline='') as stream:
        out = csv.writer(stream, lineterminator='\n')
        out.writerow(['from', 'to', *[verdict or 'distance' for verdict in counts]])
        for i in range(len(edges) - 1 if counts else 0):
            out.writerow([repr(float(edges[i])), repr(float(edges[i + 1])), *[int(rows[i]) for rows in counts.values()]])


def draw_histogram(path, edges, counts, title=''):
    """As a picture, by Matplotlib."""
    import matplotlib
    matplotlib.use('Agg')
    import matplotlib.pyplot as pyplot
    colours = {'clear': '#2a7', 'violated': '#c33', 'undecided': '#e90', '': '#47a'}
    figure, axes = pyplot.subplots(figsize=(7, 4))
    below = np.zeros(max(len(edges) - 1, 0))
    for verdict, rows in counts.items():
        axes.bar(1e3 * edges[:-1], rows, 1e3 * np.diff(edges), bottom=below, align='edge', label=verdict or 'distance',
                 color=colours.get(verdict), edgecolor='white', linewidth=0.4)
        below = below + rows
    axes.set(xlabel='certified lower bound of the clearance [mm]', ylabel='rows', title=title)
    if counts:
        axes.legend()
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    pyplot.close(figure)


# --------------------------------------------------------------------------------------------------------- command line
def main(words=None):
    parser = argparse.ArgumentParser(prog='python3 -m cprox.dataset', description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest='command', required=True)
    make = commands.add_parser('manifest', help='print a manifest, JSON Lines: every trajectory with every scene')
    make.add_argument('--robot', required=True)
    make.add_argument('--srdf')
    make.add_argument('--scene', nargs='*', default=[], help='files, folders or patterns')
    make.add_argument('--trajectory', nargs='+', required=True, help='files, folders or patterns')
    make.add_argument('--query', choices=('distance', 'tolerance', 'collision'))
    make.add_argument('--delta', type=float, help='of tolerance [m]')
    make.add_argument('--self', action='store_true', help='the robot against itself, too')
    make.add_argument('--relative-to', default='.', help='the folder in which the manifest will stand')
    tell = commands.add_parser('summary', help='counts by verdict and status; a histogram of the clearance')
    tell.add_argument('results')
    tell.add_argument('--csv', help='the histogram, a line a bin')
    tell.add_argument('--png', help='the histogram as a picture')
    tell.add_argument('--bins', type=int, default=20)
    arrays = commands.add_parser('npz', help='the columns as NumPy arrays')
    arrays.add_argument('results')
    arrays.add_argument('out')
    asked = parser.parse_args(words)
    try:
        if asked.command == 'manifest':
            if asked.delta is not None and not (math.isfinite(asked.delta) and asked.delta >= 0.0):
                raise ValueError('--delta must be at least 0')
            for row in manifest(asked.robot, files(asked.scene), files(asked.trajectory), asked.srdf, asked.query, asked.delta,
                                asked.self, asked.relative_to):
                print(json.dumps(row))
            return 0
        table = read(asked.results)
        if asked.command == 'npz':
            np.savez_compressed(asked.out, **table)
            return 0
        if asked.bins < 1:
            raise ValueError('--bins must be at least 1')
        counts = summary(table)
        print(', '.join(f'{n} {name}' for name, n in counts.items()))
        edges, bins = histogram(table, asked.bins)
        if asked.csv:
            write_histogram(asked.csv, edges, bins)
        if asked.png:
            draw_histogram(asked.png, edges, bins, f"{counts['lines']} lines of {os.path.basename(asked.results)}")
        return 0
    except (ValueError, OSError) as error:
        print(f'cprox.dataset: {error}', file=sys.stderr)
        return 2


if __name__ == '__main__':
    sys.exit(main())
