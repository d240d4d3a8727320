# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the node share: messages by one call each, and the services of the node under test."""
import io
import itertools
import math
import os
import re
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xmlrpc.client

import actionlib
import numpy
import rosgraph
import rospy
import rostest
import rosunit.xmlrunner
from curve_proximity import srv
from curve_proximity.msg import Body, CollisionObject, Curve, Hyperquadric, PoseTrajectory, ProximityQuery, Waypoint
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, Transform, TransformStamped, Vector3
from nav_msgs.msg import Path
from rosgraph.network import parse_http_host_and_port as host_and_port  # of services, too
from sensor_msgs.msg import JointState, PointCloud2, PointField
from shape_msgs.msg import Mesh, MeshTriangle, Plane, SolidPrimitive
from std_msgs.msg import Header
from trajectory_msgs.msg import (JointTrajectory, JointTrajectoryPoint, MultiDOFJointTrajectory,
                                 MultiDOFJointTrajectoryPoint)
from visualization_msgs.msg import MarkerArray

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..')
sys.path.append(os.path.join(ROOT, 'scripts'))
from free_port import free_port  # noqa: E402,F401 (for the tests that start masters)

BOX, SPHERE, CYLINDER, CONE = 1, 2, 3, 4
ARM = os.path.join(ROOT, 'test', 'ros', 'data', 'arm.urdf')


class ActionClient(actionlib.SimpleActionClient):
    """A client whose server is there. What comes of a goal while send_goal() works waits until it is done. actionlib drops it, and the
    goal never ends."""

    def __init__(self, name, action):
        self.sending = threading.RLock()
        super().__init__(name, action)
        assert self.wait_for_server(rospy.Duration(20)), 'there is no action ' + name

    def send_goal(self, *arguments, **options):
        with self.sending:
            super().send_goal(*arguments, **options)

    def _handle_transition(self, handle):
        with self.sending:
            super()._handle_transition(handle)


def keep_failed_subtest(result, test, subtest, failure):
    """rosunit counts a subtest that fails, and then reports its test as passed: here it fails as its test would."""
    if failure:
        (result.addFailure if issubclass(failure[0], test.failureException) else result.addError)(subtest, failure)


def run(name):
    """Runs all test cases of the script that calls this, as the rostest of that name."""
    rosunit.xmlrunner._XMLTestResult.addSubTest = keep_failed_subtest
    rospy.init_node(name)
    rostest.rosrun('curve_proximity', name, '__main__')


def point(p):
    return Point(*[float(c) for c in p])


def pose(position=(0, 0, 0), orientation=(0, 0, 0, 1)):
    return Pose(point(position), Quaternion(*[float(c) for c in orientation]))


def turned(angle, axis=(0, 0, 1)):
    """The orientation after a turn by so many radians about a unit axis."""
    return (*[math.sin(angle / 2) * c for c in axis], math.cos(angle / 2))


def waypoint(time, position, orientation=(0, 0, 0, 1)):
    return Waypoint(time, pose(position, orientation))


def moving(thing, *waypoints, **fields):
    thing.trajectory = PoseTrajectory(waypoints=list(waypoints), **fields)
    return thing


def bezier(*points, frame='', stamp=None, **fields):
    """A Bezier curve; further fields of the message by name."""
    header = Header(frame_id=frame, stamp=stamp or rospy.Time())
    return Curve(**dict(dict(header=header, basis='bezier', points=[point(p) for p in points]), **fields))


LINE = bezier((-1, 0, 1), (1, 0, 1))


def bspline(points, degree, knots=None, **fields):
    """A B-spline; clamped uniform knots where none are given."""
    n = len(points)
    inner = n - degree - 1
    if knots is None:
        knots = [0.0] * (degree + 1) + [(i + 1.0) / (inner + 1) for i in range(inner)] + [1.0] * (degree + 1)
    return bezier(*points, basis='bspline', degree=degree, knots=knots, **fields)


