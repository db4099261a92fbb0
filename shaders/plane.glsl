// Shared by C++ and GLSL: the part of a plane that a cell of azimuth and elevation covers. The includer includes
// footprint.glsl before this file.

// The extent in inverse range of a cell of azimuth and elevation on a plane normal.p = distance. n.d / D is linear in
// both angles except for the curvature of sine and cosine. `ahead`, `aside`: components of the normal along and across
// the azimuth of the cell's middle. `width`, `height` [rad]; `lean`: dazimuth / delevation of the cell's sides.
struct PlaneExtent {
    double sag;            // 1/r is a sinusoid of either angle: its mean over the cell is a little less than in the middle
    double along, across;  // lengths of the two boxes
};
PlaneExtent planeExtent(double ahead, double aside, double normal_z, double cos_el, double sin_el, double per_distance,
                        double inverse_range, double width, double height, double lean) {
    PlaneExtent extent;
    extent.sag = (width * width * ahead * cos_el * per_distance + height * height * inverse_range) * (double(1.0) / 24.0);
    double slope_a = aside * cos_el * per_distance;
    double slope_e = (normal_z * cos_el - ahead * sin_el) * per_distance;
    extent.along = abs(slope_a) * width;
    extent.across = abs(slope_e + slope_a * lean) * height;
    return extent;
}

// The part of a plane that a cell covers, and the distance of the plane.
struct PlaneFootprint {
    Footprint footprint;
    double perpendicular;  // distance of the plane [m]; 0: no echo
};

#ifndef GLSL
// Returns the trapezoid of inverse ranges that a cell covers on a plane, with the parameters of planeExtent(). The
// normal may have any length and sign. `cos_az` to `sin_el`: direction of the cell's middle. A plane closer to edge-on
// than EDGE_ON_COSINE has no echo, but still a shadow.
PlaneFootprint planeFootprint(double normal_x, double normal_y, double normal_z, double distance, double cos_az,
                              double sin_az, double cos_el, double sin_el, double width, double height, double lean,
                              double size, double near_limit, double far_limit, double near_edge, double far_edge) {
    double normal = sqrt(normal_x * normal_x + normal_y * normal_y + normal_z * normal_z);
    double ahead = normal_x * cos_az + normal_y * sin_az;
    double aside = normal_y * cos_az - normal_x * sin_az;
    double facing = ahead * cos_el + normal_z * sin_el;
    // Both conditions without a branch, so that a processor computes several cells together.
    bool echo = (distance * facing > 0.0 ? abs(facing) - EDGE_ON_COSINE * normal : 0.0) > 0.0;
    double per_distance = echo ? 1.0 / distance : 0.0;
    double inverse_range = facing * per_distance;
    PlaneExtent extent =
        planeExtent(ahead, aside, normal_z, cos_el, sin_el, per_distance, inverse_range, width, height, lean);
    PlaneFootprint seen;
    seen.perpendicular = echo ? abs(distance) / normal : 0.0;
    seen.footprint = trapezoidFootprint(inverse_range, inverse_range - extent.sag, extent.along, extent.across,
                                        echo ? 1.0 / seen.perpendicular : 0.0, near_limit, far_limit, near_edge, far_edge,
                                        echo ? size : 0.0);
    return seen;
}
#endif
