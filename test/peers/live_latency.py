#!/usr/bin/env python3
"""How long iniVation's server, dv_stream.launch and the deblurring take from the send to publish().

    . devel/setup.bash && /usr/bin/python3 test/peers/live_latency.py [latency] [cuts] [--seconds S] [--python PYTHON]
                                                                      [--server vendor|file]

`latency` simulates a recording of 13 million events a second (346x260, 30 frames a second, exposures of 10 ms),
lets the vendor's server send it at its own speed in calls of 10 ms of events, and measures

- from each call until the vendor's own client has the last of its events: what server and network take;
- from each call until a subscriber in another process has the array with the last of its events, which is later than
  publish(), while nothing is deblurred;
- from the call that sends the last of what a frame needs, that is the frame itself and the events up to the end of
  its exposure, until the deblurred frame has arrived at a subscriber in another process, which is later than
  publish().

`cuts` sends a quieter recording of 20 s through a relay that ends both connections ten times, wherever in a packet
they are just then, and measures how long after a cut a deblurred frame comes again.

With `--server file`, paced_file_server.py sends instead, which has nothing to compute: what is left is the network,
the package and the subscriber.

Exit code 1: something was lost, p99 of arrays or of deblurred frames is not below 12 ms, a cut was not counted, or frames
did not come again within 1 s. Needs the target array_arrivals, which test/run builds, and but for `--server file`
test/peers/run once, for the vendor's library.
"""
import argparse
import json
import os
import pathlib
import selectors
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import xmlrpc.client

FOLDER = pathlib.Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
sys.path.insert(0, str(ROOT / "test" / "faults"))
from processes import Failure, Process, find_program, free_port, wait_until  # noqa: E402 (needs the path)

MOST_P99_MS = 12.0
MOST_GAP_S = 1.0
HALF_EXPOSURE_US = 5000
CUTS = 10
START_TIMEOUT_S = 60
SETTLE_TIMEOUT_S = 20
TIMEOUT_S = 600
RECORDING = ("--texture", "mosaic", "--motion", "shake", "--seed", "5", "--period-us", "33000", "--exposure-us", "10000",
             "--no-ground-truth")
BUSY_SCALE, QUIET_SCALE = "0.58", "0.05"
CUT_SECONDS = 20.0


def simulate(folder, seconds, scale):
    bag, out = folder / "source.bag", folder / "source.aedat4"
    for words in (("simulate_davis", "--out", bag, "--force", "--frames", round(seconds * 1e6 / 33000),
                   "--motion-scale", scale, *RECORDING),
                  ("convert_recording", bag, out, "--force", "--compression", "none")):
        subprocess.run([find_program("fast_edi", words[0]), *map(str, words[1:])], check=True, timeout=TIMEOUT_S,
                       stdout=subprocess.DEVNULL)
    bag.unlink()
    return out


