// Shared by C++ and GLSL: the cell that is a beam's share of a pixel, in the picture of a frustum: u = tan(azimuth),
// v = tan(elevation) / cos(azimuth).

// The part within the aperture of a pixel's row, which is `dv` high about `at`; all in v from any origin. Rows follow
// curves of constant elevation: at u, the row of a pixel at (u_0, v_0) is about v_0 + v_0 shear (u - u_0), with the
// share's `shear`.
struct PictureRow {
    double middle, rise;
};
PictureRow pictureRow(double at, double dv, double low_limit, double high_limit) {
    double low = max(at - 0.5 * dv, low_limit);
    double high = min(at + 0.5 * dv, high_limit);
    PictureRow row;
    row.middle = 0.5 * (low + high);
    row.rise = max(high - low, 0.0);
    return row;
}

struct PictureCell {
    double width, height;  // [rad]
    double size;           // solid angle, in pixels at the picture's centre [1]
};

// Returns the cell about (u, v) that is `width` wide in u and `rise` high in v. `per_pixel`: 1 / (du dv).
PictureCell pictureCell(double u, double v, double width, double rise, double per_pixel) {
    PictureCell cell;
    double p2 = 1.0 + u * u;
    double q2 = p2 + v * v;
    cell.width = width / p2;
    cell.height = rise * sqrt(p2) / q2;
    cell.size = width * rise / (q2 * sqrt(q2)) * per_pixel;
    return cell;
}
