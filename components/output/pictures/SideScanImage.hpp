#pragma once
#include <optional>

#include "components/output/pictures/WaterfallImage.hpp"
#include "components/output/tasks/PictureConfig.hpp"
#include "types/ReturnLevels.hpp"
#include "types/samples/Range.hpp"

namespace insonify::output {

/** Parameters of the conversion from slant range to range along a flat bottom. */
struct GroundRangeConfig {
    std::optional<double> altitude;
    double threshold_db = -20;

    static void describe(auto& self, auto& visit) {
        visit({"altitude", "m",
               "height above the bottom; absent: that of port altitude, else the range of the first return", 0, 1e5},
              self.altitude);
        visit({"threshold_db", "dB",
               "min level of the first return without spreading, relative to the strongest of the ping", -300, 0},
              self.threshold_db);
    }
};

struct SideScanPictureConfig : PictureConfig {
    std::optional<GroundRangeConfig> ground_range;

    static void describe(auto& self, auto& visit) {
        PictureConfig::describe(self, visit);
        visit({"ground_range", "",
               "rows in range along a flat bottom, sqrt(r^2 - h^2), without the water column; absent: in "
               "slant range"},
              self.ground_range);
    }
};

/** Draws the lines of a side-scan: every ping is a row, the newest on top, port to the left and starboard to the right
 *  of the middle. The bearing of a beam gives its side; the first of several beams on a side counts. */
class SideScanImage final : public WaterfallImage {
public:
    explicit SideScanImage(const SideScanPictureConfig& config);

    /** Sets the measured height above the bottom for the following pings [m]; not finite: unknown. */
    void setAltitude(double altitude) { altitude_ = altitude; }
    /** Sets what is known of the bins of the following pings. */
    void setReturns(const types::ReturnRules& returns) { returns_ = returns; }

private:
    void fillRow(const types::Sonar& ping, cv::Mat& row) override;
    void addRanges(Overlay& overlay, double range) const override;
    double computeAltitude(const types::Sonar& ping);

    std::optional<GroundRangeConfig> ground_range_;
    bool is_decibel_;
    double altitude_ = types::Range::none;
    types::ReturnRules returns_;
    types::ReturnLevels levels_;
};

}  // namespace insonify::output
