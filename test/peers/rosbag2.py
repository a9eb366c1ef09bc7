#!/usr/bin/env python3
"""An independent library (rosbags) writes rosbag2, the recordings of ROS 2.

    build/peers/bin/python test/peers/rosbag2.py IN.bag OUT_FOLDER [--storage sqlite3|mcap]
        [--compression none|file|message|storage] [--frames N] [--window WIDTHxHEIGHT]
        [--packets libcaer|libcaer_cmp|mono|evt3] [--big-endian] [--png]

IN.bag has the driver's topics: events, mono8 or mono16 frames and their exposures; IMU and calibration where there
are any. N frames from the beginning, and of these the upper left window. With --packets events are
written as event_camera_msgs/EventPacket, in whole microseconds except for mono; with --png frames as
sensor_msgs/CompressedImage, by Pillow. With --big-endian also the samples of mono16 are.
"""
import argparse
import io
import pathlib

import numpy
from PIL import Image
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

TOPICS = ("/dvs/events", "/dvs/image_raw", "/dvs/exposure", "/dvs/imu", "/dvs/camera_info")
PACKET = """std_msgs/Header header
uint32 height
uint32 width
uint64 seq
uint64 time_base
string encoding
bool is_bigendian
uint8[] events
"""
PACKET_TYPE = "event_camera_msgs/msg/EventPacket"
IMAGE_TYPE = "sensor_msgs/msg/Image"
PNG_TYPE = "sensor_msgs/msg/CompressedImage"


def times_ns(array):
    return numpy.array([event.ts.sec * 10**9 + event.ts.nanosec for event in array.events],
                       numpy.int64)


class Packets:
    """Event arrays as the packets of a camera's driver. Times of libcaer wrap within the recording."""

    def __init__(self, encoding):
        self.encoding = encoding
        self.sequence = 0
        self.sensor_us = None  # ROS time minus sensor time

    def libcaer(self, base_ns, t_ns, x, y, on):
        wrap = 2**31
        if self.sensor_us is None:
            self.sensor_us = int(t_ns[0]) // 1000 - (wrap - 20000)  # 20 ms before it wraps
        t_us = t_ns // 1000 - self.sensor_us
        rows = numpy.empty((len(t_us), 2), "<u4")
        rows[:, 0] = 1 | on << 1 | y << 2 | x << 17
        rows[:, 1] = t_us % wrap
        high = int(t_us[0]) // wrap * wrap if len(t_us) else 0
        return (self.sensor_us + high) * 1000, rows.tobytes()

    def libcaer_cmp(self, base_ns, t_ns, x, y, on):
        words, last = [], None
        base_us = base_ns // 1000
        i = 0
        while i < len(t_ns):
            t_us = int(t_ns[i]) // 1000 - base_us
            if t_us != last:
                words += [t_us >> 12, 0x1000 | t_us & 0xFFF]
                last = t_us
            words.append(0x2000 | int(x[i]))
            j = i + 1  # events of one column, at rising rows within eight of the first
            while (j < len(t_ns) and t_ns[j] // 1000 == t_ns[i] // 1000 and x[j] == x[i]
                   and on[j] == on[i] and y[j - 1] < y[j] < y[i] + 8):
                j += 1
            if j == i + 1:
                words.append(0x3000 | int(on[i]) << 11 | int(y[i]))
            else:
                mask = sum(1 << int(y[k] - y[i]) for k in range(i, j))
                words += [0x4000 | int(on[i]) << 11 | int(y[i]), 0x5000 | mask]
            i = j
        return base_us * 1000, numpy.array(words, "<u2").tobytes()

    def mono(self, base_ns, t_ns, x, y, on):
        word = (on.astype(numpy.uint64) << 63 | y.astype(numpy.uint64) << 48
                | x.astype(numpy.uint64) << 32 | (t_ns - base_ns).astype(numpy.uint64))
        return base_ns, word.astype("<u8").tobytes()

    def evt3(self, base_ns, t_ns, x, y, on):
        if self.sensor_us is None:
            self.sensor_us = int(t_ns[0]) // 1000 - 5000
        words, last = [], None
        for t, column, row, polarity in zip(t_ns, x, y, on):
            t_us = int(t) // 1000 - self.sensor_us
            if t_us != last:
                words += [0x8000 | (t_us >> 12 & 0xFFF), 0x6000 | t_us & 0xFFF]
                last = t_us
            words += [int(row), 0x2000 | int(polarity) << 11 | int(column)]
        return 0, numpy.array(words, "<u2").tobytes()

    def packet(self, array, types):
        t_ns = times_ns(array)
        columns = [numpy.array([getattr(event, name) for event in array.events], numpy.uint32)
                   for name in ("x", "y", "polarity")]
        base_ns = int(t_ns[0]) if len(t_ns) else 0
        time_base, data = getattr(self, self.encoding)(base_ns, t_ns, *columns)
        self.sequence += 1
        stamp = types["builtin_interfaces/msg/Time"](*divmod(base_ns, 10**9))
        return types[PACKET_TYPE](types["std_msgs/msg/Header"](stamp, "camera"), array.height,
                                  array.width, self.sequence, time_base, self.encoding, False,
                                  numpy.frombuffer(data, numpy.uint8))


