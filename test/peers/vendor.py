#!/usr/bin/env python3
"""iniVation's own library (dv-processing) writes and reads AEDAT4.

    build/peers/bin/python test/peers/vendor.py write IN.bag OUT.aedat4 [--compression LZ4|ZSTD|NONE]
                                                 [--frames N] [--window WIDTHxHEIGHT]
    build/peers/bin/python test/peers/vendor.py digest FILE
    build/peers/bin/python test/peers/vendor.py serve IN.bag --events PORT --frames PORT [--rate FACTOR] [--burst N]

`write` takes mono8 frames, their exposures and the events of a bag with the driver's topics; N frames
from the beginning, and of these the upper left window. `digest` prints what is in an AEDAT4 file (read
by the library) or in a bag: counts, and MD5 sums over (time [us], x, y, polarity) of all events and over
(exposure start, exposure end, pixels) of all frames. `serve` waits for a client on each port, then sends
the bag by the library's own server, FACTOR times as fast as recorded (0: as fast as it can), and stays until
its standard input ends. After each N packets of a burst it prints `burst` and how many events it has sent, and waits for
a line on its standard input.
"""
import argparse
import os
import pathlib
import struct
import sys
import time

import dv_processing as dv
import numpy
from rosbags.rosbag1 import Reader

from messages import Digest, events_of, frame_of

def items(path):
    """Yields ("events", columns, size) and ("frame", (start, exposure [us], pixels), size)."""
    waiting = None
    with Reader(pathlib.Path(path)) as bag:
        for connection, _, data in bag.messages():
            if connection.topic == "/dvs/events":
                yield "events", *events_of(data)
            elif connection.topic == "/dvs/image_raw":
                waiting = frame_of(data)
            elif connection.topic == "/dvs/exposure" and waiting:
                (exposure,) = struct.unpack("<i", data)
                stamp, pixels = waiting
                yield "frame", (stamp - exposure // 2, exposure, pixels), pixels.shape[::-1]
                waiting = None


def windowed(kind, item, size, window):
    if window is None:
        return item, size
    width, height = window
    if kind == "frame":
        return (item[0], item[1], item[2][:height, :width]), window
    inside = (item[1] < width) & (item[2] < height)
    return tuple(column[inside] for column in item), window


def write(arguments):
    window = tuple(map(int, arguments.window.split("x"))) if arguments.window else None
    _, first, size = next(items(arguments.bag))
    config = dv.io.MonoCameraWriter.Config("DAVIS346_00000001",
                                           getattr(dv.CompressionType, arguments.compression))
    config.addEventStream(window or size)
    config.addFrameStream(window or size)
    writer = dv.io.MonoCameraWriter(dv.Path(arguments.out), config)
    frames = 0
    for kind, item, size in items(arguments.bag):
        item, size = windowed(kind, item, size, window)
        if kind == "events":
            store = store_of(item)
            if len(store) > 0:
                writer.writeEvents(store)
        else:
            start, exposure, pixels = item
            writer.writeFrame(dv.Frame(start, exposure, 0, 0, numpy.ascontiguousarray(pixels),
                                       dv.FrameSource.SENSOR))
            frames += 1
        if frames == arguments.frames and kind == "events":
            break


def store_of(columns):
    store = dv.EventStore()
    for t, x, y, on in zip(*(column.tolist() for column in columns)):
        store.push_back(t, x, y, bool(on))
    return store


def serve(arguments):
    prepared = []
    size = None
    for kind, item, size in items(arguments.bag):
        if kind == "events":
            if len(item[0]):
                prepared.append((int(item[0][-1]), kind, store_of(item)))
        else:
            start, exposure, pixels = item
            prepared.append((start + exposure, kind, dv.Frame(start, exposure, 0, 0, numpy.ascontiguousarray(pixels),
                                                              dv.FrameSource.SENSOR)))
    camera = "DAVIS346_00000001"
    writers = {
        "events": dv.io.NetworkWriter("127.0.0.1", arguments.events, dv.io.Stream.EventStream(0, "events", camera, size)),
        "frame": dv.io.NetworkWriter("127.0.0.1", arguments.frames, dv.io.Stream.FrameStream(0, "frames", camera, size))}
    while any(writer.getClientCount() == 0 for writer in writers.values()):
        time.sleep(0.01)
    begin, first = time.monotonic(), prepared[0][0]
    events = 0
    for number, (t, kind, item) in enumerate(prepared):
        if arguments.burst and number and number % arguments.burst == 0:
            print("burst", events, flush=True)
            sys.stdin.readline()
        wait = (t - first) * 1e-6 / arguments.rate - (time.monotonic() - begin) if arguments.rate else 0
        if wait > 0:
            time.sleep(wait)
        if kind == "events":
            writers[kind].writeEvents(item)
            events += len(item)
        else:
            writers[kind].writeFrame(item)
    print(f"sent in {time.monotonic() - begin:.3f} s", flush=True)
    sys.stdin.read()
    os._exit(0)  # without the library's own end, which may wait for ever for its clients


def digest(path):
    result = Digest()
    if str(path).endswith(".bag"):
        for kind, item, _ in items(path):
            if kind == "events":
                result.add_events(*item)
            else:
                result.add_frame(*item)
        return result
    recording = dv.io.MonoCameraRecording(dv.Path(str(path)))
    while (store := recording.getNextEventBatch()) is not None:
        rows = store.numpy()
        result.add_events(rows["timestamp"], rows["x"], rows["y"], rows["polarity"])
    while (frame := recording.getNextFrame()) is not None:
        exposure = round(frame.exposure.total_seconds() * 1e6)
        result.add_frame(frame.timestamp, exposure, frame.image)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("write")
    command.add_argument("bag")
    command.add_argument("out")
    command.add_argument("--compression", default="LZ4", choices=["LZ4", "ZSTD", "NONE"])
    command.add_argument("--frames", type=int)
    command.add_argument("--window", metavar="WIDTHxHEIGHT")
    commands.add_parser("digest").add_argument("file")
    command = commands.add_parser("serve")
    command.add_argument("bag")
    command.add_argument("--events", type=int, required=True, metavar="PORT")
    command.add_argument("--frames", type=int, required=True, metavar="PORT")
    command.add_argument("--rate", type=float, default=1.0, metavar="FACTOR")
    command.add_argument("--burst", type=int, metavar="N")
    arguments = parser.parse_args()
    if arguments.command == "write":
        write(arguments)
    elif arguments.command == "serve":
        serve(arguments)
    else:
        print(digest(arguments.file))


if __name__ == "__main__":
    main()
