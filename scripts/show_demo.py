# SPDX-License-Identifier: BSD-3-Clause
"""The demo proper, in the environment of the built workspace: see scripts/demo."""
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time

import numpy as np
import yaml

import draw_scene
from free_port import free_port

REPO = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LOGS = os.environ['LOGS']
NODE = '/curve_proximity'
ROBOT = os.path.join(REPO, 'test/data/robots/panda/panda.urdf')
SCENE = os.path.join(REPO, 'test/data/scenes/mbm/bookshelf_tall_panda/scene0001.yaml')

# A ball of 2 cm radius, say the tip of a tool, along a cubic B-spline: into the shelf, round Can7, out past Can9. The
# same as examples/tool.csv.
RADIUS, DEGREE, TOLERANCE, PIECES = 0.02, 3, 0.010, 72
CONTROL = [[-0.375, 0.344, 0.62], [-0.286, 0.412, 0.56], [0.02, 0.631, 0.47], [0.195, 0.901, 0.43],
           [0.375, 1.147, 0.42], [0.671, 0.967, 0.43], [0.61, 0.656, 0.45], [0.398, 0.448, 0.45], [0.208, 0.284, 0.36],
           [-0.038, 0.236, 0.3]]
KNOTS = [0.0] * DEGREE + list(np.linspace(0.0, 1.0, len(CONTROL) - DEGREE + 1)) + [1.0] * DEGREE

# The arm waiting in front of the shelf, and reaching into it (start and goal of the scene's planning problem).
JOINTS = [f'panda_joint{i}' for i in range(1, 8)]
FINGERS = 'panda_finger_joint1'  # closed, at 0
WAITING = [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]
REACHING = [-2.7783, -0.7590, -2.4919, -2.1355, 2.8973, 2.0248, 0.4576]


# A box that falls in front of the shelf, from 1.6 m to 0.2 m within 0.8 s, and turns by 120 degrees about x.
BOX = [0.2, 0.1, 0.3]
FALL = [{'time': 0.0, 'pose': {'position': {'x': 0.5, 'y': 0.06, 'z': 1.6}, 'orientation': {'x': 0.0, 'y': 0.0, 'z': 0.0, 'w': 1.0}}},
        {'time': 0.8, 'pose': {'position': {'x': 0.5, 'y': 0.06, 'z': 0.2},
                               'orientation': {'x': 0.8660254037844386, 'y': 0.0, 'z': 0.0, 'w': 0.5}}}]
FALLING = {'id': 'box', 'primitives': [{'type': 1, 'dimensions': BOX}], 'trajectory': {'waypoints': FALL}}


# The arm moves for 2 s, between a wedge (a mesh) and a cloud of points.
MOVE = {'joint_names': JOINTS, 'points': [
    {'positions': WAITING, 'time_from_start': {'secs': 0, 'nsecs': 0}},
    {'positions': [0.3, -0.6, 0.1, -1.9, 0.0, 1.4, 0.785], 'time_from_start': {'secs': 2, 'nsecs': 0}}]}
