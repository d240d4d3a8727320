#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The group `errors`: link pairs and swept volumes, by the Python package: errors.py [--quick] [--rounds N]

collision matrix  all pairs of links of a Panda, and of a mobile robot with two Pandas, a UR5 and a Fanuc on a Husky: 40 links and
                  more, as a PR2. nodes: boxes; distance_queries: pairs; error: the share of pairs that are undecided.
outer cover       the swept volume of a Panda's motion with a gap of a centimetre. nodes: cells; distance_queries: bodies at poses;
                  error: the gap [m].

Times of the matrix are those of the processor, of all threads together; of the cover by the clock, on all processors. Verdicts and
scales are rows of the group `robots`."""
import argparse
import os
import statistics
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree

import cprox

DATA = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'test', 'data')
ROBOTS = os.path.join(DATA, 'robots')
MOTION = os.path.join(DATA, 'trajectories', 'panda_bookshelf_small_0001_rrt.yaml')
# Where each arm stands on the Husky.
MOUNTED = (('left', 'panda/panda.urdf', '0.2 0.3 0.6'), ('right', 'panda/panda.urdf', '0.2 -0.3 0.6'),
           ('rear', 'ur5/ur5.urdf', '-0.3 0 0.6'), ('lift', 'fanuc_m10ia/fanuc_m10ia.urdf', '-1.6 0 0'))
GAP = 0.01  # [m]


def named(path, prefix):
    """The elements of a URDF, its names with a prefix, its meshes by their whole paths; and its root link."""
    robot = ElementTree.parse(path).getroot()
    for element in robot.iter():
        if element.tag in ('link', 'joint') and element.get('name'):
            element.set('name', prefix + element.get('name'))
        for name in ('link', 'joint'):
            if element.tag in ('parent', 'child', 'mimic') and element.get(name):
                element.set(name, prefix + element.get(name))
        file = element.get('filename')
        if element.tag == 'mesh' and not file.startswith(('package:', 'file:', '/')):
            element.set('filename', 'file://' + os.path.join(os.path.dirname(path), file))
    children = {joint.find('child').get('link') for joint in robot.findall('joint')}
    root = next(link.get('name') for link in robot.findall('link') if link.get('name') not in children)
    return robot, root


def mounted(text, base, arms):
    """The URDF `text` with arms on the link `base`."""
    whole = ElementTree.fromstring(text)
    for prefix, path, place in arms:
        arm, root = named(os.path.join(ROBOTS, path), prefix + '_')
        whole.extend([element for element in arm if element.tag in ('link', 'joint')])
        joint = ElementTree.SubElement(whole, 'joint', name=prefix + '_mount', type='fixed')
        ElementTree.SubElement(joint, 'parent', link=base)
        ElementTree.SubElement(joint, 'child', link=root)
        ElementTree.SubElement(joint, 'origin', xyz=place)
    return ElementTree.tostring(whole, encoding='unicode')


def mobile_robot():
    """The URDF of the Husky with its arms."""
    husky, base = named(os.path.join(ROBOTS, 'husky', 'husky.urdf'), 'husky_')
    return mounted(ElementTree.tostring(husky, encoding='unicode'), base, MOUNTED)


def matrix(name, path, rounds, max_nodes):
    robot = cprox.Robot.from_urdf(path)
    times = []
    for _ in range(rounds):
        begin = time.process_time()
        pairs = robot.collision_matrix(max_nodes=max_nodes)
        times.append(1e6 * (time.process_time() - begin))
    undecided = [pair for pair in pairs if pair['contact'] == 'undecided']
    for pair in undecided:
        print(f"errors.py: {name}: {pair['a']} and {pair['b']} are undecided", file=sys.stderr)
    print(f"errors,collision matrix,curve_proximity,{name},{statistics.median(times):.4g},{max(times):.4g},"
          f"{sum(pair['nodes'] for pair in pairs)},{len(pairs)},{len(undecided) / len(pairs):.4g},0,0", flush=True)


def cover(rounds):
    robot = cprox.Robot.from_urdf(os.path.join(ROBOTS, 'panda', 'panda.urdf'), os.path.join(ROBOTS, 'panda', 'panda.srdf'))
    motion = cprox.Motion.from_file(cprox.Scene(robot), MOTION)
    coarse = motion.sweep(0.05)
    resolution = 0.999 * GAP * coarse.resolution / coarse.gap  # the gap is a multiple of the resolution
    times = []
    for _ in range(rounds):
        begin = time.perf_counter()
        volume = motion.sweep(resolution)
        times.append(1e6 * (time.perf_counter() - begin))
    print(f"errors,outer cover,curve_proximity,gap 0.01 m cells {resolution:.5f} m,{statistics.median(times):.4g},{max(times):.4g},"
          f"{len(volume.cells)},,{volume.gap:.6g},0,0", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--quick', action='store_true', help='without the mobile robot')
    parser.add_argument('--rounds', type=int, default=3)
    arguments = parser.parse_args()
    cover(arguments.rounds)
    matrix('Panda', os.path.join(ROBOTS, 'panda', 'panda.urdf'), arguments.rounds, 500000)
    if arguments.quick:
        return
    with tempfile.NamedTemporaryFile('w', suffix='.urdf') as file:
        file.write(mobile_robot())
        file.flush()
        matrix('Husky with four arms', file.name, 1, 20000)


if __name__ == '__main__':
    main()
