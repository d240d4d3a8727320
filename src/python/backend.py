# SPDX-License-Identifier: BSD-3-Clause
"""The backend of `pip install .`: setuptools in this folder. The setup.py in the root of the checkout is catkin's."""
import os

os.chdir(os.path.dirname(os.path.abspath(__file__)))
from setuptools.build_meta import *  # noqa: E402,F401,F403
