#!/usr/bin/env python3
"""Measures the nodelet over TCPROS: throughput, loss, latency, CPU share and memory.

The nodelet runs alone on the first processor of this process, everything else on the others. Needs
the environment of the build (devel/setup.bash). Writes a JSON list, one entry for each case.

    tcpros.py RESULTS.json [--seconds 10] [--latency-seconds 60]
"""
import argparse
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'faults'))
from processes import cpu_seconds, find_program, free_port, memory_kb  # noqa: E402 (needs the path)

NAMESPACE = '/dvs'
NODELET = NAMESPACE + '/deblur'
START_TIMEOUT_S = 30
SETTLE_TIMEOUT_S = 15
STOP_TIMEOUT_S = 10
LOST_BY_RECEIVER = ('Events late', 'Events overflowed', 'Events glitched', 'Event array gaps',
                    'Frames without an event', 'Frames closed by timeout')


class Case:
    """What the load generator sends. Plain EDI unless `defaults`."""

    def __init__(self, name, rate_mev_s, array_ms, seconds, unpaced=False, defaults=False):
        self.name = name
        self.rate_mev_s = rate_mev_s
        self.array_ms = array_ms
        self.seconds = seconds
        self.unpaced = unpaced
        self.defaults = defaults
        # At several times what sensors deliver, the default holds no more than a tenth of a second.
        self.max_buffered_events = 13000000 if rate_mev_s <= 13 else 40000000

    def arguments(self):
        arguments = ['--rate', str(self.rate_mev_s), '--array', str(self.array_ms),
                     '--seconds', str(self.seconds)]
        return arguments + (['--unpaced'] if self.unpaced else [])


def wait_until(condition, timeout_s, what):
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            raise RuntimeError('%s: not within %d s' % (what, timeout_s))
        time.sleep(0.05)


class Process:
    """A child that is gone when the block ends."""

    def __init__(self, arguments, processors):
        self.child = subprocess.Popen(
            arguments, stdout=subprocess.DEVNULL,
            preexec_fn=lambda: os.sched_setaffinity(0, processors))

    def __enter__(self):
        return self.child

    def __exit__(self, *_):
        self.child.send_signal(signal.SIGINT)
        try:
            self.child.wait(STOP_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self.child.kill()
            self.child.wait()


class Diagnostics:
    """The nodelet's own report, as it comes in once a second."""

    def __init__(self):
        self.reports = []
        self.subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self.receive)

    def receive(self, message):
        for status in message.status:
            if NODELET.lstrip('/') in status.name or NODELET in status.name:
                values = {value.key: value.value for value in status.values}
                if 'Events in' in values:
                    self.reports.append(values)

    def latest(self, key):
        return float(self.reports[-1][key])

    def settle(self):
        """Waits until nothing changes from one report to the next."""
        def settled():
            return len(self.reports) > first + 2 and all(
                self.reports[-1][key] == self.reports[-2][key] for key in ('Events in', 'Frames out'))
        first = len(self.reports)
        wait_until(settled, SETTLE_TIMEOUT_S, 'the nodelet to have taken in everything')


