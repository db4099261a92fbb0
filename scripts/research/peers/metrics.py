"""Figures of a simulated sonar against closed forms, from the arrays that case.EXPERIMENTS lists. Needs numpy alone."""
import numpy as np


def peak(x, intensity):
    """Returns the place of the largest intensity, by a parabola through its level and those of its neighbours."""
    at = int(np.clip(np.argmax(intensity), 1, len(x) - 2))
    a, b, c = 10 * np.log10(np.maximum(intensity[at - 1:at + 2], 1e-300))
    curvature = a - 2 * b + c
    return x[at] + (0.5 * (a - c) / curvature if curvature < 0 else 0.0) * (x[1] - x[0])


def range_error(range_m, intensity, truth_m):
    """Returns the largest error of the ranges of point targets [m]."""
    return max(abs(peak(range_m, each) - truth) for each, truth in zip(intensity, truth_m))


def beam_width(bearing_rad, intensity):
    """Returns the width between the half-power points about the largest intensity [rad]."""
    level = intensity / intensity.max()
    at = int(np.argmax(level))
    right = at + int(np.argmax(level[at:] < 0.5))
    left = at - int(np.argmax(level[at::-1] < 0.5))

    def crossing(i, j):
        return np.interp(0.5, [level[j], level[i]], [bearing_rad[j], bearing_rad[i]])
    return crossing(right - 1, right) - crossing(left + 1, left)


def first_sidelobe(intensity):
    """Returns the higher of the two first sidelobes, relative to the largest intensity [dB]; -inf without a sidelobe."""
    at = int(np.argmax(intensity))
    found = [0.0]
    for side in (intensity[at:], intensity[at::-1]):
        rising = np.flatnonzero(np.diff(side) > 0)
        if len(rising):
            beyond = side[rising[0]:]
            falling = np.flatnonzero(np.diff(beyond) < 0)
            found.append(beyond[falling[0] if len(falling) else -1])
    with np.errstate(divide="ignore"):
        return float(10 * np.log10(max(found) / intensity[at]))


def floor_slope(range_m, intensity, depth_m, limits, groups=12):
    """Returns the exponent n of a flat floor whose backscatter is proportional to sin(grazing)^n, and its standard error.

    A ring of the floor has an area proportional to the range, and spreading takes range^4. Means of `groups` equal parts of
    the ranges are fitted, so that speckle averages out before the logarithm."""
    inside = (range_m >= limits[0]) & (range_m <= limits[1])
    strength = np.mean(intensity, axis=0)[inside] * range_m[inside] ** 3
    parts = np.array_split(np.arange(inside.sum()), groups)
    level = np.log([strength[part].mean() for part in parts])
    sine = np.log([(depth_m / range_m[inside][part]).mean() for part in parts])
    (slope, _), covariance = np.polyfit(sine, level, 1, cov=True)
    return float(slope), float(np.sqrt(covariance[0, 0]))


def target_strength(intensity, reference):
    """Returns the strength of a target [dB], given the echo of a point target of 0 dB at the same range."""
    return float(10 * np.log10(intensity.sum() / reference.sum()))


def normalised(intensity):
    """Intensities over their mean at the same beam and range, over all pings and, in range, over the 32 bins about each."""
    mean = intensity.mean(axis=0)
    window = np.ones(33) / 33
    count = np.convolve(np.ones(mean.shape[-1]), window, "same")
    smooth = np.apply_along_axis(lambda row: np.convolve(row, window, "same") / count, -1, mean)
    return intensity / smooth


def contrast(intensity):
    """Returns standard deviation over mean of normalised intensities: 1 where they are exponential (Rayleigh amplitudes)."""
    level = normalised(intensity)
    return float(level.std() / level.mean())


def distance_to_exponential(intensity):
    """Returns the largest difference of the distribution of normalised intensities from the exponential one (Kolmogorov)."""
    level = np.sort((lambda x: x / x.mean())(normalised(intensity).ravel()))
    law = 1 - np.exp(-level)
    steps = np.arange(len(level) + 1) / len(level)
    return float(max(np.abs(steps[1:] - law).max(), np.abs(steps[:-1] - law).max()))


def correlations(intensity):
    """Returns the correlation of the intensities of each shift with those of the first, [places, shifts, beams, bins]."""
    level = np.stack([normalised(each) for each in np.moveaxis(intensity, 1, 0)])
    level -= level.mean(axis=tuple(range(1, level.ndim)), keepdims=True)
    flat = level.reshape(len(level), -1)
    return (flat @ flat[0]) / np.sqrt((flat ** 2).sum(1) * (flat[0] ** 2).sum())


def aperture_correlation(shift_m, aperture_m):
    """The closed form (van Cittert and Zernike): square of the overlap of a receiving aperture with itself at twice the way,
    since the transmitter moves too."""
    return np.maximum(1 - 2 * np.abs(shift_m) / aperture_m, 0) ** 2
