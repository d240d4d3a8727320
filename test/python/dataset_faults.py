#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Dask workers in three network namespaces, and what may happen to them: the table is that of one process, to the byte.

    sudo scripts/run test/python/dataset_faults.py --rows 3000 --shards 60 --seed 1

Edges of a Panda as in dataset_campaign.py, certified again and again; each time something else goes wrong midway: a worker is
killed, a worker's cable is pulled, a worker stops without dying, the scheduler is killed, a shard crashes wherever it runs, the
disk is full, a result file is torn. Then one row of a hundred is answered again with a certificate by one worker, which
another worker checks. Needs Linux, root and iproute2. Makes a bridge, three namespaces and small file systems in memory, and
removes them. The last line is `N passed, N failed`. The environment variable CPROX may name the program.
"""
import argparse
import contextlib
import glob
import os
import random
import signal
import stat
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

import dataset_campaign  # noqa: E402

BRIDGE, NETWORK = 'cprox0', '10.77.24.'
WORKERS = (1, 2, 3)
PORT = 8786
FULL = 64 << 10  # [bytes] of the disk that is full
PATIENCE = 60.0  # [s] for anything to happen
LOST_AFTER = '12s'  # so long a worker may say nothing; Dask takes no less than 11 s


def run(*words, **more):
    return subprocess.run(words, check=True, stdout=subprocess.DEVNULL, **more)


def wait_for(happened, what, driver=None):
    end = time.monotonic() + PATIENCE
    while not happened():
        if time.monotonic() > end:
            raise RuntimeError(f'{what}: not within {PATIENCE:g} s')
        if driver is not None and driver.poll() is not None:
            raise RuntimeError(f'{what}: all was done before')
        time.sleep(0.02)


@contextlib.contextmanager
def network():
    """A bridge at .1; namespaces cprox-1 … at .11 …, whose only way out it is."""
    def remove():
        for i in WORKERS:
            subprocess.run(['ip', 'netns', 'del', f'cprox-{i}'], stderr=subprocess.DEVNULL)
        subprocess.run(['ip', 'link', 'del', BRIDGE], stderr=subprocess.DEVNULL)
    remove()
    try:
        run('ip', 'link', 'add', BRIDGE, 'type', 'bridge')
        run('ip', 'addr', 'add', NETWORK + '1/24', 'dev', BRIDGE)
        run('ip', 'link', 'set', BRIDGE, 'up')
        for i in WORKERS:
            inside = ('ip', '-n', f'cprox-{i}')
            run('ip', 'netns', 'add', f'cprox-{i}')
            run('ip', 'link', 'add', f'cprox-v{i}', 'master', BRIDGE, 'type', 'veth', 'peer', 'name', 'eth0', 'netns', f'cprox-{i}')
            run('ip', 'link', 'set', f'cprox-v{i}', 'up')
            run(*inside, 'addr', 'add', f'{NETWORK}{10 + i}/24', 'dev', 'eth0')
            run(*inside, 'link', 'set', 'lo', 'up')
            run(*inside, 'link', 'set', 'eth0', 'up')
        yield
    finally:
        remove()


class Cluster:
    """A scheduler on the bridge, and a worker in each namespace."""

    def __init__(self, place):
        self.place, self.address = place, f'tcp://{NETWORK}1:{PORT}'
        self.log = open(os.path.join(place, 'cluster.log'), 'ab')
        self.scheduler, self.workers = None, {}

    def start(self, *words):
        settings = {'DASK_DISTRIBUTED__SCHEDULER__WORKER_TTL': LOST_AFTER, 'DASK_DISTRIBUTED__COMM__TIMEOUTS__TCP': LOST_AFTER,
                    'PYTHONPATH': HERE + os.pathsep + os.environ.get('PYTHONPATH', '')}
        return subprocess.Popen(words, stdout=self.log, stderr=self.log, stdin=subprocess.DEVNULL, env=dict(os.environ, **settings))

    def __enter__(self):
        self.scheduler = self.start('dask-scheduler', '--host', NETWORK + '1', '--port', str(PORT), '--no-dashboard')
        for i in WORKERS:
            self.workers[i] = self.start('ip', 'netns', 'exec', f'cprox-{i}', 'dask-worker', self.address, '--host', f'{NETWORK}{10 + i}',
                                         '--no-nanny', '--nthreads', '1', '--no-dashboard', '--name', str(i), '--local-directory', self.place)
        try:
            with self.client() as client:
                client.wait_for_workers(len(WORKERS), timeout=PATIENCE)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for process in [*self.workers.values(), self.scheduler]:
            if process.poll() is None:
                process.send_signal(signal.SIGKILL)
            process.wait()

    def client(self):
        from distributed import Client
        return Client(self.address, timeout=PATIENCE)

    def drive(self, manifest, out, shards, program):
        return subprocess.Popen([sys.executable, '-m', 'cprox_dask', manifest, '--out', out, '--shards', str(shards), '--scheduler', self.address,
                                 '--cprox', program], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, universal_newlines=True)


class Campaign:
    def __init__(self, asked, place, cprox):
        self.place, self.cprox, self.rows, self.shards, self.seed = place, cprox, asked.rows, asked.shards, asked.seed
        self.manifest = os.path.join(place, 'edges.jsonl')
        dataset_campaign.write_edges(self.manifest, asked.rows, asked.seed)
        alone = os.path.join(place, 'alone')
        run(cprox, 'certify', '--dataset', self.manifest, '--out', alone, '--threads', '1')
        self.truth = self.table(alone)

    def table(self, folder):
        path = folder + '.csv'
        dataset_campaign.merge(self.cprox, folder, path)
        with open(path, 'rb') as stream:
            return stream.read()

    def whole(self, out):
        return len(glob.glob(os.path.join(out, 'shard-*.csv')))

    def expect_truth(self, out):
        if self.table(out) != self.truth:
            raise RuntimeError('the table is another one')

    def finish(self, driver, code=0):
        said = driver.communicate(timeout=PATIENCE)[1]
        if driver.returncode != code:
            raise RuntimeError(f'the driver ended with {driver.returncode}: {said[-500:]}')
        return said

    def midway(self, name, happens):
        """Lets something happen when a third of the shards is whole. The driver is not to notice."""
        out = os.path.join(self.place, name)
        with Cluster(self.place) as cluster:
            driver = cluster.drive(self.manifest, out, self.shards, self.cprox)
            wait_for(lambda: self.whole(out) >= self.shards // 3, name, driver)
            after = happens(cluster)
            self.finish(driver)
            if after:
                after()
        self.expect_truth(out)
        return f'after {self.shards // 3} of {self.shards} shards'

    # ---- what goes wrong ----

    def a_worker_is_killed(self):
        return self.midway('killed', lambda cluster: cluster.workers[1].send_signal(signal.SIGKILL))

    def a_cable_is_pulled(self):
        def pull(_):
            run('ip', 'link', 'set', 'cprox-v2', 'down')
            return lambda: run('ip', 'link', 'set', 'cprox-v2', 'up')
        return self.midway('cable', pull)

    def a_worker_stops_without_dying(self):
        def stop(cluster):
            cluster.workers[3].send_signal(signal.SIGSTOP)
        return self.midway('stopped', stop)

    def the_scheduler_is_killed_and_the_command_given_again(self):
        out = os.path.join(self.place, 'scheduler')
        with Cluster(self.place) as cluster:
            driver = cluster.drive(self.manifest, out, self.shards, self.cprox)
            wait_for(lambda: self.whole(out) >= self.shards // 3, 'scheduler', driver)
            cluster.scheduler.send_signal(signal.SIGKILL)
            cluster.scheduler.wait()
            said = driver.communicate(timeout=PATIENCE)[1]
            if driver.returncode != 2 or 'cprox_dask: the scheduler is lost' not in said:
                raise RuntimeError(f'the driver ended with {driver.returncode}: {said[-500:]}')
        before = self.whole(out)
        with Cluster(self.place) as cluster:
            self.finish(cluster.drive(self.manifest, out, self.shards, self.cprox))
        self.expect_truth(out)
        return f'with {before} of {self.shards} shards'

    def a_shard_crashes_wherever_it_runs(self):
        out, program, bad = os.path.join(self.place, 'poison'), os.path.join(self.place, 'poison.sh'), self.shards // 2
        with open(program, 'w') as script:
            script.write(f'#!/bin/sh\ncase "$*" in *--failed*) ;; *"--shard {bad}") kill -SEGV $$;; esac\nexec "{self.cprox}" "$@"\n')
        os.chmod(program, os.stat(program).st_mode | stat.S_IXUSR)
        with Cluster(self.place) as cluster:
            said = self.finish(cluster.drive(self.manifest, out, self.shards, program), 2)
        if f'shard {bad}: given up after 3 attempts: signal 11' not in said:
            raise RuntimeError(f'the driver does not name it: {said[-300:]}')
        path = out + '.csv'
        subprocess.run([self.cprox, 'merge', out, '--out', path], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with open(path, 'rb') as stream:
            lines, truth = stream.read().splitlines(), self.truth.splitlines()
        first, last = 1 + bad * self.rows // self.shards, 1 + (bad + 1) * self.rows // self.shards
        if lines[:first] + lines[last:] != truth[:first] + truth[last:] or not all(b',failed,' in line for line in lines[first:last]):
            raise RuntimeError('other rows than its own are failed')
        return f'its {last - first} rows are failed'

    def the_disk_is_full(self):
        out = os.path.join(self.place, 'full')
        os.makedirs(out)
        run('mount', '-t', 'tmpfs', '-o', f'size={FULL}', 'cprox', out)
        try:
            with Cluster(self.place) as cluster:
                said = self.finish(cluster.drive(self.manifest, out, self.shards, self.cprox), 2).strip().splitlines()
                before = self.whole(out)
                if not 0 < before < self.shards or 'No space left' not in said[-1]:
                    raise RuntimeError(f'{before} shards; the driver said: {said[-1]}')
                run('mount', '-o', 'remount,size=100m', out)
                self.finish(cluster.drive(self.manifest, out, self.shards, self.cprox))
            self.expect_truth(out)
        finally:
            run('umount', out)
        return f'after {before} of {self.shards} shards'

    def result_files_are_torn(self):
        out, rng = os.path.join(self.place, 'torn'), random.Random(self.seed)
        with Cluster(self.place) as cluster:
            self.finish(cluster.drive(self.manifest, out, self.shards, self.cprox))
            torn = rng.sample(sorted(glob.glob(os.path.join(out, 'shard-*.csv'))), 5)
            for path in torn:
                os.truncate(path, rng.randrange(os.path.getsize(path)))
            self.finish(cluster.drive(self.manifest, out, self.shards, self.cprox))
        self.expect_truth(out)
        return f'{len(torn)} of {self.shards}'

    def any_cut_and_any_number_of_workers_give_the_same(self):
        for count in (1, 2, 4):
            for shards in (1, 7, 64):
                out = os.path.join(self.place, f'cut-{count}-{shards}')
                failures, _ = dataset_campaign.certify_on_cluster(self.manifest, out, shards, count, self.cprox)
                if failures:
                    raise RuntimeError(str(failures[0]))
                self.expect_truth(out)
        return '1, 2 and 4 workers, 1, 7 and 64 shards'

    def another_worker_verifies_one_row_of_a_hundred(self):
        with Cluster(self.place) as cluster, cluster.client() as client:
            proven = dataset_campaign.recheck(client, self.manifest, self.truth.decode(), max(self.rows // 100, 10), self.seed, self.cprox)
        return f'{proven["clear"]} clear, proven; {proven["violated"]} violated, answered again'


FACTS = (Campaign.a_worker_is_killed, Campaign.a_cable_is_pulled, Campaign.a_worker_stops_without_dying,
         Campaign.the_scheduler_is_killed_and_the_command_given_again, Campaign.a_shard_crashes_wherever_it_runs, Campaign.the_disk_is_full,
         Campaign.result_files_are_torn, Campaign.any_cut_and_any_number_of_workers_give_the_same,
         Campaign.another_worker_verifies_one_row_of_a_hundred)


def run_facts(facts, campaign):
    """Runs each, prints what it says of itself and how many failed; the process's exit code."""
    failed = 0
    for fact in facts:
        begin = time.monotonic()
        try:
            print(f'{fact.__name__}: {fact(campaign)} ({time.monotonic() - begin:.0f} s)', flush=True)
        except (RuntimeError, OSError, subprocess.SubprocessError) as error:
            failed += 1
            print(f'FAILED {fact.__name__}: {error}', flush=True)
    print(f'{len(facts) - failed} passed, {failed} failed')
    return 1 if failed or not facts else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--rows', type=int, default=3000)
    parser.add_argument('--shards', type=int, default=60)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('names', nargs='*', help='only these')
    asked = parser.parse_args()
    if os.geteuid() != 0:
        print('dataset_faults.py: needs root: network namespaces and a file system in memory', file=sys.stderr)
        return 2
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(130))  # so that nothing is left behind
    with tempfile.TemporaryDirectory(prefix='cprox-faults-') as place, network():
        campaign = Campaign(asked, place, os.environ.get('CPROX', 'cprox'))
        return run_facts([fact for fact in FACTS if not asked.names or fact.__name__ in asked.names], campaign)


if __name__ == '__main__':
    sys.exit(main())
