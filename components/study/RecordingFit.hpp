#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/study/FitChain.hpp"
#include "components/study/FitLevels.hpp"
#include "components/study/FitSpeckle.hpp"

namespace insonify::study {

/** What a recording says of one property of the device or its surroundings. */
struct Finding {
    std::string name, unit;
    Fitted found;
    bool is_determined = false;  ///< The interval is small enough to be of use, see `text`.
    std::string note = {};       ///< How it was found, or why it is not determined.

    /** "24.2 (23.9 to 24.6) dB", or "not determined by this recording: ...". */
    std::string text() const;
};

/** Properties of a sonar as a recording states them. */
struct RecordingFit {
    FitChain chain;  ///< The deployment's with everything that was found.
    LevelFit levels;
    std::vector<Finding> findings;
    SpeckleMoments recorded, simulated;
    std::vector<CodedPing> simulated_pings;  ///< Of the chain.

    const Finding* finding(const std::string& name) const;  ///< Null where there is none of that name.
};

/** Finds what a maker does not publish from recorded pings of one shape and the scene of a deployment.
 *
 *  Levels over range state gain, noise, time-varied gain and absorption (`fitLevels`). Speckle that neighbouring beams
 *  and bins share states the width of a beam and the length of the pulse, the law of its intensities the number of
 *  scatterers in a cell (`momentsOf`). These are then measured in simulated pings by the same statistics, and moved
 *  until both agree (indirect inference: Gourieroux, Monfort and Renault 1993).
 *
 *  @param rough see LevelOptions @param progress is called with what is being done
 *  @throws types::ConfigError for recordings from which nothing can be found: without a ping, with one code throughout,
 *  with fewer than 32 beams or 64 bins, or without a frequency */
RecordingFit fitRecording(const std::vector<CodedPing>& recorded, FitChain chain, bool rough,
                          const std::function<void(const std::string&)>& progress);

}  // namespace insonify::study
