# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m cprox_dask: a dataset on a Dask cluster of this machine, or on the workers of a scheduler."""
import argparse
import sys

from . import ProgressLine, certify


def main():
    words, options = sys.argv[1:], []
    if '--' in words:
        words, options = words[:words.index('--')], words[words.index('--') + 1:]
    parser = argparse.ArgumentParser(prog='python3 -m cprox_dask', description=__doc__, epilog='What follows -- goes to cprox certify.')
    parser.add_argument('dataset', help='the manifest')
    parser.add_argument('--out', required=True, help='the folder of the shards')
    parser.add_argument('--shards', type=int, required=True)
    parser.add_argument('--scheduler', help='address of a Dask scheduler; default: a cluster of this machine')
    parser.add_argument('--workers', type=int, help='of the cluster of this machine; default: as many as it has processors')
    parser.add_argument('--attempts', type=int, default=3, help='so often a shard is tried before its rows are marked failed')
    parser.add_argument('--timeout', type=float, help='seconds that a shard may take')
    parser.add_argument('--cprox', default='cprox', help='the program on the workers')
    asked = parser.parse_args(words)
    if asked.shards < 1 or asked.attempts < 1:
        parser.error('--shards and --attempts must be at least 1')
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        print('cprox_dask: needs Dask: apt-get install python3-distributed, or pip install distributed', file=sys.stderr)
        return 2
    cluster = asked.scheduler or LocalCluster(n_workers=asked.workers, threads_per_worker=1, processes=True)
    try:
        with Client(cluster) as client:
            print(f'scheduler {client.scheduler.address}, dashboard {client.dashboard_link}', file=sys.stderr)
            failures = certify(client, asked.dataset, asked.out, asked.shards, asked.cprox, options, asked.attempts, asked.timeout,
                               ProgressLine())
    except RuntimeError as error:
        print(f'cprox_dask: {error}', file=sys.stderr)
        return 2
    finally:
        if not asked.scheduler:
            cluster.close()
    for failure in failures:
        print(f'shard {failure.shard}: given up after {failure.attempts} attempts: {failure.message}', file=sys.stderr)
    return 2 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
