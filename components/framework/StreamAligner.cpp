#include "components/framework/StreamAligner.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace insonify::framework {
namespace {

/** Returns whether `later` is at least `span` after `time`; it is not before `time`. Unsigned, because a signed
 *  difference may overflow. */
bool outlasts(types::Time later, types::Time time, types::Time span) {
    return static_cast<uint64_t>(later.microseconds) - static_cast<uint64_t>(time.microseconds) >=
           static_cast<uint64_t>(span.microseconds);
}

}  // namespace

AlignedPortBase::AlignedPortBase(StreamAligner& aligner, const InputPortBase& port) : aligner_(aligner), port_(port) {
    aligner.enlist(this);
}

bool AlignedPortBase::accepts(types::Time time) {
    ++counts_.received;
    if (time < std::max(last_, aligner_.handedOver())) return ++counts_.late, false;
    last_ = time;
    aligner_.noteTaken(time);
    return true;
}

void AlignedPortBase::clear() {
    forget();
    counts_ = {};
    last_ = before_all;
}

bool AlignedPortBase::holdsUp(types::Time time) const {
    return empty() && port_.connected() && (counts_.received == 0 || last_ < time);
}

std::string AlignedPortBase::notice() const {
    std::string text;
    if (counts_.late > 0)
        text = fmt::format("{} of {} samples came too late and were dropped", counts_.late, counts_.received);
    if (counts_.awaited > 0)
        text += fmt::format("{}samples of other ports handed over without it: {}", text.empty() ? "" : "; ",
                            counts_.awaited);
    return text.empty() ? text : port_.name() + ": " + text;
}

void StreamAligner::clear(double timeout) {
    timeout_ = types::Time::fromSeconds(timeout);
    newest_ = done_ = before_all;
    for (AlignedPortBase* port : ports_) port->clear();
}

void StreamAligner::noteTaken(types::Time time) { newest_ = std::max(newest_, time); }

void StreamAligner::update() {
    bool taken = true;
    while (taken) {
        taken = false;
        for (AlignedPortBase* port : ports_) taken |= port->fill();
        for (AlignedPortBase* port = earliest(); port && isDue(*port); port = earliest()) handOver(*port);
    }
}

void StreamAligner::flush() {
    update();
    while (AlignedPortBase* port = earliest()) handOver(*port);
}

std::vector<std::string> StreamAligner::notices() const {
    std::vector<std::string> notices;
    for (const AlignedPortBase* port : ports_)
        if (std::string notice = port->notice(); !notice.empty()) notices.push_back(std::move(notice));
    return notices;
}

AlignedPortBase* StreamAligner::earliest() const {
    AlignedPortBase* earliest = nullptr;
    for (AlignedPortBase* port : ports_)
        if (!port->empty() && (!earliest || port->firstTime() < earliest->firstTime())) earliest = port;
    return earliest;
}

bool StreamAligner::isDue(const AlignedPortBase& candidate) {
    const types::Time time = candidate.firstTime();
    const auto holdsUp = [time](const AlignedPortBase* port) { return port->holdsUp(time); };
    if (std::ranges::none_of(ports_, holdsUp)) return true;
    const auto isFull = [](const AlignedPortBase* port) { return port->full(); };
    if (!outlasts(newest_, time, timeout_) && std::ranges::none_of(ports_, isFull)) return false;
    for (AlignedPortBase* port : ports_)
        if (port->holdsUp(time)) port->noteAwaited();
    return true;
}

void StreamAligner::handOver(AlignedPortBase& port) {
    done_ = port.firstTime();
    port.handOver();
}

}  // namespace insonify::framework
