#include "components/replay/ReplayTask.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/framework/Activity.hpp"
#include "components/log/Reader.hpp"

namespace insonify::replay {
namespace {

/** Returns the time from the first sample to the latest [s]. */
double spanOf(const log::Reader& log) {
    const auto& samples = log.samples();
    if (samples.empty()) return 0;
    return (std::ranges::max(samples, {}, &log::SampleRef::time).time - samples.front().time).seconds();
}

/** Returns a warning of the longest time without samples, if it is longer than an hour, as after stamps of another
 * clock.
 */
std::string gapText(const log::Reader& log) {
    constexpr double long_gap = 3600;  // [s]
    const auto& samples = log.samples();
    types::Time before, gap, after;
    for (size_t i = 0; i < samples.size(); ++i) {
        if (i > 0 && samples[i].time - before > gap) gap = samples[i].time - before, after = samples[i].time;
        before = i == 0 ? samples[i].time : std::max(before, samples[i].time);
    }
    if (!(gap.seconds() > long_gap)) return "";
    const double from = (after - samples.front().time).seconds();
    return fmt::format(
        "Warning: the log has no sample for {:.6g} s (its stamps may be of two clocks), which its replay waits for; "
        "from: "
        "{:.6f} begins behind it, and pace: 0 does not wait",
        gap.seconds(), from);
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

void ReplayTask::open() {
    if (log_) return;
    log_ = log::openLog(inputPath(config->file));
    by_stream_.resize(log_->streams().size());
    span_s_ = spanOf(*log_);
    gap_text_ = gapText(*log_);
    clock_ = log::LoggerClock(log_->samples());
}

std::optional<types::Playback> ReplayTask::playback() const {
    if (span_s_ < 0) return std::nullopt;
    return types::Playback{std::clamp(types::Time{at_us_}.seconds(), 0.0, span_s_.load()), span_s_};
}

framework::OutputPortBase* ReplayTask::makeOutput(const std::string& stream) {
    open();
    const size_t index = log_->indexOf(stream);
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
        const double span = spanOf(*log::openLog(inputPath(config->file)));
        if (config->from > span)
            diagnostics.push_back(
                {"from", fmt::format("is {:g} s; the log ends {:g} s after its start", config->from, span)});
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& diagnostic : error.diagnostics())
            diagnostics.push_back({"file", diagnostic.text()});
    }
}

std::vector<std::string> ReplayTask::notices() const {
    if (!log_) return {};
    std::vector<std::string> notices;
    if (!gap_text_.empty()) notices.push_back(gap_text_);
    if (!log_->complete())
        notices.push_back(log_->path().string() + ": " + log_->diagnostic() + "; played up to there");
    for (size_t i = 0; i < by_stream_.size(); ++i) {
        const log::Stream& stream = log_->streams()[i];
        if (!by_stream_[i]) notices.push_back("stream " + stream.name + " (" + stream.type + ") is not replayed");
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
    const size_t wanted = stream.empty() ? 0 : log_->indexOf(stream);
    for (size_t i = next_; i < samples.size(); ++i)
        if (stream.empty() || samples[i].stream == wanted) return samples[i].time;
    return {};
}

size_t ReplayTask::indexAt(double seconds) const {
    const auto& samples = log_->samples();
    if (samples.empty()) return 0;
    const types::Time from = samples.front().time + types::Time::fromSeconds(seconds);
    const auto late_enough = [from](const log::SampleRef& at) { return at.time >= from; };
    return static_cast<size_t>(std::ranges::find_if(samples, late_enough) - samples.begin());
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
    next_ = indexAt(config->from);
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
    next_ = withOutput(indexAt(seconds));
    finished_ = next_ == log_->samples().size();
    if (finished_) return;
    if (played_us_ != 0) {
        const types::Time after = types::Time{played_us_} + gap_;
        const bool waits = !environment().lockstep && pace_ > 0;
        next_time_ = waits ? std::max(after, now()) : after;
        pause_ = next_time_ - after;
    }
    shift_ = next_time_ - clock_.evenTime(log_->samples()[next_]);
    at_us_ = (log_->samples()[next_].time - log_->samples().front().time).microseconds;
}

std::function<types::Time()> ReplayTask::clock(std::function<types::Time()> wall) {
    wall_ = std::move(wall);
    return [this] { return logTime(); };
}

types::Time ReplayTask::logTime() const {
    const double pace = pace_;
    if (pace == 0) return {std::max<int64_t>(first_us_, played_us_)};
    std::lock_guard lock(clock_mutex_);
    const types::Time wall = paused_us_ != 0 ? types::Time{paused_us_} : wall_();
    const double seconds = started_us_ == 0 ? 0 : (wall - types::Time{started_us_}).seconds();
    return types::Time{first_us_} + types::Time::fromSeconds(pace * seconds);
}

std::string ReplayTask::streamOf(const std::string& port) const {
    const log::Stream* const recorded = log_ ? log_->find(port) : nullptr;
    return recorded ? recorded->name : port;
}

std::string ReplayTask::modelOf(const std::string& port) const {
    const log::Stream* const recorded = log_ ? log_->find(port) : nullptr;
    return recorded ? recorded->metadatum("rock_task_model") : "";
}

bool ReplayTask::configureHook() {
    open();
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
    std::lock_guard lock(clock_mutex_);
    if (wall_) started_us_ = wall_().microseconds;
    paused_us_ = 0;
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
    std::lock_guard lock(clock_mutex_);
    if (on == (paused_us_ != 0)) return;
    const int64_t wall = wall_().microseconds;
    if (!on) started_us_ += wall - paused_us_;
    paused_us_ = on ? wall : 0;
}

void ReplayTask::playNext() {
    if (paused_us_ == 0) throw std::runtime_error("the replay is not paused");
    if (finished_) return;
    if (pace_ > 0) {
        std::lock_guard lock(clock_mutex_);
        const double seconds = (next_time_ - types::Time{first_us_}).seconds() / pace_;
        started_us_ = paused_us_ - types::Time::fromSeconds(seconds).microseconds;
    }
    play(next_time_);
}

void ReplayTask::updateHook() {
    const bool halted = paused_us_ != 0 && pace_ == 0;
    if (!halted) play(due());
}

void ReplayTask::play(types::Time until) {
    while (!finished_ && next_time_ <= until) {
        noteInstant();
        const log::SampleRef& at = log_->samples()[next_];
        at_us_ = (at.time - log_->samples().front().time).microseconds;
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
