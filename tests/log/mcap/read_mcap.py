"""Prints the contents of a file and its bag by mcap and rosbags: python3 read_mcap.py FOLDER/x.0.mcap"""

import pathlib
import struct
import sys
from dataclasses import astuple

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore

path = pathlib.Path(sys.argv[1])


def value(message):
    """A sonar image's numbers, or a pose's position."""
    if hasattr(message, "image"):
        assert message.image.dtype == 8 and not message.image.is_bigendian
        return [number for (number,) in struct.iter_unpack("<f", bytes(message.image.data))]
    position = message.pose.pose.position
    return [position.x, position.y, position.z]


with open(path, "rb") as file:
    reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
    (profile, library), summary = astuple(reader.get_header()), reader.get_summary()
    count, chunks = summary.statistics.message_count, summary.statistics.chunk_count
    print(f"profile {profile}, by {library}, {count} messages, {chunks} chunks")
    for record in reader.iter_metadata():
        print("metadata", record.name, dict(sorted(record.metadata.items())))
    decoded = list(reader.iter_decoded_messages())
    assert len(decoded) == count
    for schema, channel, message, ros in sorted(decoded, key=lambda each: (each[1].topic, each[2].log_time)):
        if channel.topic in ("/clock", "/tf", "/tf_static"):
            continue
        print(channel.topic, schema.name, message.log_time, message.publish_time, value(ros))

with AnyReader([path.parent], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as bag:
    messages = list(bag.messages())
    topics = ", ".join(sorted({connection.topic for connection, _, _ in messages}))
    with Reader(path.parent) as raw:
        assert raw.message_count == len(messages), (raw.message_count, len(messages))
    print(f"rosbags: {len(messages)} messages of {topics} in {bag.duration / 1e6} ms")
    connection, _, data = next(each for each in messages if each[0].topic == "/sonar/ping")
    first = bag.deserialize(data, connection.msgtype)
    stamp = first.header.stamp
    print(f"rosbags: {value(first)} at {stamp.sec * 10**9 + stamp.nanosec} ns")
