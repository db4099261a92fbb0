// Shared by C++ and GLSL: what a surface gives back beyond Lambert's law, as sigma_b / cos(theta) [1] (ACOUSTICS.md 3.5 to
// 3.8). `law` is that of a MaterialRecord. The includer defines double backscatterEntry(uint i), of tables one after another.

double tabulatedBackscatter(uint table, double cosine) {
    double at = min(cosine, 1.0) * double(BACKSCATTER_ENTRIES - 1);
    uint i = min(uint(at), uint(BACKSCATTER_ENTRIES - 2));
    double low = backscatterEntry(table * uint(BACKSCATTER_ENTRIES) + i);
    return low + (at - double(i)) * (backscatterEntry(table * uint(BACKSCATTER_ENTRIES) + i + 1u) - low);
}

// `power`: R^2 / (4 pi).
double lobeOverCosine(double power, double mean_square_slope, double cosine) {
    double secant = 1.0 / max(cosine, MIN_LOBE_COSINE);
    double square = secant * secant;
    double part = double(exp(float((1.0 - square) / mean_square_slope)));
    return power / mean_square_slope * part * square * square * secant;
}

// Of a material with Lambert's parameter mu at a cosine; `mean_square_slope` is what facets and the sample's size add to that
// of the micro-relief.
double backscatterOverCosine(vec4 law, double mu, double cosine, double mean_square_slope) {
    double section = law.x < 0.0 ? mu * cosine : tabulatedBackscatter(uint(law.x), cosine);
    if (law.y > 0.0) section += lobeOverCosine(double(law.y), double(law.z) + mean_square_slope, cosine);
    return section;
}

// What a sample that is `angle` wide adds [rad]: half its square, so that neighbouring samples together catch all of a lobe
// that is narrower than they are.
double slopeOfSample(double angle) { return 0.5 * angle * angle; }
