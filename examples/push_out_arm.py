#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the way of a Panda through a shelf smooth and 10 mm clear: SciPy's SLSQP with the rows of cprox.Motion.

    push_out_arm.py [--straight] PANDA.urdf PANDA.srdf SCENE.yaml TRAJECTORY.yaml [PICTURE.png]

The same problem as push_out_arm.cpp. TRAJECTORY.yaml is the path of a planner; with --straight only its ends are taken, and the
way between them may be in contact: distances are signed, so that the gradient leads out. It becomes a cubic B-spline of all
joints, which begins and ends at rest. The variables are its inner control points, the objective is the square of the jerk, the
bounds are the joint limits. The constraints are, for each span, the pairs of links and objects, or of two links, that come
nearest. At the end the whole spline is asked about once more: its clearance is then proven. Needs the sourced workspace
(doc/python.md) and SciPy. PICTURE.png gets the clearance over time, before and after."""
import argparse
import sys
import warnings
import xml.etree.ElementTree

import numpy
import yaml
from scipy.optimize import minimize

import cprox

SPANS, PAIRS, DURATION = 10, 3, 5.0  # constraints a span: the PAIRS that come nearest; [s]
CLEAR, MARGIN, HORIZON = .01, 1e-4, .02  # [m] what is to be proven, what is asked beyond that, what is beyond has no row
CONTROLS, STEP = SPANS + 3, DURATION / SPANS
TIMES = STEP * numpy.arange(SPANS + 1)
INNER = slice(3, CONTROLS - 3)  # the first and the last three control points stay


def banded(weights):
    """A matrix with a row a knot or span, and these weights from its diagonal on."""
    rows = CONTROLS + 1 - len(weights)
    return sum(weight * numpy.eye(rows, CONTROLS, k) for k, weight in enumerate(weights))


# The numbers of a uniform cubic B-spline at its knots: exactly a trajectory of cubic segments.
POSITION, VELOCITY, JERK = banded([1 / 6, 4 / 6, 1 / 6]), banded([-.5 / STEP, 0, .5 / STEP]), banded([-1, 3, -3, 1])


class Problem:
    def __init__(self, urdf, srdf, scene, path, straight):
        self.scene = cprox.Scene(cprox.Robot.from_urdf(urdf, srdf=srdf))
        self.scene.load(scene)
        with open(path) as text:
            said = yaml.safe_load(text)
        self.rest, trajectory = said.get('fixed_joints', {}), said['joint_trajectory']
        self.joints = trajectory['joint_names']
        points = trajectory['points'][::len(trajectory['points']) - 1] if straight else trajectory['points']
        times, positions = ([point[name] for point in points] for name in ('time_from_start', 'positions'))
        inner = numpy.clip((numpy.arange(CONTROLS) - 2) / (CONTROLS - 5), 0, 1)
        at = times[0] + inner * (times[-1] - times[0])
        self.start = numpy.column_stack([numpy.interp(at, times, column) for column in numpy.transpose(positions)])
        limits = {joint.get('name'): joint.find('limit') for joint in xml.etree.ElementTree.parse(urdf).iter('joint')}
        bounds = [[float(limits[joint].get(end)) for end in ('lower', 'upper')] for joint in self.joints]
        self.bounds = bounds * self.start[INNER].shape[0]  # a B-spline stays within the limits of its control points
        self.scale = numpy.sum((JERK @ self.start)**2)
        self.asked = None
        self.evaluations = 0

    def controls(self, x):
        out = self.start.copy()
        out[INNER] = x.reshape(-1, len(self.joints))
        return out

    def motion(self, x):
        controls = self.controls(x)
        return cprox.Motion(self.scene, self.joints, TIMES, POSITION @ controls, VELOCITY @ controls, rest=self.rest)

    def jerk(self, x):
        third = JERK @ self.controls(x)
        return numpy.sum(third**2) / self.scale, (2 * JERK.T @ third / self.scale)[INNER].ravel()

    def clearances(self, x):
        """Values and gradients of the nearest rows of each span. A span with fewer rows is clear by the horizon."""
        if self.asked is not None and numpy.array_equal(self.asked, x):
            return self.answer
        motion = self.motion(x)
        values = numpy.full((SPANS, PAIRS), HORIZON - CLEAR - MARGIN)
        gradients = numpy.zeros((SPANS, PAIRS, x.size))
        found = []
        for self_collision in (False, True):
            rows = motion.rows(HORIZON, per_pair=SPANS, self_collision=self_collision, signed=True)
            if len(rows['lower']):
                by = POSITION.T @ rows['positions'] + VELOCITY.T @ rows['velocities']
                found += zip(rows['lower'], rows['t0'], by[:, INNER].reshape(len(by), -1))
        taken = [0] * SPANS
        for lower, t0, by in sorted(found, key=lambda row: row[0]):
            span = round(t0 / STEP)
            if taken[span] < PAIRS:
                values[span, taken[span]], gradients[span, taken[span]] = lower - CLEAR - MARGIN, by
                taken[span] += 1
        self.asked, self.answer = x.copy(), (values.ravel(), gradients.reshape(-1, x.size))
        self.evaluations += 1
        return self.answer


def tell(when, motion):
    """What is proven of a whole trajectory: is it farther than CLEAR from all objects and from itself?"""
    least = min((motion.distance(self_collision=itself) for itself in (False, True)), key=lambda answer: answer['result'].lower)
    clear = all(motion.tolerance(CLEAR, self_collision=itself)['result'].verdict == 'clear' for itself in (False, True))
    print(f"{when} at least {1e3 * least['result'].lower:.4f} mm, between {least['a']} and {least['b']}; more than {1e3 * CLEAR:g} mm"
          f" everywhere: {'proven' if clear else 'no'}")
    return clear


def draw(path, motions):
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot
    breaks = numpy.linspace(0, DURATION, 201)
    figure, axes = pyplot.subplots(1, len(motions), figsize=(10, 3.2), sharey=True)
    for axis, (title, motion) in zip(axes, motions.items()):
        for itself, label in ((False, 'to the objects'), (True, 'to itself')):
            lower = motion.profile(breaks, self_collision=itself)['lower']
            axis.step(breaks[:-1], 1e3 * lower, where='post', label=label)
        axis.axhline(1e3 * CLEAR, color='black', linestyle='--', linewidth=.8)
        axis.set(title=title, xlabel='time [s]', ylim=(0, 60))
    axes[0].set(ylabel='clearance [mm]')
    axes[-1].legend(frameon=False)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--straight', action='store_true', help='from the straight line between the ends of the path')
    for name in ('urdf', 'srdf', 'scene', 'trajectory'):
        parser.add_argument(name)
    parser.add_argument('picture', nargs='?')
    given = parser.parse_args()
    problem = Problem(given.urdf, given.srdf, given.scene, given.trajectory, given.straight)
    x = problem.start[INNER].ravel()
    clearances = {'type': 'ineq', 'fun': lambda x: problem.clearances(x)[0], 'jac': lambda x: problem.clearances(x)[1]}
    warnings.filterwarnings('ignore', 'Values in x were outside bounds')  # by rounding: SciPy puts them on the bounds
    found = minimize(problem.jerk, x, jac=True, bounds=problem.bounds, constraints=[clearances], method='SLSQP',
                     options={'maxiter': 200, 'ftol': 1e-4})
    before, after = problem.motion(x), problem.motion(found.x)
    tell('before:', before)
    clear = tell('after: ', after)
    print(f'the squared jerk is {100 * found.fun:.1f} % of the start; {problem.evaluations} evaluations; SLSQP: {found.message}')
    if given.picture:
        draw(given.picture, {'before': before, 'after: smooth, more than 10 mm clear, proven': after})
    return 0 if clear and found.success else 1


if __name__ == '__main__':
    sys.exit(main())
