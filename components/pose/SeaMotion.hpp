#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "types/samples/Pose.hpp"
#include "types/text/Describe.hpp"

namespace insonify::pose {

/** Shape of a spectrum of sea waves over frequency. */
enum class SeaSpectrum { PiersonMoskowitz, Jonswap };

/** Heave, roll and pitch of a carrier on waves: root mean squares, and the period of the spectrum's peak. */
struct SeaMotionConfig {
    double heave_m = 0, roll_deg = 0, pitch_deg = 0;
    double period_s = 6;
    SeaSpectrum spectrum = SeaSpectrum::PiersonMoskowitz;
    uint32_t seed = 1;

    static void describe(auto& self, auto& visit) {
        visit({"heave_m", "m", "root mean square along the world's z", 0, 100}, self.heave_m);
        visit({"roll_deg", "deg", "root mean square about the body's x", 0, 90}, self.roll_deg);
        visit({"pitch_deg", "deg", "root mean square about the body's y", 0, 45}, self.pitch_deg);
        visit({"period_s", "s", "of the spectrum's peak", 0.1, 1000}, self.period_s);
        visit({"spectrum", "",
               "pierson_moskowitz (1964), of a fully developed sea; jonswap (Hasselmann et al. 1973), with a "
               "higher peak"},
              self.spectrum);
        visit({"seed", "1", "of the phases: the same seed gives the same motion", 0, 4294967295.0}, self.seed);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** A motion of given root mean square and spectrum, which depends only on time. It is a sum of sinusoids of equal
 *  amplitudes and random phases, whose frequencies divide the spectrum into equal energies. */
class WaveSum {
public:
    static constexpr size_t components = 64;
    struct Value {
        double value = 0, rate = 0;  ///< The rate is the time derivative [1/s].
    };

    WaveSum(double rms, double period, SeaSpectrum spectrum, uint64_t seed);

    Value at(double time) const;                                             ///< At a time [s].
    const std::vector<double>& frequencies() const { return frequencies_; }  ///< Angular [rad/s].

private:
    double amplitude_;
    std::vector<double> frequencies_, phases_;
};

/** Adds the motion of a carrier on waves to poses. Immutable: the same time gives the same motion. */
class SeaMotion {
public:
    explicit SeaMotion(const SeaMotionConfig& config);

    /** Adds heave to the position, rotates the body by pitch and then by roll, and adds the rates of all three to its
     *  velocities.
     *  @param time since the start of the run [s] */
    void move(double time, types::Pose& pose) const;

private:
    WaveSum heave_, roll_, pitch_;
};

/** Returns the angular frequency below which a spectrum has a share of its energy [rad/s]; 0 < `share` < 1. */
double frequencyOfShare(SeaSpectrum spectrum, double peak_frequency, double share);

}  // namespace insonify::pose

template <>
struct insonify::types::EnumNames<insonify::pose::SeaSpectrum> {
    static constexpr std::string_view names[] = {"pierson_moskowitz", "jonswap"};
};
