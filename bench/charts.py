# SPDX-License-Identifier: BSD-3-Clause
"""Charts of results.csv, one look for all: SVG and PNG beside the file."""
import os
import re
import textwrap

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib import ticker  # noqa: E402

from fourier import charts as fourier_charts  # noqa: E402

OURS = 'curve_proximity'
COLOURS = {OURS: '#0b6e99', 'paper': '#c2571a'}
OTHERS = ['#6b8e23', '#7b4ea3', '#8c6d3f', '#4d4d4d', '#b03060']
MARKERS = ['o', 's', 'D', '^', 'v', 'P', 'X']
LABELS = {OURS: 'curve_proximity (certified)', 'paper': 'Lakshmanan et al. 2019, as published',
          'two-ended bound': 'certified, by both ends of an interval', 'bound M2': 'certified, by its middle and the speed',
          'bound M3': 'certified, by its middle and the acceleration', 'bound M4': 'certified, by its middle and the third derivative',
          'sampling': 'samples (nothing proven)', 'sampling .05': 'samples at .05 rad (nothing proven)',
          'naive': 'interior point, as published', 'supports': 'support functions alone', 'interior_point': 'interior point alone', 'ipopt': 'Ipopt'}
# The objects of Fig. 5 of Chakraborty et al.
OBJECTS = {'I': 'I diamond', 'II': 'II column', 'III': 'III rounded box', 'IV': 'IV mouse', 'V': 'V nut', 'VI': 'VI pyramid'}


def style():
    plt.rcParams.update({'figure.figsize': (7.2, 4.4), 'figure.dpi': 110, 'font.size': 10, 'axes.spines.top': False,
                         'axes.spines.right': False, 'axes.grid': True, 'axes.axisbelow': True, 'grid.color': '#dddddd', 'grid.linewidth': 0.6,
                         'legend.frameon': False, 'lines.linewidth': 1.8, 'lines.markersize': 5, 'svg.hashsalt': 'cprox'})


def colour_of(method, seen):
    if method in COLOURS:
        return COLOURS[method]
    if method not in seen:
        seen.append(method)
    return OTHERS[seen.index(method) % len(OTHERS)]


def corner_below(figure, gap):
    """The lower left corner of all that is drawn, and below it by a gap [inches]; in fractions of the figure."""
    box = figure.get_tightbbox(figure.canvas.get_renderer())
    width, height = figure.get_size_inches()
    return box.x0 / width, (box.y0 - gap) / height


class Saver:
    """Writes figures to a folder, each with a line below it that says how its rows were made."""

    def __init__(self, out, made):
        self.out, self.made = out, textwrap.fill(made.replace('`', ''), 110)

    def __call__(self, figure, name):
        figure.text(*corner_below(figure, 0.12), self.made, va='top', fontsize=7, color='#777777')
        for suffix in ('svg', 'png'):
            figure.savefig(os.path.join(self.out, f'{name}.{suffix}'), bbox_inches='tight')
        plt.close(figure)
        return name


def legend_below(axes):
    """The legend, where it hides nothing and takes no width."""
    handles, labels = axes.get_legend_handles_labels()
    axes.figure.legend(handles, labels, loc='upper left', bbox_to_anchor=corner_below(axes.figure, 0.05), ncol=2)


def readable(axis):
    """A logarithmic axis of few decades has labels between them."""
    low, high = axis.get_view_interval()
    if 0.0 < low and high < 300.0 * low:
        axis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_minor_formatter(ticker.NullFormatter())
    if 1e-3 < low and high < 1e6:
        axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f'{value:,.12g}'))


def methods_of(rows):
    """Ours first, then in the order of the file."""
    names = list(dict.fromkeys(row['method'] for row in rows))
    return sorted(names, key=lambda name: (not name.startswith(OURS), names.index(name)))


