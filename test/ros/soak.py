#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/soak: hours of everything at once. Half of the node's clients are honest, the others are not; every honest answer is
compared with that of a twin that nobody else asks. Seeded."""
import argparse
import json
import os
import random
import statistics
import subprocess
import sys
import threading
import time

import rospy
from curve_proximity.msg import ProximityQuery
from curve_proximity.srv import ApplyScene, Distance, DistanceRequest
from helpers import Node, RawClient, Server, bezier, bspline, box, free_port, raw_call, request_of_points, ring_and_shells, serialized, sphere, start_master, transform
from hostile import Attacker
from tf2_ros import StaticTransformBroadcaster

LIMIT_MB, ROOM_MB, GROWTH_MB = 512, 64, 32  # growth: from the first quarter of the time to the last one, medians
LARGEST, SENDERS = 12000000, 2              # points of one message, of 24 bytes each, and how many clients send such
WIRE_MB = SENDERS * 24 * LARGEST >> 20      # roscpp reads a message whole, before the node sees its size
NODE, TWIN = 'hostile_target', 'twin'  # the attacker knows the first name
PROCESSES, CLIENTS, CURVES = 2, 4, 2000  # honest processes, clients in each, curves that each knows the answers of


def scene():
    balls = [sphere('ball%03d' % i, 0.05 + 0.001 * i, (i % 7 - 3, i // 7 - 3, 0.3 * (i % 5))) for i in range(50)]
    return balls + [box('box%d' % i, (0.2, 0.3, 0.4), (i - 3, 0.5, 2)) for i in range(7)]


def honest(seed, end, report, n_clients, n_curves):
    """A process of clients that ask some curves again and again until `end` on the monotonic clock, and compare each answer
    with that of the twin, to the last bit. Calls report(counts, waits, the first wrong answer) at the end and each few seconds."""
    r = random.Random(seed)
    names = [o.id for o in scene()]
    requests = []
    for _ in range(n_curves):
        points = [[r.uniform(-3, 3) for _ in range(3)] for _ in range(r.randrange(4, 12))]
        curve = bspline(points, 3, id='c', radius=r.choice([0, 0.05]))
        requests.append(serialized(DistanceRequest(ProximityQuery(curves=[curve], objects=names))))
    twin = RawClient('/' + TWIN + '/distance', Distance)
    expected = [twin.call(request).results[0] for request in requests]
    lock = threading.Lock()
    counts, waits, wrong = dict(calls=0, wrong=0, busy=0, failures=0, stopped=0), [], []

    def ask(seed):
        r, client, mine = random.Random(seed), None, []
        while time.monotonic() < end:
            i = r.randrange(n_curves)
            begin = time.monotonic()
            try:
                client = client or RawClient('/' + NODE + '/distance', Distance)
                answer = client.call(requests[i])
            except OSError:
                client, answer = None, None
            waited = time.monotonic() - begin
            mine.append(waited)
            kind = 'failures'
            if answer and answer.status == 'busy':
                kind = 'busy'
            elif answer and answer.success:
                a, b = answer.results[0], expected[i]
                same = (a.lower, a.upper, a.t, a.b, a.witness_a, a.witness_b) == (b.lower, b.upper, b.t, b.b, b.witness_a, b.witness_b)
                kind = 'stopped' if a.status == 'stopped' else 'calls' if same else 'wrong'
                if kind == 'wrong':
                    wrong.append('%s\n%s\n%s' % (i, a, b))
            with lock:
                counts[kind] += 1
                if len(mine) > 200:
                    waits.extend(mine)
                    mine.clear()
        with lock:
            waits.extend(mine)

    clients = [threading.Thread(target=ask, args=(1000 * seed + i,), daemon=True) for i in range(n_clients)]
    for client in clients:
        client.start()
    while True:
        alive = any(client.is_alive() for client in clients)
        with lock:
            report(dict(counts), waits[:], wrong[:1])
            waits.clear()
        if not alive:
            return
        clients[0].join(2)


def malformed(seed, end, report):
    """A process that makes connections of all kinds that hostile.py knows."""
    attacker = Attacker(seed)
    kinds = attacker.kinds()
    made, next_report = 0, 0.0
    while time.monotonic() < end:
        attacker.connect(attacker.random.choice(kinds))
        made += 1
        if time.monotonic() > next_report:
            next_report = time.monotonic() + 2
            report(dict(malformed=made), [], [])
    report(dict(malformed=made), [], [])


def heavy(seed, end, report, n_clients):
    """A process of clients whose requests would take the node seconds each, were there no budget. They are made once: what the node
    is asked to do is the load, not what Python does to ask."""
    ring, _, fields = ring_and_shells(shells=20)
    request = serialized(DistanceRequest(ProximityQuery(curves=[ring], **fields)))
    lock, counts = threading.Lock(), dict(heavy=0, closed=0)

    def ask():
        client = None
        while time.monotonic() < end:
            kind = 'heavy'
            try:
                client = client or RawClient('/' + NODE + '/distance', Distance)
                client.call(request)
            except OSError:
                client, kind = None, 'closed'
            with lock:
                counts[kind] += 1
    clients = [threading.Thread(target=ask, daemon=True) for _ in range(n_clients)]
    for client in clients:
        client.start()
    while any(client.is_alive() for client in clients):
        clients[0].join(2)
        with lock:
            report(dict(counts), [], [])


class Soak:
    def __init__(self, seconds, cgroup=None):
        self.seconds, self.end = seconds, 0.0
        self.lock = threading.Lock()
        self.counts = dict(large=0, lost_frames=0, changes=0, closed=0, ended_badly=0)
        self.waits, self.first_wrong, self.others = [], None, {}
        limits = dict(memory_limit_mb=LIMIT_MB, budget_ms=300, tf_timeout=0.3)
        self.nodes = [Node(NODE, cgroup=cgroup, **limits), Node(TWIN, **limits)]
        for name in (NODE, TWIN):
            Server('/' + name).replace(*scene())

    def going(self):
        return time.monotonic() < self.end and self.nodes[0].alive()

    def add(self, **counts):
        with self.lock:
            for name, n in counts.items():
                self.counts[name] += n

    # ---- in processes of their own
    def follow(self, part, seed, *more):
        """Reads what a process reports."""
        arguments = [part, seed, self.end, *more]
        process = subprocess.Popen([sys.executable, os.path.abspath(__file__), '--part', *map(str, arguments)], stdout=subprocess.PIPE, text=True)
        for line in process.stdout:
            counts, waits, wrong = json.loads(line)
            with self.lock:
                self.others[process.pid] = counts
                self.waits += waits
                self.first_wrong = self.first_wrong or (wrong[0] if wrong else None)
        if process.wait() != 0:
            self.add(ended_badly=1)

    def counted(self):
        with self.lock:
            total = dict(self.counts)
            for counts in self.others.values():
                for name, n in counts.items():
                    total[name] = total.get(name, 0) + n
            return total

    # ---- in this process
    def again_and_again(self, work, **counts):
        """work(server). A connection is closed that announces more than the others have left of the memory: then by another one."""
        server = None
        while self.going():
            try:
                server = server or Server('/' + NODE)
                work(server)
                self.add(**counts)
            except (rospy.ServiceException, rospy.ROSException):
                server = None
                self.add(closed=1)

    def changes(self, seed):
        """Objects that no honest query names come and go."""
        r = random.Random(seed)

        def change(server):
            server.apply(sphere('other%d' % r.randrange(20), r.uniform(0.1, 1), (0, 0, r.uniform(5, 9))))
            time.sleep(0.01)
        self.again_and_again(change, changes=1)

    def loses_frames(self, seed):
        """Frames that are waited for, and some that nobody has heard of."""
        r = random.Random(seed)

        def lose(server):
            server.distance(bezier((0, 0, 1), (1, 0, 1), frame='island' if r.random() < 0.9 else 'nowhere'))
            time.sleep(0.005)
        self.again_and_again(lose, lost_frames=1)

    def is_large(self, seed):
        """Long names, millions of points, many empty strings, in turn."""
        r = random.Random(seed)

        def request():
            kind = r.randrange(3)
            if kind == 0:
                points = r.choice([1000000, 5000000, LARGEST])
                data = request_of_points(os.urandom(24 << 10) * (points // 1024) + b'\0' * (24 * (points % 1024)))
                return 'apply_scene', ApplyScene, data
            query = ProximityQuery(curves=[bezier((-1, 0, 1), (1, 0, 1), id='x' * 900000)], per_object=True) if kind == 1 else \
                ProximityQuery(objects=[''] * 3000000)
            return 'distance', Distance, serialized(DistanceRequest(query))

        while self.going():
            service, kind, data = request()
            raw_call('/%s/%s' % (NODE, service), kind, data)
            self.add(large=1)

    def run(self):
        broadcaster = StaticTransformBroadcaster()  # no way leads from it to the node's frame
        broadcaster.sendTransform(transform('elsewhere', 'island'))
        memory = [self.nodes[0].resident_mb()]
        begin = next_report = time.monotonic()
        self.end = begin + self.seconds
        works = [(lambda seed: self.follow('honest', seed, CLIENTS, CURVES), PROCESSES), (self.changes, 1),
                 (lambda seed: self.follow('heavy', seed, 3), 1), (self.loses_frames, 4),
                 (lambda seed: self.follow('malformed', seed), 4), (self.is_large, SENDERS)]
        threads = [threading.Thread(target=work, args=(i,), daemon=True) for work, n in works for i in range(n)]
        for thread in threads:
            thread.start()
        while self.going():
            memory.append(self.nodes[0].resident_mb())
            if time.monotonic() > next_report:
                next_report = time.monotonic() + max(5.0, self.seconds / 20)
                print('%6.0f s  %5.0f MB  %s' % (time.monotonic() - begin, memory[-1], self.counted()), flush=True)
            time.sleep(0.01)
        for thread in threads:
            thread.join(90)
        time.sleep(3)
        return self.report(memory, sorted(self.waits), begin)

    def report(self, memory, waits, begin):
        alive = self.nodes[0].alive()
        quarter = max(1, len(memory) // 4)
        before, after = statistics.median(memory[:quarter]), statistics.median(memory[-quarter:])
        rest = self.nodes[0].resident_mb() if alive else 0.0
        counts = self.counted()
        bad = {name: counts.get(name, 0) for name in ('wrong', 'failures', 'ended_badly')}

        def quantile(q):  # [ms]
            return 1e3 * waits[int(q * len(waits))] if waits else float('nan')
        verdicts = []

        def demand(what, value, good):
            verdicts.append(good)
            return '%-7s %s: %s' % ('passed' if good else 'FAILED', what, value)

        text = ['seconds %.0f' % (time.monotonic() - begin), str(counts),
                'memory [MB]: at rest before %.0f and after %.0f' % (memory[0], rest),
                'an honest client [ms]: p50 %.2f, p99 %.2f, worst %.1f' % (quantile(0.5), quantile(0.99), quantile(0.9999999)),
                 demand('the node lives', 'yes' if alive else self.nodes[0].output()[-2000:], alive),
                 demand('wrong answers, failed calls, processes that ended badly', '%(wrong)d, %(failures)d, %(ended_badly)d' % bad,
                        counts.get('calls', 0) > 0 and sum(bad.values()) == 0),
                 demand('memory is below the limit of %d MB, %d and %d of messages on their way' % (LIMIT_MB, ROOM_MB, WIRE_MB), '%.0f MB at most' % max(memory),
                        max(memory) < LIMIT_MB + ROOM_MB + WIRE_MB),
                 demand('memory is flat, within %d MB' % GROWTH_MB, 'first quarter %.0f MB, last quarter %.0f MB' % (before, after), after < before + GROWTH_MB)]
        if self.first_wrong:
            text.append('the first wrong answer:\n' + self.first_wrong)
        text.append('passed' if all(verdicts) else 'FAILED')
        for node in self.nodes:
            node.end()
        return all(verdicts), '\n'.join(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--minutes', type=float, default=30.0)
    parser.add_argument('--out')
    parser.add_argument('--cgroup', metavar='FOLDER', help='of a memory cgroup with a limit, made for the node alone')
    parser.add_argument('--part', nargs='+', metavar=('PART', 'SEED'), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.part:
        part, seed, end, *more = options.part
        return dict(honest=honest, malformed=malformed, heavy=heavy)[part](
            int(seed), float(end), lambda *report: print(json.dumps(report), flush=True), *map(int, more))
    port = free_port()
    os.environ.update(ROS_MASTER_URI='http://localhost:%d' % port, ROS_HOSTNAME='localhost')
    master = start_master(port)
    try:
        rospy.init_node('soak', disable_signals=True)
        good, text = Soak(60 * options.minutes, options.cgroup).run()
    finally:
        master.terminate()
        master.wait()
    print(text)
    if options.out:
        with open(options.out, 'w') as file:
            file.write(text + '\n')
    return 0 if good else 1


if __name__ == '__main__':
    sys.exit(main())
