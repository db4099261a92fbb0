// Shared by C++ and GLSL: volume reverberation as changes over range, which are accumulated from bin to bin afterwards
// (ACOUSTICS.md 3.9). The includer includes footprint.glsl before this file, and defines:
//     void addVolume(uint beam, uint bin, double amount);  // of either sign; with layers also the bin behind the last bin
//     uint bin_count; double bin_width [m]
// and with HAVE_VOLUME_LAYERS:
//     uint layer_count; double layerNumber(uint i);        // three each: low and high above the surface [m], share [1]
//     double sonar_height;                                 // above the surface [m]

// Changes the volume reverberation of a beam by `amount` from `range` on. Layers split the change between two bins by
// its place, because all rays enter a layer close to each other. Without layers the change is at the nearest edge of a
// bin, because the echo of a surface is louder than the volume that it hides.
void changeVolume(uint beam, double range, double amount) {
#ifdef HAVE_VOLUME_LAYERS
    double at = range / bin_width;
    if (!(at < double(bin_count))) return;
    double rest = double(uint(at) + 1u) - at;
    addVolume(beam, uint(at), amount * rest);
    addVolume(beam, uint(at) + 1u, amount * (1.0 - rest));
#else
    double at = range / bin_width + 0.5;
    if (at < double(bin_count)) addVolume(beam, uint(at), amount);
#endif
}

#ifdef HAVE_VOLUME_LAYERS
// Adds the reverberation of each layer from the ray's entry to its exit or `end`. `rise`: metres up per metre of ray.
void addLayers(uint beam, double rise, double end, double amount) {
    for (uint i = 0u; i < layer_count; ++i) {
        double low = layerNumber(3u * i) - sonar_height, high = layerNumber(3u * i + 1u) - sonar_height;
        double slope = abs(rise) > MIN_RISE ? rise : MIN_RISE;
        double enters = max(min(low / slope, high / slope), 0.0), leaves = min(max(low / slope, high / slope), end);
        if (!(enters < leaves)) continue;
        changeVolume(beam, enters, amount * layerNumber(3u * i + 2u));
        changeVolume(beam, leaves, -amount * layerNumber(3u * i + 2u));
    }
}
#endif

// Ends the volume reverberation behind the surface that a cell of a solid angle `size` meets. A cell that covers
// several bins ends it in up to four parts.
void hideVolume(Footprint cell, uint beam, double rise, double size) {
    double depth = cell.wide + cell.narrow, of_a_bin = bin_width * cell.pixel * cell.pixel;
    uint parts = depth < of_a_bin ? 1u : depth < 2.0 * of_a_bin ? 2u : 4u;
    double per_parts = 1.0 / double(parts);
    for (uint part = 0u; part < parts; ++part) {
        double place = min(inverseAt(cell.limb, cell.centre + ((double(part) + 0.5) * per_parts - 0.5) * depth), cell.nearest);
        if (cell.near_end > cell.far_end) place = min(max(place, cell.far_end), cell.near_end);
        double inverse_range = inverseRange(place);
        if (!(inverse_range > 0.0)) continue;
#ifdef HAVE_VOLUME_LAYERS
        addLayers(beam, rise, 1.0 / inverse_range, size * per_parts);
#else
        changeVolume(beam, 1.0 / inverse_range, -size * per_parts);
#endif
    }
}
