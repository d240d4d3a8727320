#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Edges of a roadmap, certified by Dask workers of which one is killed midway, against one process: the same bytes.

    scripts/run test/python/dataset_campaign.py --rows 100000 --seed 1 --shards 100 --workers 2
    scripts/run test/python/dataset_campaign.py --matrix 4000           # so many edges in every scene, as bits
    scripts/run test/python/dataset_campaign.py --rows 300 --write 300.jsonl [--paths]    # a manifest alone, to count instructions

Each row is a straight motion of a Panda between two postures near those of the saved paths, in one of their scenes, with the
verdict of 10 mm. Prints what each way took; ends with 1 where the tables differ. The environment variable CPROX may name the
program.
"""
import argparse
import filecmp
import glob
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time

import yaml

DATA = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'data')
JOINTS = [f'panda_joint{i}' for i in range(1, 8)]
NEAR = 0.3  # [rad] how far an edge's ends are from a saved posture
SECONDS = 1.0


def postures():
    """The scene and the postures of each saved path of the Panda."""
    found = []
    for path in sorted(glob.glob(os.path.join(DATA, 'trajectories', 'panda_*.yaml'))):
        with open(path) as stream:
            saved = yaml.safe_load(stream)
        points = saved['joint_trajectory']
        order = [points['joint_names'].index(joint) for joint in JOINTS]
        found.append((os.path.join(DATA, saved['scene']), [[point['positions'][i] for i in order] for point in points['points']]))
    return found


def write_edges(path, rows, seed):
    """A manifest of so many edges: random, the same for the same seed."""
    rng, paths = random.Random(seed), postures()
    robot = os.path.join(DATA, 'robots', 'panda', 'panda.urdf')
    with open(path, 'w') as out:
        for i in range(rows):
            scene, saved = paths[rng.randrange(len(paths))]
            start = [round(q + rng.uniform(-NEAR, NEAR), 6) for q in rng.choice(saved)]
            end = [round(q + rng.uniform(-NEAR, NEAR), 6) for q in start]
            points = [{'positions': start, 'time_from_start': 0}, {'positions': end, 'time_from_start': SECONDS}]
            row = {'id': f'edge{i}', 'robot': robot, 'srdf': robot[:-4] + 'srdf', 'scene': scene, 'query': 'tolerance', 'delta': 0.01,
                   'trajectory': {'joint_trajectory': {'joint_names': JOINTS, 'points': points}}}
            out.write(json.dumps(row) + '\n')


def write_paths(path, rows):
    """A manifest of so many of the saved paths themselves, in turns, with the verdict of 10 mm."""
    files = sorted(glob.glob(os.path.join(DATA, 'trajectories', 'panda_*.yaml')))
    robot = os.path.join(DATA, 'robots', 'panda', 'panda.urdf')
    with open(path, 'w') as out:
        for i in range(rows):
            with open(files[i % len(files)]) as stream:
                saved = yaml.safe_load(stream)
            row = {'id': f'path{i}', 'robot': robot, 'srdf': robot[:-4] + 'srdf', 'scene': os.path.join(DATA, saved['scene']),
                   'query': 'tolerance', 'delta': 0.01,
                   'trajectory': {key: saved[key] for key in ('joint_trajectory', 'fixed_joints') if key in saved}}
            out.write(json.dumps(row) + '\n')


def time_matrix(count, seed):
    """So many short edges in every scene, with the robot against itself: pairs of edge and scene a second of CPU."""
    import cprox
    import cprox.dataset
    import numpy as np
    rng, paths = np.random.default_rng(seed), postures()
    scenes = sorted({scene for scene, _ in paths})
    saved = np.concatenate([np.array(postures_of) for _, postures_of in paths])
    vertices = np.concatenate([saved + rng.uniform(-NEAR, NEAR, saved.shape) for _ in range(3)])
    edges = []
    for i in rng.integers(0, len(vertices), count):
        nearest = np.argsort(np.abs(vertices - vertices[i]).max(axis=1))
        edges.append((i, nearest[1 + rng.integers(0, 8)]))
    panda = os.path.join(DATA, 'robots', 'panda', 'panda')
    robot = cprox.Robot.from_urdf(panda + '.urdf', panda + '.srdf')
    begin = time.process_time()
    found = cprox.dataset.edge_matrix(robot, scenes, JOINTS, vertices, np.array(edges), 0.01, self=True)
    seconds = time.process_time() - begin
    clear = np.unpackbits(found['clear'], axis=1, count=count).mean()
    print(f'{count} edges in {len(scenes)} scenes: {seconds:.2f} s of CPU, {count * len(scenes) / seconds:.0f} a second, '
          f'{100 * clear:.0f} % clear')


def kill_one_worker(cluster, out, after):
    """SIGKILL to a worker of the cluster once so many shards are whole. Returns its thread, and a list for the process number."""
    killed = []

    def wait():
        while len(glob.glob(os.path.join(out, 'shard-*.csv'))) < after:
            time.sleep(0.01)
        killed.append(next(iter(cluster.workers.values())).pid)
        os.kill(killed[0], signal.SIGKILL)
    thread = threading.Thread(target=wait, daemon=True)
    thread.start()
    return thread, killed


def certify_on_cluster(manifest, out, shards, workers, cprox, kill_after=None):
    """Certifies with a cluster of this machine; kills a worker once kill_after shards are whole. Returns the failures, and how
    many workers were killed."""
    from distributed import Client, LocalCluster
    import cprox_dask
    with LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None) as cluster, Client(cluster) as client:
        thread, killed = kill_one_worker(cluster, out, kill_after) if kill_after is not None else (None, [])
        failures = cprox_dask.certify(client, manifest, out, shards, cprox)
        if thread:
            thread.join(10)
        return failures, len(killed)


def merge(cprox, folder, path):
    """One table of all shards. Its exit code says what the verdicts are; 2, that there is none."""
    code = subprocess.run([cprox, 'merge', folder, '--out', path], stdout=subprocess.DEVNULL).returncode
    if code == 2:
        raise RuntimeError(f'{folder}: not merged, or rows have no answer')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--rows', type=int, default=1000)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--shards', type=int, default=20)
    parser.add_argument('--workers', type=int, default=2)
    parser.add_argument('--folder', help='where files go and stay; default: a folder that is removed')
    parser.add_argument('--matrix', type=int, metavar='EDGES', help='only this: time a bit matrix')
    parser.add_argument('--write', metavar='FILE', help='only this: write the manifest')
    parser.add_argument('--paths', action='store_true', help='with --write: of saved paths, not of edges')
    asked = parser.parse_args()
    if asked.matrix:
        return time_matrix(asked.matrix, asked.seed)
    if asked.write:
        return write_paths(asked.write, asked.rows) if asked.paths else write_edges(asked.write, asked.rows, asked.seed)
    cprox = os.environ.get('CPROX', 'cprox')
    folder = tempfile.TemporaryDirectory()
    place = asked.folder or folder.name
    os.makedirs(place, exist_ok=True)
    manifest = os.path.join(place, 'edges.jsonl')
    write_edges(manifest, asked.rows, asked.seed)

    begin = time.monotonic()
    subprocess.run([cprox, 'certify', '--dataset', manifest, '--out', os.path.join(place, 'alone'), '--threads', '1'], check=True)
    alone = time.monotonic() - begin
    print(f'one process: {asked.rows} rows in {alone:.1f} s, {asked.rows / alone:.0f} a second', flush=True)

    begin = time.monotonic()
    shared = os.path.join(place, 'shared')
    failures, killed = certify_on_cluster(manifest, shared, asked.shards, asked.workers, cprox, asked.shards // 2)
    several = time.monotonic() - begin
    print(f'{asked.workers} workers, {killed} killed midway: {asked.shards} shards in {several:.1f} s, '
          f'{asked.rows / several:.0f} rows a second, {len(failures)} shards given up', flush=True)

    tables = [os.path.join(place, name + '.csv') for name in ('alone', 'shared')]
    for table in tables:
        merge(cprox, table[:-4], table)
    same = filecmp.cmp(*tables, shallow=False)
    print(f'the tables are {"the same" if same else "NOT the same"}: {os.path.getsize(tables[0])} bytes')
    return 0 if same and killed and not failures else 1


if __name__ == '__main__':
    sys.exit(main())
