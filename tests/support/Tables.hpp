#pragma once
// Random tables of bearings that no regular fan has.
#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <vector>

namespace insonify::test {

/** Centres of beams in ascending order along their arc, and the width of each [deg]. */
struct Table {
    std::string kind;
    std::vector<double> bearings_deg;
    double width_deg;

    friend std::ostream& operator<<(std::ostream& stream, const Table& table) {
        stream << table.kind << ", beams of " << table.width_deg << " deg at";
        for (const double bearing : table.bearings_deg) stream << ' ' << bearing;
        return stream;
    }
};

/** The direction within -180 and 180 deg. */
inline double wrappedDeg(double degrees) { return std::remainder(degrees, 360); }

/** One table of each kind, all ahead except those across the seam and all around. */
inline std::vector<Table> drawTables(std::mt19937& random) {
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto evenly = [](double from, double step, int count) {
        std::vector<double> bearings;
        for (int k = 0; k < count; ++k) bearings.push_back(from + k * step);
        return bearings;
    };
    std::vector<Table> tables;
    tables.push_back({"side by side", evenly(between(-50, -20), 4, 11), 4});
    tables.push_back({"gaps", evenly(-60, between(8, 12), 11), 3});
    tables.push_back({"overlaps", evenly(-20, 3, 13), between(6, 14)});
    Table irregular{"irregular", {-70}, between(2, 5)};
    while (irregular.bearings_deg.size() < 12)
        irregular.bearings_deg.push_back(irregular.bearings_deg.back() + between(0.7, 20));
    tables.push_back(irregular);
    tables.push_back({"one beam", {between(-80, 80)}, 5});
    Table astern{"across the seam", {}, 5};
    for (const double bearing : evenly(between(140, 165), between(4, 7), 9))
        astern.bearings_deg.push_back(wrappedDeg(bearing));
    tables.push_back(astern);
    tables.push_back({"all round", evenly(-172.5, 15, 24), 15});
    return tables;
}

}  // namespace insonify::test
