#!/usr/bin/env python3
"""Makes tests/fuzz/corpus/gazebo: bytes as Gazebo Harmonic puts them on the wire, by its own message definitions.

pip install gazebo-py-bindings 'protobuf<3.21' brings these definitions, gz.msgs 10, to a Python 3.11.
"""
import math
import pathlib
import struct

from gz.msgs10 import discovery_pb2, geometry_pb2, odometry_pb2, pose_v_pb2, scene_pb2

FOLDER = pathlib.Path(__file__).parents[1] / "fuzz/corpus/gazebo"
WORLD = "11111111-2222-3333-4444-555555555555"  # process
NODE = "aaaaaaaa-bbbb-cccc-dddd-eeeeeeeeeeee"
Geometry = geometry_pb2.Geometry


def place(pose, x=0.0, y=0.0, z=0.0, yaw=0.0):
    pose.position.x, pose.position.y, pose.position.z = x, y, z
    pose.orientation.w, pose.orientation.z = math.cos(yaw / 2), math.sin(yaw / 2)


def add_model(models, name, number, **pose):
    model = models.add(name=name, id=number, is_static=name == "sea_floor")
    place(model.pose, **pose)
    return model


def add_visual(model, number, kind, link="link", **pose):
    below = model.link.add(name=link, id=number)
    place(below.pose, **pose)
    visual = below.visual.add(name="visual", id=number + 1, parent_name=link, parent_id=number, cast_shadows=True)
    place(visual.pose)
    visual.geometry.type = kind
    visual.material.diffuse.r = 0.4
    visual.material.diffuse.a = 1
    return visual


def scene():
    message = scene_pb2.Scene()
    sun = message.light.add(name="sun", id=90)
    sun.diffuse.r = 1
    floor = add_visual(add_model(message.model, "sea_floor", 1, z=-10), 2, Geometry.PLANE)
    floor.geometry.plane.normal.z = 1
    floor.geometry.plane.size.x = floor.geometry.plane.size.y = 100
    box = add_visual(add_model(message.model, "crate", 4, x=1, y=2, z=-3, yaw=math.pi / 2), 5, Geometry.BOX, x=0.5)
    box.geometry.box.size.x, box.geometry.box.size.y, box.geometry.box.size.z = 2, 4, 6
    ball = add_visual(add_model(message.model, "ball", 10, x=20), 11, Geometry.SPHERE)
    ball.geometry.sphere.radius = 2
    rig = add_model(message.model, "rig", 20, y=30)
    leg = add_model(rig.model, "leg", 21, x=3)
    pipe = add_visual(leg, 22, Geometry.CYLINDER, link="pipe")
    pipe.geometry.cylinder.radius, pipe.geometry.cylinder.length = 0.5, 8
    pipe.material.script.name = "Gazebo/Steel"
    buoy = add_model(message.model, "buoy", 30, x=-20)
    for offset, kind in enumerate((Geometry.CAPSULE, Geometry.ELLIPSOID, Geometry.CONE)):
        visual = add_visual(buoy, 31 + 2 * offset, kind, link=f"part{offset}", z=4.0 * offset)
        if kind == Geometry.CAPSULE:
            visual.geometry.capsule.radius, visual.geometry.capsule.length = 0.5, 1
        elif kind == Geometry.ELLIPSOID:
            radii = visual.geometry.ellipsoid.radii
            radii.x, radii.y, radii.z = 1, 2, 0.5
        else:
            visual.geometry.cone.radius, visual.geometry.cone.length = 1, 3
    hull = add_visual(add_model(message.model, "rov", 40, x=10, z=-5), 41, Geometry.MESH)
    hull.geometry.mesh.filename = "file:///nowhere/models/rov/meshes/hull.obj"
    hull.geometry.mesh.scale.x = hull.geometry.mesh.scale.y = hull.geometry.mesh.scale.z = 2
    hill = add_visual(add_model(message.model, "hill", 50), 51, Geometry.HEIGHTMAP)
    hill.geometry.heightmap.filename = "/nowhere/hill.png"
    hill.geometry.heightmap.size.x = hill.geometry.heightmap.size.y = hill.geometry.heightmap.size.z = 10
    return message


def poses():
    message = pose_v_pb2.Pose_V()
    message.header.stamp.sec, message.header.stamp.nsec = 12, 500_000_000
    for number, (name, x) in enumerate((("rov", 1.5), ("link", 0.0), ("visual", 0.0), ("crate", 4.0)), 40):
        place(message.pose.add(name=name, id=number), x=x, z=-5, yaw=math.pi / 2)
    return message


def odometry():
    message = odometry_pb2.Odometry()
    message.header.stamp.sec = 3
    place(message.pose, x=1, y=2, z=3)
    message.twist.linear.x, message.twist.angular.z = 0.5, 0.25
    return message


def discovery(kind, version=10):
    message = discovery_pb2.Discovery(version=version, process_uuid=WORLD, type=kind)
    message.pub.topic, message.pub.process_uuid = "", WORLD
    return message


def offer(topic, address):
    message = discovery(discovery_pb2.Discovery.ADVERTISE)
    message.pub.topic, message.pub.address = topic, address
    message.pub.node_uuid, message.pub.scope = NODE, discovery_pb2.Discovery.Publisher.ALL
    return message


def main():
    topic = offer("@/auv@/world/sea/pose/info", "tcp://127.0.0.1:40123")
    topic.pub.msg_pub.ctrl, topic.pub.msg_pub.msg_type = "", "gz.msgs.Pose_V"
    topic.pub.msg_pub.throttled, topic.pub.msg_pub.msgs_per_sec = True, 60
    service = offer("@/auv@/world/sea/scene/info", "tcp://127.0.0.1:40124")
    service.pub.srv_pub.socket_id = "99999999-8888-7777-6666-555555555555"
    service.pub.srv_pub.request_type, service.pub.srv_pub.response_type = "gz.msgs.Empty", "gz.msgs.Scene"
    datagrams = {
        "offer_topic": topic,
        "offer_service": service,
        "alive": discovery(discovery_pb2.Discovery.HEARTBEAT),
        "goodbye": discovery(discovery_pb2.Discovery.BYE),
        "alive_with_statistics": discovery(discovery_pb2.Discovery.HEARTBEAT, version=110),
    }
    FOLDER.mkdir(exist_ok=True)
    for name, message in datagrams.items():
        body = message.SerializeToString()
        (FOLDER / f"harmonic_{name}").write_bytes(struct.pack("<H", len(body)) + body)
    for name, message in (("scene", scene()), ("poses", poses()), ("odometry", odometry())):
        (FOLDER / f"harmonic_{name}").write_bytes(message.SerializeToString())


if __name__ == "__main__":
    main()
