"""Fans and a scanning beam before the scenes of scripts/scenes/make_bench_scene.py."""
import subprocess

from benchmarks.common import BENCH, ROOT
from benchmarks.table import measure

QUALITY = "quality: {rows: 256, columns_per_beam: 2}, "
FAN = "beam_height_deg: 20, field_of_view_deg: 120, range: 30"
SONARS = {
    "FLS 256 x 500": f"{{type: sonar::SonarTask, properties: {{{QUALITY}beam_count: 256, bin_count: 500, {FAN}}}}}",
    "FLS 512 x 1000": f"{{type: sonar::SonarTask, properties: {{{QUALITY}beam_count: 512, bin_count: 1000, {FAN}}}}}",
    "MSIS beam, 500 bins": f"{{type: sonar::ScanningSonarTask, properties: {{{QUALITY}range: 30, bin_count: 500, "
                           "beam_width_deg: 3, beam_height_deg: 35, head: {left_deg: 45, right_deg: -45}}}",
}
# Name of a scene: options of make_bench_scene.py.
SCENES = {"80 k": ["--cells", "200"], "1 M in view": ["--cells", "1500", "--in-view"]}
GROWTH = {"10 k": "71", "100 k": "224", "1 M": "707", "10 M": "2236"}


def scene(options):
    file = BENCH / ("bench" + "".join(options).replace("--", "_") + ".glb")
    if not file.exists():
        subprocess.run(["/usr/bin/python3", ROOT / "scripts/scenes/make_bench_scene.py", file, *options], check=True)
    return file


def seen(sonar, visibility):
    return sonar.replace("properties: {", f"properties: {{visibility: {visibility}, ", 1)


def unsaid(sonar):
    """The sonar with its default quality."""
    return sonar.replace(QUALITY, "")


# Receives the truth of pings, and makes no picture of it.
TRUTH = ("  truth: {type: output::TruthImageTask}", """  - {from: sonar.ping, to: truth.ping, policy: {type: buffer, size: 4}}
  - {from: sonar.truth, to: truth.truth, policy: {type: buffer, size: 4}}
""")


def with_truth(text):
    """The deployment with a receiver of the sonar's truth."""
    task, connections = TRUTH
    return text.replace("connections:", f"{task}\nconnections:", 1) + connections


def deployment(sonar, file, schedule="lockstep", period=0.1, noise=""):
    return f"""schedule: {schedule}
tasks:
  vehicle:
    type: pose::TrajectoryTask
    activity: {{period: {period}}}
    properties: {{waypoints: [{{time: 0, position: [0, 0, 0], roll_deg: 0, pitch_deg: 0, yaw_deg: 0}}]}}
  scene: {{type: scene::SceneTask, properties: {{file: {file}, mount: {{position: [0, 0, 0], pitch_deg: 10}}}}}}
  sonar: {sonar}
  noise: {{type: noise::NoiseTask, properties: {{speckle: {{law: rayleigh}}{noise}}}}}
  receiver: {{type: receiver::ReceiverTask, properties: {{tvg: {{log_coefficient: 40, db_per_m: 0.2, max_db: 110}}}}}}
connections:
  - {{from: vehicle.pose, to: scene.pose}}
  - {{from: scene.snapshot, to: sonar.snapshot}}
  - {{from: sonar.ping, to: noise.clean}}
  - {{from: noise.noisy, to: receiver.intensity}}
"""


def measure_seen(found, name, sonar, file, options, with_rays=True, noise="", change=str, visible=None):
    """Adds a result for each visibility, of the deployment changed by `change`."""
    for visibility in options.visibility if visible is None else visible:
        text = change(deployment(seen(sonar, visibility), file, noise=noise))
        found[f"{name}, {visibility}"] = measure(text, options.pings, with_rays)


