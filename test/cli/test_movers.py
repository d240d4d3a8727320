# SPDX-License-Identifier: BSD-3-Clause
"""Objects and further robots that move. Distances and times are worked out by hand."""
import math

from support import Case, cprox
from test_trajectory import SLIDE, SLIDER

# A cube of 0.4 falls four metres in a second and turns by a right angle about x, past the edge of a shelf at y = -0.3.
FALL = '''
world:
  collision_objects:
    - {id: shelf, primitives: [{type: box, dimensions: [1, 1, 0.1]}], primitive_poses: [{position: [0, -0.8, 0]}]}
    - id: box
      primitives: [{type: box, dimensions: [0.4, 0.4, 0.4]}]
      trajectory:
        turning: slerp
        waypoints:
          - {time: 0, pose: {position: [0, 0, 2]}}
          - {time: 1, pose: {position: [0, 0, -2], orientation: [0.7071067811865476, 0, 0, 0.7071067811865476]}}
'''
# A ball of 0.1 crosses the way of SLIDE's cart from y = 1 to y = -1 in four seconds.
BALL = '''
world:
  collision_objects:
    - id: ball
      primitives: [{type: sphere, dimensions: [0.1]}]
      trajectory:
        start: START
        waypoints: [{time: 0, pose: {position: [1, 1, 0]}}, {time: 4, pose: {position: [1, -1, 0]}}]
'''
# A second slider, 0.5 beside the first, against its direction: both carts are 0.2 wide.
SECOND = '''
moving_robots:
  - name: NAME
    robot: robot.urdf
    base: {position: [2, 0.5, 0], orientation: [0, 0, 1, 0]}
    trajectory: {joint_trajectory: {joint_names: [slide], points: [{positions: [0], time_from_start: 0}, {positions: [2], time_from_start: 4}]}}
    start: START
'''


