# SPDX-License-Identifier: BSD-3-Clause
"""The Python packages of the messages in src/ros/foreign, made by genpy: control, moveit and octomap, which need not be installed."""
import glob
import os
import sys
import tempfile

import rospkg
from genpy.generate_initpy import write_modules
from genpy.generator import MsgGenerator, SrvGenerator

FOREIGN = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'src', 'ros', 'foreign')
MADE = tempfile.TemporaryDirectory()

installed = 'actionlib_msgs', 'geometry_msgs', 'sensor_msgs', 'shape_msgs', 'std_msgs', 'trajectory_msgs'
search = {package: [rospkg.RosPack().get_path(package) + '/msg'] for package in installed}
search.update({package: [os.path.join(FOREIGN, package, 'msg')] for package in os.listdir(FOREIGN)})
for package in os.listdir(FOREIGN):
    for kind, generator in ('msg', MsgGenerator()), ('srv', SrvGenerator()):
        folder = os.path.join(MADE.name, package, kind)
        os.makedirs(folder)
        generator.generate_messages(package, glob.glob(os.path.join(FOREIGN, package, kind, '*')), folder, search)
        write_modules(folder)
    write_modules(os.path.join(MADE.name, package))
sys.path.insert(0, MADE.name)

import control_msgs.msg as control  # noqa: E402,F401
import moveit_msgs.msg as moveit  # noqa: E402,F401
import octomap_msgs.msg as octomap  # noqa: E402,F401
from moveit_msgs.srv import GetPlanningScene, GetPlanningSceneResponse  # noqa: E402,F401
