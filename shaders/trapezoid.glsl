// Shared by C++ and GLSL: what of a footprint lies where, and its energy. `real` is a double, or several at a time.

// Share of the trapezoid between its centre and centre + t, signed as t.
real trapezoidShare(Footprint cell, real t) {
    double outer = 0.5 * (cell.wide + cell.narrow), inner = 0.5 * (cell.wide - cell.narrow);
    real within = min(max(t, -outer), outer);
    real corner = within - min(max(within, -inner), inner);
    return within * cell.per_wide - corner * abs(corner) * cell.steepness;
}

// On a plane cos(theta) goes as 1/r, so the density over inverse range goes as its cube: here its mean over a part.
real meanCube(real above, real below) { return 0.5 * (0.5 * (above + below)) * (above * above + below * below); }

// Energy of a part between two inverse ranges times the square of the bin's middle range. `strength_range` = strength times
// slant range [m]; share of the trapezoid and its size are relative to one whole cell.
real partEnergy(Footprint cell, double strength_range, real share, real middle, real above, real below) {
    return strength_range * cell.size * share * middle * middle * meanCube(above, below);
}
