#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "components/framework/Properties.hpp"
#include "components/sonar/base/ThreadPool.hpp"
#include "components/sonar/bins/Detection.hpp"
#include "components/sonar/bins/Truth.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "types/samples/DepthMap.hpp"
#include "types/samples/PointCloud.hpp"
#include "types/samples/SonarDetections.hpp"

namespace insonify::sonar {

/** Beams side by side along one axis. */
struct BeamRow {
    int beam_count;
    double field_of_view_deg;

    /** Returns the centre of beam k [deg], counted from the lowest or from starboard. */
    double centreDeg(int k) const { return field_of_view_deg * ((k + 0.5) / beam_count - 0.5); }
    double spacingDeg() const { return field_of_view_deg / beam_count; }

    static void describe(auto& self, auto& visit) {
        visit({"beam_count", "1", "beams side by side", 1, 1024}, self.beam_count);
        visit({"field_of_view_deg", "deg", "angle covered by the beams, edge to edge", 0.01, 180},
              self.field_of_view_deg);
    }
};

/** A grid of beams in azimuth and elevation. */
struct Sonar3dConfig {
    SonarConfig sonar;
    BeamRow horizontal{256, 90}, vertical{64, 40};
    DetectionConfig detection;

    Sonar3dConfig();
    /** Returns the beams of one azimuth as an upright fan: its bearings are their elevations, height becomes width, and
     *  elevation becomes azimuth. With a pattern in azimuth, `quality.rows` of its rows are in the main lobe, and more
     *  in the sidelobes. Valid for a configuration without diagnostics. */
    SonarConfig upright() const;
    double beamWidthDeg() const { return sonar.beam_width_deg.value_or(horizontal.spacingDeg()); }

    static void describe(auto& self, auto& visit) {
        SonarConfig::describeBeam(self.sonar, visit);
        visit({"horizontal", "", "beams in azimuth"}, self.horizontal);
        visit({"vertical", "", "beams in elevation"}, self.vertical);
        visit({"detection", "", "how a beam's return is found"}, self.detection);
    }
    void check(types::Diagnostics& diagnostics) const;

private:
    /** Returns the upright fan with `quality.rows` as configured. */
    SonarConfig standing() const;
};

/** A 3-D sonar: narrow beams in a grid of azimuth and elevation. It reports each beam's strongest return.
 *
 *  Beam (row, column) looks along (cos e cos a, cos e sin a, sin e) of the sonar frame. `beam_width_deg` is its opening
 *  in azimuth; the default is the spacing of the beams. `beam_height_deg` is its opening in elevation. Each column is
 *  rendered as an upright fan, at the time of the ping. Where rays are traced, each thread has a renderer of its own,
 *  and takes columns as it becomes free. `quality.rows` are over the width of one
 *  beam, with a pattern between its half-power points, and `columns_per_beam` over its height; the defaults are 4
 * and 4.
 *
 *  It writes `range_image`: range and intensity of the strongest bin of each beam; `range_truth`: what that bin shows;
 *  `soundings`: the same returns as points in the world; `detections`: the same by beam and travel time; `ping`: for
 * each azimuth the sum over all elevations, with its `truth`. */
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
    framework::OutputPort<types::SonarDetectionsPtr> detections{
        this, "detections",
        "the same by beam: angles, two-way travel times and intensities, in the order of `range_image`"};

