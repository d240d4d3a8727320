#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A gate with ~verify believes no server: it reads scene and robot itself and checks each proof. Here the server lies in all the ways
that one could think of: about the scene, the robot, the motion, the verdict, the proof. Each lie is caught."""
import copy
import random
import struct
import threading
import time

import rospy
from actionlib_msgs.msg import GoalStatus
from curve_proximity.msg import AllowedContact, CollisionObject, Curve, Refusal
from curve_proximity.srv import Tolerance, ToleranceResponse
from gate import FAR, POST, ArmCase, Goal, ends_of, turning
from helpers import Server, bezier, box, connected, heard, mesh, run, sphere, transform, until
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory

APART, NEAR = 1, 2
DELTA = 0.05
CLAIM, LIMIT = 16, 8  # where the head of a certificate has its claim and its limit


class Liar:
    """The server that the gate asks. It asks an honest one, and lies as it is told."""

    def __init__(self):
        self.asks = {name: rospy.ServiceProxy('/%s/tolerance' % name, Tolerance) for name in ('curve_proximity', 'other', 'stranger')}
        for ask in self.asks.values():
            ask.wait_for_service(20)
        self.lie, self.asked, self.frozen = None, 0, None
        self.service = rospy.Service('/liar/tolerance', Tolerance, self.answer)

    def honest(self, request, server='curve_proximity'):
        return self.asks[server](request)

    def answer(self, request):
        nothing = not (request.query.trajectories or request.query.curves)
        self.asked += not nothing
        response = self.honest(request) if nothing or self.lie is None else self.lie(request)
        if self.frozen is not None:  # for ever the scene of then
            response.scene.version = self.frozen
        return response


def clear(response):
    """All is well, says every row."""
    response.success, response.message = True, ''
    for row in response.results:
        row.status, row.verdict, row.lower, row.upper, row.message = 'ok', 'clear', 1.0, 2.0, ''
    return response


def proofs(response, change):
    for row in response.results:
        row.certificate = change(bytes(row.certificate))
    return response


def put(at, form, value):
    return lambda proof: proof[:at] + struct.pack(form, value) + proof[at + struct.calcsize(form):]


class Verified(ArmCase):
    STATES = '/joint_states'

    @classmethod
    def setUpClass(cls):
        cls.liar = Liar()
        super().setUpClass()
        cls.reading, cls.server, cls.other, cls.stranger = (
            Server(name) for name in ('/gate/reading', '/curve_proximity', '/other', '/stranger'))
        cls.refused = heard('/gate/refused', Refusal)
        assert connected(cls.states)

    def setUp(self):
        self.arm.rest()
        self.liar.lie, self.liar.frozen = None, None
        self.everywhere(FAR)

    def everywhere(self, *objects, **fields):
        for server in (self.reading, self.server, self.other, self.stranger):
            server.replace(*objects, **fields)

    def send(self, trajectory=None):
        """How a goal ends that was sent to the gate, and why; for one that passes at once that it did."""
        if self.arm.position() != 0.0:
            self.arm.rest()
        begun = self.controller.begun
        self.client.send_goal(Goal(trajectory=trajectory or turning(3.0, 1.5)))
        state, why = ends_of(self.client)
        self.assertEqual(self.controller.begun, begun + (state != GoalStatus.REJECTED))
        return state, why

    def caught(self, lie, name, trajectory=None):
        self.liar.lie = lie
        asked = self.liar.asked
        state, why = self.send(trajectory)
        self.assertEqual(state, GoalStatus.REJECTED, name)
        self.assertGreater(self.liar.asked, asked, name)
        self.assertTrue(why, name)
        return why

    def asking(self, change=None, server='curve_proximity'):
        """Asks something else than it is asked, and hands the honest answer to that on as if it were the answer."""
        def lie(request):
            other = copy.deepcopy(request)
            if change:
                change(other)
            return clear(self.liar.honest(other, server))
        return lie

    def test_an_honest_answer_passes_and_an_honest_refusal_names_the_pair(self):
        self.assertEqual(self.send()[0], GoalStatus.SUCCEEDED)
        self.everywhere(POST)
        self.assertEqual(self.send()[0], GoalStatus.REJECTED)
        self.assertIn("'post'", self.client.get_result().error_string)

    def test_an_honest_answer_passes_among_boxes_meshes_and_what_the_arm_carries(self):
        corners = [(1, 1, 0), (2, 1, 0), (1, 2, 0), (1, 1, 1)]
        shape = mesh('tetrahedron', corners, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
        self.everywhere(FAR, box('table', (1, 1, 0.1), (0, 0, -1)), shape)
        self.assertEqual(self.send(), (GoalStatus.SUCCEEDED, ''))

    def test_a_lie_about_the_verdict_is_caught(self):
        self.everywhere(POST)
        self.assertIn('comes as near', self.caught(self.asking(), 'the proof says the opposite'))
        bare = self.asking()
        self.assertIn('no certificate', self.caught(lambda request: proofs(bare(request), lambda _: b''), 'no proof'))
        self.assertIn('refused', self.caught(lambda request: proofs(bare(request), put(CLAIM, '<I', APART)), 'another claim'))

    def test_a_lie_about_the_scene_is_caught(self):
        self.everywhere(FAR, POST)
        for name, others in (
                ('shifted', [FAR, sphere('post', 0.1, (0, 0.9, 0.5))]), ('smaller', [FAR, sphere('post', 0.001, (0, 0.7, 0.5))]),
                ('missing', [FAR]), ('another in its place', [FAR, sphere('post', 0.1, (0, 0, 6))]),
                ('another shape', [FAR, box('post', (0.01, 0.01, 0.01), (0, 0.7, 0.5))])):
            self.other.replace(*others)
            self.assertIn('fingerprint', self.caught(self.asking(server='other'), name))
        self.other.replace(FAR, POST, allowed_contacts=[AllowedContact(first='arm', second='post', allowed=True)])
        self.caught(self.asking(server='other'), 'a contact that nobody allowed')
        self.caught(self.asking(lambda request: setattr(request.query, 'objects', ['far'])), 'some objects alone')

    def test_a_lie_about_the_robot_is_caught(self):
        self.everywhere(sphere('post', 0.1, (0, 0.73, 0.5)))  # the smaller ball passes it by .12
        self.assertIn('fingerprint', self.caught(self.asking(server='stranger'), 'another robot'))
        self.caught(self.asking(lambda request: setattr(request.query, 'links', ['base', 'slider'])), 'some links alone')

    def test_a_lie_about_the_motion_is_caught(self):
        self.everywhere(POST)

        def half(request):
            del request.query.trajectories[0].points[1:]
            request.query.trajectories[0].points.append(copy.deepcopy(turning(0.6, 0.1, 1).points[1]))

        def scaled(factor):
            def change(request):
                for at in request.query.trajectories[0].points:
                    at.positions = [factor * at.positions[0]]
            return change

        def later(request):
            request.query.trajectories[0].points = [copy.deepcopy(at) for at in turning(3.0, 1.0).points]
            for at in request.query.trajectories[0].points:
                at.positions = [at.positions[0] - 3.0]
        self.caught(self.asking(half), 'a part of it')
        self.caught(self.asking(scaled(-1.0)), 'the other way round')
        self.caught(self.asking(scaled(0.1)), 'a shorter way')
        self.caught(self.asking(later), 'it ends where it began')
        self.caught(self.asking(lambda request: setattr(request.query, 'self_collision', False)), 'without the robot itself')

    def test_a_lie_about_the_limit_is_caught(self):
        self.everywhere(sphere('post', 0.1, (0, 0.72, 0.5)))  # passed by .02
        touching = self.asking(lambda request: setattr(request, 'delta', 0.001))
        self.assertIn('0.001 m alone', self.caught(touching, 'a smaller limit'))
        why = self.caught(lambda request: proofs(touching(request), put(LIMIT, '<d', DELTA)), 'a smaller limit, and the proof says the larger one')
        self.assertIn('refused', why)

    def test_a_proof_of_another_time_is_caught(self):
        kept = []
        self.liar.lie = lambda request: kept.append(self.liar.honest(request)) or kept[-1]
        self.assertEqual(self.send()[0], GoalStatus.SUCCEEDED)
        self.arm.rest()
        self.everywhere(FAR, POST)
        self.caught(lambda request: kept[0], 'an old answer')

    def test_a_proof_that_is_damaged_is_caught_although_the_motion_is_clear(self):
        for name, change in (('cut', lambda proof: proof[:-1]), ('longer', lambda proof: proof + b'\0'), ('half', lambda proof: proof[:len(proof) // 2]),
                             ('noise', lambda proof: bytes(len(proof))), ('another format', put(0, '<4s', b'CPC2')),
                             ('negative limit', put(LIMIT, '<d', -1.0)), ('no number', put(LIMIT, '<d', float('nan')))):
            self.assertIn('refused', self.caught(lambda request, change=change: proofs(self.liar.honest(request), change), name))

        def rows(change):
            def lie(request):
                response = self.liar.honest(request)
                response.results = change(response.results)
                return response
            return lie
        self.assertIn('2 are to be proven', self.caught(rows(lambda all_rows: all_rows[:1]), 'a row is left out'))
        self.assertIn('2 are to be proven', self.caught(rows(lambda all_rows: all_rows + all_rows[:1]), 'a row comes twice'))
        self.caught(rows(lambda all_rows: all_rows[::-1]), 'rows change places')
        self.caught(rows(lambda all_rows: []), 'no rows')
        self.caught(lambda request: ToleranceResponse(success=True), 'an empty answer')

    def test_no_mutant_of_a_proof_passes_a_motion_that_hits(self):
        """200 of them, seed 5, of the proof that the motion was clear before the post was there."""
        kept, chosen = [], random.Random(5)
        self.liar.lie = lambda request: kept.append(self.liar.honest(request)) or kept[-1]
        self.assertEqual(self.send()[0], GoalStatus.SUCCEEDED)
        self.arm.rest()
        for server in (self.reading, self.server):
            server.replace(POST)

        def mutant(proof):
            out = bytearray(proof)
            for _ in range(chosen.randint(1, 4)):
                out[chosen.randrange(len(out))] = chosen.randrange(256)
            return bytes(out[:chosen.randint(1, len(out))] if chosen.random() < 0.2 else out)
        for number in range(200):
            self.caught(lambda request: proofs(copy.deepcopy(kept[0]), mutant), 'mutant %d' % number)

    def test_a_server_whose_scene_stands_still_does_not_keep_a_motion_going(self):
        """What the gate itself reads has changed, so it asks again."""
        kept = []
        self.liar.lie = lambda request: kept.append(self.liar.honest(request)) or clear(copy.deepcopy(kept[0]))
        self.liar.frozen = self.server.scene().scene.version
        self.follow(turning(2.0, 20.0))
        self.reading.apply(POST)  # it alone has heard of it
        begin = time.monotonic()
        state, why = ends_of(self.client)
        self.assertEqual(state, GoalStatus.ABORTED)
        self.assertIn('not proven', why)
        self.assertLess(time.monotonic() - begin, 5.0)

    def test_an_object_that_the_gate_cannot_use_lets_nothing_pass(self):
        broken = self.publisher('/gate/reading/collision_object', CollisionObject)
        broken.publish(sphere('broken', -1.0, (9, 9, 9)))
        self.assertTrue(until(lambda: "object 'broken' is not used" in self.send()[1], 5))
        self.assertEqual(self.send()[0], GoalStatus.REJECTED)

    def test_no_trajectory_passes_after_a_stop_that_came_later(self):
        topic, passed = self.publisher('/gate/trajectory', JointTrajectory), heard('/gate/clear_trajectory', JointTrajectory)
        del self.refused[:]
        asked, going_on = self.liar.asked, threading.Event()
        self.liar.lie = lambda request: going_on.wait(10) and self.liar.honest(request)
        for _ in range(2):  # one is asked about, one waits
            topic.publish(turning(1.0, 2.0))
        self.assertTrue(until(lambda: self.liar.asked > asked, 5))
        topic.publish(JointTrajectory(joint_names=['turn']))
        self.assertTrue(until(lambda: passed, 5))  # at once
        going_on.set()
        self.assertTrue(until(lambda: len(self.refused) == 2, 5))
        self.assertEqual(([len(one.points) for one in passed], {one.message for one in self.refused}), ([0], {'a stop came after it'}))
        topic.publish(turning(1.0, 2.0))
        self.assertTrue(until(lambda: len(passed) == 2, 5), [one.message for one in self.refused])

    def test_curves_are_proven_too(self):
        links = self.publisher('/tf_static', TFMessage, latch=True)  # curves meet the robot where tf2 has it
        links.publish(TFMessage([transform('base', link) for link in ('arm', 'slider')]))
        topic, passed = self.publisher('/gate/curve', Curve), heard('/gate/clear_curve', Curve)
        curve = bezier((-1, 0.5, 2), (0, 0.7, 2), (1, 0.5, 2), id='c', radius=0.1)
        self.assertTrue(until(lambda: all(server.distance(curve).success for server in (self.reading, self.server)), 5))
        unreadable = bezier((-1, 0.5, 2), (1, 0.5, 2), id='c' * 10000)
        renamed = self.asking(lambda request: setattr(request.query.curves[0], 'id', 'c'))
        for asked, blocked, lie in ((curve, False, None), (curve, True, None), (curve, True, self.asking()), (unreadable, True, renamed)):
            if blocked:
                self.everywhere(sphere('post', 0.1, (0, 0.6, 2)))
            del self.refused[:], passed[:]
            self.liar.lie = lie
            topic.publish(asked)
            self.assertTrue(until(lambda: passed or self.refused, 5))
            self.assertEqual((len(passed), len(self.refused)), (0, 1) if blocked else (1, 0), [r.message for r in self.refused])


if __name__ == '__main__':
    run('verified')
