# SPDX-License-Identifier: BSD-3-Clause
"""The command line `cprox`, as pip installs it: the program that stands in this package takes the place of this one."""
import os
import sys


def main():
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'curve_proximity', 'cprox')
    os.execv(program, [program, *sys.argv[1:]])
