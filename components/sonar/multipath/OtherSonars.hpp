#pragma once
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/Directivity.hpp"
#include "components/sonar/bins/EchoShape.hpp"
#include "components/sonar/multipath/TargetPaths.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/Transmission.hpp"

namespace insonify::sonar {

/** Directions in which a sonar's transmitter radiates: by the laws of its `beam_pattern.transmit`; without one
 *  in azimuth evenly over the fan, without one in elevation evenly over the aperture. */
class SentPower final : public types::Radiation {
public:
    /** @throws types::ConfigError as Directivity does */
    explicit SentPower(const SonarConfig& config);
    double towards(const glm::dvec3& direction) const override;

private:
    bool conical_;
    double half_height_;  ///< [rad]
    Fan beams_;
    std::optional<Directivity> pattern_;
    bool has_azimuth_ = false, has_elevation_ = false;  ///< Transmit laws of the pattern.
};

/** Band and duration of a pulse. */
struct Waveform {
    double frequency_khz = types::Transmission::unknown;  ///< Centre of the band; NaN: unknown [kHz].
    double bandwidth_khz = 0;                             ///< [kHz]
    double duration = 0;                                  ///< [s]
};

/** Returns the waveform of a configured sonar. A sonar without `pulse` sends a tone as long as a bin. A chirp without
 *  `chirp_us` lasts 50 / bandwidth. */
Waveform waveform(const SonarConfig& config, const BinGrid& grid);
/** Returns the waveform of a transmission; missing values are taken from `own`. */
Waveform waveform(const types::Transmission& sent, const Waveform& own);

/** Output of a matched filter for a foreign pulse: a box in slant range (ACOUSTICS.md 5.29). */
struct Mismatch {
    double intensity = 1;  ///< Relative to the peak of the filter's own pulse of the same source level [1].
    double length = 0;     ///< In slant range [m]; 0: the pulse is the filter's own.
};

/** Returns the mismatch of a pulse.
 *  @param own  the waveform that the receiver's filter matches
 *  @param cell  integral of the own pulse's response over slant range [m]
 *  @param rejection_db  attenuation of the energy outside the receiver's band [dB] */
Mismatch computeMismatch(const Waveform& own, const Waveform& sent, double cell, double rejection_db,
                         double speed_of_sound);

/** Reception of another sonar's transmission, independent of their places. */
struct Reception {
    double level;   ///< Intensity on the axis at 1 m, relative to the sonar's own [1].
    double length;  ///< Mismatch::length [m].
    double loss;    ///< By absorption, one way, of intensity [1/m].
    double offset;  ///< Delay between the two pulses, in slant range: c (t - t_own) / 2 [m].
};

/** Receives the transmissions of others. */
class Receiver {
public:
    /** @param plan  its configuration has `crosstalk`; outlives it */
    explicit Receiver(const RenderPlan& plan);
    /** Returns the integral over slant range of an echo in one bin after all processing: of the pulse's response, or
     *  the bin where the plan omits the pulse [m]. */
    double summedCell() const { return summed_cell_; }
    Reception reception(const types::Transmission& sent, const types::Time& own_time) const;

private:
    const RenderPlan& plan_;
    Waveform own_;
    double cell_, summed_cell_;  ///< The pulse's own integral, and summedCell() [m].
    double loss_;                ///< By absorption, one way, of intensity [1/m].
};

/** The pulses of other sonars that arrive at a sonar directly or via mirrors: the one-way sonar equation
 *  (ACOUSTICS.md 5.29). */
class DirectSound {
public:
    /** Plan and geometry outlive it; the plan has `crosstalk`. */
    DirectSound(const RenderPlan& plan, const types::Geometry& geometry);
    void setScene(const types::Geometry& geometry);

    /** Adds the snapshot's transmissions to a ping whose beams are sorted. Returns the number of transmissions that any
     *  beam receives. */
    size_t add(const types::Snapshot& snapshot, types::Sonar& ping);

private:
    bool addPath(const types::Transmission& sent, const Reception& received, const TargetPath& path,
                 types::Sonar& ping);
    /** Fills shares_ for bins from first_bin_. Returns whether there are any. */
    bool spread(double range, double length);
    /** Returns the receive power of a beam in a direction of the sonar's axes [1]. */
    double receivedBy(const Beam& beam, const BeamAngles& from, double range) const;

    const RenderPlan& plan_;
    Receiver receiver_;
    std::optional<TargetPaths> paths_;
    std::optional<EchoShape> shape_;
    std::vector<Reception> received_;  ///< Receptions of the ping's transmissions.
    std::vector<double> shares_;       ///< Mean of the response in each bin [1].
    size_t first_bin_ = 0;
};

/** The pulses of other sonars that one sonar has received messages of, kept while they may arrive at it. */
class OthersReceived {
public:
    static constexpr double memory = 10;         ///< Time for which a pulse is kept: sound travels 15 km [s].
    static constexpr double longest_ping = 200;  ///< Max time for which a ping waits for pulses [s].

    /** Also forgets pulses that are far from it in time: a sonar that does not ping asks for none. */
    void add(types::TransmissionPtr sent) {
        if (!sent || !sent->radiation) return;
        if (sent_.size() >= look_at_) {
            std::erase_if(sent_, [newest = sent->time](const auto& other) {
                return std::abs((newest - other->time).seconds()) > memory + longest_ping;
            });
            look_at_ = 2 * sent_.size() + 64;
        }
        sent_.push_back(std::move(sent));
    }
    size_t size() const { return sent_.size(); }  ///< Pulses that are kept [1].
    void clear() { sent_.clear(); }

    /** Gives a snapshot the pulses from which sound may arrive within the range of its sonar, and forgets old pulses.
     *  @param range  of the sonar [m]
     *  @param speed_of_sound  [m/s] */
    void give(types::Snapshot& scene, double range, double speed_of_sound) {
        std::erase_if(sent_, [&](const auto& sent) {
            const double age = (scene.time - sent->time).seconds();
            return age > memory || age < -longest_ping;
        });
        scene.transmissions.clear();
        for (const auto& sent : sent_) {
            const double half = glm::distance(sent->sonar.position, scene.sonar.position) / 2,
                         offset = speed_of_sound * (sent->time - scene.time).seconds() / 2;
            if (offset + half <= range && offset + half + range >= 0) scene.transmissions.push_back(sent);
        }
    }

private:
    std::vector<types::TransmissionPtr> sent_;
    size_t look_at_ = 64;  ///< Number of pulses at which add() looks for old ones [1].
};

}  // namespace insonify::sonar
