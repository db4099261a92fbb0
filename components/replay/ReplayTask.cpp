#include "components/replay/ReplayTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "components/framework/config/DeploymentSpec.hpp"
#include "components/framework/execution/Activity.hpp"
#include "components/log/Reader.hpp"

namespace insonify::replay {
namespace {

/** Returns a warning of the longest time without samples of the streams that are played, if it is longer than an hour,
 *  as after stamps of another clock. */
std::string gapText(const std::vector<log::SampleRef>& samples, const log::LoggerClock& clock, auto&& is_played) {
    constexpr double long_gap = 3600;   // [s]
    std::optional<types::Time> before;  // since the first sample
    types::Time gap, after;
    for (const log::SampleRef& at : samples) {
        if (!is_played(at.stream)) continue;
        const types::Time time = clock.sinceFirst(samples, at);
        if (!before) before = time;
        if (time - *before > gap) gap = time - *before, after = time;
        before = std::max(*before, time);
    }
    if (!(gap.seconds() > long_gap)) return "";
    return fmt::format(
        "the log has no sample for {:.6g} s (its stamps may be of two clocks), which its replay waits for; from: "
        "{:.6f} begins behind it, and pace: 0 does not wait",
        gap.seconds(), after.seconds());
}

/** Whether a stream has Rock's beams or scans, which are also pings. */
bool isOlderPing(const log::Stream& stream) { return log::holdsPings(stream) && !stream.holds<types::Sonar>(); }

/** @param shift added to its stamps */
template <class Output>
void publish(Output& output, log::Reader& log, const log::SampleRef& at, types::Time shift) {
    using T = typename Output::Sample;
    if constexpr (std::is_same_v<T, typename Output::Carried>) {
        T& sample = output.kept.sample;
        log.read(at, sample);
        if constexpr (std::is_same_v<T, types::Pose>) sample.time = types::sampleTime(sample, at.time);
        moveStamps(sample, shift);
        output.port.write(sample);
    } else {
        const std::shared_ptr<T> sample = output.kept.pool.take();
        if constexpr (std::is_same_v<T, types::Sonar>)
            isOlderPing(log.streams()[at.stream]) ? log::readPing(log, at, *sample) : log.read(at, *sample);
        else
            log.read(at, *sample);
        moveStamps(*sample, shift);
        output.port.write(sample);
    }
}

}  // namespace

std::optional<types::Datum> recordedDatum(const log::Reader& log) try {
    const auto spec = framework::DeploymentSpec::parse(log.metadatum("insonify_deployment"), log.path().string());
    if (spec.datum) return spec.datum;
    for (const framework::TaskSpec& task : spec.tasks) {
        types::Datum own;
        const YAML::Node written = framework::child(task.properties, "datum");
        if (written.IsDefined() && framework::ConfigReader("").read(written, "", own)) return own;
    }
    return {};
} catch (const types::ConfigError&) {  // of another program
    return {};
}

void ReplayTask::checkDatum(const log::Reader& log, types::Diagnostics& diagnostics) const {
    const std::optional<types::Datum> recorded = recordedDatum(log);
    if (!config->datum || !recorded || isSamePlace(*config->datum, *recorded)) return;
    const auto isOfFixes = [&](const std::string& name) {
        return std::ranges::any_of(config->poses, [&](const log::PoseSource& source) {
            const log::Stream* const from = log.find(source.source);
            return source.stream == name && from && from->holds<types::Fix>();
        });
    };
    for (size_t i = 0; i < by_stream_.size(); ++i) {
        const log::Stream& stream = log.streams()[i];
        const bool is_in_world = stream.holds<types::Pose>() || stream.holds<types::PointCloud>();
        if (by_stream_[i] && is_in_world && !isOfFixes(stream.name))
            return diagnostics.push_back(
                {"datum",
                 fmt::format("is {}, and {} of the log counts from {}; give the deployment the log's datum, or "
                             "render again from fixes",
                             text(*config->datum), stream.name, text(*recorded))});
    }
}

std::pair<std::unique_ptr<log::Reader>, types::Notices> ReplayTask::opened() const {
    log::WholeLog whole = log::openWholeLog(inputPath(config->file), log::AtDamage::Stop, config->world_frame);
    auto log = std::move(whole.log);
    types::Notices notices;
    if (!whole.notice.empty()) notices.push_back(whole.notice);
    for (const log::PoseSource& source : config->poses)
        for (types::Notice& notice : log::addPoses(*log, source, config->world_frame, config->datum))
            notices.push_back(std::move(notice));
    return {std::move(log), std::move(notices)};
}

void ReplayTask::open() {
    if (log_) return;
    std::tie(log_, pose_notices_) = opened();
    by_stream_.resize(log_->streams().size());
    clock_ = log::LoggerClock(log_->samples());
    span_s_ = clock_.span(log_->samples()).seconds();
}

std::optional<types::Playback> ReplayTask::playback() const {
    if (span_s_ < 0) return std::nullopt;
    return types::Playback{std::clamp(types::Time{at_us_}.seconds(), 0.0, span_s_.load()), span_s_, is_paused_};
}

framework::OutputPortBase* ReplayTask::makeOutput(const std::string& stream) {
    try {
        open();
    } catch (const types::ConfigError& error) {
        throw framework::ReportedByCheck(error.diagnostics());
    }
    const size_t index = log_->findIndex(stream);
    const log::Stream& recorded = log_->streams()[index];
    by_stream_[index] =
        outputs_.makeFirst(stream, "stream " + stream + " of the log", [&]<class T>(std::type_identity<T>) {
            return isOlderPing(recorded) ? std::is_same_v<T, types::Sonar> : recorded.holds<T>();
        });
    rewind();
    return output(stream);
}

void ReplayTask::check(types::Diagnostics& diagnostics) const {
    try {
        const auto log = opened().first;
        checkDatum(*log, diagnostics);
        const double span = log::LoggerClock(log->samples()).span(log->samples()).seconds();
        if (config->from > span)
            diagnostics.push_back(
                {"from", fmt::format("is {:g} s; the log ends {:g} s after its start", config->from, span)});
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& diagnostic : error.diagnostics())
            diagnostics.push_back({"file", diagnostic.text()});
    }
}

