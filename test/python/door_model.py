# SPDX-License-Identifier: BSD-3-Clause
"""The model of doors.py: which inputs are valid, by a schema of its own, and distances in closed form.

Trees of YAML are Map, list, str, float, int and NULL; of XML [tag, [(attribute, value)], [children]]. Each function takes such
a tree, returns what it holds, and raises Invalid for what must not be 'clear'. A shape is (middle, half sizes or [], radius)
or a list of triangles; a way is (points, radius). It shares no code with the package."""
import math

RADIUS = 0.1  # [m] of the balls of the robot
POST = [0.0, 0.0, 0.5]  # the ball of its base
HARMLESS = ('visual', 'limit')  # what is in these changes no distance


class Map(list):
    """(key, value) pairs in their order: a key may stand twice."""


class Invalid(Exception):
    """What the model does not accept."""


class Null:
    """The value of a key without one, which counts as absent."""


NULL = Null()


def text_of(value):
    if isinstance(value, Map):
        return '{' + ', '.join(f'{key}: {text_of(one)}' for key, one in value) + '}'
    if isinstance(value, list):
        return '[' + ', '.join(text_of(one) for one in value) + ']'
    return '~' if isinstance(value, Null) else value if isinstance(value, str) else repr(value)


def xml_of(element):
    tag, attributes, children = element
    inside = ''.join(xml_of(child) for child in children)
    return f'<{tag}{"".join(f" {name}={chr(34)}{value}{chr(34)}" for name, value in attributes)}>{inside}</{tag}>'


# ------------------------------------------------------------------------------------------------------------- values
def alone(documents):
    if len(documents) != 1:
        raise Invalid('more than one document')
    return documents[0]


def keys_of(value, required=(), optional=()):
    """The map as a dict, if its keys are these and each stands once."""
    if not isinstance(value, Map):
        raise Invalid('no map')
    names = [key for key, _ in value]
    found = {key: one for key, one in value if not isinstance(one, Null)}
    if len(set(names)) < len(names) or not set(names) <= set(required) | set(optional) or not set(required) <= set(found):
        raise Invalid(f'keys {names}')
    return found


def items_of(value):
    if isinstance(value, Map) or not isinstance(value, list):
        raise Invalid('no list')
    return value


def number_of(value):
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise Invalid(f'no number: {value}')
    return float(value)


def word_of(value):
    if not isinstance(value, (str, float)) or ',' in str(value):
        raise Invalid('no word')
    return str(value)


def vector_of(value):
    if isinstance(value, Map):
        found = keys_of(value, 'xyz')
        return [number_of(found[name]) for name in 'xyz']
    if len(items_of(value)) != 3:
        raise Invalid('no vector')
    return [number_of(one) for one in value]


def place_of(pose):
    """The position of a pose; orientations are the identity."""
    found = keys_of(pose, (), ('position', 'orientation'))
    if 'orientation' in found and [number_of(one) for one in items_of(found['orientation'])] != [0, 0, 0, 1]:
        raise Invalid('it turns')
    return vector_of(found.get('position', [0, 0, 0]))


def seconds_of(value):
    if not isinstance(value, Map):
        return number_of(value)
    parts = keys_of(value, (), ('secs', 'nsecs'))
    if not parts:
        raise Invalid('time')
    return number_of(parts.get('secs', 0)) + 1e-9 * number_of(parts.get('nsecs', 0))


def frame_of(value):
    if keys_of(value, (), ('frame_id', 'stamp')).get('frame_id', 'world') != 'world':
        raise Invalid('frame')


# ------------------------------------------------------------------------------------------------------------- scenes
def shape_of(value, at, extra=()):
    found = keys_of(value, ('type', 'dimensions'), extra)
    sizes = [number_of(size) for size in items_of(found['dimensions'])]
    if found['type'] not in (1, 2, 'box', 'sphere') or min(sizes, default=0) <= 0:
        raise Invalid('shape')
    is_box = found['type'] in (1, 'box')
    if len(sizes) != (3 if is_box else 1):
        raise Invalid('dimensions')
    return (at, [size / 2 for size in sizes], 0.0) if is_box else (at, [], sizes[0])


