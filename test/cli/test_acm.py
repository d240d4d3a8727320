# SPDX-License-Identifier: BSD-3-Clause
"""cprox acm: an arm with balls at its ends, of which the law of cosines says when they touch."""
import csv
import io
import math
import os
import xml.etree.ElementTree as ElementTree
from random import Random

from support import DATA, Case, cprox

UPPER, LOWER = 1.0, 0.6  # [m]


def arm(radius, most, kind='revolute', limit=True):
    ball = f'<collision><geometry><sphere radius="{radius}"/></geometry></collision>'
    limits = f'<limit lower="-0.3" upper="{most}" effort="1" velocity="1"/>' if limit else ''
    return f"""<robot name="arm"><link name="base">{ball}</link><link name="upper"/><link name="tip">{ball}</link><link name="stand">
  <collision><origin xyz="0 0 0.05"/><geometry><sphere radius="0.01"/></geometry></collision></link>
  <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
  <joint name="elbow" type="{kind}"><parent link="upper"/><child link="fore"/><origin xyz="{UPPER} 0 0"/><axis xyz="0 0 1"/>
    {limits}</joint>
  <link name="fore"/>
  <joint name="wrist" type="fixed"><parent link="fore"/><child link="tip"/><origin xyz="{LOWER} 0 0"/></joint>
  <joint name="bolt" type="fixed"><parent link="base"/><child link="stand"/></joint></robot>"""


