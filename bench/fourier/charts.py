# SPDX-License-Identifier: BSD-3-Clause
"""Charts of the Fourier group: over-reach against n, outlines of obstacles, nesting, planning."""
import collections
import math
import re

import matplotlib.pyplot as plt

# The sum alone, and the verdict: bounds per direction first.
NAMES = {'curve_proximity sum': 'certified, the sum V alone', 'curve_proximity tuned sum': 'tuned (no guarantee), V alone',
         'curve_proximity': 'certified verdict: bounds per direction, then V', 'curve_proximity tuned': 'tuned verdict',
         'curve_proximity signal': 'signal (for solvers)',
         'paper': "Parks-McClellan kernel, Lysenko 2011, threshold corrected"}
COLOURS = {'curve_proximity': '#0b6e99', 'curve_proximity tuned': '#6b8e23', 'curve_proximity signal': '#7b4ea3', 'paper': '#c2571a',
           'exact': '#333333', 'curve_proximity sum': '#0b6e99', 'curve_proximity tuned sum': '#6b8e23'}
SPACE_NAMES = {'curve_proximity': 'certified, V alone', 'curve_proximity tuned': 'tuned (no guarantee), V alone'}


def line_of(method):
    """A verdict by bounds per direction is dashed, a sum alone is not."""
    return 'o--' if method in ('curve_proximity', 'curve_proximity tuned') else 'o-'


def exponent(by_n):
    """The slope of log mean against log n, by least squares."""
    points = [(math.log(n), math.log(sum(values) / len(values))) for n, values in by_n.items()]
    mean_x, mean_y = (sum(c) / len(points) for c in zip(*points))
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)


def over_reach(rows, save, legend_below):
    """Mean over the pairs, with the band of all pairs: the paper's Fig. 3."""
    found = collections.defaultdict(lambda: collections.defaultdict(list))
    for row in rows:
        error = float(row['error'] or 'nan')
        if row['workload'].startswith('over-reach') and not math.isnan(error):
            found[row['method']][int(row['parameter'].split()[1])].append(error)
    if not found:
        return None
    figure, axes = plt.subplots()
    for method, by_n in found.items():
        n = sorted(by_n)
        label = f'{NAMES[method]}: n^{exponent(by_n):.2f}' if len(n) > 2 else NAMES[method]
        axes.loglog(n, [sum(by_n[k]) / len(by_n[k]) for k in n], line_of(method), color=COLOURS[method], label=label)
        axes.fill_between(n, [min(by_n[k]) for k in n], [max(by_n[k]) for k in n], color=COLOURS[method], alpha=0.1, linewidth=0)
    n = sorted({k for by_n in found.values() for k in by_n})
    if found['curve_proximity sum'][n[0]]:
        first = found['curve_proximity sum'][n[0]]
        axes.loglog(n, [sum(first) / len(first) * n[0] / k for k in n], ':', color=COLOURS['exact'], label="the paper's conjecture O(1/n)")
    axes.set_xlabel('samples an axis n')
    axes.set_ylabel('largest clearance called colliding, over the period')
    axes.set_title('Over-reach of Fourier gaps: four pairs of planar shapes')
    legend_below(axes)
    return save(figure, 'fourier_over_reach')


