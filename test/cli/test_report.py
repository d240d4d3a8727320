# SPDX-License-Identifier: BSD-3-Clause
"""The page of `cprox report`: its data against the other commands, and what a browser makes of it."""
import base64
import json
import math
import os
import re
import shlex
import shutil
import struct
import subprocess
import urllib.parse
import xml.etree.ElementTree
import zlib

from support import DATA, Case, bezier, cprox
from test_movers import BALL, SECOND
from test_profile import OVER, TWO, robot_files

PANDA = [f'--{name}={os.path.join(DATA, path)}' for name, path in (
    ('robot', 'robots/panda/panda.urdf'), ('srdf', 'robots/panda/panda.srdf'),
    ('trajectory', 'trajectories/panda_bookshelf_thin_0001_rrt.yaml'))]


def numbers(values):
    """JSON has null where a number is not finite."""
    return [math.inf if x is None else x for x in values]


def pixels(path):
    """The RGB rows of a PNG of 8 bits a channel."""
    with open(path, 'rb') as file:
        raw = file.read()
    width, height, depth, kind = struct.unpack('>IIBB', raw[16:26])
    assert depth == 8 and kind in (2, 6), (depth, kind)
    size, at, packed = 3 if kind == 2 else 4, 8, b''
    while at < len(raw):
        length, name = struct.unpack('>I4s', raw[at:at + 8])
        if name == b'IDAT':
            packed += raw[at + 8:at + 8 + length]
        at += 12 + length
    flat, rows, before = zlib.decompress(packed), [], bytearray(width * size)
    for y in range(height):
        begin = y * (width * size + 1)
        how, line = flat[begin], bytearray(flat[begin + 1:begin + 1 + width * size])
        for x in range(len(line)):
            left = line[x - size] if x >= size else 0
            up, corner = before[x], before[x - size] if x >= size else 0
            if how == 1:
                line[x] = (line[x] + left) & 255
            elif how == 2:
                line[x] = (line[x] + up) & 255
            elif how == 3:
                line[x] = (line[x] + (left + up) // 2) & 255
            elif how == 4:
                guess = left + up - corner
                nearest = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))
                line[x] = (line[x] + nearest[2]) & 255
        rows.append([tuple(line[x:x + 3]) for x in range(0, len(line), size)])
        before = line
    return rows


