#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""MoveIt's scene by topic and service: its answers are those of ~apply_scene, and what is wrong is told."""
import copy
import math
import subprocess
import sys

import rospy
from curve_proximity.msg import AllowedContact, AttachedCollisionObject, LinkPadding, LinkScale, ProximityResults
from diagnostic_msgs.msg import DiagnosticArray
from foreign_types import GetPlanningScene, GetPlanningSceneResponse, moveit
from helpers import Case, Server, bezier, box, bus_links, connected, heard, joint_trajectory, joints, mesh, pose, run, sphere, transform, until
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState

NODE = '/curve_proximity'
PATIENCE = 10                 # [s] for a message to arrive; a failure takes that long
TETRAHEDRON = [(0, 0, 0), (.4, 0, 0), (0, .4, 0), (0, 0, .4)], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
SWING = joint_trajectory(['turn'], [0.0], [1.0])
CURVES = [bezier((2, -2, 1), (2, 2, 1), id='line'), bezier((0, 3, 0), (3, 3, 3), (3, 0, 0), id='bow')]


def foreign(object, frame='world', at=(0, 0, 0), subframes=()):
    """An object of ours as MoveIt's."""
    out = moveit.CollisionObject(id=object.id, pose=pose(at), primitives=object.primitives,
                                 meshes=object.meshes, planes=object.planes)
    out.header.frame_id = frame
    out.primitive_poses = [pose() for _ in object.primitives]
    out.mesh_poses = [pose() for _ in object.meshes]
    out.plane_poses = [pose() for _ in object.planes]
    out.subframe_names = [name for name, _ in subframes]
    out.subframe_poses = [pose(where) for _, where in subframes]
    return out


def attached(link, object, touch_links=()):
    return moveit.AttachedCollisionObject(link_name=link, object=object, touch_links=list(touch_links))


def matrix(names, allowed, defaults=()):
    """An allowed collision matrix: pairs that may touch, and pairs of a name and its default."""
    entries = [moveit.AllowedCollisionEntry(enabled=[{a, b} in allowed for b in names]) for a in names]
    return moveit.AllowedCollisionMatrix(entry_names=list(names), entry_values=entries, default_entry_names=[name for name, _ in defaults],
                                         default_entry_values=[value for _, value in defaults])


def full_scene():
    scene = moveit.PlanningScene(robot_model_name='arm')
    scene.robot_state.joint_state = JointState(name=['turn'], position=[0.25])
    scene.robot_state.attached_collision_objects = [
        attached('arm', foreign(box('tool', (.1, .1, .4)), frame='arm', at=(.5, 0, .2)), ['slider'])]
    scene.allowed_collision_matrix = matrix(['arm', 'base', 'slider', 'table'], [{'arm', 'base'}, {'arm', 'table'}],
                                            [('base', True)])
    scene.link_padding = [moveit.LinkPadding(*of) for of in (('arm', .02), ('base', 0), ('slider', 0))]
    scene.link_scale = [moveit.LinkScale(*of) for of in (('arm', 1.5), ('base', 1), ('slider', 1))]
    scene.world.collision_objects = [
        foreign(box('table', (1, 1, .1)), at=(1.2, 0, .3), subframes=[('top', (0, 0, .05))]),
        foreign(sphere('cup', .1), frame='table/top', at=(.2, .5, .1)),
        foreign(mesh('part', *TETRAHEDRON), at=(-1, 1, 0))]
    return scene


def same_scene():
    """The same for ~apply_scene; matrix entries that are false there mean what no entry means."""
    tool = AttachedCollisionObject(link_name='arm', touch_links=['slider'],
                                   object=box('tool', (.1, .1, .4), (.5, 0, .2), frame='arm'))
    return (
        [box('table', (1, 1, .1), (1.2, 0, .3)), sphere('cup', .1, (1.4, .5, .45)),
         mesh('part', *TETRAHEDRON, (-1, 1, 0))],
        dict(attached_collision_objects=[tool], link_padding=[LinkPadding('arm', .02)],
             link_scale=[LinkScale('arm', 1.5)], joint_state=joints(turn=.25),
             allowed_contacts=[AllowedContact('arm', 'base', True), AllowedContact('arm', 'table', True),
                               AllowedContact('base', '', True), AllowedContact('base', 'slider', False),
                               AllowedContact('base', 'table', False)]))


