#pragma once
#include <optional>

#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/sonar/PingTask.hpp"
#include "components/sonar/fan/HeadScan.hpp"

namespace insonify::sonar {

/** A mechanically scanning sonar: one beam per ping, each at its own pose and bearing of the head.
 *
 *  The scan starts at `head.left_deg` with the first ping after start; with `settings` connected the head looks where
 *  they say instead. A snapshot older than the one before leads to
 *  RunTimeError until time goes on. A head that is set while it scans starts anew. A step that `head.speed_deg_per_s`
 *  cannot make between the first two pings is an error of the configuration. */
class ScanningSonarTask final : public PingTask {
public:
    using PingTask::PingTask;
    framework::Properties<ScanningSonarConfig> config{this};
    SonarConfig sonarConfig() const override { return config->beam(); }

protected:
    bool startHook() override;
    bool propertiesHook() override;
    const char* steer(types::Snapshot& scene) override;
    void turnHead(types::Angle bearing) override { asked_ = bearing; }
    void stampBearings(types::Sonar& sample) override;
    void goOn() override { scan_->advance(); }
    int pingsPerTurn() const override { return scan_->pingsPerTurn(); }

private:
    /** Where a ping looks: the sonar with its head ahead, in the world, and the bearing of the head [rad]. */
    struct Aim {
        glm::dquat body;
        double bearing;
    };
    void checkStep(double period) const;
    /** Gives a sonar whose head has been turned its angular velocity: that of what carries it, and where the head
     *  sweeps, its own. */
    void turn(types::Pose& sonar, const Aim& aim, double seconds) const;

    double bearingDeg() const { return asked_.isUnknown() ? scan_->bearingDeg() : asked_.deg(); }

    std::optional<HeadScan> scan_;
    types::Angle asked_;               ///< By settings.
    std::optional<types::Time> last_;  ///< Of the ping before.
    std::optional<Aim> before_;        ///< Likewise.
    bool step_checked_ = false;
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::sonar