def points_of(rows, parameter, reached):
    """Method, number, median and p95 of the rows whose parameter matches a pattern, whose one group is the number. Methods without such a row
    may have some that match `reached`: these stand at the error that they made."""
    points = []
    for row in rows:
        match = re.fullmatch(parameter, row['parameter'])
        if match:
            points.append((row['method'], float(match.group(1)), float(row['median_us']), float(row['p95_us'])))
    with_number = {point[0] for point in points}
    for row in rows:
        if reached and row['method'] not in with_number and re.fullmatch(reached, row['parameter']):
            points.append((row['method'], max(float(row['error'] or 'nan'), 1e-16), float(row['median_us']), float(row['p95_us'])))
    return points


def work_precision(rows, save, group, workload, parameter, title, name, x_label='width of the interval asked for [m]', reached=None):
    """Time against the accuracy asked; see points_of()."""
    points = points_of([row for row in rows if (row['group'], row['workload']) == (group, workload)], parameter, reached)
    if not points:
        return None
    figure, axes = time_against(points)
    axes.set_xscale('log')
    readable(axes.xaxis)
    axes.invert_xaxis()
    without = ';\nof methods without: error made [m]' if reached and any(re.fullmatch(reached, row['parameter']) for row in rows) else ''
    axes.set_xlabel(f'more accurate →\n{x_label}{without}')
    axes.set_title(title)
    legend_below(axes)
    return save(figure, name)


def growth(rows, save, group, workload, parameter, title, name, x_label):
    """Time against a size, both logarithmic, so that a power is a straight line."""
    points = points_of([row for row in rows if (row['group'], row['workload']) == (group, workload)], parameter, None)
    if not points:
        return None
    figure, axes = time_against(points)
    ours = sorted(point[1:3] for point in points if point[0].startswith(OURS))
    if len(ours) > 1:
        (x, y), last = ours[0], ours[-1][0]
        axes.plot([x, last], [y, y * last / x], ':', color='#999999', linewidth=1, label='in proportion to the size')
    axes.set_xscale('log')
    axes.set_xticks(sorted({point[1] for point in points}))
    axes.xaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f'{value:,.12g}'))
    axes.xaxis.set_minor_locator(ticker.NullLocator())
    axes.set_xlabel(x_label)
    axes.set_title(title)
    legend_below(axes)
    return save(figure, name)


def time_against(points):
    """Lines of the medians of (method, x, median, p95), and bands up to p95."""
    figure, axes = plt.subplots()
    seen = []
    for method in methods_of([{'method': p[0]} for p in points]):
        x, median, p95 = zip(*sorted(p[1:] for p in points if p[0] == method))
        colour = colour_of(method, seen)
        axes.semilogy(x, median, 'o-', color=colour, label=LABELS.get(method, method))
        axes.fill_between(x, median, p95, color=colour, alpha=0.13, linewidth=0)
    readable(axes.yaxis)
    has_band = any(p95 > 1.001 * median for _, _, median, p95 in points)
    axes.set_ylabel('median time a query [µs]' + ('; band: to 95 %' if has_band else ''))
    return figure, axes


def dots(rows, save, group, select, title, name, label=lambda row: f"{row['workload']}, {row['parameter']}", time='median time a query [µs]'):
    """Time of each method: one line of dots for each workload and parameter that select(row) takes. A dot on a logarithmic axis says where it
    is; a bar would say by its length what depends on where the axis begins. A hollow dot has wrong answers; the legend counts them."""
    rows = [row for row in rows if row['group'] == group and select(row)]
    keys = list(dict.fromkeys(label(row) for row in rows))
    if not keys:
        return None
    figure, axes = plt.subplots(figsize=(7.2, 1.2 + 0.27 * len(keys)))
    seen = []
    for k, method in enumerate(methods_of(rows)):
        values = {label(row): (float(row['median_us']), int(float(row['unsound'] or 0))) for row in rows if row['method'] == method}
        colour, wrong = colour_of(method, seen), sum(unsound for _, unsound in values.values())
        for hollow in (False, True):
            y = [i for i, key in enumerate(keys) if key in values and bool(values[key][1]) == hollow]
            axes.plot([values[keys[i]][0] for i in y], y, MARKERS[k % len(MARKERS)], color=colour, markerfacecolor='white' if hollow else colour)
        axes.plot([], [], MARKERS[k % len(MARKERS)], color=colour, markerfacecolor='white' if wrong else colour,
                  label=LABELS.get(method, method) + (f', {wrong} wrong' if wrong else ''))
    axes.set_xscale('log')
    axes.set_yticks(range(len(keys)))
    axes.set_yticklabels(keys)
    axes.set_ylim(len(keys) - 0.5, -0.5)
    axes.set_xlabel(time)
    axes.set_title(title)
    readable(axes.xaxis)
    legend_below(axes)
    return save(figure, name)


