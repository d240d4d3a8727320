# SPDX-License-Identifier: BSD-3-Clause
"""Certifies a dataset on Dask workers: a shard a task, each a process `cprox certify` of its own.

    python3 -m cprox_dask data.jsonl --out results --shards 64 --workers 4
    python3 -m cprox_dask data.jsonl --out results --shards 64 --scheduler tcp://head:8786 -- --epsilon 1e-4

A task leaves nothing but its shard's file, so whatever is lost, a worker or the scheduler, the same command goes on: shards
that are whole are skipped. Workers need the program cprox, this module, and the dataset's files under the same paths.
"""
import collections
import ctypes
import os
import signal
import subprocess
import sys
import time
import uuid

__all__ = ['Failure', 'certify', 'certify_shard']

Failure = collections.namedtuple('Failure', 'shard attempts message')
Failure.__doc__ = 'A shard whose rows are marked failed, after so many attempts; what the last one said.'

PR_SET_PDEATHSIG = 1
LIBC = ctypes.CDLL(None)


def die_with_worker():
    """A worker that is killed leaves no process behind (Linux)."""
    LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def certify_shard(command, timeout=None):
    """Runs a command on a worker. None, or what went wrong: an exit code other than 0, a signal, or the time is up."""
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               preexec_fn=die_with_worker)
    try:
        said = process.communicate(timeout=timeout)[1].decode(errors='replace').strip().splitlines()
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return f'took longer than {timeout:g} s'
    if process.returncode == 0:
        return None
    ended = f'signal {-process.returncode}' if process.returncode < 0 else f'exit code {process.returncode}'
    return f'{ended}: {said[-1]}' if said else ended


def certify(client, dataset, out, shards, cprox='cprox', options=(), attempts=3, timeout=None, progress=None):
    """Certifies all shards of a dataset on the workers of a distributed.Client, and returns the Failures.

    A shard that cannot be certified so many times is written with a row `failed` for each of its rows, so that `cprox merge`
    has no gap; remove its file to have it done again. Calls progress(done, shards) after each shard. RuntimeError where not
    even that can be written, as on a full disk, and where the scheduler is lost."""
    from distributed import as_completed

    base = [cprox, 'certify', '--dataset', os.path.abspath(dataset), '--out', os.path.abspath(out), '--shards', str(shards),
            '--threads', '1', *options]
    run = uuid.uuid4().hex  # Dask takes a task of the same key for the same task, done already
    asked = {}  # future: shard, attempt, what the attempt before said where this one marks the shard

    def submit(shard, attempt, fault=None):
        command = base + ['--shard', str(shard)]
        if fault is not None:
            command += ['--failed', f'the shard was given up after {attempts} attempts: {fault}']
        future = client.submit(certify_shard, command, timeout, key=f'cprox-{run}-{shard}-{attempt}', pure=False)
        asked[future] = (shard, attempt, fault)
        return future

    failures, done = [], 0
    running = as_completed([submit(shard, 1) for shard in range(shards)])
    for future in running:
        shard, attempt, fault = asked.pop(future)
        try:
            said = future.result()
        except Exception as error:  # the worker died so often that Dask gave up; or it has no cprox
            if client.status != 'running':
                raise RuntimeError('the scheduler is lost; shards that are whole are kept, the same command goes on') from error
            said = f'{type(error).__name__}: {error}'.splitlines()[0]
        if said is None:
            done += 1
            if fault is not None:
                failures.append(Failure(shard, attempts, fault))
            if progress:
                progress(done, shards)
        elif fault is not None:
            raise RuntimeError(f'shard {shard}: {fault}; it cannot be marked failed: {said}')
        else:
            running.add(submit(shard, attempt + 1, said if attempt == attempts else None))
    return sorted(failures)


class ProgressLine:
    """On standard error: how many shards are whole, how fast, how long it will take."""

    def __init__(self):
        self.begin = time.monotonic()

    def __call__(self, done, shards):
        rate = done / max(time.monotonic() - self.begin, 1e-9)
        text = f'{done} of {shards} shards, {rate:.2f} a second, {(shards - done) / rate:.0f} s to go'
        end = '\n' if done == shards or not sys.stderr.isatty() else '\r'
        sys.stderr.write(text.ljust(70) + end if sys.stderr.isatty() else text + end)
        sys.stderr.flush()
