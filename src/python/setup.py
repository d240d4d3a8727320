# SPDX-License-Identifier: BSD-3-Clause
"""The Python package cprox without ROS: CMake builds the extension module with the library inside, the command line, the
program that reads meshes for both, and where MPFR is found the checker of certificates. In the environment, CPROX_BUILD names a build folder that
is kept, and CMAKE_ARGS has further options of CMake."""
import os
import re
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        module = os.path.abspath(self.get_ext_fullpath(ext.name))
        build = os.environ.get('CPROX_BUILD') or os.path.abspath(self.build_temp)
        subprocess.check_call(['cmake', '-S', ROOT, '-B', build, '-DCPROX_ROS=OFF', '-DCPROX_SCENE=ON', '-DBUILD_SHARED_LIBS=OFF',
                               '-DPython3_EXECUTABLE=' + sys.executable, *shlex.split(os.environ.get('CMAKE_ARGS', ''))])
        subprocess.check_call(['cmake', '--build', build, '--target', 'cprox_python', 'curve_proximity_mesh_reader', 'cprox_cli',
                               '--', '-j%d' % (os.cpu_count() or 1)])
        with open(os.path.join(build, 'python_files.txt')) as text:
            built, *beside = text.read().splitlines()
        programs = os.path.join(os.path.dirname(module), 'curve_proximity')
        os.makedirs(programs, exist_ok=True)
        shutil.copy2(built, module)
        for program in beside:
            shutil.copy2(program, programs)


def version():
    with open(os.path.join(ROOT, 'package.xml')) as text:
        return re.search('<version>([^<]+)</version>', text.read()).group(1)


setup(name='cprox', version=version(), license='BSD-3-Clause', packages=['cprox', 'cprox_dask'], package_data={'cprox': ['*.pyi', 'py.typed']},
      description='Certified proximity queries of continuous motions', install_requires=['numpy'], python_requires='>=3.8',
      entry_points={'console_scripts': ['cprox = cprox.command:main']}, ext_modules=[Extension('cprox._cprox', [])], cmdclass={'build_ext': CMakeBuild})
