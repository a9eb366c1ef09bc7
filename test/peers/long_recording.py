#!/usr/bin/env python3
"""A bag over and over, each copy behind the one before: a long recording without the time to simulate one.

    build/peers/bin/python test/peers/long_recording.py IN.bag OUT.bag --copies N

Takes the driver's topics (events, image_raw, exposure). Stamps of copy k are later by k times the length of the bag,
rounded up to whole seconds.
"""
import argparse
import pathlib
import struct

import numpy
from rosbags.rosbag1 import Reader, Writer

from messages import EVENT, Fields

TOPICS = ("/dvs/events", "/dvs/image_raw", "/dvs/exposure")
NANOSECONDS = 10**9


def later(topic, data, seconds):
    """The serialised message with later stamps."""
    data = bytearray(data)
    if topic == "/dvs/exposure":
        return data
    (stamp,) = struct.unpack_from("<I", data, 4)
    struct.pack_into("<I", data, 4, stamp + seconds)
    if topic == "/dvs/events":
        fields = Fields(data)
        fields.stamp_us()
        fields.text()
        _, _, count = fields.number(), fields.number(), fields.number()
        numpy.frombuffer(data, EVENT, count, fields.place)["s"] += seconds
    return data


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bag")
    parser.add_argument("out")
    parser.add_argument("--copies", type=int, required=True, metavar="N")
    arguments = parser.parse_args()
    with Reader(pathlib.Path(arguments.bag)) as reader, Writer(pathlib.Path(arguments.out)) as writer:
        seconds = -(-reader.duration // NANOSECONDS)
        connections = {connection.topic: writer.add_connection(
            connection.topic, connection.msgtype, msgdef=connection.msgdef.data, md5sum=connection.digest)
            for connection in reader.connections if connection.topic in TOPICS}
        for copy in range(arguments.copies):
            for connection, time, data in reader.messages():
                if connection.topic in connections:
                    writer.write(connections[connection.topic], time + copy * seconds * NANOSECONDS,
                                 bytes(later(connection.topic, data, copy * seconds)))


if __name__ == "__main__":
    main()