def cut(message, window):
    """What lies within the upper left window."""
    if window is None:
        return
    width, height = window
    if hasattr(message, "events"):
        message.events = [event for event in message.events if event.x < width and event.y < height]
    elif hasattr(message, "encoding"):
        sample = message.step // message.width
        rows = message.data.reshape(message.height, message.step)
        message.data = numpy.ascontiguousarray(rows[:height, :width * sample]).reshape(-1)
        message.step = width * sample
    else:
        return
    message.width, message.height = width, height


def png(message, types):
    """As image_transport compresses a frame."""
    kind = "<u2" if message.encoding == "mono16" else "u1"
    pixels = numpy.frombuffer(message.data.tobytes(), kind).reshape(message.height, message.width)
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "PNG")
    return types[PNG_TYPE](message.header, f"{message.encoding}; png compressed ",
                           numpy.frombuffer(file.getvalue(), numpy.uint8))


def swap(message):
    """Samples of 16 bits in the other order."""
    if getattr(message, "encoding", "") == "mono16":
        message.data = numpy.frombuffer(message.data.tobytes(), "<u2").astype(">u2").view(numpy.uint8)
        message.is_bigendian = 1


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bag", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--storage", default="sqlite3", choices=["sqlite3", "mcap"])
    parser.add_argument("--compression", default="none",
                        choices=["none", "file", "message", "storage"])
    parser.add_argument("--frames", type=int)
    parser.add_argument("--window", metavar="WIDTHxHEIGHT")
    parser.add_argument("--packets", choices=["libcaer", "libcaer_cmp", "mono", "evt3"])
    parser.add_argument("--big-endian", action="store_true")
    parser.add_argument("--png", action="store_true")
    arguments = parser.parse_args()
    window = tuple(map(int, arguments.window.split("x"))) if arguments.window else None
    types = get_typestore(Stores.ROS2_HUMBLE)
    types.register(get_types_from_msg(PACKET, PACKET_TYPE))
    packets = Packets(arguments.packets)
    storage = StoragePlugin.MCAP if arguments.storage == "mcap" else StoragePlugin.SQLITE3
    writer = Writer(arguments.out, version=9, storage_plugin=storage)
    if arguments.compression != "none":
        writer.set_compression(CompressionMode[arguments.compression.upper()], CompressionFormat.ZSTD)
    frames = 0
    with AnyReader([arguments.bag]) as reader, writer:
        types.register({name: fields for name, fields in reader.typestore.fielddefs.items()
                        if name not in types.fielddefs})
        connections = {}
        for connection in reader.connections:
            if connection.topic in TOPICS:
                topic, kind = connection.topic, connection.msgtype
                if topic == "/dvs/events" and arguments.packets:
                    kind = PACKET_TYPE
                elif kind == IMAGE_TYPE and arguments.png:
                    topic, kind = f"{topic}/compressed", PNG_TYPE
                connections[connection.id] = writer.add_connection(topic, kind, typestore=types)
        for connection, stamp, raw in reader.messages():
            if connection.id not in connections:
                continue
            # Types of ROS 1 have a sequence number in their headers.
            raw = types.ros1_to_cdr(raw, connection.msgtype)
            kind = connection.msgtype
            frames += kind == IMAGE_TYPE
            if window or arguments.packets or arguments.big_endian or arguments.png:
                message = types.deserialize_cdr(raw, kind)
                cut(message, window)
                if arguments.packets and kind.endswith("EventArray"):
                    message, kind = packets.packet(message, types.types), PACKET_TYPE
                elif arguments.png and kind == IMAGE_TYPE:
                    message, kind = png(message, types.types), PNG_TYPE
                elif arguments.big_endian:
                    swap(message)
                raw = types.serialize_cdr(message, kind, little_endian=not arguments.big_endian)
            writer.write(connections[connection.id], stamp, raw)
            if frames == arguments.frames and connection.topic == "/dvs/events":
                break


if __name__ == "__main__":
    main()
