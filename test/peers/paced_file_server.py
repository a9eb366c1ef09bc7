#!/usr/bin/env python3
"""Sends the packets of an AEDAT4 file as they are, at the recorded speed, and tells when.

    /usr/bin/python3 test/peers/paced_file_server.py IN.aedat4 --events PORT --frames PORT [--packet-ms 10]

In place of paced_server.py, with the same output: what DV's protocol sends is what the file holds, so that nothing is
packed or compressed here, and the times of the sends are those of the socket's. The file must not be compressed. All
packets of events that end within the same --packet-ms go out together when the last of them ends, frames when their
exposure ends.
"""
import argparse
import json
import pathlib
import socket
import struct
import sys
import time

MAGIC = b"#!AER-DAT4.0\r\n"
EVENT_BYTES = 16
# Fields of the flatbuffers.
TABLE_PLACE = 1
ELEMENTS = 0
END_OF_EXPOSURE = 4


class Table:
    """The root table of a flatbuffer that begins with its size."""

    def __init__(self, data):
        self.data = data
        self.kind = data[8:12]
        self.place = 4 + struct.unpack_from("<I", data, 4)[0]
        self.fields = self.place - struct.unpack_from("<i", data, self.place)[0]

    def place_of(self, field):
        return self.place + struct.unpack_from("<H", self.data, self.fields + 4 + 2 * field)[0]

    def long(self, field):
        return struct.unpack_from("<q", self.data, self.place_of(field))[0]

    def vector(self, field):
        """Place of the first element, and how many there are."""
        place = self.place_of(field)
        place += struct.unpack_from("<I", self.data, place)[0]
        return place + 4, struct.unpack_from("<I", self.data, place)[0]


def packets_of(data, begin, end):
    """Each packet with its header."""
    while begin < end:
        size = struct.unpack_from("<i", data, begin + 4)[0]
        yield data[begin:begin + 8 + size]
        begin += 8 + size


def sends_of(packets, length_us):
    """(due [us], kind, last event or end of exposure [us], number of events, bytes) in the order of time."""
    found, groups = [], {}
    for packet in packets:
        table = Table(packet[8:])
        if table.kind == b"EVTS":
            place, count = table.vector(ELEMENTS)
            last = struct.unpack_from("<q", table.data, place + (count - 1) * EVENT_BYTES)[0]
            groups.setdefault(last // length_us, []).append((last, count, packet))
        elif table.kind == b"FRME":
            end = table.long(END_OF_EXPOSURE)
            found.append((end, "frames", end, 0, packet))
    for group in groups.values():
        last = group[-1][0]
        found.append((last, "events", last, sum(count for _, count, _ in group), b"".join(packet for *_, packet in group)))
    return sorted(found, key=lambda send: send[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("--events", type=int, required=True, metavar="PORT")
    parser.add_argument("--frames", type=int, required=True, metavar="PORT")
    parser.add_argument("--packet-ms", type=float, default=10.0, metavar="MS")
    arguments = parser.parse_args()

    data = arguments.recording.read_bytes()
    if not data.startswith(MAGIC):
        parser.error(f"{arguments.recording} is no AEDAT4")
    first = len(MAGIC) + 4 + struct.unpack_from("<I", data, len(MAGIC))[0]
    header = data[len(MAGIC):first]
    end = Table(header).long(TABLE_PLACE)
    sends = sends_of(packets_of(data, first, end if end > 0 else len(data)), round(arguments.packet_ms * 1e3))
    listeners = {kind: socket.create_server(("127.0.0.1", getattr(arguments, kind))) for kind in ("events", "frames")}
    clients = {}
    for kind, listener in listeners.items():
        clients[kind] = listener.accept()[0]
        clients[kind].setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        clients[kind].sendall(header)
    sys.stdin.readline()
    sent = {"events": [], "frames": []}
    first_us, begin = sends[0][0], time.monotonic()
    for due_us, kind, t_us, count, packets in sends:
        wait = (due_us - first_us) * 1e-6 - (time.monotonic() - begin)
        if wait > 0:
            time.sleep(wait)
        now = time.monotonic()
        clients[kind].sendall(packets)
        sent[kind].append([t_us, count, now] if kind == "events" else [t_us, now])
    print(json.dumps(sent), flush=True)
    sys.stdin.read()


if __name__ == "__main__":
    main()
