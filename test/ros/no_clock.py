#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Without a clock ROS time stands still; nothing may wait on it."""
import time

import tf2_ros
from helpers import Case, Server, bezier, run, sphere, transform


class NoClock(Case):
    def test_a_missing_transform_is_told_within_the_timeout_on_the_wall_clock(self):
        server = Server()
        server.replace(sphere('ball', 0.25))
        fixed = tf2_ros.StaticTransformBroadcaster()
        fixed.sendTransform([transform('elsewhere', 'nowhere')])
        for _ in range(100):  # once the frame has been heard of it may come, and is waited for
            begin = time.monotonic()
            response = server.distance(bezier((0, 0, 1), (1, 0, 1), frame='nowhere'))
            waited = time.monotonic() - begin
            if 'nobody has published' not in response.message:
                break
            time.sleep(0.05)
        self.assertRefused(response, "'nowhere'", "'world'")
        self.assertGreater(waited, 0.4)
        self.assertLess(waited, 1.5)  # tf_timeout is 0.5 s; the rest is for a busy machine

    def test_queries_in_the_fixed_frame_are_answered(self):
        server = Server()
        server.replace(sphere('ball', 0.25))
        self.assertTrue(server.distance(bezier((0, 0, 1), (1, 0, 1))).success)


if __name__ == '__main__':
    run('no_clock')
