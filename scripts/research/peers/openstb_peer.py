"""Runs openSTB: python openstb_peer.py FOLDER [--short]. It writes FOLDER/about.json and the arrays of case.EXPERIMENTS.

openSTB simulates the signal of each receiver. This adapter compresses the chirp by its matched filter and forms beams by plain
delay and sum, focused at each range. Floors are random points of equal reflectivity, as openSTB's examples have them."""
import argparse
import json
import os
import platform
import shutil
import time
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from pathlib import Path

import case
import numpy as np
from openstb.simulator.controller import simple_points
from openstb.simulator.plugin import loader

SAMPLE_RATE, CHIRP = 40e3, 1e-3           # [Hz], [s]
CHUNK = 4000                              # points that are computed at a time
SPACING = case.WAVELENGTH / 2
ARRAY = (np.arange(case.ELEMENTS) - (case.ELEMENTS - 1) / 2) * SPACING
BEAM_STEP = 0.2 * case.RESOLUTION         # between ranges at which beams are formed
AHEAD = [np.sqrt(0.5), 0, 0, np.sqrt(0.5)]  # a quaternion: looks to starboard, across the track
SPREADING = {"name": "geometric_spreading", "parameters": {"power": 1.0}}


class Sonar:
    """openSTB with the sonar of `case`. Its axes are x along the array, y ahead and z down.

    Its controller submits chunks of points to a Dask cluster. Many runs of it one after the other stopped answering on a busy machine. The
    adapter therefore calls the controller's function for a chunk itself, one receiver on each thread, and compares one echo with that of the
    controller."""

    def __init__(self, folder, threads):
        self.folder, self.pool = folder, ThreadPoolExecutor(threads)

    def signal(self):
        half = case.BANDWIDTH / 2
        parameters = {"f_start": case.FREQUENCY - half, "f_stop": case.FREQUENCY + half, "duration": CHIRP, "rms_spl": 120}
        return loader.signal({"name": "lfm_chirp", "parameters": parameters})

    def config(self, targets, elements):
        return {
            "trajectory": loader.trajectory({"name": "linear", "parameters": {
                "start_position": [0, 0, 0], "end_position": [1, 0, 0], "speed": 1.0}}),
            "ping_times": loader.ping_times({"name": "constant_interval", "parameters": {
                "interval": 1.0, "start_delay": 0, "end_delay": 0.5}}),
            "environment": loader.environment({"name": "invariant", "parameters": {
                "salinity": 35.0, "sound_speed": case.SOUND_SPEED, "temperature": 10.0}}),
            "targets": [loader.point_targets(each) for each in targets],
            "travel_time": loader.travel_time({"name": "stop_and_hop", "parameters": {}}),
            "echo_distortion": [loader.distortion(SPREADING)],
            "system": loader.system({"name": "generic", "parameters": {
                "transmitter": transducer(0.0), "receivers": [transducer(x) for x in elements], "signal": self.signal()}}),
        }

    def echoes(self, targets, max_range, elements=(0.0,)):
        """Returns [elements, samples]: complex, after the matched filter, a point of 0 dB at 1 m has the peak 1."""
        return self.compressed(self.raw(self.config(targets, elements), samples_to(max_range)))

    def raw(self, config, samples):
        """Returns the signals of the receivers, as the controller computes and stores them."""
        signal, transmitter = config["system"].signal, config["system"].transmitter
        t = np.arange(samples + int(np.ceil(signal.duration * 1.1 * SAMPLE_RATE))) / SAMPLE_RATE
        common = simple_points.CommonSettings(
            f=np.fft.fftshift(np.fft.fftfreq(len(t), 1 / SAMPLE_RATE)) + case.FREQUENCY,
            S=np.fft.fftshift(np.fft.fft(signal.sample(t, case.FREQUENCY), norm="forward")),
            signal_frequency_bounds=(signal.minimum_frequency, signal.maximum_frequency), baseband_frequency=case.FREQUENCY,
            travel_time=config["travel_time"], trajectory=config["trajectory"], environment=config["environment"],
            tx_position=transmitter.position, tx_ori=transmitter.orientation.ndarray,
            emitted_distortion=transmitter.distortion, echo_distortion=config["echo_distortion"])

        def received(receiver):
            settings = simple_points.ChunkSettings(
                ping_time=0.0, rx_position=receiver.position, rx_ori=receiver.orientation.ndarray, rx_distortion=receiver.distortion,
                max_t=samples / SAMPLE_RATE)
            chunks = simple_points.target_chunk_iterator(config["targets"], CHUNK)
            spectrum = sum(simple_points.point_simulation_chunk(chunk, (common, settings)) for chunk in chunks)
            return np.fft.ifft(np.fft.ifftshift(spectrum), norm="forward")[:samples]
        for target in config["targets"]:
            target.prepare()
        return np.array(list(self.pool.map(received, config["system"].receivers)))

    def controlled(self, config, samples):
        """Returns the same by the controller and a Dask cluster of one process."""
        out = self.folder / "raw"
        shutil.rmtree(f"{out}.zarr", ignore_errors=True)
        Path(f"{out}.npz").unlink(missing_ok=True)
        cluster = loader.dask_cluster({"name": "local", "parameters": {"workers": 1, "total_memory": 0.25, "dashboard_address": None}})
        cluster.initialise()
        controller = loader.controller({"name": "simple_points", "parameters": {
            "result_filename": f"{out}.zarr", "points_per_chunk": CHUNK, "sample_rate": SAMPLE_RATE,
            "baseband_frequency": case.FREQUENCY, "max_samples": samples}})
        controller.run({**config, "dask_cluster": cluster, "result_converter": loader.result_converter(
            {"name": "numpy", "parameters": {"filename": f"{out}.npz", "compress": False}})})
        cluster.terminate()
        with np.load(f"{out}.npz") as found:
            return found["pressure"][0]

    def compressed(self, raw):
        count = raw.shape[-1]
        chirp = self.signal().sample(np.arange(count) / SAMPLE_RATE, case.FREQUENCY)
        length = 2 * count
        answer = np.fft.fft(raw, length) * np.conj(np.fft.fft(chirp, length))
        return np.fft.ifft(answer)[..., :count] / np.vdot(chirp, chirp).real