def thing(name, position=(0, 0, 0), frame='', **fields):
    """An object without shapes."""
    header = Header(frame_id=frame)
    return CollisionObject(**dict(dict(header=header, id=name, pose=pose(position), operation=CollisionObject.ADD), **fields))


def solid(name, kind, dimensions, position=(0, 0, 0), **fields):
    return thing(name, position, primitives=[SolidPrimitive(type=kind, dimensions=[float(d) for d in dimensions])],
                 **fields)


def sphere(name, radius, position=(0, 0, 0), **fields):
    return solid(name, SPHERE, [radius], position, **fields)


def box(name, size, position=(0, 0, 0), **fields):
    return solid(name, BOX, size, position, **fields)


def body(name, kind, dimensions=(), vertices=(), position=(0, 0, 0), values=(), **fields):
    """values: of a height field or a grid of distances."""
    return thing(name, position, bodies=[Body(type=kind, dimensions=[float(d) for d in dimensions],
                                              vertices=[point(v) for v in vertices], values=values)], **fields)


def implicit(name, hyperquadrics=(), planes=(), quadrics=(), position=(0, 0, 0), **fields):
    """The intersection of hyperquadrics, each a list of terms of five, planes of four and quadrics of ten numbers."""
    def flat(rows):
        return [float(x) for row in rows for x in row]
    return thing(name, position, bodies=[Body(type='implicit', planes=flat(planes), quadrics=flat(quadrics),
                                              hyperquadrics=[Hyperquadric(terms=flat(h)) for h in hyperquadrics])],
                 **fields)


def mesh(name, vertices, triangles, position=(0, 0, 0), **fields):
    return thing(name, position, meshes=[Mesh(triangles=[MeshTriangle(vertex_indices=t) for t in triangles],
                                              vertices=[point(v) for v in vertices])], **fields)


def plane(name, coefficients, **fields):
    return thing(name, planes=[Plane(coef=[float(c) for c in coefficients])], **fields)


def query(curves=(), trajectory=None, **fields):
    """What services and the action are asked: curves, perhaps one trajectory, and further fields."""
    if trajectory is not None:
        fields['trajectories'] = [trajectory]
    return ProximityQuery(curves=list(curves) if isinstance(curves, (list, tuple)) else [curves], **fields)


def joints(**positions):
    return JointState(name=list(positions), position=list(positions.values()))


def cloud(points, frame='', order='<', kind='f', names='xyz', padding=0, width=None, stamp=None):
    """A PointCloud2 of rows of `width` points, `padding` bytes behind each point and each row."""
    size = {'f': 4, 'd': 8}[kind]
    values = numpy.asarray(points, dtype='%s%s%d' % (order, 'f', size)).reshape(-1, 3)
    width = width or len(values)
    step = 3 * size + padding
    out = PointCloud2(height=len(values) // width if width else 0, width=width, is_bigendian=order == '>', point_step=step,
                      row_step=step * width + padding, is_dense=False)
    out.fields = [PointField(name, i * size, PointField.FLOAT32 if kind == 'f' else PointField.FLOAT64, 1) for i, name in enumerate(names)]
    out.header.frame_id, out.header.stamp = frame, stamp or rospy.Time()
    data = numpy.full((out.height, out.row_step), 255, numpy.uint8)
    each = data[:, :step * width].reshape(len(values), step)
    each[:, :3 * size] = values.view(numpy.uint8).reshape(len(values), 3 * size)
    data[:, :step * width] = each.reshape(out.height, step * width)
    out.data = data.tobytes()
    return out


def transform(parent, child, translation=(0, 0, 0), stamp=None, turn=0.0):
    """turn: about z."""
    return TransformStamped(Header(frame_id=parent, stamp=stamp or rospy.Time()), child,
                            Transform(Vector3(*translation), Quaternion(*turned(turn))))


MASK = 2**64 - 1


