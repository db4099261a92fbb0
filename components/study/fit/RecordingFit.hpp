#pragma once
#include <functional>
#include <string>
#include <vector>

#include "components/study/fit/FitChain.hpp"
#include "components/study/fit/FitLevels.hpp"
#include "components/study/fit/FitSpeckle.hpp"

namespace insonify::study {

/** The value of one property of the device or its surroundings, found from a recording. */
struct Finding {
    std::string name, unit;
    Fitted found;
    bool is_determined = false;  ///< Whether the interval is small enough to be useful, see `text`.
    std::string note = {};       ///< The method, or why the value is not determined.

    /** Returns "24.2 (23.9 to 24.6) dB", or "not determined by this recording: ...". */
    std::string text() const;
};

/** Properties of a sonar, fitted to a recording. */
struct RecordingFit {
    FitChain chain;  ///< The deployment's chain with all fitted values.
    LevelFit levels;
    std::vector<Finding> findings;
    SpeckleMoments recorded, simulated;
    std::vector<CodedPing> simulated_pings;  ///< Pings of the chain.

    const Finding* finding(const std::string& name) const;  ///< Returns null if there is none of that name.
};

/** Finds unpublished properties of a device from recorded pings of one shape and the scene of a deployment.
 *
 *  Levels over range determine gain, noise, time-varied gain and absorption (`fitLevels`). The correlation of speckle
 *  between neighbouring beams and bins determines the beam width and the pulse length; the law of its intensities
 *  determines the number of scatterers in a cell (`momentsOf`). The same statistics are then measured in simulated
 *  pings, and the properties are moved until both agree (indirect inference: Gourieroux, Monfort and Renault 1993).
 *
 *  @param rough see LevelOptions
 *  @param progress called with the current step
 *  @throws types::ConfigError for unusable recordings: without a ping, with one code throughout, with fewer than 32
 *  beams or 64 bins, or without a frequency */
RecordingFit fitRecording(const std::vector<CodedPing>& recorded, FitChain chain, bool rough,
                          const std::function<void(const std::string&)>& progress);

}  // namespace insonify::study
