#pragma once
#include <glm/vec3.hpp>
#include <limits>
#include <memory>

#include "types/samples/Pose.hpp"

namespace insonify::types {

/** The directions in which a transmitter radiates. */
class Radiation {
public:
    virtual ~Radiation() = default;
    /** Returns the power radiated in a direction, relative to that on the axis [1].
     *  @param direction  unit vector in the axes of the sonar: x ahead, y to port, z up */
    virtual double towards(const glm::dvec3& direction) const = 0;
};

/** One transmitted pulse of a sonar, for sonars that may receive it. */
struct Transmission {
    static constexpr const char* type_name = "/insonify/Transmission";
    static constexpr bool shared = true;
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    Time time;   ///< Begin of the pulse.
    Pose sonar;  ///< Sonar frame in the world.
    std::shared_ptr<const Radiation> radiation;
    double source_level_db = unknown;  ///< Source level on the axis [dB re 1 uPa m].
    double frequency_khz = unknown;    ///< Centre of the band [kHz].
    double bandwidth_khz = unknown;    ///< [kHz]
    double duration = unknown;         ///< [s]
};

using TransmissionPtr = std::shared_ptr<const Transmission>;

}  // namespace insonify::types
