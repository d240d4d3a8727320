#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Inputs with one element broken, held against a model that says what must not be 'clear' (doc/coverage.md).

    scripts/soundness --family doors --size 100000 --seed 1
    scripts/run test/python/doors.py SIZE SEED [--case N] [--seconds S]

A case is a small robot (a ball on two slides), a trajectory and a scene of balls and boxes, each a valid file. One element of
one file is removed, doubled, renamed, misplaced, put out of range, or a second document comes after the file. The model reads
the same tree by a schema of its own: a tree that it does not accept must not be 'clear'; of a tree that it accepts the distance
in closed form must agree with the interval, and the verdict must be 'clear' without a warning where the ball stays away. The
model and the package share no code. Every tenth case goes through the command line, too, whose exit code must not be 0 where
the verdict must not be clear. Prints a line for each wrong case, then `N passed, N failed`.
"""
import argparse
import copy
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

RADIUS = 0.1  # [m] of the ball that moves
CLOSE = 1e-5  # [m] nearer to the limit than this a verdict may be undecided
WORDS = ('objects', 'primitive', 'posiion', 'pose_', 'scale', 'unit', 'x', 'joint', 'offset')
BAD_NUMBERS = ('.nan', '.inf', '-.inf', '1e999', 'none', '"1 m"', '1,5', '[1]', '{}', '~', '--1')


class Map(list):
    """(key, value) pairs in their order: a key may stand twice."""


class Invalid(Exception):
    """What the model does not accept."""


# ---------------------------------------------------------------------------------------------------------------- YAML
def text_of(value):
    if isinstance(value, Map):
        return '{' + ', '.join(f'{key}: {text_of(one)}' for key, one in value) + '}'
    if isinstance(value, list):
        return '[' + ', '.join(text_of(one) for one in value) + ']'
    return value if isinstance(value, str) else repr(value)


def keys_of(value, required=(), optional=()):
    """The map as a dict, if its keys are these and each stands once."""
    if not isinstance(value, Map):
        raise Invalid('no map')
    names = [key for key, _ in value]
    if len(set(names)) < len(names) or not set(required) <= set(names) <= set(required) | set(optional):
        raise Invalid(f'keys {names}')
    return dict(value)


def items_of(value):
    if isinstance(value, Map) or not isinstance(value, list):
        raise Invalid('no list')
    return value


def number_of(value):
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise Invalid(f'no number: {value}')
    return float(value)


def vector_of(value):
    if isinstance(value, Map):
        found = keys_of(value, 'xyz')
        return [number_of(found[name]) for name in 'xyz']
    if len(items_of(value)) != 3:
        raise Invalid('no vector')
    return [number_of(one) for one in value]


# ------------------------------------------------------------------------------------------------------- the model
def scene_of(documents):
    """The balls and boxes of a scene: (middle, half sizes or [], radius). Raises Invalid."""
    if len(documents) != 1:
        raise Invalid('more than one document')
    root = keys_of(documents[0], (), ('name', 'world', 'is_diff'))
    if not root:
        raise Invalid('no scene')
    if 'is_diff' in root and root['is_diff'] not in ('true', 'false'):
        raise Invalid('is_diff')
    if 'name' in root and isinstance(root['name'], list):
        raise Invalid('name')
    out, ids = [], set()
    world = keys_of(root.get('world', Map()), (), ('collision_objects',))
    for entry in items_of(world.get('collision_objects', [])):
        one = keys_of(entry, ('id', 'primitives'), ('primitive_poses', 'header', 'pose'))
        if not isinstance(one['id'], str) or one['id'] in ids | set(BAD_NUMBERS) or not one['id'].isalnum():
            raise Invalid('id')
        ids.add(one['id'])
        if 'header' in one and keys_of(one['header'], (), ('frame_id',)).get('frame_id', 'world') != 'world':
            raise Invalid('frame')
        shapes = items_of(one['primitives'])
        poses = items_of(one.get('primitive_poses', []))
        base = vector_of(keys_of(one['pose'], (), ('position',)).get('position', [0, 0, 0])) if 'pose' in one else [0, 0, 0]
        if not shapes or poses and len(poses) != len(shapes):
            raise Invalid('poses')
        for i, shape in enumerate(shapes):
            shape = keys_of(shape, ('type', 'dimensions'))
            sizes = [number_of(size) for size in items_of(shape['dimensions'])]
            if shape['type'] not in (1, 2, 'box', 'sphere') or min(sizes, default=0) <= 0:
                raise Invalid('shape')
            is_box = shape['type'] in (1, 'box')
            if len(sizes) != (3 if is_box else 1):
                raise Invalid('dimensions')
            at = vector_of(keys_of(poses[i], (), ('position',)).get('position', [0, 0, 0])) if poses else [0, 0, 0]
            middle = [a + b for a, b in zip(base, at)]
            out.append((middle, [size / 2 for size in sizes], 0.0) if is_box else (middle, [], sizes[0]))
    return out


def trajectory_of(documents):
    """Where the ball is at the points. Raises Invalid."""
    if len(documents) != 1:
        raise Invalid('more than one document')
    root = keys_of(documents[0], ('joint_trajectory',), ('interpolation', 'fixed_joints'))
    if root.get('interpolation', 'linear') != 'linear':
        raise Invalid('interpolation')
    still = keys_of(root.get('fixed_joints', Map()), (), ('right', 'ahead'))
    way = keys_of(root['joint_trajectory'], ('joint_names', 'points'), ('header',))
    keys_of(way.get('header', Map()), (), ('frame_id',))
    names = items_of(way['joint_names'])
    if not names or len(set(map(str, names))) < len(names) or not set(map(str, names)) <= {'right', 'ahead'}:
        raise Invalid('names')
    places, before = [], -math.inf
    for point in items_of(way['points']):
        one = keys_of(point, ('positions', 'time_from_start'), ())
        values = [number_of(value) for value in items_of(one['positions'])]
        moment = one['time_from_start']
        if isinstance(moment, Map):
            parts = keys_of(moment, (), ('secs', 'nsecs'))
            if not parts:
                raise Invalid('time')
            moment = number_of(parts.get('secs', 0)) + 1e-9 * number_of(parts.get('nsecs', 0))
        if len(values) != len(names) or not number_of(moment) > before:
            raise Invalid('point')
        before = number_of(moment)
        place = {name: number_of(value) for name, value in still.items()}
        place.update(zip(names, values))
        places.append([place.get('right', 0.0), place.get('ahead', 0.0), 0.0])
    if not places or len(places) == 1 and before != 0:
        raise Invalid('no points')
    return places


HARMLESS = ('visual', 'limit')  # what is in these changes no distance


def xml_of(element):
    tag, attributes, children = element
    inside = ''.join(xml_of(child) for child in children)
    return f'<{tag}{"".join(f" {name}={chr(34)}{value}{chr(34)}" for name, value in attributes)}>{inside}</{tag}>'


def distance_of(places, shapes):
    """The least distance of the ball along straight lines to the shapes: convex along each line, so thirds find it."""
    def gap(p, shape):
        middle, half, radius = shape
        apart = [max(0.0, abs(a - b) - (half[i] if half else 0.0)) for i, (a, b) in enumerate(zip(p, middle))]
        return max(0.0, math.sqrt(sum(a * a for a in apart)) - radius - RADIUS)

    least = math.inf
    for a, b in zip(places, places[1:] or places):
        for shape in shapes:
            low, high = 0.0, 1.0
            for _ in range(80):
                s, t = low + (high - low) / 3, high - (high - low) / 3
                at = [gap([x + u * (y - x) for x, y in zip(a, b)], shape) for u in (s, t)]
                low, high = (low, t) if at[0] <= at[1] else (s, high)
            least = min(least, gap([x + low * (y - x) for x, y in zip(a, b)], shape))
    return least


# --------------------------------------------------------------------------------------------------------- the inputs
def make_scene(r):
    objects = []
    for i in range(r.randint(1, 3)):
        is_box = r.random() < 0.5
        sizes = [round(r.uniform(.05, .4), 3) for _ in range(3 if is_box else 1)]
        shape = Map([('type', 1 if is_box else 2), ('dimensions', sizes)])
        position = [round(r.uniform(-1, 1) * reach, 3) for reach in (1.2, 1.2, 0.4)]
        place = Map(zip('xyz', position)) if r.random() < 0.5 else position
        entry = Map([('id', f'thing{i}'), ('primitives', [shape]), ('primitive_poses', [Map([('position', place)])])])
        if r.random() < 0.3:
            entry.insert(0, ('header', Map([('frame_id', 'world')])))
        if r.random() < 0.3:
            entry.append(('pose', Map([('position', [round(r.uniform(-.2, .2), 3) for _ in range(3)])])))
        objects.append(entry)
    return [Map([('name', 'room'), ('world', Map([('collision_objects', objects)]))])]


def make_trajectory(r):
    points = []
    for i in range(r.randint(1, 4)):
        moment = Map([('secs', i), ('nsecs', 0)]) if r.random() < 0.5 else float(i)
        points.append(Map([('positions', [round(r.uniform(-1, 1), 3) for _ in range(2)]), ('time_from_start', moment)]))
    way = Map([('header', Map([('frame_id', 'world')])), ('joint_names', ['right', 'ahead']), ('points', points)])
    return [Map([('joint_trajectory', way)])]


def make_robot(_):
    def slide(name, parent, child, axis):
        return ['joint', [('name', name), ('type', 'prismatic')],
                [['parent', [('link', parent)], []], ['child', [('link', child)], []], ['axis', [('xyz', axis)], []],
                 ['limit', [('lower', '-2'), ('upper', '2'), ('effort', '1'), ('velocity', '1')], []]]]

    def ball():
        return ['geometry', [], [['sphere', [('radius', str(RADIUS))], []]]]

    return ['robot', [('name', 'ball')],
            [['link', [('name', 'base')], []], ['link', [('name', 'slide')], []],
             ['link', [('name', 'tip')],
              [['collision', [], [['origin', [('xyz', '0 0 0')], []], ball()]], ['visual', [], [ball()]]]],
             slide('right', 'base', 'slide', '1 0 0'), slide('ahead', 'slide', 'tip', '0 1 0')]]


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
        wrong = r.choice(BAD_NUMBERS)
        holder[i] = (holder[i][0], wrong) if is_map else wrong
    return what


def break_robot(r, robot):
    """What was done, and whether it can change the distance."""
    elements = []

    def walk(element, harmless):
        elements.append((element, harmless or element[0] in HARMLESS))
        for child in element[2]:
            walk(child, elements[-1][1] if element[0] in HARMLESS else harmless)

    walk(robot, False)
    what = r.choice(('rename', 'attribute', 'double', 'unknown', 'value'))
    element, harmless = r.choice(elements)
    i = r.randrange(max(1, len(element[1])))
    if what == 'attribute' and element[1]:
        element[1][i] = (typo(r, element[1][i][0]), element[1][i][1])
    elif what == 'value' and element[1]:
        element[1][i] = (element[1][i][0], r.choice(('nan', '', 'x', '1e999', '0 0', '0,0,0')))
        harmless = harmless or element is robot
    elif what == 'unknown':
        element[2].append([r.choice(('xacro:hand', 'capsule', 'collison', 'quaternion', 'include')), [('parent', 'tip')], []])
    elif what == 'double' and element[2]:
        child = r.choice(element[2])
        harmless = harmless or child[0] in HARMLESS
        element[2].append(child)
    else:
        harmless = harmless and element[0] not in HARMLESS
        element[0] = typo(r, element[0])
    return 'robot ' + what, harmless


# ------------------------------------------------------------------------------------------------------------- the doors
def ask_python(folder):
    """The answer, or None where there is an error; and the warnings."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter('always')
        try:
            scene = cprox.Scene(cprox.Robot.from_urdf(os.path.join(folder, 'robot.urdf')))
            scene.load(os.path.join(folder, 'scene.yaml'))
            return cprox.Motion.from_file(scene, os.path.join(folder, 'way.yaml')).collision(), said
        except (ValueError, RuntimeError):
            return None, said


