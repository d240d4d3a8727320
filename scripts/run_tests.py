#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the test groups, counts every case of every runner, and prints a table whose last line is the sum.

Called by scripts/test, which has set up and built. A runner that ends without a result counts as one failed case, and
so does a case that was skipped: a missing thing is a failure.
"""
import argparse
import concurrent.futures
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import threading
import time
import xml.etree.ElementTree as ElementTree

REPO = os.environ.get('REPO', os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
WORKSPACE = os.environ.get('WORKSPACE', '')
LOGS = os.environ.get('LOGS', '')
RUNNER_LIMIT = 600  # seconds for one runner; a test that hangs is a failed one
IDLE_LIMIT = 1800  # the same beside other groups
RUNNERS = max(1, min(os.cpu_count() or 1, 4))  # how many runners work at the same time
PRINTING = threading.Lock()


class Count:
    """Passed and failed cases, and the names of those that failed."""

    def __init__(self, passed=0, failed=0, failures=()):
        self.passed, self.failed, self.failures = passed, failed, list(failures)

    def __add__(self, other):
        return Count(self.passed + other.passed, self.failed + other.failed, self.failures + other.failures)


# ---------------------------------------------------------------------------------------------- what the runners print
def count_cmocka(output, code, name):
    """Counts the cases of one cmocka program from its lines; what was announced and did not end well has failed."""
    announced = sum(int(n) for n in re.findall(r'^\[=+\] (?:[^:\n]+: )?Running (\d+) test', output, re.M))
    passed = len(re.findall(r'^\[ +OK \]', output, re.M))
    bad = re.findall(r'^\[ +(?:FAILED|SKIPPED) +\] (?:[^:\n]+: )?([A-Za-z_]\w*)$', output, re.M)
    failures = [f'{name}: {case}' for case in bad]
    failed = announced - passed
    if announced == 0 or (code != 0 and failed == 0):
        failed, failures = failed + 1, failures + [f'{name}: exit code {code}']
    return Count(passed, failed, dict.fromkeys(failures))


def count_lines(output, code, name):
    """Counts from the last `N passed, N failed` that a script printed."""
    lines = re.findall(r'^(\d+) passed, (\d+) failed$', output, re.M)
    if not lines:
        return Count(0, 1, [f'{name}: no result (exit code {code})'])
    passed, failed = (int(n) for n in lines[-1])
    failures = [f'{name}: {line}' for line in re.findall(r'^(?:FAILED|not ok)[: ]+(.*)$', output, re.M)]
    if (code != 0) and failed == 0:
        return Count(passed, 1, failures + [f'{name}: exit code {code}'])
    return Count(passed, failed, failures or ([name] if failed else []))


def count_junit(path, code, name):
    """Counts from a JUnit file (gtest, rostest)."""
    try:
        cases = list(ElementTree.parse(path).getroot().iter('testcase'))
    except (OSError, ElementTree.ParseError):
        cases = []
    count = Count()
    for case in cases:
        bad = case.get('status') == 'notrun' or any(case.find(tag) is not None for tag in ('failure', 'error', 'skipped'))
        title = f"{name}: {case.get('classname')}.{case.get('name')}"
        count += Count(0, 1, [title]) if bad else Count(1)
    if not cases or (code != 0 and count.failed == 0):
        count += Count(0, 1, [f'{name}: no result (exit code {code})'])
    return count


# ------------------------------------------------------------------------------------------------------ running things
def execute(command, log, cwd=REPO, env=None, limit=RUNNER_LIMIT):
    """Runs a command into a log. Returns what it printed and its exit code (124 when it ran out of time)."""
    if os.sched_getscheduler(0) == os.SCHED_IDLE:
        command, limit = when_idle(command), IDLE_LIMIT
    with open(log, 'w', errors='replace') as out:
        process = subprocess.Popen(command, cwd=cwd, env=dict(os.environ, **(env or {})), stdin=subprocess.DEVNULL,
                                   stdout=out, stderr=subprocess.STDOUT, start_new_session=True)
        try:
            code = process.wait(limit)
        except subprocess.TimeoutExpired:
            code = 124
        finally:
            end_group(process)
    with open(log, errors='replace') as printed:
        return printed.read(), code


def work_when_idle():
    """From here on this thread, its threads and its processes work when nothing else wants the processor."""
    try:
        os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))
    except OSError:
        pass  # a sandbox that knows no such policy: they work at the priority of all others


def when_idle(command):
    """The command of a thread that works when idle. Where Linux groups processes by session, the group is idle, too."""
    return ['sh', '-c', 'echo 19 2>/dev/null > /proc/self/autogroup; exec "$@"', 'sh', *command]


def end_group(process):
    """Ends whatever a runner left running in its own session."""
    for signal in (15, 9):
        try:
            os.killpg(process.pid, signal)
        except ProcessLookupError:
            return
        time.sleep(0.2)
        process.poll()


def log_path(name):
    return os.path.join(LOGS, re.sub(r'[^A-Za-z0-9_.-]', '_', name) + '.log')


def show_failure(log, lines=40):
    """Prints the end of a log, so that a CI that keeps no files still tells what went wrong."""
    with open(log, errors='replace') as text:
        tail = text.read().splitlines()[-lines:]
    with PRINTING:
        print(f'---- the end of {log}')
        print('\n'.join(tail), flush=True)


def run_one(command, name, counter, **how):
    """Runs one runner and counts it with counter(output, code, name)."""
    log = log_path(name)
    output, code = execute(command, log, **how)
    count = counter(output, code, name)
    if count.failed:
        show_failure(log)
    return count


def run_together(jobs):
    """Runs jobs, functions that return a Count, RUNNERS at a time; the sum, in the jobs' order."""
    with concurrent.futures.ThreadPoolExecutor(RUNNERS) as pool:
        return sum(pool.map(lambda job: job(), jobs), Count())


