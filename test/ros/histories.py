#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Random histories of a node: objects that come, go and are refused, sensors that see, fail and fall silent, joints that are told in
part, crashes, launches with another scene file or robot. Beside it a model of what truly stands there and of what the node can know: nothing is clear that is not,
nothing is clear that is not known, and what is known and clear is called clear. Seeded; a longer run:
scripts/run rostest curve_proximity histories.test histories:=500 seed:=7"""
import math
import random
import signal
import tempfile
import time

import rospy
from curve_proximity.msg import CollisionObject
from helpers import ARM, Case, Node, Server, connected, joint_trajectory, joints, run, sphere, thing, until
from known import seen, written
from sensor_msgs.msg import JointState, PointCloud2

NAME, MAX_AGE, LIMIT, RADIUS, POINT = 'history', 1.0, 0.05, 0.1, 0.01
WAY = joint_trajectory(['turn'], (0.0,), (3.0,))
ON_WAY, ON_ARM, AWAY = (-0.25, 0.433, 0.5), (0, 0.5, 0.5), (0, 0, 5)  # the arm's ball is ON_ARM after a quarter turn, ON_WAY later
PLACES = (ON_WAY, ON_ARM) + (AWAY,) * 6
REACHES = (0.5, 0.8)  # [m] of the arm, one for each robot that is launched
STEPS, PATIENCE = 25, 15


def robot(reach):
    with open(ARM) as text:
        return text.read().replace('xyz="0.5 0 0"', 'xyz="%g 0 0"' % reach)


def write_scene(path, place):
    """A scene file of one object, or of none."""
    filed = '{id: filed, primitives: [{type: sphere, dimensions: [%g]}], primitive_poses: [{position: [%g, %g, %g]}]}'
    with open(path, 'w') as file:
        file.write('world: {collision_objects: [%s]}\n' % (filed % (RADIUS, *place) if place else ''))


class World:
    """What truly is, and why the node cannot know all of it."""

    def __init__(self):
        self.objects, self.refused, self.whole = {}, set(), True  # whole: no crash has lost a part of the scene
        self.points, self.seen = [], False                        # of the cloud; whether the node could use the latest
        self.turn, self.told, self.reach = 0.0, False, REACHES[0]

    def distance(self, turn):
        """Of the arm's balls and its cube, which never turns, to all that stands there."""
        balls = [((self.reach * math.cos(turn), self.reach * math.sin(turn), 0.5), 0.1), ((turn, 0, -0.5), 0.05)]

        def one(place, radius):
            cube = math.hypot(*(max(0.0, abs(c) - 0.1) for c in place))
            return min([math.dist(place, p) - r for p, r in balls] + [cube]) - radius
        return min([one(p, RADIUS) for p in self.objects.values()] + [one(p, POINT) for p in self.points], default=math.inf)

    def expected(self, distance, known):
        """The verdicts that are right: what is not known is not clear, and contact is said where there is contact."""
        out = set()
        if distance > LIMIT - 0.01 and known:
            out.add('clear')
        if distance < LIMIT + 0.01:
            out.add('violated')
        if not known or len(out) == 2:
            out.add('undecided')
        return out

    def verdicts(self):
        known = self.whole and self.seen and not self.refused
        on_way = min(self.distance(3.0 * i / 300) for i in range(301))
        return self.expected(on_way, known), self.expected(self.distance(self.turn), known and self.told)


