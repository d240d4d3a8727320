#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints a URDF whose mesh files have names that RViz and the server find from anywhere: relative ones become file:// and the
folder of the URDF.

    urdf_for_rviz.py ROBOT.urdf"""
import os
import re
import sys


def absolute(text, folder):
    """Names without a scheme that do not begin with a slash are relative to the folder."""
    def replace(match):
        quote, name = match.group(1), match.group(2)
        return 'filename=%sfile://%s%s' % (quote, os.path.join(folder, name), quote)
    return re.sub(r'''filename\s*=\s*(["'])([^:/"'][^:"']*)\1''', replace, text)


def main():
    if len(sys.argv) != 2:
        sys.exit('usage: urdf_for_rviz.py ROBOT.urdf')
    path = os.path.abspath(sys.argv[1])
    try:
        with open(path) as file:
            sys.stdout.write(absolute(file.read(), os.path.dirname(path)))
    except OSError as error:
        sys.exit('urdf_for_rviz.py: %s' % error)


if __name__ == '__main__':
    main()