def measure(case, nodelet_processor, other_processors):
    rospy.set_param(NODELET + '/contrast_threshold_on', 0.3)
    rospy.set_param(NODELET + '/contrast_threshold_off', 0.3)
    if rospy.has_param(NODELET + '/filter'):
        rospy.delete_param(NODELET + '/filter')
    rospy.set_param(NODELET + '/max_buffered_events', case.max_buffered_events)
    if not case.defaults:
        rospy.set_param(NODELET + '/filter', False)
    nodelet = [find_program('nodelet', 'nodelet'), 'standalone', 'fast_edi/DeblurNodelet',
               '__ns:=' + NAMESPACE, '__name:=' + NODELET.rsplit('/', 1)[1]]
    generator = [find_program('fast_edi', 'event_load_generator'), '__ns:=' + NAMESPACE]
    diagnostics = Diagnostics()
    outputs = []
    output = rospy.Subscriber(NAMESPACE + '/deblurred/image_raw', rospy.AnyMsg,
                              lambda message: outputs.append(len(message._buff)))
    with Process(nodelet, {nodelet_processor}) as child:
        wait_until(lambda: diagnostics.reports, START_TIMEOUT_S, 'diagnostics of ' + NODELET)
        with subprocess.Popen(
                generator + case.arguments(), stdout=subprocess.PIPE, text=True,
                preexec_fn=lambda: os.sched_setaffinity(0, other_processors)) as load:
            wait_until(lambda: output.get_num_connections() > 0, START_TIMEOUT_S, 'the output topic')
            cpu_before, time_before = cpu_seconds(child.pid), time.monotonic()
            report = load.communicate(timeout=case.seconds + START_TIMEOUT_S + SETTLE_TIMEOUT_S)[0]
            elapsed_s = time.monotonic() - time_before
            if load.returncode != 0:
                raise RuntimeError('the load generator failed')
        cpu_s = cpu_seconds(child.pid) - cpu_before
        sent = json.loads(report)
        diagnostics.settle()
        resident_mb, peak_mb = (memory_kb(child.pid, key) * 1024 / 1e6 for key in ('VmRSS', 'VmHWM'))
    diagnostics.subscriber.unregister()
    output.unregister()

    received = diagnostics.latest('Events in')
    result = {
        'case': case.name,
        'array_ms': case.array_ms,
        'asked_mev_s': None if case.unpaced else case.rate_mev_s,
        'sent': sent,
        'throughput_mev_s': received / sent['seconds'] / 1e6,
        'events_lost': sent['events'] - received,
        'skipped_arrays': sent['skipped_arrays'],
        'receiver': {key: diagnostics.latest(key) for key in LOST_BY_RECEIVER},
        'frames_sent': sent['images'],
        'frames_deblurred': diagnostics.latest('Frames deblurred'),
        'frames_received': len(outputs),
        'close_p50_ms': diagnostics.latest('Close latency p50 [ms]'),
        'close_p99_ms': max(float(report['Close latency p99 [ms]'])
                            for report in diagnostics.reports[-3:]),
        'image_to_output_p50_ms': diagnostics.latest('Image to output p50 [ms]'),
        'image_to_output_p99_ms': diagnostics.latest('Image to output p99 [ms]'),
        'windows_predicted': diagnostics.latest('Windows predicted'),
        'windows_not_predicted': diagnostics.latest('Windows not predicted'),
        'cpu_share': cpu_s / min(elapsed_s, sent['seconds']),
        'generator_cpu_share': sent['cpu_seconds'] / sent['seconds'],
        'resident_mb': resident_mb,
        'peak_resident_mb': peak_mb,
    }
    result['nothing_lost'] = (result['events_lost'] == 0 and sent['skipped_arrays'] == 0 and
                              not any(result['receiver'].values()))
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('results')
    parser.add_argument('--seconds', type=float, default=10, help='of the throughput cases')
    parser.add_argument('--latency-seconds', type=float, default=60)
    parser.add_argument('--only', help='run the cases whose name contains this')
    arguments = parser.parse_args()
    cases = [
        Case('100 Mev/s, arrays of 1 ms', 100, 1, arguments.seconds),
        Case('100 Mev/s, arrays of 10 ms', 100, 10, arguments.seconds),
        Case('40 Mev/s, arrays of 33 ms', 40, 33, arguments.seconds),
        Case('as fast as it goes, arrays of 1 ms', 100, 1, arguments.seconds, unpaced=True),
        Case('as fast as it goes, arrays of 10 ms', 100, 10, arguments.seconds, unpaced=True),
        Case('as fast as it goes, arrays of 33 ms', 40, 33, arguments.seconds, unpaced=True),
        Case('13 Mev/s, arrays of 10 ms', 13, 10, arguments.latency_seconds),
        Case('13 Mev/s, default parameters', 13, 10, arguments.seconds, defaults=True),
    ]
    processors = sorted(os.sched_getaffinity(0))
    nodelet_processor, other_processors = processors[0], set(processors[1:] or processors)

    port = free_port()
    os.environ['ROS_MASTER_URI'] = 'http://localhost:%d' % port
    os.sched_setaffinity(0, other_processors)
    results = []
    with Process(['roscore', '-p', str(port)], other_processors):
        wait_until(lambda: rosgraph.is_master_online(os.environ['ROS_MASTER_URI']),
                   START_TIMEOUT_S, 'roscore')
        rospy.init_node('tcpros_benchmark', disable_signals=True)
        for case in cases:
            if arguments.only and arguments.only not in case.name:
                continue
            result = measure(case, nodelet_processor, other_processors)
            results.append(result)
            print('%-36s %6.1f Mev/s, %s, %d of %d frames deblurred, close p50 %.2f p99 %.2f ms, '
                  'CPU %.0f %%, peak %.0f MB' % (
                      case.name, result['throughput_mev_s'],
                      'nothing lost' if result['nothing_lost'] else
                      '%d events lost, %d arrays skipped, receiver: %s' % (
                          result['events_lost'], result['skipped_arrays'], result['receiver']),
                      result['frames_deblurred'], result['frames_sent'], result['close_p50_ms'],
                      result['close_p99_ms'], 100 * result['cpu_share'],
                      result['peak_resident_mb']), flush=True)
    with open(arguments.results, 'w') as out:
        json.dump(results, out, indent=1)


if __name__ == '__main__':
    main()
