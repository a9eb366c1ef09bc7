#!/usr/bin/env python3
"""iniVation's own library (dv-processing) writes and reads AEDAT4.

    build/peers/bin/python test/peers/vendor.py write IN.bag OUT.aedat4 [--compression LZ4|ZSTD|NONE]
                                                 [--frames N] [--window WIDTHxHEIGHT]
    build/peers/bin/python test/peers/vendor.py digest FILE

`write` takes mono8 frames, their exposures and the events of a bag with the driver's topics; N frames
from the beginning, and of these the upper left window. `digest` prints what is in an AEDAT4 file (read
by the library) or in a bag: counts, and MD5 sums over (time [us], x, y, polarity) of all events and over
(exposure start, exposure end, pixels) of all frames.
"""
import argparse
import hashlib
import pathlib
import struct

import dv_processing as dv
import numpy
from rosbags.rosbag1 import Reader

EVENT = numpy.dtype([("x", "<u2"), ("y", "<u2"), ("s", "<u4"), ("ns", "<u4"), ("on", "u1")])


class Fields:
    """Numbers and strings of a serialised ROS message, one after the other."""

    def __init__(self, data):
        self.data = bytes(data)
        self.place = 0

    def number(self, code="I"):
        (value,) = struct.unpack_from("<" + code, self.data, self.place)
        self.place += struct.calcsize(code)
        return value

    def text(self):
        size = self.number()
        self.place += size
        return self.data[self.place - size:self.place].decode()

    def stamp_us(self):
        self.number()  # seq
        return self.number() * 1000000 + (self.number() + 500) // 1000


def events_of(data):
    """Columns t [us], x, y, polarity of an event array, and the sensor's size."""
    fields = Fields(data)
    fields.stamp_us()
    fields.text()
    height, width, count = fields.number(), fields.number(), fields.number()
    rows = numpy.frombuffer(fields.data, EVENT, count, fields.place)
    times = rows["s"].astype(numpy.int64) * 1000000 + (rows["ns"].astype(numpy.int64) + 500) // 1000
    return (times, rows["x"], rows["y"], rows["on"]), (width, height)


def frame_of(data):
    """Stamp [us] and pixels of a mono8 frame."""
    fields = Fields(data)
    stamp = fields.stamp_us()
    fields.text()
    height, width, encoding = fields.number(), fields.number(), fields.text()
    if encoding != "mono8":
        raise SystemExit(f"a frame with encoding {encoding}, expected mono8")
    fields.number("B")
    step, size = fields.number(), fields.number()
    pixels = numpy.frombuffer(fields.data, numpy.uint8, size, fields.place)
    return stamp, pixels.reshape(height, step)[:, :width]


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
            store = dv.EventStore()
            for t, x, y, on in zip(*(column.tolist() for column in item)):
                store.push_back(t, x, y, bool(on))
            if len(store) > 0:
                writer.writeEvents(store)
        else:
            start, exposure, pixels = item
            writer.writeFrame(dv.Frame(start, exposure, 0, 0, numpy.ascontiguousarray(pixels),
                                       dv.FrameSource.SENSOR))
            frames += 1
        if frames == arguments.frames and kind == "events":
            break


class Digest:
    def __init__(self):
        self.events = self.frames = 0
        self.event_hash = hashlib.md5()
        self.frame_hash = hashlib.md5()

    def add_events(self, times, x, y, on):
        rows = numpy.empty(len(times), numpy.dtype("<i8,<i2,<i2,u1"))
        for name, column in zip(rows.dtype.names, (times, x, y, on)):
            rows[name] = column
        self.events += len(rows)
        self.event_hash.update(rows.tobytes())

    def add_frame(self, start, exposure, pixels):
        self.frames += 1
        self.frame_hash.update(struct.pack("<qq", start, start + exposure))
        self.frame_hash.update(numpy.ascontiguousarray(pixels).tobytes())

    def __str__(self):
        return (f"events {self.events} {self.event_hash.hexdigest()}\n"
                f"frames {self.frames} {self.frame_hash.hexdigest()}")


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
    arguments = parser.parse_args()
    if arguments.command == "write":
        write(arguments)
    else:
        print(digest(arguments.file))


if __name__ == "__main__":
    main()
