#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the server, and runs it again when it has died or its master has forgotten it. Ends when the server ends by itself: a
configuration that is wrong (exit code 1) is not tried again. For roslaunch's launch-prefix, with required="true".

    keep_running.py COMMAND ..."""
import signal
import subprocess
import sys
import time


def main():
    ending, child = [], None

    def stop(*_):
        ending.append(True)
        if child is not None and child.poll() is None:
            child.send_signal(signal.SIGINT)

    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    while True:
        child = subprocess.Popen(sys.argv[1:])
        code = child.wait()
        if ending or code in (0, 1):
            return 0 if ending else code
        print('the server ended with code %d: it starts again' % code, file=sys.stderr, flush=True)
        for _ in range(20):
            time.sleep(0.1)
            if ending:
                return 0


if __name__ == '__main__':
    sys.exit(main())
