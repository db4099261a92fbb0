// Smooth bodies have their target strengths with any mesh and frequency, at any range and aspect (ACOUSTICS.md 3.6).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <random>

#include "components/sonar/surfaces/FacetLobes.hpp"
#include "components/sonar/surfaces/MeshFacts.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/TargetShapes.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using study::Encounter;
using study::Target;

constexpr double tolerance = 0.5;  ///< [dB]
const std::array names = {"ellipsoid", "cylinder", "tilted cylinder", "plate", "cone", "hull"};

/** A random sonar and a random body of a kind. */
class Meetings {
public:
    explicit Meetings(unsigned seed) : random_(seed) {}

    Encounter met;
    Target next(size_t kind) {
        // A tilted body far away at more kHz is weaker than half a quantum of the sums.
        met.frequency_khz = between(100, kind == 2 ? 600 : 3000);
        met.around = static_cast<int>(between(32, 2048));
        met.turn = uniform(0, 1);
        const double radius = between(0.05, 0.2);
        if (kind == 0) {
            met.range = between(3, 300);
            const double along = between(0.1, 1), across = between(0.1, 1), up = between(0.1, 1);  // in this order
            return study::ellipsoidTarget(met, along, across, up);
        }
        const double length = kind == 5 ? uniform(8, 16) * radius : between(0.4, 1);
        meet(length, kind != 2 && uniform(0, 1) < 0.5);
        if (kind == 1) return study::cylinderTarget(met, radius, length, 0);
        if (kind == 2) return study::cylinderTarget(met, radius, length, types::radians(uniform(1, 10)));
        if (kind == 3) return study::plateTarget(met, length, length * uniform(0.7, 1));
        if (kind == 4) return study::coneTarget(met, length * 0.3, length * std::sqrt(1 - 0.09));
        return study::hullTarget(met, radius, length);
    }

private:
    double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    double between(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
    /** Near or far, but not at ranges where a length interferes with itself. */
    void meet(double length, bool near) {
        const double number = near ? between(10, 60) : between(0.05, 0.2);
        met.range = length * length / (met.wavelength() * number);
    }
    std::mt19937 random_;
};

/** Energies of samples are sums over facets. A body with few facets and uneven curvature therefore has a larger
 *  error. */
TEST(TargetStrengthTest, SmoothBodiesHaveTheirTargetStrengthInAnyMesh) {
    constexpr unsigned trials_each = 20, outside_each = 4;
    for (size_t kind = 0; kind < names.size(); ++kind) {
        double squares = 0;
        unsigned outside = 0;
        for (unsigned trial = 0; trial < trials_each; ++trial) {
            Meetings meetings(static_cast<unsigned>(names.size()) * trial + static_cast<unsigned>(kind));
            const Target target = meetings.next(kind);
            const Encounter& met = meetings.met;
            const double error = study::targetError(met, target, study::targetSonar(met, target, 384));
            squares += error * error;
            outside += std::abs(error) > tolerance ? 1 : 0;
            EXPECT_NEAR(error, 0, 3 * tolerance)
                << names[kind] << ", trial " << trial << ": " << met.frequency_khz << " kHz, " << met.around
                << " facets round, " << met.range << " m, " << target.strength_db << " dB";
        }
        const double rms = std::sqrt(squares / trials_each);
        std::cout << names[kind] << ": " << rms << " dB rms, " << outside << " of " << trials_each << " beyond "
                  << tolerance << " dB\n";
        EXPECT_LT(rms, 0.9 * tolerance) << names[kind];
        EXPECT_LE(outside, outside_each) << names[kind];
    }
}

TEST(TargetStrengthTest, APipeBroadsideIsTheSameRayTracedAndRasterised) {
    const Encounter met{300, 1000, 64, 0.3};
    const Target target = study::cylinderTarget(met, 0.1, 1, 0);
    EXPECT_NEAR(target.strength_db, 10, 0.1);
    for (const SonarConfig& way : test::everyRenderer(study::targetSonar(met, target, 512)))
        EXPECT_NEAR(study::targetError(met, target, way), 0, tolerance);
}

TEST(TargetStrengthTest, AFacetSpreadsALobeAcrossACylinderAndNotAlongIt) {
    const int around = 64;
    const double turn = 2 * std::numbers::pi / around, length = 1, wavelength = 0.005;
    const types::Mesh pipe = study::revolved({{0.1, 0}, {0.1, length}}, around, 0, 2 * std::numbers::pi);
    for (const FacetRecord& facet : facetLobes(pipe, glm::dmat3(1), wavelength)) {
        EXPECT_NEAR(facet.first.x, turn * turn / 2, 1e-3 * turn * turn);
        EXPECT_NEAR(facet.first.z, 10, 0.1);
        EXPECT_NEAR(facet.second.x, 0, 1e-9);
        EXPECT_NEAR(facet.second.z, 0, 1e-3);
        EXPECT_NEAR(facet.second.y, wavelength * wavelength / (4 * std::numbers::pi * length * length), 1e-8);
        EXPECT_NEAR(facet.axis.z, 0, 1e-6);
    }
}

TEST(TargetStrengthTest, ACubesFacesStayFlatAndAPlatesLobeFollowsItsScale) {
    const types::Mesh plate = study::quad({0, 0, 0}, {2, 0, 0}, {0, 1, 0});
    for (const double scale : {1.0, 2.0})
        for (const FacetRecord& facet : facetLobes(plate, glm::dmat3(scale), 0.01)) {
            const double area = 2 * scale * scale;
            EXPECT_NEAR(std::sqrt(facet.first.y * facet.second.y) * 4 * std::numbers::pi * area / 1e-4, 1, 1e-5);
            EXPECT_EQ(facet.first.x + facet.second.x + facet.first.z + facet.second.z, 0);
        }
    const types::Mesh box = study::getMesh(
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
        {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7});
    for (const FacetRecord& facet : facetLobes(box, glm::dmat3(1), 0.01)) {
        EXPECT_EQ(facet.first.x + facet.second.x + facet.first.z + facet.second.z, 0);
        EXPECT_NEAR(std::sqrt(facet.first.y * facet.second.y), 1e-4 / (4 * std::numbers::pi), 1e-10);
    }
}

TEST(TargetStrengthTest, BothDirectionsOnASphereAreEqualAndFinerMeshesAddLess) {
    for (const int rings : {32, 256}) {
        const double step = std::numbers::pi / rings;
        const std::vector<FacetRecord> ball = facetLobes(study::sphere(0.1, rings), glm::dmat3(1), 0.005);
        const FacetRecord& facet = ball[ball.size() / 2];
        EXPECT_NEAR(facet.first.x / (step * step / 2), 1, 0.05);
        EXPECT_NEAR(facet.second.x / (step * step / 2), 1, 0.05);
        EXPECT_NEAR(facet.first.y, 25e-6 / (4 * std::numbers::pi * 0.04), 1e-6) << "of the whole body";
    }
}

TEST(TargetStrengthTest, FacetsOfAMeshAreFoundOnceForEachScaleAndWavelength) {
    const auto mesh = std::make_shared<const types::Mesh>(study::quad({0, 0, 0}, {2, 0, 0}, {0, 1, 0}));
    const auto facts = MeshFacts::of(mesh);
    MaterialLaws laws;
    laws.records = {{vec4(0), vec4(-1, 0.1f, 0.01f, 0)}};
    laws.wavelength = 0.01;
    const MeshFacts::Facets kept = facts->facets(glm::dmat3(1), laws);
    ASSERT_NE(kept, nullptr);
    EXPECT_EQ(facts->facets(glm::dmat3(1), laws), kept);
    const MeshFacts::Facets twice = facts->facets(glm::dmat3(2), laws);
    EXPECT_NEAR((*twice)[0].first.y / (*kept)[0].first.y, 0.25, 1e-5);
    laws.wavelength = 0.02;
    EXPECT_NEAR((*facts->facets(glm::dmat3(1), laws))[0].first.y / (*kept)[0].first.y, 4, 1e-4);
    laws.records[0].law.y = 0;
    EXPECT_EQ(facts->facets(glm::dmat3(1), laws), nullptr) << "no lobe";
}

}  // namespace
}  // namespace insonify::sonar
