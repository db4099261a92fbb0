#!/usr/bin/env python3
"""Writes logs of Ping Viewer with messages of the maker's package (PyPI bluerobotics-ping) into a folder, and prints
what they hold as JSON: write_ping_log.py FOLDER"""
import json
import struct
import sys
from pathlib import Path

from brping import PingMessage, definitions

BEGIN = 1709251199.5  # 2024-02-29 23:59:59.5 UTC


def text(letters):
    """A QString in a QDataStream: its size in bytes, and UTF-16, big endian."""
    encoded = letters.encode("utf-16-be")
    return struct.pack(">I", len(encoded)) + encoded


def header():
    program = ["1ed4508", "2024-02-01", "v2.4.2", "Debian", "12"]
    return text("PingViewer sensor log file") + struct.pack(">I", 1) + b"".join(map(text, program)) + struct.pack(">ii", 1, 2)


def record(ms, message):
    message.pack_msg_data()
    time = f"{ms // 3600000:02}:{ms // 60000 % 60:02}:{ms // 1000 % 60:02}.{ms % 1000:03}"
    return text(time) + struct.pack(">I", len(message.msg_data)) + bytes(message.msg_data)


def scan(identifier, angle, samples, period, data):
    message = PingMessage(identifier)
    for name in message.payload_field_names:
        setattr(message, name, 0)
    message.mode, message.gain_setting, message.angle = 1, 1, angle
    message.transmit_duration, message.sample_period, message.transmit_frequency = 20, period, 750
    message.number_of_samples, message.data_length, message.data = samples, len(data), bytearray(data)
    return message


def profile(start, length, data):
    message = PingMessage(definitions.PING1D_PROFILE)
    message.distance, message.confidence, message.transmit_duration, message.ping_number = 4000, 90, 100, 7
    message.scan_start, message.scan_length, message.gain_setting = start, length, 3
    message.profile_data_length, message.profile_data = len(data), bytearray(data)
    return message


def main(folder):
    logs = [{"file": "20240229-235959500.bin", "pings": []}, {"file": "sub/20240229-235959500.bin", "pings": []}]
    (folder / "sub").mkdir()
    scans, profiles = header(), header()
    for i in range(6):
        samples, period, ms = 200 + 100 * i, 80 + 50 * i, 250 + 480 * i
        data = [(7 * i + 3 * k) % 256 for k in range(samples)]
        identifier = definitions.PING360_AUTO_DEVICE_DATA if i % 2 else definitions.PING360_DEVICE_DATA
        scans += record(ms, scan(identifier, 60 * i, samples, period, data))
        logs[0]["pings"].append({"time": BEGIN + ms / 1000, "range": samples * period * 25e-9 * 1500 / 2, "first": 0,
                                 "bearing_deg": 0.9 * (200 - 60 * i), "data": data})
        data = [(11 * i + 5 * k) % 256 for k in range(200)]
        profiles += record(ms, profile(1000 * i, 10000, data))
        logs[1]["pings"].append({"time": BEGIN + ms / 1000, "range": i + 10, "first": 20 * i, "bearing_deg": 0,
                                 "data": data})
    (folder / logs[0]["file"]).write_bytes(scans)
    (folder / logs[1]["file"]).write_bytes(profiles)
    print(json.dumps(logs))


main(Path(sys.argv[1]))
