#include "components/sonar/tasks/Sonar3dTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/sonar/beams/Directivity.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr int default_samples = 4;  // of one beam, in each direction
constexpr int64_t max_beams = int64_t{1} << 18;

}  // namespace

Sonar3dConfig::Sonar3dConfig() {
    sonar.range = 20;
    sonar.beam_height_deg = vertical.spacingDeg();
}

SonarConfig Sonar3dConfig::upright() const {
    SonarConfig fan = standing();
    if (fan.beam_pattern && fan.beam_pattern->hasElevation())
        fan.quality.rows = Directivity(fan).rowsFor(*fan.quality.rows, !fan.tracesRays());
    return fan;
}

SonarConfig Sonar3dConfig::standing() const {
    SonarConfig fan = sonar;
    fan.bearings_deg.clear();
    for (int row = 0; row < vertical.beam_count; ++row) fan.bearings_deg.push_back(vertical.centreDeg(row));
    fan.beam_width_deg = sonar.beam_height_deg;
    fan.beam_height_deg = beamWidthDeg();
    fan.quality.rows = sonar.quality.rows.value_or(default_samples);
    fan.quality.columns_per_beam = sonar.quality.columns_per_beam.value_or(default_samples);
    if (fan.beam_pattern)
        for (ArrayConfig* array : {&fan.beam_pattern->transmit, &fan.beam_pattern->receive})
            std::swap(array->azimuth, array->elevation);
    return fan;
}

void Sonar3dConfig::check(types::Diagnostics& diagnostics) const {
    const auto refuse = [&](const char* key, std::string why) { diagnostics.push_back({key, std::move(why)}); };
    const int64_t beams = int64_t{horizontal.beam_count} * vertical.beam_count;
    if (beams > max_beams)
        refuse("horizontal.beam_count", fmt::format("is {}, with {} in the vertical {} beams; may be {}",
                                                    horizontal.beam_count, vertical.beam_count, beams, max_beams));
    if (sonar.beam_height_deg > 120)
        refuse("beam_height_deg", fmt::format("is {:g} deg; one beam may have 120", sonar.beam_height_deg));
    if (beamWidthDeg() > 120)
        refuse("beam_width_deg", fmt::format("is {:g} deg; one beam may have 120", beamWidthDeg()));
    if (sonar.beam_geometry != BeamGeometry::Planar)
        refuse("beam_geometry", "is conical; the beams of a 3-D sonar are planar, by azimuth and elevation");
    if (sonar.quality.target_error || sonar.quality.budget_ms || sonar.quality.max_samples)
        refuse("quality", "has a target; a 3-D sonar takes rows and columns_per_beam, of one beam");
    if (sonar.beam_pattern && sonar.beam_pattern->transmit.azimuth)
        refuse("beam_pattern.transmit.azimuth", "is given; a 3-D sonar is assumed to transmit equally in all azimuths");
    if (diagnostics.empty()) standing().checkBeam(diagnostics);
}

TriggeredTask::Changes Sonar3dTask::changedBy(const types::SonarSettings& requested) const {
    types::SonarSettings of_all = requested;
    of_all.field_of_view = of_all.beam_height = {};
    of_all.beam_count = 0;
    Changes changes = PingTask::changedBy(of_all);
    const BeamRow& row = config->horizontal;
    if (const auto beams = requested.beam_count; beams != 0 && beams != static_cast<uint32_t>(row.beam_count))
        changes["horizontal.beam_count"] = beams;
    const auto compare = [&](const char* name, types::Angle wanted, double now) {
        if (!wanted.isUnknown() && wanted.deg() != now) changes[name] = wanted.deg();
    };
    compare("horizontal.field_of_view_deg", requested.field_of_view, row.field_of_view_deg);
    compare("beam_height_deg", requested.beam_height, config->sonar.beam_height_deg);
    return changes;
}

RenderPlan Sonar3dTask::coverage(const types::Snapshot& scene) const {
    SonarConfig fan = config->sonar;
    fan.beam_width_deg.reset();
    fan.beam_pattern.reset();  // that of one beam
    fan.beam_count = config->horizontal.beam_count;
    fan.field_of_view_deg = config->horizontal.field_of_view_deg;
    fan.beam_height_deg = std::min(config->vertical.field_of_view_deg, fan.tracesRays() ? 180 : tallest_image_deg);
    return makeRenderPlan(fan, *scene.geometry);
}

