// Stiff and extreme cases that only whole tasks, noise or trajectories show.
#include "components/deployer/StabilityTasks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "components/noise/Noise.hpp"
#include "components/noise/Random.hpp"
#include "components/pose/Trajectory.hpp"
#include "components/sonar/ScanningSonarTask.hpp"
#include "components/sonar/SonarTask.hpp"
#include "components/study/Bounds.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "types/Angle.hpp"

namespace insonify::deployer {
namespace {

using study::Outcome;
using study::StabilityCase;
using study::Verdict;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/** One end of a connection. */
template <class T>
struct Writer : framework::TaskContext {
    Writer() : TaskContext("writer") {}
    framework::OutputPort<T> port{this, "port", "snapshots of a case"};
};
template <class T>
struct Reader : framework::TaskContext {
    Reader() : TaskContext("reader") {}
    framework::InputPort<T> port{this, "port", "pings of a case"};
};

/** A sonar task that runs, and a wall before it. */
template <class Task>
class Bench {
public:
    template <class Config>
    explicit Bench(const Config& config) {
        in_.port.connectTo(task_.snapshot, framework::ConnPolicy::buffer(2));
        task_.ping.connectTo(out_.port, framework::ConnPolicy::buffer(2));
        task_.config.set(config);
        if (!task_.configure() || !task_.start()) throw std::runtime_error(task_.lastError());
    }
    /** The ping of a snapshot of the wall; null when the task refuses it. */
    types::SonarPtr ping(double seconds, glm::dquat orientation = {1, 0, 0, 0}, glm::dvec3 position = {}) {
        types::Snapshot snapshot = study::lookingAt(wall_, position);
        snapshot.time = types::Time::fromSeconds(seconds);
        snapshot.sonar.orientation = orientation;
        in_.port.write(std::make_shared<types::Snapshot>(snapshot));
        task_.update();
        types::SonarPtr heard;
        out_.port.readNew(heard);
        return heard;
    }
    /** Whether the task warns or complains with these words. */
    bool tells(const std::string& words) const {
        const auto has = [&](const std::string& text) { return text.find(words) != std::string::npos; };
        return has(task_.lastError()) || std::ranges::any_of(task_.notices(), has);
    }

private:
    types::GeometryPtr wall_ = study::sceneOf({study::facingWall(5)});
    Task task_{"sonar"};
    Writer<types::SnapshotPtr> in_;
    Reader<types::SonarPtr> out_;
};

sonar::SonarConfig smallFan() { return study::fan(40, 20, 8, 10); }
sonar::ScanningSonarConfig scanner() {
    sonar::ScanningSonarConfig config;
    config.sonar.range = 10;
    config.sonar.bin_count = 100;
    return config;
}

Outcome longQuaternion() {
    Bench<sonar::SonarTask> bench(smallFan());
    const glm::dquat turned = glm::angleAxis(0.3, glm::dvec3(0, 0, 1));
    const auto unit = bench.ping(1, turned), longer = bench.ping(2, turned * 1.001);
    int wrong = !unit || !longer || study::difference(*longer, *unit) > 1e-9;
    for (const glm::dquat& bad : {glm::dquat(nan, 0, 0, 0), glm::dquat(0, 0, 0, 1e-7), glm::dquat(0, 0, 0, 0)})
        wrong += bench.ping(3, bad) != nullptr;
    wrong += bench.ping(4, turned) == nullptr;
    return study::none(wrong, "1.001 is normalised; NaN, 1e-7 and 0 refused; the next good pose is heard");
}

/** A ping of ones. */
types::Sonar ones(int64_t microseconds, uint32_t beams, uint32_t bins) {
    types::Sonar ping;
    ping.time.microseconds = microseconds;
    ping.beam_count = beams;
    ping.bin_count = bins;
    ping.bins.assign(size_t{beams} * bins, 1.0f);
    return ping;
}

types::Sonar noisy(const noise::NoiseConfig& config, const types::Sonar& clean, uint64_t* clamped = nullptr) {
    types::Sonar result;
    const uint64_t count = noise::Noise(config).add(clean, result);
    if (clamped) *clamped = count;
    return result;
}

Outcome wideSpeckle() {
    noise::NoiseConfig config;
    config.speckle = {.law = noise::SpeckleLaw::Gaussian, .mean = 0.4, .deviation = 10};
    uint64_t clamped = 0;
    const types::Sonar result = noisy(config, ones(1, 64, 500), &clamped);
    const auto zeros = static_cast<uint64_t>(std::ranges::count(result.bins, 0.0f));
    const auto bad = std::ranges::count_if(result.bins, [](float bin) { return !(bin >= 0) || !std::isfinite(bin); });
    const double share = static_cast<double>(clamped) / 32000, expected = 0.484;  // of N(0.4, 10) below 0
    return study::none(
        static_cast<double>(bad) + (clamped != zeros) + (std::abs(share - expected) > 0.02),
        fmt::format("{} of 32,000 factors below 0, clamped and counted ({:.1f} %, the normal law has 48.4 %)", clamped,
                    100 * share));
}

Outcome exponentialEnds() {
    int bad = 0;
    double largest = 0;
    for (const uint32_t bits : {0u, 1u, 0x7fffffffu, 0x80000000u, 0xfffffffeu, 0xffffffffu}) {
        const float variate = noise::exponential(bits);
        bad += !(variate > 0) || !std::isfinite(variate);
        largest = std::max(largest, double{variate});
    }
    return study::none(
        bad, fmt::format("u is never 0: variates of all bits equal are finite and positive, at most {:.1f}", largest));
}

/** Correlation of the first two beams. */
double correlation(const types::Sonar& ping) {
    const size_t n = ping.bin_count;
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (size_t i = 0; i < n; ++i) {
        const double a = ping.bins[i], b = ping.bins[n + i];
        x += a, y += b, xx += a * a, yy += b * b, xy += a * b;
    }
    const auto count = static_cast<double>(n);
    return (xy - x * y / count) / std::sqrt((xx - x * x / count) * (yy - y * y / count));
}

Outcome seeds() {
    constexpr uint32_t bins = 20000;
    int wrong = 0;
    double worst = 0;
    noise::NoiseConfig config;
    config.speckle.emplace();
    for (const uint64_t seed : {uint64_t{0}, uint64_t{1}, ~uint64_t{0}}) {
        config.seed = seed;
        const types::Sonar first = noisy(config, ones(5, 2, bins));
        wrong += noisy(config, ones(5, 2, bins)).bins != first.bins;
        wrong += noisy(config, ones(6, 2, bins)).bins == first.bins;
        worst = std::max(worst, std::abs(correlation(first)));
    }
    wrong += worst > 4 / std::sqrt(bins);
    return {{{"samples", bins}},
            fmt::format("seeds 0, 1 and 2^64 - 1: the same again, another ping differs, beams correlate by at most "
                        "{:.1e} (bound {:.1e})",
                        worst, 4 / std::sqrt(bins)),
            worst,
            wrong ? Verdict::Fail : Verdict::Pass};
}

Outcome extremeShapes() {
    noise::NoiseConfig config;
    const auto drawn = [&](double shape) {
        config.speckle = {.law = noise::SpeckleLaw::K, .shape = shape};
        return noisy(config, ones(7, 64, 1000)).bins;
    };
    const std::vector<float> patchy = drawn(1e-3);
    std::vector<float> even = drawn(1e6);
    const bool finite = std::ranges::all_of(patchy, [](float bin) { return bin >= 0 && std::isfinite(bin); });
    const float largest = std::ranges::max(patchy);
    std::ranges::sort(even);
    double distance = 0;
    const auto count = static_cast<double>(even.size());
    for (size_t i = 0; i < even.size(); ++i)
        distance = std::max(distance, std::abs(-std::expm1(-double{even[i]}) - (static_cast<double>(i) + 0.5) / count));
    const double bound = 1.63 / std::sqrt(count);
    return study::none(!finite + !(largest > 100) + !(distance < bound),
                       fmt::format("shape 1e-3: finite, the largest of 64,000 is {:.0f} times the mean; 1e6: off the "
                                   "exponential law by {:.1e} (bound {:.1e})",
                                   largest, distance, bound));
}

Outcome timeGoesBackwards() {
    Bench<sonar::ScanningSonarTask> bench(scanner());
    int wrong = !bench.ping(10);
    wrong += bench.ping(9) != nullptr || !bench.tells("older than the one before");
    wrong += !bench.ping(10) || !bench.ping(10);
    wrong += !bench.ping(10 + 5 * 86400.0);
    return study::none(
        wrong,
        "a scanning head: an older snapshot is refused with an error, an equal time and a gap of five days are taken");
}

Outcome trajectoryTimes() {
    const auto waypoints = [](double second) {
        pose::TrajectoryConfig config;
        config.waypoints.resize(2);
        config.waypoints[1].time = second;
        config.waypoints[1].position = {10, 0, 0};
        return config;
    };
    int wrong = !study::faultsOf(waypoints(2)).empty();
    for (const double second : {-1.0, 0.0, nan}) wrong += study::faultsOf(waypoints(second)).empty();
    const pose::Trajectory path(waypoints(2).waypoints);
    wrong += path.at(-1e9).position.x != 0 || path.at(1e9).position.x != 10 || path.at(1).position.x != 5;
    return study::none(
        wrong, "waypoints at times that fall, repeat or are NaN refused; outside a trajectory its ends are held");
}

Outcome shortInterval() {
    Bench<sonar::SonarTask> slow(smallFan()), quick(smallFan());
    const bool heard =
        slow.ping(1) && slow.ping(1.1) && quick.ping(1) && quick.ping(1.001);  // 2 x 10 m / 1000 m/s = 20 ms
    return study::none(!heard + !quick.tells("ambiguous") + slow.tells("ambiguous"),
                       "pings 1 ms apart where sound takes 20 ms: heard, told as ambiguous in range; not so at 100 ms");
}

Outcome tooFast() {
    Bench<sonar::SonarTask> bench(smallFan());
    int wrong = !bench.ping(1) || !bench.ping(2, {1, 0, 0, 0}, {0, 90, 0});
    wrong += bench.ping(3, {1, 0, 0, 0}, {0, 300, 0}) != nullptr;  // 210 m/s; a tenth of the speed of sound is 100
    wrong += bench.ping(4, {1, 0, 0, 0}, {0, 310, 0}) == nullptr;
    return study::none(
        wrong,
        "90 m/s is heard, 210 m/s at a speed of sound of 1000 m/s refused with an error, the ping after it heard");
}

}  // namespace

std::vector<StabilityCase> taskStabilityCases() {
    return {{18, "Pose with a quaternion of length 1.001, NaN or none", "normalised; refused", longQuaternion},
            {45, "Speckle of deviation 10", "no negative intensity; the clamped are counted", wideSpeckle},
            {46, "Exponential variate of u = 0", "excluded by construction: finite", exponentialEnds},
            {47, "Seeds 0 and 2^64 - 1", "identical again; beams uncorrelated, below 4 / sqrt(n)", seeds},
            {48, "K statistics of shape 1e-3 and 1e6", "finite with an extreme tail; exponential", extremeShapes},
            {49, "Time that goes backwards, stands still or leaps", "refused; taken; taken", timeGoesBackwards},
            {49, "Trajectories whose times do not increase", "refused; never extrapolated", trajectoryTimes},
            {50, "Pings closer than sound's way to the range and back", "taken, and told as ambiguous", shortInterval},
            {51, "A sonar faster than a tenth of the speed of sound", "refused", tooFast}};
}

}  // namespace insonify::deployer