def count_core(output, code, name):
    """A test of the core is a cmocka program, or a campaign of thousands of queries, which is one case."""
    if not re.search(r'^\d+ passed, \d+ failed$', output, re.M):
        return count_cmocka(output, code, name)
    campaign = count_lines(output, code, name)
    return Count(0, 1, campaign.failures or [name]) if campaign.failed else Count(1)


def count_rostest(path, code, name):
    """A rostest's own file has one case for each test node; what that node tested stands in rosunit-*.xml beside it."""
    whole, parts = count_junit(path, code, name), Count()
    for part in glob.glob(os.path.join(os.path.dirname(path), 'rosunit-*.xml')):
        parts += count_junit(part, 0, name)
    if not parts.passed + parts.failed:
        return Count(0, 1, [f'{name}: no result (exit code {code})'])
    return parts if parts.failed or not whole.failed else parts + Count(0, 1, whole.failures)


def count_exit(_, code, name):
    """A tool that says yes or no: one case."""
    return Count(1) if code == 0 else Count(0, 1, [name])


def ctest_entries(build, *folders):
    """The tests that CMake knows in a build folder, or of these folders of test/: name, command, working directory."""
    listed = subprocess.run(['ctest', '--show-only=json-v1'], cwd=build, stdout=subprocess.PIPE, check=True)
    document = json.loads(listed.stdout)
    graph = document['backtraceGraph']
    entries = []
    for test in document['tests']:
        files, node = [], test.get('backtrace')
        while node is not None:
            files.append(graph['files'][graph['nodes'][node]['file']])
            node = graph['nodes'][node].get('parent')
        properties = {p['name']: p['value'] for p in test.get('properties', [])}
        # catkin wraps its tests in the environment of the first configuration, when the devel space had no Python modules
        # yet; here they run in that of the finished workspace, which scripts/test has sourced
        command = test.get('command')
        if command and os.path.basename(command[0]) == 'env_cached.sh':
            command = command[1:]
        places = [os.path.realpath(os.path.join(build, f)) for f in files]
        if not folders or any(f'/test/{folder}/CMakeLists.txt' in place for folder in folders for place in places):
            entries.append((test['name'], command, properties.get('WORKING_DIRECTORY', build)))
    return entries


# ---------------------------------------------------------------------------------------------------------- the groups
CORE_FOLDERS = ('core', 'check', 'attack')
# Builds with a sanitizer: -O1 -g1 compiles in about half the CPU time of -O2 -g. Warnings are errors in the workspace's build;
# under a sanitizer the compiler has some that are false.
INSTRUMENTED = ['-DCPROX_TESTS=ON', '-DCMAKE_BUILD_TYPE=RelWithDebInfo',
                *(f'-DCMAKE_{language}_FLAGS_RELWITHDEBINFO=-O1 -g1 -DNDEBUG' for language in ('C', 'CXX'))]
# The slowest tests of random cases: under a sanitizer they ask a quarter of them, the group core asks them all.
SLOW = r'\.test_(approach|certificates|convex_polytope|curve_(bspline|control|evaluate|piecewise|planar|polynomial|pythagorean)|depth|' \
    r'fourier_(gap|kinds|query)|gradient|implicit_(motion|solver|support)|mesh|pair|pair_(peers|traps)|quick|' \
    r'robot_(crowd|gradient|mesh|motion|query|spans)|rounding|superquadric_nearest|time_of_contact)$'


