#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Edges of a roadmap, certified by Dask workers of which one is killed midway, against one process: the same bytes.

    scripts/run test/python/dataset_campaign.py --rows 100000 --seed 1 --shards 100 --workers 2
    scripts/run test/python/dataset_campaign.py --matrix 4000           # so many edges in every scene, as bits
    scripts/run test/python/dataset_campaign.py --rows 300 --write 300.jsonl [--paths]    # a manifest alone
    scripts/run test/python/dataset_campaign.py --overhead              # what a row costs beside its search; needs valgrind

Each row is a straight motion of a Panda between two postures near those of the saved paths, in one of their scenes, with the
verdict of 10 mm. Prints what each way took; ends with 1 where the tables differ. The environment variable CPROX may name the
program.
"""
import argparse
import collections
import csv
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


def write_paths(path, rows, query='tolerance'):
    """A manifest of so many of the saved paths themselves, in turns, with the verdict of 10 mm or another query."""
    files = sorted(glob.glob(os.path.join(DATA, 'trajectories', 'panda_*.yaml')))
    robot = os.path.join(DATA, 'robots', 'panda', 'panda.urdf')
    with open(path, 'w') as out:
        for i in range(rows):
            with open(files[i % len(files)]) as stream:
                saved = yaml.safe_load(stream)
            row = {'id': f'path{i}', 'robot': robot, 'srdf': robot[:-4] + 'srdf', 'scene': os.path.join(DATA, saved['scene']),
                   'query': query, **({'delta': 0.01} if query == 'tolerance' else {}),
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


def instructions_of(program, manifest, out):
    """All instructions of `certify`, and those of its searches."""
    profile = out + '.callgrind'
    subprocess.run(['valgrind', '--tool=callgrind', f'--callgrind-out-file={profile}', program, 'certify', '--dataset', manifest, '--out', out,
                    '--threads', '1'], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    text = subprocess.run(['callgrind_annotate', '--inclusive=yes', '--threshold=100', profile], check=True, stdout=subprocess.PIPE,
                          universal_newlines=True).stdout

    def count(name):
        return int(next(line for line in text.splitlines() if name in line).split('(')[0].replace(',', ''))
    return count('PROGRAM TOTALS'), count('curve_proximity::askEnvironment(')


def count_overhead(program):
    """What a row costs beside its search: the difference between 250 and 150 rows; and the time of a row."""
    kinds = {'edges': lambda path, rows: write_edges(path, rows, 1), 'verdicts about saved paths': write_paths,
             'distances of saved paths': lambda path, rows: write_paths(path, rows, 'distance')}
    with tempfile.TemporaryDirectory() as place:
        for kind, write in kinds.items():
            costs, seconds = [], []
            for rows in (150, 250, 3250):
                manifest, out = os.path.join(place, f'{kind}{rows}.jsonl'), os.path.join(place, f'{kind}{rows}')
                write(manifest, rows)
                if rows < 1000:
                    costs.append(instructions_of(program, manifest, out))
                if rows != 150:
                    begin = sum(os.times()[2:4])
                    subprocess.run([program, 'certify', '--dataset', manifest, '--out', out + '-timed', '--threads', '1'], check=True,
                                   stderr=subprocess.DEVNULL)
                    seconds.append(sum(os.times()[2:4]) - begin)
            whole, search = ((costs[1][i] - costs[0][i]) / 100 for i in (0, 1))
            print(f'{kind}: {whole - search:.0f} of {whole:.0f} instructions a row are not the search: {100 * (1 - search / whole):.1f} %; '
                  f'{(seconds[1] - seconds[0]) / 3000 * 1e3:.2f} ms of CPU a row')


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


def certify_row(line, program):
    """Answers a row of a manifest by `cprox tolerance`. Its verdict, and its certificate."""
    row = json.loads(line)
    with tempfile.TemporaryDirectory() as folder:
        certificate = os.path.join(folder, 'certificate')
        done = subprocess.run([program, 'tolerance', '--delta', str(row['delta']), *inputs_of(row, folder), '--certificate', certificate],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True)
        with open(certificate, 'rb') as stream:
            return next(csv.DictReader(done.stdout.splitlines()))['verdict'], stream.read()


def check_row(line, certificate, program):
    """What `cprox check` says of it: "proven: farther than ..."."""
    row = json.loads(line)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, 'certificate')
        with open(path, 'wb') as stream:
            stream.write(certificate)
        done = subprocess.run([program, 'check', path, *inputs_of(row, folder)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              universal_newlines=True)
        return done.stdout.split(': ', 1)[-1].strip()


def inputs_of(row, folder):
    """The words that name the inputs of a row; its trajectory becomes a file."""
    path = os.path.join(folder, 'trajectory.yaml')
    with open(path, 'w') as stream:
        json.dump(row['trajectory'], stream)
    return ['--robot', row['robot'], '--srdf', row['srdf'], '--scene', row['scene'], '--trajectory', path]


def recheck(client, manifest, table, count, seed, program='cprox'):
    """Random rows of a merged table, answered again by one worker; a clear one's certificate is checked by another. A hit of
    links that are meshes has no certificate. Returns how many of each verdict; RuntimeError where any of the two says otherwise."""
    with open(manifest) as stream:
        lines = stream.readlines()
    verdicts = [row['verdict'] for row in csv.DictReader(table.splitlines())]
    one, other = sorted(client.scheduler_info()['workers'])[:2]
    counts = collections.Counter()
    for row in random.Random(seed).sample(range(len(lines)), count):
        verdict, certificate = client.submit(certify_row, lines[row], program, workers=[one], pure=False).result()
        if verdict != verdicts[row]:
            raise RuntimeError(f'row {row} is {verdicts[row]} in the table, {verdict} on {one}')
        if verdict == 'clear':
            said = client.submit(check_row, lines[row], certificate, program, workers=[other], pure=False).result()
            if not said.startswith('proven: farther than 0.01 m everywhere'):
                raise RuntimeError(f'row {row}: {said}')
        counts[verdict] += 1
    return counts


def merge(cprox, folder, path):
    """One table of all shards. Its exit code says what the verdicts are; 2, that there is none."""
    code = subprocess.run([cprox, 'merge', folder, '--out', path], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
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
    parser.add_argument('--overhead', action='store_true', help='only this: instructions of a row beside its search')
    asked = parser.parse_args()
    if asked.overhead:
        return count_overhead(os.environ.get('CPROX', 'cprox'))
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
