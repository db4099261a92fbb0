// Shared by C++ and GLSL: what of a footprint lies where, and its energy. `real` is a double, or several at a time.

// Share of the trapezoid between its centre and centre + t, signed as t.
real trapezoidShare(Footprint cell, real t) {
    double outer = 0.5 * (cell.wide + cell.narrow), inner = 0.5 * (cell.wide - cell.narrow);
    real within = min(max(t, -outer), outer);
    real corner = within - min(max(within, -inner), inner);
    return within * cell.per_wide - corner * abs(corner) * cell.steepness;
}

// Length of what [from, to], `length` apart, has in common with [low, high].
double commonLength(double from, double to, double length, double low, double high) {
    return from >= low && to <= high ? length : max(min(to, high) - max(from, low), 0.0);
}

// Share of the trapezoid between centre + from and centre + to, which are `length` apart: a sum of what lies in its lower corner,
// between its corners, and in its upper one, none of them below 0. In single precision differences of trapezoidShare() lose all
// of what is small, such as a bin of the thousands that a cell covers, or the end of a corner.
double partShare(Footprint cell, double from, double to, double length) {
    double outer = 0.5 * (cell.wide + cell.narrow), inner = 0.5 * (cell.wide - cell.narrow);
    double first = max(from, -outer), last = min(to, outer);
    double low = commonLength(from, to, length, -outer, -inner), high = commonLength(from, to, length, inner, outer);
    return commonLength(from, to, length, -inner, inner) * cell.per_wide +
           low * (2.0 * outer + first + min(last, -inner)) * cell.steepness +
           high * (2.0 * outer - max(first, inner) - last) * cell.steepness;
}

// Place of an inverse range on a trapezoid with a limb.
real placeOf(Footprint cell, real inverse_range) { return inverse_range + cell.limb * cell.limb / inverse_range; }

// The same on a body with a limb, up to an inverse range. The part that would be behind the limb is added as far before it:
// it stands for the cells whose middles miss the body (ACOUSTICS.md 4.7).
real limbShare(Footprint cell, real inverse_range) {
    real place = placeOf(cell, inverse_range);
    return trapezoidShare(cell, place - cell.centre) - trapezoidShare(cell, 4.0 * cell.limb - cell.centre - place);
}

// On a plane cos(theta) goes as 1/r, so the density over inverse range goes as its cube: here its mean over a part.
real meanCube(real above, real below) { return 0.5 * (0.5 * (above + below)) * (above * above + below * below); }

// Energy of a part between two inverse ranges times the square of the bin's middle range. `strength_range` = strength times
// slant range [m]; share of the trapezoid and its size are relative to one whole cell.
real partEnergy(Footprint cell, double strength_range, real share, real middle, real above, real below) {
    return strength_range * cell.size * share * middle * middle * meanCube(above, below);
}

// meanCube on a body with a limb, where the density falls to nothing as the root of the angle to it.
real limbMean(Footprint cell, real above, real below) {
    real first = above * (above * above - cell.fade * cell.fade), last = below * (below * below - cell.fade * cell.fade);
    return (first * first + first * last + last * last) / (1.5 * (first + last) + MIN_WIDTH);
}

// partEnergy on a body with a limb.
real limbEnergy(Footprint cell, double strength_range, real share, real middle, real above, real below) {
    return strength_range * cell.size * share * middle * middle * limbMean(cell, above, below);
}
