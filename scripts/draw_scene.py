# SPDX-License-Identifier: BSD-3-Clause
"""Draws a scene, a robot, a tube coloured by its clearance and the closest pair. Used by scripts/demo."""
import math
import os
import struct
import xml.etree.ElementTree as ElementTree

import numpy as np
import yaml
import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.colors import LinearSegmentedColormap, Normalize  # noqa: E402
from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # noqa: E402

INK, SHELF, CAN, CAN_CLOSEST, ARM, CLOSEST = '#22303c', '#b9a88f', '#7d9fb8', '#35618a', '#dfe3e6', '#d6202b'
CLEARANCE = LinearSegmentedColormap.from_list('clearance', ['#d6202b', '#f39c34', '#f2d64b', '#58a86b', '#2b7a78'])
LIGHT = np.array([-0.45, -0.75, 0.9]) / np.linalg.norm([-0.45, -0.75, 0.9])


# -------------------------------------------------------------------------------------------------------------- poses
def rotation_from_quaternion(q):
    x, y, z, w = np.asarray(q, float) / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def rotation_from_rpy(rpy):
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    return np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                     [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                     [-sp, cp * sr, cp * cr]])


def rotation_about(axis, angle):
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def transform(rotation, translation):
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, translation
    return pose


# ----------------------------------------------------------------------------------------------------------- polygons
def box_faces(size):
    faces = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (-0.5, 0.5):
            face = np.zeros((4, 3))
            face[:, axis] = side * size[axis]
            face[:, u] = np.array([-0.5, 0.5, 0.5, -0.5]) * size[u]
            face[:, v] = np.array([-0.5, -0.5, 0.5, 0.5]) * size[v]
            faces.append(face if side > 0 else face[::-1])
    return faces


def cylinder_faces(height, radius, sides=24):
    angle = np.linspace(0, 2 * np.pi, sides + 1)
    rim = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    low, high = (np.column_stack([rim, np.full(sides + 1, z)]) for z in (-height / 2, height / 2))
    wall = [np.array([low[i], low[i + 1], high[i + 1], high[i]]) for i in range(sides)]
    return wall + [high[:-1], low[:-1][::-1]]


def mesh_faces(path):
    """The triangles of a binary STL file."""
    with open(path, 'rb') as stl:
        data = stl.read()
    count, = struct.unpack_from('<I', data, 80)
    rows = np.frombuffer(data, np.dtype([('normal', '<f4', 3), ('corners', '<f4', (3, 3)), ('_', '<u2')]), count, 84)
    return list(rows['corners'].astype(float))


def tube_faces(points, radius, sides=14):
    """The skin of a tube along sampled points: rings of a frame that does not twist, one list of faces a sample gap."""
    tangents = np.gradient(points, axis=0)
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    across = np.cross(tangents[0], [0, 0, 1.0])
    rings, angle = [], np.linspace(0, 2 * np.pi, sides + 1)
    for point, tangent in zip(points, tangents):
        across = across - tangent * across.dot(tangent)
        across /= np.linalg.norm(across)
        up = np.cross(tangent, across)
        rings.append(point + radius * (np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * up))
    return [[np.array([a[k], a[k + 1], b[k + 1], b[k]]) for k in range(sides)] for a, b in zip(rings, rings[1:])]


def moved(faces, pose):
    return [face @ pose[:3, :3].T + pose[:3, 3] for face in faces]


def shaded(colour, face):
    normal = np.cross(face[1] - face[0], face[2] - face[0])
    length = np.linalg.norm(normal)
    light = 0.62 + 0.38 * max(0.0, normal.dot(LIGHT) / length) if length > 0 else 0.62
    return tuple(light * c for c in matplotlib.colors.to_rgb(colour))


# ----------------------------------------------------------------------------------------------------- what is drawn
def scene_faces(scene_path):
    """(id, type, faces) of each primitive of a scene file."""
    with open(scene_path) as text:
        scene = yaml.safe_load(text)
    for thing in scene['world']['collision_objects']:
        for primitive, pose in zip(thing['primitives'], thing['primitive_poses']):
            size = primitive['dimensions']
            faces = box_faces(size) if primitive['type'] == 'box' else cylinder_faces(*size)
            place = transform(rotation_from_quaternion(pose['orientation']), pose['position'])
            yield thing['id'], primitive['type'], moved(faces, place)


def link_poses(urdf_root, positions):
    """The pose of each link of a URDF at the given joint positions; joints that are not named stand at 0."""
    joints = urdf_root.findall('joint')
    children = {joint.find('child').get('link') for joint in joints}
    poses = {link.get('name'): np.eye(4) for link in urdf_root.findall('link') if link.get('name') not in children}
    while joints:
        waiting = []
        for joint in joints:
            parent = joint.find('parent').get('link')
            if parent not in poses:
                waiting.append(joint)
                continue
            origin = joint.find('origin')
            written = {} if origin is None else origin.attrib
            rpy, xyz = ([float(x) for x in written.get(key, '0 0 0').split()] for key in ('rpy', 'xyz'))
            step = transform(rotation_from_rpy(rpy), xyz)
            value = positions.get(joint.get('name'), 0.0)
            if joint.get('type') in ('revolute', 'continuous', 'prismatic'):
                axis = np.array([float(x) for x in joint.find('axis').get('xyz').split()])
                if joint.get('type') == 'prismatic':
                    step = step @ transform(np.eye(3), value * axis)
                else:
                    step = step @ transform(rotation_about(axis, value), np.zeros(3))
            poses[joint.find('child').get('link')] = poses[parent] @ step
        joints = waiting
    return poses


