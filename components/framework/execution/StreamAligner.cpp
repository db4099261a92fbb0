#include "components/framework/execution/StreamAligner.hpp"

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

AlignedMoment AlignedPortBase::alignMoment(types::Time time) const {
    if (last_.time == before_all) return {aligner_.handedOver().round, time};
    const bool is_back = time < last_.time && outlasts(last_.time, time, types::max_lateness + types::Time{1});
    return {is_back ? std::max(last_.round + 1, aligner_.handedOver().round) : last_.round, time};
}

bool AlignedPortBase::accepts(types::Time time) {
    ++counts_.received;
    AlignedMoment moment = alignMoment(time);
    if (moment.round < aligner_.handedOver().round) {
        if (!behind_since_ || time < *behind_since_) behind_since_ = time;
        if (outlasts(time, *behind_since_, aligner_.timeout())) moment.round = aligner_.handedOver().round;
    }
    if (moment < std::max(last_, aligner_.handedOver())) return ++counts_.late, false;
    behind_since_.reset();
    last_ = moment;
    aligner_.noteTaken(moment);
    return true;
}

void AlignedPortBase::clear() {
    forget();
    counts_ = {};
    last_ = {};
    behind_since_.reset();
}

bool AlignedPortBase::holdsUp(const AlignedMoment& moment) const {
    return empty() && port_.connected() && (counts_.received == 0 || last_ < moment);
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
    newest_ = done_ = {};
    round_began_ = before_all;
    for (AlignedPortBase* port : ports_) port->clear();
}

void StreamAligner::noteTaken(const AlignedMoment& moment) {
    if (newest_.time == before_all || moment.round > newest_.round) round_began_ = moment.time;
    newest_ = std::max(newest_, moment);
}

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

types::Notices StreamAligner::notices() const {
    types::Notices notices;
    if (newest_.round > 0)
        notices.push_back(
            fmt::format("stamps went back by more than {:g} s {} times; the samples after each are in the order of "
                        "their new stamps",
                        types::max_lateness.seconds(), newest_.round));
    for (const AlignedPortBase* port : ports_)
        if (std::string notice = port->notice(); !notice.empty()) notices.push_back(std::move(notice));
    return notices;
}

AlignedPortBase* StreamAligner::earliest() const {
    AlignedPortBase* earliest = nullptr;
    for (AlignedPortBase* port : ports_)
        if (!port->empty() && (!earliest || port->first() < earliest->first())) earliest = port;
    return earliest;
}

bool StreamAligner::isDue(const AlignedPortBase& candidate) {
    const AlignedMoment moment = candidate.first();
    const auto holdsUp = [&moment](const AlignedPortBase* port) { return port->holdsUp(moment); };
    if (std::ranges::none_of(ports_, holdsUp)) return true;
    const auto isFull = [](const AlignedPortBase* port) { return port->full(); };
    const types::Time since = moment.round == newest_.round ? moment.time : round_began_;
    if (!outlasts(newest_.time, since, timeout_) && std::ranges::none_of(ports_, isFull)) return false;
    for (AlignedPortBase* port : ports_)
        if (port->holdsUp(moment)) port->noteAwaited();
    return true;
}

void StreamAligner::handOver(AlignedPortBase& port) {
    done_ = port.first();
    port.handOver();
}

}  // namespace insonify::framework
