#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Random goals through the gate: an arm at any speed, posts that appear, go and are refused on its way, joints that fall silent, a
server that is killed, launches with another scene file or robot. A model says what must not end as SUCCEEDED and what must. Seeded; a longer run:
scripts/run rostest curve_proximity goals.test goals:=200 seed:=7"""
import math
import os
import random
import tempfile
import time

import rospy
from actionlib_msgs.msg import GoalStatus
from curve_proximity.msg import CollisionObject
from gate import ArmCase, Goal, turning
from helpers import Node, Server, connected, run, sphere, thing, until
from histories import AWAY, LIMIT, RADIUS, REACHES, World, robot, write_scene

REACTION = 1.0  # [s] a gate on a busy machine stops the arm within this time
SILENCE = 2.5   # [s] the same where roscpp waits for the answer of a server that has died: ~server_timeout, and some
SURE = 0.03     # [m] closer to the limit than this either end is right


def on_arm(turn, reach):
    """A post in the way of the arm's ball after this turn, and of nothing else."""
    return (reach * math.cos(turn), reach * math.sin(turn), 0.5)


class Goals(ArmCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.objects = rospy.Publisher('/curve_proximity/collision_object', CollisionObject, queue_size=5)
        cls.folder, cls.node = tempfile.mkdtemp(), None

    @classmethod
    def tearDownClass(cls):
        cls.node.end()

    def launch(self, reach, place):
        """A server on the same master with this robot, and a scene file with a post at this place."""
        if self.node:
            self.node.end()
        rospy.set_param('/robot_description', robot(reach))
        files = {name: os.path.join(self.folder, name) for name in ('scene_file', 'state_file')}
        write_scene(files['scene_file'], place)
        type(self).node = Node('curve_proximity', fixed_frame='base', delta=LIMIT, tf_timeout=0.02, **files)
        type(self).server = Server()
        self.assertTrue(connected(self.states, self.objects))
        self.world.reach, self.world.objects = reach, {'filed': place}
        self.assertTrue(until(lambda: self.server.distance([], robot_state=True).success, 10))  # the joints have come

    # ---- what happens on the way; each returns False where it changes nothing
    def appear(self, r):
        name, place = 'post%d' % r.randrange(3), r.choice((on_arm(r.uniform(0.5, 3.5), self.world.reach), AWAY))
        if r.random() < 0.5:
            self.assertTrue(self.server.apply(sphere(name, RADIUS, place)).success)
        else:
            self.objects.publish(sphere(name, RADIUS, place))
        self.world.objects[name] = place
        self.world.refused.discard(name)

    def be_refused(self, r):
        name = 'post%d' % r.randrange(3)
        self.objects.publish(sphere(name, RADIUS, AWAY, frame='nowhere'))
        self.world.objects.pop(name, None)
        self.world.refused.add(name)

    def go(self, r):
        names = sorted(set(self.world.objects) - self.world.refused - {'far', 'filed'})
        if names:
            name = r.choice(names)
            self.assertTrue(until(lambda: self.server.apply(thing(name, operation=CollisionObject.REMOVE)).success, 5))
            del self.world.objects[name]

    def fall_silent(self, _):
        self.arm.silent = True

    def die(self, _):
        self.node.process.kill()
        self.assertIsNotNone(self.node.wait(5))

    def gap(self, begin, end):
        """The distance of the arm between two of its positions to all that stands there."""
        n = max(2, int(abs(end - begin) * 100))
        return min(self.world.distance(begin + (end - begin) * i / n) for i in range(n + 1))

    def play(self, seed):
        """What must be said of the goal: a set of the ends that are right. story: what happened."""
        r = random.Random(seed)
        self.arm.rest()
        reach = self.world.reach
        self.world, story = World(), []
        self.world.reach = reach
        if not self.node or not self.node.alive() or r.random() < 0.3:
            reach = r.choice(REACHES)
            far = (0, 0, 5 + r.random())  # no two launches begin alike
            self.launch(reach, r.choice((on_arm(r.uniform(0.5, 3.5), reach), far, far)))
        else:
            self.server.replace(sphere('far', RADIUS, AWAY))
            self.world.objects = {'far': AWAY}
        self.arm.speed = r.choice((1.0, 1.0, 0.6, 0.3))
        end, rate = r.uniform(2.0, 3.2), r.uniform(0.4, 0.9)  # [rad], [rad/s] as planned
        if r.random() < 0.3:
            self.appear(r)
            time.sleep(0.5)
        begun = self.controller.begun
        self.client.send_goal(Goal(trajectory=turning(end, end / rate, parts=r.randint(2, 40))))
        must_end = self.gap(0.0, end) < LIMIT - SURE
        may_pass = self.gap(0.0, end) > LIMIT - SURE
        may_end = self.gap(0.0, end) < LIMIT + SURE
        started = until(lambda: self.controller.begun > begun or self.client.get_state() == GoalStatus.REJECTED, 10)
        self.assertTrue(started, 'nothing came of the goal')
        happenings = [self.appear] * 4 + [self.be_refused, self.go, self.go, self.fall_silent, self.die]
        for _ in range(r.randrange(4)):
            if not self.controller.server.is_active():
                break
            time.sleep(r.uniform(0.0, 1.5))
            happening, before = r.choice(happenings), self.arm.position()
            happening(r)
            story.append('at %.2f: %s -> %s, refused %s' % (before, happening.__name__, self.world.objects, self.world.refused))
            if happening == self.die:
                until(lambda: not self.controller.server.is_active(), SILENCE)
            else:
                time.sleep(REACTION)
            after = self.arm.position()
            doubt = bool(self.world.refused) or self.arm.silent or not self.node.alive()
            running = self.controller.server.is_active() and after < end - 0.05
            if running and (doubt or self.gap(after, end) < LIMIT - SURE):
                return False, story + ['still runs at %.2f' % after]
            may_end = may_end or doubt or self.gap(before, end) < LIMIT + SURE
            if doubt or self.gap(before, end) < LIMIT:
                break
        finished = self.client.wait_for_result(rospy.Duration(end / rate / self.arm.speed + 10))
        state = self.client.get_state()
        story.append('%s at %.2f of %.2f, speed %.1f, %s: %s' % (
            state, self.arm.position(), end, self.arm.speed, self.client.get_goal_status_text(), self.world.objects))
        reached = state == GoalStatus.SUCCEEDED
        self.arrived += reached
        self.ended += not reached
        return finished and (may_pass and not must_end if reached else may_end), story

    def test_no_goal_goes_where_it_is_not_clear_and_clear_ones_arrive(self):
        first, n = rospy.get_param('~seed', 0), rospy.get_param('~goals', 6)
        self.arrived = self.ended = 0
        self.world = World()
        for seed in range(first, first + n):
            with self.subTest(seed=seed):
                right, story = self.play(seed)
                self.assertTrue(right, 'seed %d:\n%s' % (seed, '\n'.join(story)))
        self.assertGreater(min(self.arrived, self.ended), n // 10)


if __name__ == '__main__':
    run('goals')