class Histories(Case):
    def setUp(self):
        self.parameters = dict(max_age=MAX_AGE, tf_timeout=0.02, fixed_frame='base', expected_sensors=['cloud'])
        self.files()
        self.node, self.world, self.story = None, World(), []
        topics = (('cloud', PointCloud2), ('collision_object', CollisionObject), ('joint_states', JointState))
        self.topics = {name: rospy.Publisher('/%s/%s' % (NAME, name), kind, queue_size=5) for name, kind in topics}
        self.addCleanup(lambda: [topic.unregister() for topic in self.topics.values()])
        self.addCleanup(lambda: self.node.end())
        self.start()

    def files(self):
        """Those of a history of its own."""
        folder = tempfile.mkdtemp()
        self.parameters.update(state_file=folder + '/kept.scene', scene_file=folder + '/scene.yaml')
        self.launched = REACHES[0], None
        write_scene(self.parameters['scene_file'], None)
        self.set_param('/robot_description', robot(REACHES[0]))

    def start(self, **more):
        self.node = Node(NAME, **self.parameters, **more)
        self.server = Server('/' + NAME)
        self.assertTrue(connected(*self.topics.values()))

    # ---- what happens; each returns what the node is told again and again from then on
    def add(self, r):
        name, place = 'object%d' % r.randrange(4), r.choice(PLACES)
        self.assertTrue(self.server.apply(sphere(name, RADIUS, place)).success)
        self.world.objects[name] = place
        self.world.refused.discard(name)

    def add_by_topic(self, r):
        name, place, lost = 'object%d' % r.randrange(4), r.choice(PLACES), r.random() < 0.3
        self.topics['collision_object'].publish(sphere(name, RADIUS, place, frame='nowhere' if lost else ''))
        self.topics['collision_object'].publish(sphere('next', RADIUS, AWAY))  # the node takes one after the other
        self.assertTrue(until(lambda: self.server.scene('next').objects, PATIENCE))
        self.assertTrue(self.server.apply(thing('next', operation=CollisionObject.REMOVE)).success)
        self.world.objects[name] = place
        (self.world.refused.add if lost else self.world.refused.discard)(name)

    def remove(self, r):
        if not self.world.objects:
            return
        name = r.choice(sorted(self.world.objects))
        response = self.server.apply(thing(name, operation=CollisionObject.REMOVE))
        if response.success:  # a refused one is not there
            del self.world.objects[name]
            self.world.refused.discard(name)

    def replace(self, r):
        place = r.choice(PLACES)
        self.server.replace(sphere('object0', RADIUS, place))
        self.world.objects, self.world.refused, self.world.whole, self.world.seen = {'object0': place}, set(), True, False
        self.sensing = None

    def see(self, r):
        self.world.points = [r.choice(PLACES)] * 3
        fault = r.choice(['', '', '', 'frame', 'nan', 'old'])
        self.world.seen = not fault

        def publish():
            message = seen(*(self.world.points if fault != 'nan' else [(math.nan,) * 3] * 3))
            message.header.frame_id = 'nowhere' if fault == 'frame' else ''
            if fault == 'old':
                message.header.stamp -= rospy.Duration(50)
            self.topics['cloud'].publish(message)
        self.sensing = publish

    def fall_silent(self, r):
        """The sensor, or the joints."""
        if r.random() < 0.5:
            self.sensing, self.world.seen = None, False
        else:
            self.telling, self.world.told = None, False
        self.world.turn = r.choice((0.0, math.pi / 2)) if not self.telling else self.world.turn
        time.sleep(1.2 * MAX_AGE)

    def turn(self, r):
        self.world.turn, self.world.told = r.choice((0.0, math.pi / 2)), True
        self.telling = lambda: self.topics['joint_states'].publish(self.stamped(joints(turn=self.world.turn)))

    @staticmethod
    def stamped(message):
        message.header.stamp = rospy.Time.now()
        return message

    def kill(self, r):
        """Perhaps before the last change is written. Whether all of the scene was; what the master has kept of the node."""
        kept = self.parameters['state_file']
        if r.random() < 0.5:
            self.assertTrue(until(lambda: written(kept), 5))
        self.node.process.send_signal(signal.SIGKILL)
        self.node.wait(5)
        self.assertTrue(until(lambda: not connected(self.topics['collision_object'], seconds=0), 0.1), 'a message to it would be lost')
        last = rospy.get_param('/%s/last_scene' % NAME, None)
        self.world.seen, self.world.told, self.sensing, self.telling = False, False, None, None
        self.node.end()
        return self.world.whole and written(kept), {'last_scene': last} if last else {}

    def crash(self, r):
        """A respawn; a sensor and joints are unknown until their next messages."""
        self.world.whole, last = self.kill(r)
        self.start(**last)

    def launch(self, r):
        """Another launch on the same master. With other files the scene begins anew; whether clear_params is set does not matter."""
        written, last = self.kill(r)
        before, self.launched = self.launched, (r.choice(REACHES), r.choice((None, ON_ARM, AWAY)))
        self.world.reach, filed = self.launched
        rospy.set_param('/robot_description', robot(self.world.reach))
        write_scene(self.parameters['scene_file'], filed)
        if self.launched == before:
            self.world.whole = written
        else:
            self.world.objects, self.world.refused, self.world.whole = {'filed': filed} if filed else {}, set(), True
        self.start(**(last if r.random() < 0.5 else {}))

    # ---- one history
    def ask(self):
        """The verdicts about the way and about the robot as it stands."""
        for publish in (self.sensing, self.telling):
            if publish:
                publish()
        return (self.verdict(self.server.tolerance([], LIMIT, trajectory=WAY)),
                self.verdict(self.server.tolerance([], LIMIT, robot_state=True)))

    @staticmethod
    def verdict(answer):
        """The worst of its rows; 'undecided' where it has none, as without any joint state."""
        rows = [row.verdict for row in answer.results if row.kind == 'environment']
        return next((verdict for verdict in ('violated', 'undecided', 'clear') if verdict in rows), 'undecided')

    def right(self):
        return all(verdict in allowed for verdict, allowed in zip(self.ask(), self.world.verdicts()))

    def play(self, seed):
        r = random.Random(seed)
        self.sensing = self.telling = None
        self.server.replace(sphere('object0', RADIUS, AWAY))
        self.world.objects = {'object0': AWAY}
        happenings = [self.add, self.add, self.add_by_topic, self.remove, self.replace, self.fall_silent, self.crash, self.launch] + [self.see, self.turn] * 3
        called = 0
        for _ in range(STEPS):
            happening = r.choice(happenings)
            happening(r)
            self.story.append('%s: %s, %s' % (happening.__name__, self.world.__dict__, self.world.verdicts()))
            soon = until(self.right, PATIENCE)  # topics take their time
            for _ in range(5):
                verdicts, allowed = self.ask(), self.world.verdicts()
                self.assertTrue(soon and all(v in a for v, a in zip(verdicts, allowed)),
                                'seed %d: %s and not %s after\n%s' % (seed, verdicts, allowed, '\n'.join(self.story)))
                called += verdicts.count('clear')
        return called

    def test_nothing_is_clear_that_is_not_or_is_not_known(self):
        first, n, clear, played = rospy.get_param('~seed', 0), rospy.get_param('~histories', 3), 0, 0
        for seed in range(first, first + n):
            with self.subTest(seed=seed):
                if seed > first:
                    self.node.end()
                    self.world, self.story = World(), []
                    self.files()
                    self.start()
                clear += self.play(seed)
                played += 1
        self.assertTrue(clear > 0 or not played)  # it is not silent; of a history that failed its own failure is told


if __name__ == '__main__':
    run('histories')
