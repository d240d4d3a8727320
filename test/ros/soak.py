#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/soak: hours of everything at once. Half of the node's clients are honest, the others are not; every honest answer is
compared with that of a twin that nobody else asks. Seeded."""
import argparse
import io
import os
import random
import socket
import statistics
import struct
import subprocess
import sys
import threading
import time

import rosgraph
import rospy
from curve_proximity.msg import Body, CollisionObject, ProximityQuery
from curve_proximity.srv import ApplyScene, ApplySceneRequest, Distance, DistanceRequest
from helpers import Node, Server, bezier, bspline, box, free_port, ring_and_shells, sphere
from hostile import Attacker, framed, handshake

LIMIT_MB, ROOM_MB, GROWTH_MB = 512, 64, 32  # growth: from the first quarter of the time to the last one, medians
NODE, TWIN = 'hostile_target', 'twin'  # the attacker knows the first name


class Soak:
    def __init__(self, seconds):
        self.end = time.monotonic() + seconds
        self.lock = threading.Lock()
        self.counts = dict(calls=0, wrong=0, malformed=0, large=0, lost_frames=0, heavy=0, failures=0, busy=0)
        self.waits, self.first_wrong = [], None
        self.nodes = [Node(name, memory_limit_mb=LIMIT_MB, budget_ms=300, tf_timeout=0.3) for name in (NODE, TWIN)]
        self.scene = [sphere('ball%03d' % i, 0.05 + 0.001 * i, (i % 7 - 3, i // 7 - 3, 0.3 * (i % 5))) for i in range(50)]
        self.scene += [box('box%d' % i, (0.2, 0.3, 0.4), (i - 3, 0.5, 2)) for i in range(7)]
        for name in (NODE, TWIN):
            Server('/' + name).replace(*self.scene)

    def going(self):
        return time.monotonic() < self.end and self.nodes[0].alive()

    def add(self, **counts):
        with self.lock:
            for name, n in counts.items():
                self.counts[name] += n

    # ---- honest clients
    def asks(self, seed):
        """Curves that both servers answer; they must agree to the last bit."""
        r = random.Random(seed)
        objects = [o.id for o in self.scene]
        while self.going():
            server, twin = Server('/' + NODE), Server('/' + TWIN)
            for _ in range(200):
                points = [[r.uniform(-3, 3) for _ in range(3)] for _ in range(r.randrange(4, 12))]
                curve = bspline(points, 3, id='c', radius=r.choice([0, 0.05]))
                begin = time.monotonic()
                answer = server.distance(curve, objects=objects)
                waited = time.monotonic() - begin
                expected = twin.distance(curve, objects=objects)
                self.add(calls=1)
                with self.lock:
                    self.waits.append(waited)
                if not answer.success:
                    self.add(**({'busy': 1} if answer.status == 'busy' else {'failures': 1}))
                    continue
                a, b = answer.results[0], expected.results[0]
                if 'stopped' in (a.status, b.status):
                    continue
                if (a.lower, a.upper, a.b) != (b.lower, b.upper, b.b):
                    self.add(wrong=1)
                    self.first_wrong = self.first_wrong or (curve, a, b)
                if not self.going():
                    return

    def changes(self, seed):
        """Objects that no honest query names come and go."""
        r = random.Random(seed)
        server = Server('/' + NODE)
        while self.going():
            server.apply(sphere('other%d' % r.randrange(20), r.uniform(0.1, 1), (0, 0, r.uniform(5, 9))))
            time.sleep(0.01)

    # ---- others
    def is_heavy(self, _):
        ring, balls, fields = ring_and_shells(shells=20)
        server = Server('/' + NODE)
        while self.going():
            server.distance(ring, **fields)
            self.add(heavy=1)

    def loses_frames(self, _):
        server = Server('/' + NODE)
        while self.going():
            server.distance(bezier((0, 0, 1), (1, 0, 1), frame='nowhere'))
            self.add(lost_frames=1)
            time.sleep(0.005)

    def is_malformed(self, seed):
        master = rosgraph.Master('/soak')
        service = master.lookupService('/%s/distance' % NODE).split('//')[1].split(':')
        api = master.lookupNode('/' + NODE).split('//')[1].strip('/').split(':')
        attacker = Attacker((service[0], int(service[1])), (api[0], int(api[1])))
        attacker.random = random.Random(seed)
        kinds = attacker.kinds()
        while self.going():
            attacker.connect(attacker.random.choice(kinds))
            self.add(malformed=1)

    def is_large(self, seed):
        """Long names, millions of points, many empty strings, in turn."""
        r = random.Random(seed)
        body = CollisionObject(id='huge', bodies=[Body(type='points')])
        texts = []
        for n in (0, 1):
            body.bodies[0].vertices = [bezier((0, 0, 0)).points[0]] * n
            buffer = io.BytesIO()
            ApplySceneRequest(objects=[body]).serialize(buffer)
            texts.append(buffer.getvalue())
        at = next(i for i, (a, b) in enumerate(zip(*texts)) if a != b)

        def request():
            kind = r.randrange(3)
            if kind == 0:
                points = r.choice([1000000, 5000000, 12000000, 25000000])
                data = texts[0][:at] + struct.pack('<I', points) + os.urandom(24 << 10) * (points // 1024) + b'\0' * (
                    24 * (points % 1024)) + texts[0][at + 4:]
                return 'apply_scene', ApplyScene, data
            buffer = io.BytesIO()
            query = ProximityQuery(curves=[bezier((-1, 0, 1), (1, 0, 1), id='x' * 900000)], per_object=True) if kind == 1 else \
                ProximityQuery(objects=[''] * 3000000)
            DistanceRequest(query).serialize(buffer)
            return 'distance', Distance, buffer.getvalue()

        while self.going():
            service, kind, data = request()
            address = rosgraph.Master('/soak').lookupService('/%s/%s' % (NODE, service)).split('//')[1].split(':')
            try:
                with socket.create_connection((address[0], int(address[1])), 20) as connection:
                    connection.settimeout(60)
                    connection.sendall(handshake(service='/%s/%s' % (NODE, service), md5sum=kind._md5sum) + framed(data))
                    connection.recv(4096)
            except OSError:
                pass
            self.add(large=1)

    def run(self):
        memory = [self.nodes[0].resident_mb()]
        cheap = self.idle()
        works = [(self.asks, 3), (self.changes, 1), (self.is_heavy, 3), (self.loses_frames, 4), (self.is_malformed, 2), (self.is_large, 2)]
        threads = [threading.Thread(target=work, args=(i,), daemon=True) for work, n in works for i in range(n)]
        begin = time.monotonic()
        for thread in threads:
            thread.start()
        peak, next_report = 0.0, 0.0
        while self.going():
            now = self.nodes[0].resident_mb()
            peak = max(peak, now)
            memory.append(now)
            if time.monotonic() > next_report:
                next_report = time.monotonic() + max(5.0, (self.end - begin) / 20)
                print('%6.0f s  %5.0f MB  %s' % (time.monotonic() - begin, now, self.counts), flush=True)
            time.sleep(0.01)
        for thread in threads:
            thread.join(90)
        time.sleep(3)
        return self.report(memory, peak, cheap, begin)

    def idle(self):
        """The waits of one client alone [s]."""
        server, out = Server('/' + NODE), []
        for _ in range(500):
            begin = time.monotonic()
            server.distance(bezier((-1, 0, 1), (1, 0, 1)), objects=['ball001'])
            out.append(time.monotonic() - begin)
        return sorted(out)

    def report(self, memory, peak, cheap, begin):
        alive = self.nodes[0].alive()
        quarter = max(1, len(memory) // 4)
        before, after = statistics.median(memory[:quarter]), statistics.median(memory[-quarter:])
        rest = self.nodes[0].resident_mb() if alive else 0.0
        waits = sorted(self.waits)
        good = (alive and self.counts['wrong'] == 0 and self.counts['failures'] == 0 and peak < LIMIT_MB + ROOM_MB and
                after < before + GROWTH_MB)
        text = ['seconds %.0f' % (time.monotonic() - begin), str(self.counts),
                'memory [MB]: at rest before %.0f and after %.0f, first quarter %.0f, last quarter %.0f, peak %.0f (limit %d and %d)' % (
                    memory[0], rest, before, after, peak, LIMIT_MB, ROOM_MB),
                'idle client [ms]: p50 %.2f, p99 %.2f' % tuple(1e3 * cheap[int(q * len(cheap))] for q in (0.5, 0.99))]
        if waits:
            text.append('honest clients under load [ms]: p50 %.2f, p99 %.2f, worst %.0f' % (
                *(1e3 * waits[int(q * len(waits))] for q in (0.5, 0.99)), 1e3 * waits[-1]))
        if self.first_wrong:
            text.append('the first wrong answer:\n%s\n%s\n%s' % self.first_wrong)
        if not alive:
            text.append('the node died: ' + self.nodes[0].output()[-2000:])
        text.append('passed' if good else 'FAILED')
        for node in self.nodes:
            node.end()
        return good, '\n'.join(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--minutes', type=float, default=30.0)
    parser.add_argument('--out')
    options = parser.parse_args()
    port = free_port()
    os.environ.update(ROS_MASTER_URI='http://localhost:%d' % port, ROS_HOSTNAME='localhost')
    master = subprocess.Popen(['rosmaster', '--core', '-p', str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        while not rosgraph.Master('/soak').is_online():
            time.sleep(0.1)
        rospy.init_node('soak', disable_signals=True)
        good, text = Soak(60 * options.minutes).run()
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