def curves(rows, save):
    pattern = r'order \d+ eps (1e-\d+)'
    for workload, name in (('polytope 3-D distance', 'polytope'), ('polygon 2-D distance', 'polygon'), ('point 2-D distance', 'point'),
                           ('curves 3-D distance', 'curve_curve')):
        order = '5' if name == 'curve_curve' else '15'
        yield work_precision(rows, save, 'curves', workload, pattern.replace(r'\d+ eps', order + ' eps', 1),
                             f'{workload}, order {order}: time against accuracy', f'work_precision_{name}',
                             reached=rf'order {order} (samples \d+|as it is)')
    yield dots(rows, save, 'curves', lambda row: row['workload'].endswith('distance') and row['parameter'].endswith('eps 1e-10'),
               'Distance to 1e-10', 'distance_by_order', lambda row: f"{row['workload'][:-9]}, {row['parameter'][:8]}")
    yield dots(rows, save, 'curves', lambda row: 'tolerance' in row['workload'] and 'order 15' in row['parameter'],
               'Farther than delta? Order 15, delta as a fraction of the distance', 'tolerance',
               lambda row: f"{row['workload'].split(' tolerance')[0]}, {row['parameter'][9:]}")


def splines(rows, save):
    for space in ('2-D', '3-D'):
        yield growth(rows, save, 'splines', f'B-spline {space} distance', r'(\d+) segments', f'Cubic B-splines, {space}: distance to 1e-10',
                     f'splines_{space[0]}', 'segments')
    for curve, title in (('B-spline', 'Cubic B-splines of 100 segments'), ('trigonometric', 'Trigonometric series')):
        yield work_precision(rows, save, 'splines', f'{curve} 3-D accuracy', r'eps (1e-\d+)', f'{title} and a polytope: time against accuracy',
                             f'work_precision_{curve.lower()}', reached=r'samples \d+')
    yield dots(rows, save, 'splines', lambda row: row['workload'].startswith('trigonometric') and 'accuracy' not in row['workload'], 'Compiled trigonometric series', 'trigonometric',
               lambda row: row['workload'][14:])


def peers(rows, save):
    for workload, name in (('point and curve', 'points'), ('curve and curve', 'curves'), ('path distance', 'paths'),
                           ('time of contact', 'time_of_contact')):
        yield dots(rows, save, 'peers', lambda row: row['workload'] == workload, workload[0].upper() + workload[1:], f'peers_{name}',
                   lambda row: row['parameter'])


def batches(rows, save):
    yield dots(rows, save, 'batches', lambda row: row['workload'].startswith(('polygons', 'boxes')), 'A thousand quintic Bézier curves', 'batches',
               lambda row: f"{row['workload']}, {row['parameter']}", 'median time of all curves [µs]')
    for query_type in ('distance', 'tolerance', 'collision'):
        yield rates(rows, save, f'boxes {query_type}', f'Batches of a thousand quintics, {query_type}', f'batches_rate_{query_type}')
    yield threads(rows, save)