def ask_program(program, folder):
    words = [program, 'collision', '--robot', 'robot.urdf', '--scene', 'scene.yaml', '--trajectory', 'way.yaml']
    return subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE).returncode


def write(folder, name, text):
    with open(os.path.join(folder, name), 'w', encoding='utf-8') as file:
        file.write(text)


def one_case(r, folder, program):
    """What is wrong, '' if nothing; and the kind of the case."""
    scene, way, robot = make_scene(r), make_trajectory(r), make_robot(r)
    kind = r.choice(('whole', 'scene', 'scene', 'way', 'way', 'robot'))
    if kind == 'scene':
        kind += ' ' + break_yaml(r, scene, make_scene)
    elif kind == 'way':
        kind += ' ' + break_yaml(r, way, make_trajectory)
    elif kind == 'robot':
        kind, harmless = break_robot(r, robot)
    texts = {name: '\n---\n'.join(map(text_of, documents)) for name, documents in (('scene.yaml', scene), ('way.yaml', way))}
    texts['robot.urdf'] = xml_of(robot)
    for name, text in texts.items():
        write(folder, name, text)
    try:
        truth = distance_of(trajectory_of(way), scene_of(scene))
    except Invalid:
        truth = None
    if kind.startswith('robot') and not harmless:
        truth = None
    answer, said = ask_python(folder)
    verdict = answer['result'].verdict if answer else 'error'
    at = f'{kind}: {verdict}, truth {truth}\n  ' + '\n  '.join(texts.values()) + '\n  '
    if program and truth is not None and truth > CLOSE and ask_program(program, folder) not in (0, 3):
        return at + 'the command line does not answer a valid input', kind
    if verdict == 'clear':
        if truth is None:
            return at + 'clear of an input that the model does not accept', kind
        if not truth > 0:
            return at + 'clear of a contact', kind
        if math.isinf(truth):
            return at + 'clear of nothing', kind
    if program and (truth is None or not truth > 0 or math.isinf(truth)) and ask_program(program, folder) == 0:
        return at + 'the command line ends with 0', kind
    if kind != 'whole':
        return '', kind
    if answer is None:
        return at + 'a valid input is refused', kind
    if truth > CLOSE and (verdict != 'clear' or said):
        return at + f'a valid input is not clear, or with a warning: {[str(one.message) for one in said]}', kind
    if answer['result'].lower > truth + 1e-9:
        return at + f'lower is {answer["result"].lower}', kind
    return '', kind


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('size', type=int)
    parser.add_argument('seed', type=int)
    parser.add_argument('--case', type=int, help='this one alone')
    parser.add_argument('--seconds', type=float, default=math.inf, help='no more than these')
    words = parser.parse_args()
    program = os.environ.get('CPROX') or shutil.which('cprox') or ''
    end = time.monotonic() + words.seconds
    passed = failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for i in range(words.size) if words.case is None else [words.case]:
            if time.monotonic() > end:
                break
            wrong, kind = one_case(random.Random(f'{words.seed} {i}'), folder, program if i % 10 == 0 else '')
            passed, failed = passed + (not wrong), failed + bool(wrong)
            if wrong and failed <= 20:
                print(f'case {i}: {wrong}')
    print(f'{passed} passed, {failed} failed')
    return 1 if failed or not passed else 0


if __name__ == '__main__':
    sys.exit(main())
