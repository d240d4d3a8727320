# SPDX-License-Identifier: BSD-3-Clause
"""Charts of results.csv, one look for all: SVG and PNG beside the file."""
import os
import re

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib import ticker  # noqa: E402

from fourier import charts as fourier_charts  # noqa: E402

OURS = 'curve_proximity'
COLOURS = {OURS: '#0b6e99', 'paper': '#c2571a'}
OTHERS = ['#6b8e23', '#7b4ea3', '#8c6d3f', '#4d4d4d', '#b03060']
LABELS = {OURS: 'curve_proximity (certified)', 'paper': "Lakshmanan et al. 2019, as published"}


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


def save(figure, out, name):
    for suffix in ('svg', 'png'):
        figure.savefig(os.path.join(out, f'{name}.{suffix}'), bbox_inches='tight')
    plt.close(figure)
    return name


def beside(axes):
    """The legend, where it hides nothing."""
    axes.legend(loc='upper left', bbox_to_anchor=(1.0, 1.0))


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


def work_precision(rows, out, group, workload, parameter, title, name, x_label='width of the interval asked for [m]', reverse=True, reached=None):
    """Time against the accuracy asked, or another number: rows whose parameter matches the pattern, whose one group is that number. Rows that
    match `reached` have no such number: they stand at the error that they made."""
    points = []
    for row in rows:
        if row['group'] != group or row['workload'] != workload:
            continue
        match = re.fullmatch(parameter, row['parameter'])
        if match or (reached and re.fullmatch(reached, row['parameter'])):
            x = float(match.group(1)) if match else max(float(row['error'] or 'nan'), 1e-16)
            points.append((row['method'], x, float(row['median_us']), float(row['p95_us'])))
    if not points:
        return None
    figure, axes = plt.subplots()
    seen = []
    for method in methods_of([{'method': p[0]} for p in points]):
        mine = sorted(p[1:] for p in points if p[0] == method)
        x, median, p95 = zip(*mine)
        colour = colour_of(method, seen)
        axes.semilogy(x, median, 'o-', color=colour, label=LABELS.get(method, method))
        axes.fill_between(x, median, p95, color=colour, alpha=0.13, linewidth=0)
    values = [p[1] for p in points]
    if reverse or max(values) >= 30.0 * min(values):
        axes.set_xscale('log')
        readable(axes.xaxis)
    if reverse:
        axes.invert_xaxis()
    readable(axes.yaxis)
    axes.set_xlabel(x_label + ('; without one: error made [m]' if reached else ''))
    axes.set_ylabel('time a query [µs]; band: to 95 %')
    axes.set_title(title)
    beside(axes)
    return save(figure, out, name)


def bars(rows, out, group, select, title, name, label=lambda row: f"{row['workload']}\n{row['parameter']}",
         time='median time a query [µs]'):
    """Time of each method, one cluster for each workload and parameter that select(row) takes."""
    rows = [row for row in rows if row['group'] == group and select(row)]
    keys = list(dict.fromkeys(label(row) for row in rows))
    if not keys:
        return None
    methods, seen = methods_of(rows), []
    figure, axes = plt.subplots(figsize=(max(7.2, 0.75 * len(keys) + 2), 4.4))
    width = 0.8 / len(methods)
    for k, method in enumerate(methods):
        values = {label(row): float(row['median_us']) for row in rows if row['method'] == method}
        x = [i + (k - (len(methods) - 1) / 2) * width for i, key in enumerate(keys) if key in values]
        axes.bar(x, [values[key] for key in keys if key in values], width * 0.92, color=colour_of(method, seen),
                 label=LABELS.get(method, method))
    axes.set_yscale('log')
    axes.set_xticks(range(len(keys)))
    axes.set_xticklabels(keys, fontsize=8)
    axes.set_ylabel(time)
    axes.set_title(title)
    axes.grid(axis='x', visible=False)
    beside(axes)
    readable(axes.yaxis)
    return save(figure, out, name)


def stacked(words):
    return words.replace(' ', '\n')


def curves(rows, out):
    pattern = r'order \d+ eps (1e-\d+)'
    for workload, name in (('polytope 3-D distance', 'polytope'), ('polygon 2-D distance', 'polygon'), ('point 2-D distance', 'point'),
                           ('curves 3-D distance', 'curve_curve')):
        order = '5' if name == 'curve_curve' else '15'
        yield work_precision(rows, out, 'curves', workload, pattern.replace(r'\d+ eps', order + ' eps', 1),
                             f'{workload}, order {order}: time against accuracy', f'work_precision_{name}',
                             reached=rf'order {order} (samples \d+|as it is)')
    yield bars(rows, out, 'curves', lambda row: row['workload'].endswith('distance') and row['parameter'].endswith('eps 1e-10'),
               'Distance to 1e-10', 'distance_by_order', lambda row: f"{stacked(row['workload'][:-9])}\n{row['parameter'][:8]}")
    yield bars(rows, out, 'curves', lambda row: 'tolerance' in row['workload'] and 'order 15' in row['parameter'],
               'Farther than delta? Order 15, delta as a fraction of the distance', 'tolerance',
               lambda row: f"{stacked(row['workload'].split(' tolerance')[0])}\n{row['parameter'][14:]}")


def splines(rows, out):
    for space in ('2-D', '3-D'):
        yield work_precision(rows, out, 'splines', f'B-spline {space} distance', r'(\d+) segments', f'Cubic B-splines, {space}: distance to 1e-10',
                             f'splines_{space[0]}', 'segments', reverse=False)
    for curve, title in (('B-spline', 'Cubic B-splines of 100 segments'), ('trigonometric', 'Trigonometric series')):
        yield work_precision(rows, out, 'splines', f'{curve} 3-D accuracy', r'eps (1e-\d+)', f'{title} and a polytope: time against accuracy',
                             f'work_precision_{curve.lower()}', reached=r'samples \d+')
    yield bars(rows, out, 'splines', lambda row: row['workload'].startswith('trigonometric') and 'accuracy' not in row['workload'], 'Compiled trigonometric series', 'trigonometric',
               lambda row: row['workload'][14:].replace(' ', '\n'))


