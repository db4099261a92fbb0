#include "components/log/LoggerClock.hpp"

#include <algorithm>
#include <iterator>

#include "types/Elapsed.hpp"

namespace insonify::log {

LoggerClock::LoggerClock(const std::vector<SampleRef>& samples) {
    for (size_t i = 1; i < samples.size(); ++i) {
        const types::Time back = samples[i - 1].received - samples[i].received;
        if (back <= types::max_lateness) continue;
        const types::Time before = i > 1 ? samples[i - 1].received - samples[i - 2].received : types::Time{};
        const types::Time interval = std::clamp(before, types::Time{}, types::max_lateness);
        steps_.push_back({samples[i].number, steps_.back().shift + back + interval});
    }
}

types::Time LoggerClock::evenTime(const SampleRef& at) const {
    auto step = std::prev(std::ranges::upper_bound(steps_, at.number, {}, &Step::number));
    const bool is_stamped_before = at.time - at.received > types::max_lateness;
    if (is_stamped_before && step != steps_.begin()) --step;
    return at.time + step->shift;
}

types::Time LoggerClock::sinceFirst(const std::vector<SampleRef>& samples, const SampleRef& at) const {
    return evenTime(at) - evenTime(samples.front());
}

types::Time LoggerClock::span(const std::vector<SampleRef>& samples) const {
    types::Time latest;
    for (const SampleRef& at : samples) latest = std::max(latest, sinceFirst(samples, at));
    return latest;
}

size_t LoggerClock::indexAt(const std::vector<SampleRef>& samples, double seconds) const {
    const types::Time from = types::Time::fromSeconds(seconds);
    const auto late_enough = [&](const SampleRef& at) { return sinceFirst(samples, at) >= from; };
    return static_cast<size_t>(std::ranges::find_if(samples, late_enough) - samples.begin());
}

}  // namespace insonify::log
