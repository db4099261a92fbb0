"""Reads a bag like the SLAM package sonar_slam_cpp with its payload of standard messages, and dead-reckons it:
python3 read_navigation.py FOLDER

The same checks, axes and arithmetic as its adapters (projected_sonar, dvl_standard, imu enu, depth fluid_pressure) and
its dead reckoning in the mode that takes yaw from the IMU, reimplemented. Prints the result as JSON.
"""

import json
import math
import pathlib
import sys

import numpy as np
from rosbags.highlevel import AnyReader

SONAR, DVL, IMU, PRESSURE = "/oculus/sonar_image", "/dvl/data", "/mavros/imu/data", "/pressure"
TRUTH = "/truth/odometry"
SLOP = 0.1  # between a velocity and the attitude that belongs to it [s]


def seconds(header):
    return header.stamp.sec + 1e-9 * header.stamp.nanosec


def turn(q):
    """The rotation matrix of a quaternion."""
    w, x, y, z = q.w, q.x, q.y, q.z
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def sonar(m):
    """The image, a row for each range, and its bearings; or the reason why it is dropped."""
    beams, ranges = m.image.beam_count, len(m.ranges)
    if m.image.dtype != 0:
        return "not 8 bits"
    if beams <= 0 or ranges <= 1 or len(m.image.data) < beams * ranges:
        return "too few echoes"
    if len(m.beam_directions) != beams:
        return "not a direction for each beam"
    step, first = float(m.ranges[1] - m.ranges[0]), float(m.ranges[0])
    if not (step > 0 and math.isfinite(step) and 0 <= first <= 1e6 * step):
        return "no ranges"
    directions = np.array([[d.x, d.y, d.z] for d in m.beam_directions])
    bearings = np.arctan2(-directions[:, 1], directions[:, 2])
    image = m.image.data.reshape(beams, ranges).T
    if bearings[-1] < bearings[0]:
        bearings, image = bearings[::-1], image[:, ::-1]
    if (np.diff(bearings) <= 0).any() or np.ptp(directions[:, 0]) > np.ptp(directions[:, 1]):
        return "bearings out of order, or about another axis"
    return image, bearings, first, step


def velocity(m):
    v = np.array([m.velocity.x, m.velocity.y, m.velocity.z])
    if not m.beam_velocities_valid or m.velocity_mode == 2:
        return "no bottom lock"
    return v if np.isfinite(v).all() else "not finite"


def attitude(m):
    """The attitude of a body with z down, in a world with z down."""
    ned_from_enu, frd_from_flu = np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1]]), np.diag([1, -1, -1])
    return ned_from_enu @ turn(m.orientation) @ frd_from_flu


def yaw(matrix):
    return math.atan2(matrix[1, 0], matrix[0, 0])


def depth(m):
    return (m.fluid_pressure - 101325.0) / (1025.0 * 9.80665)


found = {"types": {}, "counts": {}, "dropped": {}}
velocities, attitudes, depths, truths, pings = [], [], [], [], []
with AnyReader([pathlib.Path(sys.argv[1])]) as reader:
    wanted = [each for each in reader.connections if each.topic not in ("/clock", "/tf", "/tf_static")]
    for connection in wanted:
        found["types"][connection.topic] = connection.msgtype
    for connection, _, data in reader.messages(wanted):
        m, topic = reader.deserialize(data, connection.msgtype), connection.topic
        taken = {SONAR: sonar, DVL: velocity, IMU: attitude, PRESSURE: depth, TRUTH: lambda odometry: odometry}[topic](m)
        if isinstance(taken, str):
            found["dropped"].setdefault(topic, []).append(taken)
            continue
        found["counts"][topic] = found["counts"].get(topic, 0) + 1
        {SONAR: pings, DVL: velocities, IMU: attitudes, PRESSURE: depths, TRUTH: truths}[topic].append((seconds(m.header), taken))

imu_times = np.array([time for time, _ in attitudes])
place, before, track, start = np.zeros(2), None, [], None
for time, v in velocities:
    nearest = int(np.argmin(abs(imu_times - time)))
    if abs(imu_times[nearest] - time) > SLOP:
        continue
    start = yaw(attitudes[nearest][1]) if start is None else start
    heading = yaw(attitudes[nearest][1]) - start
    if before is not None:
        earlier, slower, turned = before
        step = (v[:2] + slower[:2]) / 2 * (time - earlier)
        place = place + np.array([[math.cos(turned), -math.sin(turned)], [math.sin(turned), math.cos(turned)]]) @ step
    before = (time, v, heading)
    track.append((time, *place))
track = np.array(track)

# The truth in the same axes: north and east turned to the first heading, relative to the place of the first velocity.
times = np.array([time for time, _ in truths])
north = np.array([o.pose.pose.position.y for _, o in truths])
east = np.array([o.pose.pose.position.x for _, o in truths])
down = np.array([-o.pose.pose.position.z for _, o in truths])
inside = (track[:, 0] >= times[0]) & (track[:, 0] <= times[-1])
track = track[inside]
way = np.stack([np.interp(track[:, 0], times, north), np.interp(track[:, 0], times, east)], 1)
first_attitude = attitude(type("o", (), {"orientation": truths[0][1].pose.pose.orientation}))
ahead = yaw(first_attitude)
turned_back = np.array([[math.cos(ahead), math.sin(ahead)], [-math.sin(ahead), math.cos(ahead)]])
errors = np.hypot(*((way - way[0]) @ turned_back.T - (track[:, 1:] - track[0, 1:])).T)
at = [np.interp(time, times, down) for time, _ in depths]

image, bearings, first, step = pings[0][1]
found.update(
    length=float(np.hypot(*np.diff(way, axis=0).T).sum()), end_error=float(errors[-1]), worst=float(errors.max()),
    loop=float(np.hypot(*(track[-1, 1:] - track[0, 1:]))),
    depth_error=float(np.abs(np.array([d for _, d in depths]) - at).max()),
    imu_gap=float(np.diff(imu_times).max()), shape=list(image.shape), bearings=[float(bearings[0]), float(bearings[-1])],
    step=step, loudest=int(max(ping[0].max() for _, ping in pings)),
    echoes=float(np.mean([(ping[0] > 127).mean() for _, ping in pings])),
    to_port=float((image[:, bearings > 0] > 127).sum() / max((image > 127).sum(), 1)))
print(json.dumps(found))
