#pragma once
#include <optional>

#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/framework/execution/StreamAligner.hpp"
#include "components/output/ByteFile.hpp"
#include "components/recordings/Xtf.hpp"
#include "types/samples/Range.hpp"
#include "types/text/Notice.hpp"

namespace insonify::output {

struct XtfConfig {
    std::string file = "sidescan.xtf";
    recordings::XtfSamples samples = recordings::XtfSamples::Uint16;
    double frequency_khz = 0;
    double timeout = 1;

    static void describe(auto& self, auto& visit) {
        visit({"file", "", "name, relative to the output folder"}, self.file);
        visit({"samples", "",
               "uint16: integers from 0 to 65535, such as a receiver's codes of 16 bits; float32: the bins"},
              self.samples);
        visit({"frequency_khz", "kHz", "frequency of the sonar; 0: unknown", 0, 65535}, self.frequency_khz);
        visit({"timeout", "s", "max wait of a ping for its pose, in the samples' time", 0, 1e6}, self.timeout);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Writes the lines of a side-scan sonar as an XTF file: see Xtf.hpp.
 *
 *  In: `ping`; `pose`, the sonar in the world: the pose at the ping's time is used, or the last before it; `altitude`,
 *  of an altimeter, the newest. A ping before the first pose has none in the file, and is counted. In realtime a file
 *  that cannot be written ends: RunTimeError, and lost pings are counted, as are those for which the disk is too
 *  slow. */
class XtfTask final : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::Properties<XtfConfig> config{this};
    framework::InputPort<types::Pose> pose{this, "pose", "the sonar in the world, as published by sonars"};
    framework::InputPort<types::SonarPtr> ping{this, "ping", "lines to port and starboard"};
    framework::InputPort<types::Range> altitude{this, "altitude", "height above the bottom, the newest is used",
                                                framework::Need::Optional};

    types::Notices notices() const override;
    void check(types::Diagnostics& diagnostics) const override;

private:
    bool startHook() override;
    void updateHook() override;
    void stopHook() override;
    void errorHook() override { updateHook(); }
    void write(const types::Sonar& line);
    void put();

    recordings::XtfFormat format_;
    recordings::XtfPing next_;
    bool has_pose_ = false;
    uint64_t without_pose_ = 0, lost_ = 0;
    std::string failure_;
    types::RecurringDiagnostic slow_;
    types::Time last_;
    std::optional<ByteFile> file_;
    std::vector<char> bytes_;

    framework::StreamAligner aligner_;
    framework::AlignedPort<types::Pose> poses_{aligner_, pose, [this](const types::Pose& sonar) {
                                                   next_.sonar = sonar;
                                                   has_pose_ = true;
                                               }};
    framework::AlignedPort<types::SonarPtr> pings_{aligner_, ping,
                                                   [this](const types::SonarPtr& line) { write(*line); }};
};

}  // namespace insonify::output
