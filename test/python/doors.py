#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Inputs with one element broken, held against a model that says what must not be 'clear' (doc/coverage.md).

    scripts/soundness --family doors --size 100000 --seed 1
    scripts/run test/python/doors.py SIZE SEED [--case N] [--seconds S]

A case is a set of valid files. One element of one file is removed, doubled, renamed, misplaced, put out of range, or a second
document comes after the file. Where the model (door_model.py) does not accept what is left, no door may say 'clear' of it; what
it accepts must not be 'clear' where the distance in closed form is 0, and no lower bound may exceed that distance. Valid files
must be 'clear', without a warning, where nothing is near. Most cases go through one query of Python, in turn; every tenth
through the command line, whose exit code counts; robots go through `certify` and `merge` in batches. The families:

    robots   a ball on two slides, perhaps a ball on its base: URDF, SRDF, trajectory, scene with an allowed collision matrix
    meshes   the same beside a box from a file: OBJ, STL, DAE with a unit
    curves   rows of CSV;  paths   a nav_msgs/Path;  pairs   entries of `cprox pairs`

Prints a line for each wrong case, then `N passed, N failed`."""
import argparse
import copy
import csv
import json
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
import warnings

import cprox
import cprox.dataset

import door_model as model
from door_model import NULL, Invalid, Map, text_of, xml_of

CLOSE = 1e-5  # [m] nearer to the limit than this a verdict may be undecided
WORDS = ('objects', 'primitive', 'posiion', 'pose_', 'scale', 'unit', 'x', 'joint', 'offset')
WRONG = ('.nan', '.inf', '-.inf', '1e999', 'none', '"1 m"', '1,5', '--1', NULL, [1.0], Map())
CLI_EVERY, BATCH = 10, 40


# --------------------------------------------------------------------------------------------------------- valid inputs
def numbers(r, n, reach, least=None):
    return [round(r.uniform(-reach if least is None else least, reach), 3) for _ in range(n)]


def make_place(r, reaches):
    position = [round(r.uniform(-1, 1) * reach, 3) for reach in reaches]
    return Map([('position', Map(zip('xyz', position)) if r.random() < 0.5 else position)])


def make_scene(r):
    objects = []
    for i in range(r.randint(1, 3)):
        is_box = r.random() < 0.5
        shape = Map([('type', 1 if is_box else 2), ('dimensions', numbers(r, 3 if is_box else 1, .4, .05))])
        entry = Map([('id', f'thing{i}'), ('primitives', [shape]), ('primitive_poses', [make_place(r, (1.2, 1.2, 0.4))])])
        if r.random() < 0.3:
            entry.insert(0, ('header', Map([('frame_id', 'world')])))
        if r.random() < 0.3:
            entry.append(('pose', Map([('position', numbers(r, 3, .2))])))
        objects.append(entry)
    root = Map([('name', 'room'), ('world', Map([('collision_objects', objects)]))])
    if r.random() < 0.3:
        first, second = r.sample(['tip', 'base', 'thing0', 'thing1'], 2)
        value = r.choice(('true', 'false'))
        matrix = Map([('entry_names', [first, second]), ('entry_values', [['false', value], [value, 'false']])])
        if r.random() < 0.3:
            matrix += [('default_entry_names', [r.choice(('tip', 'thing0', 'thing1'))]), ('default_entry_values', ['true'])]
        root.append(('allowed_collision_matrix', matrix))
    return [root]


def make_trajectory(r):
    points = []
    for i in range(r.randint(1, 4)):
        moment = Map([('secs', i), ('nsecs', 0)]) if r.random() < 0.5 else float(i)
        points.append(Map([('positions', numbers(r, 2, 1)), ('time_from_start', moment)]))
    way = Map([('header', Map([('frame_id', 'world')])), ('joint_names', ['right', 'ahead']), ('points', points)])
    return [Map([('joint_trajectory', way)])]


def make_path(r):
    poses = []
    for i in range(r.randint(2, 4)):
        pose = make_place(r, (1, 1, 0))
        pose.append(('orientation', [0, 0, 0, 1]))
        header = Map([('stamp', Map([('secs', i), ('nsecs', 0)])), ('frame_id', 'world')])
        poses.append(Map([('header', header), ('pose', pose)]))
    return [Map([('header', Map([('frame_id', 'world')])), ('poses', poses)])]


def make_pairs(r):
    out = []
    for i in range(3):
        sides = []
        for kind in (2, r.choice((1, 2))):
            sides.append(Map([('type', ('box', 'sphere')[kind - 1]), ('dimensions', numbers(r, 1 if kind == 2 else 3, .5, .1)),
                              ('pose', make_place(r, (1, 1, 1)))]))
        out.append(Map([('id', f'pair{i}'), ('a', sides[0]), ('b', sides[1])]))
    return [out]


def make_robot(post):
    def slide(name, parent, child, axis):
        return ['joint', [('name', name), ('type', 'prismatic')],
                [['parent', [('link', parent)], []], ['child', [('link', child)], []], ['axis', [('xyz', axis)], []],
                 ['limit', [('lower', '-2'), ('upper', '2'), ('effort', '1'), ('velocity', '1')], []]]]

    def ball(at='0 0 0'):
        geometry = ['geometry', [], [['sphere', [('radius', str(model.RADIUS))], []]]]
        return ['collision', [], [['origin', [('xyz', at)], []], geometry]]

    return ['robot', [('name', 'ball')],
            [['link', [('name', 'base')], [ball(' '.join(map(str, model.POST)))] if post else []],
             ['link', [('name', 'slide')], []],
             ['link', [('name', 'tip')], [ball(), ['visual', [], [ball()[2][1]]]]],
             slide('right', 'base', 'slide', '1 0 0'), slide('ahead', 'slide', 'tip', '0 1 0')]]


def make_srdf(r):
    pairs = [['disable_collisions', [('link1', 'base'), ('link2', 'slide'), ('reason', 'Adjacent')], []]]
    if r.random() < 0.5:
        pairs.append(['disable_collisions', [('link1', 'tip'), ('link2', 'base'), ('reason', 'Never')], []])
    return ['robot', [('name', 'ball')], pairs]


CORNERS = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7),
         (1, 7, 3)]
DAE = ('<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="{}"/>'
       '<up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="24">{}'
       '</float_array><technique_common><accessor source="#a" count="8" stride="3"><param name="X" type="float"/><param name="Y" '
       'type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input '
       'semantic="POSITION" source="#p"/></vertices><triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>{}</p>'
       '</triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">'
       '<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>'
       '</COLLADA>')


def obj_lines(corners):
    return [f'v {" ".join(map(repr, corner))}' for corner in corners] + [f'f {a + 1} {b + 1} {c + 1}' for a, b, c in FACES]


def stl_lines(corners):
    out = ['solid box']
    for face in FACES:
        out += ['facet normal 0 0 0', 'outer loop'] + [f'vertex {" ".join(map(repr, corners[i]))}' for i in face]
        out += ['endloop', 'endfacet']
    return out + ['endsolid box']


# ------------------------------------------------------------------------------------------------------ what is broken
def lists_in(value):
    """All maps and lists of a tree that hold something."""
    out = [value] if isinstance(value, list) and value else []
    for one in value if isinstance(value, list) else ():
        out += lists_in(one[1] if isinstance(value, Map) else one)
    return out


def typo(r, word):
    i = r.randrange(len(word))
    changed = r.choice((word[:i] + word[i + 1:], word[:i] + word[i] + word[i:], word + 's', word.upper(), r.choice(WORDS)))
    return changed if changed not in ('', word) else word + '_'


def break_yaml(r, documents, make):
    if r.random() < 0.15:
        documents.append(make(r)[0])
        return 'second document'
    holders = lists_in(documents[0])
    holder, what = r.choice(holders), r.choice(('remove', 'double', 'rename', 'misplace', 'range', 'again'))
    i = r.randrange(len(holder))
    is_map = isinstance(holder, Map)
    if what == 'remove':
        del holder[i]
    elif what == 'double':
        holder.insert(r.randrange(len(holder) + 1), holder[i])
    elif what == 'again' and is_map:
        holder.append((holder[i][0], copy.deepcopy(r.choice(holders))))
    elif what == 'rename' and is_map:
        holder[i] = (typo(r, holder[i][0]), holder[i][1])
    elif what == 'misplace' and is_map:
        maps = [one for one in holders if isinstance(one, Map) and one is not holder]
        pair = holder.pop(i)
        if maps:
            r.choice(maps).append(pair)
    else:
        what, wrong = 'range', copy.deepcopy(r.choice(WRONG))
        holder[i] = (holder[i][0], wrong) if is_map else wrong
    return what


def break_xml(r, root):
    """What was done, and whether it can change the distance: equal elements of a link, and what is in harmless ones, cannot."""
    elements = []

    def walk(element, harmless):
        elements.append((element, harmless or element[0] in model.HARMLESS))
        for child in element[2]:
            walk(child, elements[-1][1] if element[0] in model.HARMLESS else harmless)

    walk(root, False)
    what = r.choice(('rename', 'attribute', 'double', 'unknown', 'value'))
    element, harmless = r.choice(elements)
    i = r.randrange(max(1, len(element[1])))
    if what == 'attribute' and element[1]:
        element[1][i] = (typo(r, element[1][i][0]), element[1][i][1])
    elif what == 'value' and element[1]:
        element[1][i] = (element[1][i][0], r.choice(('nan', '', 'x', '1e999', '0 0', '0,0,0')))
        harmless = harmless or element is root
    elif what == 'unknown':
        element[2].append([r.choice(('xacro:hand', 'capsule', 'collison', 'quaternion', 'include')), [('parent', 'tip')], []])
    elif what == 'double' and element[2]:
        child = r.choice(element[2])
        harmless = harmless or child[0] in model.HARMLESS + ('collision',)
        element[2].append(child)
    else:
        what = 'rename'
        harmless = harmless and element[0] not in model.HARMLESS
        element[0] = typo(r, element[0])
    return what, harmless


def break_lines(r, lines):
    """One line of a text, or one word of it."""
    i, what = r.randrange(len(lines)), r.choice(('remove', 'double', 'word', 'cut', 'swap', 'again'))
    words = lines[i].split()
    k = r.randrange(len(words))
    if what == 'remove':
        del lines[i]
    elif what == 'double':
        lines.insert(r.randrange(len(lines) + 1), lines[i])
    elif what == 'word':
        words[k] = r.choice(('nan', '1e999', 'x', typo(r, words[k]), '99', '-1', '0.5'))
        lines[i] = ' '.join(words)
    elif what == 'cut':
        del words[k]
        lines[i] = ' '.join(words) or '#'
    elif what == 'swap':
        lines.append(lines.pop(i))
    else:
        lines += lines[:]  # a second solid; vertices and faces again
    return what


# ----------------------------------------------------------------------------------------------------------- the doors
def write(folder, name, text):
    with open(os.path.join(folder, name), 'w', encoding='utf-8') as file:
        file.write(text)


def documents_text(documents):
    return '\n---\n'.join(map(text_of, documents))


def of_dict(answer):
    return answer['result'].verdict == 'clear', answer['result'].lower


def of_lower(answer):
    return answer['result'].lower > 0, answer['result'].lower


def least_of(lower):
    least = min(lower, default=math.nan)
    return bool(least > 0), least


def profile_of(motion, self):
    t0, t1 = motion.domain
    if not t0 < t1:
        return of_dict(motion.collision(self_collision=self))
    return least_of(motion.profile([t0, (t0 + t1) / 2, t1], self_collision=self)['lower'])


def rows_of(motion, self):
    found = motion.rows(1e3, self_collision=self)
    if not len(found['lower']) and not found['gap']:
        raise ValueError('nothing moves: there are no rows')
    return (False, None) if found['gap'] else least_of(found['lower'])


def proof_of(motion, self):
    answer = motion.certificate(0.0, self_collision=self)
    return answer['claim'] == 'apart', answer['result'].lower


def violations_of(found):
    return not found, None


PYTHON = {
    'collision': lambda m, self: of_dict(m.collision(self_collision=self)),
    'tolerance': lambda m, self: of_dict(m.tolerance(0.0, self_collision=self)),
    'distance': lambda m, self: of_lower(m.distance(self_collision=self)),
    'signed distance': lambda m, self: of_lower(m.distance(self_collision=self, signed=True)),
    'time of contact': lambda m, self: (of_dict(m.time_of_contact(self_collision=self))[0], None),
    'violations': lambda m, self: violations_of(m.violations(0.0, self_collision=self)),
    'profile': profile_of,
    'nearest pairs': lambda m, self: least_of([one['result'].lower for one in m.nearest_pairs(self_collision=self)]),
    'gradient': lambda m, self: of_lower(m.gradient(self_collision=self)),
    'rows': rows_of,
    'certificate': proof_of,
}
MOVERS = {
    'movers': lambda m, against: of_dict(m.collision(against=against)),
    'movers, distance': lambda m, against: of_lower(m.distance(against=against)),
    'movers, violations': lambda m, against: violations_of(m.violations(0.0, against=against)),
    'movers, pairs': lambda m, against: least_of([one['result'].lower for one in m.nearest_pairs(against=against)]),
    'movers, gradients': lambda m, against: of_lower(m.gradients(against=against)),
}


def ask_python(r, folder):
    """The door, is it about the robot itself, what it says: (clear, lower) or None where there is an error; the warnings."""
    door, self = r.choice([*PYTHON, *MOVERS, 'edges']), r.random() < 0.3
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter('always')
        try:
            srdf = os.path.join(folder, 'robot.srdf')
            robot = cprox.Robot.from_urdf(os.path.join(folder, 'robot.urdf'), srdf=srdf if os.path.exists(srdf) else None)
            scene = cprox.Scene(robot)
            scene.load(os.path.join(folder, 'scene.yaml'))
            motion = cprox.Motion.from_file(scene, os.path.join(folder, 'way.yaml'))
            if door == 'edges':
                try:
                    places = [[one[i][0, 3] if i == 0 else one[i][1, 3] for i in range(2)] for one in
                              ([motion.link_poses(t)['tip']] * 2 for t in motion.domain)]
                except KeyError:
                    raise ValueError('the tip has another name') from None
                verdicts = cprox.edges(scene, ['right', 'ahead'], [places[0]], [places[1]], 0.0, self_collision=self)
                return door, self, (bool(verdicts[0] == 0), None), said
            if door in MOVERS:
                movers = cprox.Movers(scene, {'one': motion})
                return door, self, MOVERS[door](movers, 'movers' if self else 'others'), said
            return door, self, PYTHON[door](motion, self), said
        except (ValueError, RuntimeError) as error:
            if str(error).startswith('nothing moves'):
                door += ' of nothing'
            return door, self, None, said


def run(program, folder, *words):
    done = subprocess.run([program, *words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


VERDICTS = (['collision'], ['tolerance', '--delta', '0'], ['time-of-contact'], ['violations', '--delta', '0'],
            ['report', '--delta', '0', '--out', 'report.html'], ['tolerance', '--delta', '0', '--per-link'])
MEASURES = (['distance'], ['profile', '--intervals', '2'], ['nearest'])


class Case:
    """One case: what it is, the truth (None: not accepted), is it whole, and what is wrong with what a door says."""

    def __init__(self, kind, whole, texts):
        self.kind, self.whole, self.texts = kind, whole, texts

    def judge(self, door, truth, said, remarks=()):
        """said: (clear, lower) or None for an error."""
        self.kind += f' | {door}'
        clear, lower = said or (False, None)
        at = f'{self.kind}: {"error" if said is None else "clear" if clear else "not clear"}, truth {truth}\n  ' + \
             '\n  '.join(self.texts) + '\n  '
        if clear and (truth is None or not truth > 0 or math.isinf(truth)):
            return at + 'clear of ' + ('what the model does not accept' if truth is None else 'a contact' if truth < 1 else 'nothing')
        if lower is not None and truth is not None and lower > max(truth, 0) + 1e-9 and not math.isinf(truth):
            return at + f'lower is {lower}'
        if not self.whole or truth is None or math.isinf(truth) or 'of nothing' in door:
            return ''
        if said is None:
            return at + 'a valid input is refused'
        if truth > CLOSE and not clear:
            return at + 'a valid input is not clear'
        return at + f'a valid input is read with a warning: {remarks}' if remarks else ''

    def judge_code(self, door, truth, code, errors, measures=False):
        """Of a command: 0 says clear, of a measure that all is answered."""
        if measures and truth is not None and not math.isinf(truth) and not truth > CLOSE:
            return ''
        remarks = [line for line in errors.splitlines() if 'warning' in line]
        return self.judge(door, truth, None if code == 2 else (code == 0, None), remarks)


def robot_case(r, folder, program):
    post = r.random() < 0.5
    scene, way, robot = make_scene(r), make_trajectory(r), make_robot(post)
    srdf = make_srdf(r) if r.random() < 0.5 else None
    kind, harmless = r.choice(('whole', 'scene', 'scene', 'way', 'way', 'robot', 'srdf')), True
    if kind == 'srdf' and not srdf:
        kind = 'whole'
    whole = kind == 'whole'
    if kind == 'scene':
        kind += ' ' + break_yaml(r, scene, make_scene)
    elif kind == 'way':
        kind += ' ' + break_yaml(r, way, make_trajectory)
    elif kind == 'robot':
        what, harmless = break_xml(r, robot)
        kind += ' ' + what
    elif kind == 'srdf':
        kind += ' ' + break_xml(r, srdf)[0]
    texts = {'scene.yaml': documents_text(scene), 'way.yaml': documents_text(way), 'robot.urdf': xml_of(robot)}
    if srdf:
        texts['robot.srdf'] = xml_of(srdf)
    elif os.path.exists(os.path.join(folder, 'robot.srdf')):
        os.remove(os.path.join(folder, 'robot.srdf'))
    for name, text in texts.items():
        write(folder, name, text)
    truth = truth_self = None
    try:
        if harmless:
            places, seen = model.trajectory_of(way), model.scene_of(scene)
            truth = model.truth_of(places, seen, post)
            truth_self = model.truth_of_self(places, seen, post, model.disabled_of(srdf) if srdf else ())
    except Invalid:
        pass
    case = Case('robots: ' + kind, whole, texts.values())
    if program:
        words = ['--robot', 'robot.urdf', '--scene', 'scene.yaml', '--trajectory', 'way.yaml'] + (['--srdf', 'robot.srdf'] if srdf else [])
        measures = r.random() < 0.3
        command = r.choice(MEASURES if measures else VERDICTS)
        if not measures and command[0] in ('collision', 'tolerance') and '--per-link' not in command and r.random() < 0.3:
            words.append('--self')
            truth = min(truth, truth_self) if truth is not None and not math.isinf(truth_self) else None
        code, _, errors = run(program, folder, *command, *words)
        return case.judge_code('cprox ' + command[0], truth, code, errors, measures), None
    door, self, said, remarks = ask_python(r, folder)
    whole_truth = truth
    if door == 'edges' and kind.startswith('way'):  # edges are not from the file
        said = None
    if door == 'edges' and truth is not None:  # from the first to the last posture, and with it the robot itself
        ends = [places[0], places[-1]]
        truth = model.truth_of(ends, seen, post)
        if self:
            own = model.truth_of_self(ends, seen, post, model.disabled_of(srdf) if srdf else ())
            truth = None if math.isinf(max(own, truth)) else min(truth, own)  # one of them measures nothing
        self = False
    asked = truth_self if self else truth
    row = {'robot': 'robot.urdf', 'scene': 'scene.yaml', 'trajectory': 'way.yaml', 'query': r.choice(('collision', 'distance'))}
    if srdf:
        row['srdf'] = 'robot.srdf'
    again = (case.kind, whole, texts, row, whole_truth)
    return case.judge(door + (' of itself' if self else ''), asked, said, [str(one.message) for one in remarks]), again


def mesh_case(r, folder, program):
    reach, solid = round(r.uniform(.2, .8), 2), r.choice(('true', 'false'))
    form, unit = r.choice(('obj', 'stl', 'dae')), 1.0
    corners = [[(x - .5) * reach for x in corner] for corner in CORNERS]
    kind, whole = r.choice(('whole', 'broken', 'broken')), False
    name = f'box.{form}'
    at = numbers(r, 2, 1) + [round(r.uniform(-.3, .3), 3)]
    entry = Map([('id', 'mesh'), ('meshes', [Map([('resource', name), ('solid', solid)])]), ('pose', Map([('position', at)]))])
    scene, way = [Map([('world', Map([('collision_objects', [entry])]))])], make_trajectory(r)
    mesh = None
    try:
        if form == 'dae':
            unit = r.choice((1.0, .01, 2.0))
            corners = [[x / unit for x in corner] for corner in corners]
            words = {'unit': repr(unit), 'points': [repr(x) for corner in corners for x in corner],
                     'faces': [str(i) for face in FACES for i in face]}
            if kind != 'whole':
                which = r.choice(('unit', 'points', 'faces'))
                if which == 'unit':
                    words['unit'] = r.choice(('', 'x', '0', '-1', 'nan', 'inf', '1e999'))
                else:
                    words[which][r.randrange(len(words[which]))] = r.choice(('x', '', 'nan', '1e999', '1.5.2') + (('99', '-1'), ())[which == 'points'])
                kind = 'dae ' + which
            text = DAE.format(words['unit'], ' '.join(words['points']), ' '.join(words['faces']))
            if kind == 'whole':
                mesh = model.Mesh('box.obj', obj_lines(corners), unit)
                mesh.name = name
        else:
            lines = (obj_lines if form == 'obj' else stl_lines)(corners)
            if kind != 'whole':
                kind = f'{form} ' + break_lines(r, lines)
            text = '\n'.join(lines) + '\n'
            mesh = model.Mesh(name, lines)
        whole = kind == 'whole'
        write(folder, name, text)
        places = model.trajectory_of(way)
        truth = model.truth_of(places, model.scene_of(scene, mesh), False)
    except Invalid:
        truth = None
    write(folder, name, text)
    write(folder, 'scene.yaml', documents_text(scene))
    write(folder, 'way.yaml', documents_text(way))
    write(folder, 'robot.urdf', xml_of(make_robot(False)))
    if os.path.exists(os.path.join(folder, 'robot.srdf')):
        os.remove(os.path.join(folder, 'robot.srdf'))
    case = Case('meshes: ' + kind, whole, (text, documents_text(scene), documents_text(way)))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter('always')
        try:
            scene = cprox.Scene(cprox.Robot.from_urdf(os.path.join(folder, 'robot.urdf')))
            scene.load(os.path.join(folder, 'scene.yaml'))
            answer = of_dict(cprox.Motion.from_file(scene, os.path.join(folder, 'way.yaml')).collision())
        except (ValueError, RuntimeError):
            answer = None
    remarks = [str(one.message) for one in said]
    if whole and unit != 1:  # which is to be told
        if not any('unit' in one for one in remarks):
            return f'{case.kind}: the unit {unit} is not told', None
        remarks = [one for one in remarks if 'unit' not in one]
    return case.judge('collision', truth, answer, remarks), None


def curve_case(r, folder, program):
    scene = make_scene(r)
    header = ['id', 'basis', 'degree', 't0', 't1', 'radius', 'n', 'x0', 'y0', 'z0', 'x1', 'y1', 'z1']
    rows = [[f'c{i}', 'bezier', '1', '0', '1', str(round(r.uniform(0, .1), 3)), '2', *map(str, numbers(r, 6, 1))] for i in range(3)]
    kind = r.choice(('whole', 'scene', 'row', 'row', 'header'))
    whole, broken = kind == 'whole', 1
    if kind == 'scene':
        kind += ' ' + break_yaml(r, scene, make_scene)
    elif kind != 'whole':
        line = header if kind == 'header' else rows[broken]
        i, what = r.randrange(2, len(line)), r.choice(('remove', 'double', 'word', 'typo'))
        if what == 'remove':
            del line[i]
        elif what == 'double':
            line.insert(i, line[i])
        elif what == 'word':
            line[i] = r.choice(('nan', 'inf', '1e999', 'x', '-1', '1.5', '"2'))
        else:
            line[i] = typo(r, line[i])
        kind += ' ' + what
    text = '\n'.join(','.join(line) for line in [header] + rows) + '\n'
    write(folder, 'curves.csv', text)
    write(folder, 'scene.yaml', documents_text(scene))
    truths, least = [], math.inf
    for row in rows:
        try:
            places, radius = model.curve_of(header, row)
            shapes = [shape for found in model.scene_of(scene)[0].values() for shape in found]
            truths.append(model.distance_of(places, radius, shapes))
        except Invalid:
            truths.append(None)
    code, out, errors = run(program, folder, 'tolerance', '--delta', '0', '--curves', 'curves.csv', '--scene', 'scene.yaml')
    case = Case('curves: ' + kind, whole, (text, documents_text(scene)))
    found = list(csv.DictReader(out.splitlines()))
    for i, truth in enumerate(truths):
        mine = [one for one in found if one['id'] == rows[i][0]]
        said = [(one['verdict'] == 'clear', float(one['lower']) if one['lower'] else None) for one in mine]
        wrong = case.judge('row', truth, said[0] if said else None)
        if wrong:
            return wrong, None
    least = None if None in truths else min(truths)
    return case.judge_code('cprox tolerance', least, code, errors), None


def path_case(r, folder, program):
    scene, path, radius = make_scene(r), make_path(r), round(r.uniform(0, .1), 3)
    kind = r.choice(('whole', 'scene', 'path', 'path'))
    whole = kind == 'whole'
    if kind != 'whole':
        kind += ' ' + (break_yaml(r, scene, make_scene) if kind == 'scene' else break_yaml(r, path, make_path))
    write(folder, 'path.yaml', documents_text(path))
    write(folder, 'scene.yaml', documents_text(scene))
    try:
        objects, matrix = model.scene_of(scene)  # what rides the path has no entry: the defaults of objects count
        shapes = [shape for name, found in objects.items() if matrix.get(frozenset((name,))) != 'true' for shape in found]
        truth = model.distance_of(model.path_of(path), radius, shapes)
    except Invalid:
        truth = None
    measures = r.random() < 0.3
    command = r.choice(MEASURES if measures else VERDICTS[:4])
    code, _, errors = run(program, folder, *command, '--path', 'path.yaml', '--radius', str(radius), '--scene', 'scene.yaml')
    case = Case('paths: ' + kind, whole, (documents_text(path), documents_text(scene)))
    return case.judge_code('cprox ' + command[0], truth, code, errors, measures), None


def pairs_case(r, folder, program):
    pairs = make_pairs(r)
    kind = r.choice(('whole', 'broken', 'broken', 'broken'))
    whole = kind == 'whole'
    if not whole:
        kind += ' ' + break_yaml(r, pairs, make_pairs)
    write(folder, 'pairs.yaml', documents_text(pairs))
    code, out, errors = run(program, folder, 'pairs', '--in', 'pairs.yaml')
    case = Case('pairs: ' + kind, whole, (documents_text(pairs), out))
    truths = []
    for entry in pairs[0] if len(pairs) == 1 and not isinstance(pairs[0], Map) else ():
        try:
            truths.append(model.pair_of(entry))
        except Invalid:
            truths.append(None)
    for truth, row in zip(truths, csv.DictReader(out.splitlines())):
        said = (row['status'] == 'ok' and float(row['lower']) > 0, float(row['lower'])) if row['lower'] else None
        if truth is not None and truth < 0:
            said = said and (said[0], None)
        wrong = case.judge('row', truth, said)
        if wrong:
            return wrong, None
    if code == 0 and (None in truths or not truths):
        return case.kind + ': the command line ends with 0\n  ' + documents_text(pairs) + '\n' + out + errors, None
    return case.judge_code('cprox pairs', min(truths), code, errors, True) if whole else '', None


# ----------------------------------------------------------------------------------------------------------- datasets
class Dataset:
    """Cases of robots as rows of one manifest: `certify`, `merge`, cprox.dataset."""

    def __init__(self, program, folder):
        self.program, self.folder, self.cases = program, folder, []

    def add(self, number, case):
        kind, whole, texts, row, truth = case
        own = os.path.join(self.folder, f'{number}')
        os.makedirs(own)
        for name, text in texts.items():
            write(own, name, text)
        row = {key: f'{number}/{value}' if key != 'query' else value for key, value in row.items()}
        self.cases.append((number, Case(kind, whole, texts.values()), dict(row, id=str(number)), truth))

    def finish(self):
        """A line for each case that is wrong."""
        if not self.cases:
            return []
        write(self.folder, 'manifest.jsonl', ''.join(json.dumps(row) + '\n' for _, _, row, _ in self.cases))
        shutil.rmtree(os.path.join(self.folder, 'out'), ignore_errors=True)
        run(self.program, self.folder, 'certify', '--dataset', 'manifest.jsonl', '--out', 'out')
        code, _, errors = run(self.program, self.folder, 'merge', 'out', '--out', 'all.csv')
        with open(os.path.join(self.folder, 'all.csv'), encoding='utf-8') as file:
            rows = {row['id']: row for row in csv.DictReader(file)}
        read = cprox.dataset.read(os.path.join(self.folder, 'all.csv'))
        wrong, open_ones = [], 0
        for number, case, asked, truth in self.cases:
            row = rows.get(str(number))
            if row is None:
                wrong.append(f'case {number}: {case.kind}: it has no row\n{errors}')
                continue
            is_ok, measures = row['status'] == 'ok', asked['query'] == 'distance'
            said = (is_ok and (float(row['lower']) > 0 if measures else row['verdict'] == 'clear'),
                    float(row['lower'])) if row['lower'] else None
            open_ones += not (is_ok and (measures or row['verdict'] == 'clear'))
            found = case.judge('certify', truth, said, [])
            if found:
                wrong.append(f'case {number}: {found}')
        if open_ones and code == 0 or len(read['row']) != len(rows):
            wrong.append(f'case {self.cases[0][0]}: merge ends with {code}, {open_ones} rows are not clear')
        for number, _, _, _ in self.cases:
            shutil.rmtree(os.path.join(self.folder, f'{number}'))
        self.cases = []
        return wrong


FAMILIES = (robot_case, robot_case, robot_case, mesh_case)
OF_PROGRAM = (robot_case, robot_case, curve_case, path_case, pairs_case)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('size', type=int)
    parser.add_argument('seed', type=int)
    parser.add_argument('--case', type=int, help='this one alone')
    parser.add_argument('--seconds', type=float, default=math.inf, help='no more than these')
    words = parser.parse_args()
    program = os.environ.get('CPROX') or shutil.which('cprox')
    if not program:
        parser.error('cprox is not on the PATH: scripts/run test/python/doors.py')
    end = time.monotonic() + words.seconds
    asked = failed = 0
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as rows:
        os.environ['XDG_CACHE_HOME'] = rows  # meshes are read anew
        dataset = Dataset(program, rows)

        def tell(lines):
            nonlocal failed
            for line in lines:
                failed += 1
                if failed <= 20:
                    print(line, flush=True)

        for i in range(words.size) if words.case is None else [words.case]:
            if time.monotonic() > end:
                break
            asked += 1
            r = random.Random(f'{words.seed} {i}')
            by_program = i % CLI_EVERY == 0
            wrong, again = r.choice(OF_PROGRAM if by_program else FAMILIES)(r, folder, program if by_program else '')
            if wrong:
                tell([f'case {i}: {wrong}'])
            elif again:
                dataset.add(i, again)
            if len(dataset.cases) == BATCH:
                tell(dataset.finish())
        tell(dataset.finish())
    print(f'{asked - failed} passed, {failed} failed')
    return 1 if failed or not asked else 0


if __name__ == '__main__':
    sys.exit(main())