def under_water(text):
    """The deployment with the sonar level and the water surface 3 m above it; objects are smooth."""
    return text.replace("pitch_deg: 10}", "pitch_deg: 0}, water_surface: 3, "
                        "materials: {steel: {reflection: 0.9, roughness_slope: 0.1}}", 1)


def measure_rays(found, name, sonar, file, options):
    """Adds a result of rays alone under the water surface."""
    text = under_water(deployment(seen(sonar, "cpu"), file))
    found[f"{name}, cpu"] = measure(text, options.pings, False)


def measure_pings(options):
    """Each sonar before each scene, and the fan of 256 beams with its default quality."""
    found = {}
    for name, scene_options in SCENES.items():
        for sonar, text in SONARS.items():
            measure_seen(found, f"{sonar}, {name}", text, scene(scene_options), options)
    fan = unsaid(SONARS["FLS 256 x 500"])
    measure_seen(found, "FLS 256 x 500, 80 k, quality unsaid", fan, scene(SCENES["80 k"]), options)
    return found


# Blocks of a sonar that are absent from the fans above.
PATTERN = ("beam_pattern: {transmit: {elevation: {width_deg: 20}}, receive: {azimuth: {weighting: taylor, width_deg: 1}, "
           "elevation: {width_deg: 20}}}, ")
PULSE = "pulse: {bandwidth_khz: 10, window: hann}, "
SEABED = "frequency_khz: 100, "  # at which the scene's sand follows APL-UW TR 9407
VOLUME = "volume: {strength_db: -70}, "
LAYERS = "volume: [{bottom_m: 1, strength_db: -60}, {top_m: 1, strength_db: -75}], "
COHERENT = "frequency_khz: 700, speckle: {coherent: true}, "
EFFECTS = {"plain": "", "pattern": PATTERN, "pulse": PULSE, "pattern and pulse": PATTERN + PULSE, "TR 9407": SEABED,
           "volume": VOLUME, "layers": LAYERS, "all": PATTERN + PULSE + SEABED + VOLUME}
RAYS_ALONE = {"coherent": COHERENT, "coherent, pattern and pulse": COHERENT + PATTERN + PULSE}
AMBIENT = ", ambient: {level_db: -110}"
# Level, 3 m below the surface, which half of the rays meet: without the surface, with it, in wind, and with smooth
# objects as well.
SURFACE = "multipath: {surface: {wind_m_s: 0}}, "
PATHS = {"level": "", "level, surface": SURFACE, "level, wind": SURFACE.replace("0", "3"),
         "level, second bounce": SURFACE.replace("}}", "}, bounces: 2}")}


def measure_effects(options):
    """The fan of 256 beams before the 80,000 triangles, plain, with each effect, and with its truth."""
    plain = SONARS["FLS 256 x 500"]
    found = {}
    for name, blocks in {**EFFECTS, **RAYS_ALONE}.items():
        sonar = plain.replace("properties: {", f"properties: {{{blocks}", 1)
        noise = AMBIENT if name == "all" else ""
        visible = [way for way in options.visibility if way == "cpu" or name not in RAYS_ALONE]
        measure_seen(found, f"FLS 256 x 500, 80 k, {name}", sonar, scene(SCENES["80 k"]), options, False, noise, str,
                     visible)
    if "cpu" in options.visibility:
        for name, blocks in PATHS.items():
            sonar = plain.replace("properties: {", f"properties: {{{blocks}", 1)
            measure_rays(found, f"FLS 256 x 500, 80 k, {name}", sonar, scene(SCENES["80 k"]), options)
    measure_seen(found, "FLS 256 x 500, 80 k, truth", plain, scene(SCENES["80 k"]), options, False, "", with_truth)
    return found


def measure_growth(options):
    """The same floor of more and more triangles, half of it in view."""
    found = {}
    for name, count in GROWTH.items():
        measure_seen(found, f"{name} triangles", SONARS["FLS 256 x 500"], scene(["--cells", count]), options, False)
    return found
