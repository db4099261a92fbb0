// Shared by C++ and GLSL, so that both deposits do the same arithmetic: which inverse ranges a cell of the picture covers.
// Over a plane 1/r is linear in the picture but for the slow |q|, so a cell covers a trapezoid of inverse ranges
// (box times box), exact to second order even where one pixel spans hundreds of bins.

// A cell, in inverse range: centre, widths of the two boxes [1/m], and its solid angle [sr].
struct Footprint {
    double centre, wide, narrow, solid_angle;
};

// The cell of pixel (u, v) between u_low and u_high, bounded by curves of constant elevation and clipped at
// |tan(elevation)| <= tan_elevation. `surface` is the pixel's texel. Its solid angle is 0 when nothing is left.
Footprint cellFootprint(double u, double v, double u_low, double u_high, double dv, double tan_elevation,
                        double range, double slope_u, double slope_v) {
    double middle = 0.5 * (u_low + u_high);
    double shear = v * u / (1.0 + u * u);
    double stretch = sqrt(1.0 + middle * middle);
    double limit = tan_elevation * stretch;
    double at = v + shear * (middle - u);
    double low = max(at - 0.5 * dv, -limit);
    double high = min(at + 0.5 * dv, limit);
    double height = max(high - low, 0.0);
    double centre_v = 0.5 * (low + high);
    double along = abs(slope_u + slope_v * shear) * (u_high - u_low);
    double across = abs(slope_v) * height;
    double q2 = 1.0 + middle * middle + centre_v * centre_v;
    Footprint cell;
    cell.centre = 1.0 / range + slope_u * (middle - u) + slope_v * (centre_v - v);
    cell.wide = max(along, across);
    cell.narrow = min(along, across);
    cell.solid_angle = (u_high - u_low) * height / (q2 * sqrt(q2));
    return cell;
}

double squareOfPositive(double x) {
    double positive = max(x, 0.0);
    return positive * positive;
}

// Share of the trapezoid that lies below centre + t. Where one box is under 2^-10 of the other it is a plain box.
double trapezoidBelow(double t, double wide, double narrow) {
    if (narrow < 0.0009765625 * wide) return clamp(t / wide + 0.5, 0.0, 1.0);
    double outer = 0.5 * (wide + narrow);
    double inner = 0.5 * (wide - narrow);
    double area = squareOfPositive(t + outer) - squareOfPositive(t + inner) - squareOfPositive(t - inner) + squareOfPositive(t - outer);
    return clamp(area / (2.0 * wide * narrow), 0.0, 1.0);
}
