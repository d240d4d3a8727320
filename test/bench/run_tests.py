#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/bench says of its rows: targets, a second run, the record of soundness, the pages of the committed run."""
import contextlib
import csv
import glob
import io
import os
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

REPO = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(REPO, 'bench'))

import pages  # noqa: E402
import passes  # noqa: E402
import repeat  # noqa: E402
import soundness  # noqa: E402
import targets  # noqa: E402
from pages import choosing, readme  # noqa: E402
from pages.figures import Figures  # noqa: E402

CHARTS = os.path.join(REPO, 'doc', 'charts')


def row(**given):
    """A row of results.csv: ours, a microsecond, no errors."""
    return {'group': 'g', 'workload': 'w', 'method': targets.OURS, 'parameter': 'p', 'median_us': '1', 'p95_us': '1', 'nodes': '2', 'distance_queries': '3',
            'error': '0', 'unsound': '0', 'failures': '0', **{key: str(value) for key, value in given.items()}}


def target(**given):
    return {'name': 'a target', 'group': 'g', 'workload': 'w', 'parameter': '*', 'kind': 'ratio', 'baseline': 'peer', 'limit': '2', 'slack': '', **given}


def committed():
    with open(os.path.join(CHARTS, 'results.csv'), newline='') as text:
        return list(csv.DictReader(text))