def diff(*objects):
    scene = moveit.PlanningScene(is_diff=True)
    scene.robot_state.is_diff = True
    scene.world.collision_objects = list(objects)
    return scene


class PlanningScene(Case):
    @classmethod
    def setUpClass(cls):
        cls.log, cls.statuses = [], {}
        cls.log_reader = rospy.Subscriber('/rosout', Log, lambda line: cls.log.append(line))
        cls.status_reader = rospy.Subscriber('/diagnostics', DiagnosticArray, cls.take_statuses)
        cls.scene = full_scene()                                     # of the move_group that the test plays
        cls.service = rospy.Service('/get_planning_scene', GetPlanningScene, cls.answer)
        names = NODE, '/told', '/late', '/follower', '/beginner'
        cls.server, cls.told, cls.late, cls.follower, cls.beginner = [Server(name) for name in names]
        cls.scenes = cls.publisher(NODE)
        # they stay: a connection may be counted that the node is about to close, as it hears late of a publisher that went
        cls.answers, topics = [], dict(robot_trajectory=moveit.RobotTrajectory, display_trajectory=moveit.DisplayTrajectory)
        cls.answer_reader = rospy.Subscriber(NODE + '/proximity', ProximityResults, cls.answers.append)
        cls.asking = {name: rospy.Publisher('%s/%s' % (NODE, name), kind, queue_size=10) for name, kind in topics.items()}

    @classmethod
    def answer(cls, request):
        cls.components, scene = request.components.components, None
        if request._connection_header['callerid'] == '/beginner':
            scene = cls.overtake()
        return GetPlanningSceneResponse(scene=scene or cls.scene)

    overtake = staticmethod(lambda: None)    # what /beginner is answered instead

    @classmethod
    def take_statuses(cls, array):
        cls.statuses.update({status.name: status for status in array.status})

    @classmethod
    def publisher(cls, node):
        publisher = rospy.Publisher(node + '/planning_scene', moveit.PlanningScene, queue_size=10)
        assert connected(publisher), 'the node has another type than moveit_msgs'
        return publisher

    def version(self, server):
        return server.scene().scene.version

    def send(self, scene, publisher=None, server=None):
        """Until it is applied."""
        server = server or self.server
        before = self.version(server)
        (publisher or self.scenes).publish(scene)
        self.assertTrue(until(lambda: self.version(server) > before, PATIENCE), 'the scene does not change')

    def assertStatus(self, node, level, *words):
        def found():
            status = self.statuses.get('%s: planning_scene' % node)
            text = status and status.message + ''.join(' %s=%s' % (v.key, v.value) for v in status.values)
            return status and status.level == level and all(word in text for word in words) and text
        self.assertTrue(until(found, PATIENCE), '%s: %s' % (node, self.statuses.get('%s: planning_scene' % node)))
        return found()

    def assertLogged(self, node, *words):
        found = until(lambda: [line.msg for line in list(self.log)
                               if line.name == node and all(word in line.msg for word in words)], PATIENCE)
        self.assertEqual(len(found), 1, '%s: %s' % (words, [line.msg for line in self.log[-5:]]))

    def rows(self, server):
        curves = server.distance(CURVES, per_object=True, joint_state=joints(turn=.25))
        motion = server.distance([], trajectory=SWING, per_object=True, self_collision=True)
        rows = list(curves.results) + list(motion.results)
        self.assertTrue(rows)
        return {(row.id, row.kind, row.a if row.kind != 'curve' else '', row.b): (row.status, row.lower, row.upper)
                for row in rows}

    def assertSameAnswers(self):
        """Both searches are the same where both scenes are; poses are equal but for rounding."""
        ours, theirs = self.rows(self.server), self.rows(self.told)
        self.assertEqual(set(ours), set(theirs))
        for key, (status, lower, upper) in ours.items():
            self.assertEqual(status, theirs[key][0], key)
            for value, other in (lower, theirs[key][1]), (upper, theirs[key][2]):
                self.assertTrue(value == other or abs(value - other) <= 2e-6, (key, value, other))

    def test_2_full_scene_and_diff_are_answered_as_by_apply_scene(self):
        objects, others = same_scene()
        self.told.replace(*objects, **others)
        self.server.apply(sphere('left over', 1, (0, 0, 9)))
        self.send(full_scene())
        self.assertEqual([thing.id for thing in self.server.scene().objects], ['cup', 'part', 'table'])
        self.assertSameAnswers()

        # the tool is put down, the table moves and its cup goes, another cup comes: as move_group's diffs say it
        change = diff(moveit.CollisionObject(id='cup', operation=1), foreign(box('table', (1, 1, .1)), at=(0, 1.5, .3)),
                      foreign(box('tool', (.1, .1, .4)), at=(1, 1, 1)), foreign(sphere('can', .05), at=(-1, -1, 1)))
        change.robot_state.attached_collision_objects = [attached('', moveit.CollisionObject(id='tool', operation=1))]
        change.link_padding = [moveit.LinkPadding('arm', .05)]
        change.allowed_collision_matrix = matrix(['arm', 'base', 'slider'], [])
        self.send(change)
        objects = [box('table', (1, 1, .1), (0, 1.5, .3)), box('tool', (.1, .1, .4), (1, 1, 1)),
                   sphere('can', .05, (-1, -1, 1)), mesh('part', *TETRAHEDRON, (-1, 1, 0))]
        self.told.replace(*objects, link_padding=[LinkPadding('arm', .05)], link_scale=[LinkScale('arm', 1.5)])
        self.assertSameAnswers()
        self.assertStatus('curve_proximity', 0, 'following', 'full scenes=1', 'diffs since then=1')

    def test_3_what_cannot_be_used_is_one_line_and_the_rest_is_used(self):
        scene = diff(foreign(sphere('good', .1), at=(5, 5, 5)), foreign(sphere('lost', .1), frame='moon'))
        scene.link_padding = [moveit.LinkPadding('wrist', .1), moveit.LinkPadding('elbow', .1)]
        scene.world.octomap.octomap.id, scene.world.octomap.octomap.resolution = 'CountingOcTree', .1
        scene.world.octomap.octomap.data = [1, 2, 3]
        self.send(scene)
        self.scenes.publish(scene)
        self.assertLogged(NODE, "'elbow', 'wrist'", "'CountingOcTree'", "'lost'", 'the rest is used')
        self.assertIn('good', [thing.id for thing in self.server.scene().objects])
        self.assertStatus('curve_proximity', 1, 'not all of the scene is used', "'wrist'")
        warnings = ' '.join(self.server.distance(CURVES[:1], objects=['good']).warnings)
        self.assertIn("'wrist'", warnings)
        # what is missing stays missing: only a full scene ends that
        self.send(diff(moveit.CollisionObject(id='good', operation=1)))
        self.assertIn("'wrist'", ' '.join(self.server.distance(CURVES[:1], objects=['table']).warnings))
        self.send(full_scene())
        self.assertStatus('curve_proximity', 0, 'following')
        self.assertNotIn("'wrist'", ' '.join(self.server.distance(CURVES[:1], objects=['table']).warnings))

    def test_4_limits_hold_for_scenes_too(self):
        before = self.version(self.server)
        self.scenes.publish(diff(foreign(sphere('x' * 65, .1))))
        self.assertLogged(NODE, 'max_name_length', 'not used')
        large = foreign(mesh('large', *TETRAHEDRON))
        large.meshes[0].vertices = large.meshes[0].vertices * 20000      # 2 MB, and 10 MB with its BVH
        self.scenes.publish(diff(large))
        self.assertLogged(NODE, 'max_request_mb', 'not used')
        self.assertEqual(self.version(self.server), before)
        self.assertStatus('curve_proximity', 1, 'max_request_mb')
        self.send(diff(foreign(sphere('small', .1), at=(7, 7, 7))))

    def test_5_a_diff_before_any_full_scene_is_told_until_one_comes(self):
        def selves():
            rows = self.late.distance([], trajectory=SWING, self_collision=True).results
            return [{row.a, row.b} for row in rows if row.kind == 'self']
        publisher = self.publisher('/late')
        self.send(diff(foreign(sphere('ball', .25), at=(0, 0, 2))), publisher, self.late)
        self.assertLogged('/late', 'diffs and no full scene')
        self.assertStatus('late', 1, 'no full scene')
        self.assertIn('no full scene', ' '.join(self.succeeded(self.late.distance(CURVES, objects=['ball'])).warnings))
        self.assertNotIn({'arm', 'slider'}, selves())    # the SRDF disables them
        self.send(full_scene(), publisher, self.late)
        self.assertIn({'arm', 'slider'}, selves())       # the matrix does not
        self.assertStatus('late', 0, 'following')
        self.assertNotIn('no full scene', ' '.join(self.late.distance(CURVES, objects=['cup']).warnings))

    def fullScenes(self, node):
        values = {value.key: value.value for value in self.statuses['%s: planning_scene' % node].values}
        return int(values['full scenes']), int(values['comparisons with ~get_planning_scene'])

    def test_6_the_server_begins_with_move_groups_scene_and_returns_to_it(self):
        self.assertTrue(until(lambda: len(self.follower.scene().objects) == 3, PATIENCE))
        self.assertEqual(self.components, 1023)
        self.assertStatus('follower', 0, 'following', 'full scenes=1')

        # diffs that never came: the service alone shows them, and a second answer confirms it
        other = copy.deepcopy(full_scene())
        other.world.collision_objects[1].pose.position.x += .01
        other.world.collision_objects.pop()
        type(self).scene = other
        self.assertTrue(until(lambda: [thing.id for thing in self.follower.scene().objects] == ['cup', 'table'], PATIENCE))
        self.assertLogged('/follower', 'replaces', "'cup' stands elsewhere", "'part' is here alone")
        self.assertStatus('follower', 0, 'following', 'full scenes=2', 'scenes replaced after a comparison=1')
        cup = next(thing for thing in self.follower.scene().objects if thing.id == 'cup')
        self.assertAlmostEqual(cup.pose.position.x, 1.41, 9)

        # what a full scene does not mend is reported, and no reason to take each answer
        type(self).scene = full_scene()
        self.scene.world.collision_objects.append(foreign(sphere('lost', -.1)))
        self.assertStatus('follower', 1, 'differs', "'lost'", 'full scenes=3')
        self.assertLogged('/follower', 'differs', "'lost'")
        self.assertIn('differs', ' '.join(self.follower.distance(CURVES, objects=['cup']).warnings))
        full, checks = self.fullScenes('follower')
        self.assertTrue(until(lambda: self.fullScenes('follower')[1] >= checks + 4, PATIENCE))
        self.assertEqual(self.fullScenes('follower')[0], full)
        type(self).scene = full_scene()
        self.assertStatus('follower', 0, 'following')

        # what has come right may be lost again
        self.scene.world.collision_objects.append(foreign(sphere('lost', .1)))
        self.assertTrue(until(lambda: 'lost' in [thing.id for thing in self.follower.scene().objects], PATIENCE))

    def test_6b_a_scene_whose_move_group_has_died_is_unknown_until_one_answers_again(self):
        _, server = self.begin('orphan', ask_planning_scene=True)
        for _ in range(2):
            with subprocess.Popen([sys.executable, __file__, '--move-group', '/orphan/get_planning_scene']) as move_group:
                self.addCleanup(move_group.kill)
                for expected in ('clear', 'ok'), ('undecided', 'unknown'):
                    rows = lambda: server.tolerance(CURVES[0], .01, objects=['cup']).results
                    self.assertTrue(until(lambda: [(r.verdict, r.status) for r in rows()] == [expected], PATIENCE), rows())
                    move_group.kill()

    def ask(self, topic, message, stamp):
        """Publishes a trajectory; the answer to it."""
        self.assertTrue(connected(self.asking[topic], self.answer_reader))
        self.asking[topic].publish(message)
        found = until(lambda: [a for a in self.answers if a.source == topic and a.header.stamp == stamp], PATIENCE)
        self.assertTrue(found, 'no answer')
        return self.succeeded(found[0])

    def assertSameRows(self, rows, expected):
        self.assertEqual([(r.kind, r.a, r.b, r.lower, r.upper) for r in rows],
                         [(r.kind, r.a, r.b, r.lower, r.upper) for r in expected])

    def test_7_trajectories_of_moveit_are_answered_as_by_service(self):
        self.send(full_scene())
        self.send(diff(foreign(sphere('way', .1), at=(.5 * math.cos(.5), .5 * math.sin(.5), .5))))
        asked = [self.server.distance([], trajectory=way, self_collision=True).results
                 for way in (SWING, joint_trajectory(['turn'], [1.0], [1.5]))]
        stamp = rospy.Time(77)
        message = moveit.RobotTrajectory(joint_trajectory=copy.deepcopy(SWING))
        message.joint_trajectory.header.stamp = stamp
        answer = self.ask('robot_trajectory', message, stamp)
        self.assertSameRows(answer.results, asked[0])

        # a joint that the robot does not have is left out
        message.joint_trajectory.joint_names = ['elbow', 'turn']
        message.joint_trajectory.header.stamp = stamp = rospy.Time(78)
        for point in message.joint_trajectory.points:
            point.positions = [1.0] + list(point.positions)
        answer = self.ask('robot_trajectory', message, stamp)
        self.assertSameRows(answer.results, asked[0])
        self.assertIn("'elbow'", ' '.join(answer.warnings))
        self.assertLogged(NODE, '~robot_trajectory', "'elbow'")

        # two after each other
        stamp = rospy.Time(80)
        shown = moveit.DisplayTrajectory(model_id='arm')
        for way in SWING, joint_trajectory(['turn'], [1.0], [1.5]):
            shown.trajectory.append(moveit.RobotTrajectory(joint_trajectory=copy.deepcopy(way)))
        shown.trajectory[0].joint_trajectory.header.stamp = stamp
        shown.trajectory_start.joint_state = JointState(name=['turn'], position=[0.0])
        contacts = heard(NODE + '/contacts', moveit.ContactInformation)
        answer = self.ask('display_trajectory', shown, stamp)
        self.assertSameRows(answer.results, asked[0] + asked[1])
        self.assertEqual({row.id for row in answer.results}, {'trajectory/0', 'trajectory/1'})

        # the arm's ball goes through the one in its way: one of the contacts names both
        def hit():
            return [c for c in contacts if c.contact_body_2 == 'way' and c.header.stamp == stamp]
        self.assertTrue(until(hit, PATIENCE), contacts)
        contact = hit()[0]
        self.assertEqual((contact.body_type_1, contact.body_type_2), (0 if contact.contact_body_1 == 'arm' else 2, 1))
        self.assertEqual(contact.header.frame_id, 'world')
        self.assertGreaterEqual(contact.depth, -1e-6)

        # from a state that carries what the scene does not know: nothing is clear
        shown.trajectory_start.attached_collision_objects = [attached('arm', foreign(sphere('pen', .1), frame='arm'))]
        stamp = rospy.Time(81)
        shown.trajectory[0].joint_trajectory.header.stamp = stamp
        answer = self.ask('display_trajectory', shown, stamp)
        self.assertEqual({row.status for row in answer.results}, {'partial'})
        self.assertLessEqual(max(row.lower for row in answer.results), 0.0)
        self.assertIn("'pen' is not measured", ' '.join(answer.warnings))

    def test_8_diffs_that_are_lost_before_the_topic_is_connected_come_by_the_service(self):
        def objects():
            return [thing.id for thing in self.beginner.scene().objects]
        type(self).scene = full_scene()
        self.assertTrue(until(lambda: objects() == ['cup', 'part', 'table'], PATIENCE))

        # a diff in the gap: published while nobody hears
        self.scene.world.collision_objects.append(foreign(sphere('can', .1), at=(0, 0, 3)))
        publisher = self.publisher('/beginner')
        self.assertTrue(until(lambda: objects() == ['can', 'cup', 'part', 'table'], PATIENCE), objects())
        self.assertStatus('beginner', 0, 'comparisons with ~get_planning_scene=1')    # and asks no more
        publisher.unregister()
        self.assertTrue(until(lambda: not bus_links('/beginner', '/beginner/planning_scene', 'i'), PATIENCE))
        rospy.sleep(.5)                                              # the node looks for publishers each 100 ms

        # a diff that overtakes an older answer of the service
        overtaken = []

        def overtake():
            if not overtaken:
                older = copy.deepcopy(self.scene)
                ball = foreign(sphere('ball', .1), at=(0, 0, 4))
                self.scene.world.collision_objects.append(ball)
                late = self.publisher('/beginner')
                late.publish(diff(ball))
                overtaken.append(until(lambda: 'ball' in objects(), PATIENCE))
                return older
        type(self).overtake = staticmethod(overtake)
        publisher = self.publisher('/beginner')
        self.assertTrue(until(lambda: overtaken, 2 * PATIENCE))
        self.assertTrue(overtaken[0], 'the diff does not come')
        self.assertTrue(until(lambda: 'ball' not in objects(), PATIENCE), 'the older answer does not replace the scene')
        self.assertTrue(until(lambda: 'ball' in objects(), PATIENCE), objects())
        self.assertStatus('beginner', 0, 'following', 'scenes replaced after a comparison=1')
        type(self).overtake = staticmethod(lambda: None)
        publisher.unregister()

    def test_9_each_message_that_cannot_be_used_is_one_message_and_the_rest_of_it_is_used(self):
        def world(*objects):
            return dict(world=moveit.PlanningSceneWorld(collision_objects=list(objects)))

        def carried(link, object):
            return dict(robot_state=moveit.RobotState(attached_collision_objects=[attached(link, object)], is_diff=True))

        def told(names, positions):
            return dict(robot_state=moveit.RobotState(joint_state=JointState(name=names, position=positions), is_diff=True))
        nothing = {operation: moveit.CollisionObject(id='cup', operation=operation) for operation in (0, 1, 3, 7)}
        short = moveit.AllowedCollisionMatrix(entry_names=['arm'], entry_values=[moveit.AllowedCollisionEntry()])
        cup, crowded, ring = foreign(sphere('cup', .1)), foreign(sphere('cup', .1)), [transform('moon', 'sun'), transform('sun', 'moon')]
        crowded.primitive_poses = [pose()] * 2
        publisher = self.publisher('/told')
        self.send(full_scene(), publisher, self.told)
        for i, (fields, *words) in enumerate((
                (dict(link_padding=[moveit.LinkPadding('wrist', .1), moveit.LinkPadding('arm', .5)]), 'links that the robot does not', "'wrist'"),
                (dict(link_padding=[moveit.LinkPadding('arm', -1)]), "'arm'", '-1', 'not below 0'),
                (dict(link_scale=[moveit.LinkScale('arm', 0)]), "link_scale", "'arm'", 'above 0'),
                (told(['wing', 'turn'], [1, .5]), 'joints that the robot does not have', "'wing'"),
                (told(['turn', 'wing'], [1]), '2 joints have 1 positions'),
                (carried('wrist', cup), "'cup'", "'wrist'"),
                (carried('arm', nothing[1]), "'cup'", 'no link carries'),
                (carried('arm', nothing[3]), "'cup'", 'operation is 3'),
                (dict(allowed_collision_matrix=short), 'allowed_collision_matrix', "'arm'", '0 entries'),
                (world(nothing[0]), "'cup'", 'no shapes'),
                (world(foreign(sphere('cup', .1), frame='mars')), "'cup'", "'mars'"),
                (world(foreign(sphere('cup', .1), at=(math.nan, 0, 0))), "'cup'", 'finite'),
                (world(crowded), "'cup'", '2 poses'),
                (world(nothing[7]), "'cup'", 'operation 7'),
                (world(foreign(sphere('<octomap>', .1))), 'reserved'),
                (world(moveit.CollisionObject(id='mug', operation=1)), "'mug'", 'to remove'),
                (world(moveit.CollisionObject(id='mug', operation=3)), "'mug'", 'to move'),
                (dict(world(foreign(sphere('cup', .1), frame='moon')), fixed_frame_transforms=ring), "'cup'", 'ring'),
                (dict(robot_model_name='another'), "'another'", "'arm'"))):
            scene = diff()
            for name, value in fields.items():
                setattr(scene, name, value)
            scene.world.collision_objects.append(foreign(sphere('good', .1), at=(i, 9, 9)))
            self.send(scene, publisher, self.told)
            self.assertLogged('/told', *words, 'the rest is used')
            self.assertEqual(self.told.scene('good').objects[0].pose.position.x, i)
        self.assertEqual([(p.link_name, p.padding) for p in self.told.scene().link_padding], [('arm', .5)])


if __name__ == '__main__':
    if '--move-group' in sys.argv:
        rospy.init_node('move_group', anonymous=True)
        serving = rospy.Service(sys.argv[2], GetPlanningScene, lambda _: GetPlanningSceneResponse(scene=full_scene()))
        rospy.spin()
    else:
        run('planning_scene')
