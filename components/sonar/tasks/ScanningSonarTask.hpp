#pragma once
#include <optional>

#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/sonar/beams/HeadScan.hpp"
#include "components/sonar/tasks/PingTask.hpp"

namespace insonify::sonar {

/** A mechanically scanning sonar: one beam per ping, each at its own pose and bearing of the head.
 *
 *  The scan starts at `head.left_deg` with the first ping after start. With `settings` connected, the head looks at the
 *  bearing that they request instead. A snapshot older than the one before leads to RunTimeError until time advances.
 *  Changing `head` during a scan starts the scan anew. A step that `head.speed_deg_per_s` cannot make in the mean of
 *  the first eight ping periods is a warning. In lockstep, a step that takes longer than one and a half periods between
 *  the first two pings is an error of the configuration. */
class ScanningSonarTask final : public PingTask {
public:
    using PingTask::PingTask;
    framework::Properties<ScanningSonarConfig> config{this};
    SonarConfig sonarConfig() const override { return config->beam(); }

protected:
    bool startHook() override;
    bool propertiesHook() override;
    const char* setLook(types::Snapshot& scene) override;
    void turnHead(types::Angle bearing) override { asked_ = bearing; }
    void stampBearings(types::Sonar& sample) override;
    void goOn() override { scan_->advance(); }
    int pingsPerTurn() const override { return scan_->pingsPerTurn(); }

private:
    /** Look direction of a ping: the sonar with its head ahead, in the world, and the bearing of the head [rad]. */
    struct Look {
        glm::dquat body;
        double bearing;
    };
    /** Follows the periods of the first pings [s], and reports a step that the head cannot make. */
    void checkStep(double seconds);
    /** Returns whether a step takes so much longer than a period [s] that no jitter explains it. */
    bool isFarTooSlow(double period) const;
    std::string stepText(double period) const;
    /** Sets the angular velocity of a sonar whose head has been turned: that of its vehicle, plus the head's own if it
     *  sweeps. */
    void turn(types::Pose& sonar, const Look& look, double seconds) const;

    double bearingDeg() const { return asked_.isUnknown() ? scan_->bearingDeg() : asked_.deg(); }

    std::optional<HeadScan> scan_;
    types::Angle asked_;               ///< Requested by settings.
    std::optional<types::Time> last_;  ///< Time of the ping before.
    std::optional<Look> before_;       ///< Look direction of the ping before.
    int periods_ = 0;                  ///< Periods in the mean [1].
    double mean_period_ = 0;           ///< Mean period of the first pings of the scan [s].
};

/** Registers the tasks of this folder for deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::sonar
