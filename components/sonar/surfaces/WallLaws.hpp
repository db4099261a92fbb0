#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "components/acoustics/Curve.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::sonar {

inline constexpr double water_density = 1025;  ///< Of the sonar's water [kg/m^3].

/** Material behind a wall that is neither water nor air (ACOUSTICS.md 5.26). */
struct WallFill {
    double speed_ratio = 1;  ///< Its speed of sound relative to the sonar's water [1].
    double attenuation = 0;  ///< Attenuation of energy, one way [Np/m].
    double within = 1;       ///< Reflection of the wall from within relative to that from outside, of energy [1].
};

/** Returns of a wall that are separate in range: the energy of each, with a sum of 1. The first is that of the face
 *  that sound hits first. */
using Returns = std::vector<float>;

/** Effect of a material's shell on sound (ACOUSTICS.md 3.10, 5.26). A material without a shell has an empty law. */
struct WallLaw {
    static constexpr size_t max_returns = 32;  ///< [1]

    double reflected = 1;  ///< Share of the energy reflected at normal incidence, all returns together [1].
    /** One-way transmitted share of energy, over the cosine in water from 0 to 1: within 0.05 dB of the plate's own
     *  transmission, or 1e-5; empty: nothing passes [1]. */
    acoustics::AdaptiveTable passed_once;
    /** Two-way transmitted share of a wall that rings, within 0.1 dB or 1e-7; empty: the square of that one way [1]. */
    acoustics::AdaptiveTable passed;
    /** Both at an angle itself, without tables; null where nothing passes [1]. */
    std::function<double(double cosine)> exactly_once, exactly;
    double thickness = 0;          ///< [m]
    double speed_ratio = 1;        ///< Speed of sound of the wall relative to the water [1].
    Returns outside, inside;       ///< Returns of its two faces; empty: they are in one bin.
    Returns behind;                ///< Returns of an echo from behind, out and back through the wall; empty likewise.
    Returns once;                  ///< Arrivals of sound that passes the wall once; empty likewise.
    std::optional<WallFill> fill;  ///< None: water, or air, which no sound enters.

    bool letsThrough() const { return !passed_once.empty(); }
    bool rings() const { return !outside.empty(); }
    /** Returns the two-way transmitted share of energy at a cosine of incidence in water, within 0.1 dB [1]. */
    double passedAt(double cosine) const {
        if (!passed.empty()) return passed.at(cosine);
        const double share = passed_once.at(cosine);
        return share * share;
    }
    /** Returns the one-way transmitted share of energy at a cosine of incidence in water [1]. Resonances of one wall
     *  make it less than the root of the two-way share. */
    double passedOnceAt(double cosine) const { return passed_once.at(cosine); }
    /** Returns the slant range between two returns at a sine of incidence in water: thickness c cos(theta_wall) /
     *  c_wall, 0 beyond the critical angle [m]. */
    double spacing(double sine) const;
    /** Returns the slant range that the wall adds to sound that passes it out and back at a sine of incidence in water;
     *  0 if it does not ring [m]. It replaces thickness cos(theta) of water. */
    double delay(double sine) const;
};

/** Returns the law of a material: an empty one without a shell, or for a sonar without a frequency. */
WallLaw makeWallLaw(const types::Material& material, const SonarConfig& config);

/** Successive echoes of one surface or point, because sound rings in walls. */
class EchoTrain {
public:
    static constexpr size_t max_echoes = WallLaw::max_returns;  ///< [1]

    struct Echo {
        double late;    ///< Slant range beyond that of the surface [m].
        double weight;  ///< Share of the energy [1].
    };

    /** Makes a train of one echo without delay. */
    EchoTrain() { echoes_[0] = {0, 1}; }
    size_t size() const { return size_; }
    /** Returns whether it is other than one echo without delay. */
    bool isDelayed() const { return size_ > 1 || echoes_[0].late != 0; }
    const Echo& operator[](size_t i) const { return echoes_[i]; }
    /** Returns the train of a wall whose returns follow each echo of this train at a spacing [m]. Echoes closer than
     *  `resolution` [m] merge, at the range of the first. Echoes beyond max_echoes are added to the last. The sum of
     *  the weights becomes the product of the sums. */
    EchoTrain then(const Returns& returns, double spacing, double resolution) const;
    /** Passes a wall once at a sine of incidence in water. Its delays are half of those out and back. Returns the share
     * of the energy that passes [1]. */
    double passOnce(const WallLaw& wall, double sine, double resolution);
    void moveAway(double range) {
        for (size_t i = 0; i < size_; ++i) echoes_[i].late += range;
    }
    /** Subtracts from the first echo. */
    void take(double weight) { echoes_[0].weight -= weight; }
    void scale(double by) {
        for (size_t i = 0; i < size_; ++i) echoes_[i].weight *= by;
    }

private:
    void append(const Echo& echo, double resolution);

    size_t size_ = 1;
    std::array<Echo, max_echoes> echoes_;
};

}  // namespace insonify::sonar