class Report(Case):
    def report(self, *words, code=0):
        """The page's text and its data."""
        path = os.path.join(self.folder, 'report.html')
        answer = cprox('report', *words, '--out', path)
        self.assertEqual((answer.code, answer.out), (code, ''), answer.err)
        with open(path, encoding='utf-8') as file:
            text = file.read()
        found = re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.S)
        return text, json.loads(found.group(1))

    def a_robot_s_report_says_what_the_commands_say(self):
        words = robot_files(self)
        _, data = self.report(*words, '--self', '--delta', '0.5', '--intervals', '8')
        self.assertEqual([row['status'] for row in data['verdicts']], ['ok', 'ok', 'ok', 'ok'])
        self.assertEqual([(row['kind'], row['query']) for row in data['verdicts']],
                         [(kind, query) for kind in ('environment', 'self') for query in ('tolerance', 'distance')])
        rows = cprox('distance', *words, '--self').rows
        for row, found in zip(rows, data['verdicts'][1::2]):
            for name in ('kind', 'a', 'b', 'status'):
                self.assertEqual(found[name], row[name], name)
            self.assertEqual(numbers([found['lower'], found['upper']]), [float(row['lower']), float(row['upper'])])
        verdicts = cprox('tolerance', '--delta', '0.5', *words, '--self').rows
        self.assertEqual([row['verdict'] for row in data['verdicts'][::2]], [row['verdict'] for row in verdicts])

        profiles = {(p['kind'], p['name']): p for p in data['profiles']}
        rows = [row for row in cprox('profile', *words, '--self', '--per-link', '--intervals', '8').rows if row['a']]
        self.assertEqual(len(rows), 8 * len(profiles))
        for row in rows:
            profile = profiles[row['kind'], row['a']]
            k = profile['t'].index(float(row['t0']))
            self.assertEqual(numbers([profile['lower'][k], profile['upper'][k]]), [float(row['lower']), float(row['upper'])])
            self.assertEqual(profile['against'][k], row['b'])
        near = [row for row in cprox('nearest', *words, '--self').rows if row['b']]
        self.assertEqual([(p['a'], p['b'], p['upper']) for p in data['pairs']],
                         [(row['a'], row['b'], float(row['upper'])) for row in near])

    def what_is_drawn_stands_where_it_was_measured(self):
        """At the moment of the closest pair each of its points lies on what is drawn of its body."""
        _, data = self.report(*robot_files(self))
        pair = min(data['pairs'], key=lambda row: row['upper'])
        moment = data['frames']['times'].index(pair['t'])
        for name, point in zip((pair['a'], pair['b']), pair['points']):
            body = next(b for b in data['bodies'] if b['name'] == name)
            x, y, z, qx, qy, qz, qw = data['frames']['poses'][body['on']][moment] if body['on'] else (0, 0, 0, 0, 0, 0, 1)
            turn = [[1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qz * qw), 2 * (qx * qz + qy * qw)],
                    [2 * (qx * qy + qz * qw), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qx * qw)],
                    [2 * (qx * qz - qy * qw), 2 * (qy * qz + qx * qw), 1 - 2 * (qx * qx + qy * qy)]]
            corners = [body['vertices'][i:i + 3] for i in range(0, len(body['vertices']), 3)]
            placed = [[sum(a * b for a, b in zip(row, corner)) + at for row, at in zip(turn, (x, y, z))] for corner in corners]
            for axis in range(3):  # all bodies here are boxes along the axes
                values = [corner[axis] for corner in placed]
                self.assertTrue(min(values) - 1e-4 <= point[axis] <= max(values) + 1e-4, (name, axis, point, values))

    def a_curve_s_report_draws_the_curve(self):
        curves = '\n'.join([OVER, bezier('other', (-3, 0, 5), (3, 0, 5))]) + '\n'
        words = ['--curves', self.file('curves.csv', curves), '--scene', self.file('scene.yaml', TWO)]
        _, data = self.report(*words, '--delta', '0.6', code=1)
        self.assertEqual([row['verdict'] for row in data['verdicts']], ['violated', None, 'clear', None])
        self.assertEqual([(c['name'], c['radius'], c['points'][:3], c['points'][-3:]) for c in data['curves']],
                         [('over', 0.5, [-3, 0, 2], [3, 0, 2]), ('other', 0, [-3, 0, 5], [3, 0, 5])])
        rows = cprox('distance', *words).rows
        self.assertEqual([row['lower'] for row in data['verdicts'][1::2]], [float(row['lower']) for row in rows])

    def a_certificate_is_named_by_its_digest(self):
        """The records in the file, one behind the other, are those that the page names; `check` proves them."""
        import hashlib
        words = robot_files(self)
        path = os.path.join(self.folder, 'proofs')
        _, data = self.report(*words, '--delta', '0.5', '--certificate', path)
        with open(path, 'rb') as file:
            record = file.read()
        row = data['verdicts'][0]
        self.assertEqual(row['certificate'], hashlib.blake2b(record, digest_size=32).hexdigest())
        self.assertEqual(row['proof'], 'apart')
        checked = cprox('check', path, *words)
        self.assertEqual(checked.code, 0, checked.out + checked.err)

    def the_page_needs_nothing_beside_it(self):
        text, _ = self.report(*robot_files(self))
        frame = re.sub(r'<script\b.*?</script>', '', text, flags=re.S)
        self.assertNotRegex(frame, r'\b(src|href|url)\s*[=(]')
        self.assertIn('THREE.OrbitControls', text)

    def the_page_says_when_where_and_by_which_command(self):
        words = [*robot_files(self), '--objects', "it's, near"]
        path = os.path.join(self.folder, 'report.html')
        scene = TWO.replace('id: far', 'id: "it\'s"')
        words[words.index('--scene') + 1] = self.file('named.yaml', scene)
        answer = cprox('report', *words, '--out', path, env={'SOURCE_DATE_EPOCH': '86400'})
        self.assertEqual(answer.code, 0, answer.err)
        with open(path, encoding='utf-8') as file:
            data = json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', file.read(), re.S).group(1))
        self.assertEqual((data['date'], data['host']), ('1970-01-02 00:00:00 UTC', os.uname().nodename))
        self.assertEqual(shlex.split(data['command']), ['cprox', 'report', *words, '--out', path])

    def a_box_is_drawn_with_all_its_faces(self):
        sizes = {'cube': (1, 1, 1), 'board': (.6, .4, .02), 'bar': (.1, .1, 2)}
        scene = 'world:\n  collision_objects:\n' + ''.join(
            f'    - {{id: {name}, primitives: [{{type: box, dimensions: {list(size)}}}], primitive_poses: [{{orientation: [.5, .1, .3, .8]}}]}}\n'
            for name, size in sizes.items())
        _, data = self.report('--curves', self.file('curves.csv', OVER + '\n'), '--scene', self.file('scene.yaml', scene))
        for body in data['bodies']:
            corners = [body['vertices'][i:i + 3] for i in range(0, len(body['vertices']), 3)]
            area = 0
            for i in range(0, len(body['triangles']), 3):
                a, b, c = (corners[k] for k in body['triangles'][i:i + 3])
                u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
                area += math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2
            x, y, z = sizes[body['name']]
            self.assertAlmostEqual(area, 2 * (x * y + y * z + z * x), delta=1e-3, msg=body['name'])

    def names_cannot_become_tags(self):
        name = '</script><b>&'
        scene = TWO.replace('id: near', f"id: '{name}'")
        curve = OVER.replace('over', '<i>x')
        words = ['--curves', self.file('a<b>.csv', curve + '\n'), '--scene', self.file('scene.yaml', scene)]
        text, data = self.report(*words)
        self.assertEqual(data['verdicts'][0]['b'], name)
        self.assertEqual(text.count('<b>'), 0)
        self.assertIn('<title>a&lt;b&gt;.csv in scene.yaml</title>', text)

    def a_name_that_is_no_utf_8_is_shown_with_a_sign(self):
        curves = (OVER.replace('over', 'ä€𝄞?') + '\n').encode().replace(b'?', b'\xff')
        _, data = self.report('--curves', self.file('curves.csv', curves), '--scene', self.file('scene.yaml', TWO))
        self.assertEqual(data['verdicts'][0]['id'], 'ä€𝄞\ufffd')

    def bad_words_are_refused_in_one_line(self):
        words = robot_files(self)
        out = ['--out', os.path.join(self.folder, 'x.html')]
        self.assertRefused(cprox('report', *words), "'report' needs --out")
        self.assertRefused(cprox('report', *out), 'needs --curves')
        self.assertRefused(cprox('report', *words, *out, '--movers'), "'report' takes no --movers")
        self.assertRefused(cprox('report', *words, *out, '--delta', '-1'), '--delta')
        self.assertRefused(cprox('report', *words, *out, '--intervals', '2001'), 'from 1 to 2000')
        self.assertRefused(cprox('report', *words, '--out', words[1]), 'is an input of this run')
        many = self.file('many.csv', '\n'.join([OVER] * 51) + '\n')
        self.assertRefused(cprox('report', '--curves', many, '--scene', words[5], *out), 'at most 50 curves')
        bad = self.file('bad.csv', OVER + '\n' + 'bad,bezier,1,0,1,0,2,0,0,0\n')
        _, data = self.report('--curves', bad, '--scene', words[5], code=2)
        self.assertEqual(len(data['verdicts']), 1)
        self.assertTrue(any('row 2' in note for note in data['notes']), data['notes'])

    def what_moves_beside_the_robot_is_where_it_is_then(self):
        words = robot_files(self, scene=BALL.replace('START', '0') + SECOND.replace('NAME', 'other').replace('START', '1'))
        _, data = self.report(*words, '--self', '--delta', '0.05', '--intervals', '8', code=1)
        self.assertEqual([(row['kind'], row['query'], row['b']) for row in data['verdicts'] if row['kind'] == 'environment'],
                         [('environment', 'tolerance', 'ball'), ('environment', 'distance', 'ball')])
        movers = {body['name'] for body in data['bodies'] if body['kind'] == 'mover'}
        self.assertEqual(movers, {'ball', 'other/cart', 'other/arm', 'other/hand'})
        times, poses = data['frames']['times'], data['frames']['poses']
        for t, ball, cart in zip(times, poses['ball'], poses['other/cart']):
            self.assertAlmostEqual(math.dist(ball[:3], (1, 1 - t / 2, 0)), 0, delta=1e-4)
            gone = min(max(t - 1, 0), 4) / 2  # it begins a second later, turned round
            self.assertAlmostEqual(math.dist(cart[:3], (2 - gone, 0.5, 0)), 0, delta=1e-4)
        cart = next(profile for profile in data['profiles'] if profile['name'] == 'cart')
        rows = [row for row in cprox('profile', *words, '--per-link', '--intervals', '8').rows if row['a'] == 'cart']
        self.assertEqual(numbers(cart['upper']), [float(row['upper']) for row in rows])
        for option in (('--certificate', os.path.join(self.folder, 'c')),):
            self.assertRefused(cprox('report', *words, *option, '--out', os.path.join(self.folder, 'no.html')), 'moves along a trajectory')

    def a_mesh_is_drawn_with_fewer_triangles(self):
        """A Panda by its own meshes: what is drawn is coarse, and within each link's size."""
        scene = os.path.join(DATA, 'scenes/mbm/bookshelf_thin_panda/scene0001.yaml')
        text, data = self.report(*PANDA, '--scene', scene, '--self', '--intervals', '20')
        self.assertLess(len(text), 6e6)
        links = [body for body in data['bodies'] if body['kind'] == 'link']
        self.assertGreater(len(links), 8)
        for body in links:
            self.assertTrue(12 <= len(body['triangles']) // 3 <= 2500, body['name'])
            self.assertLess(max(map(abs, body['vertices'])), 0.6, body['name'])
            self.assertLess(max(body['triangles']), len(body['vertices']) // 3)

    def a_browser_shows_it(self):
        """Headless Chromium: no error, the tables filled, the chart drawn, the robot and the scene in the 3-D view."""
        chromium = shutil.which('chromium') or shutil.which('chromium-browser')
        if not chromium:
            self.fail('chromium is not installed')
        self.report(*robot_files(self), '--self', '--delta', '0.5')
        page = 'file://' + os.path.join(self.folder, 'report.html')
        shot = os.path.join(self.folder, 'page.png')
        command = [chromium, '--headless=new', '--no-sandbox', '--disable-dev-shm-usage', '--use-angle=swiftshader',
                   '--enable-unsafe-swiftshader', '--enable-logging=stderr', '--hide-scrollbars', '--window-size=1000,2200',
                   f'--user-data-dir={self.folder}/profile', '--virtual-time-budget=5000']

        def browse(*more):
            done = subprocess.run([*command, *more, page], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  timeout=100, env=dict(os.environ, HOME=self.folder))
            said = done.stderr.decode(errors='replace')
            self.assertEqual(re.findall(r'.*CONSOLE.*(?:rror|Uncaught).*', said), [], said)
            return done.stdout.decode()

        dom = browse('--dump-dom')
        self.assertRegex(dom, r'<span class="verdict clear">clear</span>')
        self.assertGreaterEqual(dom.count('<tr class="row'), 2)
        self.assertRegex(dom, r'<g class="band" data-name="cart"')
        self.assertIn('<canvas', dom)
        self.assertRegex(dom, r'<p id="view-note">Links have the colour')
        self.assertRegex(dom, r'<div id="objects">(<span><i style="background: [^"]*"></i>[^<]+</span>){2}</div>')
        chart = re.search(r'<a id="chart-file" download="clearance.svg" href="data:image/svg\+xml;charset=utf-8,([^"]*)"', dom).group(1)
        figure = xml.etree.ElementTree.fromstring(urllib.parse.unquote(chart))
        self.assertEqual(figure.tag, '{http://www.w3.org/2000/svg}svg')
        texts = [text.text for text in figure.iter('{http://www.w3.org/2000/svg}text')]
        self.assertIn('cart', texts)
        self.assertIn('t [s]', texts)
        picture = re.search(r'<a id="view-file" download="view.png" href="data:image/png;base64,([^"]*)"', dom).group(1)
        self.assertEqual(base64.b64decode(picture)[:8], b'\x89PNG\r\n\x1a\n')
        browse(f'--screenshot={shot}')
        seen = {}
        for row in pixels(shot):
            for colour in row:
                seen[colour] = seen.get(colour, 0) + 1
        self.assertGreater(seen.get((244, 246, 248), 0), 20000, 'the background of the view')
        tan = sum(n for (r, g, b), n in seen.items() if r > g > b and r - b > 20 and max(r, g, b) - min(r, g, b) < 90)
        blue = sum(n for (r, g, b), n in seen.items() if r < g < b and 20 < b - r < 60 and r > 90)
        self.assertGreater(tan, 300, 'the post of the scene')
        self.assertGreater(blue, 3000, 'its wall')
        self.assertGreater(sum(n for c, n in seen.items() if c[0] > 170 and c[1] < 60 and c[2] < 70), 3, 'the closest pair')
