# SPDX-License-Identifier: BSD-3-Clause
"""A body along a nav_msgs/Path. Distances and times are worked out by hand."""
import math
import re

from support import Case, cprox
from test_trajectory import SLIDER

# As `rostopic echo -n1` prints it: from x = -1 to x = 1 in four seconds, upright.
ECHO = '''header: 
  seq: 7
  stamp: 
    secs: 1000
    nsecs: 500000000
  frame_id: "world"
poses: 
  - 
    header: 
      seq: 0
      stamp: 
        secs: 1001
        nsecs:         0
      frame_id: "world"
    pose: 
      position: 
        x: -1.0
        y: 3.0
        z: 4.0
      orientation: 
        x: 0.0
        y: 0.0
        z: 0.0
        w: 1.0
  - 
    header: 
      seq: 0
      stamp: 
        secs: 1005
        nsecs:         0
      frame_id: ''
    pose: 
      position: 
        x: 1.0
        y: 3.0
        z: 4.0
      orientation: 
        x: 0.0
        y: 0.0
        z: 0.0
        w: 1.0
---
'''
BALL = 'world: {collision_objects: [{id: ball, primitives: [{type: sphere, dimensions: [0.25]}], primitive_poses: [{position: [0, 3, 3]}]}]}\n'
CARRIED = 'id: carried\nprimitives: [{type: box, dimensions: [0.2, 0.2, 0.6]}]\n'
ROOT = math.sqrt(0.5)


def pose(position, orientation=(0, 0, 0, 1), stamp=0, frame=''):
    return (f'{{header: {{stamp: {stamp}, frame_id: "{frame}"}}, '
            f'pose: {{position: {list(position)}, orientation: {list(orientation)}}}}}')


def path(*poses, frame='world', stamp=0):
    return f'header: {{frame_id: {frame}, stamp: {stamp}}}\nposes: [{", ".join(poses)}]\n'


