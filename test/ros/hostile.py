#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Bytes that no honest client sends, under the memory limit: the node lives, and answers afterwards.

Seeded; CURVE_PROXIMITY_HOSTILE sets the number of connections."""
import os
import random
import socket
import struct

import rosgraph
from curve_proximity.msg import ProximityQuery
from curve_proximity.srv import Distance, DistanceRequest
from helpers import LINE, Case, Server, framed, handshake, header, host_and_port, run, serialized, sphere

CONNECTIONS = int(os.environ.get('CURVE_PROXIMITY_HOSTILE', 300))
MEMORY_MB = 2048
SEED = 20240607


def target_handshake(**fields):
    return handshake(**dict(dict(service='/hostile_target/distance', md5sum=Distance._md5sum), **fields))


def request():
    return serialized(DistanceRequest(ProximityQuery(curves=[LINE])))


def post(body, length=None, path='/RPC2'):
    return ('POST %s HTTP/1.1\r\nHost: x\r\nContent-Type: text/xml\r\nContent-Length: %s\r\n\r\n' %
            (path, len(body) if length is None else length)).encode() + body


class Attacker:
    """Makes connections of all kinds; keeps some open and never reads from them."""

    def __init__(self, seed):
        master = rosgraph.Master('/hostile')
        self.service = host_and_port(master.lookupService('/hostile_target/distance'))
        self.api = host_and_port(master.lookupNode('/hostile_target'))
        self.random, self.open = random.Random(seed), []

    def bytes(self, most):
        return bytes(self.random.getrandbits(8) for _ in range(self.random.randrange(1, most)))

    def kinds(self):
        r, good = self.random, request()
        call = '<?xml version="1.0"?><methodCall><methodName>%s</methodName><params>%s</params></methodCall>'
        parameter = '<param><value>%s</value></param>'
        return [
            (self.service, lambda: self.bytes(400)),
            (self.service, lambda: target_handshake()[:r.randrange(1, 60)]),
            (self.service, lambda: header(**{'': '', 'md5sum': '*'})),
            (self.service, lambda: target_handshake(md5sum='0' * 32) + framed(good)),
            (self.service, lambda: target_handshake(service='/hostile_target/none')),
            (self.service, lambda: struct.pack('<I', r.choice([0, 5, 0x7fffffff, 0xffffffff, 900000000])) + b'abc'),
            # a count of curves, points or names that the bytes do not hold
            (self.service, lambda: target_handshake() + framed(struct.pack('<I', r.choice([0xffffffff, 0x10000000])) + good[4:])),
            (self.service, lambda: target_handshake() + framed(good[:4] + struct.pack('<IIII', 1, 2, 3, 0xfffffff0) + good[20:])),
            (self.service, lambda: target_handshake() + framed(self.bytes(300))),
            # half a request; one that claims far more than it sends
            (self.service, lambda: target_handshake() + framed(good)[:r.randrange(1, len(good))]),
            (self.service, lambda: target_handshake() + framed(good, r.choice([999999999, 0xffffffff, 50000000]))),
            # clients that never read
            (self.service, lambda: target_handshake() + framed(good) * 50),
            (self.api, lambda: self.bytes(400)),
            (self.api, lambda: post(self.bytes(200))),
            (self.api, lambda: post(b'<methodCall>' * 200)),
            (self.api, lambda: post(b'x', r.choice([2**31 - 1, -5, 2**40, 'many']))),
            (self.api, lambda: post((call % ('publisherUpdate', parameter % '1' * 3)).encode())),
            (self.api, lambda: post((call % ('requestTopic', '')).encode())),
            (self.api, lambda: post((call % (self.bytes(20).hex(), parameter % '<array><data>' * 50)).encode()))]

    def connect(self, kind):
        address, data = kind
        try:
            connection = socket.create_connection(address, 5)
            connection.settimeout(1)
            connection.sendall(data())
        except OSError:
            return  # the node may hang up first
        end = self.random.choice(['close', 'reset', 'keep'])
        if end == 'keep':
            self.open.append(connection)
            while len(self.open) > 40:
                self.open.pop(0).close()
            return
        if end == 'reset':  # as when the client's process is killed
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        connection.close()


class Hostile(Case):
    def setUp(self):
        self.node, server = self.begin('hostile_target', memory_limit_mb=MEMORY_MB)
        server.replace(sphere('ball', 0.25))
        self.attacker = Attacker(SEED)

    def assertAnswers(self, after):
        self.assertTrue(self.node.alive(), 'the node died after %s: %s' % (after, self.node.output()[-2000:]))
        self.assertAlmostEqual(self.row(Server('/hostile_target').distance(LINE)).upper, 0.75, delta=2e-6)

    def test_hostile_connections_are_survived(self):
        kinds = self.attacker.kinds()
        for i in range(CONNECTIONS):
            self.attacker.connect(kinds[i] if i < len(kinds) else self.attacker.random.choice(kinds))
            if i < len(kinds) or i % 20 == 0:
                self.assertAnswers('connection %d' % i)
        for connection in self.attacker.open:
            connection.close()
        self.assertAnswers('all connections')


if __name__ == '__main__':
    run('hostile')
