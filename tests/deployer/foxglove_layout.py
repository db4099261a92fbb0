"""Checks a Foxglove layout against a server: python3 foxglove_layout.py LAYOUT.json ws://HOST:PORT

Every panel of the layout has a place in it; every topic is advertised with a schema that its panel shows, and has a
message; every path of a plot is a number of that message; the frame that the 3D panel follows has a transform. Prints
the result as JSON."""

import asyncio
import json
import math
import pathlib
import struct
import sys

import websockets
from mcap_ros2._dynamic import generate_dynamic

DRAWN = {
    "Image": {"sensor_msgs/Image"},
    "3D": {"foxglove_msgs/SceneUpdate", "foxglove_msgs/FrameTransforms", "geometry_msgs/PoseStamped",
           "sensor_msgs/PointCloud2"},
}

layout = json.loads(pathlib.Path(sys.argv[1]).read_text())


def panels_in(place):
    if isinstance(place, str):
        return [place]
    assert set(place) == {"direction", "splitPercentage", "first", "second"}, place
    assert place["direction"] in ("row", "column") and 0 < place["splitPercentage"] < 100, place
    return panels_in(place["first"]) + panels_in(place["second"])


placed = panels_in(layout["layout"])
assert sorted(placed) == sorted(layout["configById"]), (placed, list(layout["configById"]))
assert set(layout) == {"configById", "globalVariables", "userNodes", "playbackConfig", "layout"}, set(layout)

drawn, paths, followed = {}, [], set()
for panel, config in layout["configById"].items():
    kind = panel.split("!")[0]
    assert kind in ("Image", "3D", "Plot", "Parameters"), panel
    if kind == "Image":
        drawn[config["imageMode"]["imageTopic"]] = DRAWN[kind]
    elif kind == "3D":
        drawn |= {topic: DRAWN[kind] for topic, settings in config["topics"].items() if settings["visible"]}
        followed.add(config["followTf"])
    elif kind == "Plot":
        paths += [path["value"] for path in config["paths"] + [config.get("xAxisPath")] if path]


def value_of(message, fields):
    for field in fields:
        message = getattr(message, field)
    return message


async def main():
    found = {"panels": sorted(panel.split("!")[0] for panel in placed), "topics": {}, "paths": {}}
    topics = set(drawn) | {path.split(".")[0] for path in paths}
    async with websockets.connect(sys.argv[2], subprotocols=["foxglove.sdk.v1"], max_size=None,
                                  max_queue=None) as server:
        channels, messages, parameters = {}, {}, None
        frames = set()
        await server.send(json.dumps({"op": "getParameters", "parameterNames": [], "id": "all"}))
        while topics - set(messages) or parameters is None or followed - frames:
            said = await asyncio.wait_for(server.recv(), 20)
            if isinstance(said, str):
                said = json.loads(said)
                if said["op"] == "advertise":
                    channels = {channel["topic"]: channel for channel in said["channels"]}
                    missing = topics - set(channels)
                    assert not missing, (missing, sorted(channels))
                    ask = [{"id": channels[topic]["id"], "channelId": channels[topic]["id"]} for topic in topics]
                    await server.send(json.dumps({"op": "subscribe", "subscriptions": ask}))
                elif said["op"] == "parameterValues":
                    parameters = {each["name"]: each.get("value") for each in said["parameters"]}
            elif said[0] == 1:
                channel = next(one for one in channels.values() if one["id"] == struct.unpack_from("<I", said, 1)[0])
                name, text = channel["schemaName"], channel["schema"]
                full = name.replace("/", "/msg/")
                message = generate_dynamic(full, text)[full](said[13:])
                messages[channel["topic"]] = message
                if name == "foxglove_msgs/FrameTransforms":
                    frames |= {transform.child_frame_id for transform in message.transforms}
    for topic, schemas in drawn.items():
        assert channels[topic]["schemaName"] in schemas, channels[topic]
        found["topics"][topic] = channels[topic]["schemaName"]
    for path in paths:
        topic, *fields = path.split(".")
        number = value_of(messages[topic], fields)
        assert isinstance(number, float) and math.isfinite(number), (path, number)
        found["paths"][path] = number
    cloud = layout["configById"]["3D!scene"]["topics"]["/receiver/ping/points"]["colorField"]
    assert cloud in [field.name for field in messages["/receiver/ping/points"].fields], cloud
    found["parameters"] = sorted(parameters)
    print(json.dumps(found))


asyncio.run(main())
