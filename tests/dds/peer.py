"""Another ROS 2 peer, by PyPI's cyclonedds. Prints `ready` once it has joined, then its findings as JSON.

    peer.py listen TYPE TOPIC SECONDS [COUNT]   counts COUNT messages and their latency [ms]; keeps the first
    peer.py node SECONDS WRITERS                prints nodes, and writers with types and hashes, once a node has WRITERS
    peer.py image TOPIC COUNT HERTZ             sends images of 1 MB, 256 beams x 1000 ranges of float32
    peer.py transforms SPEED [ODOM]             sends transforms of base_link without end; ODOM 0 omits a link
    peer.py parameters NODE NAME VALUE          calls the parameter services of a node, sets a double
    peer.py odometry TOPIC COUNT HERTZ [FLAW]  sends poses along x; FLAW nan, back, zero or bytes spoils every second

A listener prints `met` at the first image without a stamp, and does not count these. With --greet, a sender sends such
images, or poses at the origin, until SIGUSR1: no later message is lost to an unfinished discovery.
"""
import dataclasses
import json
import math
import signal
import struct
import sys
import time
import types

import messages
from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, int64, sequence, uint8, uint64
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

DOMAIN, START, BEGUN = 0, time.time(), []
signal.signal(signal.SIGUSR1, lambda *_: BEGUN.append(True))
RELIABLE = [Policy.Reliability.Reliable(duration(seconds=60)), Policy.DataRepresentation(use_cdrv0_representation=True)]
DEEP = Qos(*RELIABLE, Policy.Durability.Volatile, Policy.History.KeepLast(200))
LATCHED = Qos(*RELIABLE, Policy.Durability.TransientLocal, Policy.History.KeepLast(1))


def ready():
    print("ready", flush=True)


def seconds(stamp):
    return stamp.sec + stamp.nanosec * 1e-9


def greet(writer, sample):
    """Waits for a reader, then until it has received a message, or for its discovery of this writer."""
    while not writer.get_matched_subscriptions():
        time.sleep(0.01)
    if "--greet" not in sys.argv:
        time.sleep(0.5)
    while "--greet" in sys.argv and not BEGUN:
        writer.write(sample)
        time.sleep(0.02)


def plain(value):
    """Returns a value for JSON; long lists by their length and first item."""
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
    while not reader.get_matched_publications() and time.time() < START + 60:
        time.sleep(0.01)
    ready()
    latencies, first, met, end = [], None, False, time.time() + float(span)
    while time.time() < end and len(latencies) < int(count):
        for sample in reader.take(N=10):
            if not isinstance(sample, getattr(messages, kind)):
                continue  # the sender has gone
            stamp = sample.clock if kind == "Clock" else sample.header.stamp
            if seconds(stamp) > 0:
                latencies.append(1e3 * (time.time() - seconds(stamp)))
                first = first or sample
            elif not met:
                met = True
                print("met", flush=True)
        time.sleep(0.0005)
    latencies.sort()
    at = (lambda share: latencies[int(share * (len(latencies) - 1))]) if latencies else (lambda share: None)
    return {"count": len(latencies), "median_ms": at(0.5), "p99_ms": at(0.99), "first": plain(first)}


def writers_of(info):
    """Returns the keys of a node's writers from its announcement."""
    return [gid["data"] for node in info["node_entities_info_seq"] for gid in node["writer_gid_seq"]]