def allowed_of(matrix):
    """The pairs of names that the matrix allows, and those that it forbids, as frozensets; of one name: with all others."""
    found = keys_of(matrix, (), ('entry_names', 'entry_values', 'default_entry_names', 'default_entry_values'))
    names, rows = (items_of(found.get(key, [])) for key in ('entry_names', 'entry_values'))
    standing, values = (items_of(found.get(key, [])) for key in ('default_entry_names', 'default_entry_values'))
    if len(names) != len(rows) or len(standing) != len(values):
        raise Invalid('matrix')
    entries = [(word_of(name), word_of(name), value) for name, value in zip(standing, values)]
    for i, row in enumerate(rows):
        row = items_of(row)
        if len(row) != len(names):
            raise Invalid('row')
        entries += [(word_of(names[i]), word_of(names[k]), row[k]) for k in range(len(row)) if k != i]
    out = {}
    for a, b, value in entries:
        if value not in ('true', 'false') or out.setdefault(frozenset((a, b)), value) != value:
            raise Invalid('entry')
    return out


def scene_of(documents, mesh=None):
    """The objects by id, lists of shapes; and the matrix. mesh: the triangles of the file that it may name."""
    root = keys_of(alone(documents), (), ('name', 'world', 'is_diff', 'allowed_collision_matrix'))
    if not root:
        raise Invalid('no scene')
    if 'is_diff' in root and root['is_diff'] not in ('true', 'false'):
        raise Invalid('is_diff')
    if 'name' in root and not isinstance(root['name'], str):
        raise Invalid('name')
    objects = {}
    world = keys_of(root.get('world', Map()), (), ('collision_objects',))
    for entry in items_of(world.get('collision_objects', [])):
        one = keys_of(entry, ('id',), ('primitives', 'primitive_poses', 'header', 'pose', 'meshes'))
        if word_of(one['id']) in objects:
            raise Invalid('id')
        if 'header' in one:
            frame_of(one['header'])
        shapes, meshes = items_of(one.get('primitives', [])), items_of(one.get('meshes', []))
        poses = items_of(one.get('primitive_poses', []))
        base = place_of(one['pose']) if 'pose' in one else [0, 0, 0]
        if not shapes + meshes or poses and len(poses) != len(shapes):
            raise Invalid('poses')
        found = []
        for i, shape in enumerate(shapes):
            at = place_of(poses[i]) if poses else [0, 0, 0]
            found.append(shape_of(shape, [a + b for a, b in zip(base, at)]))
        for shape in meshes:
            kept = keys_of(shape, ('resource',), ('solid',))
            if mesh is None or kept['resource'] != mesh.name or kept.get('solid', 'false') not in ('true', 'false'):
                raise Invalid('mesh')
            found.append(mesh.at(base, kept.get('solid') == 'true'))
        objects[one['id']] = found
    return objects, allowed_of(root.get('allowed_collision_matrix', Map()))


# ------------------------------------------------------------------------------------------------------------- motions
def trajectory_of(documents):
    """Where the ball is at the points."""
    root = keys_of(alone(documents), ('joint_trajectory',), ('interpolation', 'fixed_joints'))
    if root.get('interpolation', 'linear') != 'linear':
        raise Invalid('interpolation')
    still = keys_of(root.get('fixed_joints', Map()), (), ('right', 'ahead'))
    way = keys_of(root['joint_trajectory'], ('joint_names', 'points'), ('header',))
    if 'header' in way and not isinstance(keys_of(way['header'], (), ('frame_id', 'stamp')).get('frame_id', ''), str):
        raise Invalid('frame')
    names = [word_of(name) for name in items_of(way['joint_names'])]
    if not names or len(set(names)) < len(names) or not set(names) <= {'right', 'ahead'}:
        raise Invalid('names')
    places, before = [], -math.inf
    for point in items_of(way['points']):
        one = keys_of(point, ('positions', 'time_from_start'))
        values = [number_of(value) for value in items_of(one['positions'])]
        moment = seconds_of(one['time_from_start'])
        if len(values) != len(names) or not moment > before:
            raise Invalid('point')
        before = moment
        place = {name: number_of(value) for name, value in still.items()}
        place.update(zip(names, values))
        places.append([place.get('right', 0.0), place.get('ahead', 0.0), 0.0])
    if not places or len(places) == 1 and before != 0:
        raise Invalid('no points')
    return places


def path_of(documents):
    """Where a nav_msgs/Path leads. Stamps say when, not where: they may be anything."""
    root = keys_of(alone(documents), ('poses',), ('header',))
    frame_of(root.get('header', Map()))
    out = []
    for entry in items_of(root['poses']):
        one = keys_of(entry, ('pose',), ('header',))
        frame_of(one.get('header', Map()))
        pose = keys_of(one['pose'], (), ('position', 'orientation'))  # how the ball turns is all the same
        out.append(vector_of(pose.get('position', [0, 0, 0])))
    if not out:
        raise Invalid('no poses')
    return out


