#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What cprox_check accepts about robots is true wherever it is looked at.

    second_robots.py ROBOT_MUTANTS CPROX_CHECK [QUERIES MUTANTS SEED]

Genuine certificates and tampered ones; each claim that is accepted is tried at random times of the motion: "farther than delta" of all pairs
there, "not farther" at the time that the certificate names. Another reader of the text, kinematics by quaternions, Hermite's basis
functions, Cox and de Boor's recursion, and distances by Wolfe's algorithm for the nearest point of a convex set that is known by its
support function: nothing of the checker, and none of its bounds. TOLERANCE covers doubles. By default 12 queries, 6 mutants, seed 3.
"""
import itertools
import math
import os
import random
import re
import struct
import subprocess
import sys
import tempfile
from copy import copy

TOLERANCE = 1e-8
TIMES = 12


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def add(a, b, s=1.0):
    return [a[k] + s * b[k] for k in range(3)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def norm(a):
    return math.sqrt(dot(a, a))


# ---- quaternions w, x, y, z ------------------------------------------------------------------------------------------------


def unit(q):
    length = math.sqrt(sum(x * x for x in q))
    return [x / length for x in q]


def times(p, q):
    v = add(add([p[0] * x for x in q[1:]], q[1:], 0.0), p[1:], q[0])
    return [p[0] * q[0] - dot(p[1:], q[1:])] + add(v, cross(p[1:], q[1:]))


def turn(q, v):
    once = cross(q[1:], v)
    return add(add(v, once, 2.0 * q[0]), cross(q[1:], once), 2.0)


def turn_back(q, v):
    return turn([q[0], -q[1], -q[2], -q[3]], v)


class Pose:
    def __init__(self, position=(0.0, 0.0, 0.0), quaternion=(1.0, 0.0, 0.0, 0.0)):
        self.p, self.q = list(position), unit(quaternion)

    def then(self, inner):
        return Pose(add(self.p, turn(self.q, inner.p)), times(self.q, inner.q))


def slerp(p, q, u):
    """Between unit vectors, the shorter way."""
    along = sum(a * b for a, b in zip(p, q))
    q = [math.copysign(1.0, along) * x for x in q]
    angle = 2.0 * math.asin(min(1.0, math.sqrt(sum((a - b)**2 for a, b in zip(p, q))) / 2.0))
    if angle < 1e-12:
        return p
    return [(math.sin((1 - u) * angle) * a + math.sin(u * angle) * b) / math.sin(angle) for a, b in zip(p, q)]


# ---- the text --------------------------------------------------------------------------------------------------------------


class Words:
    def __init__(self, line):
        self.words = line.split()

    def word(self):
        return self.words.pop(0)

    def number(self):
        return float.fromhex(self.word())

    def numbers(self, n):
        return [self.number() for _ in range(n)]

    def count(self):
        return int(self.word())


SIZES = {'point': 0, 'sphere': 1, 'box': 3, 'capsule': 2, 'cylinder': 2, 'cone': 2, 'ellipsoid': 3, 'halfspace': 4, 'polytope': 0, 'hull': 1,
         'triangles': 0, 'solid': 0, 'points': 1, 'cells': 0}
CORNERS = {'triangles': 3, 'solid': 3, 'points': 1, 'cells': 2}


class Body:
    """PADDING P POSE×P KIND SIZES"""

    def __init__(self, words):
        self.own_margin = words.number()
        self.pose = Pose()
        for _ in range(words.count()):
            x = words.numbers(7)
            self.pose = self.pose.then(Pose(x[:3], x[3:]))
        self.kind = words.word()
        self.size = words.numbers(SIZES[self.kind])
        self.vertices = [words.numbers(3)] if self.kind in ('point', 'polytope', 'hull') else []
        if self.kind in ('polytope', 'hull'):
            centre = self.vertices[0]
            self.vertices = [add(centre, words.numbers(3)) for _ in range(words.count())]
        self.elements = self.read_elements(words) if self.kind in CORNERS else []

    def read_elements(self, words):
        """Each is a body of its own, with a ball about it."""
        centre, found = words.numbers(3), []
        for _ in range(words.count()):
            corners = [add(centre, words.numbers(3)) for _ in range(CORNERS[self.kind])]
            one = copy(self)
            one.elements, one.kind = [], 'hull' if self.kind == 'points' else 'polytope'
            one.vertices = [list(p) for p in itertools.product(*zip(*corners))] if self.kind == 'cells' else corners
            one.middle = [sum(v[k] for v in one.vertices) / len(one.vertices) for k in range(3)]
            one.radius = max(norm(add(v, one.middle, -1.0)) for v in one.vertices)
            found.append(one)
        return found

    def holds(self, p):
        """Whether a closed mesh winds round a point of its frame, by solid angles."""
        if self.kind != 'solid':
            return False
        total = 0.0
        for one in self.elements:
            a, b, c = (add(v, p, -1.0) for v in one.vertices)
            la, lb, lc = norm(a), norm(b), norm(c)
            volume = dot(a, cross(b, c))
            total += 2 * math.atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
        return abs(total) > 2 * math.pi

    def margin(self):
        """Of a ball that is added to the rest."""
        return self.own_margin + {'sphere': lambda s: s[0], 'capsule': lambda s: s[1], 'hull': lambda s: s[0]}.get(self.kind, lambda s: 0.0)(self.size)

    def farthest(self, d):
        """The point of the rest that is farthest along d, in the body's own frame."""
        s = self.size
        if self.vertices:
            return max(self.vertices, key=lambda v: dot(v, d))
        if self.kind == 'sphere':
            return [0.0, 0.0, 0.0]
        if self.kind == 'box':
            return [math.copysign(s[k], d[k]) for k in range(3)]
        if self.kind == 'ellipsoid':
            length = norm([s[k] * d[k] for k in range(3)])
            return [s[k] * s[k] * d[k] / length for k in range(3)]
        if self.kind == 'capsule':
            return [0.0, 0.0, math.copysign(s[0], d[2])]
        across = math.hypot(d[0], d[1])
        rim = [s[1] * d[0] / across, s[1] * d[1] / across] if across > 0.0 else [s[1], 0.0]
        if self.kind == 'cone' and s[0] * d[2] > s[1] * across - s[0] * d[2]:
            return [0.0, 0.0, s[0]]
        return rim + [-s[0] if self.kind == 'cone' else math.copysign(s[0], d[2])]


