# SPDX-License-Identifier: BSD-3-Clause
"""A robot in the scene: its links are objects, and frames of objects."""
import math
import os

from support import BOX_SCENE, DATA, Case, bezier, cprox

PANDA = DATA + '/robots/panda/panda.urdf'

# a mast at the origin; an arm of 2 m that turns about z at a height of 1, with a ball of 0.1 at its end; a slide beyond it
ARM = '''<robot name="arm">
  <link name="mast"><collision><origin xyz="0 0 0.5"/><geometry><box size="0.2 0.2 1"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="2 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="tip"/>
  <joint name="turn" type="revolute"><parent link="mast"/><child link="arm"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="arm"/><child link="tip"/><origin xyz="2 0 0"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
</robot>'''

# stands at (3, 0, 1): 0.9 from the ball when the arm points along x
BESIDE = bezier('c', (3, 0, 1), (3 + 1e-9, 0, 1))


class Robot(Case):
    def arm(self, *more, scene=None, curve=BESIDE, query_type='distance'):
        words = [query_type, '--curves', self.file('curves.csv', curve), '--robot', self.file('arm.urdf', ARM), *more]
        if scene is not None:
            words += ['--scene', self.file('scene.yaml', scene)]
        return cprox(*words)

    def links_are_objects(self):
        answer = self.arm()
        self.assertEqual((answer.code, answer.err), (0, ''))
        self.assertAnswer(answer.row('c'), 0.9, slack=2e-9)
        self.assertEqual((answer.row('c')['a'], answer.row('c')['b']), ('c', 'arm'))

    def per_object_lists_links_and_objects(self):
        answer = self.arm('--per-object', scene=BOX_SCENE)
        self.assertEqual({row['b'] for row in answer.rows}, {'box', 'mast', 'arm'})
        self.assertAnswer(answer.row('c', 'box'), 2.0, slack=2e-9)
        self.assertAnswer(answer.row('c', 'mast'), 2.9, slack=2e-9)

    def state_moves_the_links(self):
        answer = self.arm('--state', f'turn: {math.pi / 2}')
        self.assertAnswer(answer.row('c'), min(2.9, math.hypot(3, 2) - 0.1), slack=2e-9)
        self.assertEqual(answer.row('c')['b'], 'mast')

    def the_scenes_robot_state_counts_where_state_is_silent(self):
        scene = f'robot_state: {{joint_state: {{name: [turn, slide], position: [{math.pi}, 0.5]}}}}'
        self.assertEqual(self.arm(scene=scene).row('c')['b'], 'mast')
        self.assertAnswer(self.arm('--state', 'turn: 0', scene=scene).row('c'), 0.9, slack=2e-9)

    def joints_of_the_scene_that_the_robot_lacks_are_told(self):
        answer = self.arm(scene='robot_state: {joint_state: {name: [wheel], position: [1]}}')
        self.assertEqual((answer.code, answer.rows[0]['status']), (3, 'partial'))
        self.assertRegex(answer.err, "warning: .*'wheel'")

    def a_state_that_cannot_be_meant_is_refused(self):
        for state, words in (('elbow: 1', ["'elbow'"]), ('turn: fast', ["'fast'"]), ('turn: .nan', ['.nan']), ('turn', ['turn']),
                             ('turn: 1, turn: 2', ['twice']), ('turn: [', ['--state'])):
            with self.subTest(state=state):
                self.assertRefused(self.arm('--state', state), *words)

    def frames_may_be_links_at_the_scenes_state(self):
        # the tip stands at (0, 2.5, 1); an object fixed to it stays there when --state turns the arm away
        scene = (f'robot_state: {{joint_state: {{name: [turn, slide], position: [{math.pi / 2}, 0.5]}}}}\n'
                 'world: {collision_objects: [{id: thing, header: {frame_id: tip}, primitives: [{type: 2, dimensions: [0.5]}]}]}')
        for state in ((), ('--state', 'turn: 0, slide: 0')):
            row = self.arm('--per-object', *state, scene=scene).row('c', 'thing')
            self.assertAnswer(row, math.hypot(3, 2.5) - 0.5, slack=2e-9)

    def the_root_link_is_the_fixed_frame(self):
        scene = 'world: {collision_objects: [{id: thing, header: {frame_id: mast}, primitives: [{type: 2, dimensions: [0.5]}]}]}'
        self.assertAnswer(self.arm('--per-object', scene=scene).row('c', 'thing'), math.hypot(3, 1) - 0.5, slack=2e-9)

    def the_srdfs_parent_frame_is_the_fixed_frame(self):
        scene = 'world: {collision_objects: [{id: thing, header: {frame_id: hall}, primitives: [{type: 2, dimensions: [0.5]}]}]}'
        self.assertRefused(self.arm(scene=scene), "'hall'")
        srdf = self.file('arm.srdf', '<robot name="arm"><!-- <virtual_joint parent_frame="no"/> -->'
                         '<virtual_joint name="v" type="fixed" parent_frame="hall" child_link="mast"/></robot>')
        answer = self.arm('--per-object', '--srdf', srdf, scene=scene)
        self.assertAnswer(answer.row('c', 'thing'), math.hypot(3, 1) - 0.5, slack=2e-9)
        self.assertRefused(self.arm('--srdf', self.file('bad.srdf', '<robot')), 'bad.srdf')

    def attached_objects_move_with_their_link(self):
        # a ball of 0.2 half a metre beyond the end of the arm
        scene = ('robot_state: {attached_collision_objects: [{link_name: arm, object: {id: held, header: {frame_id: arm}, '
                 'primitives: [{type: 2, dimensions: [0.2]}], primitive_poses: [{position: [2.5, 0, 0]}]}}]}')
        self.assertAnswer(self.arm('--per-object', scene=scene).row('c', 'held'), 0.3, slack=2e-9)
        row = self.arm('--per-object', '--state', f'turn: {math.pi / 2}', scene=scene).row('c', 'held')
        self.assertAnswer(row, math.hypot(3, 2.5) - 0.2, slack=2e-9)
        self.assertRefused(self.arm(scene=scene.replace('link_name: arm', 'link_name: leg')), "'held'", "'leg'")

    def link_padding_enlarges_a_link(self):
        scene = 'link_padding: [{link_name: arm, padding: 0.25}]'
        row = self.arm(scene=scene).row('c')
        self.assertAnswer(row, 0.65, slack=2e-9)
        self.assertPoint(row, 'b', (2.35, 0, 1))
        self.assertRefused(self.arm(scene='link_padding: [{link_name: leg, padding: 0.25}]'), 'leg')

    def skipped_names_links_without_geometry(self):
        answer = self.arm('--skipped')
        self.assertRegex(answer.err, "skipped: .*'tip'")
        self.assertEqual(answer.code, 0)

    def geometry_that_cannot_be_used_is_left_out_where_allowed_and_never_clear(self):
        path = self.file('gone.urdf', ARM.replace('<link name="tip"/>', '<link name="tip"><collision><geometry><mesh filename="gone.stl"/></geometry></collision></link>'))
        words = ['tolerance', '--delta', '0.1', '--curves', self.file('curves.csv', BESIDE), '--robot', path]
        self.assertEqual(cprox(*words).code, 2)
        answer = cprox(*words, '--allow-missing-geometry')
        self.assertEqual((answer.code, answer.rows[0]['status'], answer.rows[0]['verdict']), (3, 'partial', 'undecided'))
        self.assertIn('gone.stl', answer.err)

    def a_urdf_that_cannot_be_used_is_refused(self):
        for text in ('', 'no xml', '<robot name="r"/>', ARM.replace('radius="0.1"', 'radius="-1"'), ARM.replace('<sphere radius="0.1"/>', '<capsule/>'),
                     ARM.replace('<sphere radius="0.1"/>', '<mesh filename="none.stl"/>')):
            with self.subTest(text=text[:20]):
                self.assertRefused(cprox('distance', '--curves', self.file('c.csv', BESIDE), '--robot', self.file('r.urdf', text)), 'r.urdf')


