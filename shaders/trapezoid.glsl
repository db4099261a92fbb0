// Shared by C++ and GLSL: shares of a footprint, and their energy. `real` is a double, or a vector of doubles.

// Share of the trapezoid between its centre and centre + t, signed as t.
real trapezoidShare(Footprint cell, real t) {
    double outer = 0.5 * (cell.wide + cell.narrow), inner = 0.5 * (cell.wide - cell.narrow);
    real within = min(max(t, -outer), outer);
    real corner = within - min(max(within, -inner), inner);
    return within * cell.per_wide - corner * abs(corner) * cell.steepness;
}

// Length of the intersection of [from, to], `length` apart, with [low, high].
double commonLength(double from, double to, double length, double low, double high) {
    return from >= low && to <= high ? length : max(min(to, high) - max(from, low), 0.0);
}

// Share of the trapezoid between centre + from and centre + to, which are `length` apart. It is the sum of the shares
// in the lower corner, between the corners, and in the upper corner, each at least 0. In single precision, differences
// of trapezoidShare() would lose small shares, such as one of thousands of bins in a cell, or the end of a corner.
double partShare(Footprint cell, double from, double to, double length) {
    double outer = 0.5 * (cell.wide + cell.narrow), inner = 0.5 * (cell.wide - cell.narrow);
    double first = max(from, -outer), last = min(to, outer);
    double low = commonLength(from, to, length, -outer, -inner), high = commonLength(from, to, length, inner, outer);
    return commonLength(from, to, length, -inner, inner) * cell.per_wide +
           low * (2.0 * outer + first + min(last, -inner)) * cell.steepness +
           high * (2.0 * outer - max(first, inner) - last) * cell.steepness;
}

// Place of an inverse range on a trapezoid with a limb.
real getPlace(Footprint cell, real inverse_range) { return inverse_range + cell.limb * cell.limb / inverse_range; }

// Share up to an inverse range on a body with a limb. The part behind the limb is mirrored to the same distance before
// it, where it represents the cells whose middles miss the body (ACOUSTICS.md 4.7).
real limbShare(Footprint cell, real inverse_range) {
    real place = getPlace(cell, inverse_range);
    return trapezoidShare(cell, place - cell.centre) - trapezoidShare(cell, 4.0 * cell.limb - cell.centre - place);
}

// Mean cube of the inverse range over a part. On a plane cos(theta) is proportional to 1/r, so the density over inverse
// range is proportional to its cube.
real meanCube(real above, real below) { return 0.5 * (0.5 * (above + below)) * (above * above + below * below); }

// Energy of a part between two inverse ranges times the square of the bin's middle range. `strength_range` = strength
// times slant range [m]; share of the trapezoid and its size are relative to one whole cell.
real partEnergy(Footprint cell, double strength_range, real share, real middle, real above, real below) {
    return strength_range * cell.size * share * middle * middle * meanCube(above, below);
}

// meanCube on a body with a limb, where the density falls to 0 as the root of the angle to the limb.
real limbMean(Footprint cell, real above, real below) {
    real first = above * (above * above - cell.fade * cell.fade), last = below * (below * below - cell.fade * cell.fade);
    return (first * first + first * last + last * last) / (1.5 * (first + last) + MIN_WIDTH);
}

// partEnergy on a body with a limb.
real limbEnergy(Footprint cell, double strength_range, real share, real middle, real above, real below) {
    return strength_range * cell.size * share * middle * middle * limbMean(cell, above, below);
}
