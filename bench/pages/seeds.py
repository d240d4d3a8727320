# SPDX-License-Identifier: BSD-3-Clause
"""seeds.md: the tables of the papers, measured again, beside the values that they print."""
import csv
import os

from pages.figures import microseconds, picture, table

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'test', 'data', 'reference')

PAPER = 'paper'


def arc_lengths(figures):
    """Table I of Lakshmanan et al.: printed in nanoseconds."""
    printed = {'2 cos t | sin t': (1710.70, 58.02), 't^3 + t | t': (1673.80, 44.69), '1/(t + 1) | t': (2102.11, 38.43)}
    lines = []
    for curve, (length, bound) in printed.items():
        here = [figures.number('seeds', 'table I', curve, method=name) for name in ('length by quadrature', 'bound in closed form')]
        lines.append([curve.replace(' | ', ', '), f'{length:.0f} ns', microseconds(here[0]), f'{bound:.0f} ns', microseconds(here[1])])
    return table(['curve', 'length, printed', 'length, here', 'bound, printed', 'bound, here'], lines)


def proximity(figures):
    """Table II of Lakshmanan et al.: printed in microseconds."""
    printed = {'a heart | polygon': (208.22, 10.52, 10.38), 'b epicycloid | polygon': (234.52, 80.90, 59.19),
               'c Euler spiral | polygon': (150.03e3, 29.70e3, 17.08e3), 'd Bezier | Bezier': (425.66, 49.20, 37.66),
               'e involute | involute': (1.21e3, 204.68, 116.22), 'f fish | Lissajous': (3.74e3, 471.99, 229.25)}
    lines = []
    for pair, values in printed.items():
        for query_type, value in zip(('distance', 'tolerance', 'collision'), values):
            key = ('seeds', f'table II {query_type}', pair)
            lines.append([pair.replace(' | ', ', ') if query_type == 'distance' else '', query_type, microseconds(value),
                          figures.time(*key, method=PAPER), figures.time(*key), figures.count(*key, method=PAPER, column='nodes'),
                          figures.count(*key, column='nodes')])
    return table(['pair', 'query', 'printed', 'its method here', 'ours', 'its intervals', 'ours'], lines)


def orders(figures):
    lines = []
    for order in range(5, 50, 5):
        line = [str(order)]
        for query_type in ('distance', 'tolerance', 'collision'):
            key = ('seeds', f'figure 10 {query_type}', f'order {order:02d}')
            line += [figures.time(*key, method=PAPER), figures.time(*key)]
        lines.append(line)
    return table(['order', 'distance, its method', 'ours', 'tolerance, its method', 'ours', 'collision, its method', 'ours'], lines)


def ellipsoids(figures):
    """Intervals of a search to 1e-10 by the ellipsoids of Theorem 1, by control points, and by the published method."""
    lines = []
    for curve in ('a heart', 'b epicycloid', 'c Euler spiral'):
        key = ('seeds', 'figure 11 ellipsoids', curve)
        lines.append([curve] + [figures.count(*key, method=PAPER, column='nodes'), figures.count(*key, column='nodes')] +
                     [figures.count('seeds', 'figure 11 intervals', curve, method='control points', column='nodes')] +
                     [figures.time(*key, method=PAPER), figures.time(*key)])
    return table(['curve', 'intervals, its method', 'our search, ellipsoids', 'our search, control points', 'time, its method',
                  'our search, ellipsoids'], lines)


def sorted_curves():
    """The thousand curves of the replanning example by class: far from both obstacles, too near, in collision."""
    with open(os.path.join(DATA, 'replan_curves.csv')) as text:
        classes = [row[4] for row in csv.reader(line for line in text if not line.startswith('#'))]
    return tuple(classes.count(name) for name in '123')


def replanning(figures):
    clear, near, hit = sorted_curves()
    key = ('batches', 'polygons tolerance', '2 obstacles')
    return (f"Printed: 11.6 ms for 1000 quintics and both obstacles. Here its method takes {figures.time(*key, method=PAPER)}, "
            f"ours {figures.time(*key)}.\nThe paper's curves are not published: of its thousand, 66 are clear, 116 too near and 818 in "
            f"collision;\nof the thousand here {clear}, {near} and {hit}, as the reference sorts them, too.")


def implicit_pairs(figures):
    """Table I of Chakraborty et al.: printed in milliseconds."""
    printed = {'I-II': .84, 'I-III': .91, 'II-III': .70, 'III-IV': .85, 'II-IV': .76, 'III-V': .78, 'V-VI': .89, 'III-VI': .89}
    lines = []
    for pair, value in printed.items():
        key = ('implicit', 'table I', pair)
        ipopt = [row for row in figures.rows if (row['workload'], row['parameter'], row['method']) == ('table I', pair, 'ipopt')]
        peer = [microseconds(float(ipopt[0]['median_us'])), ipopt[0]['failures']] if ipopt else ['not measured', '']
        lines.append([pair, microseconds(1e3 * value), *peer, figures.time(*key, method='interior_point'), figures.time(*key),
                      figures.row(*key)['failures']])
    return table(['objects', 'printed', 'Ipopt', 'its failures', 'our interior point', 'ours together', 'our failures'], lines)