class Motion:
    """Some variables, over times of their own that begin later by `start`."""

    def __init__(self, words, lines, start):
        kind = words.word()
        self.spline, self.slerps = kind == 'bspline', kind == 'slerp'
        self.order = words.count()
        self.variables = [words.count() for _ in range(words.count())]
        n = words.count()
        self.times, self.points = [], []
        if self.spline:
            knots = Words(next(lines))
            knots.word()
            self.knots = knots.numbers(n + self.order + 1)
        for _ in range(n):
            w = Words(next(lines))
            w.word()
            if self.spline:
                self.points.append(w.numbers(len(self.variables)))
                continue
            self.times.append(w.number())
            self.points.append([w.numbers(len(self.variables)) for _ in range(w.count())])
        if self.spline:
            self.times = [self.knots[i] for i in range(self.order, n) if self.knots[i] < self.knots[i + 1]] + [self.knots[n]]
        self.clock = [t + start for t in self.times]

    def fill(self, clock, balls, out):
        """Writes its values at a time of the clock. balls: the first variables of quaternions."""
        inside = min(max(clock, self.clock[0]), self.clock[-1])
        segment = max(i for i in range(len(self.clock) - 1) if i == 0 or self.clock[i] <= inside)
        u = (inside - self.clock[segment]) / (self.clock[segment + 1] - self.clock[segment])
        for k, variable in enumerate(self.variables):
            out[variable] = self.on_spline(segment, u, k) if self.spline else self.by_hermite(segment, u, k)
        for v in balls if self.slerps else ():
            if v in self.variables:
                p, q = (unit([self.points[i][0][self.variables.index(v + k)] for k in range(4)]) for i in (segment, segment + 1))
                out[v:v + 4] = slerp(p, q, u)

    def by_hermite(self, segment, u, k):
        p, q, h = self.points[segment], self.points[segment + 1], self.times[segment + 1] - self.times[segment]
        known = self.order or min(len(p), len(q))
        if known == 1:
            return p[0][k] + u * (q[0][k] - p[0][k])
        if known == 2:
            return ((1 + 2 * u) * (1 - u)**2 * p[0][k] + u * (1 - u)**2 * h * p[1][k] + u * u * (3 - 2 * u) * q[0][k] +
                    u * u * (u - 1) * h * q[1][k])
        rise = 10 * u**3 - 15 * u**4 + 6 * u**5
        return ((1 - rise) * p[0][k] + rise * q[0][k] + h * (u - 6 * u**3 + 8 * u**4 - 3 * u**5) * p[1][k] +
                h * (-4 * u**3 + 7 * u**4 - 3 * u**5) * q[1][k] + h * h * (.5 * u**2 - 1.5 * u**3 + 1.5 * u**4 - .5 * u**5) * p[2][k] +
                h * h * (.5 * u**3 - u**4 + .5 * u**5) * q[2][k])

    def on_spline(self, segment, u, k):
        t = (1 - u) * self.times[segment] + u * self.times[segment + 1]
        spans = [i for i in range(self.order, len(self.points)) if self.knots[i] < self.knots[i + 1]]
        span = spans[segment]

        def weight(i, degree):
            if degree == 0:
                return 1.0 if i == span else 0.0
            left, right = self.knots[i + degree] - self.knots[i], self.knots[i + degree + 1] - self.knots[i + 1]
            return ((t - self.knots[i]) / left * weight(i, degree - 1) if left > 0 else 0.0) + (
                (self.knots[i + degree + 1] - t) / right * weight(i + 1, degree - 1) if right > 0 else 0.0)

        return sum(weight(i, self.order) * self.points[i][k] for i in range(span - self.order, span + 1))