    SonarConfig sonarConfig() const override { return config->upright(); }
    RenderedBeam renderedBeam(size_t beam) const override;

protected:
    bool rendersOnce() const override { return false; }
    int renderThreads() const override { return sonarConfig().tracesRays() ? 1 : PingTask::renderThreads(); }
    bool configureHook() override;
    void cleanupHook() override;
    std::span<const Stage> renderStages(const SonarRenderer&) const override { return fan_stages_; }
    bool renderPing(SonarRenderer& renderer, types::Snapshot& scene, types::Sonar& sample,
                    types::SonarTruth* truth_of_ping) override;
    bool wantsTruth() const override { return PingTask::wantsTruth() || range_truth.connected(); }
    RenderPlan coverage(const types::Snapshot& scene) const override;
    void writeMore(const types::Sonar& sample, const types::Pose& sonar) override;
    void findStrongest(const types::Sonar& sample, std::vector<uint32_t>& strongest) override;
    /** Applies `field_of_view` and `beam_count` to a row of beams side by side, and `beam_height` to one beam. */
    Changes changedBy(const types::SonarSettings& requested) const override;

private:
    /** What a thread needs to render columns. */
    struct Worker {
        std::unique_ptr<SonarRenderer> own;  ///< Null for the first thread, which has the task's.
        types::Snapshot scene;               ///< Seen by the fan of a column.
        types::Sonar fan;                    ///< Beams of one azimuth.
        types::Sonar alike;                  ///< What all of these beams record alike.
        types::SonarTruth truth;             ///< Truth of the fan.
        GridTruth grid_truth;
        Detector detector;
        sonar::Stages stages{};  ///< Sum over its columns of this ping.
        bool received = false;
    };
    /** A ping whose columns are rendered. */
    struct PingOfColumns {
        SonarRenderer& renderer;  ///< The task's.
        const types::Snapshot& scene;
        types::Sonar& sample;
        types::SonarTruth* truth;     ///< Null: none.
        const DetectionRules* rules;  ///< Null: no returns are wanted.
        bool has_all_workers;         ///< Whether each worker follows the scene, though it may get no column.
        std::atomic<int> next;        ///< Column that the next free thread takes.
    };

    /** Turns the pose of the sonar to the upright fan of one azimuth. */
    void turnUpright(types::Pose& sonar, size_t column) const;
    /** Makes the workers that are missing. Returns whether each must take part in the ping. */
    bool prepareWorkers(const SonarRenderer& renderer, const types::Snapshot& scene);
    /** Renders columns as one of the workers, until none is left. */
    void work(PingOfColumns& columns, size_t number);
    /** Makes a worker's renderer, or switches it to the ping's geometry and configuration. */
    void updateWorker(const PingOfColumns& columns, Worker& worker) const;
    void renderColumn(PingOfColumns& columns, size_t column, SonarRenderer& renderer, Worker& worker);
    /** Writes the returns of one upright fan into a column of the map, and their truth if there is one. */
    void detect(size_t column, const PingOfColumns& columns, Worker& worker);
    /** Adds one upright fan to its beam of the ping, and the ring-down of the sonar once. */
    static void addTo(types::Sonar& sample, size_t column, const SonarRenderer& renderer, Worker& worker);
    void shape(const types::Sonar& fan, types::Sonar& sample);
    void writePoints(const types::Sonar& sample, const types::Pose& sonar);
    void writeDetections(const types::Sonar& sample);
    void writeReturnTruth();
    bool wantsReturns() const {
        return range_image.connected() || soundings.connected() || range_truth.connected() || detections.connected();
    }

    std::optional<ThreadPool> column_threads_;  ///< Made at the first ping; of one thread where images are rasterised.
    std::vector<Worker> workers_;               ///< One for each thread.
    types::GeometryPtr known_geometry_;         ///< That the workers have.
    std::shared_ptr<const std::vector<uint32_t>> known_movable_;  ///< Snapshot::movable that the workers know.
    bool lacks_config_ = false;   ///< Whether the workers lack the present configuration.
    sonar::Stages fan_stages_{};  ///< Sum over all azimuths of the last ping.
    types::DepthMap map_;
    std::vector<double> levels_;      ///< Of the return of each cell of the map, without spreading [1].
    DetectionRules summed_rules_;     ///< Of the sums over all elevations.
    types::SonarTruth return_truth_;  ///< One bin for each cell of the map.
    framework::SamplePool<types::DepthMap> maps_;
    framework::SamplePool<types::PointCloud> clouds_;
    framework::SamplePool<types::SonarDetections> all_detections_;
    framework::SamplePool<types::SonarTruth> return_truths_;
};

}  // namespace insonify::sonar