class Programs(unittest.TestCase):
    def test_those_in_c_match_the_core(self):
        """Compiled, not built: those of peers need the peers' headers."""
        peers = ('curve_sisl.c', 'ipopt.c', 'libraries.c')
        files = [path for folder in ('*', '*/*') for path in glob.glob(os.path.join(REPO, 'bench', folder + '.c')) if not path.endswith(peers)]
        self.assertGreater(len(files), 40)
        folders = ['include', 'src', 'src/core', 'src/fourier', 'check', 'bench', 'test/core']
        command = ['cc', '-std=c11', '-fsyntax-only', '-DBENCH_DATA_DIR=""', *(f'-I{REPO}/{folder}' for folder in folders)]
        done = subprocess.run(command + files, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual(done.returncode, 0, done.stdout)


class Targets(unittest.TestCase):
    def test_a_ratio_is_the_geometric_mean_of_theirs_over_ours(self):
        rows = [row(), row(method='peer', median_us=2), row(parameter='q'), row(method='peer', parameter='q', median_us=8)]
        self.assertAlmostEqual(targets.figure(rows, target()), 4.0)

    def test_each_is_the_least_ratio(self):
        rows = [row(), row(method='peer', median_us=2), row(parameter='q'), row(method='peer', parameter='q', median_us=8)]
        self.assertAlmostEqual(targets.figure(rows, target(kind='each')), 2.0)

    def test_fewer_compares_nodes_and_a_tail_is_that_of_the_95_percent(self):
        rows = [row(nodes=5, median_us=2, p95_us=6), row(method='peer', nodes=100)]
        self.assertAlmostEqual(targets.figure(rows, target(kind='fewer')), 20.0)
        self.assertAlmostEqual(targets.figure(rows, target(kind='tail', baseline='')), 3.0)

    def test_an_exponent_is_fitted_to_the_first_number_of_the_parameter(self):
        rows = [row(parameter=f'{n} links of 9', median_us=n ** 1.5) for n in (10, 100, 1000)]
        self.assertAlmostEqual(targets.figure(rows, target(kind='exponent', baseline='')), 1.5)

    def test_a_count_is_the_largest_and_a_failure_the_sum(self):
        rows = [row(nodes=5, failures=1), row(parameter='q', nodes=7, failures=2), row(method='peer', nodes=99, failures=9)]
        self.assertEqual(targets.figure(rows, target(kind='nodes', baseline='')), 7)
        self.assertEqual(targets.figure(rows, target(kind='failures', baseline='')), 3)

    def test_beyond_the_slack_is_missed(self):
        for value, verdict in ((2.0, 'met'), (1.7, 'within slack'), (1.6, 'MISSED')):
            self.assertEqual(targets.judge(value, target()), verdict)
        self.assertEqual(targets.judge(1.0, target(kind='failures', limit='0')), 'MISSED')
        for value, verdict in ((-0.5, 'met'), (-0.46, 'within slack'), (-0.44, 'MISSED')):
            self.assertEqual(targets.judge(value, target(kind='exponent', limit='-0.5')), verdict)

    def test_a_target_of_a_known_peer_that_is_not_here_is_not_measured_and_any_other_is_missed(self):
        with mock.patch.object(targets, 'read_targets', lambda: [target(baseline='Bullet'), target(baseline='paper')]):
            self.assertEqual([verdict for verdict, _, _ in targets.judge_all([row()])], ['not measured', 'MISSED'])


class Repeat(unittest.TestCase):
    def agree(self, first, second, *runs, **of_target):
        asked = target(**of_target)
        return repeat.agree(first, second, asked, passes.spread_of(asked, *({asked['name']: list(of_passes)} for of_passes in runs or [(1,)])))

    def test_ratios_agree_within_a_fifth_and_counts_exactly(self):
        self.assertTrue(self.agree(10.0, 11.9))
        self.assertFalse(self.agree(10.0, 12.1))
        self.assertFalse(self.agree(12.1, 10.0))
        self.assertFalse(self.agree(7, 8, kind='nodes'))
        self.assertTrue(self.agree(0.2, 0.29, kind='exponent'))

    def test_what_the_passes_differ_by_two_runs_may(self):
        self.assertTrue(self.agree(10.0, 12.9, (8.0, 9.0, 10.4)))
        self.assertFalse(self.agree(10.0, 13.1, (8.0, 9.0, 10.4)))
        self.assertTrue(self.agree(10.0, 14.2, (8.0, 9.0, 10.4), (10.0, 10.5, 11.0)))
        self.assertFalse(self.agree(10.0, 14.4, (8.0, 9.0, 10.4), (10.0, 10.5, 11.0)))
        self.assertFalse(self.agree(10.0, 12.1, (10.0, 10.1, 10.2)))
        self.assertTrue(self.agree(0.2, 0.39, (0.1, 0.2, 0.3), kind='exponent'))
        self.assertFalse(self.agree(7, 8, (7, 9), kind='nodes'))

    def test_a_run_agrees_with_itself_and_not_with_one_whose_peer_is_twice_as_slow(self):
        rows = committed()
        slow = [dict(r, median_us=str(2.0 * float(r['median_us']))) if r['method'] == 'paper' and r['median_us'] else r for r in rows]
        with tempfile.TemporaryDirectory() as out, contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(repeat.report(rows, rows, (out, out), ('here', 'there')), 0)
            self.assertGreater(repeat.report(rows, slow, (out, out), ('here', 'there')), 5)
            with open(os.path.join(out, repeat.PAGE)) as text:
                self.assertIn('**differs**', text.read())

    def test_differences_are_those_of_the_ratios(self):
        first = [row(), row(method='peer', median_us=2)]
        second = [row(median_us=10), row(method='peer', median_us=30)]
        self.assertAlmostEqual(repeat.differences(first, second)['g'][0], 0.5)


class Passes(unittest.TestCase):
    def test_a_merged_row_has_the_median_of_the_times_and_the_largest_of_the_counts(self):
        one = passes.merge([[row(median_us=us, p95_us=2 * us, nodes=nodes, failures=failures, error='')]
                            for us, nodes, failures in ((3, 7, 0), (1, 5, 2), (2, 6, 1))])
        self.assertEqual(len(one), 1)
        self.assertEqual([one[0][key] for key in ('median_us', 'p95_us', 'nodes', 'failures', 'error')], ['2', '4', '7', '2', ''])

    def test_rows_that_one_pass_has_are_kept_and_so_is_the_order(self):
        merged = passes.merge([[row(workload='b'), row(workload='a', median_us='nan')], [row(workload='b')]])
        self.assertEqual([(r['workload'], r['median_us']) for r in merged], [('b', '1'), ('a', 'nan')])

    def test_the_spread_is_read_as_it_was_written(self):
        with tempfile.TemporaryDirectory() as out, mock.patch.object(targets, 'read_targets', lambda: [target()]):
            passes.write_spread([[row(), row(method='peer', median_us=us)] for us in (4, 5, 6)], out)
            self.assertEqual(passes.read_spread(out), {'a target': [4.0, 5.0, 6.0]})
            self.assertAlmostEqual(passes.spread_of(target(), passes.read_spread(out)), 0.5)
        self.assertEqual(passes.read_spread(out), {})


class Soundness(unittest.TestCase):
    def judged(self, **changed):
        """The record of one campaign, held against what is asked of it."""
        line = {'campaign': 'rounding: T2', 'seed': '1', 'cases': '100000', 'violations': '0', 'figure': '0.2 of the bound', 'commit': 'c', 'command': 'x',
                **changed}
        with tempfile.NamedTemporaryFile('w', suffix='.csv') as text:
            writer = csv.DictWriter(text, line)
            writer.writeheader()
            writer.writerow(line)
            text.flush()
            return next(v for v, name, _ in soundness.judge_all(text.name) if name.endswith('rounding: T2'))

    def test_a_violation_too_few_cases_or_a_padded_bound_is_missed(self):
        self.assertEqual(self.judged(), 'met')
        for bad in ({'violations': '1'}, {'cases': '99999'}, {'figure': '0.1 of the bound'}):
            self.assertEqual(self.judged(**bad), 'MISSED')

    def test_the_committed_record_has_every_campaign(self):
        self.assertEqual([name for _, name, said in soundness.judge_all() if said == 'no record'], [])


class Pages(unittest.TestCase):
    def test_the_committed_run_gives_every_page_and_a_line_for_each_target(self):
        with tempfile.TemporaryDirectory() as out:
            written = pages.write_all(committed(), ['tolerance'], out, 'Made.')
            self.assertEqual(sorted(written), ['README.md', 'choosing.md', 'contacts.md', 'optimise.md', 'seeds.md', 'stability.md'])
            with open(os.path.join(out, 'README.md')) as text:
                said = text.read()
            for asked in targets.read_targets():
                self.assertIn(f"| {asked['name']} |", said)

    def test_a_general_solver_is_quoted_by_the_median_over_the_pairs_and_with_its_failures(self):
        rows = [row(group='implicit', workload='table I', parameter=f'pair {i}', median_us=10) for i in range(3)]
        rows += [row(group='implicit', workload='table I', parameter=f'pair {i}', method='ipopt', median_us=10 * ratio, failures=i)
                 for i, ratio in enumerate((200, 9000, 300))]
        said = choosing.superquadric_pairs(Figures(rows))
        self.assertIn('takes 300 times as long', said)
        self.assertIn('the least is 200', said)
        self.assertNotIn('9000', said)
        self.assertIn('fails in 3 of the cases', said)
        self.assertNotIn('Ipopt', choosing.superquadric_pairs(Figures(rows[:3])))

    def test_what_is_missed_is_listed_and_what_is_nearly_so_where_a_reason_is_known(self):
        rows = [row(), row(method='peer', median_us=10)]
        asked = [target(name='missed', limit='20'), target(name='known', limit='11'), target(name='unknown', limit='11'), target(name='met', limit='10')]
        known = [{'pattern': name, 'why': 'Because.'} for name in ('known', 'met')]
        with mock.patch.object(targets, 'read_targets', lambda: asked), mock.patch.object(readme, 'reasons', lambda: known):
            self.assertEqual(list(readme.loss_lines(rows)), ['- **missed** (missed). Not explained yet.', '- **known** (within slack). Because.'])

    def test_growth_takes_what_is_named_so_from_three_sizes_up(self):
        rows = [row(workload='growth links', parameter=f'links {n}', median_us=n * n) for n in (2, 4, 8)]
        rows += [row(workload='memory mesh', parameter=f'triangles {n}', median_us='nan', nodes=100 * n) for n in (2, 4, 8)]
        rows += [row(workload='growth few', parameter='1')]
        rows += [row(workload='growth distance', parameter=name) for name in ('box, box', 'box, cylinder', 'box, cone')]
        self.assertEqual([(line[1], line[-1]) for line in readme.growth_lines(rows)], [('growth links', '2.00'), ('memory mesh', '1.00')])

    def test_how_made_names_command_and_commit(self):
        said = pages.how_made('scripts/bench', 'abc')
        self.assertIn('scripts/bench', said)
        self.assertIn('abc', said)


if __name__ == '__main__':
    ended = unittest.main(exit=False).result
    failed = len(ended.failures) + len(ended.errors)
    print(f'{ended.testsRun - failed} passed, {failed} failed')
    sys.exit(failed > 0)
