# SPDX-License-Identifier: BSD-3-Clause
"""cprox sweep: a ball on a slide and on an arm, whose swept volumes are known."""
import csv
import io
import math
import os
import struct

from support import Case, bezier, cprox

RADIUS = 0.1


def robot(joint, origin='0 0 0'):
    return f"""<robot name="r"><link name="base"/><link name="ball"><collision><origin xyz="{origin}"/><geometry>
  <sphere radius="{RADIUS}"/></geometry></collision></link>
  <joint name="j" type="{joint}"><parent link="base"/><child link="ball"/><axis xyz="{'1 0 0' if joint == 'prismatic' else '0 0 1'}"/>
    <limit lower="-7" upper="7" effort="1" velocity="1"/></joint></robot>"""


def motion(first, last):
    points = ', '.join(f'{{positions: [{value}], time_from_start: {t}}}' for t, value in enumerate((first, last)))
    return f'joint_trajectory: {{joint_names: [j], points: [{points}]}}'


def cells_of(path):
    """The boundary facets of a binary STL: corners and normals."""
    data = open(path, 'rb').read()
    n, = struct.unpack_from('<I', data, 80)
    assert len(data) == 84 + 50 * n
    return [struct.unpack_from('<12f', data, 84 + 50 * i) for i in range(n)]


def volume_of(facets):
    """Of a closed surface."""
    total = 0.0
    for f in facets:
        a, b, c = f[3:6], f[6:9], f[9:12]
        total += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    return total


class Sweep(Case):
    def sweep(self, urdf, trajectory, *more, out='swept.stl'):
        self.out = os.path.join(self.folder, out)
        answer = cprox('sweep', '--robot', self.file('r.urdf', urdf), '--trajectory', self.file('go.yaml', trajectory), '--out', self.out, *more)
        answer.found = next(csv.DictReader(io.StringIO(answer.out)), None)
        return answer

    def the_volume_of_a_capsule_is_between_both_covers(self):
        true = math.pi * RADIUS ** 2 * 1.5 + 4 / 3 * math.pi * RADIUS ** 3
        inside = os.path.join(self.folder, 'inside.stl')
        for resolution in (0.04, 0.02):
            answer = self.sweep(robot('prismatic'), motion(0, 1.5), '--resolution', resolution, '--inside', inside)
            self.assertEqual((answer.code, answer.err), (0, ''))
            row = answer.found
            self.assertLess(float(row['volume_inside']), true)
            self.assertGreater(float(row['volume']), true)
            gap = float(row['gap'])
            self.assertLessEqual(gap, 2.3 * resolution)
            self.assertLess(float(row['volume']), math.pi * (RADIUS + gap) ** 2 * 1.5 + 4 / 3 * math.pi * (RADIUS + gap) ** 3)
            # both files are closed surfaces of the volumes that the row states
            self.assertAlmostEqual(volume_of(cells_of(self.out)), float(row['volume']), delta=1e-5)
            self.assertAlmostEqual(volume_of(cells_of(inside)), float(row['volume_inside']), delta=1e-5)
        self.assertGreater(float(row['volume_inside']), 0.3 * true)

    def no_corner_of_the_surface_is_in_the_ring_that_a_ball_sweeps(self):
        answer = self.sweep(robot('revolute', '0.5 0 0'), motion(-1.2, 2.0), '--resolution', 0.02)
        for facet in cells_of(self.out):
            for x, y, z in (facet[3:6], facet[6:9], facet[9:12]):
                angle = min(max(math.atan2(y, x), -1.2), 2.0)
                away = math.dist((x, y, z), (0.5 * math.cos(angle), 0.5 * math.sin(angle), 0))
                self.assertGreaterEqual(away, RADIUS - 1e-6)
                self.assertLessEqual(away, RADIUS + float(answer.found['gap']))

    def an_octree_is_an_obstacle_of_a_scene(self):
        self.assertEqual(self.sweep(robot('prismatic'), motion(0, 1.5), '--resolution', 0.02, out='swept.bt').err, '')
        scene = 'world: {collision_objects: [{id: swept, bodies: [{type: octree, resource: swept.bt}], body_poses: [{}]}]}'
        row = self.ask('distance', bezier('beside', (0.2, 0.5, 0), (1.0, 0.5, 0)), scene).row('beside')
        self.assertTrue(0.5 - RADIUS - 2.3 * 0.02 <= float(row['lower']) <= float(row['upper']) <= 0.5 - RADIUS, row)

    def what_is_wrong_is_said_in_one_line(self):
        self.assertRefused(self.sweep(robot('prismatic'), motion(0, 1), out='swept.obj'), '.bt', '.stl')
        self.assertRefused(self.sweep(robot('prismatic'), motion(0, 1), '--resolution', 0), '--resolution')
        answer = self.sweep(robot('prismatic'), motion(0, 1), '--resolution', 1e-5)
        self.assertEqual(answer.code, 2)
        self.assertIn('GB, the limit is', answer.err)
        self.assertRefused(cprox('sweep', '--robot', 'r', '--out', 'x.bt'), '--trajectory')
        self.assertRefused(cprox('sweep', '--robot', 'r', '--trajectory', 't'), '--out')