def fingerprint(message):
    """As include/curve_proximity/fingerprint.hpp documents it."""
    data = b'\0\0\0\0' + serialized(message)[4:]
    value = 0xcbf29ce484222325 ^ len(data)
    data += b'\0' * (-len(data) % 8)
    for word, in struct.iter_unpack('<Q', data):
        value = ((value ^ word) * 0x9e3779b97f4a7c15) & MASK
        value ^= value >> 29
    return value


def path(*points, frame='', orientations=None):
    """The poses have no orientation where none are given."""
    poses = [PoseStamped(pose=pose(*at)) for at in zip(points, orientations or itertools.repeat((0, 0, 0, 0)))]
    return Path(Header(frame_id=frame), poses)


def joint_trajectory(names, *rows, times=None):
    """A point a second where no times are given."""
    return JointTrajectory(joint_names=names, points=[
        JointTrajectoryPoint(positions=row, time_from_start=rospy.Duration(t)) for row, t in zip(rows, times or itertools.count())])


def free_flight(name, *points, times=None, orientations=None):
    """A point a second where no times are given, not turned where no orientations are."""
    return MultiDOFJointTrajectory(joint_names=[name], points=[
        MultiDOFJointTrajectoryPoint(transforms=[Transform(Vector3(*at), Quaternion(*turn))], time_from_start=rospy.Duration(t))
        for at, turn, t in zip(points, orientations or itertools.repeat(turned(0)), times or itertools.count())])


SERVICES = {'distance': srv.Distance, 'tolerance': srv.Tolerance, 'collision': srv.Collision, 'violations': srv.ListViolations,
            'clearance_profile': srv.ClearanceProfile, 'nearest_pairs': srv.NearestPairs, 'time_of_contact': srv.TimeOfContact,
            'measure_pairs': srv.MeasurePairs, 'evaluate_constraints': srv.EvaluateConstraints, 'speed_limits': srv.LimitSpeed,
            'margins': srv.ListMargins, 'swept_volume': srv.SweepVolume, 'collision_matrix': srv.ListLinkPairs,
            'apply_scene': srv.ApplyScene, 'get_scene': srv.GetScene}


class Server:
    """The services of one node, by persistent connections."""

    def __init__(self, name='/curve_proximity', timeout=20.0):
        self._name, self._timeout, self._services = name, timeout, {}
        for which in ('distance', 'tolerance', 'collision', 'apply_scene', 'get_scene'):
            self._connect(which)

    def _connect(self, which):
        rospy.wait_for_service(self._name + '/' + which, self._timeout)
        self._services[which] = rospy.ServiceProxy(self._name + '/' + which, SERVICES[which], persistent=True)

    def ask(self, which, **fields):
        """The answer of a service; fields: of the request."""
        if which not in self._services:
            self._connect(which)
        return self._services[which](**fields)

    def distance(self, curves, **fields):
        return self.ask('distance', query=query(curves, **fields))

    def tolerance(self, curves, delta, **fields):
        return self.ask('tolerance', query=query(curves, **fields), delta=delta)

    def collision(self, curves, **fields):
        return self.ask('collision', query=query(curves, **fields))

    def apply(self, *objects, **fields):
        return self.ask('apply_scene', objects=list(objects), **fields)

    def replace(self, *objects, **fields):
        """The scene holds these objects and nothing else."""
        response = self.apply(*objects, clear=True, **fields)
        assert response.success, response.message
        return response

    def scene(self, *ids):
        return self.ask('get_scene', ids=list(ids))


def header(**fields):
    """A TCPROS connection header."""
    entries = b''
    for name, value in fields.items():
        entry = ('%s=%s' % (name, value)).encode()
        entries += struct.pack('<I', len(entry)) + entry
    return struct.pack('<I', len(entries)) + entries


def handshake(**fields):
    return header(**dict(dict(callerid='/hostile', persistent='1'), **fields))


def framed(data, claimed=None):
    return struct.pack('<I', len(data) if claimed is None else claimed) + data


