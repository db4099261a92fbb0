#pragma once
#include <cstdint>
#include <vector>

#include "types/Sonar.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::dataset {

/** The pings of one sample joined to one ping: the beams of the first ping, then those of the second, and so on. Time,
 *  bin duration and speed of sound are those of the first ping. */
class Run {
public:
    /** Adds a ping. Throws std::runtime_error if its beams or bins differ from those of the previous pings. */
    void add(const types::SonarPtr& ping, const types::SonarTruthPtr& truth);

    uint32_t size() const { return static_cast<uint32_t>(pings_.size()); }  ///< Number of pings.
    const std::vector<types::SonarPtr>& pings() const { return pings_; }
    const std::vector<types::SonarTruthPtr>& truths() const { return truths_; }
    const types::Sonar& ping() const { return size() == 1 ? *pings_[0] : ping_; }
    const types::SonarTruth& truth() const { return size() == 1 ? *truths_[0] : truth_; }

private:
    std::vector<types::SonarPtr> pings_;
    std::vector<types::SonarTruthPtr> truths_;
    types::Sonar ping_;  ///< All pings joined; empty for a single ping, as is the truth.
    types::SonarTruth truth_;
};

}  // namespace insonify::dataset