def peers(rows, out):
    for workload, name in (('point and curve', 'points'), ('curve and curve', 'curves'), ('path distance', 'paths'),
                           ('time of contact', 'time_of_contact')):
        yield bars(rows, out, 'peers', lambda row: row['workload'] == workload, workload[0].upper() + workload[1:], f'peers_{name}',
                   lambda row: row['parameter'])


def batches(rows, out):
    yield bars(rows, out, 'batches', lambda row: row['workload'].startswith(('polygons', 'boxes')), 'A thousand quintic Bézier curves', 'batches',
               lambda row: f"{row['workload'].replace(' ', chr(10))}\n{row['parameter'].split()[0]}", 'median time of all curves [µs]')
    for query_type in ('distance', 'tolerance', 'collision'):
        yield rates(rows, out, f'boxes {query_type}', f'Batches of a thousand quintics, {query_type}', f'batches_rate_{query_type}')
    yield threads(rows, out)


def rates(rows, out, workload, title, name):
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
    beside(axes)
    return save(figure, out, name)


def threads(rows, out):
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
    beside(axes)
    return save(figure, out, 'batches_threads')


def worlds(rows, out):
    for what, unit, title in (('mesh distance', 'triangles', 'Quintic curves against a mesh: certified to 1e-6, and 100 samples'),
                              ('set distance', 'targets', 'One curve against many boxes at one density')):
        yield work_precision(rows, out, 'worlds', what, unit + r' (\d+)', title, 'worlds_' + what.replace(' ', '_'), x_label=unit, reverse=False)


def robots(rows, out):
    for workload in ('environment', 'self'):
        bounded = [row for row in rows if row['method'] != 'sampling .05']  # which knows no epsilon; "sampling" stands at its error
        yield work_precision(bounded, out, 'robots', workload, r'epsilon ([0-9.e-]+)', f'Robots, {workload}: time against accuracy',
                             f'robots_{workload}', reached=r'step .*')
    yield bars(rows, out, 'robots', lambda row: row['workload'] == 'tolerance', 'Robots: farther than delta?', 'robots_verdicts',
               lambda row: row['parameter'].replace('delta ', ''))
    yield bars(rows, out, 'robots', lambda row: row['workload'] == 'planning',
               'A Panda in seven scenes: certified minimum to 1 mm, and checks of states', 'robots_planning',
               lambda row: row['parameter'].replace('panda_', '').replace('_0001_rrt', '').replace('_', '\n'))
    for what in dict.fromkeys(row['workload'] for row in rows if row['group'] == 'robots' and row['workload'].startswith('growth')):
        yield work_precision(rows, out, 'robots', what, r'\D*(\d+).*', f'Robots: {what}', 'robots_' + what.replace(' ', '_'), what.split()[1], reverse=False)


def implicit(rows, out):
    """Table I of Chakraborty et al. as bars, and its Fig. 2."""
    yield bars(rows, out, 'implicit', lambda row: row['workload'] == 'table I', 'Pairs of implicit bodies to 1e-8 of their size', 'implicit_pairs',
               lambda row: row['parameter'])
    for kind in ('planes', 'quadrics', 'superquadrics'):
        yield work_precision(rows, out, 'implicit', f'figure 2 {kind}', r'(\d+)', f'Bodies of many {kind}', f'seeds_figure_2_{kind}',
                             'constraints of both bodies', reverse=False)


def fourier(rows, out):
    yield from fourier_charts.draw(rows, out, save)
    yield bars(rows, out, 'fourier', lambda row: row['workload'] == 'boxes', 'Two boxes: a gap beside a distance', 'fourier_boxes')


def seeds(rows, out):
    """Fig. 7 and 10 of Lakshmanan et al., and its Table II as bars."""
    yield narrowing(rows, out)
    for query_type in ('distance', 'tolerance', 'collision'):
        yield work_precision(rows, out, 'seeds', f'figure 10 {query_type}', r'order (\d+)', f'Bézier curves and a point, {query_type}',
                             f'seeds_figure_10_{query_type}', 'order of the curve', reverse=False)
    yield bars(rows, out, 'seeds', lambda row: row['workload'].startswith('table II'), 'The pairs of Table II', 'seeds_table_2',
               lambda row: f"{row['parameter'][0]}\n{row['workload'][9:]}")


def narrowing(rows, out):
    figure, axes = plt.subplots()
    found = [row for row in rows if row['group'] == 'seeds' and row['workload'] == 'figure 7']
    for method in methods_of(found):
        mine = [row for row in found if row['method'] == method]
        axes.semilogy([float(row['nodes']) for row in mine], [float(row['error']) for row in mine], 'o-', color=colour_of(method, []),
                      label=LABELS.get(method, method))
    axes.set_xlabel('intervals examined')
    axes.set_ylabel('upper - lower [m]')
    axes.set_title('A curve of order 13 and a polygon: how the interval narrows')
    beside(axes)
    return save(figure, out, 'seeds_figure_7') if found else plt.close(figure)


def present(out):
    """The charts that are there from an earlier run."""
    return sorted(name[:-4] for name in os.listdir(out) if name.endswith('.png'))


def draw_all(rows, out):
    """All charts for which there are rows; their names."""
    style()
    drawn = []
    for draw in (curves, splines, peers, seeds, batches, worlds, robots, implicit, fourier):
        drawn += [name for name in draw(rows, out) if name]
    return drawn
