"""Figures of a loaded node: its memory, what its consumers get, and what it says of itself."""
import os
import pathlib
import statistics
import struct
import sys
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'faults'))
from processes import memory_kb, wait_until  # noqa: E402 (the path has to be known before)

SENSOR_PIXELS = 346 * 260
VINS_MONO_GAP_S = 1.0
SAMPLE_PERIOD_S = 0.05
REPORT_TIMEOUT_S = 30


def memory_bound_mb(max_buffered_events, pixels=SENSOR_PIXELS):
    return (12 * max_buffered_events + 48 * pixels) / 1e6 + 80


def quantile(values, share):
    ordered = sorted(values)
    return ordered[min(int(share * len(ordered)), len(ordered) - 1)] if ordered else 0.0


def slope(points):
    """Least squares through (x, y)."""
    if len(points) < 2:
        return 0.0
    mean_x = statistics.fmean(x for x, _ in points)
    mean_y = statistics.fmean(y for _, y in points)
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / spread if spread else 0.0


class MemoryLog:
    """Resident memory of a process [MB] over time, as pairs with seconds since `zero`."""

    def __init__(self, pid, zero, period_s=SAMPLE_PERIOD_S):
        self.samples = []
        self.stop = threading.Event()
        self.thread = threading.Thread(target=self.run, args=(pid, zero, period_s), daemon=True)
        self.thread.start()

    def run(self, pid, zero, period_s):
        while not self.stop.wait(period_s) and os.path.exists('/proc/%d' % pid):
            self.samples.append((time.monotonic() - zero, memory_kb(pid) * 1024 / 1e6))

    def end(self):
        self.stop.set()
        self.thread.join()
        return self.samples


class ImageLog:
    """When images with which stamp arrived: (seconds on the monotonic clock, stamp in ns).

    Images are not unpacked: that would cost more than all the rest.
    """

    def __init__(self, topic):
        self.entries = []
        self.subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self.take, buff_size=2 ** 24,
                                           tcp_nodelay=True)

    def take(self, message):
        _, seconds, nanoseconds = struct.unpack_from('<III', message._buff)
        self.entries.append((time.monotonic(), seconds * 10 ** 9 + nanoseconds))


class Diagnostics:
    """The newest report of a node, as numbers by name."""

    def __init__(self, node):
        self.node = node.lstrip('/')
        self.count = 0
        self.values = {}
        self.subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self.take)

    def take(self, array):
        for status in array.status:
            if status.name.lstrip('/').startswith(self.node):
                self.values = {value.key: value.value for value in status.values}
                self.count += 1

    def next(self):
        """The values of the next report."""
        seen = self.count
        wait_until(lambda: self.count > seen, REPORT_TIMEOUT_S, 'a report')
        return self.values

    def number(self, key):
        return float(self.values.get(key, 0))

    def settle(self, keys, timeout_s):
        """Waits until these stay the same for two reports, or the time is over."""
        deadline = time.monotonic() + timeout_s
        same = 0
        before = None
        while same < 2 and time.monotonic() < deadline:
            values = self.next()
            now = [values.get(key) for key in keys]
            same = same + 1 if now == before else 0
            before = now
