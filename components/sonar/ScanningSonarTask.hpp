#pragma once
#include <optional>

#include "components/framework/Properties.hpp"
#include "components/sonar/HeadScan.hpp"
#include "components/sonar/PingTask.hpp"

namespace insonify::sonar {

/** A mechanically scanning sonar: one beam per ping, each at its own pose and bearing of the head.
 *
 *  The scan starts at `head.left_deg` with the first ping after start. A snapshot older than the one before leads to
 *  RunTimeError until time goes on. A head that is set while it scans starts anew. A step that `head.speed_deg_per_s`
 * cannot make between the first two pings is an error of the configuration. */
class ScanningSonarTask final : public PingTask {
public:
    using PingTask::PingTask;
    framework::Properties<ScanningSonarConfig> config{this};
    SonarConfig sonarConfig() const override { return config->beam(); }

protected:
    bool startHook() override;
    bool propertiesHook() override;
    const char* steer(types::Snapshot& scene) override;
    void stampBearings(types::Sonar& sample) override;
    int pingsPerTurn() const override { return scan_->pingsPerTurn(); }

private:
    void checkStep(double period) const;

    std::optional<HeadScan> scan_;
    std::optional<types::Time> last_;  ///< Of the ping before.
    bool step_checked_ = false;
};

}  // namespace insonify::sonar
