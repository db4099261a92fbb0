#!/usr/bin/env python3
"""A vehicle by PyPI's pymavlink, until it is stopped: vehicle.py PORT WORK [SYSTEM [NORTH]].

WORK is poses1, poses2 or signed (ATTITUDE_QUATERNION and LOCAL_POSITION_NED by a version of MAVLink), vision,
heartbeat (and the messages of poses2 that are asked for), damaged (poses2, each between damaged copies of itself). The
k-th pose is 0.02 k m north, 2 m east, 3 m deep, rolled by 0.1, its bow raised by 0.2, its heading 0.3 k, with k from 0
to 19 and back; all of it NORTH farther north."""
import socket
import sys
import time

from pymavlink.dialects.v10 import common as v10
from pymavlink.dialects.v20 import common as v20
from pymavlink.quaternion import QuaternionBase

PORT, WORK = int(sys.argv[1]), sys.argv[2]
SYSTEM = int(sys.argv[3]) if len(sys.argv) > 3 else 1
NORTH = float(sys.argv[4]) if len(sys.argv) > 4 else 0
START = time.time()
common = v10 if WORK == "poses1" else v20
link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
link.connect(("127.0.0.1", PORT))
link.setblocking(False)
mavlink = common.MAVLink(None, SYSTEM, 1)
if WORK == "signed":
    mavlink.signing.secret_key = bytes(range(32))
    mavlink.signing.sign_outgoing = True
    mavlink.signing.timestamp = 10**12
streamed = set() if WORK == "heartbeat" else {31, 32}


def send(message):
    packed = message.pack(mavlink)
    pieces = [packed[:-3] + bytes(3), packed, packed[:20]] if WORK == "damaged" else [packed]
    for piece in pieces:
        try:
            link.send(piece)
        except OSError:
            pass  # no receiver yet, or no longer


def receive():
    """Returns the requests of a ground station."""
    try:
        messages = mavlink.parse_buffer(link.recv(2048)) or []
    except OSError:
        return
    for message in messages:
        if message.get_type() == "COMMAND_LONG" and message.command == 511 and message.target_system == SYSTEM:
            assert message.get_srcSystem() == 255 and message.param2 in (20000, 50000), message
            streamed.add(int(message.param1))


for count in range(10**9):
    k = min(count % 40, 39 - count % 40)  # back and forth
    boot = int(1000 * (time.time() - START)) + 5000
    roll, pitch, yaw = 0.1, 0.2, 0.3 * k
    if WORK == "vision":
        send(common.MAVLink_vision_position_estimate_message(1000 * boot, NORTH + 0.02 * k, 2, 3, roll, pitch, yaw))
    elif count % 10 == 0:
        send(common.MAVLink_heartbeat_message(12, 3, 0, 0, 4, 3))
    if WORK != "vision" and 32 in streamed:
        send(common.MAVLink_local_position_ned_message(boot, NORTH + 0.02 * k, 2, 3, 0, 0, 0))
    if WORK != "vision" and 31 in streamed:
        send(common.MAVLink_attitude_quaternion_message(boot, *QuaternionBase([roll, pitch, yaw]).q, 0.1, 0.2, 0.3))
    receive()
    time.sleep(0.02)