def node(span, count):
    participant = DomainParticipant(DOMAIN)
    reader = DataReader(participant, Topic(participant, "ros_discovery_info", messages.ParticipantEntitiesInfo), qos=LATCHED)
    writers = BuiltinDataReader(participant, BuiltinTopicDcpsPublication)
    ready()
    infos, found, end = [], {}, time.time() + float(span)

    def complete():
        keys = [writer["key"] for writer in found.values()]
        return any(len(writers_of(info)) == int(count) and all(key in keys for key in writers_of(info)) for info in infos)

    while time.time() < end and not complete():
        infos += [plain(info) for info in reader.take(N=100) if isinstance(info, messages.ParticipantEntitiesInfo)]
        for writer in writers.take(N=100):
            data = [p for p in writer.qos if isinstance(p, Policy.Userdata)]
            found[writer.topic_name] = {"type": writer.type_name, "user_data": data[0].data.decode() if data else "",
                                        "key": list(writer.key.bytes)}
        time.sleep(0.01)
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
    greet(writer, sample)
    stamped_now(sample.header)
    wire = bytearray(sample.serialize(use_version_2=False))  # serialising takes longer than a period: once, then only the stamp
    sample.serialize = lambda **_: bytes(wire)
    due = time.time()
    for _ in range(int(count)):
        due += 1 / float(hertz)
        time.sleep(max(0, due - time.time()))
        now = time.time()
        struct.pack_into("<iI", wire, 4, int(now), int(now % 1 * 1e9))
        writer.write(sample)
    writer.wait_for_acks(duration(seconds=60))
    return {"count": int(count)}


def pose_at(now, *place):
    sample = messages.Odometry()
    sample.header.stamp = messages.Time(int(now), int(now % 1 * 1e9))
    sample.header.frame_id, sample.child_frame_id = "map", "base_link"
    sample.pose.pose.position = messages.Point(*place)
    sample.twist.twist.linear.x = 1.5
    return sample


def bytes_of(sample):
    return sample.serialize(use_version_2=False)[4:]


@dataclasses.dataclass
class Octets(IdlStruct, typename="nav_msgs::msg::dds_::Odometry_"):
    """Bytes that may or may not be a pose. Their number depends on the names of its frames."""
    all: array[uint8, len(bytes_of(pose_at(0, 0.0, 0.0, 0.0)))]


def odometry(topic, count, hertz, flaw=""):
    participant = DomainParticipant(DOMAIN)
    kind, as_sent = (Octets, lambda pose: Octets(bytes_of(pose))) if flaw == "bytes" else (messages.Odometry, lambda pose: pose)
    writer = DataWriter(participant, Topic(participant, "rt" + topic, kind), qos=DEEP)
    ready()
    greet(writer, as_sent(pose_at(time.time(), 0.0, 0.0, 0.0)))
    for i in range(int(count)):
        now = time.time()
        spoilt = bool(flaw) and i % 2 == 1
        now -= 5 if spoilt and flaw == "back" else 0
        sample = pose_at(now, float(i), 2.0, -3.0)
        if spoilt and flaw == "nan":
            sample.pose.pose.position.x = float("nan")
        if spoilt and flaw == "zero":
            sample.pose.pose.orientation.w = 0.0
        sent = as_sent(sample)
        if spoilt and flaw == "bytes":
            sent.all = sent.all[:8] + b"\xff" * 4 + sent.all[12:]  # a name of 4 GB
        writer.write(sent)
        time.sleep(1 / float(hertz))
    writer.wait_for_acks(duration(seconds=60))
    return {"count": int(count)}


def transform(parent, child, now, x, y, z, turn=0.0):
    placed = messages.Transform(messages.Vector3(x, y, z), messages.Quaternion(0.0, 0.0, math.sin(turn / 2), math.cos(turn / 2)))
    return messages.TransformStamped(messages.Header(messages.Time(int(now), int(now % 1 * 1e9)), parent), child, placed)


