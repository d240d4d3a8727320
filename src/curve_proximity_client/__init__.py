# SPDX-License-Identifier: BSD-3-Clause
"""A small client of the node for Python: queries in a line, answers as messages, failures as exceptions.

    from curve_proximity_client import Client, bezier, sphere
    client = Client()                       # of the node /curve_proximity
    client.add(sphere('ball', 0.25, (1, 0, 0)))
    row = client.distance(bezier([(0, 0, 1), (2, 0, 1)]))
    print(row.lower, row.upper, row.b)

Metres, radians, the node's ~fixed_frame unless a frame is given. An instance belongs to one thread at a time.
"""
import time

import rospy
from curve_proximity.msg import Body, CollisionObject, ConstraintQuery, Curve, ProximityQuery
from curve_proximity.srv import (ApplyScene, ApplySceneRequest, ClearanceProfile, ClearanceProfileRequest, Collision,
                                 CollisionRequest, Distance, DistanceRequest, EvaluateConstraints, EvaluateConstraintsRequest,
                                 ListViolations, ListViolationsRequest, NearestPairs, NearestPairsRequest, TimeOfContact, TimeOfContactRequest, Tolerance,
                                 ToleranceRequest)
from geometry_msgs.msg import Point, Pose, Quaternion

__all__ = ['Client', 'Failure', 'bezier', 'bspline', 'body', 'box', 'pose', 'sphere']


class Failure(Exception):
    """The node refused a query, or could not be reached; the text says why."""


# ---------------------------------------------------------------------------------------------------------------- messages
def pose(position=(0, 0, 0), orientation=(0, 0, 0, 1)):
    """A pose by three coordinates and a quaternion x, y, z, w."""
    return Pose(Point(*map(float, position)), Quaternion(*map(float, orientation)))


def _curve(basis, points, radius, frame, identifier, **fields):
    curve = Curve(id=identifier, basis=basis, radius=float(radius), points=[Point(*map(float, p)) for p in points], **fields)
    curve.header.frame_id = frame
    return curve


def bezier(points, radius=0.0, frame='', id=''):
    """A Bezier curve over [0, 1], with a ball of the radius riding it."""
    return _curve('bezier', points, radius, frame, id)


def bspline(points, degree=3, knots=None, radius=0.0, frame='', id=''):
    """A B-spline; without knots clamped and uniform over [0, 1]."""
    inner = len(points) - degree - 1
    if inner < 0:
        raise Failure('a B-spline of degree %d needs %d points, not %d' % (degree, degree + 1, len(points)))
    if knots is None:
        knots = [0.0] * (degree + 1) + [(i + 1.0) / (inner + 1) for i in range(inner)] + [1.0] * (degree + 1)
    return _curve('bspline', points, radius, frame, id, degree=degree, knots=[float(k) for k in knots])


def body(name, kind, dimensions=(), position=(0, 0, 0), orientation=(0, 0, 0, 1), frame='', padding=0.0, vertices=()):
    """An object of one body; kinds and dimensions as in Body.msg."""
    thing = CollisionObject(id=name, pose=pose(position, orientation), padding=float(padding), operation=CollisionObject.ADD,
                            bodies=[Body(type=kind, dimensions=[float(d) for d in dimensions],
                                         vertices=[Point(*map(float, v)) for v in vertices])])
    thing.header.frame_id = frame
    return thing


def sphere(name, radius, position=(0, 0, 0), **fields):
    """A ball."""
    return body(name, 'sphere', [radius], position, **fields)


def box(name, size, position=(0, 0, 0), orientation=(0, 0, 0, 1), **fields):
    """A box by its full edge lengths."""
    return body(name, 'box', size, position, orientation, **fields)


