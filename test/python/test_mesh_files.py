#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Robots whose link is a mesh file of each format: the distance to a ball is that of a reader of this file
(NumPy, no code of the package), also in map coordinates. Truth: brute force over the triangles."""
import json
import os
import struct
import tempfile
import unittest
import warnings

import numpy as np

import cprox

CORNERS = np.array([[0, 0, 0], [1.1, 0.1, 0], [0.2, 0.9, 0.1], [0.3, 0.3, 1.2]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
RADIUS = 0.1
URDF = ('<robot name="r"><link name="base"/><link name="l"><collision><geometry><mesh filename="{}"/>'
        '</geometry></collision>'
        '</link><joint name="j" type="prismatic"><parent link="base"/><child link="l"/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>')
DAE = ('<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>'
       '<unit meter="{unit}"/><up_axis>{up}</up_axis></asset><library_geometries><geometry id="g"><mesh>'
       '<source id="p">'
       '<float_array id="a" count="12">{numbers}</float_array><technique_common>'
       '<accessor source="#a" count="4" stride="3">'
       '<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>'
       '</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
       '<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>{faces}</p></triangles>'
       '</mesh></geometry>'
       '</library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">'
       '<instance_geometry url="#g"/></node>'
       '</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>')


def lines(rows, start=''):
    return ''.join(start + ' '.join(repr(x) for x in row) + '\n' for row in rows.tolist())


# Each writes corners and returns the corners that the written numbers mean.
def obj(corners):
    text = '\ufeff' + lines(corners, 'v ') + lines(FACES + 1, 'f ')
    return text.encode(), np.array([row.split()[1:] for row in text[1:].splitlines()[:4]], float)


def stl(corners):
    text = '\n  \nSOLID a b\n'
    for face in FACES:
        text += 'FACET NORMAL 0 0 0\nOUTER LOOP\n' + lines(corners[face], 'VERTEX ') + 'ENDLOOP\nENDFACET\n'
    return (text + 'ENDSOLID\n').encode(), corners


def ply(corners):
    header = ('ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty double x\nproperty double y\n'
              'property double z\nelement face 4\nproperty list uchar ushort vertex_indices\nend_header\n')
    data = corners.astype('>f8').tobytes() + b''.join(struct.pack('>B3H', 3, *face) for face in FACES.tolist())
    return header.encode() + data, corners


def dae(corners, unit=0.0254, up='Y_UP'):
    numbers = ' '.join(repr(x / unit) for x in corners.ravel().tolist())
    text = DAE.format(unit=unit, up=up, numbers=numbers, faces=' '.join(map(str, FACES.ravel())))
    return text.encode(), np.array(numbers.split(), float).reshape(-1, 3) * unit


def glb(corners):
    """Floats about the origin, in millimetres, below a root node that turns and moves them."""
    middle = corners.mean(axis=0)
    turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.]])
    floats = ((corners - middle) @ turn * 1000).astype('<f4')
    gltf = {'asset': {'version': '2.0'}, 'scenes': [{'nodes': [0]}],
            'nodes': [{'children': [1], 'translation': middle.tolist(), 'scale': [.001] * 3,
                       'rotation': [0, 0, .5**.5, .5**.5]}, {'mesh': 0}],
            'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1}]}],
            'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3'},
                          {'bufferView': 1, 'componentType': 5123, 'count': 12, 'type': 'SCALAR'}],
            'bufferViews': [{'buffer': 0, 'byteLength': 48}, {'buffer': 0, 'byteOffset': 48, 'byteLength': 24}],
            'buffers': [{'byteLength': 72}]}
    text = json.dumps(gltf).encode()
    text += b' ' * (-len(text) % 4)
    binary = floats.tobytes() + FACES.astype('<u2').tobytes()
    chunks = struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(binary), b'BIN\0') + binary
    return b'glTF' + struct.pack('<II', 2, 12 + len(chunks)) + chunks, floats.astype(float) @ turn.T * .001 + middle


def to_segment(p, a, b):
    t = np.clip(np.dot(p - a, b - a) / np.dot(b - a, b - a), 0, 1)
    return np.linalg.norm(p - a - t * (b - a))


def to_triangle(p, a, b, c):
    n = np.cross(b - a, c - a)
    n /= np.linalg.norm(n)
    foot = p - np.dot(p - a, n) * n
    sides = [np.dot(np.cross(v - u, foot - u), n) for u, v in ((a, b), (b, c), (c, a))]
    if min(sides) >= 0:
        return abs(np.dot(p - a, n))
    return min(to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a))


def ask(folder, name, data, centre):
    """Lower, upper, and the warnings."""
    with open(os.path.join(folder, name), 'wb') as file:
        file.write(data)
    urdf, motion = os.path.join(folder, 'r.urdf'), os.path.join(folder, 't.yaml')
    with open(urdf, 'w') as file:
        file.write(URDF.format(name))
    with open(motion, 'w') as file:
        file.write('joint_trajectory: {joint_names: [j], points: [{positions: [0], time_from_start: 0}]}')
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter('always', UserWarning)
        scene = cprox.Scene(cprox.Robot.from_urdf(urdf))
        scene.add('ball', 'sphere', [RADIUS], pose=cprox.transform(centre.tolist()))
        result = cprox.Motion.from_file(scene, motion).distance()['result']
    return result.lower, result.upper, [str(w.message) for w in said if issubclass(w.category, UserWarning)]


class MeshFiles(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def expect(self, name, write, offset, rng):
        corners = CORNERS + offset
        centre = offset + CORNERS.mean(axis=0) + 2 * (lambda v: v / np.linalg.norm(v))(rng.normal(size=3))
        data, meant = write(corners)
        truth = min(to_triangle(centre - offset, *(meant[face] - offset)) for face in FACES) - RADIUS
        lower, upper, said = ask(self.folder.name, name, data, centre)
        rounding = 16 * np.finfo(float).eps * np.abs(corners).max()  # of this file's own arithmetic
        self.assertLessEqual(lower, truth + rounding, (name, offset))
        self.assertGreaterEqual(upper, truth - rounding, (name, offset))
        self.assertLess(upper - lower, 1e-5, (name, offset))
        return said

    def test_distances_are_those_of_the_coordinates_in_the_file(self):
        rng = np.random.default_rng(39)
        for offset in ([0, 0, 0], [6280000.3, -4649776.7, 1200.1]):
            for name, write in (('a.obj', obj), ('a.stl', stl), ('a.ply', ply), ('a.glb', glb),
                                ('a.dae', lambda corners: dae(corners, 1.0, 'Z_UP'))):
                for _ in range(3):
                    self.assertEqual(self.expect(name, write, np.array(offset), rng), [])

    def test_a_unit_is_honoured_and_said_and_axes_are_not_turned(self):
        rng = np.random.default_rng(40)
        for _ in range(2):  # the second time from the cache
            said = self.expect('a.dae', dae, np.zeros(3), rng)
            self.assertEqual(len(said), 1)
            self.assertIn("its unit is '0.0254' m", said[0])


if __name__ == '__main__':
    outcome = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromModule(__import__('__main__')))
    failed = len(outcome.failures) + len(outcome.errors)
    print(f'{outcome.testsRun - failed} passed, {failed} failed')
    raise SystemExit(failed > 0 or outcome.testsRun == 0)
