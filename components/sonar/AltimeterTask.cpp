#include "components/sonar/AltimeterTask.hpp"

namespace insonify::sonar {

SonarConfig AltimeterConfig::beam() const {
    SonarConfig one = sonar;
    one.bearings_deg = {0};
    return one;
}

void AltimeterTask::tellMore(const types::Sonar& sample, const types::Pose& /*sonar*/) {
    if (!range.connected()) return;
    types::Range told;
    told.time = sample.time;
    if (const auto found = Detector(config->detection, sample, binWidth()).first(0)) told.range = found->range;
    told.range_min = config->sonar.range_min;
    told.range_max = binWidth() * sample.bin_count;
    told.field_of_view = sample.beam_width;
    range.write(told);
}

}  // namespace insonify::sonar