def rates(rows, save, workload, title, name):
    """Curves a second against the number of obstacles."""
    rows = [row for row in rows if row['group'] == 'batches' and row['workload'] == workload]
    if not rows:
        return None
    figure, axes = plt.subplots()
    seen = []
    for method in methods_of(rows):
        mine = sorted((float(row['parameter'].split()[0]), 1e9 / float(row['median_us'])) for row in rows if row['method'] == method)
        axes.loglog(*zip(*mine), 'o-', color=colour_of(method, seen), label=LABELS.get(method, method))
    readable(axes.xaxis)
    readable(axes.yaxis)
    axes.set_xlabel('obstacles')
    axes.set_ylabel('curves a second, one thread')
    axes.set_title(title)
    legend_below(axes)
    return save(figure, name)


def threads(rows, save):
    """Curves a second against threads."""
    rows = [row for row in rows if row['group'] == 'threads' and row['workload'].startswith('growth threads')]
    if not rows:
        return None
    figure, axes = plt.subplots()
    for k, workload in enumerate(dict.fromkeys(row['workload'] for row in rows)):
        mine = sorted((int(row['parameter'].split()[0]), 1e9 / float(row['median_us'])) for row in rows if row['workload'] == workload)
        axes.plot(*zip(*mine), 'o-', color=[COLOURS[OURS], *OTHERS][k], label=workload.split()[-1])
        axes.plot([n for n, _ in mine], [n * mine[0][1] for n, _ in mine], ':', color='#999999', linewidth=1)
    axes.set_xticks(sorted({int(row['parameter'].split()[0]) for row in rows}))
    axes.set_ylim(bottom=0)
    axes.set_xlabel('threads; dotted: in proportion')
    axes.set_ylabel('curves a second')
    axes.set_title('A thousand quintics against a hundred boxes, over threads')
    legend_below(axes)
    return save(figure, 'batches_threads')


def worlds(rows, save):
    for what, unit, title in (('mesh distance', 'triangles', 'Quintic curves against a mesh: certified to 1e-6, and 100 samples'),
                              ('set distance', 'targets', 'One curve against many boxes at one density')):
        yield growth(rows, save, 'worlds', what, unit + r' (\d+)', title, 'worlds_' + what.replace(' ', '_'), unit)


SAMPLERS = {'the same lanes': 'samples by the same lanes', 'VAMP': 'samples by VAMP', 'FCL': 'samples by FCL'}


def edges(rows, save, workload, title, name):
    """The time of an edge over how many verdicts are wrong: certified, and by samples from coarse to fine of each sampler."""
    rows = [row for row in rows if (row['group'], row['workload']) == ('robots', workload)]
    if not rows:
        return None
    figure, axes = plt.subplots()
    seen = []
    own = [row for row in rows if row['method'] == OURS]
    axes.plot([float(row['unsound']) for row in own], [float(row['median_us']) for row in own], 'o', color=COLOURS[OURS], label=LABELS[OURS])
    for sampler, label in SAMPLERS.items():
        found = [(re.fullmatch(sampler + r' at (\d+) a radian', row['method']), row) for row in rows]
        points = [(int(match[1]), float(row['unsound']), float(row['median_us'])) for match, row in found if match]
        if not points:
            continue
        colour = colour_of(sampler, seen)
        axes.plot([wrong for _, wrong, _ in points], [time for _, _, time in points], MARKERS[len(seen)] + '-', color=colour,
                  label=f'{label} (nothing proven)')
        for fineness, wrong, time in points:
            axes.annotate(str(fineness), (wrong, time), textcoords='offset points', xytext=(5, 4), fontsize=7, color=colour)
    axes.set_xscale('symlog', linthresh=1)
    axes.set_yscale('log')
    axes.invert_xaxis()
    axes.set_xlabel('fewer wrong →\nwrong verdicts; numbers: samples a radian')
    axes.set_ylabel('median time an edge [µs]')
    axes.set_title(title)
    readable(axes.yaxis)
    legend_below(axes)
    return save(figure, name)