def curve_of(header, fields):
    """A row of CSV: a straight line, and the radius."""
    known = ['id', 'basis', 'degree', 't0', 't1', 'radius', 'n', 'x0', 'y0', 'z0', 'x1', 'y1', 'z1']
    for i, name in enumerate(header):  # names of knots and parameters are free
        is_free = i > 6 and not (name[:1] in ('x', 'y', 'z') and name[1:].isdigit())
        if not is_free and (i >= len(known) or name != known[i]):
            raise Invalid('header')
    while fields and not fields[-1]:
        fields = fields[:-1]
    try:
        numbers = [float(one) for one in fields[2:]]
    except ValueError:
        raise Invalid('number') from None
    if len(fields) != 13 or fields[1] != 'bezier' or not all(map(math.isfinite, numbers)):
        raise Invalid('row')
    degree, t0, t1, radius, n = numbers[:5]
    if degree not in (0, 1) or not t0 < t1 or radius < 0 or n != 2:
        raise Invalid('row')
    return [numbers[5:8], numbers[8:]], radius


def pair_of(entry):
    """The distance of a pair, below 0 where it overlaps."""
    one = keys_of(entry, ('id', 'a', 'b'))
    if not isinstance(one['id'], str) or ',' in one['id']:
        raise Invalid('id')
    shapes = []
    for side in 'ab':
        pose = dict(one[side]).get('pose', NULL) if isinstance(one[side], Map) else NULL
        shapes.append(shape_of(one[side], [0, 0, 0] if isinstance(pose, Null) else place_of(pose), ('pose',)))
    (a, half, r), (b, other, s) = shapes
    half, other = half or [0, 0, 0], other or [0, 0, 0]
    apart = [abs(x - y) - h - o for x, y, h, o in zip(a, b, half, other)]
    outside = math.sqrt(sum(max(0.0, one) ** 2 for one in apart))
    return (outside or min(0.0, max(apart))) - r - s


def disabled_of(srdf):
    """The pairs that an SRDF disables. Anything else in it takes no pair away."""
    out = set()
    for tag, attributes, _ in srdf[2]:
        if tag == 'disable_collisions' and srdf[0] == 'robot':
            out.add(frozenset(value for name, value in attributes if name in ('link1', 'link2')))
    return out


# ------------------------------------------------------------------------------------------------------------- meshes
class Mesh:
    """The triangles of a mesh file, read by rules of its own; `name` of the file."""

    def __init__(self, name, lines, unit=1.0):
        self.name, self.unit, self.triangles = name, unit, []
        (self._obj if name.endswith('.obj') else self._stl)(lines)
        if not self.triangles:
            raise Invalid('no triangle')
        self.triangles = [[[x * unit for x in corner] for corner in one] for one in self.triangles]

    @staticmethod
    def _vertex(words):
        try:
            out = [float(word) for word in words]
        except ValueError:
            raise Invalid('vertex') from None
        if len(out) != 3 or not all(map(math.isfinite, out)):
            raise Invalid('vertex')
        return out

    def _obj(self, lines):
        vertices, faces = [], []
        for line in lines:
            word, *rest = line.split()
            if word == 'v':
                vertices.append(self._vertex(rest))
            elif word == 'f' and len(rest) == 3 and all(one.lstrip('-').isdigit() and int(one) for one in rest):
                faces.append([int(one) - 1 if int(one) > 0 else len(vertices) + int(one) for one in rest])
                if min(faces[-1]) < 0:
                    raise Invalid('index')
            elif word not in ('o', '#'):
                raise Invalid(word)
        for face in faces:
            if max(face) >= len(vertices):
                raise Invalid('index')
            self.triangles.append([vertices[i] for i in face])

    def _stl(self, lines):
        """Facets of three vertices; other words than those of the format are skipped."""
        solid, corners = False, None  # corners: of an open facet
        for line in lines:
            word, *rest = line.lower().split()
            if word == 'solid' and not solid:
                solid, corners = True, None
            elif not solid:
                raise Invalid('outside of a solid')
            elif word == 'vertex':
                if corners is None or len(corners) == 3:
                    raise Invalid('outside of a facet')
                corners.append(self._vertex(rest))
            elif word in ('facet', 'endfacet', 'endsolid'):
                if corners is not None and len(corners) != 3:
                    raise Invalid('facet')
                self.triangles += [corners] if corners else []
                corners = [] if word == 'facet' else None
                solid = word != 'endsolid'
        if solid:
            raise Invalid('no end')

    def at(self, base, solid):
        """Its triangles there. solid: with the box about them, unless they are closed and bound something else."""
        moved = [[[a + b for a, b in zip(base, corner)] for corner in one] for one in self.triangles]
        corners = [corner for one in moved for corner in one]
        low, high = ([f(corner[i] for corner in corners) for i in range(3)] for f in (min, max))
        box = ([(a + b) / 2 for a, b in zip(low, high)], [(b - a) / 2 for a, b in zip(low, high)], 0.0)
        edges = [(tuple(one[k]), tuple(one[(k + 1) % 3])) for one in moved for k in range(3)]
        is_closed = sorted(edges) == sorted((b, a) for a, b in edges)
        on_faces = all(any(len({corner[i] for corner in one}) == 1 and one[0][i] in (low[i], high[i]) for i in range(3)) for one in moved)
        return {'triangles': moved, 'inside': box if solid and (on_faces or not is_closed) else None}