def workspace_build():
    return os.path.join(WORKSPACE, 'build')


def sources(*folders):
    """The C and C++ files of the checkout."""
    return sorted(path for folder in folders for pattern in ('*.c', '*.h', '*.cpp', '*.hpp')
                  for path in glob.glob(os.path.join(REPO, folder, '**', pattern), recursive=True))


def layering():
    return run_one([os.path.join(REPO, 'test/layering/run')], 'layering', count_lines)


def headers():
    return run_one([os.path.join(REPO, 'test/headers/run')], 'headers', count_lines)


def text():
    return run_one([os.path.join(REPO, 'test/text/run')], 'text', count_lines)


def docs():
    return run_one([os.path.join(REPO, 'test/docs/run')], 'docs', count_lines)


def lint():
    package = os.path.join(WORKSPACE, 'src/curve_proximity')  # a folder of the package's name, whatever the clone's is
    return run_one(['catkin_lint', '--strict', '-W2', '--offline', package], 'catkin_lint', count_exit)


def formatting():
    files = sources('include', 'src', 'check', 'test', 'bench', 'examples')
    return run_one(['clang-format', '--dry-run', '-Werror', *files], 'clang-format', count_exit)


def step_apart(flavour, word, command):
    """One step of a build in a folder of its own. Returns whether it went well."""
    log = log_path(f'{flavour}-{word}')
    if execute(command, log, limit=1800)[1] == 0:
        return True
    show_failure(log)
    return False


def build_apart(flavour, options, targets=lambda build: ['all']):
    """Configures and builds in a folder of its own beside the workspace's build; targets names what, given the configured
    folder. Returns that folder, or None."""
    build = os.path.join(WORKSPACE, 'core', flavour)
    if not step_apart(flavour, 'configure', ['cmake', '-S', REPO, '-B', build, *options]):
        return None
    command = ['cmake', '--build', build, '--target', *targets(build), '--', '-j2']
    return build if step_apart(flavour, 'build', command) else None


def run_core_tests(build, flavour, env=lambda name: {}, only='', folders=CORE_FOLDERS):
    """Runs the core's tests that stand in a build folder, or those alone that `only` matches; env(name) is a test's
    environment."""
    jobs = []
    for name, command, folder in ctest_entries(build, *folders):
        if not re.search(only, name):
            continue
        title = f'{name} ({flavour})'
        counter = count_core if command else (lambda output, code, title: Count(0, 1, [f'{title}: not built']))
        jobs.append(lambda c=command or ['false'], t=title, k=counter, f=folder, e=env(name): run_one(c, t, k, cwd=f, env=e))
    return run_together(jobs) if jobs else Count(0, 1, [f'core-{flavour}: no test matches'])


def core():
    """The tests of the core, of the checker, and the random cases, in the workspace's own build."""
    return run_core_tests(workspace_build(), 'release')


def sanitized():
    build = build_apart('sanitized', ['-DCPROX_ROS=OFF', '-DCPROX_SANITIZE=address,undefined', *INSTRUMENTED])
    if build is None:
        return Count(0, 1, ['core-sanitized: the build failed'])
    options = {'ASAN_OPTIONS': 'detect_leaks=1:abort_on_error=0', 'UBSAN_OPTIONS': 'print_stacktrace=1'}
    fewer = dict(options, CPROX_TEST_SCALE='0.25')
    return run_core_tests(build, 'sanitized', lambda name: fewer if re.search(SLOW, name) else options, folders=())


def threads():
    """The tests with threads, of the core and of the scene, under ThreadSanitizer, in one build."""
    wanted = re.compile(r'^core\..*(thread|parallel)')
    devel = os.path.join(WORKSPACE, 'core', 'threads', 'devel')
    options = ['-DCPROX_SANITIZE=thread', *INSTRUMENTED, '-DPYTHON_EXECUTABLE=/usr/bin/python3',
               f'-DCATKIN_DEVEL_PREFIX={devel}']

    def targets(build):
        core_targets = [name.split('.', 1)[1] for name, _, _ in ctest_entries(build, *CORE_FOLDERS) if wanted.search(name)]
        return ['scene_test_threads', *core_targets]
    build = build_apart('threads', options, targets)
    if build is None:
        return Count(0, 1, ['threads: the build failed'])
    count = run_core_tests(build, 'threads', only=wanted.pattern)
    results = log_path('threads-scene') + '.xml'
    if os.path.exists(results):
        os.remove(results)
    command = [os.path.join(devel, 'lib/curve_proximity/scene_test_threads'), f'--gtest_output=xml:{results}']
    # the libraries of this build: the workspace's own, which its setup puts first, are not instrumented and would look racy
    libraries = {'LD_LIBRARY_PATH': os.pathsep.join(filter(None, [f'{devel}/lib', os.environ.get('LD_LIBRARY_PATH')]))}
    return count + run_one(command, 'threads-scene', lambda _, code, name: count_junit(results, code, name), env=libraries)


