# SPDX-License-Identifier: BSD-3-Clause
"""Files of other programs: clouds (PCD, PLY, XYZ), paths (TUM, EuRoC, PoseArray), Barr's superquadrics, robots that are no URDF."""
import os
import random
import re
import struct

from support import PASSING, Case, cprox

SCENE = 'world: {{collision_objects: [{{id: it, bodies: [{{type: {}}}]}}]}}\n'


def same(row):
    return {name: field for name, field in row.items() if name not in ('microseconds', 'id')}


class Clouds(Case):
    def setUp(self):
        super().setUp()
        self.random = random.Random(3)
        # floats of 32 bits, so that all files hold the same numbers
        self.points = [struct.unpack('<3f', struct.pack('<3f', *(self.random.uniform(-1, 1) for _ in range(3)))) for _ in range(50)]

    def files(self):
        n, text = len(self.points), ''.join('%.17g %.17g %.17g\n' % point for point in self.points)
        colours = ''.join('%d %.17g %.17g %.17g\n' % (i % 256, *point) for i, point in enumerate(self.points))
        pcd = f'# .PCD v0.7\nVERSION 0.7\nFIELDS {{}}\nSIZE {{}}\nTYPE {{}}\nCOUNT {{}}\nWIDTH {n}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {n}\nDATA '
        ply = f'ply\nformat {{}} 1.0\ncomment made by hand\nelement vertex {n}\nproperty uchar red\nproperty {{}} x\nproperty {{}} y\nproperty {{}} z\nend_header\n'
        yield 'ascii.pcd', (pcd.format('x y z', '4 4 4', 'F F F', '1 1 1') + 'ascii\n' + text).encode()
        yield 'binary.pcd', (pcd.format('rgb normal x y z', '4 4 4 4 4', 'U F F F F', '1 3 1 1 1') + 'binary\n').encode() + b''.join(
            struct.pack('<I3f3f', 7, 1, 2, 3, *point) for point in self.points)
        yield 'doubles.pcd', (pcd.format('x y z', '8 8 8', 'F F F', '1 1 1') + 'binary\n').encode() + b''.join(struct.pack('<3d', *p) for p in self.points)
        yield 'ascii.ply', (ply.format('ascii', *['float'] * 3) + colours).encode()
        yield 'binary.ply', ply.format('binary_little_endian', *['float32'] * 3).encode() + b''.join(struct.pack('<B3f', 9, *p) for p in self.points)
        yield 'doubles.ply', ply.format('binary_little_endian', *['double'] * 3).encode() + b''.join(struct.pack('<B3d', 9, *p) for p in self.points)
        yield 'plain.xyz', text.encode()
        yield 'more.xyz', ('// x y z intensity\r\n' + text.replace('\n', ' 17\r\n')).encode()
        yield 'commas.csv', text.replace(' ', ',').encode()
        yield 'measured.xyz', ('nan nan nan\n' + text + '1 nan 2\n').encode()

    def ask(self, body, *more):
        return super().ask('distance', [PASSING], SCENE.format(body), *more)

    def each_file_is_the_points_that_it_holds(self):
        wanted = self.ask('points, dimensions: [0.05], vertices: ' + str([list(point) for point in self.points]))
        self.assertEqual((wanted.code, wanted.err), (0, ''))
        for name, content in self.files():
            with self.subTest(name=name):
                self.file(name, content)
                answer = self.ask(f'points, dimensions: [0.05], resource: {name}')
                self.assertEqual((answer.code, answer.err), (0, ''))
                self.assertEqual(same(answer.rows[0]), same(wanted.rows[0]))

    def what_is_no_cloud_is_refused_in_one_line(self):
        good = dict(self.files())
        for name, content, words in (('cut.pcd', good['binary.pcd'][:-1], 'ends before'), ('short.pcd', good['ascii.pcd'].rpartition(b'\n')[0].rpartition(b'\n')[0], 'ends after'),
                                     ('cut.ply', good['binary.ply'][:-1], 'ends before'), ('zipped.pcd', good['ascii.pcd'].replace(b'DATA ascii', b'DATA binary_compressed'), 'binary_compressed'),
                                     ('flat.pcd', good['ascii.pcd'].replace(b'x y z', b'x y w'), 'x, y and z'), ('big.ply', good['ascii.ply'].replace(b'ascii', b'binary_big_endian'), 'big_endian'),
                                     ('endless.xyz', b'1 2 inf\n', "'inf'"), ('words.xyz', b'1 2 3\na b c\n', 'line 2'), ('nothing.xyz', b'# none\n', 'no point'),
                                     ('all.xyz', b'nan nan nan\n', 'no point'), ('cloud.las', b'LASF', '.pcd'), ('huge.pcd', good['binary.pcd'].replace(b'POINTS 50', b'POINTS 9007199254740992'), 'ends before'),
                                     ('infinite.ply', good['binary.ply'][:-4] + struct.pack('<f', float('inf')), 'finite'), ('none.ply', b'', 'no PLY')):
            with self.subTest(name=name):
                self.file(name, content)
                self.assertRefused(self.ask(f'points, resource: {name}'), name, words)
        self.assertRefused(self.ask('points, resource: nowhere.pcd'), 'nowhere.pcd', 'cannot be read')


