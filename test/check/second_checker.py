#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A second checker of certificates, in rational arithmetic: what cprox_check says is held against it.

It was written from doc/certificates.md and goes other ways than check/ does: curves are interpolated from their values, and cut
by substitution in powers. Numbers are exact fractions; roots are rounded up, cosines carry an error of 2^-250.

    second_checker.py PROBLEM CERTIFICATES     prints a line a certificate: ID proven|refused [apart|near DELTA | why]
"""
import struct
import sys
from copy import copy
from fractions import Fraction as F
from itertools import product
from math import ceil, comb, isqrt

TINY = F(1, 2 ** 250)


class Refused(Exception):
    pass


def require(condition, why):
    if not condition:
        raise Refused(why)


# ---- numbers -----------------------------------------------------------------------------------------------------------

def root_up(x):
    """A fraction that is at least sqrt(x), by less than 2^-200 of it."""
    if x <= 0:
        return F(0)
    shift = max(0, 400 - x.numerator.bit_length() + x.denominator.bit_length())
    shift += shift % 2
    whole = (x.numerator << shift) // x.denominator + 1
    return F(isqrt(whole) + 1, 1 << (shift // 2))


def dyadic(x, bits=300):
    """x rounded to a multiple of 2^-bits."""
    return F(round(x * 2 ** bits), 2 ** bits)


def cos_sin(x):
    """Both within TINY, by Taylor's series about 0 of x / 2^k and the doubling formulas."""
    k = 0
    while abs(x) > F(1, 16):
        x, k = x / 2, k + 1
    x = dyadic(x, 400)
    cosine, sine, term = F(1), F(0), F(1)
    for i in range(1, 80):
        term = dyadic(term * x / i, 400)
        if i % 2:
            sine += term if i % 4 == 1 else -term
        else:
            cosine += term if i % 4 == 0 else -term
    for _ in range(k):
        cosine, sine = dyadic(cosine * cosine - sine * sine, 400), dyadic(2 * cosine * sine, 400)
    return cosine, sine


def dot(a, b):
    return sum((x * y for x, y in zip(a, b)), F(0))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def norm_up(a):
    return root_up(dot(a, a))


# ---- the query --------------------------------------------------------------------------------------------------------

class Words:
    def __init__(self, line):
        self.words, self.at = line.split(), 0

    def word(self):
        self.at += 1
        return self.words[self.at - 1]

    def count(self):
        return int(self.word())

    def number(self):
        text = self.word()
        return F(float.fromhex(text) if 'x' in text else float(text))

    def numbers(self, n):
        return [self.number() for _ in range(n)]


