"""ROS processes that a test starts, watches and kills, on a master of its own."""
import os
import signal
import socket
import subprocess
import sys
import threading
import time
import xmlrpc.client

import roslib.packages
import rosgraph
import rospy

POLL_S = 0.02
STOP_TIMEOUT_S = 30  # roslaunch itself waits for half of that


class Failure(Exception):
    """What was expected of the package did not happen."""


def free_port():
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        return probe.getsockname()[1]


def find_program(package, name):
    found = roslib.packages.find_node(package, name)
    if not found:
        sys.exit('%s/%s was not found: was devel/setup.bash sourced and the target %s built?'
                 % (package, name, name))
    return found[0]


def wait_until(condition, timeout_s, what):
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            raise Failure('%s: not within %d s' % (what, timeout_s))
        time.sleep(POLL_S)


class Process:
    """A child with children of its own, all of them gone when the block ends."""

    def __init__(self, arguments, log):
        self.child = subprocess.Popen([str(word) for word in arguments], stdin=subprocess.DEVNULL,
                                      stdout=log, stderr=subprocess.STDOUT,
                                      start_new_session=True)

    def __enter__(self):
        return self.child

    def __exit__(self, *_):
        for signal_number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            if self.child.poll() is not None:
                break
            self.child.send_signal(signal_number)
            try:
                self.child.wait(STOP_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                continue
        try:
            os.killpg(self.child.pid, signal.SIGKILL)  # children that it left behind
        except ProcessLookupError:
            pass


def use_own_master():
    """The port of a master to come, to which ROS_MASTER_URI leads from now on."""
    port = free_port()
    os.environ['ROS_MASTER_URI'] = 'http://localhost:%d' % port
    return port


def wait_for_master(timeout_s):
    wait_until(rosgraph.is_master_online, timeout_s, 'the ROS master to answer')


def leave_ros():
    """Ends rospy in this process."""
    if not hasattr(threading.Thread, 'isAlive'):
        # Debian 11's rospy still asks for it, though Python has not had it since 3.9.
        threading.Thread.isAlive = threading.Thread.is_alive
    rospy.signal_shutdown('done')


def pid_of(node):
    """Process of a ROS node, None when there is none of that name."""
    try:
        address = rosgraph.Master('/test_faults').lookupNode(node)
        return xmlrpc.client.ServerProxy(address).getPid('/test_faults')[2]
    except (rosgraph.MasterException, OSError, xmlrpc.client.Error):
        return None


def cpu_seconds(pid):
    """Processor time that a process has used, in user and kernel mode."""
    with open('/proc/%d/stat' % pid, encoding='utf-8') as stat:
        fields = stat.read().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def memory_kb(pid, key='VmRSS'):
    with open('/proc/%d/status' % pid, encoding='ascii') as status:
        for line in status:
            if line.startswith(key + ':'):
                return int(line.split()[1])
    raise Failure('process %d has no %s' % (pid, key))
