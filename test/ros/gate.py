#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The gate as an action between a planner and a controller: what is clear passes, what is not is refused with its reason, and what
stops being clear while it runs is cancelled."""
import math
import signal
import threading
import time

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from curve_proximity.msg import CollisionObject, Curve, Proximity, Refusal
from foreign_types import control
from helpers import (ActionClient, Case, Node, Server, bezier, connected, free_flight, heard, joint_trajectory, joints, lying, moving,
                     path, peak_mb, run, sphere, thing, turned, until, waypoint)
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

Action, Goal, Result, Feedback = (getattr(control, 'FollowJointTrajectory' + name) for name in ('Action', 'Goal', 'Result', 'Feedback'))
POST = sphere('post', 0.1, (0, 0.5, 0.5))  # where the arm is after a quarter turn
FAR = sphere('far', 0.1, (0, 0, 5))


class Arm:
    """The robot: its joint goes along the trajectory that it was given last, at a part of its speed, and tells where it is."""

    def __init__(self, states):
        self.states, self.turn, self.speed, self.offset, self.silent, self.given = states, 0.0, 1.0, 0.0, False, 0
        rospy.Timer(rospy.Duration(0.02), lambda _: self.silent or self.states.publish(joints(turn=self.position())))

    def rest(self):
        """Stands at 0 from now on, whatever it was given."""
        self.given += 1
        time.sleep(0.05)  # what moved it has noticed
        self.turn, self.speed, self.offset, self.silent = 0.0, 1.0, 0.0, False
        time.sleep(0.1)

    def position(self):
        return self.turn + self.offset

    def take(self, trajectory):
        threading.Thread(target=self.follow, args=(trajectory,), daemon=True).start()

    def follow(self, trajectory, goes_on=lambda position: True):
        """Until its end, or until another one is given, or goes_on(position) is false: then False."""
        self.given += 1
        mine, at, now = self.given, 0.0, time.monotonic()
        times = [p.time_from_start.to_sec() for p in trajectory.points]
        while trajectory.header.stamp > rospy.Time.now() and goes_on(self.position()):
            time.sleep(0.01)
        while times and at < times[-1]:
            if mine != self.given or not goes_on(self.position()):
                return False
            time.sleep(0.01)
            now, before = time.monotonic(), now
            at += self.speed * (now - before)
            i = max(1, sum(t <= at for t in times[:-1]))
            share = min(1.0, (at - times[i - 1]) / (times[i] - times[i - 1]))
            self.turn = (1 - share) * trajectory.points[i - 1].positions[0] + share * trajectory.points[i].positions[0]
        return True


class Controller:
    """Moves the arm, tells where it is, and ends when it is at the end."""

    def __init__(self, arm, name='/controller'):
        self.arm, self.begun, self.cancelled, self.ended, self.dead = arm, 0, 0, 0, False
        self.server = actionlib.SimpleActionServer(name + '/follow_joint_trajectory', Action, self.execute, False)
        self.server.start()

    def execute(self, goal):
        self.begun += 1

        def tell(position):
            if not self.arm.silent and not self.dead:
                self.server.publish_feedback(Feedback(joint_names=['turn'], actual=JointTrajectoryPoint(positions=[position])))
            return not self.server.is_preempt_requested()
        reached = self.arm.follow(goal.trajectory, tell)
        if self.dead:
            return None
        if not reached:
            self.cancelled += 1
            return self.server.set_preempted(Result(), 'cancelled')
        self.ended += 1
        return self.server.set_succeeded(Result())

    def die(self):
        """Its topics are gone, as those of a process that ends."""
        self.dead, server = True, self.server.action_server
        server.status_list_timeout = rospy.Duration(0)
        for end in (server.status_pub, server.result_pub, server.feedback_pub, server.goal_sub, server.cancel_sub):
            end.unregister()


def turning(to, seconds, parts=2, first=0):
    steps = range(first, parts + 1)
    return joint_trajectory(['turn'], *[[to * i / parts] for i in steps], times=[seconds * i / parts for i in steps])


def ends_of(client, seconds=10):
    """The state and the message with which a client's goal ends."""
    assert client.wait_for_result(rospy.Duration(seconds))
    return client.get_state(), client.get_result().error_string


class ArmCase(Case):
    """An arm that tells where it is by STATES, its controller, and a client of the gate before it."""
    STATES = '/curve_proximity/joint_states'

    @classmethod
    def setUpClass(cls):
        cls.states = rospy.Publisher(cls.STATES, JointState, queue_size=5)
        cls.arm = Arm(cls.states)
        cls.controller = Controller(cls.arm)
        cls.client = ActionClient('/gate/follow_joint_trajectory', Action)
        time.sleep(1.0)  # the gate finds the controller

    def follow(self, trajectory, client=None):
        """Sends a goal, which begins."""
        client = client or self.client
        client.send_goal(Goal(trajectory=trajectory))
        self.assertTrue(until(self.controller.server.is_active, 5), client.get_goal_status_text())


