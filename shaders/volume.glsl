// Shared by C++ and GLSL: volume reverberation as changes over range, which are accumulated from bin to bin afterwards
// (ACOUSTICS.md 3.9). The includer includes footprint.glsl before this file, and defines:
//     void addVolume(uint beam, uint bin, double amount);  // of either sign; with layers also the bin behind the last bin
//     uint bin_count; double bin_width [m]
// and with HAVE_VOLUME_LAYERS:
//     uint layer_count; double layerNumber(uint i);        // three each: low and high above the surface [m], share [1]
//     double sonar_height;                                 // above the surface [m]

// A change of the volume reverberation from a bin on: `here`, of which the bins from the next on have `behind` as well.
// A bin of bin_count or more: none.
struct VolumeChange {
    uint bin;
    double here, behind;
};

// Returns the change by `amount` from `range` on. Layers split it between two bins by its place, because all rays enter a
// layer close to each other. Without layers the change is at the nearest edge of a bin, because the echo of a surface is
// louder than the volume that it hides.
VolumeChange volumeChange(double range, double amount) {
#ifdef HAVE_VOLUME_LAYERS
    double at = range / bin_width;
    uint bin = uint(min(at, double(bin_count)));
    double rest = double(bin + 1u) - at;
    return VolumeChange(bin, amount * rest, amount * (1.0 - rest));
#else
    double at = range / bin_width + 0.5;
    return VolumeChange(uint(min(at, double(bin_count))), amount, 0.0);
#endif
}

#ifdef HAVE_VOLUME_LAYERS
// The part of a ray in a layer [m]; none where it does not end behind its beginning.
struct LayerStretch {
    double enters, leaves;
};

// `rise`: metres up per metre of ray; `end`: where the ray ends [m].
LayerStretch layerStretch(uint layer, double rise, double end) {
    double low = layerNumber(3u * layer) - sonar_height, high = layerNumber(3u * layer + 1u) - sonar_height;
    double slope = abs(rise) > MIN_RISE ? rise : MIN_RISE;
    double at_low = low / slope, at_high = high / slope;
    return LayerStretch(max(min(at_low, at_high), 0.0), min(max(at_low, at_high), end));
}
#endif

// A cell that covers several bins ends the volume reverberation behind its surface in up to four parts.
double countVolumeParts(Footprint cell) {
    double depth = cell.wide + cell.narrow, of_a_bin = bin_width * cell.pixel * cell.pixel;
    double several = depth < 2.0 * of_a_bin ? 2.0 : 4.0;
    return depth < of_a_bin ? 1.0 : several;
}

// Returns the inverse range of the surface in a part of a cell [1/m]; not more than 0: none.
double inverseAtPart(Footprint cell, double part, double parts) {
    double depth = cell.wide + cell.narrow;
    double place = min(inverseAt(cell.limb, cell.centre + ((part + 0.5) / parts - 0.5) * depth), cell.nearest);
    double in_reach = min(max(place, cell.far_end), cell.near_end);
    return inverseRange(cell.near_end > cell.far_end ? in_reach : place);
}

#ifdef GLSL
void changeVolume(uint beam, double range, double amount) {
    VolumeChange change = volumeChange(range, amount);
    if (change.bin >= bin_count) return;
    addVolume(beam, change.bin, change.here);
#ifdef HAVE_VOLUME_LAYERS
    addVolume(beam, change.bin + 1u, change.behind);
#endif
}

#ifdef HAVE_VOLUME_LAYERS
// Adds the reverberation of each layer from the ray's entry to its exit or `end`.
void addLayers(uint beam, double rise, double end, double amount) {
    for (uint i = 0u; i < layer_count; ++i) {
        LayerStretch ray = layerStretch(i, rise, end);
        if (!(ray.enters < ray.leaves)) continue;
        changeVolume(beam, ray.enters, amount * layerNumber(3u * i + 2u));
        changeVolume(beam, ray.leaves, -amount * layerNumber(3u * i + 2u));
    }
}
#endif

// Ends the volume reverberation behind the surface that a cell of a solid angle `size` meets.
void hideVolume(Footprint cell, uint beam, double rise, double size) {
    double parts = countVolumeParts(cell), per_parts = 1.0 / parts;
    for (double part = 0.0; part < parts; part += 1.0) {
        double inverse_range = inverseAtPart(cell, part, parts);
        if (!(inverse_range > 0.0)) continue;
#ifdef HAVE_VOLUME_LAYERS
        addLayers(beam, rise, 1.0 / inverse_range, size * per_parts);
#else
        changeVolume(beam, 1.0 / inverse_range, -size * per_parts);
#endif
    }
}
#endif