BESIDE = [{'id': 'wedge', 'bodies': [{'type': 'mesh', 'vertices': [dict(zip('xyz', corner)) for corner in (
              [0.5, -0.5, 0.0], [0.8, -0.5, 0.0], [0.5, -0.2, 0.0], [0.5, -0.25, 0.5])],
              'triangles': [{'vertex_indices': corners} for corners in ([0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3])]}]},
          {'id': 'cloud', 'bodies': [{'type': 'points', 'dimensions': [0.01], 'vertices': [
              {'x': 0.4 + 0.02 * (i % 8), 'y': 0.37 + 0.02 * (i // 8 % 8), 'z': 0.55 + 0.02 * (i // 64)} for i in range(256)]}]}]


class Failure(Exception):
    """Something that a person must read, in one sentence."""


# ------------------------------------------------------------------------------------------------- starting, stopping
class Programs:
    """What the demo started, each in a session of its own; all of it is ended, whatever happens."""

    def __init__(self):
        self.running = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for sign, patience in ((signal.SIGINT, 8), (signal.SIGTERM, 3), (signal.SIGKILL, 3)):
            for process in reversed(self.running):
                self.end(process, sign, patience)

    @staticmethod
    def end(process, sign, patience):
        try:
            os.killpg(process.pid, sign)
            process.wait(patience)
        except (ProcessLookupError, subprocess.TimeoutExpired):
            pass

    def start(self, name, *command):
        log = os.path.join(LOGS, f'demo-{name}.log')
        with open(log, 'w') as out:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT,
                                       start_new_session=True)
        self.running.append(process)
        return process, log


def wait_for(query, process, log, seconds):
    """Waits until query() is true; a program that has ended or says nothing for too long is a failure."""
    deadline = time.monotonic() + seconds
    while not query():
        if process.poll() is not None or time.monotonic() > deadline:
            with open(log, errors='replace') as text:
                tail = ''.join(text.readlines()[-15:])
            raise Failure(f'{tail}\n{os.path.basename(log)[5:-4]} did not start; the end of {log} is above')
        time.sleep(0.1)


# -------------------------------------------------------------------------------------------------------------- asking
def run(*command, seconds=60):
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          timeout=seconds, universal_newlines=True)
    if done.returncode != 0:
        raise Failure(f"{' '.join(command[:3])}: {(done.stderr or done.stdout).strip()}")
    return done.stdout


def serving():
    listed = subprocess.run(['rosservice', 'list', NODE], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return f'{NODE}/distance'.encode() in listed.stdout


def master_answers():
    quiet = {'stdout': subprocess.DEVNULL, 'stderr': subprocess.DEVNULL}
    return subprocess.call(['rosparam', 'get', '/run_id'], **quiet) == 0


def ask(query_type, **request):
    """Calls a service of the node with rosservice, and returns its results."""
    own = {name: request.pop(name) for name in ('delta',) if name in request}
    text = yaml.safe_dump(dict(own, query=request), default_flow_style=True, width=1e9)
    answer = yaml.safe_load(run('rosservice', 'call', f'{NODE}/{query_type}', text))
    if not answer['success']:
        raise Failure(f"{query_type}: {answer['message']}")
    return answer['results']


def change(thing):
    """Adds an object to the scene of the node, or removes it."""
    answer = yaml.safe_load(run('rosservice', 'call', f'{NODE}/apply_scene', yaml.safe_dump({'objects': [thing]}, width=1e9)))
    if not answer['success']:
        raise Failure(f"apply_scene: {answer['message']}")


def checked(row, *query, files=(), robot=True):
    """Prints the line of cprox_check about the certificate of a row, for the same query read from files: words of `cprox
    check`, and {option: text of a file}."""
    proof = bytes(row['certificate'])
    with tempfile.TemporaryDirectory() as folder:
        words = [os.path.join(folder, 'proof.cpc')]
        with open(words[0], 'wb') as out:
            out.write(struct.pack('<I', len(proof)) + proof)
        for option, text in files:
            words += [option, os.path.join(folder, option[2:])]
            with open(words[-1], 'w') as out:
                out.write(text)
        words += ['--robot', ROBOT] if robot else []
        line = run('cprox', 'check', *words, *query).strip()
    print(f'   cprox_check: {line.partition(": ")[2]}')


def checked_tool(row, positions):
    numbers = [0.0, 1.0, RADIUS, len(CONTROL), *sum(CONTROL, []), *map(float, KNOTS)]
    curve = ','.join(['tool', 'bspline', str(DEGREE), *map(repr, numbers)]) + '\n'
    state = ', '.join(f'{name}: {value}' for name, value in zip(JOINTS, positions))
    checked(row, '--scene', SCENE, '--state', state, files=[('--curves', curve)])


def checked_arm(row, trajectory, things):
    """things: objects of the scene beside those of its file."""
    with open(SCENE) as text:
        scene = yaml.safe_load(text)
    scene['world']['collision_objects'] += things
    checked(row, files=[('--trajectory', yaml.safe_dump({'joint_trajectory': trajectory})), ('--scene', yaml.safe_dump(scene))])


def checked_fall(row):
    with open(SCENE) as text:
        scene = yaml.safe_load(text)
    scene['world']['collision_objects'].append(FALLING)
    checked(row, '--movers', files=[('--scene', yaml.safe_dump(scene))], robot=False)


def tool_path(t0=0.0, t1=1.0):
    points = [dict(zip('xyz', point)) for point in CONTROL]
    return {'id': 'tool', 'basis': 'bspline', 'degree': DEGREE, 'radius': RADIUS, 't0': float(t0), 't1': float(t1),
            'points': points, 'knots': [float(k) for k in KNOTS]}


def posture(positions):
    return {'name': JOINTS + [FINGERS], 'position': positions + [0.0]}


def point(message):
    return [float(message[axis]) for axis in 'xyz']


def at(message):
    return '({:.3f}, {:.3f}, {:.3f}) m'.format(*point(message))


# ------------------------------------------------------------------------------------------------------------ the demo
def ask_and_tell():
    """The queries, in words. Returns the nearest pair."""
    waiting, reaching = posture(WAITING), posture(REACHING)

    print('\n1. How close does the tool come to anything?   rosservice call ~distance')
    near, = ask('distance', curves=[tool_path()], joint_state=waiting, epsilon=1e-6, certificate=True)
    lower, upper, microseconds = (float(near[key]) for key in ('lower', 'upper', 'microseconds'))
    print(f"   {1e3 * upper:.6f} mm, to {near['b']}, at t = {float(near['t']):.4f} of the path.\n"
          f"   The tool's surface is then at {at(near['witness_a'])}, that of {near['b']} at {at(near['witness_b'])}.\n"
          f"   Certified: the true distance is at most {1e3 * (upper - lower):.1g} mm less, and no more. "
          f"It took {near['nodes']} intervals, {microseconds:.0f} microseconds.")
    checked_tool(near, WAITING)

    print(f'\n2. Does it stay more than {1e3 * TOLERANCE:.0f} mm clear of everything?   rosservice call ~tolerance')
    clear, = ask('tolerance', curves=[tool_path()], joint_state=waiting, delta=TOLERANCE, certificate=True)
    print('   ' + {'clear': 'Yes, everywhere along the path', 'violated': f"No: {clear['b']} is closer at t = {float(clear['t']):.4f}"}
          .get(clear['verdict'], 'Undecided, which counts as no') + f": {clear['nodes']} intervals settle it.")
    checked_tool(clear, WAITING)

    print('\n3. And while the arm reaches into the shelf: does the tool hit it?   rosservice call ~collision')
    hit, = ask('collision', curves=[tool_path()], joint_state=reaching, certificate=True)
    print('   ' + {'violated': f"Yes: it hits {hit['b']} at t = {float(hit['t']):.4f}, near {at(hit['witness_a'])}.",
                   'clear': 'No: the whole path is free.'}.get(hit['verdict'], 'Undecided, which counts as a hit.'))
    checked_tool(hit, REACHING)

    print('\n4. A box is dropped past the shelf, and turns: how close does it come?   rosservice call ~distance')
    change(FALLING)
    fall, = ask('distance', movers=True, certificate=True)
    change({'id': 'box', 'operation': 1})
    print(f"   {1e3 * float(fall['upper']):.6f} mm, to {fall['b']}, at t = {float(fall['t']):.4f} s of the fall.")
    checked_fall(fall)

    print('\n5. The arm moves between a wedge and a cloud: how close does it come?   rosservice call ~distance')
    for thing in BESIDE:
        change(thing)
    arm, = ask('distance', trajectories=[MOVE], joint_state=waiting, epsilon=1e-5, certificate=True)
    for thing in BESIDE:
        change({'id': thing['id'], 'operation': 1})
    print(f"   {1e3 * float(arm['upper']):.2f} mm, {arm['a']} to {arm['b']}, after {float(arm['t']):.3f} s.")
    checked_arm(arm, MOVE, BESIDE)
    return near


def picture(out, near):
    """Draws the scene; the tool is coloured piece by piece, each piece asked for as a curve of its own."""
    ends = np.linspace(0.0, 1.0, PIECES + 1)
    curves = [tool_path(a, b) for a, b in zip(ends, ends[1:])]
    pieces = ask('distance', curves=curves, joint_state=posture(WAITING), epsilon=1e-4)
    draw_scene.draw(
        out, SCENE, ROBOT, dict(zip(JOINTS, WAITING)), draw_scene.bspline_points(CONTROL, DEGREE, KNOTS, ends), RADIUS,
        [float(piece['lower']) for piece in pieces],
        {'a': point(near['witness_a']), 'b': point(near['witness_b']), 'name': near['b'], 't': float(near['t']),
         'distance': float(near['lower'])},
        f'A tool of {100 * RADIUS:.0f} cm radius\nthrough a shelf, past a Panda')


def main(out):
    # A master of our own, on a machine whose name need not be known to any name server.
    os.environ['ROS_MASTER_URI'] = f'http://localhost:{free_port()}'
    os.environ['ROS_HOSTNAME'] = 'localhost'
    os.environ.pop('ROS_IP', None)
    with Programs() as programs:
        print('starting roscore and the node, with a Panda in front of a bookshelf of nine cans')
        core, log = programs.start('roscore', 'roscore', '-p', os.environ['ROS_MASTER_URI'].rsplit(':', 1)[1])
        wait_for(master_answers, core, log, 30)
        launch, log = programs.start('node', 'roslaunch', '--wait', 'curve_proximity', 'demo.launch', 'rviz:=false', 'play:=false',
                                     'scene:=')
        wait_for(serving, launch, log, 60)
        run('cprox', 'send', SCENE, '--node', NODE)
        near = ask_and_tell()
        picture(out, near)
    print(f'\nthe picture: {out}')
    return 0


if __name__ == '__main__':
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    try:
        sys.exit(main(sys.argv[1]))
    except Failure as failure:
        print(failure, file=sys.stderr)
        sys.exit(1)
    except KeyboardInterrupt:
        sys.exit(130)