class Gate(ArmCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.server, cls.refused, cls.passed = Server(), heard('/gate/refused', Refusal), heard('/gate/clear_trajectory', JointTrajectory)
        cls.topic = rospy.Publisher('/curve_proximity/trajectory', JointTrajectory, queue_size=5)
        assert connected(cls.states, cls.topic, rospy.Subscriber('/gate/clear_trajectory', JointTrajectory, cls.arm.take))

    def setUp(self):
        self.arm.rest()
        self.server.replace(FAR)
        del self.refused[:], self.passed[:]

    def sent(self, trajectory):
        """How its goal ends: the state and the message."""
        self.client.send_goal(Goal(trajectory=trajectory))
        return ends_of(self.client)

    def test_a_clear_goal_reaches_the_controller_and_its_result_comes_back(self):
        begun = self.controller.begun
        state, why = self.sent(turning(1.0, 0.5))
        self.assertEqual((state, self.controller.begun), (GoalStatus.SUCCEEDED, begun + 1), why)
        self.assertEqual(self.refused, [])

    def test_a_goal_that_is_not_clear_is_rejected_with_pair_time_and_distance(self):
        begun = self.controller.begun
        self.server.apply(POST)
        state, why = self.sent(turning(3.0, 2.0))
        self.assertEqual((state, self.controller.begun), (GoalStatus.REJECTED, begun))
        self.assertIn("'post'", why)
        self.assertTrue(until(lambda: self.refused, 5))
        refusal, = self.refused
        self.assertEqual((refusal.source, refusal.row.a, refusal.row.b, refusal.cancelled), (Refusal.ACTION, 'arm', 'post', False))
        self.assertLess(refusal.row.lower, 0.05)
        self.assertGreater(refusal.row.t, 0.0)

    def test_a_running_goal_is_cancelled_when_what_is_left_of_it_is_no_longer_clear(self):
        before = self.controller.cancelled
        self.follow(turning(2.0, 3.0))
        self.server.apply(sphere('behind', 0.1, (0.5, -0.5, 0.5)))  # another scene, and nothing in the way
        time.sleep(0.4)
        self.assertEqual((self.controller.cancelled, self.refused), (before, []))
        self.server.apply(POST)
        begin = time.monotonic()
        state, _ = ends_of(self.client)
        self.assertLess(time.monotonic() - begin, 1.0)
        self.assertEqual((state, self.controller.cancelled), (GoalStatus.ABORTED, before + 1))
        self.assertTrue(until(lambda: self.refused, 5))
        self.assertEqual((self.refused[0].row.b, self.refused[0].cancelled), ('post', True))

    def test_a_robot_that_is_slow_is_not_taken_to_be_where_the_clock_is(self):
        self.arm.speed = 0.3
        self.client.send_goal(Goal(trajectory=turning(3.0, 3.0, parts=30)))
        time.sleep(2.4)  # by the clock the arm is past the post
        self.assertLess(self.arm.position(), 1.0)
        self.server.apply(POST)
        state, why = ends_of(self.client)
        self.assertEqual(state, GoalStatus.ABORTED)
        self.assertIn("'post'", why)
        self.assertLess(self.arm.position(), 1.0)

    def test_what_a_robot_has_passed_stops_it_no_more(self):
        self.client.send_goal(Goal(trajectory=turning(3.0, 3.0, parts=30)))
        self.assertTrue(until(lambda: self.arm.position() > 2.4, 5))
        self.server.apply(POST)
        self.assertEqual(ends_of(self.client)[0], GoalStatus.SUCCEEDED)

    def test_a_robot_that_is_silent_or_elsewhere_is_stopped(self):
        for fault, word in (('silent', 'has not told where its joints are'), ('offset', "joint 'turn' at")):
            self.arm.rest()
            before = self.controller.cancelled
            self.follow(turning(2.0, 4.0))
            time.sleep(0.2)
            setattr(self.arm, fault, 0.5)
            state, why = ends_of(self.client, 3)
            self.assertEqual((state, self.controller.cancelled), (GoalStatus.ABORTED, before + 1))
            self.assertIn(word, why)

    def test_a_goal_that_does_not_begin_where_the_robot_is_does_not_pass(self):
        self.arm.offset = 1.0
        time.sleep(0.2)
        state, why = self.sent(turning(3.0, 2.0))
        self.assertEqual(state, GoalStatus.REJECTED)
        self.assertIn("joint 'turn' at 1 is", why)

    def test_the_way_to_a_first_point_that_is_not_at_time_zero_counts(self):
        self.server.apply(POST)  # between the arm and the first point
        state, why = self.sent(turning(3.0, 1.0, parts=4, first=3))
        self.assertEqual(state, GoalStatus.REJECTED)
        self.assertIn("'post'", why)
        self.arm.silent = True
        time.sleep(0.7)
        state, why = self.sent(turning(3.0, 1.0, parts=4, first=3))
        self.assertEqual(state, GoalStatus.REJECTED)
        self.assertIn("~joint_states does not tell of joint 'turn'", why)

    def test_a_goal_that_begins_later_is_asked_about_at_its_time(self):
        """A cart stands where the arm will be, from five seconds after now on."""
        now = rospy.Time.now()
        way = [waypoint(t, p) for t, p in ((0, (0, 3, 0.5)), (5, (0, 3, 0.5)), (5.5, (0, 0.5, 0.5)), (60, (0, 0.5, 0.5)))]
        self.server.apply(moving(sphere('cart', 0.1), *way, start=now))
        goal = turning(3.0, 2.0)
        for stamp, passes in ((now + rospy.Duration(5.5), False), (now, True)):
            goal.header.stamp = stamp
            state, why = self.sent(goal)
            self.assertEqual(state, GoalStatus.SUCCEEDED if passes else GoalStatus.REJECTED, why)
            self.assertTrue(passes or "'cart'" in why, why)

    def test_a_long_question_keeps_no_running_goal_waiting(self):
        other = ActionClient('/gate/follow_joint_trajectory', Action)
        self.follow(turning(2.0, 6.0))
        other.send_goal(Goal(trajectory=turning(0.5, 30.0, parts=30000)))
        self.server.apply(POST)
        self.assertEqual(ends_of(self.client)[0], GoalStatus.ABORTED)
        other.cancel_goal()

    def test_a_stop_passes(self):
        self.server.apply(sphere('post', 0.1, (0.5, 0, 0.5)))  # in contact with the arm as it stands
        self.assertEqual(self.sent(JointTrajectory(joint_names=['turn']))[0], GoalStatus.SUCCEEDED)
        self.topic.publish(JointTrajectory(joint_names=['turn']))
        self.assertTrue(until(lambda: self.passed, 5))
        self.assertEqual((self.passed[0].points, self.refused), ([], []))

    def test_the_goal_of_a_controller_that_goes_away_is_aborted(self):
        controller = Controller(self.arm, '/lost')
        client = ActionClient('/lost_gate/follow_joint_trajectory', Action)

        def begins():  # the gate finds the controller in its own time
            client.send_goal(Goal(trajectory=turning(2.0, 20.0)))
            return until(controller.server.is_active, 1)
        self.assertTrue(until(begins, 20))
        controller.die()
        state, why = ends_of(client)
        self.assertEqual((state, why), (GoalStatus.ABORTED, "the controller's action '/lost/follow_joint_trajectory' is not there"))

    def test_a_server_that_is_gone_or_hangs_ends_the_motion(self):
        client = ActionClient('/alone_gate/follow_joint_trajectory', Action)
        for how, word in ((signal.SIGKILL, 'the server does not answer'), (signal.SIGSTOP, '~server_timeout')):
            self.arm.rest()
            node = Node('alone', fixed_frame='base')
            try:
                Server('/alone').replace(FAR)
                before = self.controller.cancelled
                self.follow(turning(2.0, 20.0), client)
                time.sleep(0.3)
                node.process.send_signal(how)
                state, why = ends_of(client)
                self.assertEqual((state, self.controller.cancelled), (GoalStatus.ABORTED, before + 1))
                self.assertIn(word, why)
            finally:
                node.process.send_signal(signal.SIGCONT)
                node.end()

    def test_a_goal_that_makes_no_sense_is_rejected_and_the_next_one_passes(self):
        far = [JointTrajectoryPoint(positions=[0.5], time_from_start=rospy.Duration(0.2))]
        for names, positions in ((['turn'], []), (['turn'], [math.nan]), (['turn'], [0.0, 1.0]), (['none'], [0.0]), ([], [])):
            state, why = self.sent(JointTrajectory(joint_names=names, points=[JointTrajectoryPoint(positions=positions)] + far))
            self.assertEqual((state, bool(why)), (GoalStatus.REJECTED, True), (names, positions))
        self.assertEqual(self.sent(turning(0.2, 0.2))[0], GoalStatus.SUCCEEDED)

    def test_a_client_may_cancel(self):
        before = self.controller.cancelled
        self.follow(turning(1.0, 3.0))
        self.client.cancel_goal()
        self.assertEqual((ends_of(self.client, 5)[0], self.controller.cancelled), (GoalStatus.PREEMPTED, before + 1))

    def test_a_body_that_turns_into_the_way_is_refused(self):
        """A plank of 2 m goes along x past a post .4 beside it, and at the end turns into the post or does not."""
        server = Server('/plank')
        server.replace(sphere('post', 0.1, (1, 0.6, 3)))
        ways = dict(path=lambda *turns: path((-1, 0, 3), (1, 0, 3), orientations=turns),
                    multi_dof_trajectory=lambda *turns: free_flight('drone', (-1, 0, 3), (1, 0, 3), orientations=turns))
        for name, way in ways.items():
            topic = self.publisher('/plank_gate/' + name, type(way()))
            passed, refused = heard('/plank_gate/clear_' + name, type(way())), heard('/plank_gate/refused', Refusal)
            for turns in (False, True):
                del passed[:], refused[:]
                topic.publish(way(turned(0), turned(math.radians(90) if turns else 0)))
                self.assertTrue(until(lambda: passed or refused, 5), (name, turns))
                self.assertEqual((len(passed), [(r.row.a, r.row.b) for r in refused]), (0, [('plank', 'post')]) if turns else (1, []), (name, turns))
                if turns:
                    self.assertEqual((refused[0].source, refused[0].row.kind), (name, 'movers'))

    def test_refused_messages_of_topics_are_told_too(self):
        self.server.apply(POST)
        self.topic.publish(turning(3.0, 2.0))
        self.assertTrue(until(lambda: self.refused, 5))
        self.assertEqual((self.refused[0].source, self.refused[0].row.b), ('trajectory', 'post'))
        self.server.apply(thing('post', operation=CollisionObject.REMOVE))
        self.topic.publish(turning(3.0, 0.2))
        self.assertTrue(until(lambda: self.passed and self.arm.position() == 3.0, 5))
        self.assertEqual((len(self.passed), len(self.refused)), (1, 1))

    def test_counts_that_lie_take_no_memory(self):
        """2^24 points or names would be 400 MB; the messages hold 7."""
        refused, before, curve = heard('/alone_gate/refused', Refusal), peak_mb('/alone_gate'), bezier(*[(i, 0, 2) for i in range(7)])
        curves = self.publisher('/alone_gate/curve', Curve)
        self.states.publish(lying(JointState(name=list('abcdefg'))))
        curves.publish(lying(curve))
        curves.publish(curve)
        self.assertTrue(until(lambda: refused, 10))  # its server is not there
        self.assertEqual(refused[0].source, 'curve')
        self.assertLess(peak_mb('/alone_gate'), before + 100)

    def test_a_trajectory_that_passed_is_stopped_when_what_is_left_of_it_is_no_longer_clear(self):
        self.topic.publish(turning(2.0, 3.0))
        self.assertTrue(until(lambda: self.passed, 5))
        self.server.apply(sphere('behind', 0.1, (0.5, -0.5, 0.5)))  # another scene, and nothing in the way
        time.sleep(0.4)
        self.assertEqual((len(self.passed), self.refused), (1, []))
        self.server.apply(POST)
        begin = time.monotonic()
        self.assertTrue(until(lambda: len(self.passed) == 2 and self.refused, 5))
        self.assertLess(time.monotonic() - begin, 1.0)
        self.assertEqual((self.passed[1].joint_names, self.passed[1].points), (['turn'], []))
        refusal, = self.refused
        self.assertEqual((refusal.source, refusal.row.b, refusal.cancelled), ('trajectory', 'post', True))
        time.sleep(0.3)
        self.assertEqual((len(self.passed), len(self.refused)), (2, 1))  # once

    def test_a_trajectory_at_its_end_is_watched_no_more_and_another_one_takes_its_place(self):
        self.topic.publish(turning(2.0, 0.3))
        self.assertTrue(until(lambda: self.passed, 5))
        time.sleep(0.5)
        self.arm.rest()
        self.topic.publish(turning(2.0, 30.0))
        self.topic.publish(turning(0.5, 30.0))  # the post is not in the way of this one
        self.assertTrue(until(lambda: len(self.passed) == 3, 5))
        self.server.apply(POST)
        time.sleep(0.4)
        self.assertEqual((len(self.passed), self.refused), (3, []))

    def test_a_trajectory_is_stopped_when_data_becomes_too_old(self):
        passed, refused = heard('/aging_gate/clear_trajectory', JointTrajectory), heard('/aging_gate/refused', Refusal)
        out = self.publisher('/aging/trajectory', JointTrajectory)
        states = self.publisher('/aging/joint_states', JointState)
        Server('/aging').replace(FAR)

        def ask():  # the first joint states may come after the question
            states.publish(joints(turn=0.0))
            time.sleep(0.1)
            out.publish(turning(2.0, 8.0))
            return until(lambda: passed, 1)
        self.assertTrue(until(ask, 10))
        del refused[:]
        self.assertTrue(until(lambda: refused and len(passed) == 2, 5))
        self.assertEqual((refused[0].cancelled, refused[0].row.status, passed[1].points), (True, Proximity.STATUS_STALE, []))


if __name__ == '__main__':
    run('gating')
