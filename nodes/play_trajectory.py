#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A source of trajectories: sends a file's joint trajectory, and curves, again and again, and moves joints along it.

Private parameters: file (the YAML of `cprox --trajectory`), curves (the CSV of `cprox --curves`; '' for none), period [s] between
two messages of a kind, rate [1/s] of joint_states. Publishes ~trajectory, ~curve and joint_states."""
import csv
import math

import rospy
import yaml
from curve_proximity.msg import Curve
from geometry_msgs.msg import Point
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint


def seconds(value):
    """A time in the file: a number, or {secs, nsecs}."""
    return value['secs'] + 1e-9 * value['nsecs'] if isinstance(value, dict) else float(value)


def read_trajectory(path):
    """The message, and the joints that the file holds still."""
    with open(path) as text:
        content = yaml.safe_load(text)
    given = content['joint_trajectory']
    points = [JointTrajectoryPoint(positions=p['positions'], velocities=p.get('velocities', []),
                                   accelerations=p.get('accelerations', []),
                                   time_from_start=rospy.Duration.from_sec(seconds(p['time_from_start'])))
              for p in given['points']]
    return JointTrajectory(joint_names=given['joint_names'], points=points), content.get('fixed_joints', {})


def read_curves(path):
    """id,basis,degree,t0,t1,radius,n,x0,y0,z0,...[,knot0,...]: a message a row, of the bases without parameters."""
    curves = []
    with open(path) as text:
        for row in csv.reader(line for line in text if line.strip() and not line.startswith('#')):
            if row[0].strip() == 'id':
                continue
            n = int(row[6])
            numbers = [float(x) for x in row[7:] if x.strip()]
            curves.append(Curve(id=row[0], basis=row[1].strip(), degree=int(row[2]), t0=float(row[3]), t1=float(row[4]),
                                radius=float(row[5]), points=[Point(*numbers[3 * i:3 * i + 3]) for i in range(n)],
                                knots=numbers[3 * n:]))
    return curves


def positions_at(trajectory, t):
    """Cubic where the points carry velocities, else linear."""
    points = trajectory.points
    for a, b in zip(points, points[1:]):
        ta, tb = a.time_from_start.to_sec(), b.time_from_start.to_sec()
        if t > tb:
            continue
        h = tb - ta
        s = min(1.0, max(0.0, (t - ta) / h))
        if not (a.velocities and b.velocities):
            return [p + s * (q - p) for p, q in zip(a.positions, b.positions)]
        return [(1 + 2 * s) * (1 - s)**2 * p + s * (1 - s)**2 * h * v + s * s * (3 - 2 * s) * q + s * s * (s - 1) * h * w
                for p, q, v, w in zip(a.positions, b.positions, a.velocities, b.velocities)]
    return list(points[-1].positions)


def main():
    rospy.init_node('play_trajectory')
    trajectory, fixed = read_trajectory(rospy.get_param('~file'))
    path = rospy.get_param('~curves', '')
    curves = read_curves(path) if path else []
    period, rate = rospy.get_param('~period', 1.0), rospy.get_param('~rate', 20.0)
    duration = trajectory.points[-1].time_from_start.to_sec()

    out = rospy.Publisher('~trajectory', JointTrajectory, queue_size=1)
    curve_out = rospy.Publisher('~curve', Curve, queue_size=10)
    joints_out = rospy.Publisher('joint_states', JointState, queue_size=10)

    def send(_):
        trajectory.header.stamp = rospy.Time.now()
        out.publish(trajectory)
        for curve in curves:
            curve_out.publish(curve)
    rospy.Timer(rospy.Duration.from_sec(period), send)

    # There and back again, without a jump.
    begin, ticks = rospy.Time.now(), rospy.Rate(rate)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        t = 0.5 * duration * (1 - math.cos(math.pi * (now - begin).to_sec() / (1.5 * duration)))
        state = JointState(name=trajectory.joint_names + list(fixed), position=positions_at(trajectory, t) + list(fixed.values()))
        state.header.stamp = now
        joints_out.publish(state)
        ticks.sleep()


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