class Curve:
    def __init__(self, words):
        self.basis, self.degree = words.word(), words.count()
        self.t0, self.t1 = words.numbers(2)
        self.points = [words.numbers(3) for _ in range(words.count())]
        self.knots = words.numbers(words.count())

    def span(self, lo, hi, first):
        spans = [r for r in range(self.degree, len(self.points)) if self.knots[r] <= lo and hi <= self.knots[r + 1]
                 and self.knots[r] < self.knots[r + 1]]
        require(spans, 'a knot lies inside a piece')
        return spans[0 if first else -1]

    def weights(self, t, span):
        """psi(t) = sum of weights * points, of the polynomial that holds in the span."""
        n = self.degree
        if self.basis == 'bezier':
            s = (t - self.t0) / (self.t1 - self.t0)
            return [comb(n, i) * s ** i * (1 - s) ** (n - i) for i in range(n + 1)]
        if self.basis == 'polynomial':
            return [t ** i for i in range(n + 1)]
        if self.basis == 'legendre':
            x = (2 * t - self.t0 - self.t1) / (self.t1 - self.t0)
            p = [F(1), x]
            for i in range(1, n):
                p.append(((2 * i + 1) * x * p[i] - i * p[i - 1]) / (i + 1))
            return p[:n + 1]
        if self.basis == 'lagrange':
            w = []
            for i, a in enumerate(self.knots):
                product = F(1)
                for j, b in enumerate(self.knots):
                    if j != i:
                        product *= (t - b) / (a - b)
                w.append(product)
            return w
        u = self.knots  # Cox-de Boor, the span's degree 0 function being 1
        b = [F(int(i == span)) for i in range(len(u) - 1)]
        for k in range(1, n + 1):
            b = [(b[i] * (t - u[i]) / (u[i + k] - u[i]) if b[i] else F(0)) +
                 (b[i + 1] * (u[i + k + 1] - t) / (u[i + k + 1] - u[i + 1]) if b[i + 1] else F(0))
                 for i in range(len(u) - 1 - k)]
        return b

    def jet(self, t):
        """Value and two derivatives of a trigonometric series, within TINY times the sizes."""
        out = [list(self.points[0]), [F(0)] * 3, [F(0)] * 3]
        for m in range(1, self.degree + 1):
            c, s = cos_sin(m * t)
            for k in range(3):
                a, b = self.points[2 * m - 1][k], self.points[2 * m][k]
                out[0][k] += a * c + b * s
                out[1][k] += m * (b * c - a * s)
                out[2][k] -= m * m * (a * c + b * s)
        return out

    def slack(self):
        """What the errors of cosines can do to a point of a piece that is not longer than 8."""
        return TINY * 64 * self.degree ** 2 * sum(sum(abs(x) for x in p) for p in self.points)

    def point(self, t, first):
        """The point at t and how far it may be off."""
        require(self.t0 <= t <= self.t1, 'the parameter lies outside')
        if self.basis == 'trigonometric':
            return self.jet(t)[0], self.slack()
        span = self.span(t, t, first) if self.basis == 'bspline' else 0
        w = self.weights(t, span)
        return [sum((a * p[k] for a, p in zip(w, self.points)), F(0)) for k in range(3)], F(0)

    def piece(self, lo, hi):
        """Powers of s in [0, 1], three coefficients each, and how far the curve may be from them."""
        if self.basis == 'trigonometric':
            return self.series_piece(lo, hi)
        n = self.degree
        span = self.span(lo, hi, True) if self.basis == 'bspline' else 0
        values = []
        for i in range(n + 1):
            w = self.weights(lo + (hi - lo) * F(i, max(n, 1)), span)
            values.append([sum((a * p[k] for a, p in zip(w, self.points)), F(0)) for k in range(3)])
        return [list(c) for c in zip(*(interpolate([v[k] for v in values]) for k in range(3)))], F(0)

    def series_piece(self, lo, hi):
        h, a, b = hi - lo, self.jet(lo), self.jet(hi)
        require(h <= 8, 'a piece is too long')
        axes = []
        for k in range(3):  # the quintic with both ends' values and derivatives by s
            p0, v0, w0, p1, v1, w1 = a[0][k], h * a[1][k], h * h * a[2][k], b[0][k], h * b[1][k], h * h * b[2][k]
            d = p1 - p0 - v0 - w0 / 2
            e, f = v1 - v0 - w0, w1 - w0
            axes.append([p0, v0, w0 / 2, 10 * d - 4 * e + f / 2, -15 * d + 7 * e - f, 6 * d - 3 * e + f / 2])
        sixth = F(0)
        for m in range(1, self.degree + 1):
            u, v = self.points[2 * m - 1], self.points[2 * m]
            uu, vv, uv = dot(u, u), dot(v, v), dot(u, v)
            sixth += m ** 6 * root_up((uu + vv + root_up((uu - vv) ** 2 + 4 * uv ** 2)) / 2)
        return [list(c) for c in zip(*axes)], sixth * h ** 6 / 46080 + 100 * self.slack()


