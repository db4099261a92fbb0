"""Writes 50 PoseStamped on /nav/pose and a foreign type with mcap: python3 write_mcap.py FILE COMPRESSION"""

import sys

from mcap.writer import CompressionType, Writer
from mcap_ros2.writer import Writer as RosWriter

path, compression = sys.argv[1:]
kind = {"none": CompressionType.NONE, "lz4": CompressionType.LZ4, "zstd": CompressionType.ZSTD}[compression]
line = "=" * 80
pose_schema = f"""std_msgs/Header header
geometry_msgs/Pose pose
{line}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
{line}
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
{line}
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
{line}
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
"""

with open(path, "wb") as file:
    writer = RosWriter(file, chunk_size=1000, compression=kind)
    pose = writer.register_msgdef("geometry_msgs/msg/PoseStamped", pose_schema)
    colour = writer.register_msgdef("std_msgs/msg/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n")
    for i in range(50):
        stamp = {"sec": i, "nanosec": 0}
        position = {"x": 1.0, "y": 2.0, "z": 3.0 + i}
        message = {
            "header": {"stamp": stamp, "frame_id": "map"},
            "pose": {"position": position, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}},
        }
        writer.write_message("/nav/pose", pose, message, log_time=i * 10**9, publish_time=i * 10**9)
    writer.write_message("/lamp", colour, {"r": 1.0, "g": 0.0, "b": 0.0, "a": 1.0}, log_time=50 * 10**9)
    writer.finish()
