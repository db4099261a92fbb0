// Shared by C++ and GLSL: backscatter of a surface beyond Lambert's law, as sigma_b / cos(theta) [1] (ACOUSTICS.md 3.5
// to 3.8). `law` is that of a MaterialRecord. The includer defines double backscatterEntry(uint i), which indexes all
// tables in sequence.

double tabulatedBackscatter(uint table, double cosine) {
    double at = 4096.0 * min(cosine, 0.0625) + 4096.0 / 7.0 * min(max(cosine - 0.0625, 0.0), 0.875) +
                4080.0 * min(max(cosine - 0.9375, 0.0), 0.0625);
    uint i = min(uint(at), uint(BACKSCATTER_ENTRIES - 2));
    double low = backscatterEntry(table * uint(BACKSCATTER_ENTRIES) + i);
    return low + (at - double(i)) * (backscatterEntry(table * uint(BACKSCATTER_ENTRIES) + i + 1u) - low);
}

// Returns sinc^2(beta) up to beta = 3 pi / 4, where beta = k L sin(t) is the phase at the end of a length relative to
// its middle. Beyond it returns the mean, 1 / (2 beta^2), because the interference of both ends varies within a band
// and with the slightest turn. `at`: beta^2 / pi; `edges`: 1 where an echo of edges replaces that mean, else 0
// (ACOUSTICS.md 3.12).
double diffracted(double at, double edges) {
    double beta_square = LOBE_PI * at;
    if (beta_square > 0.5625 * LOBE_PI * LOBE_PI) return (1.0 - edges) * 0.5 / beta_square;
    double sum = 1.0, term = 1.0;
    for (int n = 1; n < 8; ++n) {
        term *= -4.0 * beta_square / double((2 * n + 1) * (2 * n + 2));
        sum += term;
    }
    return sum;
}

// `power`: R^2 / (4 pi). The rough or curved share has slopes; the flat share diffracts.
double lobeOverCosine(double power, LobeSlopes slopes, double cosine) {
    double secant = 1.0 / max(cosine, MIN_LOBE_COSINE), square = secant * secant;
    double at_1 = slopes.sine_1 / slopes.square_1, at_2 = slopes.sine_2 / slopes.square_2;
    double flat_1 = sqrt(slopes.wave_1 / slopes.square_1), flat_2 = sqrt(slopes.wave_2 / slopes.square_2);
    double rough_1 = (1.0 - flat_1) * double(exp(float(-at_1 * square)));
    double rough_2 = (1.0 - flat_2) * double(exp(float(-at_2 * square)));
    double both = rough_1 * rough_2, all = both;
    if (flat_1 + flat_2 > 0.0)
        all = (rough_1 + flat_1 * diffracted(at_1, slopes.edges)) * (rough_2 + flat_2 * diffracted(at_2, slopes.edges));
    return power / sqrt(slopes.square_1 * slopes.square_2) *
           (both * square * square * secant + (all - both) * cosine);
}

// Backscatter of a material with Lambert's parameter mu at a cosine of incidence.
double backscatterOverCosine(vec4 law, double mu, double cosine, LobeSlopes slopes) {
    double section = law.x < 0.0 ? mu * cosine : tabulatedBackscatter(uint(law.x), cosine);
    if (law.y > 0.0) section += lobeOverCosine(double(law.y), slopes, cosine);
    return section;
}

// Returns the mean square slope of a lobe in a principal direction of a facet: that of the micro-relief plus the
// facet's plus half the square of the angle by which the normal turns within a sample. The last term makes the samples
// together cover all of a narrower lobe. `sample_square`: square of the sample's width [rad^2].
double meanSquareSlope(vec4 direction, double relief, double sample_square, double range) {
    double turn = 1.0 + 4.0 * range * double(direction.z);
    return relief + double(direction.x) + double(direction.y) + 0.5 * sample_square * turn * turn;
}

// Returns the slopes of a sample with planeFootprint()'s plane, direction and extent. `axis`: the facet's first
// direction, of any length; `bent`: cosine of a mapped normal, 0: the plane's normal applies.
LobeSlopes lobeSlopes(FacetRecord facet, double relief, double range, double normal_x, double normal_y, double normal_z,
                      double axis_x, double axis_y, double axis_z, double cos_az, double sin_az, double cos_el, double sin_el,
                      double width, double height, double bent) {
    double second_x = normal_y * axis_z - normal_z * axis_y;
    double second_y = normal_z * axis_x - normal_x * axis_z;
    double second_z = normal_x * axis_y - normal_y * axis_x;
    double first_x = second_y * normal_z - second_z * normal_y;
    double first_y = second_z * normal_x - second_x * normal_z;
    double first_z = second_x * normal_y - second_y * normal_x;
    double ahead_1 = first_x * cos_az + first_y * sin_az, ahead_2 = second_x * cos_az + second_y * sin_az;
    double aside_1 = first_y * cos_az - first_x * sin_az, aside_2 = second_y * cos_az - second_x * sin_az;
    double up_1 = first_z * cos_el - ahead_1 * sin_el, up_2 = second_z * cos_el - ahead_2 * sin_el;
    double along_1 = ahead_1 * cos_el + first_z * sin_el, along_2 = ahead_2 * cos_el + second_z * sin_el;
    double across_1 = aside_1 * aside_1 + up_1 * up_1 + MIN_ACROSS, across_2 = aside_2 * aside_2 + up_2 * up_2 + MIN_ACROSS;
    double facing = ((normal_x * cos_az + normal_y * sin_az) * cos_el + normal_z * sin_el) /
                    sqrt(normal_x * normal_x + normal_y * normal_y + normal_z * normal_z);
    double cosine_square = max(facing * facing, MIN_LOBE_COSINE * MIN_LOBE_COSINE);
    LobeSlopes slopes;
    double wide = width * width, high = height * height;
    slopes.square_1 = meanSquareSlope(
        facet.first, relief, (wide * aside_1 * aside_1 + high * (up_1 * up_1 + MIN_ACROSS)) / across_1, range);
    slopes.square_2 = meanSquareSlope(
        facet.second, relief, (wide * aside_2 * aside_2 + high * (up_2 * up_2 + MIN_ACROSS)) / across_2, range);
    slopes.sine_1 = along_1 * along_1 / (along_1 * along_1 + across_1);
    double bow = min(slopes.sine_1 / cosine_square, 4.0 * slopes.square_1);
    double sine_2 = along_2 / sqrt(along_2 * along_2 + across_2) - (double(facet.first.w) + double(facet.second.w) * bow) * facing;
    slopes.sine_2 = sine_2 * sine_2;
    if (bent > 0.0) {
        double share = (slopes.sine_1 + MIN_SINE_SQUARE) / (slopes.sine_1 + slopes.sine_2 + 2.0 * MIN_SINE_SQUARE);
        slopes.sine_1 = share * max(1.0 - bent * bent, 0.0);
        slopes.sine_2 = (1.0 - share) * max(1.0 - bent * bent, 0.0);
    }
    slopes.wave_1 = double(facet.first.y);
    slopes.wave_2 = double(facet.second.y);
    slopes.edges = double(facet.axis.w);
    return slopes;
}