class Server:
    """A server in a process of its own."""

    def __init__(self, command, recording):
        self.ports = {"events": free_port(), "frames": free_port()}
        self.child = subprocess.Popen(
            [str(word) for word in (*command, recording, "--events", self.ports["events"], "--frames",
                                    self.ports["frames"])],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def begin(self):
        self.child.stdin.write("\n")
        self.child.stdin.flush()

    def sent(self):
        """What was sent when, once it has been."""
        return json.loads(self.child.stdout.readline())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.child.kill()
        self.child.wait()


class Relay:
    """Passes on what a server sends, and ends the connections when it is told to."""

    def __init__(self, port):
        self.server_port = port
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.pairs = []
        self.lock = threading.Lock()
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            client, _ = self.listener.accept()
            try:
                server = socket.create_connection(("127.0.0.1", self.server_port))
            except ConnectionRefusedError:  # it reads its recording first; the client will try again
                client.close()
                continue
            with self.lock:
                self.pairs.append((client, server))
            threading.Thread(target=self.relay, args=(client, server), daemon=True).start()

    @staticmethod
    def relay(client, server):
        with selectors.DefaultSelector() as selector:
            for one, other in ((client, server), (server, client)):
                selector.register(one, selectors.EVENT_READ, other)
            try:
                while True:
                    for key, _ in selector.select():
                        data = key.fileobj.recv(65536)
                        if not data:
                            return
                        key.data.sendall(data)
            except OSError:
                pass  # cut
            finally:
                client.close()
                server.close()

    def cut(self):
        with self.lock:
            pairs, self.pairs = self.pairs, []
        for pair in pairs:
            for end in pair:
                try:
                    end.shutdown(socket.SHUT_RDWR)
                except OSError:
                    pass  # it has ended itself


class Arrivals:
    """When messages of one topic arrived, each with what `describe` makes of it."""

    def __init__(self, topic, describe):
        import rospy
        self.topic = topic
        self.found = []
        self.subscriber = rospy.Subscriber(topic, rospy.AnyMsg, lambda message: self.found.append(
            (time.monotonic(), describe(message._buff))), queue_size=None, buff_size=2**24, tcp_nodelay=True)

    def wait_for_publisher(self):
        wait_until(lambda: self.subscriber.get_num_connections() > 0, START_TIMEOUT_S, f"a publisher of {self.topic}")


class Diagnostics:
    """The last values of each node."""

    def __init__(self):
        import rospy
        from diagnostic_msgs.msg import DiagnosticArray
        self.values = {}
        self.subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, self.receive)

    def receive(self, message):
        for status in message.status:
            node = status.name.split(":")[0]
            self.values.setdefault(node, {}).update({value.key: value.value for value in status.values})

    def value(self, node, key):
        return self.values.get(node, {}).get(key)

    def wait_for(self, node, key, expected):
        """Until a value is what was expected; says what all values of the nodes are if it does not become that."""
        try:
            wait_until(lambda: self.value(node, key) == expected, SETTLE_TIMEOUT_S, f"{node}: {key} {expected}")
        except Failure as failure:
            raise Failure(f"{failure}; what the nodes said last: {json.dumps(self.values, indent=1)}") from failure


def published_by_manager():
    """Topics that the nodelets publish to anyone just now."""
    import rosgraph
    try:
        manager = xmlrpc.client.ServerProxy(rosgraph.Master("/live_latency").lookupNode("/dvs/nodelet_manager"))
    except rosgraph.MasterError:
        return set()  # not there yet
    return {row[4] for row in manager.getBusInfo("/live_latency")[2] if row[2] == "o" and row[5]}


def wait_for_deblurring(arrivals):
    """Until the nodelet has seen its subscriber, and gets events and frames itself."""
    arrivals.wait_for_publisher()
    wait_until(lambda: {"/dvs/events", "/dvs/image_raw"} <= published_by_manager(), START_TIMEOUT_S,
               "the deblurring to get events and frames")


def stamp_us(buffer):
    _, seconds, nanoseconds = struct.unpack_from("<III", buffer, 0)
    return seconds * 1000000 + (nanoseconds + 500) // 1000


def percentile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def row(what, values):
    ms = [value * 1e3 for value in values]
    print(f"| {what} | {len(ms)} | {percentile(ms, 0.5):.2f} | {percentile(ms, 0.99):.2f} | {max(ms):.2f} |", flush=True)
    return percentile(ms, 0.99)


def config_with(folder, parameters):
    """The package's configuration with other values."""
    import yaml
    values = yaml.safe_load((ROOT / "cfg" / "davis346.yaml").read_text())
    values.update({name: yaml.safe_load(value) for name, value in parameters})
    path = folder / "config.yaml"
    path.write_text(yaml.safe_dump(values))
    return path


def run_on(processors):
    return ("taskset", "-c", ",".join(map(str, sorted(processors))))


