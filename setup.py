# SPDX-License-Identifier: BSD-3-Clause
"""For catkin_python_setup(): the Python client of the node, the Python package over the library, and the one that drives Dask."""
from setuptools import setup
from catkin_pkg.python_setup import generate_distutils_setup

setup(**generate_distutils_setup(
    packages=['curve_proximity_client', 'cprox', 'cprox_dask'],
    package_dir={'curve_proximity_client': 'src/curve_proximity_client', 'cprox': 'src/python/cprox', 'cprox_dask': 'src/python/cprox_dask'}))
