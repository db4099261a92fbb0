// Shared by C++ and GLSL: one cell's echo, spread over the bins that its footprint covers.
// The includer defines, before this file:
//     double binEdge(uint k);                      1 / range of edge k [1/m]; edge 0 is the near blanking, edge n the far end
//     void addToBin(uint beam, uint bin, double amount, double weight);
//     uint bin_count; double bin_width [m], attenuation (amplitude, one way, cerqueira2017) [Np/m]

// S of cerqueira2017; x = reflectivity cos(theta), attenuated.
double cerqueiraEcho(double x) { return 0.5 + 0.5 * double(tanh(float(9.0 * (x - 2.0 / 3.0)))); }

// What the includer's addToBin is told: `amount` is, for `physical`, the part's energy times the square of the bin's
// central range; for cerqueira2017 it is S weighted by the part's size `weight`. Both are relative to one whole pixel.
void depositPart(uint beam, uint bin, double share, double inverse_range, double range, double strength) {
#ifdef HAVE_CERQUEIRA2017
    double cosine = min(strength * inverse_range * range, 1.0);
    double echo = cerqueiraEcho(cosine * double(exp(float(-2.0 * attenuation / inverse_range))));
    addToBin(beam, bin, share * echo, share);
#else
    // On a plane cos(theta) goes as 1/r, so the density over inverse range goes as its cube.
    double bin_range = (double(bin) + 0.5) * bin_width;
    double cube = inverse_range * inverse_range * inverse_range;
    addToBin(beam, bin, strength * share * cube * range * bin_range * bin_range, 0.0);
#endif
}

// No part goes beyond [far_limit, near_limit], the inverse ranges of the object: a facet seen edge-on is steep, not long.
// `scale` = 1 / solid angle of a whole pixel at the picture's centre.
void depositCell(Footprint cell, uint beam, double range, double strength, double scale, double near_limit, double far_limit) {
    double wide = max(cell.wide, 1e-12 * abs(cell.centre));
    double half_length = 0.5 * (wide + cell.narrow);
    double near_end = min(min(cell.centre + half_length, near_limit), binEdge(0u));
    double far_end = max(max(cell.centre - half_length, far_limit), binEdge(bin_count));
    if (!(near_end > far_end)) return;
    uint bin = min(uint(1.0 / (near_end * bin_width)), bin_count - 1u);
    while (bin > 0u && binEdge(bin) < near_end) --bin;
    while (binEdge(bin + 1u) >= near_end) ++bin;
    double size = cell.solid_angle * scale;
    double above = near_end;
    double below_above = trapezoidBelow(near_end - cell.centre, wide, cell.narrow);
    for (; above > far_end; ++bin) {
        double below = max(binEdge(bin + 1u), far_end);
        double below_below = trapezoidBelow(below - cell.centre, wide, cell.narrow);
        depositPart(beam, bin, size * (below_above - below_below), 0.5 * (above + below), range, strength);
        above = below;
        below_above = below_below;
    }
}