def vendors_client(python, server_command, recording):
    """Prints the row of the vendor's own client."""
    with Server(server_command, recording) as server:
        with subprocess.Popen([python, FOLDER / "paced_client.py", "--events", str(server.ports["events"]), "--frames",
                               str(server.ports["frames"])], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              text=True) as client:
            if client.stdout.readline().strip() != "connected":
                raise SystemExit("the vendor's client did not connect")
            server.begin()
            sent = server.sent()
            # What has been sent is under way for less than a second.
            time.sleep(1.0)
            client.stdin.close()
            found = json.loads(client.stdout.readline())
    events = sum(count for _, count, _ in sent["events"])
    duration = sent["events"][-1][2] - sent["events"][0][2]
    print(f"{events} events in {duration:.2f} s: {events / duration / 1e6:.1f} Mev/s\n")
    print("| from the send to arrival [ms] | number | p50 | p99 | worst |\n|---|---:|---:|---:|---:|")
    arrived = iter(found)
    last, when = next(arrived)
    latencies = []
    for t, _, now in sent["events"]:
        while last < t:
            last, when = next(arrived)
        latencies.append(when - now)
    calls = [now for _, _, now in sent["events"]]
    row("(from one call of the server to the next)", [after - before for before, after in zip(calls, calls[1:])])
    row("events, the vendor's client", latencies)


def launch_words(server):
    return ("roslaunch", "fast_edi", "dv_stream.launch", f"events_port:={server.ports['events']}",
            f"frames_port:={server.ports['frames']}", "stall_timeout_s:=60")


def array_latency(server_command, recording, node_processors, log):
    """Of arrays, while nobody asks for deblurred frames."""
    with Server(server_command, recording) as server, \
            Process([*run_on(node_processors), *launch_words(server)], log):
        receiver = subprocess.Popen([find_program("fast_edi", "array_arrivals"), "/dvs/events"],
                                    stdout=subprocess.PIPE, text=True)
        try:
            wait_until(lambda: "/dvs/events" in published_by_manager(), START_TIMEOUT_S, "a subscriber of /dvs/events")
            server.begin()
            sent = server.sent()
            # What has been sent is under way for less than a second.
            time.sleep(1.0)
        finally:
            receiver.send_signal(signal.SIGINT)
            lines = receiver.communicate()[0].splitlines()
    latencies = []
    arrived = iter([float(word) for word in line.split()] for line in lines)
    when, last = next(arrived)
    for t, _, now in sent["events"]:
        while last < t:
            when, last = next(arrived)
        latencies.append(when - now)
    p99 = row("arrays of events", latencies)
    return [f"p99 of arrays {p99:.2f} ms, expected below {MOST_P99_MS:.0f} ms"] if p99 >= MOST_P99_MS else []


def latency(server_command, recording, config, node_processors, log):
    faults = []
    with Server(server_command, recording) as server:
        arrivals, diagnostics = Arrivals("/dvs/deblurred/image_raw", stamp_us), Diagnostics()
        with Process([*run_on(node_processors), *launch_words(server), f"config:={config}"], log):
            wait_for_deblurring(arrivals)
            server.begin()
            sent = server.sent()
            events = sum(count for _, count, _ in sent["events"])
            diagnostics.wait_for("dvs/deblur", "Events in", str(events))
            wait_until(lambda: len(arrivals.found) >= len(sent["frames"]), SETTLE_TIMEOUT_S,
                       f"{len(sent['frames'])} frames")
        arrivals.subscriber.unregister()
    deblurred = diagnostics.value("dvs/deblur", "Frames deblurred")
    latencies = []
    for arrived, stamp in arrivals.found:
        end = stamp + HALF_EXPOSURE_US
        # The last frame may end behind the last event.
        packet = next((now for t, _, now in sent["events"] if t >= end), None)
        frame = next((now for t, now in sent["frames"] if abs(t - end) <= 1), None)
        if packet is not None and frame is not None:
            latencies.append(arrived - max(packet, frame))
    p99 = row("deblurred frames", latencies)
    print(f"\n{deblurred} of {len(sent['frames'])} frames deblurred, all events taken in")
    if p99 >= MOST_P99_MS:
        faults.append(f"p99 of deblurred frames {p99:.2f} ms, expected below {MOST_P99_MS:.0f} ms")
    return faults


