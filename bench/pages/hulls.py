# SPDX-License-Identifier: BSD-3-Clause
"""hulls.md: the robots' meshes beside their hulls, from what bench/hulls.py left in the folder."""
import csv
import os

from pages.figures import microseconds, table


def read(out):
    path = os.path.join(out, 'hulls.csv')
    if not os.path.exists(path):
        return []
    with open(path, newline='') as text:
        return list(csv.DictReader(text))


def interval(lower, upper):
    """In millimetres, down to a nanometre."""
    return f'{1e3 * float(lower):.6f} – {1e3 * float(upper):.6f}'


def line(row):
    hull, mesh = (interval(row[f'{lod}_lower'], row[f'{lod}_upper']) for lod in ('hull', 'mesh'))
    pair = f"{row['mesh_a']}, {row['mesh_b']}"
    times = [float(row[f'{lod}_microseconds']) for lod in ('hull', 'mesh')]
    return [row['trajectory'], row['kind'], interval(row['reference_lower'], row['reference_upper']), hull, mesh, pair, *map(microseconds, times),
            f'{times[1] / times[0]:.1f}']


def page(out):
    rows = read(out)
    ratios = sorted(float(row['mesh_microseconds']) / float(row['hull_microseconds']) for row in rows)
    return f'''# Meshes beside their hulls

The least distance along the trajectories of `test/data`, at 1e-6 m, with every mesh as its convex hull and with the meshes themselves (`bench/hulls.py`).
The reference is another program's, certified on the hulls; intervals in millimetres. In the median the meshes cost {ratios[len(ratios) // 2]:.1f} times what the hulls cost.

{table(['trajectory', 'row', 'reference', 'hulls', 'meshes', 'nearest', 'hulls cost', 'meshes cost', 'ratio'], [line(row) for row in rows])}
'''
