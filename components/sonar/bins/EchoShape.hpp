#pragma once
#include <optional>
#include <vector>

#include "components/acoustics/Pulse.hpp"
#include "components/sonar/plan/RenderPlan.hpp"

namespace insonify::sonar {

/** The mean of a pulse's response h over a bin, computed quickly from an integral that is made once. */
class EchoShape {
public:
    explicit EchoShape(const acoustics::Pulse& pulse);

    /** Returns the mean of h between two distances from the echo [m]. */
    double mean(double low, double high) const;
    double reach() const { return reach_; }  ///< Distance beyond which h is 0 [m].

private:
    double integralTo(double distance) const;

    std::optional<acoustics::Pulse> tone_;  ///< A box, which a table cannot represent.
    double reach_, step_ = 0;               ///< [m]
    std::vector<double> response_;          ///< h at steps from 0 [1].
    std::vector<double> integral_;          ///< Integral from 0, with straight lines between the steps [m].
};

/** Returns the shape of the plan's pulse; none where the plan omits the pulse. */
std::optional<EchoShape> echoShape(const RenderPlan& plan);

}  // namespace insonify::sonar