class Robot:
    def __init__(self, words, lines, targets):
        self.id = words.word()
        links, parts, variables = words.count(), words.count(), words.count()
        self.links = []
        for _ in range(links):
            w = Words(next(lines))
            w.word()
            parent, kind, x = w.count(), w.word(), w.numbers(10)
            self.links.append((parent, kind, Pose(x[:3], x[3:7]), x[7:], w.count(), w.number(), w.number()))
        self.bodies = []
        for _ in range(parts):
            w = Words(next(lines))
            w.word()
            link = w.count()
            self.bodies.append((link, Body(w)))
        self.bodies += [(-1, target) for target in targets]
        w = Words(next(lines))
        w.word()
        self.pairs = [(w.count(), w.count()) for _ in range(w.count())]
        w = Words(next(lines))
        w.word()
        self.rest = w.numbers(variables)
        w = Words(next(lines))
        w.word()
        self.motions = []
        if w.words[0] != 'joined':
            self.motions.append(Motion(w, lines, 0.0))
        else:
            w.word()
            for _ in range(w.count()):
                start, head = Words(next(lines)), Words(next(lines))
                start.word(), head.word()
                self.motions.append(Motion(head, lines, start.number()))
        self.times = sorted({t for one in self.motions for t in one.clock})

    # ---- its motion ----

    def values(self, segment, u):
        out = list(self.rest)
        balls = [link[4] + 3 for link in self.links if link[1] == 'floating']
        for one in self.motions:
            one.fill((1 - u) * self.times[segment] + u * self.times[segment + 1], balls, out)
        return out

    def poses(self, segment, u):
        """Of all bodies."""
        q = self.values(segment, u)
        frames = []
        for parent, kind, origin, axis, v, multiplier, offset in self.links:
            at = (frames[parent] if parent >= 0 else Pose()).then(origin)
            if kind in ('revolute', 'prismatic'):
                z, value = [x / norm(axis) for x in axis], multiplier * q[v] + offset
                at = at.then(Pose([value * x for x in z]) if kind == 'prismatic' else
                             Pose(quaternion=[math.cos(value / 2)] + [math.sin(value / 2) * x for x in z]))
            elif kind == 'planar':
                at = at.then(Pose([q[v], q[v + 1], 0.0], [math.cos(q[v + 2] / 2), 0.0, 0.0, math.sin(q[v + 2] / 2)]))
            elif kind == 'floating':
                at = at.then(Pose(q[v:v + 3], [q[v + 6]] + q[v + 3:v + 6]))
            frames.append(at)
        return [(frames[link] if link >= 0 else Pose()).then(body.pose) for link, body in self.bodies]


