// Shared by GLSL and a test in C++: numbers as sums of two floats, for devices that are slow in double. They have at
// least 44 bits, even if the device divides and takes roots imprecisely. Sum and product with their rounding errors: D.
// E. Knuth, The Art of Computer Programming 2, 4.2.2; T. J. Dekker, "A floating-point technique for extending the
// available precision", Numer. Math. 18, 1971. `precise` keeps a compiler from rearranging the terms; C++ defines it as
// nothing.

struct Pair {
    float high, low;  // high is the sum, rounded
};

Pair exactSum(float a, float b) {
    precise float sum = a + b;
    precise float of_b = sum - a;
    precise float rest = (a - (sum - of_b)) + (b - of_b);
    return Pair(sum, rest);
}

// The first half of the bits of a float, so that products of halves are exact.
float firstHalf(float a) { return uintBitsToFloat(floatBitsToUint(a) & 0xfffff000u); }

Pair exactProduct(float a, float b) {
    precise float product = a * b;
    precise float a_first = firstHalf(a), b_first = firstHalf(b);
    precise float a_rest = a - a_first, b_rest = b - b_first;
    precise float rest = ((a_first * b_first - product) + a_first * b_rest + a_rest * b_first) + a_rest * b_rest;
    return Pair(product, rest);
}

Pair negative(Pair a) { return Pair(-a.high, -a.low); }

Pair computeSum(Pair a, Pair b) {
    Pair high = exactSum(a.high, b.high);
    precise float low = high.low + (a.low + b.low);
    return exactSum(high.high, low);
}

Pair product(Pair a, Pair b) {
    Pair high = exactProduct(a.high, b.high);
    precise float low = high.low + (a.high * b.low + a.low * b.high);
    return exactSum(high.high, low);
}

Pair quotient(Pair a, Pair b) {
    precise float first = a.high / b.high;
    Pair rest = computeSum(a, negative(product(b, Pair(first, 0.0f))));
    precise float second = rest.high / b.high;
    return exactSum(first, second);
}

// The square root of a number above 0.
Pair root(Pair a) {
    precise float first = sqrt(a.high);
    Pair rest = computeSum(a, negative(exactProduct(first, first)));
    precise float second = 0.5f * rest.high / first;
    return exactSum(first, second);
}

// The difference of a number and a float; exact where the two are close.
float beyond(Pair a, float origin) {
    precise float difference = (a.high - origin) + a.low;
    return difference;
}