def compile_commands_once():
    """A folder with the workspace's compile commands, the first of each file: clang-tidy analyses a file once for each of its
    commands, and the tests compile the core a second time, with fused multiplications."""
    with open(os.path.join(workspace_build(), 'compile_commands.json')) as listed:
        first = {}
        for entry in json.load(listed):
            first.setdefault(entry['file'], entry)
    folder = os.path.join(LOGS, 'tidy')
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, 'compile_commands.json'), 'w') as out:
        json.dump(list(first.values()), out)
    return folder


def tidy():
    files = [path for path in sources('src/core', 'src/fourier', 'check') if path.endswith('.c')]
    command = ['xargs', '-a', write_list(files), f'-P{RUNNERS}', '-n4', 'clang-tidy', '--quiet', '-p', compile_commands_once()]
    return run_one(command, 'clang-tidy', count_exit, limit=1800)


def write_list(files):
    path = os.path.join(LOGS, 'files.txt')
    with open(path, 'w') as out:
        out.write('\n'.join(files) + '\n')
    return path


# Rostests that hold an answer against the wall clock have the machine to themselves.
ALONE = r'_ros_(batches|concurrency|diagnostics|lifetime|managers|no_clock|nodelet|robot|topics)\.test$'


def run_catkin_test(title, command, folder):
    """One gtest, rostest or script, run as catkin runs it, with a results folder of its own: two may run at a time."""
    title = re.sub('^_ctest_curve_proximity_', '', title)
    results = next((word for word in command if word.endswith('.xml')), None)  # …/test_results/PACKAGE/NAME.xml
    if results:
        shared = os.path.dirname(os.path.dirname(results))
        own = os.path.join(shared, title)
        shutil.rmtree(own, ignore_errors=True)
        command = [word.replace(shared, own) for word in command]
        results = results.replace(shared, own)
        os.makedirs(os.path.dirname(results))
    read = count_rostest if title.startswith('rostest_') else count_junit
    counter = (lambda _, code, name: read(results, code, name)) if results else count_lines
    return run_one(command, title, counter, cwd=folder)


def cli_modules(entry, only=''):
    """The tests of the command line, a job for each module test_*.py."""
    title, command, folder = entry
    modules = sorted(os.path.basename(path)[:-3] for path in glob.glob(os.path.join(REPO, 'test/cli/test_*.py')))
    return [lambda m=module: run_catkin_test(f'{title}-{m}', [*command, m], folder)
            for module in modules if only in ('', module)]


def catkin_jobs(folder, only='', alone=None):
    """The jobs of test/FOLDER/CMakeLists.txt: those with a part of a name, and of these those that run alone or those that
    do not."""
    jobs = []
    for entry in ctest_entries(workspace_build(), folder):
        if alone not in (None, bool(re.search(ALONE, entry[0]))):
            continue
        if entry[0] == 'cli':
            jobs += cli_modules(entry, only)
        elif not only or re.search(rf'(^|[_/]){re.escape(only)}(\.test)?$', entry[0]):
            jobs.append(lambda e=entry: run_catkin_test(*e))
    return jobs


def room(name):
    """The gtests, rostests and scripts that test/NAME/CMakeLists.txt declares."""
    together, one_by_one = catkin_jobs(name, alone=False), catkin_jobs(name, alone=True)
    if not together + one_by_one:
        return Count(0, 1, [f'test/{name}: no test was found'])
    return sum((job() for job in one_by_one), run_together(together))


def run_named(name):
    """One test, GROUP.NAME: of the core as ctest names it, of the other rooms by a part of its name."""
    folder, _, part = name.partition('.')
    if folder in CORE_FOLDERS:
        return run_core_tests(workspace_build(), 'release', only=f'^{re.escape(name)}$', folders=(folder,))
    jobs = catkin_jobs(folder, part)
    return run_together(jobs) if jobs else Count(0, 1, [f'{name}: no such test'])


