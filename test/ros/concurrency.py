#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Several clients at once, and a scene that changes while they ask."""
import time
import unittest

from curve_proximity.msg import CollisionObject
from helpers import Call, Server, bezier, bspline, run, sphere, thing

SECONDS = 4.0  # of hammering


def again_and_again(work):
    """How often a piece of work was done."""
    server, end, rounds = Server(), time.monotonic() + SECONDS, 0
    while time.monotonic() < end:
        work(server, rounds)
        rounds += 1
    return rounds


class Concurrency(unittest.TestCase):
    def hammer(self, *works):
        for client in [Call(lambda work=work: again_and_again(work)) for work in works]:
            client.join(SECONDS + 20)
            self.assertIsNotNone(client.ended, 'a client is still waiting')
            if client.failure:
                raise client.failure
            self.assertGreater(client.response, 20)

    def test_each_client_gets_the_answer_to_its_own_query(self):
        Server().replace(sphere('ball', 0.25))

        def ask(height):
            def work(server, _):
                response = server.distance([bezier((-1, 0, height), (1, 0, height), id=str(height))])
                assert response.success and response.results[0].id == str(height), response.message
                assert abs(response.results[0].upper - (height - 0.25)) < 2e-6, response.results[0].upper
            return work
        self.hammer(ask(1.0), ask(2.0), ask(3.0))

    def test_answers_are_of_one_scene_or_the_other_while_it_changes(self):
        # Two balls move together, so that between the two scenes no answer is right: one near (0.75) and one far (1.75)
        # in each. A half-made change would show two near, two far, or a ball missing.
        def at(z, other):
            return [sphere('a', 0.25, (0, 0, z)), sphere('b', 0.25, (0, 0, other))]
        Server().replace(*at(0, -1))

        def change(server, n):
            if n % 3 == 2:
                moves = [thing('a', (0, 0, -1), operation=CollisionObject.MOVE),
                         thing('b', (0, 0, 0), operation=CollisionObject.MOVE)]
            else:
                moves = at(0, -1) if n % 3 == 0 else at(-1, 0)
            response = server.apply(*moves, clear=(n % 3 == 1))
            assert response.success, response.message

        def ask(server, _):
            response = server.distance([bezier((-1, 0, 1), (1, 0, 1))] * 3, per_object=True)
            assert response.success, response.message
            found = [(row.b, round(row.upper, 4)) for row in response.results]
            assert found[0:2] == found[2:4] == found[4:6], found
            assert sorted(found[0:2]) in ([('a', 0.75), ('b', 1.75)], [('a', 1.75), ('b', 0.75)]), found
        self.hammer(change, ask, ask)

    def test_changes_do_not_wait_for_a_long_query(self):
        server = Server()
        server.replace(sphere('ball', 0.25))
        n = 20000
        line = bspline([(i / 1e3, 0, 1) for i in range(n)], 3)
        long = Call(lambda: again_and_again(lambda s, _: s.distance([line] * 3, epsilon=1e-9)))
        slowest = 0.0
        while long.is_alive():
            begin = time.monotonic()
            self.assertTrue(server.apply(sphere('other', 0.1, (5, 5, 5))).success)
            slowest = max(slowest, time.monotonic() - begin)
        self.assertIsNone(long.failure)
        self.assertLess(slowest, 1.0)


if __name__ == '__main__':
    run('concurrency')
