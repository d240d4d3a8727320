#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints a TCP port for a ROS master of our own. It lies below the range from which the system takes the ports of outgoing
connections: one of that range can be taken by any program before the master listens on it."""
import random
import socket

LOWEST = 15000


def free_port():
    with open('/proc/sys/net/ipv4/ip_local_port_range') as text:
        end = int(text.read().split()[0])
    for port in random.sample(range(LOWEST, max(end, LOWEST + 1000)), 200):
        with socket.socket() as probe:
            try:
                probe.bind(('', port))
                return port
            except OSError:
                pass
    raise OSError('no free port was found')


if __name__ == '__main__':
    print(free_port())
