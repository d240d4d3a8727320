# SPDX-License-Identifier: BSD-3-Clause
"""For catkin_python_setup(): the Python client."""
from setuptools import setup
from catkin_pkg.python_setup import generate_distutils_setup

setup(**generate_distutils_setup(packages=['curve_proximity_client'], package_dir={'': 'src'}))
