#!/usr/bin/env python3
"""Receives from iniVation's own server by dv_stream_node and prints what was published.

    /usr/bin/python3 test/peers/live.py IN.bag [--rate FACTOR] [--tools DIRECTORY] [--python PYTHON]

Starts a ROS master, the node, and `vendor.py serve` by PYTHON (build/peers/bin/python). Prints how long the server took
to send and the digest of vendor.py: counts and MD5 sums of all events and frames that came over the topics `events`,
`image_raw` and `exposure`. Ends when as much has come as the bag has, or nothing for 20 s. Arrays that are missing by
their `header.seq` are counted on standard error.

With factor 0 the server sends bursts as fast as it can, and waits after each until this program has it: the node keeps
100 arrays for a subscriber, and this one, on a busy machine, may be slower than any burst.
"""
import argparse
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import threading
import time

from messages import Digest, events_of, frame_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = pathlib.Path(__file__).resolve().parent
SILENCE_S = 20
START_S = 60
BURST = 50  # packets; half of what dv_stream_node keeps for a subscriber


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Listener:
    """Digests of the topics; frames and exposures belong together in the order in which they come."""

    def __init__(self, rospy):
        self.lock = threading.Lock()
        self.digest = Digest()
        self.frames = []
        self.exposures = []
        self.arrays = 0
        self.last_seq = -1
        self.last = time.monotonic()
        for topic, receive in (("events", self.take_events), ("image_raw", self.take_frame),
                               ("exposure", self.take_exposure)):
            rospy.Subscriber("/dvs/" + topic, rospy.AnyMsg, receive, queue_size=None)

    def take_events(self, message):
        with self.lock:
            self.last = time.monotonic()
            self.digest.add_events(*events_of(message._buff)[0])
            self.arrays += 1
            (self.last_seq,) = struct.unpack_from("<I", message._buff)

    def take_frame(self, message):
        with self.lock:
            self.last = time.monotonic()
            self.frames.append(frame_of(message._buff))
            self.pair()

    def take_exposure(self, message):
        with self.lock:
            self.exposures.append(struct.unpack("<i", message._buff)[0])
            self.pair()

    def pair(self):
        while self.frames and self.exposures:
            stamp, pixels = self.frames.pop(0)
            exposure = self.exposures.pop(0)
            self.digest.add_frame(stamp - exposure // 2, exposure, pixels)

    def wait(self, is_all):
        while not is_all() and time.monotonic() - self.last < SILENCE_S:
            time.sleep(0.01)

    def missing(self):
        return self.last_seq + 1 - self.arrays


def connect(rospy, node):
    """Waits until the node publishes to this process."""
    deadline = time.monotonic() + START_S
    topics = {"/dvs/events", "/dvs/image_raw", "/dvs/exposure"}
    while time.monotonic() < deadline and node.poll() is None:
        rows = rospy.impl.registration.get_topic_manager().get_pub_sub_info()
        if topics <= {row[4] for row in rows if row[2] == "i" and row[5]}:
            return
        time.sleep(0.1)
    raise SystemExit(f"dv_stream_node did not connect within {START_S} s")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bag")
    parser.add_argument("--rate", default="1", metavar="FACTOR", help="0: as fast as the server can")
    parser.add_argument("--tools", type=pathlib.Path, default=ROOT / "devel" / "lib" / "fast_edi")
    parser.add_argument("--python", type=pathlib.Path, default=ROOT / "build" / "peers" / "bin" / "python")
    arguments = parser.parse_args()
    expected = subprocess.run([arguments.python, FOLDER / "vendor.py", "digest", arguments.bag], check=True,
                              text=True, stdout=subprocess.PIPE).stdout.strip()
    master, events, frames = free_port(), str(free_port()), str(free_port())
    os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{master}"
    os.environ["ROS_HOSTNAME"] = "127.0.0.1"
    import rospy
    processes = []
    try:
        processes.append(subprocess.Popen(["rosmaster", "--core", "-p", str(master)], stdout=subprocess.DEVNULL))
        deadline = time.monotonic() + START_S
        while True:
            try:
                rospy.get_master().getPid()
                break
            except OSError:
                if time.monotonic() > deadline:
                    raise
                time.sleep(0.1)
        rospy.init_node("live", disable_signals=True, disable_rosout=True)
        listener = Listener(rospy)
        node = subprocess.Popen([arguments.tools / "dv_stream_node", "__ns:=dvs", "_events_port:=" + events,
                                 "_frames_port:=" + frames, "_stall_timeout_s:=60"], stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL)
        processes.append(node)
        connect(rospy, node)
        burst = [] if float(arguments.rate) else ["--burst", str(BURST)]
        server = subprocess.Popen([arguments.python, FOLDER / "vendor.py", "serve", arguments.bag, "--events", events,
                                   "--frames", frames, "--rate", arguments.rate, *burst],
                                  stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        processes.append(server)
        for line in server.stdout:
            listener.last = time.monotonic()
            if not line.startswith("burst"):
                print(line.strip())
                break
            sent = int(line.split()[1])
            listener.wait(lambda: listener.digest.events >= sent)
            server.stdin.write("go on\n")
            server.stdin.flush()
        listener.wait(lambda: str(listener.digest) == expected)
        print(listener.digest)
        if listener.missing():
            print(f"arrays missing by their header.seq: {listener.missing()}", file=sys.stderr)
        server.stdin.close()
        node.send_signal(signal.SIGINT)
        if node.wait(timeout=START_S) != 0:
            raise SystemExit(f"dv_stream_node ended with {node.returncode}")
    finally:
        for process in reversed(processes):
            if process.poll() is None:
                process.kill()
            process.wait()


if __name__ == "__main__":
    main()