class Panda(Case):
    def meshes_with_fewer_triangles_contain_those_they_stand_for(self):
        """The Fanuc's own meshes, past which a point moves: with a tolerance it is nearer, by at most twice that."""
        words = ['distance', '--curves', self.file('curves.csv', bezier('c', (1.5, -1, 0.9), (1.2, 1, 1.2))), '--robot',
                 DATA + '/robots/fanuc_m10ia/fanuc_m10ia.urdf', '--timings']
        exact, counts = None, []
        for tolerance in ('0', '0.002', '0.02', '1'):
            answer = cprox(*words, '--mesh-tolerance', tolerance)
            self.assertEqual(answer.code, 0, answer.err)
            row = answer.row('c')
            lower, upper = float(row['lower']), float(row['upper'])
            exact = exact or (lower, upper)
            self.assertLessEqual(lower, exact[1])
            self.assertGreaterEqual(upper, exact[0] - 2 * float(tolerance))
            counts.append(sum(int(line.split(' triangles')[0].split()[-1]) for line in answer.err.splitlines() if ' triangles' in line))
        self.assertEqual(counts, sorted(counts, reverse=True))
        self.assertLess(counts[2], counts[0] / 2)
        self.assertRefused(cprox(*words, '--mesh-tolerance', '-1'), '--mesh-tolerance')

    def the_panda_among_the_shelves_answers_with_links_and_objects(self):
        scene = DATA + '/scenes/mbm/bookshelf_small_panda/scene0001.yaml'
        curves = self.file('curves.csv', bezier('c', (0.6, -0.6, 0.7), (0.2, 0.2, 0.9), (0.1, 0.4, 0.3)))
        state = ', '.join(f'panda_joint{i + 1}: {q}' for i, q in enumerate((0, -0.785, 0, -2.356, 0, 1.571, 0.785)))
        answer = cprox('distance', '--curves', curves, '--scene', scene, '--robot', PANDA, '--state', state, '--per-object')
        self.assertEqual((answer.code, answer.err), (0, ''))
        names = {row['b'] for row in answer.rows}
        self.assertTrue({'Can1', 'shelf_top', 'panda_link0', 'panda_hand', 'panda_leftfinger'} <= names, names)
        self.assertEqual({row['status'] for row in answer.rows}, {'ok'})

        # the one row without --per-object is the least of them
        nearest = cprox('distance', '--curves', curves, '--scene', scene, '--robot', PANDA, '--state', state).row('c')
        least = min(answer.rows, key=lambda row: float(row['upper']))
        self.assertEqual(nearest['b'], least['b'])
        self.assertAlmostEqual(float(nearest['upper']), float(least['upper']), delta=1e-6)

        # the fingertips of this well-known posture hold at about x = 0.31, z = 0.49: a curve there hits the hand
        hand = self.file('hand.csv', bezier('h', (0.307, -0.3, 0.6), (0.307, 0.3, 0.6)))
        self.assertEqual(cprox('collision', '--curves', hand, '--robot', PANDA, '--state', state).row('h')['verdict'], 'violated')
        self.assertTrue(os.path.exists(PANDA))