def read_problem(path):
    robots, targets = [], []
    with open(path) as text:
        lines = iter(text.read().splitlines()[1:])
    for line in lines:
        words = Words(line)
        first = words.word()
        if first == 'targets':
            targets = []
        elif first == 'target':
            targets.append(Body(words))
        else:
            robots.append(Robot(words, lines, targets))
    return robots


# ---- distances -------------------------------------------------------------------------------------------------------------


def solve(rows):
    """Gauss with pivots; None where there is no one answer."""
    n = len(rows)
    for i in range(n):
        best = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[best] = rows[best], rows[i]
        if abs(rows[i][i]) < 1e-300:
            return None
        for r in range(n):
            if r != i:
                f = rows[r][i] / rows[i][i]
                rows[r] = [a - f * b for a, b in zip(rows[r], rows[i])]
    return [rows[i][n] / rows[i][i] for i in range(n)]


def affine_weights(points):
    """Of the point nearest to 0 of the flat through the points, sum 1."""
    first, rest = points[0], points[1:]
    edges = [add(p, first, -1.0) for p in rest]
    found = solve([[dot(a, b) for b in edges] + [-dot(a, first)] for a in edges]) if edges else []
    return None if found is None else [1.0 - sum(found)] + found


def nearest(farthest, start):
    """Wolfe: upper bound on the norm of the point nearest to 0 (attained), and a lower one (by support), of a convex set."""
    corral, weights = [farthest(start)], [1.0]
    lower = 0.0
    for _ in range(300):
        v = [sum(w * p[k] for w, p in zip(weights, corral)) for k in range(3)]
        size = norm(v)
        if size < 1e-12:
            return 0.0, 0.0
        p = farthest([-x for x in v])
        lower = max(lower, dot(p, v) / size)
        if size - lower < 1e-10 * (1.0 + size) or p in corral:
            return size, lower
        corral.append(p)
        weights.append(0.0)
        while True:
            best = affine_weights(corral)
            if best is None:  # flat: the newest takes the place of the lightest
                drop = min(range(len(corral) - 1), key=lambda i: weights[i])
                corral.pop(drop)
                weights.pop(drop)
                weights = [w / sum(weights) for w in weights] if sum(weights) > 0 else [1.0 / len(corral)] * len(corral)
                continue
            if min(best) > 1e-14:
                weights = best
                break
            step = min([w / (w - b) for w, b in zip(weights, best) if b <= 1e-14 and w > b] + [1.0])
            weights = [w + step * (b - w) for w, b in zip(weights, best)]
            keep = [i for i in range(len(corral)) if weights[i] > 1e-14] or [len(corral) - 1]
            if len(keep) == len(corral):
                break
            corral, weights = [corral[i] for i in keep], [weights[i] for i in keep]
            weights = [w / sum(weights) for w in weights]
    return size, lower


def to_elements(a, at_a, b, at_b):
    """To the nearest one; those farther than the best one by their balls are left out."""
    some = add(at_a.p, turn(at_a.q, a.farthest([0.3, 0.5, 0.8])))
    if b.holds(turn_back(at_b.q, add(some, at_b.p, -1.0))):
        return -a.margin() - b.own_margin
    way = {one: norm(add(some, add(at_b.p, turn(at_b.q, one.middle)), -1.0)) - one.radius for one in b.elements}
    reach = 2.0 * max(norm(add(a.farthest(d), a.farthest([-x for x in d]), -1.0)) for d in ([1, 0, 0], [0, 1, 0], [0, 0, 1]))
    best = math.inf
    for one in sorted(b.elements, key=way.get):
        if way[one] - reach - a.margin() - one.margin() > best:
            break
        best = min(best, distance(a, at_a, one, at_b))
    return best


