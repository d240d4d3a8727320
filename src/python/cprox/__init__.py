# SPDX-License-Identifier: BSD-3-Clause
"""Certified proximity queries of continuous motions, for NumPy.

Shapes, curves and obstacles are immutable; any number of threads may share them. Queries release the GIL. Lengths are
in metres, angles in radians, poses are homogeneous matrices of shape (4, 4). A failed call is a ValueError.

    import cprox
    curve = cprox.bezier([[-1, 0, 0], [0, 1, 0], [1, 0, 0]])
    wall = cprox.Obstacle(cprox.box([0.1, 1, 1]), cprox.transform([0, 2, 0]))
    answer = cprox.distance(cprox.tube(curve, 0.2), wall)
    print(answer.lower, answer.upper, answer.t)
"""
import operator as _operator
import os as _os
import struct as _struct
import subprocess as _subprocess
import sys as _sys
import tempfile as _tempfile

from pkgutil import extend_path as _extend_path

# A devel space of catkin has the compiled module in another folder of the path than this file.
__path__ = _extend_path(__path__, __name__)

from ._cprox import *  # noqa: E402,F401,F403
from ._cprox import __version__  # noqa: E402,F401


def _make(name, *arguments):
    """For pickle: what a function of this package, or of one of its classes, makes of the arguments."""
    return _operator.attrgetter(name)(_sys.modules[__name__])(*arguments)


def edges(scene, joints, start, end, delta=0.0, self_collision=True, **options):
    """Straight motions between pairs of postures: a proven verdict for each.

    start, end: (n, joints), or one posture. Returns uint8 (n,): 0 clear, farther than delta [m] from all objects and, with
    self_collision, from itself, everywhere on the way; 1 violated; 2 undecided. options: those of edge_verdicts()."""
    import numpy

    start, end = numpy.broadcast_arrays(numpy.atleast_2d(start), numpy.atleast_2d(end))
    if start.ndim != 2:
        raise ValueError('start and end must be arrays of shape (n, joints): one row a posture')
    return edge_verdicts(scene, joints, start, None, delta, whole=self_collision, to=end, **options).view(numpy.uint8)  # noqa: F405


def check(certificate, program=None):
    """What the certificate of a motion or a curve proves: the line that the program cprox_check prints.

    certificate: what Motion.certificate() or Scene.certificate() returned, or a dict with its record (bytes) and query (str). The program shares no
    code with this package. Raises ValueError with its line where nothing is proven, and FileNotFoundError where the program
    is not there. program: its path; None: that of this package, else the PATH is searched."""
    if program is None:
        beside = _os.path.join(_os.path.dirname(_os.path.abspath(__file__)), 'curve_proximity', 'cprox_check')
        program = beside if _os.path.exists(beside) else 'cprox_check'
    if not (isinstance(certificate, dict) and isinstance(certificate.get('record'), bytes) and isinstance(certificate.get('query'), str)):
        raise TypeError('certificate must be a dict with record (bytes) and query (str), got ' + type(certificate).__name__
                        + (f' of {", ".join(map(str, certificate))}' if isinstance(certificate, dict) else ''))
    record = certificate['record']
    with _tempfile.TemporaryDirectory(prefix='cprox-') as folder:
        path = _os.path.join(folder, 'certificate')
        with open(path, 'wb') as file:
            file.write(_struct.pack('<I', len(record)) + record)
        done = _subprocess.run([program, '-', path], input=certificate['query'].encode(), stdout=_subprocess.PIPE,
                               stderr=_subprocess.PIPE)
    line = (done.stdout or done.stderr).decode(errors='replace').strip()
    if done.returncode != 0:
        raise ValueError(line or f'{program} ended with the exit code {done.returncode}')
    return line
