"""Another ROS 2 peer, by PyPI's cyclonedds. What it found goes to stdout as JSON; `ready` before that, once it is there.

    peer.py listen TYPE TOPIC SECONDS [COUNT]   counts messages, until that many came, and their latency [ms]; keeps the first
    peer.py node SECONDS                        nodes, and writers with their types and hashes
    peer.py image TOPIC COUNT HERTZ               sends images of 1 MB, 256 beams x 1000 ranges of float32
    peer.py odometry TOPIC COUNT HERTZ [FAULT]  sends poses along x; FAULT nan, back, zero or bytes spoils every second
"""
import dataclasses
import json
import struct
import sys
import time

import messages
from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import float64
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

DOMAIN, START = 0, time.time()
RELIABLE = [Policy.Reliability.Reliable(duration(milliseconds=100)), Policy.DataRepresentation(use_cdrv0_representation=True)]
SENSOR = Qos(*RELIABLE, Policy.Durability.Volatile, Policy.History.KeepLast(5))
DEEP = Qos(*RELIABLE, Policy.Durability.Volatile, Policy.History.KeepLast(200))
LATCHED = Qos(*RELIABLE, Policy.Durability.TransientLocal, Policy.History.KeepLast(1))


def ready():
    print("ready", flush=True)


def seconds(stamp):
    return stamp.sec + stamp.nanosec * 1e-9


def plain(value):
    """As JSON holds it, long lists by their length and first."""
    if dataclasses.is_dataclass(value):
        return {f.name: plain(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, (bytes, bytearray, list, tuple)) and len(value) > 64:
        return {"size": len(value), "first": plain(list(value[:64]))}
    if isinstance(value, (bytes, bytearray, tuple, list)):
        return [plain(one) for one in value]
    return value if value == value else None


def listen(kind, topic, span, count=10**9):
    participant = DomainParticipant(DOMAIN)
    reader = DataReader(participant, Topic(participant, "rt" + topic, getattr(messages, kind)), qos=DEEP)
    while not reader.get_matched_publications() and time.time() < START + 20:
        time.sleep(0.01)
    ready()
    latencies, first, end = [], None, time.time() + float(span)
    while time.time() < end and len(latencies) < int(count):
        for sample in reader.take(N=10):
            if not isinstance(sample, getattr(messages, kind)):
                continue  # the sender has gone
            stamp = sample.clock if kind == "Clock" else sample.header.stamp
            latencies.append(1e3 * (time.time() - seconds(stamp)))
            first = first or sample
        time.sleep(0.0005)
    latencies.sort()
    at = (lambda share: latencies[int(share * (len(latencies) - 1))]) if latencies else (lambda share: None)
    return {"count": len(latencies), "median_ms": at(0.5), "p99_ms": at(0.99), "first": plain(first)}


def node(span):
    participant = DomainParticipant(DOMAIN)
    reader = DataReader(participant, Topic(participant, "ros_discovery_info", messages.ParticipantEntitiesInfo), qos=LATCHED)
    writers = BuiltinDataReader(participant, BuiltinTopicDcpsPublication)
    ready()
    time.sleep(float(span))
    infos = [plain(info) for info in reader.take(N=100)]
    found = {}
    for writer in writers.take(N=100):
        data = [p for p in writer.qos if isinstance(p, Policy.Userdata)]
        found[writer.topic_name] = {"type": writer.type_name, "user_data": data[0].data.decode() if data else "",
                                    "key": list(writer.key.bytes)}
    return {"infos": infos, "writers": found}


def stamped_now(header):
    now = time.time()
    header.stamp = messages.Time(int(now), int(now % 1 * 1e9))


def image(topic, count, hertz):
    participant = DomainParticipant(DOMAIN)
    kind = messages.ProjectedSonarImage
    writer = DataWriter(participant, Topic(participant, "rt" + topic, kind), qos=DEEP)
    sample = kind(messages.Header(messages.Time(0, 0), "sonar"), messages.PingInfo(750e3, 1500.0, [0.3], [0.01]),
                  [messages.Vector3(0.0, 0.0, 1.0)] * 256, [0.01 * k for k in range(1000)],
                  messages.SonarImageData(False, 8, 256, bytes(1_024_000)))
    ready()
    while not writer.get_matched_subscriptions():
        time.sleep(0.01)
    time.sleep(0.5)  # the other side may not know us yet
    stamped_now(sample.header)
    wire = bytearray(sample.serialize(use_version_2=False))  # takes Python longer than a period: once, then the stamp
    sample.serialize = lambda **_: bytes(wire)
    due = time.time()
    for _ in range(int(count)):
        due += 1 / float(hertz)
        time.sleep(max(0, due - time.time()))
        now = time.time()
        struct.pack_into("<iI", wire, 4, int(now), int(now % 1 * 1e9))
        writer.write(sample)
    time.sleep(1)
    return {"count": int(count)}


@dataclasses.dataclass
class Short(IdlStruct, typename="nav_msgs::msg::dds_::Odometry_"):
    only: float64 = 1.0


def odometry(topic, count, hertz, fault=""):
    participant = DomainParticipant(DOMAIN)
    name = "rt" + topic
    writer = DataWriter(participant, Topic(participant, name, messages.Odometry), qos=SENSOR)
    other = DomainParticipant(DOMAIN)
    short = DataWriter(other, Topic(other, name, Short), qos=SENSOR) if fault == "bytes" else None
    ready()
    while not writer.get_matched_subscriptions() or (short and not short.get_matched_subscriptions()):
        time.sleep(0.01)
    time.sleep(0.5)  # the other side may not know us yet
    for i in range(int(count)):
        sample = messages.Odometry()
        now = time.time()
        spoilt = bool(fault) and i % 2 == 1
        now -= 5 if spoilt and fault == "back" else 0
        sample.header.stamp = messages.Time(int(now), int(now % 1 * 1e9))
        sample.header.frame_id, sample.child_frame_id = "map", "base_link"
        sample.pose.pose.position = messages.Point(float(i), 2.0, -3.0)
        sample.twist.twist.linear.x = 1.5
        if spoilt and fault == "nan":
            sample.pose.pose.position.x = float("nan")
        if spoilt and fault == "zero":
            sample.pose.pose.orientation.w = 0.0
        short.write(Short()) if spoilt and short else writer.write(sample)
        time.sleep(1 / float(hertz))
    time.sleep(0.5)
    return {"count": int(count)}


if __name__ == "__main__":
    DOMAIN = int(__import__("os").environ.get("ROS_DOMAIN_ID", "0"))
    print(json.dumps({"listen": listen, "node": node, "image": image, "odometry": odometry}[sys.argv[1]](*sys.argv[2:])))