def samples_to(max_range):
    """Returns an even number of samples, which reaches beyond the range."""
    return 2 * int(np.ceil((max_range + 1) / case.SOUND_SPEED * SAMPLE_RATE))


def transducer(x):
    return loader.transducer({"name": "generic", "parameters": {"position": [x, 0, 0], "orientation": AHEAD}})


def beams(echoes, elements, ranges, bearings, factor=16):
    """Delay and sum: fields [bearings, ranges] of the mean over the elements, focused at each range."""
    count = echoes.shape[-1]              # even
    spectrum = np.fft.fftshift(np.fft.fft(echoes), axes=-1)
    margin = (factor - 1) * count // 2
    spectrum = np.pad(spectrum, [(0, 0), (margin, (factor - 1) * count - margin)])
    fine = np.fft.ifft(np.fft.ifftshift(spectrum, axes=-1)) * factor
    summed = np.zeros((len(bearings), len(ranges)), complex)
    for k, x in enumerate(elements):
        back = np.sqrt(ranges ** 2 + x ** 2 - 2 * ranges * x * np.sin(bearings)[:, None])
        delay = (ranges + back) / case.SOUND_SPEED
        at = delay * SAMPLE_RATE * factor
        low = np.clip(at.astype(int), 0, fine.shape[-1] - 2)
        part = np.clip(at - low, 0, 1)
        taken = fine[k][low] * (1 - part) + fine[k][low + 1] * part
        summed += taken * np.exp(2j * np.pi * case.FREQUENCY * delay)
    return summed / len(elements)


def point(x, y, z=0.0, reflectivity=1.0):
    return {"name": "single_point", "parameters": {"position": (x, y, z), "reflectivity": reflectivity}}


def floor(seed, depth, width, near, far, density, x=0.0):
    return {"name": "random_point_rectangle", "parameters": {
        "seed": seed, "Dx": width, "Dy": far - near, "centre": (x, (near + far) / 2, depth), "normal": (0, 0, -1),
        "point_density": density, "reflectivity": 1.0}}


def grid(low, high):
    return np.arange(low, high, BEAM_STEP)


def points(sonar):
    ranges, found = grid(9.5, 11), []
    for truth in case.POINTS:
        echoes = sonar.echoes([point(0, truth)], 11.5)
        found.append(np.abs(beams(echoes, [0.0], ranges, np.zeros(1))[0]) ** 2)
    return {"range_m": ranges, "truth_m": case.POINTS, "intensity": np.array(found)}


def beam(sonar):
    echoes = sonar.echoes([point(0, case.BEAM_RANGE)], 11.5, ARRAY)
    field = beams(echoes, ARRAY, np.array([case.BEAM_RANGE]), case.BEAM_BEARINGS)
    return {"bearing_rad": case.BEAM_BEARINGS, "intensity": np.abs(field[:, 0]) ** 2}


def floor_slope(sonar, short):
    low, high = case.FLOOR_RANGES
    reach = np.sqrt((high + 0.5) ** 2 - case.FLOOR_DEPTH ** 2)
    density, count = (5, 2) if short else (15, 40)
    ranges = grid(low, high)
    found = [np.abs(beams(sonar.echoes([floor(101 + i, case.FLOOR_DEPTH, 2 * reach, -reach, reach, density)], high + 1), [0.0], ranges,
                          np.zeros(1))[0]) ** 2 for i in range(count)]
    return {"range_m": ranges, "intensity": np.array(found), "azimuth_rad": 2 * np.pi, "depth_m": case.FLOOR_DEPTH}


