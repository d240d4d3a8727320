#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The recipes of examples/datasets, for real: a Slurm array, and GNU parallel over ssh. The table is that of one process.

    sudo scripts/run test/python/dataset_recipes.py --rows 3000 --shards 16 --seed 1

Slurm has one controller on a bridge and two node daemons, each in a network namespace of its own; ssh has a daemon on this
machine with keys of its own. All of it stands in a temporary folder and is ended. Needs Linux, root, iproute2, slurm-wlm, munge,
openssh-server and parallel. The last line is `N passed, N failed`. The environment variable CPROX may name the program.
"""
import argparse
import contextlib
import os
import pwd
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

import dataset_faults  # noqa: E402

RECIPES = os.path.join(os.path.dirname(os.path.dirname(HERE)), 'examples', 'datasets')
NODES = (1, 2)
SSH_PORT = 2222
SLURM = '''ClusterName=cprox
SlurmctldHost={host}({network}1)
SlurmctldPort=16817
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={place}/munge/socket
StateSaveLocation={place}
SlurmdSpoolDir={place}/spool-%n
SlurmdPidFile={place}/slurmd-%n.pid
SlurmctldPidFile={place}/slurmctld.pid
SlurmdLogFile={place}/slurmd-%n.log
SlurmctldLogFile={place}/slurmctld.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
{nodes}
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
'''
SSHD = '''ListenAddress 127.0.0.1
HostKey {place}/host
AuthorizedKeysFile {place}/user.pub
PidFile none
StrictModes no
UsePAM no
'''


@contextlib.contextmanager
def daemons(log, *commands):
    with open(log, 'ab') as stream:
        running = [subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=stream, stderr=stream) for command in commands]
        try:
            yield
        finally:
            for process in running:
                process.terminate()
            for process in running:
                process.wait()


def slurm(campaign):
    """Two node daemons; their tasks reach the controller over the bridge alone."""
    place, out = os.path.join(campaign.place, 'slurm'), os.path.join(campaign.place, 'by-slurm')
    munge = os.path.join(place, 'munge')
    os.makedirs(munge)
    nodes = '\n'.join(f'NodeName=node{i} NodeHostname=localhost NodeAddr={dataset_faults.NETWORK}{10 + i} Port={17000 + i} CPUs=1' for i in NODES)
    config = os.path.join(place, 'slurm.conf')
    with open(config, 'w') as stream:
        stream.write(SLURM.format(place=place, host=os.uname().nodename, network=dataset_faults.NETWORK, nodes=nodes))
    with open(os.path.join(munge, 'key'), 'wb') as stream:
        stream.write(os.urandom(128))
    os.chmod(os.path.join(munge, 'key'), 0o600)
    user = pwd.getpwnam('munge')
    for path in (munge, os.path.join(munge, 'key')):
        os.chown(path, user.pw_uid, user.pw_gid)
    for path in (campaign.place, place, munge):
        os.chmod(path, 0o755)
    os.environ['SLURM_CONF'] = config
    log = os.path.join(campaign.place, 'slurm.log')
    munged = ['setpriv', '--reuid=munge', '--regid=munge', '--init-groups', 'munged', '--foreground', f'--key-file={munge}/key',
              f'--socket={munge}/socket', f'--pid-file={munge}/pid', f'--seed-file={munge}/seed', f'--log-file={munge}/log']
    with daemons(log, munged):
        dataset_faults.wait_for(lambda: os.path.exists(os.path.join(munge, 'socket')), 'munged')
        with daemons(log, ['slurmctld', '-D'], *(['nsenter', f'--net=/run/netns/cprox-{i}', 'slurmd', '-D', '-N', f'node{i}'] for i in NODES)):
            def idle():
                done = subprocess.run(['sinfo', '-h', '-t', 'idle', '-o', '%D'], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
                return done.stdout.strip() == str(len(NODES)).encode()
            dataset_faults.wait_for(idle, 'two idle nodes')
            done = subprocess.run(['sbatch', '--wait', f'--array=0-{campaign.shards - 1}', os.path.join(RECIPES, 'slurm.sbatch'), campaign.manifest, out],
                                  cwd=place, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=dataset_faults.PATIENCE * 4)
            if done.returncode != 0:
                raise RuntimeError(f'sbatch ended with {done.returncode}: {done.stderr}')
            with open(os.path.join(place, 'slurmctld.log')) as stream:
                said = stream.read()
    tasks = [said.count(f'NodeList=node{i}') for i in NODES]
    if not all(tasks):
        raise RuntimeError(f'the nodes had {tasks} tasks')
    campaign.expect_truth(out)
    return f'{campaign.shards} tasks, {" and ".join(map(str, tasks))} on the two nodes, the same bytes as of one process'


def parallel_over_ssh(campaign):
    place, out = os.path.join(campaign.place, 'ssh'), os.path.join(campaign.place, 'by-ssh')
    os.makedirs(place)
    for name in ('host', 'user'):
        dataset_faults.run('ssh-keygen', '-q', '-t', 'ed25519', '-N', '', '-f', os.path.join(place, name))
    config = os.path.join(place, 'sshd_config')
    with open(config, 'w') as stream:
        stream.write(SSHD.format(place=place))
    os.makedirs('/run/sshd', exist_ok=True)
    login = f'ssh -p {SSH_PORT} -i {place}/user -o UserKnownHostsFile={place}/known -o StrictHostKeyChecking=accept-new localhost'
    with daemons(os.path.join(campaign.place, 'ssh.log'), [shutil.which('sshd'), '-D', '-f', config, '-p', str(SSH_PORT)]):
        dataset_faults.wait_for(lambda: subprocess.run([*login.split(), 'true'], stderr=subprocess.DEVNULL).returncode == 0, 'sshd')
        done = subprocess.run([os.path.join(RECIPES, 'parallel_ssh'), campaign.manifest, out, str(campaign.shards), f'2/{login}'],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=dataset_faults.PATIENCE * 4)
    if done.returncode != 0:
        raise RuntimeError(f'parallel ended with {done.returncode}: {done.stderr[-500:]}')
    campaign.expect_truth(out)
    return f'{campaign.shards} shards, the same bytes as of one process'


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--rows', type=int, default=3000)
    parser.add_argument('--shards', type=int, default=16)
    parser.add_argument('--seed', type=int, default=1)
    asked = parser.parse_args()
    missing = [name for name in ('ip', 'slurmctld', 'slurmd', 'munged', 'sshd', 'parallel') if not shutil.which(name)]
    if os.geteuid() != 0 or missing:
        print(f'dataset_recipes.py: needs root, and {", ".join(missing) or "nothing else"}', file=sys.stderr)
        return 2
    cprox = shutil.which(os.environ.get('CPROX', 'cprox'))
    os.environ['CPROX'] = cprox
    os.environ['PATH'] = os.path.dirname(cprox) + os.pathsep + os.environ['PATH']
    with tempfile.TemporaryDirectory(prefix='cprox-recipes-') as place, dataset_faults.network():
        return dataset_faults.run_facts((slurm, parallel_over_ssh), dataset_faults.Campaign(asked, place, cprox))


if __name__ == '__main__':
    sys.exit(main())
