"""Talks to a Sonar 3D-15 by the maker's client: python3 sonar3d_client.py PORT unicast|MULTICAST_PORT [VOXELS.npz]

Sets all that the client can set, receives range images, and prints one JSON object: accepted and refused values, the
wall and the ball that the voxels show (x ahead, y to starboard, z down).
"""

import datetime
import json
import sys

import numpy
import requests
import wlsonar
import wlsonar.range_image_protocol as rip

port, way = int(sys.argv[1]), sys.argv[2]
results = {}


def refused(call):
    try:
        call()
    except requests.HTTPError as error:
        return [error.response.status_code, error.response.json()["error"]]
    return None


def image_of(sock, kind, fits):
    """The first image of the present settings; packets of earlier pings are skipped."""
    while True:
        message = rip.unpackb(sock.recv(wlsonar.UDP_MAX_DATAGRAM_SIZE))
        if isinstance(message, kind) and fits(message):
            return message


def ball(points):
    """Centre and radius by least squares: |p|^2 = 2 p c + r^2 - |c|^2."""
    matrix = numpy.hstack([2 * points, numpy.ones((len(points), 1))])
    solution = numpy.linalg.lstsq(matrix, (points**2).sum(1), rcond=None)[0]
    centre = solution[:3]
    return centre, float(numpy.sqrt(solution[3] + centre @ centre))


sonar = wlsonar.Sonar3D("127.0.0.1", port, timeout=60)
results["about"] = sonar.about().product_name
results["ready"] = sonar.get_status().api.operational and sonar.get_status().time.operational
results["temperature"] = sonar.get_temperature()
results["enabled_at_first"] = sonar.get_acoustics_enabled()

sonar.set_speed_of_sound(1500)
sonar.set_range(0.3, 8)
sonar.set_mode("low-frequency")
sonar.set_salinity("fresh")
sonar.set_output_imu_batch_enabled(True)
sonar.set_time_ntp(wlsonar.NTPConfiguration("10.0.0.1"))
results["kept"] = [sonar.get_speed_of_sound(), sonar.get_range(), sonar.get_mode(), sonar.get_salinity(),
                   sonar.get_output_imu_batch_enabled(), sonar.get_time_ntp().ntp_address]
results["refused"] = [refused(lambda: sonar.set_range(0, 1000)), refused(lambda: sonar.set_speed_of_sound(10)),
                      refused(lambda: sonar.set_udp_unicast("nowhere", 1))]

if way == "unicast":
    sock = wlsonar.open_sonar_udp_unicast_socket(udp_port=0, iface_ip="127.0.0.1")
    sonar.set_udp_unicast("127.0.0.1", sock.getsockname()[1])
else:
    try:
        sock = wlsonar.open_sonar_udp_multicast_socket(udp_port=int(way))
    except OSError as error:
        print(json.dumps({"no_multicast": str(error)}))
        sys.exit()
    sonar.set_udp_multicast()
sock.settimeout(60)
results["udp"] = sonar.get_udp_config().mode
sonar.set_acoustics_enabled(True)

image = image_of(sock, rip.RangeImage, lambda image: image.range == 8)
bitmap = image_of(sock, rip.BitmapImageGreyscale8, lambda bitmap: True)
results["size"] = [image.width, image.height, bitmap.width, bitmap.height]
results["view"] = [image.fov_horizontal, image.fov_vertical]
results["frequency"], results["speed"] = image.frequency, image.speed_of_sound
strengths = wlsonar.bitmap_image_to_strength_linear(bitmap)
results["strongest"] = max(strengths)
results["same_pixels"] = all((a == 0) == (b == 0) for a, b in zip(image.image_pixel_data, strengths))
stamp = image.header.timestamp.ToDatetime(tzinfo=datetime.timezone.utc)
results["age"] = (datetime.datetime.now(datetime.timezone.utc) - stamp).total_seconds()

voxels = wlsonar.range_image_to_xyz(image)
points = numpy.array([voxel for voxel in voxels if voxel is not None])
results["heard"] = len(points)
if len(sys.argv) > 3:
    ranges = numpy.array(wlsonar.range_image_to_distance(image)).reshape(image.height, image.width)
    numpy.savez(sys.argv[3], ranges=ranges, strengths=numpy.array(strengths).reshape(ranges.shape), points=points)

near = points[points[:, 0] < 4.6]
centre, radius = ball(near)
front = near[((near - centre) * -centre).sum(1) > 0.5 * radius * numpy.linalg.norm(centre)]  # not its rim
centre, radius = ball(front)
results["ball"] = {"voxels": len(front), "centre": list(map(float, centre)), "radius": radius}

wall = points[points[:, 0] > 4.8]
ways = wall / numpy.linalg.norm(wall, axis=1, keepdims=True)
whole = numpy.linalg.norm(numpy.cross(ways, centre), axis=1) > radius + 0.1  # past the ball by more than half a beam
results["wall"] = {"voxels": int(whole.sum()), "mean": float(wall[:, 0].mean()),
                   "worst": float(abs(wall[whole, 0] - 5).max()), "worst_beside_ball": float(abs(wall[:, 0] - 5).max())}

sonar.set_mode("high-frequency")
sonar.set_range(0.3, 6)
image = image_of(sock, rip.RangeImage, lambda image: image.range == 6)
results["high"] = [image.frequency, image.fov_horizontal]
points = numpy.array([voxel for voxel in wlsonar.range_image_to_xyz(image) if voxel is not None])
wall = points[points[:, 0] > 4.8]
results["high_wall"] = float(wall[:, 0].mean())

results["synchronised"] = sonar.force_sync_ntp(1).success
sonar.set_acoustics_enabled(False)
print(json.dumps(results))
