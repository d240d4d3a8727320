# SPDX-License-Identifier: BSD-3-Clause
"""What the pages say of results.csv: one figure at a time, as text."""
import os

import targets

OURS = targets.OURS


class Figures:
    """Looks up rows; a row that is not there is an error that names it, so that no page is left with a hole."""

    def __init__(self, rows):
        self.rows = rows

    def row(self, group, workload, parameter, method=OURS):
        for row in self.rows:
            if (row['group'], row['workload'], row['parameter'], row['method']) == (group, workload, parameter, method):
                return row
        raise LookupError(f'results.csv has no row {group}, {workload}, {method}, {parameter}')

    def has(self, group):
        return any(row['group'] == group for row in self.rows)

    def number(self, *key, method=OURS, column='median_us'):
        return float(self.row(*key, method=method)[column])

    def time(self, *key, method=OURS):
        return microseconds(self.number(*key, method=method))

    def ratio(self, *key, baseline):
        return short(self.number(*key, method=baseline) / self.number(*key))

    def count(self, *key, column, method=OURS):
        return short(self.number(*key, method=method, column=column))


def picture(out, name, text):
    """The chart as a picture of the page, or its name where this run has not drawn it."""
    return f'![{text}]({name}.png)' if os.path.exists(os.path.join(out, f'{name}.png')) else f'(`{name}` is not drawn here.)'


def short(value):
    """Two digits, more only before the point."""
    return f'{value:.0f}' if abs(value) >= 10 else f'{value:.2g}'


def microseconds(value):
    if value >= 1e6:
        return f'{short(value / 1e6)} s'
    if value >= 1e3:
        return f'{short(value / 1e3)} ms'
    return f'{short(value)} µs' if value >= 1.0 else f'{short(1e3 * value)} ns'


def table(header, lines):
    """A table of Markdown."""
    return '\n'.join(['| ' + ' | '.join(line) + ' |' for line in [header, ['---'] * len(header), *lines]])