def serialized(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def lying(message):
    """A message whose first count of seven says 2^24."""
    data = serialized(message).replace(struct.pack('<I', 7), struct.pack('<I', 1 << 24), 1)
    return type('Lying', (type(message),), {'serialize': lambda _, buffer: buffer.write(data)})()


class RawClient:
    """A connection to a service that sends bytes."""

    def __init__(self, service, kind, seconds=60):
        address = host_and_port(rosgraph.Master('/test').lookupService(service))
        self.kind = kind
        for more in (2, 1, 0):
            self.connection = socket.create_connection(address, 20)
            self.connection.settimeout(15)
            self.connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.connection.sendall(handshake(service=service, md5sum=kind._md5sum))
            try:
                self._sized()
                break
            except socket.timeout:  # roscpp loses one now and then: doc/ros.md
                self.close()
                if not more:
                    raise
        self.connection.settimeout(seconds)

    def _received(self, size):
        data = bytearray()
        while len(data) < size:
            part = self.connection.recv(size - len(data))
            if not part:
                raise OSError('the connection was closed')
            data += part
        return bytes(data)

    def _sized(self):
        size, = struct.unpack('<I', self._received(4))
        return self._received(size) if size else b''

    def call(self, data):
        """The answer; None where roscpp says that the call failed. Raises OSError where the connection is closed."""
        self.connection.sendall(framed(data))
        good = self._received(1) == b'\1'
        answer = self._sized()
        return self.kind._response_class().deserialize(answer) if good else None

    def close(self):
        self.connection.close()


def raw_call(service, kind, data, seconds=60):
    """One call over a connection of its own; None where it failed, whatever the way."""
    client = RawClient(service, kind, seconds)
    try:
        return client.call(data)
    except OSError:
        return None
    finally:
        client.close()


SHADOW = range(0x7fff7000, 0x10007fff8000)  # of AddressSanitizer on x86-64


def is_sanitized(pid):
    with open('/proc/%d/maps' % pid) as maps:
        return '/libasan.so' in maps.read()


def resident_mb(pid, shadow=False):
    """Without AddressSanitizer's shadow: an eighth of each large block that is freed becomes resident there for a moment."""
    sanitized = is_sanitized(pid) and not shadow
    with open('/proc/%d/%s' % (pid, 'smaps' if sanitized else 'status')) as sizes:
        text = sizes.read()
    if not sanitized:
        return sum(map(int, re.findall(r'VmRSS:\s*(\d+)', text))) / 1024  # none: it has ended
    mappings = re.findall(r'^([0-9a-f]+)-[0-9a-f]+ .*?^Rss: +(\d+)', text, re.M | re.S)
    return sum(int(size) for begin, size in mappings if int(begin, 16) not in SHADOW) / 1024


def peak_mb(node):
    """The most that a node has had resident."""
    pid = xmlrpc.client.ServerProxy(rosgraph.Master('/test').lookupNode(node)).getPid('/test')[2]
    with open('/proc/%d/status' % pid) as status:
        return int(re.search(r'VmHWM:\s*(\d+)', status.read())[1]) / 1024


def cpu_seconds(pid):
    """What a process has computed so far."""
    with open('/proc/%d/stat' % pid) as stat:
        return sum(map(int, stat.read().rsplit(')', 1)[1].split()[11:13])) / os.sysconf('SC_CLK_TCK')


def request_of_points(data):
    """The bytes of a request of ~apply_scene for one body of points; data: theirs, 24 each. No message of all of them is made."""
    texts = [serialized(srv.ApplySceneRequest(objects=[body('big', 'points', vertices=[(0, 0, 0)] * n)])) for n in (0, 1)]
    at = next(i for i, (a, b) in enumerate(zip(*texts)) if a != b)  # where their count stands: what one more changes first
    return texts[0][:at] + struct.pack('<I', len(data) // 24) + data + texts[0][at + 4:]


def start_master(port):
    """A master of its own on that port, which answers."""
    uri = 'http://localhost:%d' % port
    process = subprocess.Popen(['rosmaster', '--core', '-p', str(port)], env=dict(os.environ, ROS_MASTER_URI=uri), stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    assert until(rosgraph.Master('/test', uri).is_online, 20)
    return process


def executable(package, name):
    """The path of a node's program."""
    import roslib.packages
    found = roslib.packages.find_node(package, name)
    assert found, 'there is no %s in %s' % (name, package)
    return found[0]


class Node:
    """The node as a process of its own, under a name of its own, its output kept. cgroup: the folder of one that it begins in."""

    def __init__(self, name, environment=None, cgroup=None, **parameters):
        self.name = name
        self.forget()
        arguments = [executable('curve_proximity', 'curve_proximity_node'), '__name:=' + name]
        if cgroup:
            arguments = ['sh', '-c', 'echo $$ >"$0"/cgroup.procs && exec "$@"', cgroup] + arguments
        for parameter, value in dict({'state_file': '', 'max_age': 0.0}, **parameters).items():  # what a test sends stays fresh
            if environment is None and value is not None:
                rospy.set_param('/%s/%s' % (name, parameter), value)
        self._log = tempfile.NamedTemporaryFile(prefix='curve_proximity_%s_' % name, suffix='.log')
        self.process = subprocess.Popen(arguments, stdout=self._log, stderr=subprocess.STDOUT, env=environment)

    def forget(self):
        """Private parameters stay on the master between runs."""
        try:
            rospy.delete_param('/' + self.name)
        except (KeyError, rospy.ROSException):
            pass

    def alive(self):
        return self.process.poll() is None

    def output(self):
        with open(self._log.name) as log:
            return log.read()

    def wait(self, seconds):
        """The exit code, or None where it still runs then."""
        try:
            return self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            return None

    def resident_mb(self, shadow=False):
        return resident_mb(self.process.pid, shadow)

    def end(self):
        """Ends it where it runs: it must do so without a fault."""
        code, said = 0, ''
        if self.alive():
            self.process.terminate()
            code = self.wait(10)
            said = self.output()
            if code is None:
                self.process.kill()
                self.process.wait()
        self._log.close()
        self.forget()
        if code:
            raise AssertionError('%s ended with code %d: %s' % (self.name, code, said[-2000:]))


class Case(unittest.TestCase):
    """Nodes that end with their test, and what tests say of answers."""

    def begin(self, name, **parameters):
        """A node, and its services."""
        node = Node(name, **parameters)
        self.addCleanup(node.end)
        return node, Server('/' + name)

    def set_param(self, name, value):
        """Until the test ends."""
        rospy.set_param(name, value)
        self.addCleanup(lambda: rospy.has_param(name) and rospy.delete_param(name))

    def publisher(self, topic, kind, **fields):
        publisher = rospy.Publisher(topic, kind, **dict(dict(queue_size=5), **fields))
        self.assertTrue(connected(publisher))
        return publisher

    def succeeded(self, response):
        self.assertTrue(response.success, response.message)
        return response

    def stopped(self, **parameters):
        """What a node said that ended by itself, with a failure, since it could not use these parameters."""
        node = Node('wrong', **parameters)
        self.addCleanup(node.end)
        code = node.wait(20)
        self.assertNotIn(code, (None, 0), node.output())
        self.assertGreater(code, 0, 'the node died of a signal: ' + node.output())
        return node.output()

    def output_of(self, *arguments):
        """Of one of our examples that ends well."""
        done = subprocess.run([sys.executable, os.path.join(ROOT, 'examples', arguments[0]), *arguments[1:]], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=60, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        return done.stdout

    def row(self, response):
        """The one result of a call that succeeded."""
        row, = self.succeeded(response).results
        return row

    def assertHolds(self, lower, upper, expected, width=1e-6, slack=1e-12):
        """The interval is narrow and contains the value, which is known to the slack."""
        self.assertLessEqual(lower, expected + slack)
        self.assertGreaterEqual(upper, expected - slack)
        self.assertLessEqual(upper - lower, width)

    def assertRefused(self, response, *words):
        self.assertFalse(response.success)
        for word in words:
            self.assertIn(word, response.message)
        self.assertNotIn('\n', response.message)


def until(condition, seconds, step=0.02):
    """Waits for a condition on the wall clock; its last value."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        value = condition()
        if value:
            return value
        time.sleep(step)
    return condition()


def connected(*ends, seconds=20):
    """Waits until what these publishers and subscribers send or await gets through; whether it does.

    rospy counts a subscriber's connection before it is made, and what is published meanwhile is lost: so the publishers are asked.
    They may still count one that has been closed: so it must be one of ours by its port."""
    return until(lambda: all(map(_is_connected, ends)), seconds)


def _is_connected(end):
    if isinstance(end, rospy.Publisher):
        end.impl.check()  # for those that were closed; rospy itself looks every half second
        return end.get_num_connections() > 0
    master = rosgraph.Master(rospy.get_name())
    publishers = set(dict(master.getSystemState()[0]).get(end.resolved_name, [])) - {rospy.get_name()}
    ports = [re.search(r'on port (\d+)', info[-1]) for info in end.impl.get_stats_info()]
    ours = [':%s on socket' % port[1] for port in ports if port] + ['[None:None on']  # rospy's publishers do not say
    topic = end.resolved_name
    return bool(publishers) and all(any(port in link for port in ours for link in bus_links(name, topic, 'o')) for name in publishers)


def bus_links(node, topic, direction):
    """What a node says of its connections about the topic, those to subscribers ('o') or to publishers ('i'): a text each."""
    with xmlrpc.client.ServerProxy(rosgraph.Master(rospy.get_name()).lookupNode(node)) as api:
        connections = api.getBusInfo(rospy.get_name())[2]
    return [link[-1] for link in connections if (link[2], link[4]) == (direction, topic)]


def heard(topic, kind):
    """The messages of a topic from now on, as they come."""
    messages = []
    assert connected(rospy.Subscriber(topic, kind, messages.append)), 'nobody publishes ' + topic
    return messages


class Drawings:
    """What the node draws, from now on: nothing is drawn where nobody listens."""

    def __init__(self):
        self.arrays = []
        self.subscriber = rospy.Subscriber('/curve_proximity/markers', MarkerArray, self.arrays.append)
        assert connected(self.subscriber)

    def shown(self, condition, *spaces):
        """The markers of the first array in which those of these namespaces meet the condition, by namespace."""
        def look():
            for array in self.arrays[-3:]:
                found = {space: [m for m in array.markers if m.ns == space] for space in spaces}
                if all(found.values()) and condition(found):
                    return found
        found = until(look, 10)
        assert found, [(m.ns, m.type) for a in self.arrays[-1:] for m in a.markers]
        return found


def ring_and_shells(shells=200, n=20000):
    """A query that keeps a processor busy for seconds: a spline all but at the same distance from concentric balls,
    each asked for alone. Returns the curve, the balls, and the fields of the request."""
    ring = bspline([(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n), 0) for i in range(n)], 3, id='ring')
    balls = [sphere('ball%03d' % i, 0.1 + 0.001 * i) for i in range(shells)]
    return ring, balls, dict(per_object=True, epsilon=1e-13, max_nodes=2**32 - 1)


class Call(threading.Thread):
    """One call in the background: its response or failure, and when it ended."""

    def __init__(self, work):
        super().__init__(daemon=True)
        self.work, self.response, self.failure, self.ended = work, None, None, None
        self.start()

    def run(self):
        try:
            self.response = self.work()
        except Exception as failure:
            self.failure = failure
        self.ended = time.monotonic()


def status_of(seen, name, condition, seconds=8):
    """The first status of a server's of that name, among arrays of /diagnostics, for which condition(status, its values) holds; and these."""
    def look():
        for array in list(seen):
            for status in array.status:
                values = {v.key: v.value for v in status.values}
                if status.name == 'curve_proximity: ' + name and condition(status, values):
                    return status, values
    found = until(look, seconds)
    assert found, 'no such status: ' + str(seen[-1:])
    return found
