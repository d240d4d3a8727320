#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the tests of the command line: run_tests.py --cprox PROGRAM [--node PROGRAM] [NAME...]

NAME is a module (test_pairs) or a case (test_pairs.Pairs.a_name). The last line is `N passed, N failed`; what was skipped
counts as failed.
"""
import argparse
import inspect
import os
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))


class Loader(unittest.TestLoader):
    """Cases are statements of fact: every method of a test class that needs nothing but self is one."""

    def getTestCaseNames(self, case):
        own = {name: method for kind in case.__mro__ if kind.__module__.startswith('test_') for name, method in vars(kind).items()}
        return sorted(name for name, method in own.items() if inspect.isfunction(method)
                      and list(inspect.signature(method).parameters) == ['self'] and name not in ('setUp', 'tearDown'))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--cprox', required=True, help='the program')
    parser.add_argument('--node', default='', help='curve_proximity_node')
    parser.add_argument('--example-ompl', default='', help='example_ompl')
    parser.add_argument('names', nargs='*')
    arguments = parser.parse_args()
    os.environ['CPROX'] = os.path.abspath(arguments.cprox)
    os.environ['CPROX_NODE'] = os.path.abspath(arguments.node) if arguments.node else ''
    os.environ['CPROX_EXAMPLE_OMPL'] = os.path.abspath(arguments.example_ompl) if arguments.example_ompl else ''
    sys.path.insert(0, HERE)

    # all modules beside this one, or those that are named
    loader = Loader()
    if arguments.names:
        suite = loader.loadTestsFromNames(arguments.names)
    else:
        suite = loader.discover(HERE, pattern='test_*.py', top_level_dir=HERE)
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(suite)

    # one line a failure, then the sum
    bad = [case for case, _ in result.failures + result.errors + result.skipped] + result.unexpectedSuccesses
    failed = len({str(getattr(case, 'test_case', case)) for case in bad})  # the parts of one case are one case
    for case in bad:
        print(f'FAILED: {case}')
    print(f'{result.testsRun - failed} passed, {failed} failed')
    return 1 if failed or not result.testsRun else 0


if __name__ == '__main__':
    sys.exit(main())