# ---------------------------------------------------------------------------------------------------------------- the client
class Client:
    """The services of one node over persistent connections, which are made again where the node has been restarted."""

    def __init__(self, node='/curve_proximity', patience=5.0):
        """patience: how long a call may wait for the node, on the wall clock [s]."""
        self._node, self._patience, self._services = node, patience, {}

    def distance(self, curves, **fields):
        """The least distance of each curve to the scene and the robot: a Proximity message, or a list of them for a list. Further
        fields of the request by name: objects, links, joint_state, epsilon, ..."""
        return self._ask('distance', Distance, DistanceRequest, curves, fields)

    def tolerance(self, curves, delta, **fields):
        """The same; verdict 'clear': farther than delta [m] everywhere."""
        return self._ask('tolerance', Tolerance, ToleranceRequest, curves, dict(fields, delta=float(delta)))

    def collision(self, curves, **fields):
        """The same; verdict 'violated': it touches something."""
        return self._ask('collision', Collision, CollisionRequest, curves, fields)

    def time_of_contact(self, curves, **fields):
        """When each curve first touches something: rows as of collision(), with t_contact_lower. For a motion of the robot: no curves
        and trajectory=a JointTrajectory, here as in the other queries."""
        return self._ask('time_of_contact', TimeOfContact, TimeOfContactRequest, curves, fields)

    def nearest_pairs(self, curves, count=10, within=0.0, **fields):
        """At most count pairs for each curve, the nearest first, or only those within a distance [m]: a list of Proximity messages."""
        return self._answers('nearest_pairs', NearestPairs, NearestPairsRequest, curves, dict(fields, count=count, within=float(within)))

    def clearance_profile(self, curves, intervals=100, breaks=(), per_link=False, horizon=0.0, **fields):
        """The least distance on each of so many intervals of the parameter, or between breaks: a Profile message, or a list of them
        for a list or per_link. Clearance beyond a horizon [m] above 0 is only bounded."""
        own = dict(breaks=list(breaks)) if len(breaks) else dict(intervals=intervals)
        own.update(per_link=per_link, horizon=float(horizon))
        return self._ask('clearance_profile', ClearanceProfile, ClearanceProfileRequest, curves, dict(fields, **own))

    def violations(self, curves, delta, resolution=0.0, **fields):
        """All intervals of the parameter within delta [m] of something: a ViolationIntervals message, or a list of them for a list."""
        own = dict(delta=float(delta), resolution=float(resolution))
        return self._ask('violations', ListViolations, ListViolationsRequest, curves, dict(fields, **own))

    def gradient(self, curves, **fields):
        """The derivatives of distance(): a Gradient message, or a list of them for a list. Where valid is false there is none, and message
        says why."""
        return self._ask('distance', Distance, DistanceRequest, curves, dict(fields, gradient=True))

    def is_clear(self, curve, delta, **fields):
        """True only where it is proven that the curve stays farther than delta [m] from everything."""
        return self.tolerance(curve, delta, **fields).verdict == 'clear'

    def constraint(self, provider, b=None, a=None, curve=None, trajectory=None, joint_state=None):
        """Value and gradient of a provider of the node's ~constraint_providers: a ConstraintResult. b and a are objects, or names of
        objects in the scene; a may be None along a curve. Of a trajectory (trajectory_msgs/JointTrajectory) neither is given;
        joint_state has the joints that it does not name."""
        case = ConstraintQuery(id='case', providers=[provider], b=self._side(b), a=self._side(a))
        if curve is not None:
            case.curve = curve
        if trajectory is not None:
            case.trajectory = trajectory
        if joint_state is not None:
            case.joint_state = joint_state
        response = self._call('evaluate_constraints', EvaluateConstraints, EvaluateConstraintsRequest(cases=[case]))
        return response.results[0]

    def add(self, *objects):
        """Puts objects into the scene, each in the place of one of its name."""
        self._call('apply_scene', ApplyScene, ApplySceneRequest(objects=list(objects)))

    def remove(self, *names):
        """Takes objects out of the scene."""
        self.add(*[CollisionObject(id=name, operation=CollisionObject.REMOVE) for name in names])

    def clear(self):
        """Takes everything out of the scene."""
        self._call('apply_scene', ApplyScene, ApplySceneRequest(clear=True))

    # ---- how
    @staticmethod
    def _side(side):
        return CollisionObject() if side is None else CollisionObject(id=side) if isinstance(side, str) else side

    def _ask(self, service, kind, request, curves, fields):
        """The one answer about one curve, else the list."""
        answers = self._answers(service, kind, request, curves, fields)
        return answers[0] if isinstance(curves, Curve) and len(answers) == 1 else answers

    def _answers(self, service, kind, request, curves, fields):
        asked = ProximityQuery(curves=[curves] if isinstance(curves, Curve) else list(curves))
        whole = request(query=asked)
        for name, value in fields.items():
            if name == 'trajectory':
                asked.trajectories = [value]
            elif name in ProximityQuery.__slots__:
                setattr(asked, name, value)
            elif name in request.__slots__:
                setattr(whole, name, value)
            else:
                raise Failure('a query has no field %r' % name)
        response = self._call(service, kind, whole)
        if asked.gradient:
            return response.gradients
        if service == 'violations':
            return response.violations
        return response.profiles if service == 'clearance_profile' else response.results

    def _call(self, service, kind, request):
        """Calls until there is an answer or the patience is over. A call whose answer was lost is made again: all of these can bear
        that."""
        name = self._node + '/' + service
        deadline, pause, why = time.monotonic() + self._patience, 0.01, 'it is not there'
        while True:
            try:
                if service not in self._services:
                    rospy.wait_for_service(name, max(0.1, deadline - time.monotonic()))
                    self._services[service] = rospy.ServiceProxy(name, kind, persistent=True)
                response = self._services[service](request)
                break
            except (rospy.ServiceException, rospy.ROSException) as failure:
                why = failure
                if service in self._services:
                    self._services.pop(service).close()
            if rospy.is_shutdown() or time.monotonic() + pause >= deadline:
                raise Failure('%s: no answer: %s' % (name, why))
            time.sleep(pause)
            pause = min(2 * pause, 0.5)
        if not response.success:
            raise Failure('%s: %s' % (name, response.message))
        return response
