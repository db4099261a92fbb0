"""What every simulator of scripts/research/peers is asked for: one sonar, and one scene for each row of the sheet.

The sonar has one transmitter without directivity and a straight array of elements half a wavelength apart. Lengths are in metres."""
import numpy as np

SOUND_SPEED = 1500.0                      # [m/s]
FREQUENCY = 300e3                         # [Hz]
BANDWIDTH = 30e3                          # [Hz], of a chirp behind its matched filter without a window
WAVELENGTH = SOUND_SPEED / FREQUENCY
ELEMENTS = 32
APERTURE = ELEMENTS * WAVELENGTH / 2
RESOLUTION = SOUND_SPEED / (2 * BANDWIDTH)  # in range

POINTS = 10 + RESOLUTION * np.arange(9) * 0.137       # ranges of a point target, at nine parts of a bin
BEAM_RANGE = 10.0                         # range of the point target that the beam is turned past [m]
BEAM_BEARINGS = np.radians(np.arange(-200, 201) / 10)
FLOOR_DEPTH = 5.0                         # depth of the floor below the sonar [m]
FLOOR_RANGES = (6.0, 18.0)                # slant ranges at which the slope is fitted: grazing angles of 56 to 16 degrees
SPHERE_RADIUS, SPHERE_RANGE = 0.25, 10.0  # a sphere that reflects all; its nearest point is at this range [m]
MOTION_SHIFTS = APERTURE * np.array([0, 0.05, 0.1464, 0.3, 0.45])   # along the array
MOTION_DEPTH = 3.0                        # depth of the floor below the sonar [m]
MOTION_RANGES = (5.5, 7.5)
MOTION_BEARINGS = np.arcsin(np.array([-1, 0, 1]) * WAVELENGTH / APERTURE)     # apart by the first null
MOTION_PLACES = 4                         # patches of floor that the correlation is a mean over

EXPERIMENTS = {
    "points": "range_m [bins], truth_m [targets], intensity [targets, bins]",
    "beam": "bearing_rad [directions], intensity [directions]: of a point target straight ahead",
    "floor": "range_m [bins], intensity [pings, bins]; azimuth_rad and depth_m of the floor that they are of",
    "sphere": "intensity [bins] of the sphere, reference [bins] of a point target of 0 dB at the sphere's nearest point",
    "speckle": "range_m [bins], intensity [pings, beams, bins]: of the floor, from places that have nothing in common",
    "motion": "shift_m [shifts], intensity [places, shifts, beams, bins]",
    "times": "seconds and processor [pings]: times of the pings of `motion` by the clock and of all threads; cores",
}
