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

// A vector, in axes with z up at elevation 90 degrees.
struct Axis {
    double x, y, z;
};

Axis cross(Axis a, Axis b) { return Axis(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }

// How a sonar sees a sample of a facet: planeFootprint()'s plane, direction and extent.
struct LobeView {
    Axis normal, axis;                      // of the facet, any length; `axis` is its first principal direction
    double range;                           // [m]
    double cos_az, sin_az, cos_el, sin_el;  // direction of the sample's middle
    double width, height;                   // [rad]
    double mapped;                          // cosine of a mapped normal; 0: the plane's normal applies
};

// A principal direction of a facet in a view, times its length: away from the sonar, and square of the rest.
struct SeenAxis {
    double along, across;
    double sample_square;  // square of the sample's width in this direction [rad^2]
};

SeenAxis seenAxis(Axis axis, LobeView view) {
    double ahead = axis.x * view.cos_az + axis.y * view.sin_az;
    double aside = axis.y * view.cos_az - axis.x * view.sin_az;
    double up = axis.z * view.cos_el - ahead * view.sin_el;
    double across = aside * aside + up * up + MIN_ACROSS;
    double wide = view.width * view.width, high = view.height * view.height;
    return SeenAxis(ahead * view.cos_el + axis.z * view.sin_el, across,
                    (wide * aside * aside + high * (up * up + MIN_ACROSS)) / across);
}

// Returns the mean square slope of a lobe in a principal direction of a facet: that of the micro-relief plus the
// facet's plus half the square of the angle by which the normal turns within a sample. The last term makes the samples
// together cover all of a narrower lobe.
double meanSquareSlope(vec4 direction, double relief, double sample_square, double range) {
    double turn = 1.0 + 4.0 * range * double(direction.z);
    return relief + double(direction.x) + double(direction.y) + 0.5 * sample_square * turn * turn;
}

struct LobeSines {
    double first, second;
};

// Returns the squares of the sines of the incidence along both principal directions; `square_1`: mean square slope along
// the first, which bounds by how much the curved facet bows.
LobeSines lobeSines(FacetRecord facet, LobeView view, SeenAxis first, SeenAxis second, double square_1) {
    double facing = ((view.normal.x * view.cos_az + view.normal.y * view.sin_az) * view.cos_el + view.normal.z * view.sin_el) /
                    sqrt(view.normal.x * view.normal.x + view.normal.y * view.normal.y + view.normal.z * view.normal.z);
    double cosine_square = max(facing * facing, MIN_LOBE_COSINE * MIN_LOBE_COSINE);
    double sine_1 = first.along * first.along / (first.along * first.along + first.across);
    double bow = min(sine_1 / cosine_square, 4.0 * square_1);
    double of_plane = second.along / sqrt(second.along * second.along + second.across);
    double sine_2 = of_plane - (double(facet.first.w) + double(facet.second.w) * bow) * facing;
    double square_2 = sine_2 * sine_2;
    if (!(view.mapped > 0.0)) return LobeSines(sine_1, square_2);
    double share = (sine_1 + MIN_SINE_SQUARE) / (sine_1 + square_2 + 2.0 * MIN_SINE_SQUARE);
    double sine_square = max(1.0 - view.mapped * view.mapped, 0.0);
    return LobeSines(share * sine_square, (1.0 - share) * sine_square);
}

// Returns the slopes of a facet's lobe in a sample, for a micro-relief of a mean square slope. For example, a level plate
// (normal 0 0 1, axis 1 0 0) seen from straight above has sines 0 and the squares of the relief and the sample.
LobeSlopes lobeSlopes(FacetRecord facet, double relief, LobeView view) {
    Axis second_axis = cross(view.normal, view.axis);
    SeenAxis first = seenAxis(cross(second_axis, view.normal), view), second = seenAxis(second_axis, view);
    LobeSlopes slopes;
    slopes.square_1 = meanSquareSlope(facet.first, relief, first.sample_square, view.range);
    slopes.square_2 = meanSquareSlope(facet.second, relief, second.sample_square, view.range);
    LobeSines sines = lobeSines(facet, view, first, second, slopes.square_1);
    slopes.sine_1 = sines.first;
    slopes.sine_2 = sines.second;
    slopes.wave_1 = double(facet.first.y);
    slopes.wave_2 = double(facet.second.y);
    slopes.edges = double(facet.axis.w);
    return slopes;
}
