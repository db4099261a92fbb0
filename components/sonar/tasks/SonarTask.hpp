#pragma once
#include "components/framework/Properties.hpp"
#include "components/sonar/tasks/PingTask.hpp"

namespace insonify::sonar {

/** A forward-looking imaging sonar: a fan of beams per ping.
 *
 *  Bins hold E/S0 of the active sonar equation (`physical`) or means of S(n.d) (`cerqueira2017`), beam-first. The
 *  sonar frame is x ahead, y to port, z up; bearings are positive to port. */
class SonarTask final : public PingTask {
public:
    using PingTask::PingTask;
    framework::Properties<SonarConfig> config{this};
    SonarConfig sonarConfig() const override { return config->fan(); }
};

}  // namespace insonify::sonar