def interpolate(values):
    """The powers of s of the polynomial that has these values at 0, 1/n, …, 1."""
    n = len(values) - 1
    x, d = [F(i, max(n, 1)) for i in range(n + 1)], list(values)
    for k in range(1, n + 1):
        for i in range(n, k - 1, -1):
            d[i] = (d[i] - d[i - 1]) / (x[i] - x[i - k])
    powers = [d[n]]
    for i in range(n - 1, -1, -1):
        powers = [F(0)] + powers
        for k in range(len(powers) - 1):
            powers[k] -= x[i] * powers[k + 1]
        powers[0] += d[i]
    return powers


class Set:
    SIZES = {'point': 0, 'sphere': 1, 'box': 3, 'capsule': 2, 'cylinder': 2, 'cone': 2, 'ellipsoid': 3, 'halfspace': 4,
             'polytope': 0, 'hull': 1, 'curve': 0, 'triangles': 0, 'solid': 0, 'points': 1, 'cells': 0}
    CORNERS = {'triangles': 3, 'solid': 3, 'points': 1, 'cells': 2}

    def __init__(self, words):
        self.margin = words.number()
        self.poses = [(words.numbers(3), words.numbers(4)) for _ in range(words.count())]
        self.kind = words.word()
        self.size = words.numbers(self.SIZES[self.kind])
        if self.kind in ('point', 'polytope', 'hull'):
            centre = words.numbers(3)
            about = [words.numbers(3) for _ in range(words.count())] if self.kind != 'point' else [[F(0)] * 3]
            self.vertices = [[c + x for c, x in zip(centre, v)] for v in about]
        if self.kind == 'curve':
            self.curve = Curve(words)
        self.elements = self.read_elements(words) if self.kind in self.CORNERS else None

    def read_elements(self, words):
        """The vertices of each."""
        centre, found = words.numbers(3), []
        for _ in range(words.count()):
            corners = [words.numbers(3) for _ in range(self.CORNERS[self.kind])]
            if self.kind == 'cells':
                corners = [list(p)[::-1] for p in product(*reversed(list(zip(*corners))))]  # x first
            found.append([[c + x for c, x in zip(centre, v)] for v in corners])
        return found

    def group(self, start, end):
        """The hull of some elements."""
        hull = copy(self)
        hull.kind, hull.size = 'hull', self.size or [F(0)]
        hull.vertices = [v for element in self.elements[int(start):int(end)] for v in element]
        return hull

    def winding(self, p):
        """How often a closed mesh winds round a point of its frame: its triangles that a ray goes through, by signs."""
        require(self.kind == 'solid', 'it is no solid')
        d, total = [F(3, 7), F(-5, 11), F(6, 13)], 0
        for element in self.elements:
            a, b, c = ([x - y for x, y in zip(v, p)] for v in element)
            n = cross([x - y for x, y in zip(b, a)], [x - y for x, y in zip(c, a)])
            facing, height = dot(n, d), dot(n, a)
            if facing == 0 or height / facing < 0:
                continue
            hit = [x * height / facing for x in d]
            sides = [dot(n, cross([x - y for x, y in zip(v, u)], [x - y for x, y in zip(hit, u)]))
                     for u, v in ((a, b), (b, c), (c, a))]
            require(0 not in sides and height != 0, 'the ray or the point meets an edge')
            total += (all(s > 0 for s in sides)) * (1 if facing > 0 else -1)
        return total

    def matrices(self):
        for x, (w, a, b, c) in self.poses:
            n = w * w + a * a + b * b + c * c
            yield x, [[1 - 2 * (b * b + c * c) / n, 2 * (a * b - w * c) / n, 2 * (a * c + w * b) / n],
                      [2 * (a * b + w * c) / n, 1 - 2 * (a * a + c * c) / n, 2 * (b * c - w * a) / n],
                      [2 * (a * c - w * b) / n, 2 * (b * c + w * a) / n, 1 - 2 * (a * a + b * b) / n]]

    def to_frame(self, n):
        far, own = F(0), list(n)
        for x, r in self.matrices():
            far += dot(own, x)
            own = [sum(r[j][k] * own[j] for j in range(3)) for k in range(3)]
        return far, own

    def point_to_frame(self, p):
        own = list(p)
        for x, r in self.matrices():
            d = [a - b for a, b in zip(own, x)]
            own = [sum(r[j][k] * d[j] for j in range(3)) for k in range(3)]
        return own

    def own_normal(self):
        n = self.size[:3]
        for _, r in reversed(list(self.matrices())):
            n = [dot(row, n) for row in r]
        return n

    def reach(self, n):
        """At least max n·x over the body."""
        s, (x, y, z) = self.size, n
        if self.kind in ('point', 'polytope'):
            return max(dot(n, v) for v in self.vertices)
        if self.kind == 'hull':  # of a mesh that may stick out of it
            return max(dot(n, v) for v in self.vertices) + s[0] * norm_up(n)
        if self.kind == 'sphere':
            return s[0] * norm_up(n)
        if self.kind == 'box':
            return sum(a * abs(b) for a, b in zip(s, n))
        if self.kind == 'ellipsoid':
            return norm_up([a * b for a, b in zip(s, n)])
        if self.kind == 'capsule':
            return s[0] * abs(z) + s[1] * norm_up(n)
        if self.kind == 'cylinder':
            return s[0] * abs(z) + s[1] * norm_up([x, y])
        if self.kind == 'cone':
            return max(s[0] * z, s[1] * norm_up([x, y]) - s[0] * z)
        return -s[3]  # a halfspace along its own normal

    def contains(self, p):
        s, (x, y, z) = self.size, p
        if self.kind == 'hull':  # what is in it need not be in the mesh
            return False
        if self.kind == 'sphere':
            return dot(p, p) <= s[0] ** 2
        if self.kind == 'box':
            return all(abs(a) <= b for a, b in zip(p, s))
        if self.kind == 'ellipsoid':
            return sum((a / b) ** 2 for a, b in zip(p, s)) <= 1
        if self.kind == 'capsule':
            return x * x + y * y + max(abs(z) - s[0], F(0)) ** 2 <= s[1] ** 2
        if self.kind == 'cylinder':
            return abs(z) <= s[0] and x * x + y * y <= s[1] ** 2
        if self.kind == 'cone':
            return abs(z) <= s[0] and (x * x + y * y) * 4 * s[0] ** 2 <= (s[1] * (s[0] - z)) ** 2
        return dot(s[:3], p) + s[3] <= 0  # a halfspace


