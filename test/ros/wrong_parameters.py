#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Parameters that are wrong stop the node at start, by name. Every way to name a mesh file."""
import os
import tempfile

from helpers import ARM, LINE, Case, joints, run

PANDA = os.path.realpath(os.path.join(os.path.dirname(ARM), '../../data/robots/panda'))
ROBOT = '''<robot name="one"><link name="base"/>
  <link name="finger"><collision><geometry><mesh filename="%s"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="finger"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
</robot>'''


class WrongParameters(Case):
    def test_each_wrong_type_and_value_is_told_by_name(self):
        cases = [('epsilon', 'small'), ('epsilon', 0.0), ('epsilon', -1e-6), ('epsilon', float('nan')), ('tf_timeout', -1.0),
                 ('max_nodes', 0), ('max_nodes', 2.5), ('budget_ms', 0), ('threads', 0), ('threads', 1000),
                 ('memory_limit_mb', -1), ('memory_limit_mb', 5), ('max_curves', 0), ('max_control_points', 'many'),
                 ('max_results', 0), ('fixed_frame', ''), ('fixed_frame', 3), ('urdf_dir', 1),
                 ('allow_missing_geometry', 'yes'), ('robot_description', '<robot/>'),
                 ('robot_description', 'no_such_parameter'), ('query_type', 'guess'), ('query_type', 1), ('delta', -0.1),
                 ('delta', 'wide'), ('self_collision', 'yes'), ('path_radius', -1.0), ('path_body', 'crate'),
                 ('path_body', {'primitives': [{'type': 'sphere', 'dimensions': [1.0]}]}),
                 ('path_body', {'id': 'crate', 'primitives': [{'type': 'sphere', 'dimensions': [-1.0]}]}), ('queue_size', 0), ('queue_size', 2.5),
                 ('scene_file', 7), ('scene_file', '/no/such/scene.yaml'), ('scene_file', ARM)]
        for name, value in cases:
            with self.subTest(parameter=name, value=value):
                self.assertIn('~' + name, self.stopped(**{name: value}))

    def test_a_robot_with_unusable_geometry_is_refused_by_link_name(self):
        good = open(ARM).read()
        cases = [good.replace('<sphere radius="0.1"/>', '<sphere radius="nan"/>'),
                 good.replace('<sphere radius="0.1"/>', '<sphere radius="-1"/>'),
                 good.replace('<sphere radius="0.1"/>', '<torus radius="0.1" length="1"/>'),
                 good.replace('<sphere radius="0.1"/>', '<mesh filename="package://curve_proximity/none.stl"/>')]
        for urdf in cases:
            self.set_param('/robot_description', urdf)
            self.assertIn("link 'arm'", self.stopped())
        self.set_param('/robot_description', 'no robot')
        self.assertIn('robot_description', self.stopped())

    def test_allow_missing_geometry_insists(self):
        urdf = open(ARM).read().replace('<sphere radius="0.1"/>', '<sphere radius="-1"/>')
        self.set_param('/robot_description', urdf)
        node, server = self.begin('insisting', allow_missing_geometry=True)
        self.assertTrue(server.scene().success)
        self.assertIn('arm', node.output())

    def scene_in(self, frame):
        """The path of a scene file with a box in that frame."""
        with tempfile.NamedTemporaryFile('w', suffix='.yaml', delete=False) as scene:
            scene.write('world: {collision_objects: [{id: box, header: {frame_id: %s}, pose: {position: [1, 2, 3]}, '
                        'primitives: [{type: box, dimensions: [1, 1, 1]}]}]}' % frame)
        self.addCleanup(os.unlink, scene.name)
        return scene.name

    def test_a_scene_file_is_there_from_the_start(self):
        _, server = self.begin('furnished', scene_file=self.scene_in('world'))
        found, = server.scene().objects
        self.assertEqual((found.id, found.pose.position.y), ('box', 2.0))

    def test_a_scene_file_with_an_object_in_a_frame_that_nobody_knows_is_refused(self):
        output = self.stopped(scene_file=self.scene_in('nowhere'), tf_timeout=0.1)
        self.assertIn("'nowhere'", output)
        self.assertIn('~scene_file', output)

    def test_a_misspelt_name_is_warned_of(self):
        node, server = self.begin('misspelt', epsilom=1e-3)
        self.assertTrue(server.scene().success)
        self.assertIn('~epsilom', node.output())

    def test_every_form_of_a_mesh_uri_is_the_same_mesh_and_http_is_none(self):
        distances = []
        for uri in ('meshes/finger.stl', 'file://' + PANDA + '/meshes/finger.stl',
                    'package://curve_proximity/test/data/robots/panda/meshes/finger.stl'):
            self.set_param('/robot_description', ROBOT % uri)
            name = 'meshes%d' % len(distances)
            _, server = self.begin(name, urdf_dir=PANDA, fixed_frame='base')
            row, = server.distance(LINE, links=['finger'], joint_state=joints(slide=0.0)).results
            self.assertEqual(row.status, 'ok', row.message)
            distances.append((row.lower, row.upper))
        self.assertEqual(len(set(distances)), 1)
        self.assertLess(distances[0][1], 1.0)
        for uri, word in (('http://localhost/finger.stl', 'http'), ('meshes/none.stl', 'none.stl'), ('', "'finger'")):
            self.set_param('/robot_description', ROBOT % uri)
            self.assertIn(word, self.stopped(urdf_dir=PANDA))
        self.set_param('/robot_description', ROBOT % 'meshes/finger.stl')
        self.assertIn('finger.stl', self.stopped())  # relative to nothing


if __name__ == '__main__':
    run('wrong_parameters')