types::Notices ReplayTask::notices() const {
    if (!log_) return {};
    types::Notices notices = pose_notices_;
    if (!gap_text_.empty()) notices.push_back(types::warning(gap_text_));
    if (!log_->complete())
        notices.push_back(log_->path().string() + ": " + log_->diagnostic() + "; played up to there");
    for (size_t i = 0; i < by_stream_.size(); ++i) {
        const log::Stream& stream = log_->streams()[i];
        const auto is_source = [&](const log::PoseSource& poses) { return log::isSourceOf(poses, stream); };
        if (!by_stream_[i] && stream.count > 0 && std::ranges::none_of(config->poses, is_source))
            notices.push_back("stream " + stream.name + " (" + stream.type + ") is not replayed");
    }
    return notices;
}

std::optional<types::Time> ReplayTask::nextTime() const {
    if (log_ && next_ == log_->samples().size()) return std::nullopt;  // its length is unknown until it is opened
    return next_time_;
}

std::optional<types::Time> ReplayTask::nextStamp(const std::string& stream) const {
    if (!log_) return {};
    const auto& samples = log_->samples();
    const size_t wanted = stream.empty() ? 0 : log_->findIndex(stream);
    for (size_t i = next_; i < samples.size(); ++i)
        if (stream.empty() || samples[i].stream == wanted) return samples[i].time;
    return {};
}

size_t ReplayTask::withOutput(size_t index) const {
    const auto& samples = log_->samples();
    while (index < samples.size() && !by_stream_[samples[index].stream]) ++index;
    return index;
}

void ReplayTask::settle() {
    const auto& samples = log_->samples();
    next_ = withOutput(next_);
    if (next_ == samples.size() && config->loop && played_us_ != 0) jump(config->from);
    finished_ = next_ == samples.size();
    if (!finished_) next_time_ = std::max(next_time_, clock_.evenTime(samples[next_]) + shift_);
}

void ReplayTask::rewind() {
    next_ = clock_.indexAt(log_->samples(), config->from);
    next_time_ = shift_ = pause_ = {};
    at_us_ = types::Time::fromSeconds(config->from).microseconds;
    pace_ = config->pace;
    played_us_ = 0;
    settle();
    first_us_ = next_time_.microseconds;
}

void ReplayTask::seekTo(double seconds) {
    open();
    const double span = span_s_;
    if (!(seconds >= 0 && seconds <= span + 0.5e-6))  // stamps are whole microseconds
        throw std::runtime_error(fmt::format("{:g} s is outside of the log, which is {:g} s long", seconds, span));
    jump(seconds);
}