void Sonar3dTask::turnUpright(types::Pose& sonar, size_t column) const {
    const double azimuth = types::radians(config->horizontal.centreDeg(static_cast<int>(column)));
    const glm::dquat stood_up = glm::angleAxis(types::radians(90), glm::dvec3(1, 0, 0));  // bearings become elevations
    const glm::dvec3 turn = sonar.orientation * sonar.angular_velocity;                   // in the world
    sonar.orientation = sonar.orientation * glm::angleAxis(azimuth, glm::dvec3(0, 0, 1)) * stood_up;
    sonar.angular_velocity = glm::conjugate(sonar.orientation) * turn;
}

PingTask::RenderedBeam Sonar3dTask::renderedBeam(size_t beam) const {
    RenderedBeam rendered = PingTask::renderedBeam(beam);
    turnUpright(rendered.scene.sonar, beam);
    rendered.beam.reset();
    return rendered;
}

bool Sonar3dTask::configureHook() {
    lacks_config_ = true;
    return PingTask::configureHook();
}

void Sonar3dTask::cleanupHook() {
    PingTask::cleanupHook();
    workers_.clear();
    column_threads_.reset();
}

bool Sonar3dTask::prepareWorkers(const SonarRenderer& renderer, const types::Snapshot& scene) {
    const bool traces_rays = renderer.renderPlan().traces_rays;
    if (!traces_rays) workers_.resize(std::min<size_t>(workers_.size(), 1));  // the task's thread has the images
    const bool are_new = workers_.empty();
    if (are_new) {
        column_threads_.emplace(traces_rays ? PingTask::renderThreads() : 1, ThreadPool::Threads::Shared);
        workers_.resize(static_cast<size_t>(column_threads_->size()));
    }
    for (Worker& worker : workers_) {
        worker.scene = scene;
        if (&worker != &workers_.front()) worker.scene.ahead.reset();  // what the task's renderer prepares
        worker.received = false;
        worker.stages = empty_stages;
    }
    const bool has_changed = known_geometry_ != scene.geometry || known_movable_ != scene.movable || lacks_config_;
    known_geometry_ = scene.geometry;
    known_movable_ = scene.movable;
    return are_new || has_changed || renderer.isRemembered(scene);
}

void Sonar3dTask::updateWorker(const PingOfColumns& columns, Worker& worker) const {
    const SonarConfig& fan = columns.renderer.renderPlan().config;
    if (!worker.own) {
        worker.own = std::make_unique<SonarRenderer>(fan, columns.scene.geometry, RenderOptions{.threads = 1});
        return;
    }
    worker.own->setGeometry(columns.scene.geometry);
    if (lacks_config_) worker.own->setConfig(fan);
}

void Sonar3dTask::work(PingOfColumns& columns, size_t number) {
    Worker& worker = workers_[number];
    if (number > 0 && columns.has_all_workers) updateWorker(columns, worker);
    SonarRenderer& renderer = number > 0 ? *worker.own : columns.renderer;
    renderer.setTruth(worker.fan, columns.truth ? &worker.truth : nullptr);
    if (columns.has_all_workers) {  // the motion of sonar and objects is that seen by the first column
        turnUpright(worker.scene.sonar, 0);
        renderer.follow(worker.scene);
    }
    const bool has_first = number == 0 || columns.has_all_workers;
    for (int column = has_first ? static_cast<int>(number) : columns.next++; column < config->horizontal.beam_count;
         column = columns.next++)
        renderColumn(columns, static_cast<size_t>(column), renderer, worker);
}

void Sonar3dTask::renderColumn(PingOfColumns& columns, size_t column, SonarRenderer& renderer, Worker& worker) {
    worker.scene.sonar = columns.scene.sonar;
    turnUpright(worker.scene.sonar, column);
    renderer.render(worker.scene, worker.fan);
    for (size_t i = 0; i < worker.stages.size(); ++i) worker.stages[i].seconds += renderer.stages()[i].seconds;
    worker.received = renderer.hasEchoes() || renderer.othersReceived() > 0 || worker.received;
    addTo(columns.sample, column, renderer, worker);
    if (columns.truth) worker.grid_truth.addTo(worker.fan, worker.truth, column, *columns.truth);
    if (columns.rules) detect(column, columns, worker);
}