def install():
    return run_one([os.path.join(REPO, 'test/install/run')], 'install', count_lines, limit=1800)


def demo():
    return run_one([os.path.join(REPO, 'test/install/demo')], 'demo', count_lines)


def first_hour():
    """doc/first-hour.md, but for what the groups demo and install do: the demo, and C against a prefix."""
    tasks = [str(number) for number in range(2, 11) if number != 7]
    return run_one([os.path.join(REPO, 'scripts/first_hour'), *tasks], 'first_hour', count_lines)


def bench_pages():
    return run_one([os.path.join(REPO, 'test/bench/run_tests.py')], 'bench', count_lines)


def on_debian_12():
    """The formatter's and the linter's verdict changes with their version: Debian 12's (14) is the one that holds."""
    with open('/etc/os-release') as text:
        release = text.read()
    return 'ID=debian' in release and 'VERSION_ID="12"' in release


GROUPS = {
    'layering': layering, 'headers': headers, 'text': text, 'docs': docs, 'lint': lint, 'format': formatting, 'bench': bench_pages,
    'core': core, 'tidy': tidy, 'sanitizers': sanitized, 'threads': threads,
    'scene': lambda: room('scene'), 'providers': lambda: room('providers'), 'cli': lambda: room('cli'), 'python': lambda: room('python'),
    'ros': lambda: room('ros'),
    'install': install, 'demo': demo, 'first_hour': first_hour,
}

# These work beside all others, when nothing else wants the processor: while rostests wait, which they mostly do, while CMake
# configures, and while the last program of a build is compiled.
WHEN_IDLE = ('tidy', 'threads')

NAMED = (*CORE_FOLDERS, 'scene', 'providers', 'cli', 'python', 'ros')  # rooms whose tests have names: scripts/test core.test_pair


def timed(name):
    """Runs a group or a named test: its count and how many seconds it took."""
    begin = time.monotonic()
    try:
        count = GROUPS[name]() if name in GROUPS else run_named(name)
    except (OSError, subprocess.SubprocessError, KeyError, ValueError) as error:
        count = Count(0, 1, [f'{name}: {error}'])
    return count, time.monotonic() - begin


def report(name, count, seconds):
    """Prints a group's line; returns its count."""
    with PRINTING:
        print(f'{name:<12}{count.passed:>8}{count.failed:>8}{seconds:>9.0f}', flush=True)
    return count


def main():
    parser = argparse.ArgumentParser(prog='scripts/test')
    parser.add_argument('groups', nargs='*', help='only these groups, or single tests, such as core.test_pair')
    parser.add_argument('--list', action='store_true', help='name the groups')
    arguments = parser.parse_args()
    if arguments.list:
        print('\n'.join(GROUPS))
        return 0
    if not WORKSPACE or not LOGS:
        parser.error('WORKSPACE and LOGS are not set: scripts/test sets them, and runs this')
    unknown = [name for name in arguments.groups if name not in GROUPS and name.partition('.')[0] not in NAMED]
    if unknown:
        parser.error(f"no group {', '.join(unknown)}: there are {', '.join(GROUPS)}")

    # Nodes under test find each other whatever this machine's name is.
    os.environ['ROS_HOSTNAME'] = 'localhost'
    os.environ.pop('ROS_IP', None)

    # Run, a line a group.
    groups = arguments.groups or list(GROUPS)
    if not arguments.groups and not on_debian_12():
        groups = [name for name in groups if name not in ('format', 'tidy', 'docs')]
        print('format, tidy, docs: left to Debian 12, whose clang 14 and Doxygen 1.9 they are written for')
    os.makedirs(LOGS, exist_ok=True)
    total = Count()
    print(f"{'group':<12}{'passed':>8}{'failed':>8}{'seconds':>9}", flush=True)
    idle = [name for name in WHEN_IDLE if name in groups] if not arguments.groups else []
    with concurrent.futures.ThreadPoolExecutor(1, initializer=work_when_idle) as beside:
        waiting = [(name, beside.submit(timed, name)) for name in idle]
        for name in groups:
            if name not in idle:
                total += report(name, *timed(name))
        for name, group in waiting:
            total += report(name, *group.result())

    # Say what failed, then the sum.
    for failure in total.failures:
        print(f'FAILED {failure}')
    print(f'logs: {LOGS}')
    print(f'{total.passed} passed, {total.failed} failed')
    return 1 if total.failed or not total.passed else 0


if __name__ == '__main__':
    sys.exit(main())
