#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every way to name a mesh file."""
import os

import rospy
from helpers import Case, bezier, joints, refusal, run

DATA = os.path.dirname(os.path.abspath(__file__)) + '/../data'
LINE = bezier((-1, 0, 1), (1, 0, 1))
ROBOT = '''<robot name="one"><link name="base"/>
  <link name="finger"><collision><geometry><mesh filename="%s"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="finger"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
</robot>'''


class Limits(Case):
    def test_every_form_of_a_mesh_uri_is_the_same_mesh_and_http_is_none(self):
        folder = os.path.realpath(DATA + '/robots/panda')
        self.addCleanup(rospy.delete_param, '/robot_description')
        distances = []
        for uri in ('meshes/finger.stl', 'file://' + folder + '/meshes/finger.stl',
                    'package://curve_proximity/test/data/robots/panda/meshes/finger.stl'):
            rospy.set_param('/robot_description', ROBOT % uri)
            name = 'meshes%d' % len(distances)
            _, server = self.begin(name, urdf_dir=folder, fixed_frame='base')
            row, = server.distance(LINE, links=['finger'], joint_state=joints(slide=0.0)).results
            self.assertEqual(row.status, 'ok', row.message)
            distances.append((row.lower, row.upper))
        self.assertEqual(len(set(distances)), 1)
        self.assertLess(distances[0][1], 1.0)
        for uri, word in (('http://localhost/finger.stl', 'http'), ('meshes/none.stl', 'none.stl'), ('', "'finger'")):
            rospy.set_param('/robot_description', ROBOT % uri)
            self.assertIn(word, refusal(self, 'refused', urdf_dir=folder))
        rospy.set_param('/robot_description', ROBOT % 'meshes/finger.stl')
        self.assertIn('finger.stl', refusal(self, 'refused'))  # relative to nothing


if __name__ == '__main__':
    run('limits')