def transforms(speed, odom=1):
    """Sends transforms in a world of east, north, up. odom is 10 m east of map, turned left by 90 degrees, at 10 Hz. In odom
    base_link moves ahead from 1 m on, at 50 Hz, by another sender. In base_link an arm is static."""
    participant = DomainParticipant(DOMAIN)
    topic = Topic(participant, "rt/tf", messages.TFMessage)
    latched = DataWriter(participant, Topic(participant, "rt/tf_static", messages.TFMessage), qos=LATCHED)
    latched.write(messages.TFMessage([transform("base_link", "arm", 0, 0.0, 0.0, 0.5)]))
    slow, fast = DataWriter(participant, topic, qos=DEEP), DataWriter(participant, topic, qos=DEEP)
    ready()
    for i in range(10**9):
        now = time.time()
        if i % 5 == 0 and int(odom):
            slow.write(messages.TFMessage([transform("map", "odom", now, 10.0, 0.0, 0.0, math.pi / 2)]))
        fast.write(messages.TFMessage([transform("odom", "base_link", now, 1 + float(speed) * (now - START), 0.0, -3.0)]))
        time.sleep(0.02)


def struct_of(typename, fields):
    body = {"__annotations__": dict(fields)}
    return dataclasses.dataclass(types.new_class("Struct", (IdlStruct,), {"typename": typename}, lambda space: space.update(body)))


def ask(participant, node, service, kind, request, response, *words):
    """Calls a service as rmw_cyclonedds_cpp does: request and response begin with the client's identity and a number."""
    who_asks = [("who", uint64), ("number", int64)]
    asked = struct_of(f"rcl_interfaces::srv::dds_::{kind}_Request_", who_asks + request)
    said = struct_of(f"rcl_interfaces::srv::dds_::{kind}_Response_", who_asks + response)
    topics = [Topic(participant, f"rq{node}/{service}Request", asked), Topic(participant, f"rr{node}/{service}Reply", said)]
    writer, reader = DataWriter(participant, topics[0], qos=DEEP), DataReader(participant, topics[1], qos=DEEP)
    while not writer.get_matched_subscriptions() or not reader.get_matched_publications():
        time.sleep(0.01)
    who, number = 0x0123456789ABCDEF, 40 + len(service)
    time.sleep(0.2)  # it must discover our reader as well
    writer.write(asked(who, number, *words))
    while True:
        for answer in reader.take(N=10):
            if isinstance(answer, said) and (answer.who, answer.number) == (who, number):
                return [plain(getattr(answer, field.name)) for field in dataclasses.fields(answer)[2:]]
        time.sleep(0.01)


def parameters(node, name, value):
    participant = DomainParticipant(DOMAIN)
    ready()
    texts, one = sequence[str], messages.ParameterValue
    task = name.split(".")[0]
    get = lambda: ask(participant, node, "get_parameters", "GetParameters", [("names", texts)], [("values", sequence[one])],
                      [name, "nobody.at_home"])
    found = {"list": ask(participant, node, "list_parameters", "ListParameters", [("prefixes", texts), ("depth", uint64)],
                         [("names", texts), ("tasks", texts)], [task], 0)}
    found["types"] = ask(participant, node, "get_parameter_types", "GetParameterTypes", [("names", texts)],
                         [("types", sequence[uint8])], [name])
    found["descriptors"] = ask(participant, node, "describe_parameters", "DescribeParameters", [("names", texts)],
                               [("descriptors", sequence[messages.ParameterDescriptor])], [name, "nobody.at_home"])
    found["before"] = get()
    wanted = [messages.Parameter(name, one(type=3, double_value=float(value))),
              messages.Parameter(name, one(type=4, string_value="far")),
              messages.Parameter("nobody.at_home", one(type=1))]
    found["results"] = ask(participant, node, "set_parameters", "SetParameters", [("all", sequence[messages.Parameter])],
                           [("results", sequence[messages.SetParametersResult])], wanted)
    found["after"] = get()
    return found


if __name__ == "__main__":
    DOMAIN = int(__import__("os").environ.get("ROS_DOMAIN_ID", "0"))
    work, *words = (word for word in sys.argv[1:] if word != "--greet")
    print(json.dumps({"listen": listen, "node": node, "image": image, "odometry": odometry,
                      "transforms": transforms, "parameters": parameters}[work](*words)))
