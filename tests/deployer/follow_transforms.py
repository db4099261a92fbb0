"""Follows the transforms of a bag from its pings to the world: python3 follow_transforms.py FOLDER/x.0.mcap

Prints a JSON object: the time, chain of frames and place of the frame (origin [m], axes by column) of each ping;
the topics with their counts; the times of the clock. Transforms are interpolated as in tf2."""

import json
import pathlib
import sys

import numpy
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

path = pathlib.Path(sys.argv[1])


def nanoseconds(stamp):
    return stamp.sec * 10**9 + stamp.nanosec


def vector(v):
    return numpy.array([v.x, v.y, v.z])


def matrix(q):
    x, y, z, w = q / numpy.linalg.norm(q)
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


class Tree:
    def __init__(self):
        self.parents, self.fixed, self.moving = {}, {}, {}

    def add(self, transform, is_static):
        child, parent = transform.child_frame_id, transform.header.frame_id
        assert self.parents.setdefault(child, parent) == parent, f"{child} has two parents"
        q = transform.transform.rotation
        assert abs(q.x**2 + q.y**2 + q.z**2 + q.w**2 - 1) < 1e-9, f"{child} is not turned by a unit quaternion"
        placed = vector(transform.transform.translation), numpy.array([q.x, q.y, q.z, q.w])
        if is_static:
            self.fixed[child] = placed
        else:
            times = self.moving.setdefault(child, {})
            assert nanoseconds(transform.header.stamp) not in times, f"{child} has two transforms of one time"
            times[nanoseconds(transform.header.stamp)] = placed

    def at(self, child, time):
        if child in self.fixed:
            return self.fixed[child]
        times = sorted(self.moving[child])
        after = next(each for each in times if each >= time)
        before = max(each for each in times if each <= time)
        (p, q), (r, s) = self.moving[child][before], self.moving[child][after]
        share = (time - before) / (after - before) if after > before else 0
        return p + share * (r - p), q + share * (s * numpy.sign(q @ s) - q)

    def follow(self, frame, time):
        chain, position, turn = [frame], numpy.zeros(3), numpy.eye(3)
        while chain[-1] in self.parents:
            p, q = self.at(chain[-1], time)
            position, turn = p + matrix(q) @ position, matrix(q) @ turn
            chain.append(self.parents[chain[-1]])
        return {"time": time, "chain": chain, "position": position.tolist(), "axes": turn.T.tolist()}


tree, frames, clock, topics = Tree(), [], [], {}
with open(path, "rb") as file:
    reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
    for schema, channel, message, ros in reader.iter_decoded_messages():
        topics[channel.topic] = topics.get(channel.topic, 0) + 1
        if channel.topic in ("/tf", "/tf_static"):
            for transform in ros.transforms:
                tree.add(transform, channel.topic == "/tf_static")
        elif channel.topic == "/clock":
            clock.append(nanoseconds(ros.clock))
        elif schema.name.endswith("ProjectedSonarImage"):
            frames.append((channel.topic, ros.header.frame_id, nanoseconds(ros.header.stamp)))

with AnyReader([path.parent], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as bag:
    counts = {each.topic: each.msgcount for each in bag.connections}
    profiles = {each.topic: str(each.ext.offered_qos_profiles) for each in bag.connections}
    for connection, _, data in bag.messages():
        bag.deserialize(data, connection.msgtype)
assert counts == topics, (counts, topics)
assert "/tf_static" not in profiles or "TRANSIENT_LOCAL" in profiles["/tf_static"], profiles["/tf_static"]

pings = [{"topic": topic} | tree.follow(frame, time) for topic, frame, time in frames]
print(json.dumps({"pings": pings, "clock": clock, "topics": topics}))
