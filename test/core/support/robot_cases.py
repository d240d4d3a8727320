#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes robots, trajectories and scenes as plain numbers, which the core's tests and benches read (support/robot_case.c).

robot_cases.py DATA OUT: DATA holds robots/, scenes/, trajectories/ and expected_hull_model.json. OUT receives a file NAME.robot for
each robot (links, geometries, disabled pairs) and cases.txt (trajectories, scenes, expected answers); robots/ur5 and robots/panda_spheres have no case."""
import json
import math
import os
import struct
import sys
import xml.etree.ElementTree as ET

import yaml

TYPES = {'fixed': 0, 'revolute': 1, 'continuous': 1, 'prismatic': 2, 'planar': 3, 'floating': 4}


def numbers(text):
    return [float(x) for x in text.split()]


def pose_of(origin):
    """position and quaternion (w x y z) of a URDF origin"""
    xyz = numbers(origin.get('xyz', '0 0 0')) if origin is not None else [0, 0, 0]
    r, p, y = numbers(origin.get('rpy', '0 0 0')) if origin is not None else [0, 0, 0]
    cr, sr, cp, sp, cy, sy = (f(a / 2) for a in (r, p, y) for f in (math.cos, math.sin))
    return xyz + [cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                  cr * cp * sy - sr * sp * cy]


def stl_mesh(path, scale):
    """the vertices, each once, and the triangles"""
    data = open(path, 'rb').read()
    count = struct.unpack_from('<I', data, 80)[0]
    seen, triangles = {}, []
    for i in range(count):
        v = struct.unpack_from('<12f', data, 84 + 50 * i)
        corners = [tuple(a * s for a, s in zip(v[3 + 3 * k:6 + 3 * k], scale)) for k in range(3)]
        triangles.append([seen.setdefault(c, len(seen)) for c in corners])
    return list(seen), triangles


def shape_of(node, folder):
    """a body as text: box x y z | sphere r | cylinder height radius | mesh n m x y z ... i j k ..."""
    child = node[0]
    if child.tag == 'box':
        return 'box ' + child.get('size')
    if child.tag == 'sphere':
        return 'sphere ' + child.get('radius')
    if child.tag == 'cylinder':
        return 'cylinder %s %s' % (child.get('length'), child.get('radius'))
    path = child.get('filename').replace('file://', '')
    vertices, triangles = stl_mesh(os.path.join(folder, path), numbers(child.get('scale', '1 1 1')))
    return 'mesh %d %d %s %s' % (len(vertices), len(triangles), ' '.join(repr(x) for v in vertices for x in v),
                                 ' '.join(str(i) for t in triangles for i in t))


def text(values):
    return ' '.join(repr(float(v)) for v in values)


class Robot:
    def __init__(self, urdf, srdf, virtual):
        root = ET.parse(urdf).getroot()
        folder = os.path.dirname(urdf)
        joints = {j.find('child').get('link'): j for j in root.findall('joint')}
        self.variables, self.links, self.geometries, self.mimics = [], [], [], []
        order, todo = [], [l.get('name') for l in root.findall('link') if l.get('name') not in joints]
        while todo:
            name = todo.pop(0)
            order.append(name)
            todo += [c for c, j in joints.items() if j.find('parent').get('link') == name]
        self.order = order
        for name in order:
            self.add_link(name, joints.get(name), virtual)
        for name in order:
            link = next(l for l in root.findall('link') if l.get('name') == name)
            for c in link.findall('collision'):
                self.geometries.append('%d %s %s' % (order.index(name), text(pose_of(c.find('origin'))),
                                                     shape_of(c.find('geometry'), folder)))
        self.disabled = []
        if srdf:
            for d in ET.parse(srdf).getroot().findall('disable_collisions'):
                a, b = d.get('link1'), d.get('link2')
                if a in order and b in order:
                    self.disabled.append((order.index(a), order.index(b)))

    def add_link(self, name, joint, virtual):
        first = len(self.variables)
        if joint is None:
            kind = TYPES[virtual['type']] if virtual else 0
            if virtual:
                self.variables += virtual['joints']
            self.links.append('%s -1 %d %s 0 0 1 %d 1 0' % (name, kind, text(pose_of(None)), first))
            return
        parent = self.order.index(joint.find('parent').get('link'))
        kind, axis, mimic = TYPES[joint.get('type')], joint.find('axis'), joint.find('mimic')
        axis = numbers(axis.get('xyz')) if axis is not None else [1, 0, 0]
        multiplier, offset = 1.0, 0.0
        if mimic is not None and kind:
            first = self.variables.index(mimic.get('joint'))
            multiplier, offset = float(mimic.get('multiplier', 1)), float(mimic.get('offset', 0))
        elif kind:
            self.variables.append(joint.get('name'))
        self.links.append('%s %d %d %s %s %d %r %r' % (name, parent, kind, text(pose_of(joint.find('origin'))), text(axis),
                                                       first, multiplier, offset))

    def write(self, path):
        with open(path, 'w') as f:
            f.write('%d %d %d\n' % (len(self.links), len(self.variables), len(self.geometries)))
            f.write('\n'.join(self.links + self.geometries) + '\n')
            f.write('%d\n%s\n' % (len(self.disabled), '\n'.join('%d %d' % d for d in self.disabled)))


def objects_of(scene):
    """one line a shape: object id, pose, shape"""
    lines = []
    for o in scene['world']['collision_objects']:
        for shape, at in zip(o.get('primitives', []), o.get('primitive_poses', [])):
            q = at['orientation']
            kind = {1: 'box', 2: 'sphere', 3: 'cylinder'}.get(shape['type'], shape['type'])
            lines.append('%s %s %s %s' % (o['id'].replace(' ', '_'), text(at['position'] + [q[3]] + q[:3]), kind,
                                          text(shape['dimensions'])))
    return lines


def main():
    data, out = sys.argv[1:]
    cases = json.load(open(os.path.join(data, 'expected_hull_model.json')))['cases']
    written = {}
    with open(os.path.join(out, 'cases.txt'), 'w') as f:
        f.write('%d\n' % len(cases))
        for case in cases:
            t = yaml.safe_load(open(os.path.join(data, case['trajectory'])))
            name = os.path.splitext(os.path.basename(case['robot']))[0]
            if name not in written:
                srdf = case.get('srdf')
                written[name] = Robot(os.path.join(data, case['robot']), srdf and os.path.join(data, srdf),
                                      t.get('virtual_joint'))
                written[name].write(os.path.join(out, name + '.robot'))
            robot, j = written[name], t['joint_trajectory']
            f.write('%s %s\n' % (os.path.splitext(os.path.basename(case['trajectory']))[0], name))
            fixed = t.get('fixed_joints') or {}
            f.write(text(fixed.get(v, 0.0) for v in robot.variables) + '\n')
            f.write('%d %d\n%s\n' % (len(j['joint_names']), len(j['points']),
                                     ' '.join(str(robot.variables.index(n)) for n in j['joint_names'])))
            for p in j['points']:
                f.write('%s\n' % text([p['time_from_start']] + p['positions'] + p['velocities']))
            lines = objects_of(yaml.safe_load(open(os.path.join(data, case['scene']))))
            f.write('%d\n%s\n' % (len(lines), '\n'.join(lines)))
            f.write('%d\n' % len(case['results']))
            for r in case['results']:
                f.write('%s %r %r %r\n' % (r['kind'], r['lower'], r['upper'], r['sampled_min_step_0p001rad']))
    robots = os.path.join(data, 'robots')
    for urdf, srdf in (('ur5/ur5', 'ur5/ur5'), ('panda_spheres/panda_spheres', 'panda/panda')):
        robot = Robot(os.path.join(robots, urdf + '.urdf'), os.path.join(robots, srdf + '.srdf'), None)
        robot.write(os.path.join(out, os.path.basename(urdf) + '.robot'))


main()