class Movers(Case):
    def scene(self, query_type, scene, *more):
        return cprox(query_type, '--scene', self.file('scene.yaml', scene), *more)

    def robot(self, query_type, scene, *more):
        return self.scene(query_type, scene, '--robot', self.file('robot.urdf', SLIDER), '--trajectory',
                          self.file('go.yaml', SLIDE), *more)

    def a_box_that_falls_and_turns_is_measured_at_its_corner(self):
        answer = self.scene('distance', FALL, '--movers')
        self.assertEqual((answer.code, answer.err), (0, ''))
        row = answer.row('movers')
        self.assertAnswer(row, 0.3 - 0.2 * math.sqrt(2))
        self.assertEqual((row['kind'], row['a'], row['b']), ('environment', 'box', 'shelf'))
        self.assertAlmostEqual(float(row['t']), 0.5, delta=0.02)
        self.assertEqual(self.scene('time-of-contact', FALL, '--movers').row('movers')['verdict'], 'clear')
        self.assertEqual(self.scene('tolerance', FALL, '--movers', '--delta', '0.018').row('movers')['verdict'], 'violated')

    def contact_is_never_told_late(self):
        """With the shelf in its way: the lower face, turned by a, meets z = 0.05 with its lowest corner."""
        scene = FALL.replace('-0.8, 0]', '0, 0]')
        answer = self.scene('time-of-contact', scene, '--movers')
        self.assertEqual(answer.code, 1)

        def height(t):
            a = t * math.pi / 2
            return 2 - 4 * t - 0.2 * (math.cos(a) + math.sin(a))
        low, high = 0.0, 1.0
        for _ in range(60):
            mid = (low + high) / 2
            low, high = (mid, high) if height(mid) > 0.05 else (low, mid)
        row = answer.row('movers')
        self.assertLessEqual(float(row['t_contact_lower']), low + 1e-12)
        self.assertAlmostEqual(float(row['t_contact_lower']), low, delta=1e-5)

    def a_robot_and_a_ball_are_on_one_clock(self):
        together = self.robot('collision', BALL.replace('START', '0'))
        self.assertEqual((together.code, together.row('go')['b']), (1, 'ball'))
        contact = self.robot('time-of-contact', BALL.replace('START', '0')).row('go')
        # the cart's corner and the ball: both gaps are 0.9 - t / 2
        truth = 2 * (0.9 - 0.1 / math.sqrt(2))
        self.assertLessEqual(float(contact['t_contact_lower']), truth)
        self.assertAlmostEqual(float(contact['t_contact_lower']), truth, delta=1e-4)
        for start in ('3', '{secs: 3, nsecs: 0}'):
            later = self.robot('distance', BALL.replace('START', start))
            self.assertEqual((later.code, later.err), (0, ''))
            row = later.row('go')
            self.assertAnswer(row, 0.8)  # at the ball's first place, that it has not left
            self.assertEqual((row['kind'], row['a'], row['b']), ('environment', 'cart', 'ball'))
            self.assertTrue(1.79 <= float(row['t']) <= 2.21, row['t'])
        # nothing is asked of the time after the trajectory's end: the ball comes to y = 0.5 by then
        self.assertAnswer(self.robot('distance', BALL.replace('START', '3').replace('[1,', '[2.5,')).row('go'),
                          math.hypot(0.4, 0.4) - 0.1)

    def starts_may_be_known_to_a_tolerance(self):
        """A ball that comes t seconds late crosses half t behind the cart: both are nearest half of that from the crossing."""
        for tolerance in (0.0, 0.5, 1.0):
            answer = self.robot('distance', BALL.replace('START', f'2\n        start_tolerance: {tolerance}'))
            self.assertEqual((answer.code, answer.err), (0, ''))
            late = 2 - tolerance
            self.assertAnswer(answer.row('go'), math.sqrt(2) * (late / 4 - 0.1) - 0.1)
        self.assertAnswer(self.robot('distance', BALL.replace('START', '2\n        any_time: true')).row('go'), 0)
        self.assertEqual(self.robot('collision', BALL.replace('START', '2\n        any_time: true')).row('go')['verdict'], 'violated')
        self.assertRefused(self.robot('distance', BALL.replace('START', '2\n        start_tolerance: -1')), 'start_tolerance', 'at least 0')

    def two_robots_are_on_one_clock(self):
        answer = self.robot('distance', SECOND.replace('NAME', 'other').replace('START', '0'), '--self')
        self.assertEqual((answer.code, answer.rows[1]['status']), (0, 'ok'), answer.err)
        row = answer.rows[0]
        self.assertAnswer(row, 0.3)
        self.assertEqual((row['kind'], row['a'].split('/')[-1], row['b'].split('/')[0]), ('environment', row['a'], 'other'))
        self.assertEqual(answer.rows[1]['kind'], 'self')
        # two seconds late it has come to x = 1 when the other one is at 2
        late = self.robot('distance', SECOND.replace('NAME', 'other').replace('START', '3').replace('0.5, 0]', '0, 0]'))
        self.assertEqual(late.row('go')['b'].split('/')[0], 'other')
        self.assertAnswer(late.row('go'), 0)
        alone = self.scene('distance', SECOND.replace('NAME', 'other').replace('START', '0'), '--movers')
        self.assertEqual((alone.code, alone.rows[0]['status'], alone.rows[0]['lower']), (3, 'empty', '0'))
        self.assertIn('measured against nothing', alone.err)

    def what_may_touch_is_left_out(self):
        allowed = '\nallowed_collision_matrix: {entry_names: [cart, ball], entry_values: [[true, true], [true, true]]}\n'
        row = self.robot('distance', BALL.replace('START', '0') + allowed).row('go')
        self.assertEqual((row['a'], row['b']), ('arm', 'ball'))

    def a_frame_takes_the_whole_trajectory_with_it(self):
        frame = "\nfixed_frame_transforms: [{header: {frame_id: world}, child_frame_id: tilted, transform: {translation: [0, 0.01, 0]}}]\n"
        row = self.scene('distance', FALL.replace('id: box', 'id: box\n      header: {frame_id: tilted}') + frame, '--movers').row('movers')
        self.assertAnswer(row, 0.31 - 0.2 * math.sqrt(2))

    def clocks_that_do_not_overlap_are_refused_by_how_much(self):
        self.assertRefused(self.robot('distance', BALL.replace('START', '10')), "object 'ball'", 'it begins 6 s after that of')
        self.assertRefused(self.robot('distance', BALL.replace('START', '-7')), "object 'ball'", 'stale: it ends 3 s before')
        self.assertRefused(self.robot('distance', SECOND.replace('NAME', 'other').replace('START', '4.5')), "robot 'other'", '0.5 s')

    def names_that_clash_are_refused(self):
        self.assertRefused(self.robot('distance', SECOND.replace('NAME', 'slider').replace('START', '0')), "two movers are named 'slider'")
        twice = BALL.replace('START', '0') + SECOND.replace('NAME', 'ball').replace('START', '0')
        self.assertRefused(self.robot('distance', twice), "two movers are named 'ball'")

    def bad_trajectories_are_refused_by_place(self):
        ball = BALL.replace('START', '0')
        for change, into, because in (
                ('time: 4', 'time: 0', "'ball'.trajectory.waypoints[1].time (line 8): does not ascend"),
                ('[1, -1, 0]}', '[1, -1, 0], orientation: [0, 0, 0, 0]}', "the quaternion's norm is 0"),
                ('[1, -1, 0]}', '[1, -1, 0], orientation: [0, 0, 1, 0]}', 'half a turn'),
                ('[1, -1, 0]', '[1, .nan, 0]', 'not a finite number'),
                ('start: 0', 'turning: fast', "'fast' is none of slerp, screw"),
                ('trajectory:', 'pose: {position: [0, 0, 1]}\n      trajectory:', 'a pose and a trajectory'),
                ('id: ball', 'id: ball\n      operation: append', 'only ADD takes a trajectory')):
            with self.subTest(into=into):
                self.assertRefused(self.scene('distance', ball.replace(change, into), '--movers'), because)
        self.assertRefused(self.scene('distance', SECOND.replace('NAME', 'a').replace('START', '0').replace('robot.urdf', 'none.urdf'), '--movers'), "none.urdf")

    def clearance_over_time_between_what_moves(self):
        """Cart and ball are both at |1 - t/2| from where their ways cross, in x and in y."""
        def apart(t):
            return max(0.0, math.sqrt(2) * max(0.0, abs(1 - t / 2) - 0.1) - 0.1)
        answer = self.robot('profile', BALL.replace('START', '0'), '--intervals', '4')
        self.assertEqual((answer.code, answer.err, len(answer.rows)), (0, '', 4))
        for row, t in zip(answer.rows, (1, 2, 2, 3)):
            self.assertAnswer(row, apart(t))
            self.assertEqual((row['id'], row['kind'], row['a'], row['b']), ('go', 'environment', 'cart', 'ball'))
        on_cart, on_ball = ([float(answer.rows[0][f'{side}_{axis}']) for axis in 'xyz'] for side in 'ab')
        self.assertAlmostEqual(on_cart[0], 0.6, delta=1e-4)
        self.assertAlmostEqual(math.dist(on_ball, (1, 0.5, on_ball[2])), 0.1, delta=1e-4)
        row, = self.robot('violations', BALL.replace('START', '0'), '--delta', '0.2', '--resolution', '1e-5').rows
        enter = 2 * (1 - (0.3 / math.sqrt(2) + 0.1))
        self.assertTrue(float(row['enter_lower']) <= enter <= float(row['enter_upper']) + 1e-9, row)
        self.assertTrue(float(row['leave_lower']) - 1e-9 <= 4 - enter <= float(row['leave_upper']), row)
        self.assertLess(float(row['enter_upper']) - float(row['enter_lower']), 1e-3)
        self.assertEqual((row['verdict'], row['a'], row['b']), ('violated', 'cart', 'ball'))

    def pairs_links_and_objects_among_what_moves(self):
        scene = BALL.replace('START', '0') + '    - {id: wall, primitives: [{type: box, dimensions: [1, 4, 4]}], primitive_poses: [{position: [3.5, 0, 0]}]}\n'
        rows = self.robot('nearest', scene).rows
        self.assertEqual({(row['a'], row['b']) for row in rows}, {(a, b) for a in ('cart', 'arm', 'hand') for b in ('ball', 'wall')})
        self.assertEqual([float(row['upper']) for row in rows], sorted(float(row['upper']) for row in rows))
        self.assertEqual((rows[0]['a'], rows[0]['b'], float(rows[0]['upper'])), ('cart', 'ball', 0.0))
        rows = self.robot('distance', scene, '--per-object').rows
        self.assertEqual([(row['b'], round(float(row['upper']), 5)) for row in rows], [('wall', 0.9), ('ball', 0.0)])
        rows = self.robot('distance', scene, '--per-link', '--objects', 'wall').rows
        self.assertEqual({row['a']: round(float(row['upper']), 5) for row in rows}, {'cart': 0.9, 'arm': 0.95, 'hand': 0.9})
        self.assertEqual([row['a'] for row in self.robot('distance', scene, '--links', 'hand').rows], ['hand'])
        self.assertEqual([row['b'] for row in self.robot('profile', scene, '--objects', 'wall', '--intervals', '2').rows], ['wall', 'wall'])
        answer = self.robot('distance', scene, '--objects', 'wal')
        self.assertEqual(answer.code, 2)
        self.assertIn("no object 'wal'", answer.err)
        second = SECOND.replace('NAME', 'other').replace('START', '0')
        rows = self.robot('distance', second, '--per-object').rows
        self.assertEqual([row['b'].split('/')[0] for row in rows], ['other'])

    def clearance_over_time_of_all_that_moves(self):
        answer = self.scene('profile', FALL, '--movers', '--intervals', '5')
        self.assertEqual((answer.code, answer.err, [row['kind'] for row in answer.rows]), (0, '', ['movers'] * 5))
        self.assertAnswer(answer.rows[2], 0.3 - 0.2 * math.sqrt(2))
        self.assertGreater(float(answer.rows[0]['lower']), 0.9)
        row, = self.scene('nearest', FALL, '--movers').rows
        self.assertEqual((row['a'], row['b']), ('box', 'shelf'))
        row, = self.scene('violations', FALL, '--movers', '--delta', '0.018').rows
        self.assertEqual((row['verdict'], row['a'], row['b']), ('violated', 'box', 'shelf'))

    def proven(self, ask, query_type, scene, *more):
        """What cprox_check says about the answers of a query."""
        proofs = self.folder + '/proofs'
        answer = ask(query_type, scene, *more, '--certificate', proofs)
        self.assertEqual(answer.err, '')
        words = [word for word in more if word in ('--movers', '--self')]
        arguments = ['--scene', self.folder + '/scene.yaml', *words]
        if ask == self.robot:
            arguments += ['--robot', self.folder + '/robot.urdf', '--trajectory', self.folder + '/go.yaml']
        checked = cprox('check', proofs, *arguments)
        self.assertEqual((checked.code, checked.err), (0, ''), checked.out)
        return checked.out

    def proofs_of_what_moves_are_accepted(self):
        """A body that turns by slerp; a robot beside a ball and beside another robot, on one clock."""
        said = self.proven(self.scene, 'distance', FALL, '--movers')
        self.assertAlmostEqual(float(said.split('farther than ')[1].split()[0]), 0.3 - 0.2 * math.sqrt(2), delta=3e-6)
        self.assertIn('everywhere', said)
        self.assertIn('farther than 0.017', self.proven(self.scene, 'tolerance', FALL, '--movers', '--delta', '0.017'))
        self.assertIn('not farther than 0.01', self.proven(self.scene, 'tolerance', FALL, '--movers', '--delta', '0.018'))
        self.assertIn('everywhere', self.proven(self.scene, 'time-of-contact', FALL, '--movers'))
        self.assertIn(' before ', self.proven(self.scene, 'time-of-contact', FALL.replace('-0.8, 0]', '0, 0]'), '--movers'))
        self.assertIn(' from ', self.proven(self.scene, 'profile', FALL, '--movers', '--intervals', '5'))
        self.assertIn('not farther than', self.proven(self.scene, 'violations', FALL, '--movers', '--delta', '0.018'))
        late, second = BALL.replace('START', '3'), SECOND.replace('NAME', 'other').replace('START', '0')
        self.assertIn('from 0 to 4', self.proven(self.robot, 'distance', late))
        self.assertIn('not farther than', self.proven(self.robot, 'collision', BALL.replace('START', '0')))
        self.assertIn('everywhere', self.proven(self.robot, 'tolerance', second, '--self', '--delta', '0.01'))
        self.assertIn(' from ', self.proven(self.robot, 'profile', late, '--intervals', '3'))

    def a_proof_of_another_fall_is_refused(self):
        proofs = self.folder + '/proofs'
        self.scene('tolerance', FALL, '--movers', '--delta', '0.017', '--certificate', proofs)
        for change, into in (('0.8, 0]', '0.79, 0]'), ('[0, 0, 2]}', '[0, -0.01, 2]}'), ('[0, 0, -2]', '[0, -0.1, -2]')):
            with self.subTest(into=into):
                checked = cprox('check', proofs, '--movers', '--scene', self.file('other.yaml', FALL.replace(change, into)))
                self.assertEqual(checked.code, 1, checked.out)
                self.assertIn('refused', checked.out)

    def a_check_says_of_which_files_it_is(self):
        """By the digest, which changes with the file; and which part of a proof failed."""
        proofs = self.folder + '/proofs'
        self.scene('profile', FALL, '--movers', '--intervals', '5', '--certificate', proofs)
        scene = self.file('scene.yaml', FALL)
        first = cprox('check', proofs, '--movers', '--scene', scene, '-v').err
        self.assertRegex(first, 'read: ' + scene + ', BLAKE2b [0-9a-f]{64}')
        self.assertRegex(first, 'read: ' + proofs + ', BLAKE2b [0-9a-f]{64}')
        self.assertIn('rests on', first)
        changed = cprox('check', proofs, '--movers', '--scene', self.file('scene.yaml', FALL + '\n'), '-v').err
        self.assertNotEqual(first, changed)
        nearer = self.file('scene.yaml', FALL.replace('-0.8, 0]', '-0.7, 0]'))
        self.assertRegex(cprox('check', proofs, '--movers', '--scene', nearer).out, 'refused: part [1-5] of 5: .*, at direction [0-9]')

    def starts_with_a_tolerance_have_no_proof(self):
        answer = self.robot('distance', BALL.replace('START', '2\n        start_tolerance: 0.5'), '--certificate', self.folder + '/proofs')
        self.assertEqual(answer.row('go')['proof'], 'none')
        self.assertIn('starts with a tolerance', answer.err)

    def what_does_not_know_movers_says_so(self):
        ball = BALL.replace('START', '0')
        self.assertRefused(self.robot('distance', ball, '--signed'), 'not available where objects or further robots move')
        curves = self.file('curves.csv', 'c,bezier,1,0,1,0,2,0,0,0,1,0,0\n')
        self.assertRefused(self.scene('distance', ball, '--curves', curves), "object 'ball' moves along a trajectory")
        self.assertRefused(self.scene('distance', 'world: {}', '--movers'), 'nothing moves in this scene')
        self.assertRefused(cprox('distance', '--movers'), '--movers needs --scene')
        self.assertRefused(self.scene('distance', ball, '--movers', '--robot', 'r'), '--movers takes no --robot')
