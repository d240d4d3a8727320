# SPDX-License-Identifier: BSD-3-Clause
"""send: a scene file to a running node, and back by ~get_scene. Needs the sourced workspace (rosservice, the messages)."""
import os
import subprocess
import time

import yaml

from support import BOX_SCENE, DATA, Case, cprox, free_port


class Send(Case):
    @classmethod
    def setUpClass(cls):
        """A master and a node of our own."""
        cls.ros = {'ROS_MASTER_URI': f'http://localhost:{free_port()}', 'ROS_HOSTNAME': 'localhost'}
        cls.processes = []
        cls.spawn('roscore', '-p', cls.ros['ROS_MASTER_URI'].rsplit(':', 1)[1])
        cls.wait_for('rosnode', 'list')
        cls.spawn(os.environ['CPROX_NODE'], '__name:=curve_proximity')
        cls.wait_for('rosservice', 'type', '/curve_proximity/apply_scene')

    def setUp(self):
        """Every case begins with an empty scene."""
        super().setUp()
        self.assertTrue(self.call('apply_scene', '{objects: [{operation: 1}]}')['success'])

    @classmethod
    def tearDownClass(cls):
        for process in reversed(cls.processes):
            process.terminate()
            process.wait(20)

    @classmethod
    def spawn(cls, *words):
        cls.processes.append(subprocess.Popen(words, env=dict(os.environ, **cls.ros), stdin=subprocess.DEVNULL,
                                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))

    @classmethod
    def wait_for(cls, *words):
        end = time.monotonic() + 30
        while subprocess.run(words, env=dict(os.environ, **cls.ros), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode:
            if time.monotonic() > end:
                cls.tearDownClass()
                raise AssertionError(f'{words} did not succeed within 30 s')
            time.sleep(0.2)

    def call(self, service, request):
        done = subprocess.run(['rosservice', 'call', '/curve_proximity/' + service, request], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env=dict(os.environ, **self.ros), timeout=60)
        self.assertEqual(done.returncode, 0, done.stdout)
        return yaml.safe_load(done.stdout)

    def send(self, scene, *more):
        return cprox('send', self.file('scene.yaml', scene), *more, env=self.ros)

    def objects_arrive_as_the_file_has_them(self):
        self.file('t.stl', 'solid t\nfacet normal 0 0 0\nouter loop\nvertex 3 0 0\nvertex 5 1 0\nvertex 5 0 1\nendloop\nendfacet\nendsolid t\n')
        scene = BOX_SCENE + '''
    - id: mounted
      header: {frame_id: mast}
      padding: 0.1
      bodies: [{type: capsule, dimensions: [2, 0.5]}]
      body_poses: [{position: [0, 0, 1]}]
    - id: mesh
      header: {frame_id: world}
      meshes: [{resource: t.stl}]
fixed_frame_transforms:
  - {child_frame_id: mast, transform: {translation: [5, 0, 0], rotation: [0, 0, 0, 1]}}
'''
        answer = self.send(scene)
        self.assertEqual((answer.code, answer.out), (0, ''), answer.err)
        objects = {entry['id']: entry for entry in self.call('get_scene', '{}')['objects']}
        self.assertEqual(set(objects), {'box', 'mounted', 'mesh'})
        self.assertEqual(objects['box']['primitives'][0]['dimensions'], [2, 2, 2])
        self.assertEqual(objects['mounted']['pose']['position'], {'x': 5, 'y': 0, 'z': 0})
        self.assertEqual(objects['mounted']['body_poses'][0]['position'], {'x': 0, 'y': 0, 'z': 1})
        self.assertEqual(objects['mounted']['padding'], 0.1)

    def a_scene_of_the_data_arrives(self):
        answer = cprox('send', DATA + '/scenes/mbm/bookshelf_small_panda/scene0001.yaml', env=self.ros)
        self.assertEqual(answer.code, 0, answer.err)
        self.assertEqual(len(self.call('get_scene', '{}')['objects']), 7)

    def a_file_takes_the_place_of_the_scene_unless_it_is_a_diff(self):
        other = BOX_SCENE.replace('box', 'other', 1)
        for scene, more, expected in ((BOX_SCENE, (), {'box'}), (BOX_SCENE, (), {'box'}), (other, (), {'other'}),
                                      (BOX_SCENE, ('--add',), {'box', 'other'}), ('is_diff: true\n' + other, (), {'box', 'other'}),
                                      ('is_diff: true\n' + other, ('--replace',), {'other'})):
            answer = self.send(scene, *more)
            self.assertEqual(answer.code, 0, answer.err)
            self.assertEqual({entry['id'] for entry in self.call('get_scene', '{}')['objects']}, expected)

    def a_node_under_another_name_is_not_found(self):
        answer = self.send(BOX_SCENE, '--node', '/elsewhere')
        self.assertRefused(answer, '/elsewhere/apply_scene')

    def without_a_master_it_says_so_at_once(self):
        begin = time.monotonic()
        answer = cprox('send', self.file('scene.yaml', BOX_SCENE), env={'ROS_MASTER_URI': f'http://localhost:{free_port()}'})
        self.assertRefused(answer, 'master')
        self.assertLess(time.monotonic() - begin, 5)

    def the_nodes_reason_is_passed_on(self):
        answer = self.send('world: {collision_objects: [{id: s, primitives: [{type: 2, dimensions: [-1]}]}]}')
        self.assertRefused(answer, "'s'", 'sphere')
        answer = self.send('world: {collision_objects: [{id: s, header: {frame_id: nowhere}, primitives: [{type: 2, dimensions: [1]}]}]}')
        self.assertRefused(answer, "'s'", 'nowhere')

    def a_file_that_cannot_be_used_needs_no_node(self):
        self.assertRefused(self.send('world: 5'), 'scene.yaml')