def distance(a, at_a, b, at_b):
    """Of two posed bodies, from above: attained but for rounding."""
    if b.elements:
        return to_elements(a, at_a, b, at_b)
    margins = a.margin() + b.margin()
    if b.kind == 'halfspace':
        n = turn(at_b.q, b.size[:3])
        lowest = add(turn(at_a.q, a.farthest(turn_back(at_a.q, [-x for x in n]))), add(at_a.p, at_b.p, -1.0))
        return (dot(n, lowest) + b.size[3]) / norm(n) - margins

    def farthest(d):
        x = add(at_a.p, turn(at_a.q, a.farthest(turn_back(at_a.q, d))))
        y = add(at_b.p, turn(at_b.q, b.farthest(turn_back(at_b.q, [-k for k in d]))))
        return add(x, y, -1.0)

    return nearest(farthest, [0.3, 0.5, 0.8])[0] - margins


# ---- claims ----------------------------------------------------------------------------------------------------------------


def refute(robot, data, claim, delta, chance):
    """A message where the claim is not so."""
    if claim == 'near':
        pair, segment, u = struct.unpack_from('<IId', data, 24)
        moving, standing = robot.pairs[pair]
        poses = robot.poses(segment, u)
        found = distance(robot.bodies[moving][1], poses[moving], robot.bodies[standing][1], poses[standing])
        return f'the distance is {found}' if found > delta + TOLERANCE else None
    for _ in range(TIMES):
        segment, u = chance.randrange(len(robot.times) - 1), chance.random()
        poses = robot.poses(segment, u)
        for moving, standing in robot.pairs:
            found = distance(robot.bodies[moving][1], poses[moving], robot.bodies[standing][1], poses[standing])
            if found < delta - TOLERANCE:
                return f'bodies {moving} and {standing} are {found} apart in segment {segment} at {u}'
    return None


def findings(program, problem, certificates):
    ran = subprocess.run([program, problem, certificates], capture_output=True, text=True)
    if ran.returncode not in (0, 1):
        sys.exit(f'{program} ended with {ran.returncode} on {problem}: {ran.stderr}')
    for line in ran.stdout.splitlines():
        apart, near = re.search(r': proven: farther than (\S+) m', line), re.search(r': proven: not farther than (\S+) m', line)
        yield ('apart', float(apart[1])) if apart else ('near', float(near[1])) if near else None


def records(path):
    with open(path, 'rb') as file:
        data = file.read()
    while data:
        size, = struct.unpack_from('<I', data)
        yield data[4:4 + size]
        data = data[4 + size:]


def main():
    writer, program = sys.argv[1:3]
    queries, mutants, seed = sys.argv[3:6] or ('12', '6', '3')
    chance = random.Random(int(seed))
    tried = refused = 0
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([writer, queries, mutants, seed, folder], check=True, stdout=subprocess.DEVNULL)
        for i in range(int(queries)):
            base = os.path.join(folder, str(i))
            robots = read_problem(base + '.problem')
            found = list(findings(program, base + '.problem', base + '.certificates'))
            if not found or not found[0]:
                faults.append(f'query {i}: the genuine certificate was refused')
            for k, (robot, data, finding) in enumerate(zip(robots, records(base + '.certificates'), found)):
                if not finding:
                    refused += 1
                    continue
                tried += 1
                wrong = refute(robot, data, *finding, chance)
                if wrong:
                    faults.append(f'query {i}, certificate {k}: {finding} was accepted, but {wrong}')
    for fault in faults:
        print('FAILED', fault)
    print(f'robots, looked at in {TIMES} random times: {tried} claims that were accepted, {refused} certificates refused')
    print(f'{tried - len(faults)} passed, {len(faults)} failed')
    return 1 if faults or tried == 0 else 0


if __name__ == '__main__':
    sys.exit(main())
