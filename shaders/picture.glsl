// Shared by C++ and GLSL: the cell that is a beam's share of a pixel, in the picture of a frustum: u = tan(azimuth),
// v = tan(elevation) / cos(azimuth).

struct PictureCell {
    double u, v;           // of its middle [1]
    double width, height;  // [rad]
    double size;           // solid angle, in pixels at the picture's centre [1]
};

// The share of pixel (u, v), bounded by curves of constant elevation and clipped at the aperture; shares are described in
// interface.glsl. `dv`: height of a pixel; `per_pixel`: 1 / (du dv).
PictureCell pictureCell(double u, double v, double middle, double width, double limit, double shear, double dv,
                        double per_pixel) {
    double at = v + v * shear * (middle - u);
    double low = max(at - 0.5 * dv, -limit);
    double high = min(at + 0.5 * dv, limit);
    double rise = max(high - low, 0.0);
    PictureCell cell;
    cell.u = middle;
    cell.v = 0.5 * (low + high);
    double p2 = 1.0 + middle * middle;
    double q2 = p2 + cell.v * cell.v;
    cell.width = width / p2;
    cell.height = rise * sqrt(p2) / q2;
    cell.size = width * rise / (q2 * sqrt(q2)) * per_pixel;
    return cell;
}