void ReplayTask::jump(double seconds) {
    next_ = withOutput(clock_.indexAt(log_->samples(), seconds));
    finished_ = next_ == log_->samples().size();
    if (finished_) return;
    if (played_us_ != 0) {
        const types::Time after = types::Time{played_us_} + gap_;
        const bool waits = !environment().lockstep && pace_ > 0;
        next_time_ = waits ? std::max(after, now()) : after;
        pause_ = next_time_ - after;
    }
    shift_ = next_time_ - clock_.evenTime(log_->samples()[next_]);
    at_us_ = clock_.sinceFirst(log_->samples(), log_->samples()[next_]).microseconds;
}

std::function<types::Time()> ReplayTask::clock(std::function<types::Time()> wall) {
    wall_ = std::move(wall);
    return [this] { return logTime(); };
}

types::Time ReplayTask::logTime() const {
    const double pace = pace_;
    if (pace == 0) return {std::max<int64_t>(first_us_, played_us_)};
    const int64_t clock = clock_us_;
    const types::Time elapsed{clock < 0 ? -1 - clock : wall_().microseconds - clock};
    return types::Time{first_us_} + types::Time::fromSeconds(pace * elapsed.seconds());
}

std::string ReplayTask::getStream(const std::string& port) const {
    const log::Stream* const recorded = log_ ? log_->find(port) : nullptr;
    return recorded ? recorded->name : port;
}

std::string ReplayTask::getModel(const std::string& port) const {
    const log::Stream* const recorded = log_ ? log_->find(port) : nullptr;
    return recorded ? recorded->metadatum("rock_task_model") : "";
}

bool ReplayTask::configureHook() {
    open();
    gap_text_ = gapText(log_->samples(), clock_, [&](size_t stream) { return by_stream_[stream] != nullptr; });
    // Lockstep calls nextTime(); the wall clock needs a period.
    if (!environment().lockstep && !activity().settings().periodic()) {
        framework::ActivitySettings settings = activity().settings();
        settings.period = 0.001;
        settings.trigger.clear();
        activity().configure(std::move(settings));
    }
    return true;
}

bool ReplayTask::startHook() {
    rewind();
    if (wall_) clock_us_ = wall_().microseconds;
    is_paused_ = false;
    return true;
}

types::Time ReplayTask::due() {
    const bool unpaced = !environment().lockstep && pace_ == 0;
    return unpaced ? next_time_ : now();
}

void ReplayTask::noteInstant() {
    const int64_t before = played_us_.exchange(next_time_.microseconds);
    if (before != 0 && next_time_.microseconds > before) gap_ = next_time_ - types::Time{before} - pause_;
    pause_ = {};
}

void ReplayTask::setPaused(bool on) {
    if (!wall_ || !isRunning())
        throw std::runtime_error(
            "the log's time can be paused while the replay runs in realtime; in lockstep pause the deployment");
    if (on == is_paused_) return;
    const int64_t wall = wall_().microseconds, clock = clock_us_;
    clock_us_ = on ? -1 - std::max<int64_t>(wall - clock, 0) : wall - (-1 - clock);
    is_paused_ = on;
}

void ReplayTask::playNext() {
    if (!is_paused_) throw std::runtime_error("the replay is not paused");
    if (finished_) return;
    if (pace_ > 0) {
        const double seconds = (next_time_ - types::Time{first_us_}).seconds() / pace_;
        clock_us_ = -1 - types::Time::fromSeconds(seconds).microseconds;
    }
    play(next_time_);
}

void ReplayTask::updateHook() {
    const bool halted = is_paused_ && pace_ == 0;
    if (!halted) play(due());
}

void ReplayTask::play(types::Time until) {
    while (!finished_ && next_time_ <= until) {
        noteInstant();
        const log::SampleRef& at = log_->samples()[next_];
        at_us_ = clock_.sinceFirst(log_->samples(), at).microseconds;
        const types::Time shift = clock_.evenTime(at) - at.time + shift_;
        std::visit([&](auto& output) { publish(output, *log_, at, shift); }, *by_stream_[at.stream]);
        ++next_;
        settle();
    }
}

void registerTasks(framework::Registry& registry) {
    registry.add<ReplayTask>("replay::ReplayTask", "publishes the streams of a log on ports");
}

}  // namespace insonify::replay