bool Sonar3dTask::renderPing(SonarRenderer& renderer, types::Snapshot& scene, types::Sonar& sample,
                             types::SonarTruth* truth_of_ping) {
    const bool has_all_workers = prepareWorkers(renderer, scene);
    types::Sonar& fan = workers_.front().fan;
    renderer.fillHeader(scene, fan);
    shape(fan, sample);
    if (truth_of_ping) GridTruth::shape(sample, map_.vertical_size, *truth_of_ping, return_truth_);
    PingOfColumns columns{renderer,
                          scene,
                          sample,
                          truth_of_ping,
                          wantsReturns() ? &detectionRules() : nullptr,
                          has_all_workers,
                          has_all_workers ? column_threads_->size() : 1};
    const auto job = [&](int part, int) { work(columns, static_cast<size_t>(part)); };
    has_all_workers ? column_threads_->run(job) : column_threads_->share(job);
    lacks_config_ = false;
    fan_stages_ = empty_stages;
    bool received = false;
    for (const Worker& worker : workers_) {
        for (size_t i = 0; i < fan_stages_.size(); ++i)
            fan_stages_[i].seconds += worker.stages[i].seconds / static_cast<double>(workers_.size());
        received = received || worker.received;
    }
    return received;
}

void Sonar3dTask::shape(const types::Sonar& fan, types::Sonar& sample) {
    const BeamRow &across = config->horizontal, &up = config->vertical;
    const auto columns = static_cast<size_t>(across.beam_count), rows = static_cast<size_t>(up.beam_count);
    sample.time = fan.time;
    sample.timestamps.clear();
    static_cast<types::RangeBins&>(sample) = fan;
    sample.bin_count = fan.bin_count;
    sample.beam_count = static_cast<uint32_t>(columns);
    sample.beam_width = types::Angle::fromDeg(config->beamWidthDeg());
    sample.beam_height = types::Angle::fromDeg(up.field_of_view_deg);
    sample.bearings.resize(columns);
    for (int k = 0; k < across.beam_count; ++k)
        sample.bearings[static_cast<size_t>(k)] = types::Angle::fromDeg(across.centreDeg(k));
    sample.bins.assign(columns * fan.bin_count, 0);
    map_.time = fan.time;
    map_.bin_width = fan.binWidth();
    map_.vertical_size = static_cast<uint32_t>(rows);
    map_.horizontal_size = static_cast<uint32_t>(columns);
    map_.vertical_interval.resize(rows);
    map_.horizontal_interval.resize(columns);
    for (size_t row = 0; row < rows; ++row)  // from the top
        map_.vertical_interval[row] = types::radians(up.centreDeg(static_cast<int>(row)));
    for (size_t column = 0; column < columns; ++column)  // from the left
        map_.horizontal_interval[column] = -types::radians(across.centreDeg(static_cast<int>(column)));
    map_.distances.assign(rows * columns, types::DepthMap::too_far);
    map_.remissions.assign(rows * columns, 0);
    levels_.assign(rows * columns, 0);
}

void Sonar3dTask::addTo(types::Sonar& sample, size_t column, const SonarRenderer& renderer, Worker& worker) {
    const types::Sonar& fan = worker.fan;
    float* const sum = sample.bins.data() + column * sample.bin_count;
    for (size_t row = 0; row < fan.bins.size(); row += fan.bin_count)
        for (size_t k = 0; k < fan.bin_count; ++k) sum[k] += fan.bins[row + k];
    if (fan.beam_count < 2 || !renderer.computeAlike(fan, worker.alike)) return;
    // The sonar rings once: its mean over the beams that were summed remains.
    const double too_many = 1 - 1.0 / fan.beam_count;
    const std::vector<float>& alike = worker.alike.bins;
    for (size_t k = 0; k < fan.bin_count; ++k) {
        double ringing = 0;
        for (size_t i = k; i < alike.size(); i += fan.bin_count) ringing += double{alike[i]};
        if (ringing > 0) sum[k] = std::max(0.0f, static_cast<float>(double{sum[k]} - too_many * ringing));
    }
}

