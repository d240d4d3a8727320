# SPDX-License-Identifier: BSD-3-Clause
"""SCENE.yaml: every way to write a thing, and what is said of things that are wrong."""
import glob
import math
import os

from support import BOX_SCENE, DATA, PASSING, Case, bezier, cprox

# a point that stands still (almost) at the origin: its distance is that of the object to the origin
ORIGIN = bezier('o', (0, 0, 0), (1e-9, 0, 0))


# an octree with cells of 0.5 m, of which one is measured, and occupied: [0, 0.5]³. Sixteen levels lead to it: from the root
# the last of eight children, then always the first, two bits each: 11 has children, 10 (bit 1 alone) is occupied
BT_HEADER = b'# Octomap OcTree binary file\n# a comment\nid OcTree\nsize 17\nres 0.5\ndata\n'


def one_cell():
    return b'\x00\xc0' + b'\x03\x00' * 14 + b'\x02\x00'


def one(body):
    """A scene with one object; `body` is a flow map without its braces."""
    return 'world: {collision_objects: [{id: thing, ' + body + '}]}'


class Shapes(Case):
    def distance_to_origin(self, scene, *more):
        answer = self.ask('distance', [ORIGIN], scene, *more)
        self.assertEqual(answer.err, '')
        return answer.row('o')

    def primitives_are_known_by_name_and_by_number(self):
        # each stands at x = 10 with its axes along the world's
        for names, dimensions, distance in ((('box', 'BOX', 1), [2, 3, 4], 9), (('sphere', '"2"', 2), [1.5], 8.5),
                                            (('cylinder', 3), [4, 1], 9)):
            for name in names:
                with self.subTest(name=name):
                    row = self.distance_to_origin(one(f'primitives: [{{type: {name}, dimensions: {dimensions}}}], '
                                                      'primitive_poses: [{position: [10, 0, 0]}]'))
                    self.assertAnswer(row, distance, epsilon=1e-6 + 2e-9, slack=2e-9)

    def a_cone_points_upwards(self):
        # apex at z = 10 - 1, base at z = 10 + 1 after half a turn about x; upright the base disc is below
        for orientation, distance in (([0, 0, 0, 1], 9), ([1, 0, 0, 0], 9)):
            row = self.distance_to_origin(one('primitives: [{type: cone, dimensions: [2, 1]}], primitive_poses: '
                                              f'[{{position: [0, 0, 10], orientation: {orientation}}}]'))
            self.assertAnswer(row, distance, slack=2e-9)
        # seen from the side, the upright cone's slope is nearest to a point beside its upper half
        near = bezier('n', (1, 0, 1), (1, 1e-9, 1))
        row = self.ask('distance', [near], one('primitives: [{type: 4, dimensions: [2, 1]}]')).row('n')
        self.assertAnswer(row, abs(2 * 1 + 1 - 1) / math.sqrt(5), slack=2e-9)  # the line 2x + z = 1 in the plane y = 0

    def planes_are_halfspaces(self):
        self.assertAnswer(self.distance_to_origin(one('planes: [{coef: [0, 0, 2, 6]}]')), 3, slack=2e-9)
        self.assertAnswer(self.distance_to_origin(one('planes: [{coef: [0, 0, 2, 6]}], plane_poses: [{position: [0, 0, -1]}]')), 4, slack=2e-9)
        self.assertAnswer(self.distance_to_origin(one('planes: [{coef: [0, 0, 1, -1]}]')), 0, slack=2e-9)

    def meshes_are_given_by_vertices_or_by_a_file_beside_the_scene(self):
        tetrahedron = [(3, 0, 0), (5, 1, -1), (5, -1, -1), (5, 0, 1)]
        faces = [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)]
        as_lists = f'meshes: [{{vertices: {[list(v) for v in tetrahedron]}, triangles: {[list(f) for f in faces]}}}]'
        as_maps = ('meshes: [{vertices: [' + ', '.join('{x: %g, y: %g, z: %g}' % v for v in tetrahedron) + '], triangles: ['
                   + ', '.join(f'{{vertex_indices: {list(f)}}}' for f in faces) + ']}]')
        os.makedirs(self.folder + '/meshes', exist_ok=True)
        self.file('meshes/t.stl', 'solid t\n' + ''.join(
            'facet normal 0 0 0\nouter loop\n' + ''.join('vertex %g %g %g\n' % tetrahedron[i] for i in face) + 'endloop\nendfacet\n'
            for face in faces) + 'endsolid t\n')
        for text in (as_lists, as_maps, 'meshes: [{resource: meshes/t.stl}]',
                     f'meshes: [{{resource: "file://{self.folder}/meshes/t.stl"}}]', f'meshes: [{{resource: {self.folder}/meshes/t.stl}}]'):
            with self.subTest(text=text[:50]):
                row = self.distance_to_origin(one(text))
                self.assertAnswer(row, 3, slack=1e-6)  # the hull of a mesh file is read in single precision
                self.assertEqual(row['lod'], 'mesh')
        row = self.distance_to_origin(one('meshes: [{resource: meshes/t.stl, dimensions: [2, 1, 1]}]'))
        self.assertAnswer(row, 6, slack=1e-6)

    def meshes_are_found_in_packages(self):
        os.makedirs(self.folder + '/src/group/things/meshes')
        self.file('src/group/things/package.xml', '<package format="2">\n <name> things </name></package>')
        self.file('src/group/things/meshes/t.stl', 'solid t\nfacet normal 0 0 0\nouter loop\nvertex 3 0 0\nvertex 5 1 0\nvertex 5 0 1\n'
                  'endloop\nendfacet\nendsolid t\n')
        scene = one('meshes: [{resource: "package://things/meshes/t.stl"}]')
        row = self.ask_with_packages(scene).row('o')
        self.assertAnswer(row, 3, slack=1e-6)
        self.assertRefused(self.ask('distance', [ORIGIN], scene), 'thing', 'things')

    def package_names_a_folder_without_a_package_xml(self):
        os.makedirs(self.folder + '/here/meshes')
        self.file('here/meshes/t.stl', 'solid t\nfacet normal 0 0 0\nouter loop\nvertex 3 0 0\nvertex 5 1 0\nvertex 5 0 1\nendloop\nendfacet\nendsolid t\n')
        scene = one('meshes: [{resource: "package://things/meshes/t.stl"}]')
        answer = self.ask('distance', [ORIGIN], scene, '--package', f'others={self.folder}, things={self.folder}/here')
        self.assertAnswer(answer.row('o'), 3, slack=1e-6)
        for words in (f'others={self.folder}', f'things={self.folder}/gone', 'things', '=here', f'things={self.folder}, things={self.folder}'):
            with self.subTest(words=words):
                self.assertEqual(self.ask('distance', [ORIGIN], scene, '--package', words).code, 2)

    def ask_with_packages(self, scene):
        return cprox('distance', '--curves', self.file('curves.csv', ORIGIN), '--scene', self.file('scene.yaml', scene),
                     env={'ROS_PACKAGE_PATH': '/nowhere:' + self.folder + '/src'})

    def bodies_are_what_moveit_lacks(self):
        for body, distance in (('{type: capsule, dimensions: [4, 1]}', 9), ('{type: ellipsoid, dimensions: [2, 3, 4]}', 8),
                               ('{type: polytope, vertices: [[-1, 0, 0], [1, 1, 0], [1, -1, 0], [1, 0, 1]]}', 9),
                               ('{type: point}', 10), ('{type: point, vertices: [[-3, 0, 0]]}', 7),
                               ('{type: halfspace, dimensions: [-1, 0, 0, 0]}', 10),
                               ('{type: sphere, dimensions: [1], pose: {position: [1, 0, 0]}}', 10)):
            with self.subTest(body=body):
                row = self.distance_to_origin(one(f'bodies: [{body}], body_poses: [{{position: [10, 0, 0]}}]'))
                self.assertAnswer(row, distance, epsilon=1e-6 + 2e-9, slack=2e-9)

    def ground_and_grids_of_distances_are_bodies(self):
        ground = ('bodies: [{type: height_field, dimensions: [1, 1, 3, 2], values: [-3, -2, -3, -3, -2, -3]}], '
                  'body_poses: [{position: [-1, -0.5, 0]}]')
        self.assertAnswer(self.distance_to_origin(one(ground)), 2, slack=2e-9)
        # by triangles, the slopes are the planes z = -2 - |x|; with a floor, the origin is inside
        below = ground.replace('[1, 1, 3, 2]', '[1, 1, 3, 2, -4]').replace('-0.5, 0]', '-0.5, 2.5]')
        self.assertAnswer(self.distance_to_origin(one(below)), 0, slack=2e-9)
        values = [math.sqrt(x * x + y * y + z * z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        grid = 'bodies: [{type: distance_grid, dimensions: [1, 2, 2, 2], values: %s}], body_poses: [{position: [3, 0, 0]}]'
        answer = self.ask('distance', [ORIGIN], one(grid % values), '--epsilon', '0.1')
        row = answer.row('o')
        self.assertLessEqual(float(row['lower']), 3)  # from outside the grid, whose first point is the set
        self.assertGreaterEqual(float(row['upper']), 3 - 2e-9)  # the curve ends there

    def grids_that_are_wrong_are_told(self):
        for body, words in (('type: height_field, dimensions: [1, 1, 2, 2], values: [0, 0, 0]', '3 values, but 4 points'),
                            ('type: height_field, dimensions: [1, 1, 2.5, 2], values: [0]', 'whole number'),
                            ('type: height_field, dimensions: [1, 1, 2], values: [0]', 'got 3'),
                            ('type: height_field, dimensions: [1, -1, 2, 2], values: [0, 0, 0, 0]', 'cell is -1'),
                            ('type: height_field, dimensions: [1, 1, 2, 2, 0], values: [0, 0, 0, 0]', 'above the floor'),
                            ('type: distance_grid, dimensions: [1, 2, 2, 2], values: [0, 0, 0, 0, 0, 0, 0, 3]', 'neighbour'),
                            ('type: box, dimensions: [1, 2, 2], values: [0]', 'values')):
            with self.subTest(body=body):
                answer = self.ask('distance', [ORIGIN], one('bodies: [{%s}]' % body))
                self.assertIn(words, answer.err)

    def padding_enlarges_an_object(self):
        row = self.distance_to_origin(one('padding: 0.5, primitives: [{type: box, dimensions: [2, 2, 2]}], '
                                          'primitive_poses: [{position: [10, 0, 0]}]'))
        self.assertAnswer(row, 8.5, slack=2e-9)
        self.assertPoint(row, 'b', (8.5, 0, 0))

    def point_clouds_and_octree_files_are_bodies(self):
        cloud = 'bodies: [{type: points, dimensions: [0.25], vertices: [[1, 0, 0], {x: -4, y: 1, z: 0}]}]'
        self.assertAnswer(self.distance_to_origin(one(cloud)), 0.75, slack=2e-9)
        bare = cloud.replace('dimensions: [0.25], ', '')
        self.assertAnswer(self.distance_to_origin(one(bare)), 1, slack=2e-9)
        octree = one('pose: {position: [3, 0, 0]}, bodies: [{type: octree, resource: map.bt}]')
        self.file('map.bt', BT_HEADER + one_cell())
        self.assertAnswer(self.distance_to_origin(octree), 3, slack=2e-9)
        self.file('map.bt', BT_HEADER + one_cell()[:-3])
        self.assertRefused(self.ask('distance', [ORIGIN], octree), "'thing'", 'map.bt', 'cut short')
        self.file('map.bt', b'octomap' + BT_HEADER)
        self.assertRefused(self.ask('distance', [ORIGIN], octree), 'map.bt', 'no octomap header')


class MoveitText(Case):
    """*.scene: what MoveIt's planning panel writes."""
    SHAPES = {'box': '2 3 4', 'sphere': '1.5', 'cylinder': '0.5 4', 'cone': '0.5 4', 'plane': '1 0 0 2',
              'mesh': '4 4\n3 0 0\n5 1 -1\n5 -1 -1\n5 0 1\n0 1 2\n0 1 3\n0 2 3\n1 2 3'}
    IN_YAML = {'box': 'primitives: [{type: box, dimensions: [2, 3, 4]}], primitive_poses: [%s]',
               'sphere': 'primitives: [{type: sphere, dimensions: [1.5]}], primitive_poses: [%s]',
               'cylinder': 'primitives: [{type: cylinder, dimensions: [4, 0.5]}], primitive_poses: [%s]',
               'cone': 'primitives: [{type: cone, dimensions: [4, 0.5]}], primitive_poses: [%s]',
               'plane': 'planes: [{coef: [1, 0, 0, 2]}], plane_poses: [%s]',
               'mesh': 'meshes: [{vertices: [[3, 0, 0], [5, 1, -1], [5, -1, -1], [5, 0, 1]], '
                       'triangles: [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]}], mesh_poses: [%s]'}
    TURN = '0.18257418583505536 0.3651483716701107 0.5477225575051661 0.7302967433402214'

    def ask_text(self, text):
        return cprox('distance', '--curves', self.file('curves.csv', ORIGIN + '\n'), '--scene', self.file('world.scene', text))

    def every_shape_is_where_the_same_scene_in_yaml_puts_it(self):
        pose = '{position: [7, 1, -2], orientation: [%s]}' % self.TURN.replace(' ', ', ')
        for kind, sizes in self.SHAPES.items():
            shape = f'{kind}\n{sizes}\n7 1 -2\n{self.TURN}\n0 0 0 0\n'
            new = f'a name\n* the thing\n0.5 0 0\n0 0 0 1\n1\n{shape}1\na tip\n1 2 3\n0 0 0 1\n.\n'
            old = f'(noname)\n* the thing\n1\n{shape}.\n'
            for text, place in ((new, 'pose: {position: [0.5, 0, 0]}, '), (old, ''), (old.replace('\n', '\r\n'), '')):
                with self.subTest(kind=kind, old=not place):
                    expected = self.ask('distance', [ORIGIN], one(place + self.IN_YAML[kind] % pose).replace('thing', 'the thing'))
                    self.assertEqual((expected.code, expected.err), (0, ''))
                    answer = self.ask_text(text)
                    self.assertEqual((answer.code, answer.err), (0, ''))
                    self.assertEqual(answer.without_times(), expected.without_times())

    def what_is_wrong_is_said_with_its_line(self):
        box = 'box\n1 1 1\n0 0 0\n0 0 0 1\n0 0 0 0\n'
        for text, *words in (('', 'line 1', 'empty'), ('name\n', 'line 2', "without the line '.'"),
                             (f'name\n* a\n1\n{box}', 'line 9', "without the line '.'"),
                             (f'name\n* a\n1\n{box}1\n.\n', 'line 9', "'1' is neither"),
                             (f'name\n* a\n1\n{box}.\n* b\n', 'line 10', 'after the end'),
                             (f'name\n* a\n2\n{box}.\n', 'line 9', "the shape '.'"),
                             (f'name\n* a\n-1\n{box}.\n', 'line 3', "'-1' is not the number of shapes of 'a'"),
                             ('name\n* a\n1\nbox\n1 1 nan\n', 'line 5', "'nan'"),
                             ('name\n* a\n1\nbox\n1 1', 'line 5', 'the file ends before the sizes of a box'),
                             ('name\n* a\n1\noctree\n', 'line 4', "'octree'"),
                             ('name\n* a\n0\n.\n', "'a'", 'no shape'), (f'name\n*\n1\n{box}.\n', 'no id'),
                             (f'name\n* a\n1\n{box.replace("0 0 0 1", "0 0 0 0")}.\n', "'a'", 'norm is 0'),
                             ('name\n* a\n1\nmesh\n3 1\n0 0 0\n1 0 0\n0 1 0\n0 1 3\n0 0 0\n0 0 0 1\n0 0 0 0\n.\n', "'a'")):
            with self.subTest(text=text):
                self.assertRefused(self.ask_text(text), 'world.scene', *words)


class Poses(Case):
    def lists_and_maps_mean_the_same(self):
        c, s = math.cos(math.pi / 8), math.sin(math.pi / 8)
        texts = (f'{{position: [10, 0, 0], orientation: [0, 0, {s!r}, {c!r}]}}',
                 f'{{position: {{x: 10, y: 0, z: 0}}, orientation: {{w: {c!r}, x: 0, y: 0, z: {s!r}}}}}')
        for text in texts:
            answer = self.ask('distance', [ORIGIN], one('primitives: [{type: box, dimensions: [2, 2, 2]}], '
                                                        f'primitive_poses: [{text}]'))
            self.assertAnswer(answer.row('o'), 10 - math.sqrt(2), slack=2e-9)  # an edge looks towards the origin

    def an_objects_pose_comes_before_that_of_its_shapes(self):
        # turned by 90 degrees about z, the shape at x = 3 of the object stands at y = 3, beyond the object's x = 10
        quarter = [0, 0, math.sqrt(0.5), math.sqrt(0.5)]
        scene = one(f'pose: {{position: [10, 0, 0], orientation: {quarter}}}, primitives: [{{type: 2, dimensions: [1]}}], '
                    'primitive_poses: [{position: [3, 0, 0]}]')
        row = self.ask('distance', [ORIGIN], scene).row('o')
        self.assertAnswer(row, math.hypot(10, 3) - 1, slack=2e-9)

    def a_quaternion_is_normalised_with_a_warning_if_it_is_far_from_a_unit(self):
        for q, warned in (([0, 0, 0, 2], True), ([0, 0, 0, 1.0005], False), ([0, 0, 0.3826834, 0.9238795], False),
                          ([0, 0, 0, 1e-200], True), ([0, 0, 0, 1e200], True)):
            scene = one(f'primitives: [{{type: 2, dimensions: [1]}}], primitive_poses: [{{position: [3, 0, 0], orientation: {q}}}]')
            answer = self.ask('distance', [ORIGIN], scene)
            self.assertAnswer(answer.row('o'), 2, slack=2e-9)
            self.assertEqual('norm' in answer.err, warned, answer.err)
            self.assertEqual(answer.code, 0)

    def a_quaternion_of_norm_0_is_an_error(self):
        for place in ('pose: {orientation: [0, 0, 0, 0]}, primitives: [{type: 2, dimensions: [1]}]',
                      'primitives: [{type: 2, dimensions: [1]}], primitive_poses: [{orientation: {x: 0, y: 0, z: 0, w: 0}}]'):
            self.assertRefused(self.ask('distance', [ORIGIN], one(place)), "'thing'", 'norm is 0', 'scene.yaml', 'line 1')


class Frames(Case):
    def frame(self, frame, more='', curve=ORIGIN):
        """The distance from the origin to a unit sphere at x = 10 of the frame."""
        scene = (f'world: {{collision_objects: [{{id: thing, header: {{frame_id: "{frame}"}}, primitives: [{{type: 2, dimensions: [1]}}], '
                 'primitive_poses: [{position: [10, 0, 0]}]}]}\n' + more)
        return self.ask('distance', [curve], scene)

    def the_fixed_frame_has_no_name_or_is_the_world(self):
        for name in ('', 'world', '/world'):
            self.assertAnswer(self.frame(name).row('o'), 9, slack=2e-9)

    def transforms_lead_from_frame_to_frame(self):
        half_turn = [0, 0, 1, 0]
        more = (f'fixed_frame_transforms:\n- child_frame_id: camera\n  header: {{frame_id: mast}}\n  transform: {{translation: [2, 0, 0], rotation: {half_turn}}}\n'
                '- child_frame_id: mast\n  transform: {translation: {x: 1, y: 0, z: 0}, rotation: {x: 0, y: 0, z: 0, w: 1}}\n')
        self.assertAnswer(self.frame('mast', more).row('o'), 10, slack=2e-9)
        self.assertAnswer(self.frame('camera', more).row('o'), 6, slack=2e-9)  # 1 + 2 - 10 = -7
        self.assertAnswer(self.frame('/camera', more).row('o'), 6, slack=2e-9)

    def an_unknown_frame_is_an_error_that_names_it(self):
        self.assertRefused(self.frame('camera'), "'thing'", "'camera'")
        more = 'fixed_frame_transforms: [{child_frame_id: camera, header: {frame_id: mast}, transform: {translation: [0, 0, 0]}}]'
        self.assertRefused(self.frame('camera', more), "'camera'", "'mast'")

    def a_ring_of_frames_is_an_error(self):
        more = ('fixed_frame_transforms: [{child_frame_id: a, header: {frame_id: b}, transform: {}}, '
                '{child_frame_id: b, header: {frame_id: a}, transform: {}}]')
        self.assertRefused(self.frame('a', more), "'a'", 'ring')

    def the_fixed_frame_itself_stays(self):
        more = 'fixed_frame_transforms: [{child_frame_id: world, transform: {translation: [5, 0, 0]}}]'
        answer = self.frame('world', more)
        self.assertEqual((answer.code, answer.row('o')['status'], answer.row('o')['lower']), (3, 'partial', '0'))
        self.assertAlmostEqual(float(answer.row('o')['upper']), 9, delta=2e-6)
        self.assertIn('warning', answer.err)


class Files(Case):
    def every_scene_of_the_data_is_read(self):
        scenes = sorted(glob.glob(DATA + '/scenes/mbm/*/scene*.yaml') + glob.glob(DATA + '/scenes/converted/*.yaml')
                        + glob.glob(DATA + '/scenes/robowflex_box/scene*.yaml'))
        self.assertEqual(len(scenes), 32)
        curves = self.file('curves.csv', bezier('c', (0.2, -1, 0.3), (1, 1, 0.5), (0.5, 1, 0.7)))
        for scene in scenes:
            with self.subTest(scene=scene):
                answer = cprox('distance', '--curves', curves, '--scene', scene)
                self.assertEqual(answer.code, 0, answer.err)
                self.assertEqual(answer.err, '')
                self.assertEqual(answer.row('c')['status'], 'ok')
                self.assertLess(float(answer.row('c')['upper']), 2)

    def a_scene_in_the_frame_of_a_robot_needs_that_robot(self):
        scene = DATA + '/scenes/robowflex_table/scene.yaml'
        curves = self.file('curves.csv', bezier('c', (0.2, -1, 0.3), (1, 1, 0.5), (0.5, 1, 0.7)))
        self.assertRefused(cprox('distance', '--curves', curves, '--scene', scene), "'base_link'")
        answer = cprox('distance', '--curves', curves, '--scene', scene, '--robot', DATA + '/robots/husky/husky.urdf')
        self.assertEqual((answer.code, answer.err, answer.row('c')['status']), (0, '', 'ok'))

    def an_octomap_takes_part_under_the_name_that_moveit_gives_it(self):
        # one cell of 0.5 m at the origin's corner, moved by its origin to x = 2 … 2.5: nearer to x = 3 than the box
        cells = ', '.join(str(byte if byte < 128 else byte - 256) for byte in one_cell())
        octomap = '{binary: true, id: OcTree, resolution: 0.5, data: [%s]}'
        scene = BOX_SCENE + '  octomap: {header: {frame_id: world}, origin: {position: [2, 0, 0]}, octomap: ' + octomap % cells + '}\n'
        row = self.ask('distance', [PASSING], scene).row('passing')
        self.assertAnswer(row, 0.5)
        self.assertEqual(row['b'], '<octomap>')
        short = BOX_SCENE + '  octomap: {octomap: ' + octomap % '3, 0' + '}\n'
        self.assertRefused(self.ask('distance', [PASSING], short), '<octomap>', 'cut short')
        empty = BOX_SCENE + '  octomap: {octomap: {data: []}}\n'
        self.assertEqual(self.ask('distance', [PASSING], empty).err, '')

    def unknown_keys_are_told_once_each_and_make_answers_partial(self):
        objects = ', '.join(f'{{id: s{i}, colour: red, primitives: [{{type: 2, dimensions: [1]}}], primitive_poses: '
                            f'[{{position: [{i}, 0, 0], note: x}}]}}' for i in range(5))
        answer = self.ask('distance', [PASSING], f'world: {{collision_objects: [{objects}]}}\nmood: good\n')
        self.assertEqual((answer.code, answer.rows[0]['status'], answer.rows[0]['lower']), (3, 'partial', '0'))
        for key in ('colour', 'mood', 'note'):
            self.assertEqual(answer.err.count(key), 1, answer.err)
        self.assertEqual(answer.err.count('\n'), 3)

    def keys_that_curves_have_no_use_for_are_ignored_without_a_word(self):
        more = ('name: a\nrobot_model_name: r\nis_diff: false\nobject_colors: []\n'
                'allowed_collision_matrix: {entry_names: [a, b], entry_values: [[false, true], [true, false]]}\n'
                'link_padding: [{link_name: a, padding: 0.1}]\nlink_scale: [{link_name: a, scale: 1}]\n')
        self.assertEqual(self.ask('distance', [PASSING], BOX_SCENE + more).err, '')

    def later_objects_replace_those_of_the_same_id(self):
        scene = ('world: {collision_objects: [{id: s, primitives: [{type: 2, dimensions: [1]}]}, '
                 '{id: s, primitives: [{type: 2, dimensions: [2]}]}]}')
        answer = self.ask('distance', [PASSING], scene)
        self.assertEqual((answer.code, answer.row('passing')['status']), (3, 'partial'))
        self.assertAlmostEqual(float(answer.row('passing')['upper']), 1.0, delta=2e-6)
        self.assertRegex(answer.err, "warning: .*'s' comes twice")

    def operations_are_carried_out_in_order(self):
        sphere = 'primitives: [{type: 2, dimensions: [1]}]'
        scene = (f'world: {{collision_objects: [{{id: s, {sphere}}}, {{id: t, {sphere}}}, '
                 f'{{id: s, operation: append, primitives: [{{type: 2, dimensions: [1]}}], primitive_poses: [{{position: [1.5, 0, 0]}}]}}, '
                 '{id: t, operation: 3, pose: {position: [3, 0, 10]}}, {id: s, operation: 1}]}')
        answer = self.ask('distance', [PASSING], scene)
        self.assertAnswer(answer.row('passing'), 9.0)
        self.assertEqual(answer.row('passing')['b'], 't')
        self.assertEqual(answer.err, '')

    def what_would_leave_an_object_out_is_an_error_in_one_line(self):
        bad = {
            'world: [': ['line'],
            'world: {collision_objects: 5}': ['world.collision_objects', 'list'],
            'world: {collision_objects: [5]}': ['world.collision_objects[0]', 'map'],
            '- a': ['map'],
            '': ['empty'],
            '# nothing': ['empty'],
            'world: {collision_objects: [{primitives: [{type: 2, dimensions: [1]}]}]}': ['no id'],
            one('header: {}'): ["'thing'", 'no shape'],
            one('primitives: [{type: blob, dimensions: [1]}]'): ["'thing'", 'primitives[0]', "'blob'", 'box (1)'],
            one('primitives: [{type: 7, dimensions: [1]}]'): ["'7'"],
            one('primitives: [{dimensions: [1]}]'): ["'type'"],
            one('primitives: [{type: 2}]'): ["'dimensions'"],
            one('primitives: [{type: 2, dimensions: [1, 2]}]'): ["'thing'", 'sphere'],
            one('primitives: [{type: 2, dimensions: [0]}]'): ["'thing'", 'sphere'],
            one('primitives: [{type: 2, dimensions: [-1]}]'): ["'thing'"],
            one('primitives: [{type: 2, dimensions: [.nan]}]'): ['dimensions[0]', '.nan'],
            one('primitives: [{type: 2, dimensions: [.inf]}]'): ['dimensions[0]', '.inf'],
            one('primitives: [{type: 1, dimensions: [1, 1]}]'): ["'thing'", 'box'],
            one('primitives: [{type: 2, dimensions: [1]}], primitive_poses: [{}, {}]'): ['1 primitives', '2 primitive_poses'],
            one('primitives: [{type: 2, dimensions: [1]}], primitive_poses: [{position: [1, 2]}]'): ['[x, y, z]'],
            one('primitives: [{type: 2, dimensions: [1]}], primitive_poses: [{position: {x: 1, y: 2}}]'): ["'z'"],
            one('primitives: [{type: 2, dimensions: [1]}], primitive_poses: [{orientation: [0, 0, 1]}]'): ['[x, y, z, w]'],
            one('primitives: [{type: 2, dimensions: [1]}], padding: -0.1'): ["'thing'", 'padding'],
            one('primitives: [{type: 2, dimensions: [1]}], operation: 9'): ["'9'", 'add (0)'],
            one('planes: [{coef: [0, 0, 0, 1]}]'): ["'thing'"],
            one('planes: [{coef: [0, 0, 1]}]'): ["'thing'"],
            one('meshes: [{}]'): ["'thing'", 'vertices'],
            one('meshes: [{resource: none.stl}]'): ["'thing'", 'none.stl'],
            one('meshes: [{resource: "package://no_such_package/a.stl"}]'): ['no_such_package'],
            one('meshes: [{resource: "http://localhost/a.stl"}]'): ['http'],
            one('meshes: [{vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 3]]}]'): ["'thing'"],
            one('meshes: [{vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1]]}]'): ['three'],
            one('bodies: [{type: superquadric, dimensions: [1, 1, 1, 4, 4, 0]}]'): ["'thing'", 'superquadric'],
            one('bodies: [{type: implicit}]'): ["'thing'", 'no terms'],
            one('bodies: [{type: ball, dimensions: [1]}]'): ["'ball' is unknown"],
            one('bodies: [{type: polytope}]'): ["'thing'", 'vertices'],
            BOX_SCENE + 'robot_state: {joint_state: {name: [a, b], position: [1]}}': ['2 names', '1 positions'],
            BOX_SCENE + 'link_padding: [{link_name: a, padding: -1}]': ['padding'],
            BOX_SCENE + 'allowed_collision_matrix: {entry_names: [a], entry_values: []}': ['entry_names'],
        }
        for scene, words in bad.items():
            with self.subTest(scene=scene[-80:]):
                self.assertRefused(self.ask('distance', [PASSING], scene), 'scene.yaml', *words)

    def an_empty_mesh_file_is_an_error(self):
        self.file('empty.stl', '')
        self.assertRefused(self.ask('distance', [PASSING], one('meshes: [{resource: empty.stl}]')), 'empty.stl')

    def yaml_that_is_deep_or_noisy_is_refused(self):
        for text in ('[' * 100000, '{a: ' * 20000, '\x00\x01\x02', '&a [*a]', '!!binary x: ]'):
            answer = self.ask('distance', [PASSING], text)
            self.assertRefused(answer, 'scene.yaml')
