// Shared by C++ and GLSL: what a ray through (u, v) of a frustum's picture meets on a triangle's plane.

struct Surface {
    double range, inverse_range;  // slant range [m], and 1 / range; both 0: no echo (edge-on, or behind)
    double slope_u, slope_v;      // d(1/range)/du and /dv [1/m]
    double nearest;               // 1 / perpendicular distance: no point of the plane is nearer [1/m]
    double cosine;                // of the angle between ray and geometric normal, either side [1]
};

// Plane normal.p = distance in frustum axes (x into the picture, y to port, z up); the normal may have any length and sign.
// Slopes: ACOUSTICS.md 4.2. Closer to edge-on than 1e-4 rad there is no echo, but still a shadow.
Surface surfaceAt(double normal_x, double normal_y, double normal_z, double distance, double u, double v) {
    double q2 = 1.0 + u * u + v * v;
    double facing = normal_x + normal_y * u + normal_z * v;
    Surface surface;
    double q = sqrt(q2);
    double normal = sqrt(normal_x * normal_x + normal_y * normal_y + normal_z * normal_z);
    surface.cosine = abs(facing) / (q * normal);
    bool echo = surface.cosine > 0.0001 && distance * facing > 0.0;
    double per_facing = echo ? 1.0 / facing : 0.0;
    double per_q2 = 1.0 / q2;
    surface.range = distance * per_facing * q;
    surface.inverse_range = echo ? 1.0 / surface.range : 0.0;
    surface.slope_u = (normal_y * per_facing - u * per_q2) * surface.inverse_range;
    surface.slope_v = (normal_z * per_facing - v * per_q2) * surface.inverse_range;
    surface.nearest = echo ? normal / abs(distance) : 0.0;
    return surface;
}
