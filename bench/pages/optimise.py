# SPDX-License-Identifier: BSD-3-Clause
"""optimise.md: motions of an arm made smooth and clear, by whole motions and by samples; every number from results.csv."""
import re
import statistics

import targets
from pages.figures import microseconds, picture, short, table

CLEAR, FREE = 'clear by 10 mm', 'free of contact'


def motions(rows):
    return sum(int(re.search(r'(\d+) motions', row['parameter']).group(1)) for row in rows)


def said(rows):
    """Of how many it was said, and of how many of these it is not true."""
    many, wrong = (sum(int(row[column]) for row in rows) for column in ('distance_queries', 'unsound'))
    return f'{many}, **{wrong} wrong**' if wrong else str(many)


def method_lines(rows, methods):
    for method in methods:
        mine = [row for row in rows if row['method'] == method]
        clear, free = ([row for row in mine if row['workload'] == what] for what in (CLEAR, FREE))
        deepest = max(float(row['error']) for row in free)
        yield [method, str(motions(clear)), said(clear), said(free), f'{1e3 * deepest:.1f} mm' if deepest else '',
               microseconds(statistics.median(float(row['median_us']) for row in clear)),
               short(statistics.median(float(row['nodes']) for row in clear))]


def family_lines(rows, methods):
    clear = [row for row in rows if row['workload'] == CLEAR]
    for family in dict.fromkeys(row['parameter'] for row in clear):
        of = {row['method']: row for row in clear if row['parameter'] == family}
        yield [family.split()[0].replace('_', ' '), microseconds(float(of[targets.OURS]['median_us'])),
               *(said([of[method]]) for method in methods)]


def page(figures, out):
    rows = [row for row in figures.rows if row['group'] == 'optimise']
    methods = list(dict.fromkeys(row['method'] for row in rows))
    return f'''# Motions made smooth and clear

A Panda in the scenes of seven families of MotionBenchMaker. A motion is a cubic B-spline of the joints; NLopt's SLSQP
makes its squared jerk least, within the joint limits, 10 mm clear of the scene and of the robot itself. The motions begin
as paths of an RRT and as straight lines between their ends, some of them in contact (`bench/optimise`).

- `curve_proximity`: the constraints are certified rows of the whole motion, and the end is proven, as in
  [push_out_arm.cpp](../../examples/push_out_arm.cpp).
- `FCL rows`: the same constraints and the same rules to stop; the distances are FCL's signed ones at 20, 50 or 200 states.
- `FCL hinges`: the objective has a hinge for each pair at each of these states, max(0, 11 mm - distance)². Its weight
  grows tenfold, up to five times, until all samples are 10 mm clear.

A method by samples says what its samples say. **Wrong**: a certified distance of the whole motion, or FCL at 1000 of its
states, is less than was said. Deepest: the depth of the worst motion that was said to be free of contact.

{table(['method', 'motions', 'said clear by 10 mm', 'said free of contact', 'deepest', 'time', 'evaluations'],
       list(method_lines(rows, methods)))}

Time and evaluations: medians over the motions of a family, then over the families. An evaluation asks for all clearances
of one motion; the time is that of the processor, the proof of `curve_proximity` included.

{picture(out, 'optimise', 'Time of a motion by method and family; the table above has how many are wrong')}

## By family
Time of `curve_proximity`, and how many motions each method says to be 10 mm clear.

{table(['family', 'time', *methods], list(family_lines(rows, methods)))}
'''
