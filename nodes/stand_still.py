#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Publishes the joint states of a robot that nobody drives: each movable joint at 0, or in the middle of its limits where 0 is
outside.

    ~joints (dict) values [rad, m] by name; names that the robot does not have are ignored    ~rate (20.0) [Hz]"""
import xml.etree.ElementTree

import rospy
import yaml
from sensor_msgs.msg import JointState


def rest(joint):
    """The value of a joint at rest; None of one that follows another or does not move."""
    kind = joint.get('type')
    if kind not in ('revolute', 'continuous', 'prismatic') or joint.find('mimic') is not None:
        return None
    limit = joint.find('limit')
    lower, upper = (float(limit.get(key, 0)) if limit is not None else 0.0 for key in ('lower', 'upper'))
    return 0.0 if kind == 'continuous' or lower <= 0.0 <= upper else 0.5 * (lower + upper)


def main():
    rospy.init_node('stand_still')
    robot = xml.etree.ElementTree.fromstring(rospy.get_param('robot_description'))
    values = {joint.get('name'): rest(joint) for joint in robot.findall('joint')}
    values = {name: value for name, value in values.items() if value is not None}
    given = rospy.get_param('~joints', {})
    given = yaml.safe_load(given) if isinstance(given, str) else given
    values.update({name: float(value) for name, value in (given or {}).items() if name in values})
    out = rospy.Publisher('joint_states', JointState, queue_size=10)
    ticks = rospy.Rate(rospy.get_param('~rate', 20.0))
    while not rospy.is_shutdown():
        state = JointState(name=list(values), position=list(values.values()))
        state.header.stamp = rospy.Time.now()
        out.publish(state)
        ticks.sleep()


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
