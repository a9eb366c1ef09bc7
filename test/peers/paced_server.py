#!/usr/bin/env python3
"""iniVation's own server (NetworkWriter) sends an AEDAT4 file at its recorded speed, and tells when.

    build/peers/bin/python test/peers/paced_server.py IN.aedat4 --events PORT --frames PORT
                                                      [--packet-ms 10]

Events go out in packets of the given length when their last event is due, frames when their exposure ends.
Waits for a client on each port and for a line on its standard input, sends, prints one JSON object, and stays until its standard input ends:
"events": [last event's time [us], number of events, time of the call] of each packet; "frames": [end of the
exposure [us], time of the call]. Times of calls are those of the clock that Python calls monotonic [s], which
all processes of one machine share, taken before the call.
"""
import argparse
import datetime
import json
import os
import sys
import time

import dv_processing as dv


def packets_of(recording, length_us):
    """Event stores of at most that length, in order."""
    packets = []
    slicer = dv.EventStreamSlicer()
    slicer.doEveryTimeInterval(datetime.timedelta(microseconds=length_us), packets.append)
    last = None
    total = 0
    while (store := recording.getNextEventBatch()) is not None:
        slicer.accept(store)
        total += len(store)
        last = store
    # What the slicer still waits for the end of.
    handed_out = sum(len(packet) for packet in packets)
    if last is not None and handed_out < total:
        packets.append(last.sliceBack(total - handed_out) if total - handed_out <= len(last) else last)
    return [packet for packet in packets if len(packet) > 0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording")
    parser.add_argument("--events", type=int, required=True, metavar="PORT")
    parser.add_argument("--frames", type=int, required=True, metavar="PORT")
    parser.add_argument("--packet-ms", type=float, default=10.0, metavar="MS")
    arguments = parser.parse_args()

    recording = dv.io.MonoCameraRecording(dv.Path(arguments.recording))
    size, camera = recording.getEventResolution(), recording.getCameraName()
    due = [(packet.getHighestTime(), "events", packet)
           for packet in packets_of(recording, round(arguments.packet_ms * 1e3))]
    while (frame := recording.getNextFrame()) is not None:
        due.append((frame.timestamp + round(frame.exposure.total_seconds() * 1e6), "frames", frame))
    due.sort(key=lambda item: item[0])

    events = dv.io.NetworkWriter("127.0.0.1", arguments.events, dv.io.Stream.EventStream(0, "events", camera, size))
    frames = dv.io.NetworkWriter("127.0.0.1", arguments.frames, dv.io.Stream.FrameStream(0, "frames", camera, size))
    while events.getClientCount() == 0 or frames.getClientCount() == 0:
        time.sleep(0.01)
    sys.stdin.readline()
    sent = {"events": [], "frames": []}
    first, begin = due[0][0], time.monotonic()
    for t, kind, item in due:
        wait = (t - first) * 1e-6 - (time.monotonic() - begin)
        if wait > 0:
            time.sleep(wait)
        now = time.monotonic()
        if kind == "events":
            events.writeEvents(item)
            sent[kind].append([t, len(item), now])
        else:
            frames.writeFrame(item)
            sent[kind].append([t, now])
    print(json.dumps(sent), flush=True)
    sys.stdin.read()
    os._exit(0)  # without the library's own end, which may wait for ever for its clients


if __name__ == "__main__":
    main()
