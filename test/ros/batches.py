#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The action ~query: long batches with feedback, cancelled or not."""
import subprocess
import sys
import time

import rospy
from actionlib_msgs.msg import GoalStatus
from curve_proximity.msg import QueryAction, QueryActionFeedback, QueryActionGoal, QueryActionResult, QueryGoal
from helpers import ActionClient, Case, Server, bezier, heard, lying, peak_mb, query, ring_and_shells, run, sphere, until


class Batches(Case):
    @classmethod
    def setUpClass(cls):
        cls.server = Server()
        cls.client = ActionClient('/curve_proximity/query', QueryAction)

    def send(self, **fields):
        """One goal; its state and its result."""
        self.feedback = []
        own = {name: fields.pop(name) for name in ('query_type', 'delta') if name in fields}
        self.client.send_goal(QueryGoal(query=query(**fields), **own), feedback_cb=self.feedback.append)
        self.assertTrue(self.client.wait_for_result(rospy.Duration(60)))  # on a machine that builds beside it, too
        return self.client.get_state(), self.client.get_result()

    def test_a_batch_is_answered_as_the_service_answers_it(self):
        self.server.replace(sphere('ball', 0.25), sphere('other', 0.1, (0, 3, 0)))
        curves = [bezier((-1, 0, 0.3 + 0.01 * i), (1, 0.1 * i, 1), id='c%d' % i) for i in range(300)]
        curves[7] = bezier((0, 0, 1), id='bad')
        state, result = self.send(query_type='distance', curves=curves)
        self.assertEqual(state, GoalStatus.SUCCEEDED)
        response = self.server.distance(curves)
        self.assertFalse(result.success)
        self.assertEqual((result.message, result.frame_id), (response.message, 'world'))
        for a, b in zip(result.results, response.results):
            self.assertEqual((a.id, a.b, a.status), (b.id, b.b, b.status))
            if a.id != 'bad':
                self.assertEqual((a.lower, a.upper, a.t), (b.lower, b.upper, b.t))
        self.assertEqual(len(result.results), 300)

    def test_counts_that_lie_take_no_memory(self):
        """2^24 points would be 400 MB; the goal holds 7."""
        goals, results = self.publisher('/curve_proximity/query/goal', QueryActionGoal), heard('/curve_proximity/query/result', QueryActionResult)
        before, goal = peak_mb('/curve_proximity'), QueryActionGoal()
        goal.goal.query = query([bezier(*[(i, 0, 2) for i in range(7)])])
        goal.goal_id.id = 'honest'
        goals.publish(lying(goal))
        goals.publish(goal)
        self.assertTrue(until(lambda: 'honest' in [result.status.goal_id.id for result in results], 10))
        self.assertLess(peak_mb('/curve_proximity'), before + 100)

    def test_feedback_tells_how_far_it_is(self):
        ring, balls, _ = ring_and_shells(shells=1, n=3000)
        self.server.replace(*balls)
        ring.id = 'ring'
        state, result = self.send(query_type='distance', curves=[ring] * 60, epsilon=1e-12)
        self.assertEqual(state, GoalStatus.SUCCEEDED)
        self.assertGreater(len(self.feedback), 0)
        done = [f.done for f in self.feedback]
        self.assertEqual(done, sorted(done))
        last = self.feedback[-1]
        self.assertEqual((last.total, last.id, last.failed), (60, 'ring', 0))
        self.assertLessEqual(min(r.lower for r in result.results), last.lower)

    def test_a_cancelled_batch_hands_over_what_it_has(self):
        ring, balls, fields = ring_and_shells()
        self.server.replace(*balls)
        first = bezier((0, 0, 5), (1, 0, 5), id='first')
        self.feedback = []
        self.client.send_goal(QueryGoal(query_type='distance', query=query([first] + [ring] * 50, **fields)),
                              feedback_cb=self.feedback.append)
        self.assertTrue(until(lambda: self.feedback, 10))
        time.sleep(0.3)
        self.client.cancel_goal()
        self.assertTrue(self.client.wait_for_result(rospy.Duration(20)))  # all of it would take minutes
        self.assertEqual(self.client.get_state(), GoalStatus.PREEMPTED)
        result = self.client.get_result()
        self.assertRefused(result, 'cancelled')
        self.assertEqual((result.results[0].id, result.results[0].status), ('first', 'ok'))
        self.assertIn('stopped', {row.status for row in result.results})
        self.assertTrue(self.server.distance(first).success)

    def test_a_batch_ends_when_its_client_is_killed(self):
        self.server.replace(*ring_and_shells()[1])
        results = heard('/curve_proximity/query/result', QueryActionResult)
        feedback = heard('/curve_proximity/query/feedback', QueryActionFeedback)
        with subprocess.Popen([sys.executable, __file__, '--send', '/curve_proximity']) as client:
            self.addCleanup(client.kill)
            self.assertTrue(until(lambda: feedback, 20) and not results)
            client.kill()
        self.assertTrue(until(lambda: results, 5))  # all of it would take minutes
        self.assertEqual((results[0].status.status, results[0].result.message), (GoalStatus.PREEMPTED, 'its client has gone'))
        self.assertTrue(self.server.distance(bezier((0, 0, 5), (1, 0, 5))).success)

    def test_a_budget_ends_it_and_without_one_it_outlives_that_of_the_server(self):
        ring, balls, fields = ring_and_shells()
        self.server.replace(*balls)
        state, result = self.send(query_type='distance', curves=[ring], budget_ms=300, **fields)
        self.assertEqual(state, GoalStatus.SUCCEEDED)
        self.assertIn('stopped', {row.status for row in result.results})

    def test_goals_that_make_no_sense_are_aborted_with_a_reason(self):
        line = bezier((0, 0, 1), (1, 0, 1))
        for fields, word in ((dict(query_type='guess', curves=[line]), 'guess'), (dict(query_type='tolerance', delta=-1, curves=[line]), 'delta'),
                             (dict(query_type='distance', curves=[line], budget_ms=-1), 'budget_ms')):
            state, result = self.send(**fields)
            self.assertEqual(state, GoalStatus.ABORTED, fields)
            self.assertRefused(result, word)


def send_and_stay(server):
    """A client as a process of its own, with a goal of minutes. bench/ros/reactions.py starts it, too."""
    rospy.init_node('client', anonymous=True)
    client = ActionClient(server + '/query', QueryAction)
    ring, _, fields = ring_and_shells()
    client.send_goal(QueryGoal(query_type='distance', query=query([ring] * 50, **fields)))
    rospy.spin()


if __name__ == '__main__':
    send_and_stay(sys.argv[2]) if '--send' in sys.argv else run('batches')
