#pragma once
#include <optional>
#include <vector>

#include "components/acoustics/Pulse.hpp"
#include "components/sonar/plan/RenderPlan.hpp"

namespace insonify::sonar {

/** What a pulse leaves of an echo in a bin, quickly: the mean of h over it, by an integral that is made once. */
class EchoShape {
public:
    explicit EchoShape(const acoustics::Pulse& pulse);

    /** Mean of h between two distances from the echo [m]. */
    double mean(double low, double high) const;
    double reach() const { return reach_; }  ///< Beyond it nothing is left [m].

private:
    double integralTo(double distance) const;

    std::optional<acoustics::Pulse> tone_;  ///< A box, which no table holds.
    double reach_, step_ = 0;               ///< [m]
    std::vector<double> response_;          ///< h at steps from 0 on [1].
    std::vector<double> integral_;          ///< From 0 to there, of straight lines between the steps [m].
};

/** Returns what the plan's pulse leaves; none where the plan omits the pulse. */
std::optional<EchoShape> echoShapeOf(const RenderPlan& plan);

}  // namespace insonify::sonar
