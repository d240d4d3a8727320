# SPDX-License-Identifier: BSD-3-Clause
"""Datasets of trajectories: manifests for `cprox certify`, and the table that `cprox merge` makes of its shards.

    python3 -m cprox.dataset manifest --robot arm.urdf --scene 'scenes/*.yaml' --trajectory trajectories/ --delta 0.02 > data.jsonl
    python3 -m cprox.dataset summary results.csv --csv histogram.csv --png histogram.png
    python3 -m cprox.dataset report results.csv --out report.html
    python3 -m cprox.dataset npz results.csv results.npz
    python3 -m cprox.dataset edges --robot arm.urdf --scene 'scenes/*.yaml' --roadmap roadmap.npz --delta 0.02 --out matrix.npz
"""
import argparse
import base64
import collections
import csv
import glob
import html
import io
import itertools
import json
import math
import os
import sys

import numpy as np

FLOATS = ('lower', 'upper', 't')
INTEGERS = ('row', 'nodes', 'distance_queries')
VERDICTS = ('clear', 'violated', 'undecided')
CLEAR, UNDECIDED = VERDICTS.index('clear'), VERDICTS.index('undecided')


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


# --------------------------------------------------------------------------------------------------- edges times scenes
def edge_matrix(robot, scenes, joints, vertices, edges, delta, self=False, progress=None, **options):
    """Every edge of a roadmap in every scene: a dict of bit matrices `clear` and `undecided`, uint8 (scenes, (m + 7) // 8) as
    numpy.packbits() makes them, with `scenes` (their files) and `edges` (m). Neither bit: violated.

    robot: a cprox.Robot. vertices (n, joints), edges (m, 2) of their rows; with self also the robot against itself, which is
    asked once for all scenes. A scene that cannot be read is undecided throughout, and `failed` (scenes,) says why.
    progress(scene, counts of verdicts) is called after each. options: those of cprox.edge_verdicts()."""
    import cprox
    m = len(edges)
    rows = {name: np.zeros((len(scenes), (m + 7) // 8), dtype=np.uint8) for name in ('clear', 'undecided')}
    failed = [''] * len(scenes)
    own = np.zeros(m, dtype=np.int8)
    if self:
        own = cprox.edge_verdicts(cprox.Scene(robot), joints, vertices, edges, delta, self_collision=True, **options)
    for i, path in enumerate(scenes):
        try:
            scene = cprox.Scene(robot)
            scene.load(path)
            verdicts = cprox.edge_verdicts(scene, joints, vertices, edges, delta, known=own, **options)
        except (ValueError, UserWarning) as error:
            failed[i] = str(error)
            verdicts = np.full(m, UNDECIDED, dtype=np.int8)
        rows['clear'][i] = np.packbits(verdicts == CLEAR)
        rows['undecided'][i] = np.packbits(verdicts == UNDECIDED)
        if progress:
            progress(path, np.bincount(verdicts, minlength=3))
    return {**rows, 'scenes': np.array(scenes, dtype=np.str_), 'edges': m, 'failed': np.array(failed, dtype=np.str_)}


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
    """As a picture, by Matplotlib. path: or a stream, for PNG."""
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


# ----------------------------------------------------------------------------------------------------------- report
PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>
body {{ font: 15px/1.5 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; color: #222; }}
table {{ border-collapse: collapse; margin: .5em 0 1.5em; }} th, td {{ border-bottom: 1px solid #ccc; padding: .2em .8em .2em 0; text-align: left; }}
td.number {{ text-align: right; font-variant-numeric: tabular-nums; }} img {{ max-width: 100%; }}
</style></head><body><h1>{title}</h1>
<h2>Lines</h2>{counts}<h2>Clearance</h2><p>{clearance}</p>{picture}
<h2>Nearest</h2>{nearest}<h2>Without a verdict or an answer</h2>{open}</body></html>
"""


def html_table(header, lines):
    def cell(value):
        number = isinstance(value, (int, float))
        return f'<td class="number">{value:,}</td>' if number else f'<td>{html.escape(str(value))}</td>'
    if not lines:
        return '<p>None.</p>'
    head = ''.join(f'<th>{html.escape(name)}</th>' for name in header)
    return f'<table><tr>{head}</tr>' + ''.join(f"<tr>{''.join(map(cell, line))}</tr>" for line in lines) + '</table>'


def report(table, title, bins=20, most=20):
    """One page of HTML that needs no other file: how many lines have which verdict and status, the histogram of the clearance,
    the lines that come nearest, and those that are undecided or have no answer; at most so many of either, and how many more."""
    edges, counts = histogram(table, bins)
    picture = io.BytesIO()
    draw_histogram(picture, edges, counts)
    lower, upper = table['lower'], table['upper']
    met = np.flatnonzero(np.isfinite(lower))
    nearest = met[np.argsort(upper[met], kind='stable')][:most]
    unsure = np.flatnonzero((table['verdict'] == 'undecided') | np.isin(table['status'], ('failed', 'missing')))
    beyond = f'<p>And {len(unsure) - most:,} more.</p>' if len(unsure) > most else ''

    def text(name, i):
        return str(table[name][i])
    return PAGE.format(
        title=html.escape(title), counts=html_table(('', 'lines'), [(name, n) for name, n in summary(table).items()]),
        clearance=f'Certified lower bounds of {len(met):,} lines that met something.' if len(met) else 'No line met anything.',
        picture=f'<img alt="histogram of the clearance" src="data:image/png;base64,{base64.b64encode(picture.getvalue()).decode()}">',
        nearest=html_table(('row', 'id', 'kind', 'verdict', 'at least [mm]', 'at most [mm]', 't', 'between', 'and'),
                           [(int(table['row'][i]), text('id', i), text('kind', i), text('verdict', i), f'{1e3 * lower[i]:.4f}',
                             f'{1e3 * upper[i]:.4f}', f"{table['t'][i]:.4g}", text('a', i), text('b', i)) for i in nearest]),
        open=html_table(('row', 'id', 'status', 'verdict', 'message'),
                        [(int(table['row'][i]), text('id', i), text('status', i), text('verdict', i), text('message', i))
                         for i in unsure[:most]]) + beyond)


# --------------------------------------------------------------------------------------------------------- command line
def certify_edges(asked):
    """The command `edges`. The file is whole or not there."""
    import cprox
    with np.load(asked.roadmap) as roadmap:
        missing = {'joints', 'vertices', 'edges'} - set(roadmap)
        if missing:
            raise ValueError(f'{asked.roadmap}: has no array {", ".join(sorted(missing))}')
        joints, vertices, edges = [str(joint) for joint in roadmap['joints']], roadmap['vertices'], roadmap['edges']

    def tell(path, counts):
        print(f'{path}: {", ".join(f"{n} {name}" for n, name in zip(counts, VERDICTS))}', file=sys.stderr)
    found = edge_matrix(cprox.Robot.from_urdf(asked.robot, asked.srdf), files(asked.scene), joints, vertices, edges, asked.delta,
                        asked.self, tell, threads=asked.threads)
    beside = asked.out + '.part'
    with open(beside, 'wb') as out:
        np.savez_compressed(out, **found)
    os.replace(beside, asked.out)
    for path, why in zip(found['scenes'], found['failed']):
        if why:
            print(f'cprox.dataset: {path}: {why}', file=sys.stderr)
    return 2 if any(found['failed']) else 0


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
    page = commands.add_parser('report', help='one page of HTML: counts, histogram, what comes nearest, what is open')
    page.add_argument('results')
    page.add_argument('--out', required=True, help='.html')
    arrays = commands.add_parser('npz', help='the columns as NumPy arrays')
    arrays.add_argument('results')
    arrays.add_argument('out')
    many = commands.add_parser('edges', help='edges of a roadmap in many scenes: a bit matrix of what is clear')
    many.add_argument('--robot', required=True)
    many.add_argument('--srdf')
    many.add_argument('--scene', nargs='+', required=True, help='files, folders or patterns')
    many.add_argument('--roadmap', required=True, help='.npz of joints (names), vertices (n, joints), edges (m, 2)')
    many.add_argument('--delta', type=float, required=True, help='[m]')
    many.add_argument('--self', action='store_true', help='the robot against itself, too')
    many.add_argument('--threads', type=int, default=0, help='0: one a processor')
    many.add_argument('--out', required=True, help='.npz')
    asked = parser.parse_args(words)
    try:
        if asked.command == 'edges':
            return certify_edges(asked)
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
        if asked.command == 'report':
            with open(asked.out, 'w', encoding='utf-8') as out:
                out.write(report(table, f'Dataset {os.path.basename(asked.results)}'))
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
