#pragma once
#include <cstdint>
#include <vector>

#include "types/Sonar.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::dataset {

/** The pings of one sample as one ping: its beams are those of the first, then those of the second, and so on. Time,
 *  bin duration and speed of sound are those of the first. */
class Run {
public:
    /** Throws std::runtime_error for a ping of other beams or bins than those before. */
    void add(const types::SonarPtr& ping, const types::SonarTruthPtr& truth);

    uint32_t size() const { return static_cast<uint32_t>(pings_.size()); }  ///< Pings.
    const std::vector<types::SonarPtr>& pings() const { return pings_; }
    const std::vector<types::SonarTruthPtr>& truths() const { return truths_; }
    const types::Sonar& ping() const { return size() == 1 ? *pings_[0] : ping_; }
    const types::SonarTruth& truth() const { return size() == 1 ? *truths_[0] : truth_; }

private:
    std::vector<types::SonarPtr> pings_;
    std::vector<types::SonarTruthPtr> truths_;
    types::Sonar ping_;  ///< All as one; empty for one alone, as the truth.
    types::SonarTruth truth_;
};

}  // namespace insonify::dataset
