#pragma once
#include <optional>

#include "components/acoustics/BeamPattern.hpp"
#include "types/text/Describe.hpp"

namespace insonify::acoustics {

enum class PulseWindow { None, Hann, Hamming, Taylor };

/** The intensity that a receiver gets from its own transmitter after the pulse; it falls exponentially. */
struct RingDownConfig {
    std::optional<double> level_db, decay_db_per_m;

    static void describe(auto& self, auto& visit) {
        visit({"level_db", "dB", "at range 0, relative to the source at 1 m", -3000, 300}, self.level_db);
        visit({"decay_db_per_m", "dB/m", "per metre of slant range; 54.6 f / (Q c) for a resonance f of quality Q",
               0.01, 1e6},
              self.decay_db_per_m);
    }
    void check(types::Diagnostics& diagnostics) const;

    /** Returns the mean intensity between two slant ranges [m], relative to the source at 1 m [1].
     *  ACOUSTICS.md 5.15. */
    double mean(double low, double high) const;
};

/** A tone of a duration, or a chirp of a bandwidth whose matched filter is weighted by a window. */
struct PulseConfig {
    std::optional<double> bandwidth_khz, duration_us, chirp_us;
    std::optional<PulseWindow> window;
    std::optional<RingDownConfig> ring_down;

    static void describe(auto& self, auto& visit) {
        visit({"bandwidth_khz", "kHz", "of a chirp, compressed by a matched filter", 1e-3, 1e5}, self.bandwidth_khz);
        visit({"window", "", "of the matched filter; absent: none (Harris 1978; taylor: -30 dB, nbar 4)"}, self.window);
        visit({"duration_us", "us", "instead: of a tone", 0.1, 1e7}, self.duration_us);
        visit({"chirp_us", "us",
               "duration of a chirp, which shifts the range of moving targets; needs motion_in_ping and "
               "frequency_khz; absent: nothing is shifted",
               0.1, 1e7},
              self.chirp_us);
        visit({"ring_down", "", "the transmitter's ringing in the first bins; absent: none"}, self.ring_down);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** The response h of the pulse in range, two way, as intensity: h(0) = 1, centred on the echo. ACOUSTICS.md 5.10. */
class Pulse {
public:
    /** @param speed_of_sound [m/s] */
    Pulse(const PulseConfig& config, double speed_of_sound);

    /** Returns h at a distance in slant range from the echo [m]. */
    double response(double distance) const;
    /** Returns the amplitude of the field, whose square is h. Successive sidelobes alternate in sign. */
    double amplitude(double distance) const;
    /** Returns the mean of h between two distances from the echo [m]. */
    double mean(double low, double high) const;
    /** Returns the width of h at half its peak [m]. */
    double resolution() const;
    /** Returns the integral of h over range [m]: the length of a reverberation cell. */
    double cellLength() const;
    /** Returns the highest sidelobe of the matched filter [dB]; a tone has none. */
    std::optional<double> peakSidelobeDb() const;
    /** Returns the distance [m] beyond which h stays below `floor_db` relative to its peak; the sign is ignored
     *  [dB]. */
    double extent(double floor_db) const;

private:
    bool isTone() const { return !taper_; }

    double unit_;  ///< c / 2B, or c tau / 2 [m].
    std::optional<Taper> taper_;
};

}  // namespace insonify::acoustics

template <>
struct insonify::types::EnumNames<insonify::acoustics::PulseWindow> {
    static constexpr std::string_view names[] = {"none", "hann", "hamming", "taylor"};
};