def read_problem(path):
    """The targets, the name, the radius and the curve of each mover."""
    movers, sets = [], []
    with open(path) as lines:
        head = next(lines).split()
        assert head == ['cprox-problem', '1'], head
        for line in lines:
            words = Words(line)
            what = words.word()
            if what == 'targets':
                sets = []
            elif what == 'target':
                sets.append(Set(words))
            elif what == 'mover':
                movers.append((sets, words.word(), words.number(), Curve(words)))
            elif what == 'none':
                movers.append((sets, words.word(), None, None))
    return movers


# ---- certificates --------------------------------------------------------------------------------------------------------

class Bytes:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, form):
        size = struct.calcsize(form)
        require(self.at + size <= len(self.data), 'it is cut off')
        value = struct.unpack_from(form, self.data, self.at)[0]
        self.at += size
        return value

    def count(self):
        return self.take('<I')

    def number(self, form='<d'):
        value = self.take(form)
        require(value == value and abs(value) != float('inf'), 'a number is not finite')
        return F(value)

    def normal(self, width):
        return [self.number('<f' if width == 4 else '<d') for _ in range(3)]


class Pieces:
    def __init__(self, curve, bytes_):
        n = bytes_.count()
        require(1 <= n <= 1 + (len(bytes_.data) - bytes_.at) // 8, 'it is cut off')
        breaks = [curve.t0] + [bytes_.number() for _ in range(n - 1)] + [curve.t1]
        require(all(a < b for a, b in zip(breaks, breaks[1:])), 'the pieces do not follow each other')
        self.pieces = [curve.piece(a, b) for a, b in zip(breaks, breaks[1:])]

    def least(self, n, start, end):
        """At most min n·psi over the part, counted in pieces."""
        best = None
        for i in range(int(start), len(self.pieces)):
            if i >= end:
                break
            powers, error = self.pieces[i]
            s0, s1 = max(start - i, F(0)), min(end - i, F(1))
            c = [dot(n, p) for p in powers]
            for k in range(len(c)):  # s = s0 + (s1 - s0) u
                for j in range(len(c) - 2, k - 1, -1):
                    c[j] += s0 * c[j + 1]
            c = [a * (s1 - s0) ** k for k, a in enumerate(c)]
            degree = len(c) - 1
            b = min(sum(F(comb(j, k), comb(degree, k)) * c[k] for k in range(j + 1)) for j in range(degree + 1))
            b -= error * norm_up(n) if error else 0
            best = b if best is None else min(best, b)
        return best


def separates(set_, mover, normal, part, gap, target=None, other=None):
    n = set_.own_normal() if set_.kind == 'halfspace' else normal
    require(any(n), 'a direction is 0')
    far, own = set_.to_frame(n)
    far += -target.least([-x for x in own], *other) if target else set_.reach(own)
    return mover.least(n, *part) - far - gap * norm_up(n) > 0


def check_apart(sets, radius, curve, bytes_, width, delta, ends=False):
    """ends: it speaks of the curve up to a number of pieces, which stands first."""
    end_of_claim = bytes_.number() if ends else None
    mover = Pieces(curve, bytes_)
    n = end_of_claim if ends else F(len(mover.pieces))
    require(0 < n <= len(mover.pieces), 'it ends outside the curve')
    for set_ in sets:
        gap, kind = delta + radius + set_.margin, bytes_.take('<B')
        require(kind == (2 if set_.kind == 'curve' else 3 if set_.elements else 1), 'another kind of target')
        if kind == 1:
            start = F(0)
            for _ in range(bytes_.count()):
                end, normal = bytes_.number(), bytes_.normal(width)
                require(start < end <= n, 'the parts do not follow each other')
                require(separates(set_, mover, normal, (start, end), gap), 'a direction does not separate')
                start = end
            require(start == n, 'the parts do not cover the curve')
            continue
        target = Pieces(set_.curve, bytes_) if kind == 2 else None
        open_ = [((F(0), n), (F(0), F(len(target.pieces if target else set_.elements))), 0)]
        while open_:
            mine, other, depth = open_.pop()
            tag = bytes_.take('<B')
            require(tag <= 2 and depth <= 256, 'the tree is broken')
            if tag == 0:
                normal = bytes_.normal(width)
                if target:
                    require(separates(set_, mover, normal, mine, gap, target, other), 'a direction does not separate')
                else:
                    require(separates(set_.group(*other), mover, normal, mine, gap), 'a direction does not separate')
                continue
            cut = bytes_.number()
            whole = mine if tag == 1 else other
            require(target or tag == 1 or cut == int(cut), 'a cut lies inside an element')
            require(whole[0] < cut < whole[1], 'a cut lies outside')
            halves = [(whole[0], cut), (cut, whole[1])]
            for half in reversed(halves):
                open_.append((half, other, depth + 1) if tag == 1 else (mine, half, depth + 1))
        for powers, _ in mover.pieces[:ceil(n)] if set_.kind == 'solid' else ():
            require(set_.winding(set_.point_to_frame(powers[0])) == 0, 'a piece begins inside')


def inside_tetrahedron(corners, p):
    def volume(a, b, c, d):
        return dot([x - y for x, y in zip(b, a)], cross([x - y for x, y in zip(c, a)], [x - y for x, y in zip(d, a)]))
    volumes = [volume(*corners)] + [volume(*(corners[:i] + [p] + corners[i + 1:])) for i in range(4)]
    return all(v > 0 for v in volumes) or all(v < 0 for v in volumes)


def check_near_at(sets, radius, curve, bytes_, delta, limits):
    index, t = bytes_.count(), bytes_.number()
    require(index < len(sets), 'no such target')
    set_ = sets[index]
    p, error = curve.point(t, limits[0])
    y, gap = set_.point_to_frame(p), delta + radius + set_.margin - error
    if set_.elements:
        element = bytes_.count()
        if element == 2 ** 32 - 1:
            return require(set_.winding(y) != 0, 'it is not inside')
        require(element < len(set_.elements), 'no such element')
        gap += set_.size[0] if set_.size else 0
        set_ = set_.group(element, element + 1)
        set_.kind = 'polytope'
    if set_.kind == 'curve':
        q, error = set_.curve.point(bytes_.number(), limits[1])
        v, gap = [a - b for a, b in zip(y, q)], gap - error
    elif set_.kind == 'point':
        v = [a - b for a, b in zip(y, set_.vertices[0])]
    elif set_.kind == 'polytope':
        named = [(bytes_.count(), bytes_.number()) for _ in range(4)]
        require(all(i < len(set_.vertices) and w >= 0 for i, w in named), 'no such vertex')
        total, corners = sum(w for _, w in named), [set_.vertices[i] for i, _ in named]
        if total == 0:
            require(inside_tetrahedron(corners, y), 'it is not inside')
            v = [F(0)] * 3
        else:
            v = [y[k] - sum(w * c[k] for (_, w), c in zip(named, corners)) / total for k in range(3)]
    else:
        v = [bytes_.number() for _ in range(3)]
        require(set_.contains([a - b for a, b in zip(y, v)]), 'the point is not in the target')
    require(gap >= 0 and dot(v, v) <= gap ** 2, 'too far apart')


def check_near(sets, radius, curve, bytes_, delta):
    at = bytes_.at
    for limits in ((False, False), (True, False), (False, True), (True, True)):
        bytes_.at = at
        try:
            return check_near_at(sets, radius, curve, bytes_, delta, limits)
        except Refused as refused:
            why = refused
    raise why


def check(sets, radius, curve, data):
    """'apart', 'near', 'before' or 'before and near', and delta; Refused."""
    bytes_ = Bytes(data)
    magic = bytes(bytes_.take('<B') for _ in range(4))
    width, delta, claim, sections = bytes_.count(), bytes_.number(), bytes_.count(), bytes_.count()
    require(magic == b'CPC1' and width in (4, 8) and delta >= 0, 'it is no certificate')
    found = {1: 'apart', 2: 'near', 3: 'before'}.get(claim)
    if claim in (1, 3):
        require(sections == len(sets), 'another number of targets')
        check_apart(sets, radius, curve, bytes_, width, delta, claim == 3)
        if claim == 3 and bytes_.at < len(data):
            meets = bytes_.number()
            require(meets >= 0, 'it is no distance')
            check_near(sets, radius, curve, bytes_, meets)
            found = 'before and near'
    else:
        require(claim == 2, 'it claims nothing that is known')
        check_near(sets, radius, curve, bytes_, delta)
    require(bytes_.at == len(data), 'bytes follow its end')
    return found, delta


def records(path):
    with open(path, 'rb') as file:
        data = file.read()
    at = 0
    while at < len(data):
        size = struct.unpack_from('<I', data, at)[0]
        yield data[at + 4:at + 4 + size]
        at += 4 + size


def main():
    proven = True
    for (sets, name, radius, curve), data in zip(read_problem(sys.argv[1]), records(sys.argv[2])):
        try:
            require(curve, 'there is no such mover')
            claim, delta = check(sets, radius, curve, data)
            print(name, 'proven', claim, float(delta).hex())
        except Refused as why:
            proven = False
            print(name, 'refused', why)
    return 0 if proven else 1


if __name__ == '__main__':
    sys.exit(main())
