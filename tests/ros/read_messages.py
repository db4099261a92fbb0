"""Reads the messages of a folder with rosbags: python3 read_messages.py FOLDER

`list` names them: number, type, RIHS01 hash; NUMBER.msg is the schema, NUMBER.cdr the bytes. Schema, hash and bytes
must agree with each other (what is decoded and encoded again must be the same bytes); then some values are printed.
"""

import pathlib
import sys

from rosbags.typesys import Stores, get_types_from_msg, get_typestore

folder = pathlib.Path(sys.argv[1])
standard = get_typestore(Stores.ROS2_JAZZY)
of_nodes = ("rcl_interfaces", "lifecycle_msgs", "diagnostic_msgs")


def lists(values):
    return [round(float(value), 6) for value in values]


def vector(v):
    return lists([v.x, v.y, v.z])


def show(name, m):
    if name == "ProjectedSonarImage":
        stamp = f"{m.header.stamp.sec}.{m.header.stamp.nanosec:09d}"
        y = round(m.beam_directions[0].y, 6)
        print(name, stamp, m.header.frame_id, m.ping_info.sound_speed, lists(m.ranges), y, m.image.data.tolist())
    elif name == "RawSonarImage":
        print(name, m.sample_rate, m.samples_per_beam, lists(m.rx_angles))
    elif name == "SonarRanges":
        print(name, lists(m.ranges), [f.flag for f in m.flags], lists(m.intensities))
    elif name == "SonarDetections":
        print(name, lists(m.two_way_travel_times), [f.flag for f in m.flags], lists(m.tx_angles), lists(m.rx_angles))
    elif name == "PointCloud2":
        print(name, m.width, m.point_step, [f.name for f in m.fields])
    elif name == "LaserScan":
        print(name, m.angle_min, m.angle_increment, lists(m.ranges))
    elif name == "Odometry":
        p, t = m.pose.pose.position, m.twist.twist.linear
        print(name, m.header.frame_id, m.child_frame_id, vector(p), vector(t), round(m.pose.covariance[0], 6))


entries = [line.split() for line in (folder / "list").read_text().splitlines()]
messages = []
for number, type_name, type_hash in entries:
    types = get_types_from_msg((folder / f"{number}.msg").read_text(), type_name)
    store = get_typestore(Stores.EMPTY)
    store.register(types)
    read_as = type_name.replace("/srv/", "/srv/msg/")  # rosbags knows messages only
    store.fielddefs[type_name] = store.fielddefs[read_as]
    for name, definition in types.items():
        known = standard.fielddefs.get(name, definition)
        if name.split("/")[0] in of_nodes:  # whose constants we do not need
            definition, known = definition[1], known[1]
        assert definition == known, f"{name}: {definition} is not {known}"
    assert store.hash_rihs01(type_name) == type_hash, f"{type_name}: {store.hash_rihs01(type_name)}"
    data = (folder / f"{number}.cdr").read_bytes()
    message = store.deserialize_cdr(data, read_as)
    assert bytes(store.serialize_cdr(message, read_as)) == data, type_name
    messages.append((type_name.rsplit("/", 1)[1], message))

print(len(messages), "messages as announced")
for name, message in messages[-7:]:
    show(name, message)
