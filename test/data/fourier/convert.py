#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the CSV files of this folder from the JSON files they come from: convert.py FOLDER_OF_JSON.

Rows: `case,id,N,kernel,beta,rho,L,threshold`, then its solids `solid,id,a|b,kind,numbers…` (already offset), then its poses
`pose,id,orientation and position of both, V, dV by position and rotation of both`. Spectra: `shape,name,n,x,y,…` (a convex piece)
and `wave,name,qx,qy,re,im`. Numbers are written as in the source, shortest decimal that gives the same double.
"""
import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))


def flat(x):
    return [v for y in x for v in flat(y)] if isinstance(x, list) else [x]


def write(name, rows, head):
    with open(os.path.join(HERE, name), 'w') as out:
        out.write(f'# {head}\n')
        for row in rows:
            out.write(','.join(v if isinstance(v, str) else repr(v) for v in flat(row)) + '\n')


def solids_2d(case, i):
    for key, side in (('S', 'a'), ('T', 'b')):
        for poly in case[f'{key}_offset_polys']:
            yield ['solid', str(i), side, 'polygon', len(poly), poly]
        disk = case[f'{key}_offset_disk']
        if disk:
            yield ['solid', str(i), side, 'disk', disk]


def solids_3d(case, i):
    for key, side in (('S', 'a'), ('T', 'b')):
        solid = case[f'{key}_offset']
        if solid['kind'] == 'mesh':
            yield ['solid', str(i), side, 'mesh', len(solid['vertices']), len(solid['triangles']), solid['vertices'],
                   solid['triangles']]
        else:
            yield ['solid', str(i), side, solid['kind'], solid['params']]


def cases(data, solids, fields):
    for i, case in enumerate(data['cases']):
        yield ['case', str(i), case['N'], case['kernel'], case['beta'], case['rho'], data['L'], case['threshold']]
        yield from solids(case, i)
        for pose in case['poses']:
            yield ['pose', str(i)] + [pose[f] for f in fields]


def main(folder):
    def load(name):
        with open(os.path.join(folder, name)) as source:
            return json.load(source)
    plane, space, spectra = load('fourier_2d.json'), load('fourier_3d.json'), load('fourier_spectrum_2d.json')
    write('gap_2d.csv', cases(plane, solids_2d, 'theta_S x_S theta_T x_T V dV_dxS dV_dthS dV_dxT dV_dthT'.split()),
          'gaps in the plane; see convert.py')
    write('gap_3d.csv', cases(space, solids_3d, 'R_S x_S R_T x_T V dV_dxS dV_dwS dV_dxT dV_dwT'.split()),
          'gaps in space; see convert.py')
    rows = [['shape', name, len(piece), piece] for name, shape in plane['shapes'].items() for piece in shape['pieces'] or []]
    for entry in spectra:
        for q, re, im in zip(entry['q'], entry['re'], entry['im']):
            rows.append(['wave', entry['shape'], q, re, im])
    write('spectrum_2d.csv', rows, 'spectra of bare shapes; see convert.py')


if __name__ == '__main__':
    main(sys.argv[1])
