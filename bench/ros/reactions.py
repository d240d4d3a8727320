#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The group `reactions`: how soon node and gate react, by the clock, with a master, nodes and a controller of its own:
reactions.py [--quick]

goal cancelled       from the call that puts a post in the way of a goal that runs, or from the server's death, to the cancellation that
                     its controller gets. Beside it, another client sends goals of 30,000 points without end.
one more object      a call of ~apply_scene with one ball, among those that are there; and that call with a curve asked about after it.
batch of a dead client  from the client's death to the end of its goal of ~query."""
import argparse
import os
import signal
import statistics
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
TESTS = os.path.join(HERE, '..', '..', 'test', 'ros')
sys.path.append(TESTS)
from helpers import ActionClient, Node, Server, bezier, executable, free_port, ring_and_shells, sphere, start_master, thing, until  # noqa: E402

ROWS, sys.stdout = sys.stdout, sys.stderr  # rospy's log goes there
LIMIT = 0.05  # [m]
IN_THE_WAY, AT_THE_END = (0, 0.5, 0.5), (-0.5, -0.1, 0.5)  # of the arm's ball after a quarter turn; after the long goals, the other way round


def row(workload, parameter, seconds):
    times = sorted(1e6 * s for s in seconds)
    print('reactions,%s,curve_proximity,%s,%.0f,%.0f,0,0,%.0f,0,0' % (
        workload, parameter, statistics.median(times), times[int(0.95 * (len(times) - 1))], times[-1]), file=ROWS, flush=True)


