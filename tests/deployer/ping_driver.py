#!/usr/bin/env python3
"""Drives a Ping360 or a Ping1D with their maker's client, unmodified (PyPI bluerobotics-ping), and prints the result as
JSON: ping_driver.py ping360|ping1d LINE [FIRST LAST STEP] with LINE a UDP port of this machine or a serial line."""
import contextlib
import io
import json
import sys
import time

from brping import Ping1D, Ping360, definitions, pingmessage

PATIENCE = 120  # also on a busy machine [s]; the client gives up sooner, and is called again


def insist(action):
    """Repeats an action until it returns something, and returns that."""
    end = time.time() + PATIENCE
    while time.time() < end:
        got = action()
        if got:
            return got
    raise SystemExit(f"nothing came of {action} in {PATIENCE} s")


def connected(device, line):
    if line.isdigit():
        device.connect_udp("127.0.0.1", int(line))
    else:
        device.connect_serial(line, 115200)
    insist(device.initialize)
    return device


def data_of(message):
    """The fields of a message with data; none of a refusal, so that it is requested again."""
    if message is None or message.message_id == definitions.COMMON_NACK:
        return None
    return {name: getattr(message, name) for name in message.payload_field_names if name != "data"} | {
        "data": list(message.data)}


def echoes(device, angle, samples):
    """The answer for one angle; skips late answers to earlier requests."""
    def once():
        got = data_of(device.transmitAngle(angle))
        return got if got and got["angle"] == angle and len(got["data"]) == samples else None
    return insist(once)


def refusal(call):
    """The text of a refusal."""
    def once():
        message = call()
        return message if message is not None and message.message_id == definitions.COMMON_NACK else None
    message = insist(once)
    return {"id": message.nacked_id, "text": bytes(message.nack_message).decode()}


def automatic(device, first, last, pings):
    """Angles of an automatic scan, which is then ended."""
    device.control_auto_transmit(1, 0, 50, 1000, 750, 800, first, last, 1, 0)
    angles = []
    end = time.time() + PATIENCE
    while len(angles) < pings and time.time() < end:
        message = device.wait_message([definitions.PING360_AUTO_DEVICE_DATA], 1)
        if message and len(message.data) == 800:
            angles.append(message.angle)

    def stop():
        device.control_motor_off()
        return device.wait_message([definitions.COMMON_ACK], 1)
    return {"angles": angles, "stopped": insist(stop).acked_id}


def ping360(line, first=0, last=399, step=1):
    device = connected(Ping360(), line)
    answers = {"information": insist(device.get_device_information)}
    for setting, value in (("number_of_samples", 800), ("sample_period", 1000), ("transmit_frequency", 750),
                           ("transmit_duration", 50), ("gain_setting", 0)):
        insist(lambda: data_of(getattr(device, "set_" + setting)(value)))
    answers["scan"] = [echoes(device, angle, 800) for angle in range(int(first), int(last) + 1, int(step))]
    answers["refusals"] = [refusal(lambda: device.set_angle(400)), refusal(lambda: device.set_number_of_samples(5000))]
    insist(device.readDeviceInformation)  # the refused values are not used
    insist(lambda: data_of(device.set_number_of_samples(400)))
    insist(lambda: data_of(device.set_sample_period(2000)))
    answers["coarser"] = echoes(device, 90, 400)
    answers["automatic"] = automatic(device, 95, 99, 8)
    return answers


def ping1d_set(device, message, **fields):
    """Sends messages that the client cannot: its S500 has messages of the same numbers, whose fields hide the Ping1D's."""
    asked = pingmessage.PingMessage(message, payload_dict=definitions.payload_dict_ping1d)
    for name, value in fields.items():
        setattr(asked, name, value)
    device.write(asked.pack_msg_data())
    return device.wait_message([definitions.COMMON_ACK], 1)


def ping1d(line):
    device = connected(Ping1D(payload_dict=definitions.payload_dict_ping1d), line)
    answers = {"information": insist(device.get_device_information), "general": insist(device.get_general_info)}
    for call in (lambda: device.set_mode_auto(0), lambda: device.set_gain_setting(2),
                 lambda: device.set_ping_interval(50), lambda: device.set_ping_enable(1),
                 lambda: ping1d_set(device, definitions.PING1D_SET_RANGE, scan_start=0, scan_length=6000),
                 lambda: ping1d_set(device, definitions.PING1D_SET_SPEED_OF_SOUND, speed_of_sound=1500000)):
        insist(call)
    answers["range"] = insist(device.get_range)
    profile = insist(device.get_profile)
    answers["profile"] = profile | {"profile_data": list(profile["profile_data"])}
    answers["distance"] = insist(device.get_distance)
    answers["simple"] = insist(device.get_distance_simple)
    device.control_continuous_start(definitions.PING1D_PROFILE)
    answers["streamed"] = [insist(lambda: device.wait_message([definitions.PING1D_PROFILE], 1)).ping_number for _ in range(5)]
    device.control_continuous_stop(definitions.PING1D_PROFILE)
    return answers


with contextlib.redirect_stdout(io.StringIO()):  # the client prints
    result = {"ping360": ping360, "ping1d": ping1d}[sys.argv[1]](*sys.argv[2:])
print(json.dumps(result))