def edge_levels(rows, save):
    """Which level decided what share of the edges, over how near they come to the scene: a panel for each kind of robot."""
    rows = [row for row in rows if (row['group'], row['workload']) == ('robots', 'levels of edges')]
    robots_of = list(dict.fromkeys(row['parameter'].split(':')[0] for row in rows))
    if not rows:
        return None
    figure, panels = plt.subplots(1, len(robots_of), figsize=(3.4 * len(robots_of), 3.2), sharey=True, squeeze=False)
    levels = list(dict.fromkeys(row['method'] for row in rows))
    for axes, robot in zip(panels[0], robots_of):
        mine = [row for row in rows if row['parameter'].split(':')[0] == robot]
        ranges = list(dict.fromkeys(row['parameter'].split(': ')[1] for row in mine))
        left = [0.0] * len(ranges)
        for level, colour in zip(levels, (COLOURS[OURS], '#6fb1cf', '#6b8e23', '#e0a030', '#c22020')):
            share = {row['parameter'].split(': ')[1]: 100.0 * float(row['error']) for row in mine if row['method'] == level}
            widths = [share.get(name, 0.0) for name in ranges]
            axes.barh(range(len(ranges)), widths, left=left, height=0.75, color=colour, label=level.replace('decided ', ''))
            left = [before + width for before, width in zip(left, widths)]
        axes.set_yticks(range(len(ranges)))
        axes.set_yticklabels(ranges)
        axes.set_xlim(0, 100)
        axes.set_title(robot.replace('panda', 'Panda'))
        axes.set_xlabel('percent of the edges')
        for i, name in enumerate(ranges):
            count = next(row['nodes'] for row in mine if row['parameter'].endswith(': ' + name))
            axes.text(101, i, count, va='center', fontsize=7, color='#777777')
    panels[0][0].set_ylabel('nearest to the scene')
    legend_below(panels[0][0])
    return save(figure, 'robots_edge_levels')


def robots(rows, save):
    for workload in ('all edges', 'grazing edges'):
        yield edges(rows, save, workload, f'A Panda by 59 balls, {workload} of a planner: time against wrong verdicts',
                    'robots_' + workload.replace(' ', '_'))
    yield edge_levels(rows, save)
    for workload in ('environment', 'self'):
        bounded = [row for row in rows if row['method'] != 'sampling .05']  # which knows no epsilon; "sampling" stands at its error
        yield work_precision(bounded, save, 'robots', workload, r'epsilon ([0-9.e-]+)', f'Robots, {workload}: time against accuracy',
                             f'robots_{workload}', reached=r'step .*')
    yield dots(rows, save, 'robots', lambda row: row['workload'] == 'tolerance', 'Robots: farther than delta?', 'robots_verdicts',
               lambda row: row['parameter'].replace('delta ', ''))
    yield dots(rows, save, 'robots', lambda row: row['workload'] == 'planning',
               'A Panda in seven scenes: certified minimum to 1 mm, and checks of states', 'robots_planning',
               lambda row: row['parameter'].replace('panda_', '').replace('_0001_rrt', '').replace('_', ' '))
    for what in dict.fromkeys(row['workload'] for row in rows if row['group'] == 'robots' and row['workload'].startswith('growth')):
        yield growth(rows, save, 'robots', what, r'\D*(\d+).*', f'Robots: time over the number of {what.split()[1]}', 'robots_' + what.replace(' ', '_'), what.split()[1])


def optimise(rows, save):
    yield dots(rows, save, 'optimise', lambda row: row['workload'] == 'clear by 10 mm', 'A motion of a Panda made smooth and clear',
               'optimise', lambda row: row['parameter'].split()[0].replace('_', ' '), 'median time a motion [µs]')


