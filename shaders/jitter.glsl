// Shared by C++ and GLSL: a number in [-0.5, 0.5) for a pixel's column (which = 0) or row (which = 1), in steps of
// 2^-32. The hash is PCG: M. Jarzynski and M. Olano, "Hash functions for GPU rendering", JCGT 9(3), 2020.
uint jitterWord(uint column, uint row, uint which) {
    uint state = (row * 32768u + column) * 2u + which;
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}
double jitter(uint column, uint row, uint which) {
    return double(jitterWord(column, row, which)) * (1.0 / 4294967296.0) - 0.5;
}