class Path(Case):
    def ask(self, query_type, way, *more, body=CARRIED, scene=BALL):
        return cprox(query_type, '--path', self.file('walk.yaml', way), '--body', self.file('body.yaml', body),
                     '--scene', self.file('scene.yaml', scene), *more)

    def a_body_rides_what_rostopic_prints(self):
        """A box of .2 x .2 x .6 past a ball of .25, 1 m above it: upright, and lying along its way."""
        answer = self.ask('distance', ECHO)
        self.assertEqual((answer.code, answer.err), (0, ''))
        row, = answer.rows
        self.assertAnswer(row, 1 - 0.3 - 0.25)
        self.assertEqual((row['id'], row['kind'], row['a'], row['b']), ('walk', 'environment', 'carried', 'ball'))
        self.assertAlmostEqual(float(row['t']), 2.0, delta=0.21)  # from its own start; the ball is below its face for .4 s
        self.assertPoint(row, 'b', (0, 3, 3.25), 1e-3)
        lying = re.sub(r'y: 0.0\n(\s+)z: 0.0\n(\s+)w: 1.0', r'y: %r\n\1z: 0.0\n\2w: %r' % (ROOT, ROOT), ECHO)
        self.assertAnswer(self.ask('distance', lying).rows[0], 1 - 0.1 - 0.25)

    def it_turns_as_the_poses_say(self):
        """A bar of 2 m turns by a right angle on the spot: about halfway one corner of its end, then the other points at the ball."""
        bar = 'id: bar\nprimitives: [{type: box, dimensions: [2, 0.2, 0.2]}]\n'
        ball = BALL.replace('[0, 3, 3]', f'[{2 * ROOT}, {2 * ROOT}, 0]')
        row, = self.ask('distance', path(pose((0, 0, 0), stamp=5), pose((0, 0, 0), (0, 0, ROOT, ROOT), stamp=9)), body=bar, scene=ball).rows
        self.assertAnswer(row, 2 - math.hypot(1, 0.1) - 0.25)
        self.assertAlmostEqual(abs(float(row['t']) - 2.0), 4 * math.atan(0.1) / (math.pi / 2), delta=0.01)
        # without the turn the nearest point is the bar's corner
        still = self.ask('distance', path(pose((0, 0, 0), stamp=5), pose((0.001, 0, 0), stamp=9)), body=bar, scene=ball)
        self.assertAnswer(still.rows[0], math.hypot(2 * ROOT - 1.001, 2 * ROOT - 0.1) - 0.25)

    def a_pose_of_the_body_is_in_the_frame_of_the_path_s_poses(self):
        lamp = 'id: lamp\npose: {position: [0, 0, 0.5]}\npadding: 0.01\nprimitives: [{type: sphere, dimensions: [0.1]}]\n'
        upside_down = path(pose((-1, 3, 4), (1, 0, 0, 0), 1), pose((1, 3, 4), (1, 0, 0, 0), 2))
        self.assertAnswer(self.ask('distance', upside_down, body=lamp).rows[0], 1 - 0.5 - 0.1 - 0.01 - 0.25)

    def stamps_that_do_not_ascend_are_replaced_by_unit_steps_and_a_warning_says_so(self):
        for stamps, words in (((7, 7, 7), 'its stamps are all the same: t counts its poses'),
                              ((3, 5, 5), 'its stamps do not ascend: t counts its poses'),
                              ((3, 5, 4), 'its stamps do not ascend: t counts its poses')):
            with self.subTest(stamps=stamps):
                answer = self.ask('distance', path(*[pose((x, 3, 4), stamp=s) for x, s in zip((-4, 0, 1), stamps)]))
                self.assertEqual((answer.code, answer.err.count('\n')), (0, 1), answer.err)
                self.assertIn('walk.yaml: ' + words, answer.err)
                self.assertAlmostEqual(float(answer.rows[0]['t']), 1.0, delta=0.11)
        bare = 'header: {frame_id: world}\nposes: [{pose: {position: [-1, 3, 4]}}, {pose: {position: [1, 3, 4]}}]\n'
        self.assertIn('all the same', self.ask('distance', bare).err)

    def of_one_pose_it_stands_there_at_all_times(self):
        other = ('''}, {id: other, primitives: [{type: sphere, dimensions: [0.1]}],
            trajectory: {waypoints: [{time: 0, pose: {position: [0, 3, 6]}}, {time: 9, pose: {position: [0, 3, 5]}}]}}]}\n''')
        one, scene = path(pose((0, 3, 4), stamp=7)), BALL.replace('}]}\n', other)
        for more, b, expected in (((), 'ball', 0.45), (('--objects', 'other'), 'other', 0.6)):
            answer = self.ask('distance', one, *more, scene=scene)
            self.assertEqual((answer.code, answer.err), (0, ''))
            self.assertAnswer(answer.rows[0], expected)
            self.assertEqual(answer.rows[0]['b'], b)
        self.assertRefused(self.ask('distance', one), "nothing moves: each mover has one pose, 'carried'")

    def stamps_put_it_on_one_clock_with_what_moves(self):
        """Along x at 1 m/s from 1000 s on; a ball crosses x = 2 downwards at 1 m/s: it begins at 1001 s, or with the path."""
        ball = 'id: rider\nprimitives: [{type: sphere, dimensions: [0.1]}]\n'
        way = path(pose((0, 0, 0), stamp=1000), pose((4, 0, 0), stamp='{secs: 1004, nsecs: 0}'))
        for start, expected, t in ((1001, 0.0, 2.0), (0, ROOT - 0.2, 1.5), ('{secs: 1000, nsecs: 500000000}', math.sqrt(0.125) - 0.2, 1.75)):
            scene = ('world: {collision_objects: [{id: other, primitives: [{type: sphere, dimensions: [0.1]}], trajectory: {start: %s, '
                     'waypoints: [{time: 0, pose: {position: [2, 1, 0]}}, {time: 2, pose: {position: [2, -1, 0]}}]}}]}\n' % start)
            with self.subTest(start=start):
                row, = self.ask('distance', way, body=ball, scene=scene).rows
                self.assertAnswer(row, expected, slack=1e-9)
                self.assertAlmostEqual(float(row['t']), t, delta=0.2)
                self.assertEqual((row['kind'], row['a'], row['b']), ('movers', 'rider', 'other'))
                self.assertPoint(row, 'a', (float(row['t']), 0, 0), 0.1001)
        for query_type, more in (('nearest', ()), ('profile', ('--intervals', '2')), ('violations', ('--delta', '0.6'))):
            for row in self.ask(query_type, way, *more, body=ball, scene=scene).rows:
                self.assertEqual((row['a'], row['b']), ('rider', 'other'), row)
                if query_type == 'profile':  # the ball begins half a second after the path, at 1 m/s
                    self.assertLessEqual(abs(float(row['a_x']) - float(row['t'])), 0.1001, row)

    def a_frame_of_the_scene_takes_the_path_with_it(self):
        scene = BALL + 'fixed_frame_transforms: [{header: {frame_id: world}, child_frame_id: map, transform: {translation: [0, 0, 0.1]}}]\n'
        way = path(pose((-1, 3, 4), stamp=1, frame='map'), pose((1, 3, 4), stamp=2), frame='map')
        self.assertAnswer(self.ask('distance', way, scene=scene).rows[0], 1.1 - 0.3 - 0.25)

    def every_query_is_about_it(self):
        """The upright box is within .5 of the ball while its edge is at most sqrt(.75^2 - .7^2) from above it."""
        scene = BALL.replace('}]}\n', '}, {id: wall, primitives: [{type: box, dimensions: [1, 4, 4]}], primitive_poses: [{position: [3.5, 3, 4]}]}]}\n')
        rows = self.ask('nearest', ECHO, scene=scene).rows
        self.assertEqual([(row['a'], row['b'], round(float(row['upper']), 5)) for row in rows], [('carried', 'ball', 0.45), ('carried', 'wall', 1.9)])
        rows = self.ask('distance', ECHO, '--per-object', scene=scene).rows
        self.assertEqual({row['b']: round(float(row['upper']), 5) for row in rows}, {'ball': 0.45, 'wall': 1.9})
        rows = self.ask('profile', ECHO, '--intervals', '4', scene=scene).rows
        self.assertEqual([(row['id'], row['a'], float(row['t0']), float(row['t1'])) for row in rows], [('walk', 'carried', i, i + 1) for i in range(4)])
        self.assertAnswer(rows[0], math.hypot(0.4, 0.7) - 0.25)  # at x = -.5 its edge is .4 from the ball's middle
        row, = self.ask('violations', ECHO, '--delta', '0.5', '--resolution', '1e-5', scene=scene).rows
        enter = 2 * (1 - 0.1 - math.sqrt(0.75 ** 2 - 0.7 ** 2))
        self.assertTrue(float(row['enter_lower']) <= enter <= float(row['enter_upper']) + 1e-9, row)
        self.assertEqual((row['verdict'], row['a'], row['b']), ('violated', 'carried', 'ball'))
        self.assertEqual(self.ask('tolerance', ECHO, '--delta', '0.44').rows[0]['verdict'], 'clear')
        self.assertEqual(self.ask('tolerance', ECHO, '--delta', '0.46').code, 1)
        contact = self.ask('time-of-contact', ECHO.replace('z: 4.0', 'z: 3.0'))
        self.assertEqual((contact.code, contact.rows[0]['b']), (1, 'ball'))
        self.assertAlmostEqual(float(contact.rows[0]['t_contact_lower']), 2 * (1 - 0.1 - 0.25), delta=1e-4)
        self.assertLessEqual(float(contact.rows[0]['t_contact_lower']), 2 * (1 - 0.1 - 0.25) + 1e-12)
        allowed = 'allowed_collision_matrix: {default_entry_names: [carried], default_entry_values: [true]}\n'
        self.assertEqual(self.ask('collision', ECHO.replace('z: 4.0', 'z: 3.0'), scene=BALL + allowed).code, 3)  # nothing is left to measure

    def it_may_be_what_a_link_carries(self):
        """A ball of .1 half a metre ahead of the cart: the path is the cart's, which turns it downwards."""
        held = ('robot_state: {attached_collision_objects: [{link_name: cart, object: {id: held, header: {frame_id: cart}, '
                'primitives: [{type: 2, dimensions: [0.1]}], primitive_poses: [{position: [0.5, 0, 0]}]}}]}\n')
        down = (0, ROOT, 0, ROOT)
        way = path(pose((-1, 3, 4), down, 1), pose((1, 3, 4), down, 2))
        robot = ('--robot', self.file('robot.urdf', SLIDER))
        answer = self.ask('distance', way, *robot, body='id: held', scene=BALL + held)
        self.assertEqual((answer.code, answer.err), (0, ''))
        self.assertAnswer(answer.rows[0], 1 - 0.5 - 0.1 - 0.25)
        self.assertEqual(answer.rows[0]['a'], 'held')
        self.assertRefused(self.ask('distance', way, *robot, body='id: hold', scene=BALL + held), "no link carries an object 'hold'", "'held'")
        self.assertRefused(self.ask('distance', way, body='id: held'), "'held' has no shape", '--robot')
        self.assertRefused(self.ask('distance', way, *robot), '--path takes no --robot', 'not measured')

    def without_a_body_a_point_or_a_ball_rides_along_it(self):
        """Past the ball of .25, 1 m above it, then sideways away from it. What orientations say does not matter."""
        upside_down, none = (0, 0, 1, 0), (0, 0, 0, 0)
        way = path(pose((-1, 3, 4), stamp=1), pose((1, 3, 4), upside_down, 3), pose((1, 5, 4), none, 4))
        scene = BALL + 'fixed_frame_transforms: [{header: {frame_id: world}, child_frame_id: map, transform: {translation: [0, 0, 0.1]}}]\n'

        def ask(query_type, *more, way=way, scene=scene):
            return cprox(query_type, '--path', self.file('walk.yaml', way), '--scene', self.file('scene.yaml', scene), *more)
        for more, radius in (((), 0.0), (('--radius', '0'), 0.0), (('--radius', '0.2'), 0.2)):
            answer = ask('distance', *more)
            self.assertEqual((answer.code, answer.err), (0, ''))
            row, = answer.rows
            self.assertAnswer(row, 0.75 - radius)
            self.assertEqual((row['id'], row['kind'], row['a'], row['b']), ('walk', 'environment', 'walk', 'ball'))
            self.assertAlmostEqual(float(row['t']), 1.0, delta=0.01)
            self.assertPoint(row, 'a', (0, 3, 4 - radius), 0.01)
        self.assertAnswer(ask('distance', way=way.replace('world', 'map')).rows[0], 0.85)
        contact = ask('time-of-contact', '--radius', '0.85')
        self.assertEqual((contact.code, contact.rows[0]['verdict']), (1, 'violated'))
        self.assertAlmostEqual(float(contact.rows[0]['t_contact_lower']), 1 - math.sqrt(1.1 ** 2 - 1), delta=1e-4)
        row, = ask('violations', '--delta', '1', '--resolution', '1e-5').rows
        self.assertTrue(float(row['enter_lower']) <= 0.25 <= float(row['enter_upper']) <= float(row['enter_lower']) + 1e-4, row)
        self.assertTrue(float(row['leave_lower']) <= 1.75 <= float(row['leave_upper']) <= float(row['leave_lower']) + 1e-4, row)
        first, last = ask('profile', '--intervals', '2', '--radius', '0.1').rows
        self.assertAnswer(first, 0.65)
        self.assertAnswer(last, math.sqrt(1.25) - 0.35)
        self.assertRefused(ask('distance', '--robot', self.file('robot.urdf', SLIDER)), '--path takes no --robot')
        self.assertRefused(ask('distance', scene=BALL.replace('id: ball', 'id: walk')), "'walk' is a mover and an object that stands")

    def what_is_wrong_is_one_line(self):
        good = (pose((0, 0, 0), stamp=1), pose((1, 0, 0), stamp=2))
        for way, words in ((path(good[0], pose((1, 0, 0), (0, 0, 0, 0), 2)), ('poses[1].pose.orientation', "the quaternion's norm is 0")),
                           (path(good[0], pose((1, 0, 0), (0, 0, '.nan', 1), 2)), ('poses[1].pose.orientation', 'not a finite number')),
                           (path(good[0], pose((1, '.inf', 0), stamp=2)), ('poses[1].pose.position', 'not a finite number')),
                           (path(good[0], pose((1, 0, 0), (0, 0, 1, 0), 2)), ("'carried'", 'half a turn')),
                           (path(*good, frame='nowhere'), ("'nowhere'",)),
                           (path(good[0], pose((1, 0, 0), stamp=2, frame='map')), ('poses[1]', "is in frame 'map', the path in 'world'")),
                           (path(), ('the path has no poses',)),
                           (path(good[0], '{header: {stamp: 2}}'), ('poses[1]', "has no 'pose'")),
                           (path(good[0], pose((1, 0, 0), stamp='soon')), ('poses[1].header.stamp', "'soon'")),
                           ('header: {frame_id: world}\n', ("has no 'poses'",)),
                           ('[1, 2]', ('walk.yaml', 'must be a map')), ('a: [', ('walk.yaml', 'no YAML'))):
            with self.subTest(way=way):
                self.assertRefused(self.ask('distance', way), 'walk.yaml', *words)
        for body, words in (('primitives: [{type: sphere, dimensions: [0.1]}]', ("has no 'id'",)),
                            ('id: a\nprimitives: [{type: sphere, dimensions: [-1]}]', ("object 'a'", 'sphere dimension 0')),
                            ('id: ball\nprimitives: [{type: sphere, dimensions: [1]}]', ("'ball' is a mover and an object that stands",)),
                            ('id: a\nprimitives: 3', ('body.yaml', 'must be a list'))):
            with self.subTest(body=body):
                self.assertRefused(self.ask('distance', path(*good), body=body), *words)
        for radius, words in ((('--radius', '-1'), 'at least 0'), (('--radius', 'x'), "is 'x'"), (('--radius', '1', '--body', 'b'), 'exclude')):
            self.assertRefused(cprox('distance', '--path', 'p', '--scene', 's', *radius), '--radius', words)
        self.assertRefused(cprox('distance', '--radius', '1', '--scene', 's', '--curves', 'c'), '--radius needs --path')
        self.assertRefused(cprox('distance', '--path', 'p', '--body', 'b'), '--path needs --scene')
        self.assertRefused(cprox('distance', '--body', 'b', '--scene', 's', '--curves', 'c'), '--body needs --path')
        for more in (('--curves', 'c'), ('--trajectory', 't'), ('--movers',), ('--self',), ('--signed',), ('--links', 'l')):
            self.assertRefused(cprox('distance', '--path', 'p', '--body', 'b', '--scene', 's', *more), more[0])
        self.assertRefused(cprox('report', '--path', 'p', '--out', 'r'), "'report' takes no --path")
