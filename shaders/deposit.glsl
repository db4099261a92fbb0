// Shared by C++ and GLSL: spreads one cell's echo over the bins that its footprint covers.
// The includer includes footprint.glsl and trapezoid.glsl before this file, and defines:
//     double binEdge(uint k);                      place of edge k [1/m]; edge 0 is the near blanking, edge n the far end
//     uint findBin(double place);                    the bin that contains a place in range, up to rounding
//     void addToBin(uint beam, uint bin, double amount, double weight);
//     uint bin_count; double bin_width [m], attenuation (amplitude, one way, cerqueira2017) [Np/m]

#ifdef HAVE_CERQUEIRA2017
// S of cerqueira2017; x = reflectivity cos(theta), attenuated.
double cerqueiraEcho(double x) { return 1.0 / (1.0 + double(exp(float(12.0 - 18.0 * x)))); }
#endif

#ifdef HAVE_ABSORPTION
// A cosine after two-way absorption.
double attenuated(double cosine, double range) { return cosine * double(exp(float(-2.0 * attenuation * range))); }
#endif

// Adds the part of a cell between two inverse ranges to a bin: `amount` is, for `physical`,
// partEnergy; for cerqueira2017 it is S weighted by the part's size `weight`.
void depositPart(Footprint cell, uint beam, uint bin, double share, double above, double below, double strength_range) {
#ifdef HAVE_CERQUEIRA2017
    double inverse_range = 0.5 * (above + below);
    double cosine = min(strength_range * (inverse_range - cell.fade * cell.fade / inverse_range), 1.0);
#ifdef HAVE_ABSORPTION
    cosine = attenuated(cosine, 1.0 / inverse_range);
#endif
    addToBin(beam, bin, cell.size * share * cerqueiraEcho(cosine), cell.size * share);
#endif
#ifdef HAVE_PHYSICAL
    double middle = (double(bin) + 0.5) * bin_width;
    addToBin(beam, bin, cell.limb > 0.0 ? limbEnergy(cell, strength_range, share, middle, above, below)
                                        : partEnergy(cell, strength_range, share, middle, above, below), 0.0);
#endif
}

// Share of a cell up to an inverse range, plus a constant of the cell.
double shareAt(Footprint cell, double inverse_range) {
    return cell.limb > 0.0 ? limbShare(cell, inverse_range) : trapezoidShare(cell, inverse_range - cell.centre);
}
// The share that the nearest point cuts off is deposited at that point; the shares that object, blanking and range cut
// off are lost.
double firstShare(Footprint cell, double inverse_range) {
    if (inverse_range < cell.nearest) return shareAt(cell, inverse_range);
    if (!(cell.limb > 0.0)) return 0.5;
    return limbShare(cell, inverse_range) + 0.5 - trapezoidShare(cell, getPlace(cell, inverse_range) - cell.centre);
}

#ifdef HAVE_PUBLISHED
// cerqueira2017 exactly as published (ACOUSTICS.md 8.2, items 3, 4): each pixel counts once, in the bin of its centre.
// A pixel without an echo in range counts in bin 0 with a cosine of 0.
void depositCell(Footprint cell, uint beam, double strength_range) {
    double range = cell.pixel > 0.0 ? 1.0 / cell.pixel : 0.0;
#ifdef GLSL
    bool received = range > 0.0 && pixel_place >= binEdge(bin_count - 1u);
    uint bin = received ? findBin(pixel_place) : 0u;
#else
    bool received = range > 0.0 && range <= double(bin_count - 1u) * bin_width;
    uint bin = received ? uint(range / bin_width) : 0u;
#endif
    double cosine = received ? min(strength_range * cell.pixel, 1.0) : 0.0;
#ifdef HAVE_ABSORPTION
    cosine = attenuated(cosine, range);
#endif
    addToBin(beam, bin, cerqueiraEcho(cosine), 1.0);
}
#elif defined(HAVE_NEAREST)
// Deposits a whole cell in one bin, that of a point in its pixel.
void depositCell(Footprint cell, uint beam, double strength_range) {
#ifdef GLSL
    double place = pixel_place;
#else
    double place = cell.pixel;
#endif
    if (!(cell.pixel > 0.0 && place > binEdge(bin_count)) || place > binEdge(0u)) return;
    uint bin = findBin(place);
    double relative = (double(bin) + 0.5) * bin_width * cell.pixel;
    addToBin(beam, bin, strength_range * cell.size * cell.pixel * relative * relative, 0.0);
}
#else
// `strength_range` = strength times slant range [m].
void depositCell(Footprint cell, uint beam, double strength_range) {
    if (!(cell.near_end > cell.far_end && strength_range >= 0.0)) return;  // false for NaN
    uint bin = findBin(cell.near_end);
    while (bin > 0u && binEdge(bin) < cell.near_end) --bin;
    while (binEdge(bin + 1u) >= cell.near_end) ++bin;
    double above = cell.near_end;
#ifdef GLSL
    for (; above > cell.far_end; ++bin) {
        double below = max(binEdge(bin + 1u), cell.far_end);
        double to = above < cell.nearest ? above : cell.centre + cell.wide;
        double share = partShare(cell, below - cell.centre, to - cell.centre, computeLength(bin, below, to));
        depositPart(cell, beam, bin, share, inverseRange(above), inverseRange(below), strength_range);
        above = below;
    }
#else
    double share_above = firstShare(cell, above);
    for (; above > cell.far_end; ++bin) {
        double below = max(binEdge(bin + 1u), cell.far_end);
        double share_below = shareAt(cell, below);
        depositPart(cell, beam, bin, share_above - share_below, above, below, strength_range);
        above = below;
        share_above = share_below;
    }
#endif
}
#endif
