#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Edges on all public problems of MotionBenchMaker, as VAMP distributes them: a row of results.csv for each robot of spheres.

    git clone https://github.com/KavrakiLab/vamp
    bench/public_edges.py --source vamp [--problems N] >>rows.csv

The cprox package must be importable. Data alone is read: spherized URDFs, SRDFs, scenes and requests. The edges of a problem go from
states of the straight way from start to goal, and from states about it, to random ones, at most 2 rad (or m) long; beginnings are
clear. All are asked in one call, scene and self, many times over. median_us, p95_us: of an edge, over the problems. nodes: edges;
distance_queries: those that are violated; unsound: clear edges with a sample that collides, at 64 a radian; failures: undecided
edges, and problems that could not be read."""
import argparse
import glob
import os
import re
import sys
import tarfile
import tempfile
import time
import xml.etree.ElementTree as ElementTree

import numpy
import yaml

import cprox

LOADER = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)
ROBOTS = ('panda', 'ur5', 'fetch', 'baxter')
EDGES, TIMES, LONGEST, PER_RADIAN = 32, 20, 2.0, 64.0


def limits_of(urdf, joints):
    """The lowest and the highest value of each joint; a whole turn each way where it has none."""
    found = {}
    for joint in ElementTree.parse(urdf).getroot().iter('joint'):
        limit = joint.find('limit')
        has = limit is not None and joint.get('type') != 'continuous'
        found[joint.get('name')] = (float(limit.get('lower', 0)), float(limit.get('upper', 0))) if has else (-numpy.pi, numpy.pi)
    return numpy.array([found[name] for name in joints]).T


def problem_of(path):
    """The joints, start, goal, and where the others stand; none where the goal is no posture."""
    with open(path) as stream:
        request = yaml.load(stream, LOADER)
    state = request['start_state']['joint_state']
    start = dict(zip(state['name'], state['position']))
    goal = {joint['joint_name']: joint['position'] for constraints in request['goal_constraints']
            for joint in constraints.get('joint_constraints') or []}
    if not goal or not set(goal) <= set(start):
        return None
    joints = sorted(goal)
    return joints, [start[name] for name in joints], [goal[name] for name in joints], {
        name: value for name, value in start.items() if name not in goal}


def draw_edges(random, ask, start, goal, limits):
    """Beginnings that are clear, and ends."""
    share = random.uniform(0, 1, (8 * EDGES, 1))
    states = (1 - share) * start + share * goal + random.normal(0, 0.3, (8 * EDGES, len(start))) * (random.uniform(size=(8 * EDGES, 1)) < 0.7)
    states = numpy.clip(states, *limits)
    begin = states[ask(states, states) == 0][:EDGES]
    way = random.uniform(*limits, begin.shape) - begin
    length = numpy.linalg.norm(way, axis=1, keepdims=True)
    return begin, begin + way * numpy.minimum(1.0, LONGEST / numpy.maximum(length, 1e-9)), numpy.minimum(length, LONGEST)


def contradicted(ask, begin, end, length):
    """How many edges have a sample that collides."""
    states, owner = [], []
    for number, (a, b, far) in enumerate(zip(begin, end, length[:, 0])):
        t = numpy.linspace(0, 1, 2 + int(far * PER_RADIAN))[:, None]
        states.append((1 - t) * a + t * b)
        owner += [number] * len(t)
    if not states:
        return 0
    states = numpy.concatenate(states)
    return len(set(numpy.array(owner)[ask(states, states) == 1]))


def load(scene, path, folder):
    """The objects of a scene; its robot_state is that of the request, and names wheels that a URDF does not have."""
    with open(path) as stream:
        given = yaml.load(stream, LOADER)
    given.pop('robot_state', None)
    copy = os.path.join(folder, 'scene.yaml')
    with open(copy, 'w') as stream:
        yaml.dump(given, stream)
    scene.load(copy)


def measure(robot, urdf, request, random, folder):
    """Microseconds an edge, verdicts, contradictions."""
    found = problem_of(request)
    if found is None:
        return None
    joints, start, goal, rest = found
    scene = cprox.Scene(robot)
    load(scene, request.replace('request', 'scene'), folder)
    moving = {joint.get('name') for joint in ElementTree.parse(urdf).getroot().iter('joint') if joint.get('type') != 'fixed'}
    options = {'rest': {name: value for name, value in rest.items() if name in moving}, 'threads': 1}

    def ask(begin, end):
        return cprox.edges(scene, joints, begin, end, **options)

    begin, end, length = draw_edges(random, ask, numpy.array(start), numpy.array(goal), limits_of(urdf, joints))
    if len(begin) == 0:
        return None
    many = numpy.tile(begin, (TIMES, 1)), numpy.tile(end, (TIMES, 1))
    spent = []
    for _ in range(3):
        began = time.thread_time()
        verdicts = ask(*many)
        spent.append(time.thread_time() - began)
    verdicts = verdicts[:len(begin)]
    clear = verdicts == 0
    return 1e6 * min(spent) / len(many[0]), verdicts, contradicted(ask, begin[clear], end[clear], length[clear])


def bench_robot(name, source, folder, most):
    resources = os.path.join(source, 'resources', name)
    if not os.path.isdir(resources):
        print(f'{name}: not in {source}', file=sys.stderr)
        return
    with tarfile.open(os.path.join(resources, 'problems.tar.bz2')) as archive:
        archive.extractall(os.path.join(folder, name), members=[one for one in archive if re.fullmatch(r'[\w./-]+\.yaml', one.name)
                                                                and '..' not in one.name])
    urdf = os.path.join(resources, name + '_spherized.urdf')
    robot = cprox.Robot.from_urdf(urdf, srdf=os.path.join(resources, name + '.srdf'))
    requests = sorted(glob.glob(os.path.join(folder, name, '**', 'request*.yaml'), recursive=True))
    requests = requests[::max(1, len(requests) // most)] if most else requests
    random = numpy.random.default_rng(97)
    times, verdicts, unsound, failures = [], [], 0, 0
    for number, request in enumerate(requests):
        try:
            found = measure(robot, urdf, request, random, folder)
        except (ValueError, KeyError) as error:
            print(f'{request}: {error}', file=sys.stderr)
            found = None
        if found is None:
            failures += 1
            continue
        times.append(found[0])
        verdicts.append(found[1])
        unsound += found[2]
        print(f'\r{name}: {number + 1} of {len(requests)}', end='', file=sys.stderr)
    print(file=sys.stderr)
    if not times:
        print(f'{name}: no problem was measured', file=sys.stderr)
        return
    all_of = numpy.concatenate(verdicts)
    print(f'robots,public problems,curve_proximity,{name} {len(times)} problems,{numpy.median(times):.4g},{numpy.quantile(times, 0.95):.4g},'
          f'{len(all_of)},{(all_of == 1).sum()},,{unsound},{failures + (all_of == 2).sum()}', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--source', required=True, help='a clone of github.com/KavrakiLab/vamp')
    parser.add_argument('--problems', type=int, default=0, help='so many of each robot at most; 0: all')
    parser.add_argument('--robot', action='append', choices=ROBOTS, help='this robot only; may be given more than once')
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for name in asked.robot or ROBOTS:
            bench_robot(name, asked.source, folder, asked.problems)
    return 0


if __name__ == '__main__':
    sys.exit(main())