def check(sonar):
    """Compares an echo of two points with that of openSTB's controller."""
    config, samples = sonar.config([point(0, 5), point(0.5, 6, 1)], (0.0, 0.03)), samples_to(7)
    expected = sonar.controlled(config, samples)
    assert np.abs(sonar.raw(config, samples) - expected).max() < 1e-9 * np.abs(expected).max()


def lambert_plugin():
    """Intensities that the plugin of Lambertian scattering gives, by grazing angle. No controller of 0.9.0 calls it."""
    model = loader.scattering_model({"name": "lambertian", "parameters": {"scale_factor": 1.0}})
    grazing = np.radians(np.linspace(16, 56, 41))
    towards = np.stack([np.cos(grazing), 0 * grazing, np.sin(grazing)], 1)
    up = np.tile([0.0, 0.0, -1.0], (len(grazing), 1))
    answer = model.apply(np.array([case.FREQUENCY]), np.ones((1, len(grazing)), complex), 0 * grazing, 0 * towards, up, towards,
                         -towards, None, case.FREQUENCY, (0.0, 0.0))
    slope, _ = np.polyfit(np.log(np.sin(grazing)), np.log(np.abs(answer[0]) ** 2), 1)
    return float(slope)


def sphere(sonar):
    """A point whose reflectivity is that of the sphere: there are no surfaces."""
    ranges = grid(9.5, 11)

    def echo(reflectivity):
        field = beams(sonar.echoes([point(0, case.SPHERE_RANGE, 0, reflectivity)], 11.5), [0.0], ranges, np.zeros(1))
        return np.abs(field[0]) ** 2
    return {"intensity": echo(case.SPHERE_RADIUS / 2), "reference": echo(1.0)}


def motion(sonar, short):
    """Places are other points of the floor. The sonar stays at 0, and the floor moves by a shift the other way."""
    low, high = case.MOTION_RANGES
    near, far = (np.sqrt(r ** 2 - case.MOTION_DEPTH ** 2) for r in (low - 0.15, high + 0.15))
    width = 2 * far * np.tan(np.radians(20))                     # five sidelobes: farther sidelobes have 2 % of the energy
    ranges = np.arange(low, high, case.RESOLUTION)
    # Every second element: grating lobes are at 90 degrees, where there are no points.
    density, places, elements = (60, 2, ARRAY[::16]) if short else (1500, case.MOTION_PLACES, ARRAY[::2] + SPACING / 2)
    found, seconds, processor = [], [], []
    for place in range(places):
        rows = []
        for shift in case.MOTION_SHIFTS:
            began = time.perf_counter(), time.process_time()
            targets = [floor(201 + place, case.MOTION_DEPTH, width, near, far, density, -shift)]
            echoes = sonar.echoes(targets, high + 0.3, elements)
            rows.append(np.abs(beams(echoes, elements, ranges, case.MOTION_BEARINGS)) ** 2)
            seconds.append(time.perf_counter() - began[0])
            processor.append(time.process_time() - began[1])
        found.append(rows)
    count = round(width * (far - near) * density)
    return {"range_m": ranges, "shift_m": case.MOTION_SHIFTS, "intensity": np.array(found)}, {"seconds": seconds, "processor": processor}, count


def about(slope, count):
    return {
        "name": "openSTB", "version": version("openstb-simulator"), "python": platform.python_version(),
        "notes": {
            "floor": f"points reflect alike from all sides; its plugin `lambertian`, which no controller calls yet, has {slope:.2f}",
            "sphere": "no surfaces: a point is given the reflectivity a/2",
            "times": f"{count} points, {case.ELEMENTS // 2} receivers; beams are formed by the adapter",
        },
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--short", action="store_true", help="few points, to see that it runs")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    cores = len(os.sched_getaffinity(0))
    sonar = Sonar(options.folder, cores)
    check(sonar)

    def save(name, arrays):
        np.savez(options.folder / f"{name}.npz", **arrays)
    save("points", points(sonar))
    save("beam", beam(sonar))
    save("sphere", sphere(sonar))
    save("floor", floor_slope(sonar, options.short))
    arrays, times, count = motion(sonar, options.short)
    save("motion", arrays)
    save("speckle", {"range_m": arrays["range_m"], "intensity": arrays["intensity"][:, 0]})
    save("times", {**times, "cores": cores})
    (options.folder / "about.json").write_text(json.dumps(about(lambert_plugin(), count), indent=1))


if __name__ == "__main__":
    main()
