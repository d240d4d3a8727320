#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Genuine certificates are accepted by both checkers, tampered ones only where what they claim is true, and both always agree.

    test_second_checker.py WRITE_MUTANTS CPROX_CHECK [QUERIES MUTANTS SEED]

By default 120 queries of all kinds with 5 mutants each, seed 11: a twentieth of a second each. A claim counts as false where the
distance, known within 1e-12 of the sizes, contradicts it.
"""
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import second_checker  # noqa: E402


def by_cprox_check(program, problem, certificates):
    """A list of (claim, delta) or None, one a certificate."""
    ran = subprocess.run([program, problem, certificates], capture_output=True, text=True)
    if ran.returncode not in (0, 1):
        sys.exit(f'{program} ended with {ran.returncode} on {problem}: {ran.stderr}')
    found = []
    for line in ran.stdout.splitlines():
        line = re.search(r': proven: (not )?farther than (\S+) m(?: everywhere)?( before \S+)?(?: \(|(, and by \S+ not farther))', line)
        claim = line and ('near' if line[1] else 'apart' if not line[3] else 'before and near' if line[4] else 'before')
        found.append((claim, float(line[2])) if line else None)
    return found


def by_fractions(problem, certificates):
    found = []
    movers = second_checker.read_problem(problem)
    for (sets, _, radius, curve), data in zip(movers, second_checker.records(certificates)):
        try:
            claim, delta = second_checker.check(sets, radius, curve, data)
            found.append((claim, float(delta)))
        except second_checker.Refused:
            found.append(None)
    return found


def is_false(finding, lower, upper):
    claim, delta = finding
    return delta >= upper if claim == 'apart' else claim == 'near' and delta < lower


def main():
    writer, program = sys.argv[1:3]
    queries, mutants, seed = sys.argv[3:6] or ('120', '5', '11')
    genuine = tampered = accepted = 0
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([writer, folder, queries, mutants, seed], check=True)
        for i in range(int(queries)):
            base = os.path.join(folder, str(i))
            first = by_cprox_check(program, base + '.problem', base + '.certificates')
            second = by_fractions(base + '.problem', base + '.certificates')
            with open(base + '.truth') as truth:
                lines = truth.read().splitlines()
            if not len(first) == len(second) == len(lines):
                faults.append(f'query {i}: {len(first)} and {len(second)} findings on {len(lines)} certificates')
            for k, line in enumerate(lines):
                lower, upper, done = line.split(' ', 2)
                lower, upper = float.fromhex(lower), float.fromhex(upper)
                where = f'query {i}, certificate {k} ({done})'
                if first[k] != second[k]:
                    faults.append(f'{where}: cprox_check finds {first[k]}, the second checker {second[k]}')
                if first[k] and is_false(first[k], lower, upper):
                    faults.append(f'{where}: {first[k]} was accepted, but the distance is in [{lower}, {upper}]')
                if done == 'genuine':
                    genuine += 1
                    if not first[k]:
                        faults.append(f'{where} was refused')
                else:
                    tampered += 1
                    accepted += first[k] is not None
    for fault in faults:
        print('FAILED', fault)
    print(f'{genuine} genuine certificates, {tampered} mutants, of which {accepted} prove something true')
    failed = min(len(faults), genuine + tampered)
    print(f'{genuine + tampered - failed} passed, {failed} failed')
    return 1 if faults or genuine == 0 else 0


if __name__ == '__main__':
    sys.exit(main())