void Sonar3dTask::detect(size_t column, const PingOfColumns& columns, Worker& worker) {
    const types::Sonar& fan = worker.fan;
    worker.detector.take(fan, config->detection, *columns.rules);
    const size_t from_left = map_.horizontal_size - 1 - column;
    for (uint32_t beam = 0; beam < fan.beam_count; ++beam)
        if (const auto found = worker.detector.strongest(beam)) {
            const size_t cell = size_t{map_.vertical_size - 1 - beam} * map_.horizontal_size + from_left;
            map_.distances[cell] = static_cast<float>(found->range);
            map_.remissions[cell] = found->intensity;
            levels_[cell] = found->level;
            if (columns.truth) GridTruth::copyReturn(worker.truth, beam, found->bin, cell, return_truth_);
        }
}

void Sonar3dTask::writeMore(const types::Sonar& sample, const types::Pose& sonar) {
    if (!wantsReturns()) return;
    const double strongest = *std::max_element(levels_.begin(), levels_.end());
    const double minimum = strongest * std::pow(10, config->detection.threshold_db / 10);
    for (size_t cell = 0; cell < map_.distances.size(); ++cell)  // weak in the ping, if not in their azimuth
        if (levels_[cell] < minimum) {
            map_.distances[cell] = types::DepthMap::too_far;
            map_.remissions[cell] = 0;
            if (range_truth.connected()) GridTruth::forget(cell, return_truth_);
        }
    if (soundings.connected()) writePoints(sample, sonar);
    if (detections.connected()) writeDetections(sample);
    if (range_truth.connected()) writeReturnTruth();
    if (!range_image.connected()) return;
    const auto image = maps_.take();
    *image = map_;
    maps_.stock(*image);
    range_image.write(image);
}

void Sonar3dTask::findStrongest(const types::Sonar& sample, std::vector<uint32_t>& strongest) {
    const std::vector<float>& fan = detectionRules().water;
    summed_rules_.returns = detectionRules().returns;
    summed_rules_.water.assign(fan.empty() ? 0 : sample.bins.size(), 0);
    for (size_t beam = 0; beam < sample.beam_count; ++beam)  // each is the sum over all elevations
        for (size_t i = 0; i < fan.size(); ++i)
            summed_rules_.water[beam * sample.bin_count + i % sample.bin_count] += fan[i];
    PingTask::findStrongest(sample, summed_rules_, strongest);
}

void Sonar3dTask::writeReturnTruth() {
    const auto written = return_truths_.take();
    nameObjects(return_truth_);
    *written = return_truth_;
    return_truths_.stock(*written);
    range_truth.write(written);
}

void Sonar3dTask::writeDetections(const types::Sonar& sample) {
    const auto written = all_detections_.take();
    written->copyPing(sample);
    written->beam_height = types::Angle::fromDeg(config->sonar.beam_height_deg);  // the ping's is that of all rows
    written->reserve(map_.distances.size());
    for (size_t row = 0; row < map_.vertical_size; ++row)
        for (size_t column = 0; column < map_.horizontal_size; ++column) {
            const size_t cell = row * map_.horizontal_size + column;
            written->add({map_.horizontal_interval[column]}, {-map_.vertical_interval[row]},
                         static_cast<double>(map_.distances[cell]), map_.remissions[cell]);
        }
    all_detections_.stock(*written, [this](types::SonarDetections& other) { other.reserve(map_.distances.size()); });
    detections.write(written);
}

void Sonar3dTask::writePoints(const types::Sonar& sample, const types::Pose& sonar) {
    const auto cloud = clouds_.take();
    cloud->clear();
    cloud->reserve(map_.distances.size());
    cloud->time = sample.time;
    for (size_t row = 0; row < map_.vertical_size; ++row)
        for (size_t column = 0; column < map_.horizontal_size; ++column) {
            const size_t cell = row * map_.horizontal_size + column;
            if (!std::isfinite(map_.distances[cell])) continue;
            const glm::dvec3 offset = map_.direction(row, column) * static_cast<double>(map_.distances[cell]);
            cloud->add(sonar.position + sonar.orientation * offset, static_cast<double>(map_.remissions[cell]));
        }
    clouds_.stock(*cloud, [this](types::PointCloud& other) { other.reserve(map_.distances.size()); });
    soundings.write(cloud);
}

}  // namespace insonify::sonar
