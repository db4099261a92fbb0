#pragma once
#include <vector>

#include "components/sonar/RenderPlan.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

/** The transmitter, as every beam hears it in its first bins (ACOUSTICS.md 5.15). */
class RingDown {
public:
    /** Of a plan whose pulse has one. */
    explicit RingDown(const RenderPlan& plan);
    /** Once the bins are filled. Allocates nothing. */
    void add(types::Sonar& ping) const;

private:
    std::vector<float> bins_;  ///< Of each beam, as far as anything is left.
};

}  // namespace insonify::sonar