# ------------------------------------------------------------------------------------------------------------- distances
def point_to_box(p, shape):
    middle, half, radius = shape
    apart = [max(0.0, abs(a - b) - (half[i] if half else 0.0)) for i, (a, b) in enumerate(zip(p, middle))]
    return max(0.0, math.sqrt(sum(a * a for a in apart)) - radius)


def point_to_triangle(p, triangle):
    """By the regions of the triangle's edges: the foot in the plane, else the nearest of three segments."""
    a, b, c = triangle

    def minus(u, v):
        return [x - y for x, y in zip(u, v)]

    def dot(u, v):
        return sum(x * y for x, y in zip(u, v))

    def to_segment(u, v):
        along = minus(v, u)
        t = min(1.0, max(0.0, dot(minus(p, u), along) / (dot(along, along) or 1.0)))
        return math.dist(p, [x + t * y for x, y in zip(u, along)])

    ab, ac, ap = minus(b, a), minus(c, a), minus(p, a)
    g11, g12, g22 = dot(ab, ab), dot(ab, ac), dot(ac, ac)
    det = g11 * g22 - g12 * g12
    if det > 1e-12 * g11 * g22:
        s, t = ((g22 * dot(ab, ap) - g12 * dot(ac, ap)) / det, (g11 * dot(ac, ap) - g12 * dot(ab, ap)) / det)
        if s >= 0 and t >= 0 and s + t <= 1:
            return math.dist(p, [x + s * y + t * z for x, y, z in zip(a, ab, ac)])
    return min(to_segment(a, b), to_segment(b, c), to_segment(c, a))


def parts_of(shape):
    """Functions of a point, each convex, whose least value is the distance to the shape."""
    if not isinstance(shape, dict):
        return [lambda p: point_to_box(p, shape)]
    out = [lambda p, one=one: point_to_triangle(p, one) for one in shape['triangles']]
    return out + [lambda p: point_to_box(p, shape['inside'])] if shape['inside'] else out


def distance_of(places, radius, shapes):
    """The least distance of a ball along straight lines to the shapes: convex along each line, so thirds find it."""
    least = math.inf
    for a, b in zip(places, places[1:]) if len(places) > 1 else [(places[0], places[0])]:
        for part in (part for shape in shapes for part in parts_of(shape)):
            low, high = 0.0, 1.0
            if a != b:
                for _ in range(60):
                    s, t = low + (high - low) / 3, high - (high - low) / 3
                    at = [part([x + u * (y - x) for x, y in zip(a, b)]) for u in (s, t)]
                    low, high = (low, t) if at[0] <= at[1] else (s, high)
            ends = [part([x + u * (y - x) for x, y in zip(a, b)]) for u in (low, 0.0, 1.0)]
            least = min(least, max(0.0, min(ends) - radius))
    return least


def truth_of(places, scene, post):
    """Of the robot: how near its balls come to objects that they may not touch; inf if to none."""
    objects, matrix = scene
    least = math.inf
    for link, way in [('tip', places)] + ([('base', [POST])] if post else []):
        for name, shapes in objects.items():
            entry = matrix.get(frozenset((link, name)))
            defaults = [matrix.get(frozenset((one,))) for one in (link, name)]
            if entry == 'true' or entry is None and 'true' in defaults and 'false' not in defaults:
                continue
            least = min(least, distance_of(way, RADIUS, shapes))
    return least


def truth_of_self(places, scene, post, disabled):
    """How near the balls come to each other."""
    entry = scene[1].get(frozenset(('tip', 'base')))
    defaults = [scene[1].get(frozenset((one,))) for one in ('tip', 'base')]
    allowed = entry == 'true' or entry is None and 'true' in defaults and 'false' not in defaults
    if not post or allowed or frozenset(('tip', 'base')) in disabled:
        return math.inf
    return distance_of(places, RADIUS, [(POST, [], RADIUS)])