class Cell:
    """An arm with its controller, a gate, and the server that the gate asks."""

    def __init__(self):
        import rospy
        from gate import Action, Arm, Controller
        from sensor_msgs.msg import JointState
        with open(os.path.join(TESTS, 'data', 'arm.urdf')) as urdf:
            rospy.set_param('/robot_description', urdf.read())
        self.arm = Arm(rospy.Publisher('/curve_proximity/joint_states', JointState, queue_size=5))
        self.controller, self.cancelled = Controller(self.arm), []
        self.controller.server.register_preempt_callback(lambda: self.cancelled.append(time.monotonic()))
        rospy.set_param('/gate', {'delta': LIMIT, 'server': '/curve_proximity', 'controller': '/controller/follow_joint_trajectory'})
        self.node = None
        self.gate = subprocess.Popen([executable('nodelet', 'nodelet'), 'standalone', 'curve_proximity/TrajectoryGate', '__name:=gate',
                                      '~joint_states:=/curve_proximity/joint_states'], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.client = ActionClient('/gate/follow_joint_trajectory', Action)
        assert self.client.wait_for_server(rospy.Duration(20))

    def end(self):
        self.gate.terminate()
        self.gate.wait()
        self.node.end()

    def launch(self):
        if self.node:
            self.node.end()
        self.node = Node('curve_proximity', fixed_frame='base', delta=LIMIT)
        self.server = Server()
        self.server.replace(sphere('wall', 0.1, AT_THE_END))
        assert until(lambda: self.server.distance([], robot_state=True).success, 10)  # the joints have come

    def reaction(self, what):
        """[s] from the call of what() to the cancellation of a goal that runs."""
        from gate import Goal, turning

        def runs():
            self.client.send_goal(Goal(trajectory=turning(2.0, 20.0)))
            return until(self.controller.server.is_active, 2)
        self.arm.rest()
        assert until(runs, 20), self.client.get_goal_status_text()
        time.sleep(0.3 + 0.01 * (len(self.cancelled) % 5))  # anywhere between two looks
        before = len(self.cancelled)
        begin = time.monotonic()
        what()
        assert until(lambda: len(self.cancelled) > before, 10, 0.002), 'a goal was not cancelled'
        until(lambda: not self.controller.server.is_active(), 5)
        return self.cancelled[before] - begin

    def appear(self):
        seconds = self.reaction(lambda: self.server.apply(sphere('post', 0.1, IN_THE_WAY)))
        self.server.apply(thing('post', operation=thing('').REMOVE))
        return seconds

    def die(self):
        self.launch()
        return self.reaction(lambda: self.node.process.send_signal(signal.SIGKILL))


def send_long_goals():
    """A client as a process of its own: its goals reach the wall after 29,000 of their points."""
    import rospy
    from gate import Action, Goal, turning
    rospy.init_node('long', anonymous=True)
    client = ActionClient('/gate/follow_joint_trajectory', Action)
    assert client.wait_for_server(rospy.Duration(20))
    goal = Goal(trajectory=turning(-3.0, 60.0, parts=30000))
    while not rospy.is_shutdown():
        client.send_goal(goal)
        client.wait_for_result(rospy.Duration(60))
        print(client.get_state(), file=ROWS, flush=True)


def measure_gate(rounds):
    cell = Cell()
    try:
        cell.launch()
        row('goal cancelled', 'a post appears', [cell.appear() for _ in range(rounds)])
        with subprocess.Popen([sys.executable, __file__, '--long'], stdout=subprocess.PIPE, text=True) as long:
            assert int(long.stdout.readline()) == 5, 'a goal of 30,000 points was not rejected'
            row('goal cancelled', 'a post appears beside goals of 30000 points', [cell.appear() for _ in range(rounds)])
            long.kill()
        row('goal cancelled', 'the server dies', [cell.die() for _ in range(max(3, rounds // 4))])
    finally:
        cell.end()


def measure_scene(rounds):
    node = Node('many')
    try:
        server, line = Server('/many'), bezier((0, 0, 1), (1, 0, 1))
        for n in (1, 10000):
            server.replace(*[sphere('b%d' % i, 0.05, (0.3 * (i % 100), 0.3 * (i // 100), 0)) for i in range(n)])
            server.distance(line)
            added, asked = [], []
            for k in range(10 * rounds):
                begin = time.perf_counter()
                assert server.apply(sphere('x%d' % k, 0.1, (0, 0, 5 + k))).success
                added.append(time.perf_counter() - begin)
                assert server.distance(line).success
                asked.append(time.perf_counter() - begin)
            row('one more object', 'among %d' % n, added)
            row('one more object and a curve', 'among %d' % n, asked)
    finally:
        node.end()


def measure_dead_clients(rounds):
    import rospy
    from curve_proximity.msg import QueryActionFeedback
    node = Node('batches')
    ends, begun, times = [], [], []
    topics = [rospy.Subscriber('/batches/query/result', rospy.AnyMsg, lambda _: ends.append(time.monotonic())),
              rospy.Subscriber('/batches/query/feedback', QueryActionFeedback, begun.append)]
    try:
        Server('/batches').replace(*ring_and_shells()[1])
        for _ in range(max(3, rounds // 4)):
            del ends[:], begun[:]
            with subprocess.Popen([sys.executable, os.path.join(TESTS, 'batches.py'), '--send', '/batches']) as client:
                assert until(lambda: begun, 20) and not ends
                begin = time.monotonic()
                client.kill()
            assert until(lambda: ends, 20, 0.001)
            times.append(ends[0] - begin)
        row('batch of a dead client', 'ends', times)
    finally:
        for topic in topics:
            topic.unregister()
        node.end()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--quick', action='store_true', help='a third of the rounds')
    parser.add_argument('--long', action='store_true', help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.long:
        return send_long_goals()
    rounds = 10 if arguments.quick else 30
    port = free_port()
    os.environ.update(ROS_MASTER_URI='http://localhost:%d' % port, ROS_HOSTNAME='localhost')
    master = start_master(port)
    try:
        import rospy
        rospy.init_node('bench_reactions')
        measure_scene(rounds)
        measure_dead_clients(rounds)
        measure_gate(rounds)
        rospy.signal_shutdown('all is measured')  # the controller's thread ends
    finally:
        master.terminate()
        master.wait()
    return 0


if __name__ == '__main__':
    sys.exit(main())