def implicit(rows, save):
    """Table I of Chakraborty et al. as bars, and its Fig. 2."""
    yield dots(rows, save, 'implicit', lambda row: row['workload'] == 'table I', 'Pairs of implicit bodies to 1e-8 of their size', 'implicit_pairs',
               lambda row: ' and '.join(OBJECTS[name] for name in row['parameter'].split('-')))
    yield accuracies(rows, save)
    yield dots(rows, save, 'implicit', lambda row: row['workload'] == 'as meshes', 'Pairs of implicit bodies, and as meshes of 19,000 triangles',
               'implicit_meshes', lambda row: ' and '.join(OBJECTS[name] for name in row['parameter'].split('-')))
    yield dots(rows, save, 'implicit', lambda row: row['workload'] == 'growth gradient', 'Growth distances with their gradients',
               'implicit_growth', lambda row: row['parameter'].replace('-', ' and '))
    for kind in ('planes', 'quadrics', 'superquadrics'):
        yield growth(rows, save, 'implicit', f'figure 2 {kind}', r'(\d+)', f'Bodies of many {kind}', f'seeds_figure_2_{kind}',
                     'constraints of both bodies')


def accuracies(rows, save):
    """Objects II and III to 1e-2 … 1e-12 of their sizes."""
    found = [row for row in rows if row['group'] == 'implicit' and row['workload'] == 'accuracy']
    figure, axes = plt.subplots()
    names = {'curve_proximity': 'ours together', 'interior_point': 'our interior point', 'supports': 'support functions', 'ipopt': 'Ipopt'}
    for method, name in names.items():
        mine = [row for row in found if row['method'] == method]
        if mine:
            axes.loglog([float(row['parameter']) for row in mine], [float(row['median_us']) for row in mine], 'o-', label=name)
    axes.invert_xaxis()
    axes.set_xlabel('accuracy asked for, of the size of both bodies')
    axes.set_ylabel('time [µs]')
    axes.set_title('Objects II and III: time against accuracy')
    legend_below(axes)
    return save(figure, 'implicit_accuracy') if found else plt.close(figure)


def fourier(rows, save):
    yield from fourier_charts.draw(rows, save, legend_below)
    yield dots(rows, save, 'fourier', lambda row: row['workload'] == 'boxes', 'Two boxes: a gap beside a distance', 'fourier_boxes')


def seeds(rows, save):
    """Fig. 7 and 10 of Lakshmanan et al., and its Table II as bars."""
    yield narrowing(rows, save)
    yield reaches(rows, save)
    yield memory(rows, save)
    for query_type in ('distance', 'tolerance', 'collision'):
        yield growth(rows, save, 'seeds', f'figure 10 {query_type}', r'order (\d+)', f'Bézier curves and a point, {query_type}',
                     f'seeds_figure_10_{query_type}', 'order of the curve')
    yield dots(rows, save, 'seeds', lambda row: row['workload'].startswith('table II'), 'The pairs of Table II', 'seeds_table_2',
               lambda row: f"{row['parameter'][2:].replace(' | ', ' and ')}: {row['workload'][9:]}")


def narrowing(rows, save):
    figure, axes = plt.subplots()
    found = [row for row in rows if row['group'] == 'seeds' and row['workload'] == 'figure 7']
    for method in methods_of(found):
        mine = [row for row in found if row['method'] == method]
        axes.semilogy([float(row['nodes']) for row in mine], [float(row['error']) for row in mine], 'o-', color=colour_of(method, []),
                      label=LABELS.get(method, method))
    axes.set_xlabel('intervals examined')
    axes.set_ylabel('upper - lower [m]')
    axes.set_title('A curve of order 13 and a polygon: how the interval narrows')
    legend_below(axes)
    return save(figure, 'seeds_figure_7') if found else plt.close(figure)


def reaches(rows, save):
    """What Theorem 1's ellipsoids are worth beside control points: the three curves of Fig. 11 a to c, cut in equal parts."""
    found = [row for row in rows if row['group'] == 'seeds' and row['workload'] == 'figure 11 reach']
    figure, axes = plt.subplots()
    for style_of, method in (('--', 'ellipsoids'), ('-', 'control points')):
        for number, curve in enumerate(sorted({row['parameter'] for row in found})):
            mine = [row for row in found if (row['method'], row['parameter']) == (method, curve)]
            axes.loglog([float(row['nodes']) for row in mine], [float(row['error']) for row in mine], style_of, marker='o', markersize=3,
                        color=f'C{number}', label=f'{curve[2:]}, {method}')
    axes.set_xlabel('parts of the curve')
    axes.set_ylabel('mean reach beyond the chord [m]')
    axes.set_title('Curves of Fig. 11 a, b, c: ellipsoids by arc length, and control points')
    legend_below(axes)
    return save(figure, 'seeds_figure_11_reach') if found else plt.close(figure)


