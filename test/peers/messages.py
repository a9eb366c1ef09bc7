"""Serialised messages of the driver's topics, read without ROS, and digests of what is in them."""
import hashlib
import struct

import numpy

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
