"""Reads an XTF file with PyPI's pyxtf and prints its content as JSON: python3 read_xtf.py FILE"""

import json
import sys

import pyxtf

header, packets = pyxtf.xtf_read(sys.argv[1])
channels = [[pyxtf.XTFChannelType(info.TypeOfChannel).name, info.Frequency, info.BytesPerSample, info.SampleFormat,
             info.HorizBeamAngle, info.BeamWidth] for info in header.sonar_info]
pings = []
for ping in packets[pyxtf.XTFHeaderType.sonar]:
    port, stbd = ping.data
    pings.append({
        "time": str(ping.get_time().astype("datetime64[ms]")),
        "number": ping.PingNumber,
        "sound_velocity": ping.SoundVelocity,
        "x_y": [ping.SensorXcoordinate, ping.SensorYcoordinate],
        "depth": ping.SensorDepth,
        "altitude": ping.SensorPrimaryAltitude,
        "heading": ping.SensorHeading,
        "pitch": ping.SensorPitch,
        "roll": ping.SensorRoll,
        "speed_knots": ping.SensorSpeed,
        "slant_range": ping.ping_chan_headers[0].SlantRange,
        "seconds_per_ping": ping.ping_chan_headers[0].SecondsPerPing,
        "port": port.tolist(),
        "stbd": stbd.tolist(),
    })
print(json.dumps({"program": header.RecordingProgramName.decode(), "channels": channels, "pings": pings}))
