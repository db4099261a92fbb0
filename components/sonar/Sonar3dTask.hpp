#pragma once
#include <vector>

#include "components/framework/Properties.hpp"
#include "components/sonar/PingTask.hpp"
#include "components/sonar/echo/Detection.hpp"
#include "components/sonar/echo/GridTruth.hpp"
#include "types/DepthMap.hpp"
#include "types/PointCloud.hpp"

namespace insonify::sonar {

/** Beams side by side along one axis. */
struct BeamRow {
    int beam_count;
    double field_of_view_deg;

    /** Centre of beam k [deg], from the lowest or from starboard on. */
    double centreDeg(int k) const { return field_of_view_deg * ((k + 0.5) / beam_count - 0.5); }
    double spacingDeg() const { return field_of_view_deg / beam_count; }

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"beam_count", "1", "beams side by side", 1, 1024}, self.beam_count);
        visit(Field{"field_of_view_deg", "deg", "covered by them, edge to edge", 0.01, 180}, self.field_of_view_deg);
    }
};

/** A grid of beams in azimuth and elevation. */
struct Sonar3dConfig {
    SonarConfig sonar;
    BeamRow horizontal{256, 90}, vertical{64, 40};
    DetectionConfig detection;

    Sonar3dConfig();
    /** The beams of one azimuth, as a fan that stands upright: its bearings are their elevations, what is height here
     *  is width there, and elevation is azimuth. */
    SonarConfig upright() const;
    double beamWidthDeg() const { return sonar.beam_width_deg.value_or(horizontal.spacingDeg()); }

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        SonarConfig::describeBeam(self.sonar, visit);
        visit(Field{"horizontal", "", "beams in azimuth"}, self.horizontal);
        visit(Field{"vertical", "", "beams in elevation"}, self.vertical);
        visit(Field{"detection", "", "how a beam's return is found"}, self.detection);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** A 3-D sonar: narrow beams in a grid of azimuth and elevation, of each of which the strongest return is told.
 *
 *  Beam (row, column) looks along (cos e cos a, cos e sin a, sin e) of the sonar frame. `beam_width_deg` is its opening
 *  in azimuth, the distance between two beams where it is not given, `beam_height_deg` that in elevation. The columns
 *  are rendered one after the other as upright fans, all at the time of the ping; `quality.rows` are over the width of
 *  one beam, `columns_per_beam` over its height, 4 and 4 where nothing is said. Out: `range_image`, of every beam the
 *  range and the intensity of the strongest bin; `range_truth`, what that bin shows; `soundings`, the same as points in
 *  the world; `ping`, of each azimuth the sum over all elevations, with its `truth`. */
class Sonar3dTask final : public PingTask {
public:
    using PingTask::PingTask;

    framework::Properties<Sonar3dConfig> config{this};
    framework::OutputPort<types::DepthMapPtr> range_image{
        this, "range_image", "range and intensity of each beam's strongest return, rows from the top"};
    framework::OutputPort<types::SonarTruthPtr> range_truth{
        this, "range_truth",
        "what each beam's strongest return shows: one bin for each cell of `range_image`, in its order"};
    framework::OutputPort<types::PointCloudPtr> soundings{this, "soundings", "the same as points in the world"};

    SonarConfig sonarConfig() const override { return config->upright(); }

protected:
    bool rendersOnce() const override { return false; }
    std::span<const Stage> renderStages(const SonarRenderer&) const override { return fan_stages_; }
    bool renderPing(SonarRenderer& renderer, types::Snapshot& scene, types::Sonar& sample,
                    types::SonarTruth* truth_of_ping) override;
    bool wantsTruth() const override { return PingTask::wantsTruth() || range_truth.connected(); }
    RenderPlan coverage(const types::Snapshot& scene) const override;
    void tellMore(const types::Sonar& sample, const types::Pose& sonar) override;
    /** `field_of_view` and `beam_count` are those of a row of beams side by side, `beam_height` is that of one beam. */
    std::map<std::string, std::string> changedBy(const types::SonarSettings& asked) const override;

private:
    /** Takes the returns of one upright fan into a column of the map, and their truth if there is one. */
    void detect(int column, bool with_truth);
    /** Adds one upright fan to its beam of the ping. */
    void addTo(types::Sonar& sample, int column) const;
    void shape(types::Sonar& sample);
    void writePoints(const types::Sonar& sample, const types::Pose& sonar);
    void writeReturnTruth();
    bool wantsReturns() const { return range_image.connected() || soundings.connected() || range_truth.connected(); }

    types::Sonar fan_;            ///< Of one azimuth.
    sonar::Stages fan_stages_{};  ///< Of all azimuths of the last ping.
    types::DepthMap map_;
    GridTruth grid_truth_;
    types::SonarTruth fan_truth_;     ///< Of one azimuth.
    types::SonarTruth return_truth_;  ///< A bin for each cell of the map.
    framework::SamplePool<types::DepthMap> maps_;
    framework::SamplePool<types::PointCloud> clouds_;
    framework::SamplePool<types::SonarTruth> return_truths_;
};

}  // namespace insonify::sonar