class Acm(Case):
    def acm(self, urdf, *more, srdf=None):
        self.new = os.path.join(self.folder, 'new.srdf')
        words = ['acm', '--robot', self.file('arm.urdf', urdf), '--out', self.new]
        answer = cprox(*words, *(['--srdf', self.file('arm.srdf', srdf)] if srdf else []), *more)
        answer.pairs = {(row['a'], row['b']): row for row in csv.DictReader(io.StringIO(answer.out))}
        return answer

    def disabled_in(self, srdf):
        return {(e.get('link1'), e.get('link2')): e.get('reason') for e in ElementTree.parse(srdf).iter('disable_collisions')}

    def links_touch_where_the_law_of_cosines_says(self):
        for most in (1.0, 2.0, 2.5, 2.7, 3.0):
            least = math.sqrt(UPPER ** 2 + LOWER ** 2 + 2 * UPPER * LOWER * math.cos(most)) - 0.5
            with self.subTest(most=most):
                answer = self.acm(arm(0.25, most))
                row = answer.pairs['base', 'tip']
                self.assertEqual((row['contact'], answer.code, answer.err), ('never' if least > 0 else 'possible', 0, ''))
                self.assertLessEqual(float(row['lower']), max(least, 0))
                self.assertEqual(self.disabled_in(self.new).get(('base', 'tip')), 'Never' if least > 0 else None)
                if least <= 0:
                    posture = dict(part.split(': ') for part in row['posture'].split(', '))
                    angle = float(posture['elbow'])
                    self.assertTrue(-0.3 <= angle <= most)
                    self.assertLessEqual(UPPER ** 2 + LOWER ** 2 + 2 * UPPER * LOWER * math.cos(angle), 0.25 + 1e-9)

    def what_is_fixed_touches_always_or_never(self):
        self.assertEqual(self.acm(arm(0.25, 1)).pairs['base', 'stand']['contact'], 'always')
        self.assertEqual(self.disabled_in(self.new)['base', 'stand'], 'Always')
        self.assertEqual(self.acm(arm(0.03, 1)).pairs['base', 'stand']['contact'], 'never')

    def a_srdf_that_disables_a_pair_that_can_touch_is_reported(self):
        srdf = """<robot name="arm"><!-- kept --><group name="all"><chain base_link="base" tip_link="tip"/></group>
          <disable_collisions link1="tip" link2="base" reason="{}"/><disable_collisions link1="stand" link2="tip" reason="User"/></robot>"""
        answer = self.acm(arm(0.25, 3), srdf=srdf.format('Never'))
        self.assertEqual(answer.code, 1)
        self.assertIn("'base' and 'tip' are disabled as Never, and touch at elbow: ", answer.err)
        self.assertEqual((answer.pairs['base', 'tip']['disabled_before'], answer.pairs['base', 'tip']['disabled']), ('Never', ''))
        self.assertNotIn(('base', 'tip'), self.disabled_in(self.new))
        self.assertIn('kept', open(self.new).read())
        self.assertEqual(len(ElementTree.parse(self.new).findall('group/chain')), 1)
        answer = self.acm(arm(0.25, 3), srdf=srdf.format('User'))  # what a person decided stays
        self.assertEqual((answer.code, answer.err, self.disabled_in(self.new)['base', 'tip']), (0, '', 'User'))

    def the_panda_keeps_its_adjacent_links_and_no_posture_is_wrong(self):
        panda = os.path.join(DATA, 'robots/panda/panda')
        new = os.path.join(self.folder, 'new.srdf')
        answer = cprox('acm', '--robot', panda + '.urdf', '--srdf', panda + '.srdf', '--out', new, '--max-nodes', 3000, '--quiet')
        self.assertIn(answer.code, (1, 3), answer.err)
        rows = list(csv.DictReader(io.StringIO(answer.out)))
        self.assertEqual(len(rows), 55)
        found = {(row['a'], row['b']): row for row in rows}
        self.assertEqual(found['panda_link0', 'panda_link2']['contact'], 'never')
        self.assertEqual(found['panda_link0', 'panda_link5']['contact'], 'possible')
        for row in rows:
            if row['contact'] != 'possible' or row['disabled']:
                continue
            values = dict(part.split(': ') for part in row['posture'].split(', '))
            points = ', '.join(f'{{positions: [{", ".join(values.values())}], time_from_start: {t}}}' for t in (0, 1))
            trajectory = self.file('there.yaml', f'joint_trajectory: {{joint_names: [{", ".join(values)}], points: [{points}]}}')
            there = cprox('nearest', '--robot', panda + '.urdf', '--trajectory', trajectory, '--self', '--links', row['a'], '--within', 0,
                          '--pairs', 100, '--allow-empty')
            self.assertIn({row['a'], row['b']}, [{pair['a'], pair['b']} for pair in there.rows], row)

    def no_motion_through_random_states_brings_links_together_that_never_touch(self):
        # seed 46: 200 states within the limits, straight from one to the next; proven by the search along motions, which is another
        panda = os.path.join(DATA, 'robots/panda/panda')
        answer = cprox('acm', '--robot', panda + '.urdf', '--out', os.path.join(self.folder, 'new.srdf'), '--max-nodes', 3000, '--quiet')
        rows = list(csv.DictReader(io.StringIO(answer.out)))
        never = {frozenset((row['a'], row['b'])) for row in rows if row['contact'] == 'never'}
        self.assertGreater(len(never), 12)
        limits = {e.get('name'): [float(e.find('limit').get(side)) for side in ('lower', 'upper')]
                  for e in ElementTree.parse(panda + '.urdf').findall('joint') if e.get('type') in ('revolute', 'prismatic')}
        random = Random(46)
        points = ', '.join(f'{{positions: [{", ".join(str(random.uniform(*limit)) for limit in limits.values())}], time_from_start: {t}}}'
                           for t in range(200))
        trajectory = self.file('go.yaml', f'joint_trajectory: {{joint_names: [{", ".join(limits)}], points: [{points}]}}')
        met = cprox('nearest', '--robot', panda + '.urdf', '--trajectory', trajectory, '--self', '--within', 0, '--pairs', 5000, '--max-nodes', 100000000)
        touched = {frozenset((row['a'], row['b'])) for row in met.rows if row['kind'] == 'self' and float(row['upper']) <= 0}
        self.assertGreater(len(touched), 10, met.err)
        self.assertFalse(touched & never)

    def what_is_wrong_is_said_in_one_line(self):
        self.assertRefused(cprox('acm', '--out', 'new.srdf'), '--robot')
        self.assertRefused(cprox('acm', '--robot', self.file('arm.urdf', arm(0.1, 1))), '--out')
        self.assertRefused(self.acm(arm(0.1, 1), '--delta', 1), '--delta')
        self.assertRefused(self.acm(arm(0.1, 1), srdf='<robot'), 'arm.srdf')
        answer = self.acm(arm(0.1, 1, 'planar', False))
        self.assertEqual(answer.code, 2)
        self.assertIn("base and tip: joint 'elbow' has several values without limits", answer.err)