def space(rows, save, legend_below):
    """Pairs in space: the share of clear poses that are called clear, and what a verdict costs beside the distance."""
    share, cost, exact = (collections.defaultdict(lambda: collections.defaultdict(list)) for _ in range(3))
    for row in rows:
        if not row['workload'].startswith('space: clear') or math.isnan(float(row['error'] or 'nan')):
            continue
        if row['method'] == 'curve_proximity distance':
            exact[''][0].append(float(row['median_us']))
            continue
        n = int(row['parameter'].split()[1])
        share[row['method']][n].append(100.0 * float(row['error']))
        cost[row['method']][n].append(float(row['median_us']))
    if not share:
        return None
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.2, 4.0))
    for method, by_n in share.items():
        n = sorted(by_n)
        for axes, values in ((left, by_n), (right, cost[method])):
            axes.plot(n, [sum(values[k]) / len(values[k]) for k in n], 'o-', color=COLOURS[method], label=SPACE_NAMES[method])
            axes.fill_between(n, [min(values[k]) for k in n], [max(values[k]) for k in n], color=COLOURS[method], alpha=0.13,
                              linewidth=0)
    left.axhline(100.0, color=COLOURS['exact'], label='certified distance (cprox_pair)')
    right.axhline(sorted(exact[''][0])[len(exact[''][0]) // 2] if exact else math.nan, color=COLOURS['exact'])
    for axes in (left, right):
        axes.set_xscale('log')
        axes.set_xlabel('samples an axis n')
    left.set_ylabel('called clear [%]')
    right.set_yscale('log')
    right.set_ylabel('time of a verdict [µs]')
    figure.suptitle('In space: clear poses farther apart than 5 % of the size; five pairs, mean and band')
    legend_below(left)
    return save(figure, 'fourier_space')


def cost(rows, save, legend_below):
    """Over-reach against the time of value and gradient, a point for each n."""
    found = collections.defaultdict(lambda: collections.defaultdict(list))
    for row in rows:
        error, time = float(row['error'] or 'nan'), float(row['median_us'] or 'nan')
        if row['workload'].startswith('over-reach') and not math.isnan(error + time):
            found[row['method']][int(row['parameter'].split()[1])].append((1e3 * time, error))
    if not found:
        return None
    figure, axes = plt.subplots()
    for method, by_n in found.items():
        means = [[sum(values) / len(values) for values in zip(*by_n[n])] for n in sorted(by_n)]
        axes.loglog(*zip(*means), line_of(method), color=COLOURS[method], label=NAMES[method])
        for n, (x, y) in zip(sorted(by_n), means):
            axes.annotate(f'n = {n}', (x, y), textcoords='offset points', xytext=(5, 4), fontsize=8, color=COLOURS[method])
    axes.set_xlabel('time of value and gradient [ns]')
    axes.set_ylabel('largest clearance called colliding, over the period')
    axes.set_title('What accuracy costs: mean of four pairs of planar shapes')
    legend_below(axes)
    return save(figure, 'fourier_cost')


def gradients(rows, save, legend_below):
    """Median cosine to the gradient of the distance, against the clearance."""
    found = collections.defaultdict(list)
    for row in rows:
        match = re.fullmatch(r'clearance ([\d.]+) to ([\d.]+) n (\d+)', row['parameter'])
        if row['workload'].startswith('gradient') and match:
            found[row['method']].append((0.5 * (float(match.group(1)) + float(match.group(2))), 1.0 - float(row['error'])))
    if not found:
        return None
    figure, axes = plt.subplots()
    for method, points in found.items():
        axes.semilogx(*zip(*sorted(points)), 'o-', color=COLOURS[method], label=NAMES[method])
    axes.set_xlabel('clearance [m]; the shapes have circumradii of about 1 m')
    axes.set_ylabel('median cosine to the gradient of the distance')
    axes.set_title('Gradients of gap functions of an L and a T, n = 33')
    legend_below(axes)
    return save(figure, 'fourier_gradients')


def tables(rows, save, legend_below):
    """A box's gap: the error of value against the time, by the closed form and by tables of its spectrum."""
    found = collections.defaultdict(list)
    for row in rows:
        if row['workload'] == 'box value and gradient' and row['method'] != 'no rotation':
            found[row['method']].append((float(row['median_us']), max(float(row['error']), 1e-16), row['parameter']))
    if not found:
        return None
    figure, axes = plt.subplots()
    for k, (method, points) in enumerate(found.items()):
        colour = list(COLOURS.values())[k]
        axes.loglog(*zip(*(point[:2] for point in points)), 'o', color=colour, label=method)
        for x, y, parameter in points:
            axes.annotate(parameter, (x, y), textcoords='offset points', xytext=(5, 4), fontsize=8, color=colour)
    axes.set_xlabel('time of value and gradient [µs]')
    axes.set_ylabel('largest error of V/t')
    axes.set_title('Two boxes: closed-form spectrum, and tables with tricubic interpolation')
    legend_below(axes)
    return save(figure, 'fourier_tables')


def outlines(rows, *methods):
    """n, theta -> closed lists of x, y, of these methods."""
    found = collections.defaultdict(lambda: ([], []))
    for row in rows:
        match = re.fullmatch(r'n (\d+) theta ([\d.]+) phi ([\d.]+)', row['parameter'])
        if row['workload'].startswith('obstacle') and match and row['method'] in methods:
            n, theta, phi = int(match.group(1)), float(match.group(2)), float(match.group(3))
            x, y = found[n, theta]
            x.append(float(row['error']) * math.cos(phi))
            y.append(float(row['error']) * math.sin(phi))
    for x, y in found.values():
        x.append(x[0])
        y.append(y[0])
    return found


def convergence(rows, save, legend_below):
    """The outline of one obstacle for several n around the exact one, by the sum alone and by the verdict: the paper's Fig. 5."""
    found, verdict = outlines(rows, 'exact', 'curve_proximity sum'), outlines(rows, 'curve_proximity')
    if not found:
        return None
    theta = min(key[1] for key in found)
    figure, axes = plt.subplots(figsize=(5.4, 5.4))
    samples = sorted({key[0] for key in found} - {0})
    for k, n in enumerate(samples):
        axes.plot(*found[n, theta], color=plt.cm.viridis(0.15 + 0.2 * k), label=f'n = {n}, V alone')
    axes.plot(*found[0, theta], color=COLOURS['exact'], label='exact', linewidth=1.2)
    # the finer ones lie between this one and the exact outline
    axes.plot(*verdict[samples[0], theta], '--', linewidth=1.2, color='#c2571a', label=f'n = {samples[0]}, verdict')
    axes.set_aspect('equal')
    axes.set_title('Outline of the obstacle of an L and a T, one rotation (certified)')
    legend_below(axes)
    return save(figure, 'fourier_convergence')


def profile(rows, save, legend_below):
    """The rows of the paper's Fig. 5 along one ray: value, part of the sum before a verdict, gradient."""
    kinds = {'profile value': 'V/θ', 'profile terms': 'part of the sum\n(dashed: verdict)', 'profile gradient': 'gradient [1/m]'}
    found = collections.defaultdict(lambda: collections.defaultdict(list))
    touch = math.inf
    for row in rows:
        match = re.fullmatch(r'n (\d+) x ([\d.]+) clearance (-?[\d.]+)', row['parameter'])
        if row['workload'] in kinds and match:
            key = (int(match.group(1)), row['method'] if row['workload'] == 'profile terms' else 'curve_proximity sum')
            found[row['workload']][key].append((float(match.group(2)), float(row['error'])))
            if float(match.group(3)) > 0.0:
                touch = min(touch, float(match.group(2)))
    if not found:
        return None
    figure, grid = plt.subplots(3, 1, figsize=(7.2, 6.4), sharex=True)
    for axes, (workload, label) in zip(grid, kinds.items()):
        samples = sorted({key[0] for key in found[workload]})
        for (n, method), points in sorted(found[workload].items()):
            axes.plot(*zip(*sorted(points)), line_of(method), color=plt.cm.viridis(0.15 + 0.3 * samples.index(n)), label=f'n = {n}', markersize=3)
        axes.axvline(touch, color=COLOURS['exact'], linewidth=1.0, label='apart from here on' if workload == 'profile value' else None)
        axes.set_ylabel(label)
        if workload != 'profile terms':
            axes.set_yscale('log')
    grid[0].axhline(1.0, color=COLOURS['exact'], linewidth=0.8, linestyle='--')
    grid[0].legend(loc='lower left', fontsize=8)
    grid[-1].set_xlabel('distance of the T from the L along a ray [m]')
    figure.suptitle('A gap of an L and a T along a ray (certified)')
    return save(figure, 'fourier_profile')


def obstacle(rows, save, legend_below):
    """Slices of the SE(2) obstacle at n = 17, by the sum alone and by the verdict, rotation upwards: the paper's Fig. 6."""
    slices = {key[1]: value for key, value in outlines(rows, 'curve_proximity sum').items() if key[0] == 17}
    verdict = outlines(rows, 'curve_proximity')
    if not slices:
        return None
    columns = 4
    lines = -(-len(slices) // columns)
    figure, grid = plt.subplots(lines, columns, figsize=(2.1 * columns, 2.3 * lines), sharex=True, sharey=True, squeeze=False)
    for axes in grid.flat[len(slices):]:
        axes.set_visible(False)
    for axes, (theta, (x, y)) in zip(grid.flat, sorted(slices.items())):
        axes.fill(x, y, color=COLOURS['curve_proximity'], alpha=0.25, linewidth=0)
        axes.plot(x, y, color=COLOURS['curve_proximity'], linewidth=1.2)
        axes.plot(*verdict[17, theta], '--', color=COLOURS['exact'], linewidth=0.9)
        axes.plot(0.0, 0.0, '+', color=COLOURS['exact'])
        axes.set_aspect('equal')
        axes.set_title(f'{theta:.2f} rad', fontsize=10)
    for axes in grid[-1]:
        axes.set_xlabel('x of the T [m]')
    for axes in grid[:, 0]:
        axes.set_ylabel('y of the T [m]')
    figure.suptitle('Where a T may not stand beside an L at the origin, by its rotation (n = 17; solid: V alone, dashed: verdict)')
    return save(figure, 'fourier_obstacle')


def nesting(rows, save, legend_below):
    rows = [row for row in rows if row['workload'].startswith('nesting')]
    keys = list(dict.fromkeys(row['workload'][len('nesting: '):] for row in rows))
    if not keys:
        return None
    methods = list(dict.fromkeys(row['method'] for row in rows))
    figure, axes = plt.subplots(figsize=(7.2, 3.2))
    for k, method in enumerate(methods):
        values = {row['workload'][len('nesting: '):]: float(row['nodes']) for row in rows if row['method'] == method}
        y = [i + (k - (len(methods) - 1) / 2) * 0.26 for i in range(len(keys))]
        of_it = axes.barh(y, [values[key] for key in keys], 0.24, color=list(COLOURS.values())[k],
                          label=method.replace('curve_proximity', 'certified gap, coarse to fine'))
        axes.bar_label(of_it, fmt='%.0f %%', padding=3)
    axes.set_yticks(range(len(keys)))
    axes.set_yticklabels(keys)
    axes.invert_yaxis()
    axes.set_xlim(0.0, 112.0)
    axes.set_xlabel('of 100 random starts [%]')
    axes.set_title('Nesting an L in an E by SLSQP')
    axes.grid(axis='y', visible=False)
    legend_below(axes)
    return save(figure, 'fourier_nesting')


PLANNING = {'signed distance': '#999999', 'superquadrics; then distance': '#999999', 'growth distance; then distance': '#999999',
            'no obstacle; then distance': '#cccccc'}
SMOOTH = {'signed distance': '#999999', 'growth by a cone program; then distance': '#999999',
          'randomised smoothing; then distance': '#999999'}


def starts(rows, save, what, title, name, colours):
    """Of all starts: free (pale), and near the best that any method found (full); the milliseconds a start."""
    rows = [row for row in rows if row['workload'].startswith(what + ': ')]
    workloads = list(dict.fromkeys(row['workload'] for row in rows))
    if not workloads:
        return None
    figure, grid = plt.subplots(2, (len(workloads) + 1) // 2, figsize=(13.0, 5.6), sharey=True, squeeze=False)
    for axes, workload in zip(grid.T.flat, workloads):
        own = [row for row in rows if row['workload'] == workload]
        methods = list(dict.fromkeys(row['method'] for row in own))
        for parameter, alpha in (('free', 0.35), ('near the best', 1.0)):
            share = {row['method']: 100.0 * (1.0 - float(row['error'])) for row in own if row['parameter'] == parameter}
            axes.barh(methods, [share[method] for method in methods], 0.7, alpha=alpha,
                      color=[colours.get(method, '#0b6e99') for method in methods])
        for i, method in enumerate(methods):
            milliseconds = next(float(row['median_us']) for row in own if row['method'] == method) / 1e3
            axes.text(101.0, i, f'{milliseconds:.3g} ms', va='center', fontsize=7)
        axes.set_xlim(0.0, 125.0)
        axes.set_xticks([0, 50, 100])
        axes.set_title(workload[len(what) + 2:], fontsize=9)
        axes.grid(axis='y', visible=False)
        axes.tick_params(labelsize=8)
    grid[0][0].invert_yaxis()
    for axes in grid[1]:
        axes.set_xlabel('of 50 starts [%]', fontsize=8)
    figure.suptitle(title)
    figure.tight_layout()
    return save(figure, name)


def planning(rows, save, _):
    return starts(rows, save, 'planning', 'Planning problems from random starts: free (pale), near the best (full); blue: Fourier gaps lead',
                  'fourier_planning', PLANNING)


def smooth(rows, save, _):
    """The growth distance and how others have it."""
    return starts(rows, save, 'smooth', 'Placing from random starts: free (pale), near the best (full); blue: our growth distance leads',
                  'fourier_smooth', SMOOTH)


def draw(rows, save, legend_below):
    rows = [row for row in rows if row['group'] == 'fourier']
    for chart in (over_reach, space, cost, gradients, tables, convergence, profile, obstacle, nesting, planning, smooth):
        yield chart(rows, save, legend_below)