def implicit_motion(figures):
    """Tables II and III of Chakraborty et al.: printed in milliseconds."""
    printed = [('table II closest distance', 'I-III', 1.32), ('table II closest distance', 'II-III', .97),
               ('table II time of contact', 'I-III', 2.03), ('table II time of contact', 'II-III', 1.51),
               ('table III scaling', 'I-III', 1.04), ('table III scaling', 'II-III', .75),
               ('table III exponents', 'I-III', .87), ('table III exponents', 'II-III', .84)]
    lines = [[name, pair, microseconds(1e3 * value), figures.time('implicit', name, pair)] for name, pair, value in printed]
    return table(['table and query', 'objects', 'printed', 'ours'], lines)


def motions(figures):
    """Iterations from scratch and from where the search before ended."""
    lines = []
    for pair in ('II-III', 'III-IV', 'V-VI'):
        for step in ('0.1', '0.01', '0.001'):
            key = ('implicit', 'motion', f'{pair} step {step}')
            lines.append([pair, step, figures.count(*key, column='nodes'), figures.count(*key, method='curve_proximity tracked', column='nodes')])
    return table(['objects', 'step [m, rad]', 'from scratch', 'from the former answer'], lines)


def page(figures, out):
    return f'''# The papers' own tables, measured again

Printed values come from other machines and, where inputs are not published (where the curves of Fig. 11 stand, the polygons, the vehicle's
curves), from other problems of the same kind: compare orders of magnitude there. What was run here ran in one process, in turns; "its
method" is the published method, written again as described (`bench/paper`).

## Proximity Queries for Absolutely Continuous Parametric Curves

A. Lakshmanan, A. Patterson, V. Cichella, N. Hovakimyan, RSS 2019
(printed: Julia, 2.3 GHz Core i5)

**Table I**, the length of an interval of a curve and its bound by Eq. 6:

{arc_lengths(figures)}

**Table II**, the pairs of Fig. 11, to 1e-10; tolerance at half of the distance:

{proximity(figures)}

{picture(out, 'seeds_table_2', 'Table II: time of the published method and of ours')}

**Fig. 6**, stages of a search, by `bench/pictures.py`:

{picture(out, 'papers_figure_6', 'Fig. 6: stages of a search')}

**Fig. 7**, the width of the interval against intervals examined:

{picture(out, 'seeds_figure_7', 'Fig. 7: convergence')}

**Fig. 8**, glyphs, by `bench/pictures.py`:

{picture(out, 'papers_figure_8', 'Fig. 8: glyphs')}

**Fig. 11**, intervals by the ellipsoids of Theorem 1, and how far they reach:

{ellipsoids(figures)}

Our search asks for 30, 25 and 46 arc lengths, the published method for 126, 130 and 142 values of their integral. Its
bounds take rounding into account; those of the published method do not.

{picture(out, 'seeds_figure_11_reach', 'Fig. 11: how far ellipsoids and control points reach')}

**§V-D**, confidence regions, by `bench/pictures.py`:

{picture(out, 'papers_section_5d', 'Section V-D: confidence regions')}

**Fig. 10**, ten random Bézier curves of each order and a point, medians:

{orders(figures)}

{picture(out, 'seeds_figure_10_distance', 'Fig. 10 a: distance over the order')}

{picture(out, 'seeds_figure_10_tolerance', 'Fig. 10 a: tolerance over the order')}

{picture(out, 'seeds_figure_10_collision', 'Fig. 10 a: collision over the order')}

**Fig. 10 b**, memory:

{picture(out, 'seeds_figure_10_memory', 'Fig. 10 b: memory over the order')}

**Fig. 12**, replanning. {replanning(figures)}

## Proximity Queries Between Convex Objects: An Interior Point Approach for Implicit Surfaces

N. Chakraborty, J. Peng, S. Akella, J. Mitchell, 2008
(printed: KNITRO 5.0 on a 2.2 GHz Athlon 64, to 1e-8)

**Table I**:

{implicit_pairs(figures)}

**Tables II and III**, translation and deformation:

{implicit_motion(figures)}

**Coherence**: iterations of a pair that moves in steps, 6 m apart. The paper's places have none; `start` of `cprox_options`:

{motions(figures)}

**Accuracy**, time against the accuracy asked for, beside support functions and Ipopt, and **as meshes** of 19,000 triangles, which the paper
gave to PQP, FCL's mesh distance beside ours: the implicit charts of [README.md](README.md#all-charts).

**Fig. 2**, time against the number of constraints; exponents in [growth](README.md#growth):

{picture(out, 'seeds_figure_2_planes', 'Fig. 2: time over the number of planes')}

{picture(out, 'seeds_figure_2_quadrics', 'Fig. 2: time over the number of quadrics')}

{picture(out, 'seeds_figure_2_superquadrics', 'Fig. 2: time over the number of superquadrics')}

## Fourier Collision Detection

M. Lysenko, 2011. It prints no figures, only pictures: Fig. 3 is `fourier_over_reach`, Fig. 5 `fourier_convergence`, Fig. 6
`fourier_obstacle`, among the Fourier charts of [README.md](README.md#all-charts).
'''