class Paths(Case):
    POSES = [(10.5, (0.2, -0.4, 0.55), (0, 0, 0, 1)), (12.25, (0.2, 0.1, 0.55), (0, 0, .6, .8)), (13.000000001, (-0.4, 0.3, 0.7), (.6, 0, 0, .8))]
    BODY = 'id: bar\nprimitives: [{type: box, dimensions: [.4, .1, .1]}]\n'
    BOX = 'world: {collision_objects: [{id: box, primitives: [{type: box, dimensions: [.3, .2, .1]}]}]}\n'

    def ask(self, name, text, *more):
        path, body, scene = self.file(name, text), self.file('body.yaml', self.BODY), self.file('scene.yaml', self.BOX)
        return cprox('distance', '--path', path, '--body', body, '--scene', scene, *more)

    def yaml(self, stamps):
        out = 'header: {frame_id: world}\nposes:\n'
        for (_, p, q), (secs, nsecs) in zip(self.POSES, stamps):
            out += '  - {header: {stamp: {secs: %d, nsecs: %d}}, pose: {position: {x: %r, y: %r, z: %r}, orientation: {x: %r, y: %r, z: %r, w: %r}}}\n' % (secs, nsecs, *p, *q)
        return out

    def lines_of_tum_and_euroc_are_the_path_that_they_say(self):
        wanted = self.ask('path.yaml', self.yaml([(10, 500000000), (12, 250000000), (13, 1)]))
        self.assertEqual((wanted.code, wanted.err), (0, ''))
        tum = '# stamp\n' + ''.join('%s %r %r %r %r %r %r %r\n' % (t, *p, *q) for t, (_, p, q) in zip(('10.5', '12.25', '13.000000001'), self.POSES))
        euroc = '#stamp [ns], p, q\n' + ''.join('%d,%r,%r,%r,%r,%r,%r,%r%s\n' % (round(t * 1e9), *p, q[3], *q[:3], ',1,2,3,4,5,6,7,8,9' if t > 12 else '') for t, p, q in self.POSES)
        for name, text in (('a.tum', tum), ('a.txt', tum.replace('\n', '\r\n')), ('a.csv', euroc)):
            answer = self.ask(name, text)
            self.assertEqual((answer.code, answer.err), (0, ''), name)
            self.assertEqual(same(answer.rows[0]), same(wanted.rows[0]))

    def a_pose_array_counts_its_poses(self):
        wanted = self.ask('path.yaml', self.yaml([(0, 0)] * 3))
        array = 'header: {frame_id: world}\nposes:\n' + ''.join('  - {position: {x: %r, y: %r, z: %r}, orientation: {x: %r, y: %r, z: %r, w: %r}}\n' % (*p, *q) for _, p, q in self.POSES)
        answer = self.ask('array.yaml', array)
        self.assertEqual(same(answer.rows[0]), same(wanted.rows[0]))
        self.assertIn('t counts its poses', answer.err)

    def what_is_no_pose_is_refused_by_its_line(self):
        for text, words in (('1 2 3\n', 'line 1'), ('# x\n1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 0\n', 'line 3'), ('1 0 0 0 0 0 0 nan\n', "'nan'"), ('', 'no poses'),
                            ('now 0 0 0 0 0 0 1\n', "'now'"), ('1.5,0,0,0,1,0,0,0\n', 'nanoseconds'), ('1e9 0 0 0 0 0 0 1\n', "'1e9'")):
            self.assertRefused(self.ask('path.txt', text), 'path.txt', words)


class Others(Case):
    def files_that_a_scene_names_are_in_its_digest(self):
        """Also where the scene is JSON."""
        curves, page = self.file('curves.csv', PASSING + '\n'), os.path.join(self.folder, 'report.html')
        for name, scene in (('scene.yaml', SCENE.format('points, resource: cloud.xyz')),
                            ('scene.json', '{"world": {"collision_objects": [{"id": "it", "bodies": [{"type": "points", "resource": "cloud.xyz"}]}]}}')):
            digests = []
            for points in ('0 0 0\n', '0 0 1\n', '0 0 0\n'):
                self.file('cloud.xyz', points)
                answer = cprox('report', '--curves', curves, '--scene', self.file(name, scene), '--out', page)
                self.assertEqual((answer.code, answer.err), (0, ''))
                with open(page, encoding='utf-8') as text:
                    digests.append(re.search(r'"what":"scene"[^}]*"digest":"(\w+)"', text.read())[1])
            self.assertEqual((digests[0] == digests[2], digests[0] == digests[1]), (True, False), name)

    def a_superquadric_has_barrs_exponents(self):
        for e in (.5, .8, 1, 2):
            barr = self.ask('distance', [PASSING], SCENE.format(f'superquadric, dimensions: [.5, .4, .3, {e}, {e}]'))
            sums = self.ask('distance', [PASSING], SCENE.format('superquadric, dimensions: [.5, .4, .3, {0}, {0}, {0}]'.format(2 / e)))
            self.assertEqual((barr.code, same(barr.rows[0])), (0, same(sums.rows[0])))
        two = [self.ask('distance', [PASSING], SCENE.format(f'{kind}, dimensions: [.5, .4, .3, .5, 1]')) for kind in ('superquadric', 'superellipsoid')]
        self.assertEqual((two[0].code, same(two[0].rows[0])), (0, same(two[1].rows[0])))
        self.assertEqual(self.ask('distance', [PASSING], SCENE.format('superquadric, dimensions: [.5, .4, .3, .5, 2.5]')).code, 2)
        self.assertEqual(self.ask('distance', [PASSING], SCENE.format('superquadric, dimensions: [.5, .4, .3, 0, 0]')).code, 2)
        self.assertEqual(self.ask('distance', [PASSING], SCENE.format('superquadric, dimensions: [.5, .4, .3, 2.5, 2.5]')).code, 2)

    def robots_of_other_formats_are_named(self):
        for text, words in (('<mujoco model="m"><worldbody/></mujoco>', "MuJoCo's MJCF"), ('<?xml version="1.0"?><sdf version="1.7"><model name="m"/></sdf>', 'SDF')):
            path, points = self.file('robot.xml', text), self.file('curves.csv', PASSING + '\n')
            self.assertRefused(cprox('distance', '--curves', points, '--robot', path), words, 'convert it')
