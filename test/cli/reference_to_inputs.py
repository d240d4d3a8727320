#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Turns the reference files into what cprox reads: reference_to_inputs.py REFERENCE_DIR OUT_DIR

curve_point, curve_polygon, curve3d and edge ask of each curve its distance to an obstacle of its own. A scene holds the
obstacles of up to BATCH rows of one accuracy, each under its row's id, so that `cprox distance --per-object` answers (among
others) the pairs that are asked for: those whose id equals b. OUT_DIR/NAME-K/ then holds curves.csv, scene.yaml and
expected.csv (id,d_ref,slack); OUT_DIR/NAME-K/epsilon is the accuracy asked, 1e-9 max(1, largest coordinate). slack is how
far the reference may be from the truth: it was computed in long double (16 * 2^-64 of the largest coordinate; offset_1e6 is
1.5e-13 off, as exact arithmetic shows), and a box that is written with a quaternion stands elsewhere by that one's rounding.

static_pairs.json becomes OUT_DIR/static_pairs/pairs.yaml and expected.csv (id,d_ref,kind,slack,scale): slack bounds by how
much writing the poses with quaternions moves the distance, scale is the largest coordinate.
"""
import csv
import json
import os
import sys

NAMES = ('curve_point', 'curve_polygon', 'curve3d', 'edge')
BATCH = 12
ULP = 2.0 ** -53


def rows_of(path):
    """The rows of a reference file: comments left out."""
    with open(path, newline='') as text:
        return [row for row in csv.reader(text) if row and not row[0].startswith('#')]


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, 'w') as out:
        out.write(text)


def points_of(values, dim):
    """Points in space, as they are written: planar ones lie at z = 0."""
    return [values[i:i + dim] + ['0'] * (3 - dim) for i in range(0, len(values), dim)]


def scale_of(numbers):
    return max(1.0, max(abs(float(x)) for x in numbers))


# ------------------------------------------------------------------------------------------------ rotations to quaternions
def quaternion_of(matrix):
    """x, y, z, w of a rotation matrix, by the largest component."""
    m = matrix
    trace = m[0][0] + m[1][1] + m[2][2]
    candidates = [trace, m[0][0], m[1][1], m[2][2]]
    k = candidates.index(max(candidates))
    if k == 0:
        q = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], 1 + trace]
    else:
        i, j, l = k - 1, k % 3, (k + 1) % 3
        q = [0.0] * 4
        q[i] = 1 + m[i][i] - m[j][j] - m[l][l]
        q[j] = m[i][j] + m[j][i]
        q[l] = m[i][l] + m[l][i]
        q[3] = m[l][j] - m[j][l]
    norm = sum(x * x for x in q) ** 0.5
    return [x / norm for x in q]


def matrix_of(q):
    """The rotation of a quaternion of any norm: 1 + (2/q.q)(w[v] + [v][v])."""
    x, y, z, w = q
    s = 2 / (x * x + y * y + z * z + w * w)
    return [[1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
            [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
            [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)]]


def rotation_error(matrix, q):
    """How far writing a matrix as a quaternion may move a point at unit distance: the largest row sum of the difference."""
    back = matrix_of(q)
    return max(sum(abs(a - b) for a, b in zip(row, other)) for row, other in zip(matrix, back)) + 8 * ULP


# ------------------------------------------------------------------------------------------------------- curves and scenes
def obstacle(identifier, vertices):
    """A collision object in YAML, the hull of the vertices."""
    kind = 'point' if len(vertices) == 1 else 'polytope'
    listed = ', '.join('[' + ', '.join(v) + ']' for v in vertices)
    return f'    - {{id: {identifier}, bodies: [{{type: {kind}, vertices: [{listed}]}}]}}\n'


def boxes_of(reference):
    """curve3d_boxmeta.csv: by id, the same obstacle as a box under a pose."""
    out = {}
    for row in rows_of(os.path.join(reference, 'curve3d_boxmeta.csv')):
        values = [float(x) for x in row[1:]]
        centre, rotation, half = values[:3], [values[3 + 3 * i:6 + 3 * i] for i in range(3)], values[12:]
        q = quaternion_of(rotation)
        slack = rotation_error(rotation, q) * sum(half) + 8 * ULP * scale_of(centre)
        text = (f'    - {{id: {row[0]}, primitives: [{{type: box, dimensions: {[2 * h for h in half]}}}], '
                f'primitive_poses: [{{position: {centre}, orientation: {q}}}]}}\n')
        out[row[0]] = (text, slack)
    return out


def convert_curves(name, reference, out, boxes=None):
    """One reference file into batches of one accuracy each; `boxes` puts boxes in the place of hulls."""
    expected = {row[0]: row[1] for row in rows_of(os.path.join(reference, name + '_ref.csv'))}
    groups = {}
    for row in rows_of(os.path.join(reference, name + '_inputs.csv')):
        identifier, dim, order, n = row[0], int(row[2]), int(row[3]), int(row[4])
        if boxes is not None and identifier not in boxes:
            continue
        values = row[5:]
        split = (order + 1) * dim
        assert len(values) == split + n * dim, identifier
        flat = [x for point in points_of(values[:split], dim) for x in point]
        curve = ','.join([identifier, 'bezier', str(order), '0', '1', '0', str(order + 1), *flat])
        text, slack = boxes[identifier] if boxes is not None else (obstacle(identifier, points_of(values[split:], dim)), 0.0)
        slack += 16 * 2.0 ** -64 * scale_of(values)
        groups.setdefault(1e-9 * scale_of(values), []).append((identifier, curve, text, expected[identifier], slack))

    number = 0
    for epsilon, rows in groups.items():
        for begin in range(0, len(rows), BATCH):
            batch = rows[begin:begin + BATCH]
            folder = os.path.join(out, f'{name}{"-box" if boxes is not None else ""}-{number}')
            number += 1
            write(folder + '/curves.csv', ''.join(curve + '\n' for _, curve, _, _, _ in batch))
            write(folder + '/scene.yaml', 'world:\n  collision_objects:\n' + ''.join(text for _, _, text, _, _ in batch))
            write(folder + '/expected.csv', 'id,d_ref,slack\n' + ''.join(f'{i},{d},{s!r}\n' for i, _, _, d, s in batch))
            write(folder + '/epsilon', repr(epsilon))


# ------------------------------------------------------------------------------------------------------------ static pairs
def body_of(side):
    """One side of a static pair: BODY in YAML, how far the rounding of its pose may move it, its largest coordinate."""
    kind, p, matrix = side['t'], side['p'], side['X']
    if kind == 'poly':
        shape, reach = f'type: polytope, vertices: {p}', max(sum(x * x for x in v) ** 0.5 for v in p)
    elif kind == 'box':
        shape, reach = f'type: box, dimensions: {p}', sum(x * x for x in p) ** 0.5 / 2
    elif kind == 'cyl':
        shape, reach = f'type: cylinder, dimensions: [{p[1]!r}, {p[0]!r}]', (p[0] ** 2 + p[1] ** 2 / 4) ** 0.5
    else:
        assert kind == 'sph', kind
        shape, reach = f'type: sphere, dimensions: {p}', p[0]
    position = [float(row[3]) for row in matrix]
    rotation = [[float(x) for x in row[:3]] for row in matrix]
    q = quaternion_of(rotation)
    slack = 0.0 if kind == 'sph' else rotation_error(rotation, q) * reach
    return f'{{{shape}, pose: {{position: {position}, orientation: {q}}}}}', slack, scale_of(position) + reach


def convert_pairs(reference, out):
    with open(os.path.join(reference, 'static_pairs.json')) as text:
        pairs = json.load(text)
    listed, expected = '', 'id,d_ref,kind,slack,scale\n'
    for entry in pairs:
        a, slack_a, scale_a = body_of(entry['a'])
        b, slack_b, scale_b = body_of(entry['b'])
        listed += f'- {{id: "{entry["id"]}", a: {a}, b: {b}}}\n'
        search = 1e-9 if 'search' in entry['method'] else 0.0  # references that come from a search are about 1e-10 true
        expected += f'{entry["id"]},{entry["ref"]},{entry["kind"]},{slack_a + slack_b + search!r},{max(scale_a, scale_b)!r}\n'
    write(os.path.join(out, 'static_pairs', 'pairs.yaml'), listed)
    write(os.path.join(out, 'static_pairs', 'expected.csv'), expected)


def convert(reference, out):
    for name in NAMES:
        convert_curves(name, reference, out)
    convert_curves('curve3d', reference, out, boxes_of(reference))
    convert_pairs(reference, out)


if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit('usage: reference_to_inputs.py REFERENCE_DIR OUT_DIR')
    convert(sys.argv[1], sys.argv[2])
