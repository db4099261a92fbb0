// Shared by C++ and GLSL, so that all deposits do the same arithmetic: the inverse ranges that a cell of a picture or
// of rays covers. On a plane 1/r is nearly linear in the cell's coordinates (ACOUSTICS.md 4). A cell therefore covers a
// trapezoid of inverse ranges (box convolved with box), exact to second order even where one pixel spans hundreds of
// bins.

// A cell's trapezoid: the widths of its two boxes, and its part in reach. It is in inverse range g [1/m], or on a body
// with a limb in g + limb^2 / g, which is linear in angle over a sphere. Its places are inverse ranges relative to an
// origin: 0 in C++, and close to the cell in GLSL, which uses single precision. The includer defines double
// inverseRange(double place).
struct Footprint {
    double pixel;  // inverse range (not a place) of the centre of the cell's pixel; 0: no echo
    double centre;  // place
    double wide, narrow;
    double per_wide, steepness;  // 1 / wide, and 1 / (2 wide narrow)
    double near_end, far_end;    // places; near_end <= far_end: nothing in reach
    double nearest;              // place of the nearest point of plane or sphere
    double limb;                 // inverse range of the limb; 0: a plane, which has none
    double fade;                 // `limb` where the echo fades to 0 there by Lambert's law; 0: constant strength in the cell
    double size;                 // solid angle relative to a whole pixel at the picture's centre [1]
};

// Inverse range of a place on a trapezoid; places behind the limb have that of the limb.
double inverseAt(double limb, double place) {
    double curved = max(0.5 * (place + sqrt(max(place * place - 4.0 * limb * limb, 0.0))), limb);
    return limb > 0.0 ? curved : place;
}

// Returns the trapezoid about `centre` that a cell covers: box `along` convolved with box `across`. It is clipped to
// `nearest`, the plane's nearest point, to [far_limit, near_limit], the extent of the plane's object (a facet seen
// edge-on is steep, not long), and to [far_edge, near_edge], the extent of the bins. All of these are places. A `size`
// of 0 means no echo.
Footprint trapezoidFootprint(double inverse_range, double centre, double along, double across, double nearest, double near_limit,
                             double far_limit, double near_edge, double far_edge, double size) {
    Footprint cell;
    cell.pixel = inverse_range;
    cell.centre = min(centre, nearest);
    cell.wide = max(max(along, across), MIN_WIDTH_RATIO * inverse_range + MIN_WIDTH);
    cell.narrow = max(min(along, across), MIN_WIDTH_RATIO * cell.wide);
    cell.per_wide = 1.0 / cell.wide;
    cell.steepness = 0.5 * cell.per_wide / cell.narrow;
    double half_length = 0.5 * (cell.wide + cell.narrow);
    cell.near_end = size > 0.0 ? min(min(cell.centre + half_length, nearest), min(near_limit, near_edge)) : far_edge;
    cell.nearest = nearest;
    cell.limb = cell.fade = 0.0;
    cell.far_end = max(max(cell.centre - half_length, far_limit), far_edge);
    cell.size = size;
    return cell;
}