def robot_faces(urdf_path, positions):
    root = ElementTree.parse(urdf_path).getroot()
    poses = link_poses(root, positions)
    for link in root.findall('link'):
        for mesh in link.iterfind('collision/geometry/mesh'):
            path = os.path.join(os.path.dirname(urdf_path), mesh.get('filename'))
            yield moved(mesh_faces(path), poses[link.get('name')])


def bspline_points(control, degree, knots, parameters):
    """Points of a B-spline by de Boor's recursion."""
    control, points = np.asarray(control, float), []
    for t in parameters:
        span = min(max(np.searchsorted(knots, t, side='right') - 1, degree), len(control) - 1)
        d = [control[span - degree + j] for j in range(degree + 1)]
        for r in range(1, degree + 1):
            for j in range(degree, r - 1, -1):
                i = span - degree + j
                a = (t - knots[i]) / (knots[i + degree - r + 1] - knots[i])
                d[j] = (1 - a) * d[j - 1] + a * d[j]
        points.append(d[degree])
    return np.array(points)


# ------------------------------------------------------------------------------------------------------- the picture
def paint(axes, boards, solids, closest):
    """Puts boards (glass, behind everything), solids (a list of (face, colour)) and the closest pair on 3-D axes."""
    if boards:
        glass = [(*shaded(SHELF, face), 0.16) for face in boards]
        axes.add_collection3d(Poly3DCollection(boards, facecolors=glass, edgecolors=SHELF, linewidths=0.6, zorder=1))

    # One collection for all that is solid: matplotlib orders faces by depth only within one.
    faces, colours = [face for face, _ in solids], [shaded(colour, face) for face, colour in solids]
    axes.add_collection3d(Poly3DCollection(faces, facecolors=colours, edgecolors=colours, linewidths=0.2, zorder=2))
    pair = np.array([closest['a'], closest['b']])
    axes.plot(*pair.T, color=CLOSEST, linewidth=2.4, zorder=10)
    axes.scatter(*pair.T, s=30, color=CLOSEST, edgecolors='white', linewidths=0.9, zorder=11, depthshade=False)
    axes.set_proj_type('persp')
    axes.set_axis_off()


def frame(axes, low, high, zoom):
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_zlim(low[2], high[2])
    axes.set_box_aspect(high - low, zoom=zoom)


def draw(out, scene_path, urdf_path, positions, centre_line, radius, clearance, closest, title):
    """centre_line: n+1 samples; clearance: n values [m], one for each gap between them; closest: the pair as a dictionary
    of points a and b, name, t, distance."""
    colour_of = Normalize(0.0, 1e3 * max(clearance))
    boards, solids = [], []
    for name, kind, faces in scene_faces(scene_path):
        if kind == 'box' and name != closest['name']:
            boards.extend(faces)
        else:
            solids.extend((face, CAN_CLOSEST if name == closest['name'] else CAN) for face in faces)
    for faces in robot_faces(urdf_path, positions):
        solids.extend((face, ARM) for face in faces)
    for faces, value in zip(tube_faces(centre_line, radius), clearance):
        solids.extend((face, CLEARANCE(colour_of(1e3 * value))) for face in faces)

    # The whole scene.
    figure = plt.figure(figsize=(12, 8), dpi=110)
    axes = figure.add_axes([-0.02, -0.12, 0.78, 1.2], projection='3d', computed_zorder=False)
    paint(axes, boards, solids, closest)
    corners = np.concatenate(boards + [face for face, _ in solids])
    frame(axes, corners.min(axis=0), corners.max(axis=0), 1.22)
    axes.view_init(elev=16, azim=-84)

    # The closest pair, enlarged, along the direction in which the gap is seen at its full width.
    middle, gap = (np.add(closest['a'], closest['b'])) / 2, np.subtract(closest['a'], closest['b'])
    reach = 0.1
    near = [(face, colour) for face, colour in solids if np.linalg.norm(face.mean(axis=0) - middle) < reach]
    lens = figure.add_axes([0.70, 0.29, 0.31, 0.46], projection='3d', computed_zorder=False)
    paint(lens, [], near, closest)
    frame(lens, middle - reach, middle + reach, 1.45)
    lens.view_init(elev=18, azim=math.degrees(math.atan2(gap[1], gap[0])) - 90)

    # Words, and what the colours mean.
    figure.text(0.715, 0.90, title, fontsize=14, color=INK, weight='bold', va='top', linespacing=1.3)
    words = f"closest to {closest['name']}:\n{1e3 * closest['distance']:.3f} mm at t = {closest['t']:.4f}"
    figure.text(0.715, 0.255, words, fontsize=13, color=CLOSEST, weight='bold', va='top', linespacing=1.4)
    bar_axes = figure.add_axes([0.715, 0.11, 0.25, 0.022])
    bar = figure.colorbar(matplotlib.cm.ScalarMappable(colour_of, CLEARANCE), cax=bar_axes, orientation='horizontal')
    bar.outline.set_visible(False)
    bar.set_label('certified clearance of the tube [mm]', color=INK, fontsize=11)
    figure.savefig(out, facecolor='white')
    plt.close(figure)
