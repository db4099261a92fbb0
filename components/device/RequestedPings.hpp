#pragma once
#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "types/Time.hpp"

namespace insonify::device {

/** The pings that were requested from a sonar and have not arrived, the newest last, each with data kept for its
 *  answer. All times are of one clock that is never set back, such as types::SteadyTime. */
template <class Kept = std::monostate>
class RequestedPings {
public:
    /** @param max_waiting max number of unanswered requests, for a slow sonar; the oldest is given up beyond it */
    explicit RequestedPings(size_t max_waiting = 1) : max_waiting_(max_waiting) {}

    /** @param sound_is_back latest time of the ping's last echo */
    void add(types::Time now, types::Time sound_is_back, Kept kept = {}) {
        if (requests_.size() >= max_waiting_) requests_.erase(requests_.begin());
        requests_.push_back({now, sound_is_back, std::move(kept)});
    }
    void clear() { requests_.clear(); }

    bool empty() const { return requests_.empty(); }
    size_t size() const { return requests_.size(); }
    /** Whether a ping of this time answers a request. */
    bool awaits(types::Time ping) const { return !requests_.empty() && ping >= requests_.front().time; }
    /** Returns the data kept for a ping of this time. The ping answers the newest request made by then; older requests
     *  are never answered. None: there is no such request. */
    std::optional<Kept> take(types::Time ping) {
        if (!awaits(ping)) return std::nullopt;
        const auto later = std::ranges::find_if(requests_, [&](const Request& each) { return each.time > ping; });
        std::optional<Kept> kept = std::move(std::prev(later)->kept);
        requests_.erase(requests_.begin(), later);
        return kept;
    }
    /** Returns when the newest request is late, if there is one. @param patience with the sonar, in addition to the
     *  travel time of sound [s] */
    types::Time deadline(double patience = 2) const {
        return requests_.back().sound_is_back + types::Time::fromSeconds(patience);
    }
    bool isLate(types::Time now) const { return !empty() && now >= deadline(); }

private:
    struct Request {
        types::Time time, sound_is_back;
        Kept kept;
    };

    size_t max_waiting_;
    std::vector<Request> requests_;
};

}  // namespace insonify::device
