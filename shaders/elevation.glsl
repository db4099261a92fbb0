// Shared by C++ and GLSL: the two-way pattern at the elevation of a ray through (u, v) of a frustum's picture. The
// table elevationPower(0) to elevationPower(ELEVATION_STEPS) is evenly spaced in the sine of elevation, from
// -elevation_reach to elevation_reach.
double elevationWeight(double u, double v) {
    double sine = v / sqrt(1.0 + u * u + v * v);
    double at = 0.5 * double(ELEVATION_STEPS) * (1.0 + sine / elevation_reach);
    at = min(max(at, 0.0), double(ELEVATION_STEPS));
    uint i = min(uint(at), uint(ELEVATION_STEPS - 1));
    double part = at - double(i);
    return elevationPower(i) * (1.0 - part) + elevationPower(i + 1u) * part;
}
