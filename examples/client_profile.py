#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws how close each link of a robot comes over time, by the service ~clearance_profile of a running node.

    scripts/run roslaunch curve_proximity demo.launch rviz:=false play:=false
    scripts/run cprox send test/data/scenes/mbm/bookshelf_tall_panda/scene0001.yaml
    scripts/run python3 examples/client_profile.py test/data/trajectories/panda_bookshelf_tall_0001_rrt.yaml /tmp/profile.png
"""
import sys

import matplotlib
import rospy
import yaml
from curve_proximity_client import Client
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

matplotlib.use('Agg')
from matplotlib import pyplot  # noqa: E402


def read_trajectory(path):
    """The trajectory of a file, and where the other joints stand."""
    with open(path) as text:
        saved = yaml.safe_load(text)
    points = [JointTrajectoryPoint(positions=point['positions'], velocities=point.get('velocities', []),
                                   time_from_start=rospy.Duration.from_sec(point['time_from_start']))
              for point in saved['joint_trajectory']['points']]
    still = saved.get('fixed_joints', {})
    return (JointTrajectory(joint_names=saved['joint_trajectory']['joint_names'], points=points),
            JointState(name=list(still), position=list(still.values())))


def main(path, picture, node='/curve_proximity'):
    trajectory, still = read_trajectory(path)
    for i, profile in enumerate(Client(node).clearance_profile([], trajectory=trajectory, joint_state=still, per_link=True, epsilon=1e-3)):
        breaks = [*profile.t0, profile.t1[-1]]
        lower, upper = ([*bounds, bounds[-1]] for bounds in (profile.lower, profile.upper))
        pyplot.fill_between(breaks, lower, upper, step='post', label=profile.link, color='C%d' % i, linewidth=1.5)
        print('%-20s at least %.4f m, to %s' % (profile.link, profile.summary.lower, profile.summary.b))
    pyplot.xlabel('time [s]')
    pyplot.ylabel('certified clearance [m]')
    pyplot.legend(loc='center left', bbox_to_anchor=(1, 0.5))
    pyplot.savefig(picture, bbox_inches='tight')


if __name__ == '__main__':
    rospy.init_node('curve_proximity_profile', anonymous=True)
    main(*rospy.myargv(sys.argv)[1:])
