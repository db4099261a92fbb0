#pragma once
// A cut through a beam that is 3 deg wide, and its textbook values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/Weightings.hpp"

namespace insonify::sonar {

struct BeamCut {
    double width_deg, first_null_deg, sidelobe_db;

    /** @param level energies at successive angles @param axis where the loudest is @param step between angles [deg] */
    BeamCut(const std::vector<double>& level, size_t axis, double step) {
        const double half = 0.5 * level[axis];
        size_t k = axis;
        while (level[k] > half) ++k;
        width_deg = 2 * step * (static_cast<double>(k - axis) - (half - level[k]) / (level[k - 1] - level[k]));
        while (level[k + 1] < level[k]) ++k;
        first_null_deg = step * static_cast<double>(k - axis);
        sidelobe_db =
            10 * std::log10(*std::max_element(level.begin() + static_cast<long>(k), level.end()) / level[axis]);
    }
    void expect(const test::WeightingRow& row) const {
        EXPECT_NEAR(width_deg, 3, 0.03) << row.name;
        EXPECT_NEAR(first_null_deg, 3 * row.first_null / row.width, 0.02 * 3 * row.first_null / row.width) << row.name;
        EXPECT_NEAR(sidelobe_db, row.peak_sidelobe_db, 0.3) << row.name;
    }
};

}  // namespace insonify::sonar
