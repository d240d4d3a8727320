# SPDX-License-Identifier: BSD-3-Clause
"""Files of which a part would go missing: it is used, or refused in one line."""
from support import Case, cprox

ROBOT = '''<robot name="m" %s><link name="base"><collision><geometry><box size="0.4 0.4 0.4"/></geometry></collision></link>
<link name="l"><collision><origin xyz="0 0 0.5"/><geometry><box size="0.1 0.1 0.4"/></geometry></collision></link>
<joint name="j" type="%s"><parent link="base"/><child link="l"/><axis xyz="0 0 1"/><limit lower="-1" upper="%s"/></joint>%s</robot>'''
SRDF = '<robot name="m"><virtual_joint name="world_joint" type="planar" parent_frame="world" child_link="base"/></robot>'


def arm(a, b):
    return ('joint_trajectory:\n  joint_names: [j]\n  points:\n'
            f'    - {{positions: [{a}], time_from_start: {{secs: 0, nsecs: 0}}}}\n'
            f'    - {{positions: [{b}], time_from_start: {{secs: 2, nsecs: 0}}}}\n')


def ball(name, at):
    return (f'world: {{collision_objects: [{{id: {name}, primitives: [{{type: 2, dimensions: [0.1]}}], '
            f'primitive_poses: [{{position: [{at}]}}]}}]}}\n')


def drive(x):
    pose = '{translation: {x: %g, y: 0, z: 0}, rotation: {x: 0, y: 0, z: 0, w: 1}}'
    return ('multi_dof_joint_trajectory:\n  header: {frame_id: world}\n  joint_names: [world_joint]\n  points:\n'
            f'    - {{transforms: [{pose % 0}], time_from_start: {{secs: 0, nsecs: 0}}}}\n'
            f'    - {{transforms: [{pose % x}], time_from_start: {{secs: 2, nsecs: 0}}}}\n')


STATE = ('robot_state: {multi_dof_joint_state: {header: {frame_id: world}, joint_names: [world_joint], '
         'transforms: [{translation: {x: 3, y: 0, z: 0}, rotation: {x: 0, y: 0, z: 0, w: 1}}]}}\n')


class Files(Case):
    def collide(self, trajectory, scene, *more, srdf=SRDF, joint='revolute', upper='1', inside='', attributes='', query='collision'):
        words = ['--robot', self.file('m.urdf', ROBOT % (attributes, joint, upper, inside)),
                 '--trajectory', self.file('t.yaml', trajectory), '--scene', self.file('s.yaml', scene)]
        if srdf:
            words += ['--srdf', self.file('m.srdf', srdf)]
        return cprox(query, *words, *more)

    def a_base_that_drives_through_a_ball_violates(self):
        far = ball('far', '3, 0, 0')
        self.assertEqual(self.collide(arm(0, .5), far).row('t')['verdict'], 'clear')
        answer = self.collide(arm(0, .5) + drive(6), far)
        self.assertEqual((answer.code, answer.err, answer.row('t')['verdict']), (1, '', 'violated'))
        self.assertRefused(self.collide(arm(0, .5) + drive(6), far, srdf=None), 'world_joint', 'is the SRDF given?')

    def a_base_that_stands_beside_a_ball_violates(self):
        answer = self.collide(arm(0, .5), STATE + ball('b', '3.1, 0, 0.5'))
        self.assertEqual((answer.code, answer.err, answer.row('t')['verdict']), (1, '', 'violated'))
        self.assertRefused(self.collide(arm(0, .5), STATE + ball('b', '3.1, 0, 0.5'), srdf=None), 's.yaml', 'world_joint')

    def documents_and_keys_that_would_be_dropped_are_refused(self):
        far, near = ball('far', '3, 0, 0'), ball('near', '0.1, 0, 0.5')
        self.assertRefused(self.collide(arm(0, .5), far + '---\n' + near), 's.yaml: line 3: a second document', 'rostopic echo -n1')
        self.assertRefused(self.collide(arm(0, .5) + '---\n' + arm(0, .9), far), 't.yaml: line 7: a second document')
        self.assertRefused(self.collide(arm(0, .5), far + near), "line 2: the key 'world' stands twice: in line 1")
        self.assertRefused(self.collide(arm(0, .5), 'id: near\nprimitives: [{type: 2, dimensions: [0.1]}]\n'), 'world: collision_objects')
        self.assertEqual(self.collide(arm(0, .5) + '---\n', far + '---\n').err, '')

    def paths_and_bodies_hold_one_document(self):
        path = 'header: {frame_id: world}\nposes:\n- pose: {position: [0, 0, 0]}\n- pose: {position: [1, 0, 0]}\n'
        words = ['distance', '--scene', self.file('s.yaml', ball('far', '3, 0, 0')), '--path']
        self.assertRefused(cprox(*words, self.file('p.yaml', path + '---\n' + path)), 'p.yaml: line 6: a second document')
        body = 'id: b\nprimitives: [{type: 2, dimensions: [0.1]}]\n'
        self.assertRefused(cprox(*words, self.file('p.yaml', path), '--body', self.file('b.yaml', body + '---\n' + body)), 'b.yaml')

    def the_robots_own_fault_is_told(self):
        far = ball('far', '3, 0, 0')
        self.assertRefused(self.collide(arm(0, .5), far, inside='<xacro:hand parent="l"/>', attributes='xmlns:xacro="http://www.ros.org/wiki/xacro"'),
                           'm.urdf: line 3: <xacro:hand>: this is xacro: expand it first')
        self.assertRefused(self.collide(arm(0, .5), far, upper='none'), "joint 'j': limit upper='none' is not one finite number")
        self.assertRefused(self.collide(arm(0, .5), far, inside='<link name="other"/>'), 'Two root links found')

    def a_continuous_joint_goes_the_short_way_where_it_is_asked_to(self):
        robot = dict(joint='continuous', srdf=None, query='distance')
        answer = self.collide(arm(3.1, -3.1), ball('b', '0, 0, 3'), **robot)
        self.assertRegex(answer.err, "continuous joint 'j' turns by -6.2 rad from point 0 to point 1; the short way is 0.08319 rad")
        self.assertEqual(answer.err.count('\n'), 1)
        self.assertEqual(self.collide(arm(3.1, -3.1), ball('b', '0, 0, 3'), '--shortest-way', **robot).err, '')
        self.assertEqual(self.collide(arm(3.1, -3.1) + 'shortest_way: true\n', ball('b', '0, 0, 3'), **robot).err, '')
        self.assertRefused(cprox('distance', '--scene', self.file('s.yaml', ball('b', '0, 0, 3')), '--movers', '--shortest-way'),
                           '--shortest-way needs --trajectory')
        # a corner of the bar, sqrt(2) * 0.05 m from the axis, passes the ball only on the long way
        corner = ball('b', '0.2, 0, 0.5').replace('[0.1]', '[0.05]')
        long_way = self.collide(arm(3.1, -3.1), corner, **robot).row('t')
        self.assertAnswer(long_way, 0.2 - 0.05 - 0.05 * 2 ** .5, slack=1e-9)
        short_way = self.collide(arm(3.1, -3.1), corner, '--shortest-way', **robot).row('t')
        self.assertGreater(float(short_way['lower']), float(long_way['upper']) + 0.01)