def memory(rows, save):
    found = [row for row in rows if row['group'] == 'seeds' and row['workload'] == 'figure 10 memory']
    figure, axes = plt.subplots()
    names = {'curve_proximity': 'ours: curve, workspace', 'the curve alone': 'ours: the curve alone', 'paper': 'published: nodes examined, curve'}
    for method, name in names.items():
        mine = [row for row in found if row['method'] == method]
        axes.plot([int(row['parameter'][6:]) for row in mine], [float(row['error']) / 1024 for row in mine], 'o-', label=name)
    axes.set_xlabel('order of the curve')
    axes.set_ylabel('memory [KiB]')
    axes.set_ylim(bottom=0)
    axes.set_title('Memory of a curve and the search for its distance from a point')
    legend_below(axes)
    return save(figure, 'seeds_figure_10_memory') if found else plt.close(figure)


HARD = (('curves', lambda row: row['group'] == 'stability' and not row['workload'].startswith(('plate', 'graze', 'gap: '))),
        ('thin plates and grazes', lambda row: row['group'] == 'stability' and row['workload'].startswith(('plate', 'graze'))),
        ('overlapping solids', lambda row: row['group'] == 'stability' and row['workload'].startswith('gap: ')),
        ('implicit bodies', lambda row: (row['group'], row['workload']) == ('implicit', 'hard families')))


def stability(rows, save):
    """What each method says of the hard inputs that it was asked about: the shares of right, wrong and given up, over all families."""
    bars = []
    for title, of in HARD:
        counted = {}
        for row in filter(of, rows):
            cases = int(re.search(r'(\d+) cases', row['parameter'])[1])
            before = counted.get(row['method'], (0, 0, 0))
            counted[row['method']] = tuple(a + b for a, b in zip(before, (cases, int(row['unsound']), int(row['failures']))))
        bars += [(f'{title}: {LABELS.get(method, method)}', *counted[method]) for method in sorted(counted, key=lambda name: name != OURS)]
    if not any(cases for _, cases, _, _ in bars):
        return
    figure, axes = plt.subplots(figsize=(7.2, 0.8 + 0.27 * len(bars)))
    places = range(len(bars), 0, -1)
    shares = [(100 * (cases - wrong - open_) / cases, 100 * wrong / cases, 100 * open_ / cases) for _, cases, wrong, open_ in bars]
    left = [0.0] * len(bars)
    for k, (name, colour) in enumerate((('right', COLOURS[OURS]), ('wrong', '#c22020'), ('given up', '#bbbbbb'))):
        axes.barh(places, [share[k] for share in shares], left=left, height=0.7, color=colour, label=name)
        left = [before + share[k] for before, share in zip(left, shares)]
    axes.set_yticks(list(places))
    axes.set_yticklabels([f'{name} ({cases})' for name, cases, _, _ in bars], fontsize=8)
    axes.set_xlim(0, 100)
    axes.set_xlabel('percent of the cases that the method was asked about (their number)')
    axes.set_title('Hard inputs: right, wrong, given up')
    legend_below(axes)
    yield save(figure, 'stability')


def draw_all(rows, out, made):
    """All charts for which there are rows; their names. made: how the rows were made."""
    save = Saver(out, made)
    style()
    drawn = []
    for draw in (curves, splines, peers, seeds, batches, worlds, robots, optimise, implicit, stability, fourier):
        drawn += [name for name in draw(rows, save) if name]
    return drawn
