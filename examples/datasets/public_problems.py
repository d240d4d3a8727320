#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A manifest of the public MotionBenchMaker problems, as VAMP distributes them: each from start to goal, straight and smoothed.

    git clone https://github.com/KavrakiLab/vamp
    for robot in panda ur5 fetch baxter; do tar -xjf vamp/resources/$robot/problems.tar.bz2 -C vamp/resources/$robot; done
    examples/datasets/public_problems.py vamp/resources problems
    cprox certify --dataset problems/edges.jsonl --out results --shards 16

The problems are BSD-3-Clause (Rice University), VAMP is Apache-2.0; each robot's description has a licence of its own. A straight edge
is a line in joint space. A smoothed one rests at both ends and goes through a posture near the middle, random but the same for the
same seed. The joints that a problem does not move stand as in its start state. The URDFs of UR5 and Fetch name their meshes as those of a
package `meshes`, which there is not: copies of the URDFs name the files.
"""
import argparse
import glob
import json
import os
import random
import re
import shutil
import sys

import yaml

LOADER = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)
SECONDS = 2.0
ASIDE = 0.2  # [rad, m] how far the posture in the middle is beside the line


def problem_of(path):
    """Start, goal and the joints that stand still; none where the goal is no posture."""
    with open(path) as stream:
        request = yaml.load(stream, LOADER)
    state = request['start_state']['joint_state']
    start = dict(zip(state['name'], state['position']))
    goal = {}
    for constraints in request['goal_constraints']:
        goal.update((joint['joint_name'], joint['position']) for joint in constraints.get('joint_constraints') or [])
    if not goal or not set(goal) <= set(start):
        return None
    joints = sorted(goal)
    return joints, [start[joint] for joint in joints], [goal[joint] for joint in joints], {
        joint: value for joint, value in start.items() if joint not in goal}


def edges_of(path, known, rng):
    """The trajectories of a problem, by name; of joints that the robot has (Fetch's wheels are in no URDF)."""
    found = problem_of(path)
    if found is None:
        return
    joints, start, goal, fixed = found
    middle = [(a + b) / 2 + rng.uniform(-ASIDE, ASIDE) for a, b in zip(start, goal)]
    speed = [(b - a) / SECONDS for a, b in zip(start, goal)]
    rest = [0.0] * len(joints)
    for name, interpolation, points in (
            ('straight', 'linear', [(0.0, start, None), (SECONDS, goal, None)]),
            ('smoothed', 'cubic', [(0.0, start, rest), (SECONDS / 2, middle, speed), (SECONDS, goal, rest)])):
        yield name, {'joint_trajectory': {'joint_names': joints, 'points': [
            {'positions': positions, **({'velocities': velocities} if velocities else {}), 'time_from_start': time}
            for time, positions, velocities in points]}, 'interpolation': interpolation,
                     'fixed_joints': {joint: value for joint, value in fixed.items() if joint in known}}


def copy_robot(folder, out):
    """The URDF with the paths of its meshes, and the SRDF of a robot. Its joints."""
    name = os.path.basename(folder)
    with open(os.path.join(folder, name + '.urdf')) as stream:
        text = stream.read()
    meshes = f'file://{folder}/meshes/'
    for prefix in ('package://meshes/', 'meshes/'):
        text = text.replace(f'filename="{prefix}', f'filename="{meshes}')
    with open(os.path.join(out, name + '.urdf'), 'w') as stream:
        stream.write(text)
    shutil.copy(os.path.join(folder, name + '.srdf'), out)
    return set(re.findall(r'<joint\s+name="([^"]+)"', text))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('resources', help='the folder resources of a checkout of VAMP, with the problems unpacked')
    parser.add_argument('out', help='the folder that is written: edges.jsonl, and the robots')
    parser.add_argument('--delta', type=float, default=0.01, help='the clearance asked about [m]')
    parser.add_argument('--seed', type=int, default=1)
    asked = parser.parse_args()
    rng, rows, skipped, robots = random.Random(asked.seed), 0, 0, {}
    os.makedirs(asked.out, exist_ok=True)
    with open(os.path.join(asked.out, 'edges.jsonl'), 'w') as out:
        for request in sorted(glob.glob(os.path.join(os.path.abspath(asked.resources), '*', 'problems', '*', 'request*.yaml'))):
            folder, name = os.path.split(request)
            number = name[len('request'):-len('.yaml')]
            robot_folder = os.path.dirname(os.path.dirname(folder))
            robot = os.path.basename(robot_folder)
            if robot not in robots:
                robots[robot] = copy_robot(robot_folder, asked.out)
            before = rows
            for kind, trajectory in edges_of(request, robots[robot], rng):
                row = {'id': f'{os.path.basename(folder)}/{number}/{kind}', 'robot': robot + '.urdf', 'srdf': robot + '.srdf',
                       'scene': os.path.join(folder, f'scene{number}.yaml'), 'query': 'tolerance', 'delta': asked.delta,
                       'trajectory': trajectory}
                out.write(json.dumps(row) + '\n')
                rows += 1
            skipped += rows == before
    print(f'{rows} edges; {skipped} problems have no goal that is a posture of the start\'s joints', file=sys.stderr)
    return 0 if rows else 2


if __name__ == '__main__':
    sys.exit(main())
