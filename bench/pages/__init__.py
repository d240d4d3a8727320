# SPDX-License-Identifier: BSD-3-Clause
"""The pages that stand beside the charts, written from results.csv."""
import datetime
import os
import subprocess
import textwrap

from pages import choosing, contacts, hulls, optimise, readme, seeds, stability
from pages.figures import Figures

NEEDS = {'stability.md': {'stability'}, 'optimise.md': {'optimise'}, 'contacts.md': {'moving'}, 'seeds.md': {'seeds', 'batches', 'implicit'}, 'choosing.md': {'curves', 'batches', 'robots', 'implicit', 'worlds', 'certificates'}}


def how_made(command, commit):
    """The message that says where the figures come from."""
    with open('/proc/cpuinfo') as text:
        model = next((line.split(':', 1)[1].strip() for line in text if line.startswith('model name')), 'an unnamed processor')
    return f'Made by `{command}` at commit {commit}, {datetime.date.today()}, on {os.cpu_count()} cores ({model}).'


def commit_of(repository):
    found = subprocess.run(['git', '-C', repository, 'rev-parse', '--short', 'HEAD'], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return found.stdout.strip() or 'unknown'


def write_all(rows, drawn, out, made):
    """The pages for which all groups were run; their names."""
    figures = Figures(rows)
    groups = {row['group'] for row in rows}
    pages = {'README.md': lambda: readme.page(figures, drawn, made, out), 'seeds.md': lambda: seeds.page(figures, out),
             'stability.md': lambda: stability.page(figures, out),
             'optimise.md': lambda: optimise.page(figures, out),
             'contacts.md': lambda: contacts.page(figures, out),
             'choosing.md': lambda: choosing.page(figures, out)}
    if hulls.read(out):
        pages['hulls.md'] = lambda: hulls.page(out)
    written = []
    for name, write in pages.items():
        if NEEDS.get(name, set()) <= groups:
            with open(os.path.join(out, name), 'w') as text:
                text.write(wrapped(write()))
            written.append(name)
    return written


def wrapped(text, width=120):
    """Paragraphs and items with a line beyond the width are broken anew. Tables, headings, pictures and code stay lines."""
    blocks = []
    for line in text.split('\n'):
        goes_on = blocks and not _is_kept(line) and not _is_kept(blocks[-1][0]) and not line.startswith('- ')
        if goes_on:
            blocks[-1].append(line)
        else:
            blocks.append([line])
    return '\n'.join(_broken(block, width) for block in blocks)


def _is_kept(line):
    return not line or line.startswith(('|', '#', '!', '`' * 3, '    '))


def _broken(block, width):
    if max(map(len, block)) <= width or _is_kept(block[0]):
        return '\n'.join(block)
    indent = '  ' if block[0].startswith('- ') else ''
    words = ' '.join(line.strip() for line in block)
    return textwrap.fill(words, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