def cuts(server_command, recording, log):
    faults, gaps = [], []
    with Server(server_command, recording) as server:
        relays = {kind: Relay(port) for kind, port in server.ports.items()}
        arrivals, diagnostics = Arrivals("/dvs/deblurred/image_raw", stamp_us), Diagnostics()
        with Process(["roslaunch", "fast_edi", "dv_stream.launch", f"events_port:={relays['events'].port}",
                      f"frames_port:={relays['frames'].port}"], log):
            wait_for_deblurring(arrivals)
            server.begin()
            wait_until(lambda: len(arrivals.found) > 10, START_TIMEOUT_S, "deblurred frames")
            for _ in range(CUTS):
                before = len(arrivals.found)
                begin = time.monotonic()
                for relay in relays.values():
                    relay.cut()
                # The first frame that was sent after the cut: its exposure ended after those before it.
                wait_until(lambda: len(arrivals.found) > before + 1, SETTLE_TIMEOUT_S, "frames after a cut")
                gaps.append(arrivals.found[before + 1][0] - begin)
                # Frames come regularly again.
                wait_until(lambda: len(arrivals.found) > before + 10, SETTLE_TIMEOUT_S, "ten frames after a cut")
            for kind in relays:
                diagnostics.wait_for("dvs/dv_stream", f"{kind}: cuts", str(CUTS))
    row(f"second frame after each of {CUTS} cuts of both connections", gaps)
    if max(gaps) > MOST_GAP_S:
        faults.append(f"frames came again after {max(gaps):.2f} s, expected {MOST_GAP_S:.0f} s")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", metavar="latency|cuts|PARAMETER:=VALUE",
                        help="what to measure, both by default; parameters of the deblurring")
    parser.add_argument("--pin", action="store_true",
                        help="the nodelets have one processor alone")
    parser.add_argument("--seconds", type=float, default=8.0, help="length of the busy recording (8)")
    parser.add_argument("--server", choices=("vendor", "file"), default="vendor")
    parser.add_argument("--python", type=pathlib.Path, default=ROOT / "build" / "peers" / "bin" / "python")
    arguments = parser.parse_args()
    parameters = [word.split(":=", 1) for word in arguments.words if ":=" in word]
    parts = [word for word in arguments.words if ":=" not in word] or ["latency", "cuts"]
    if not set(parts) <= {"latency", "cuts"}:
        parser.error("expected latency, cuts or both")
    server_command = ((arguments.python, FOLDER / "paced_server.py") if arguments.server == "vendor" else
                      (sys.executable, FOLDER / "paced_file_server.py"))
    processors = sorted(os.sched_getaffinity(0))
    node_processors = {processors[0]} if arguments.pin else set(processors)
    os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{free_port()}"
    os.environ["ROS_HOSTNAME"] = "127.0.0.1"
    import rosgraph
    import rospy
    faults = []
    with tempfile.TemporaryDirectory(dir="/dev/shm") as path, open(os.path.join(path, "log"), "w") as log:
        folder = pathlib.Path(path)
        try:
            with Process(["rosmaster", "--core", "-p", os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1]], log):
                wait_until(rosgraph.is_master_online, START_TIMEOUT_S, "the ROS master")
                rospy.init_node("live_latency", disable_signals=True, disable_rosout=True)
                if "latency" in parts:
                    recording = simulate(folder, arguments.seconds, BUSY_SCALE)
                    if arguments.server == "vendor":
                        vendors_client(arguments.python, server_command, recording)
                    faults += array_latency(server_command, recording, node_processors, log)
                    faults += latency(server_command, recording, config_with(folder, parameters), node_processors, log)
                if "cuts" in parts:
                    recording = simulate(folder, CUT_SECONDS, QUIET_SCALE)
                    faults += cuts(server_command, recording, log)
        except Exception:
            log.flush()
            print((folder / "log").read_text()[-3000:], file=sys.stderr)
            raise
    print("\n".join(faults) or "nothing lost")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
