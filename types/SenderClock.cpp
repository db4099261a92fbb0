#include "types/SenderClock.hpp"

#include <algorithm>
#include <utility>

namespace insonify::types {

SenderClock::Order SenderClock::findOrder(Time stamp, Time arrival) {
    const int late_before = std::exchange(late_, 0);
    if (!newest_ || stamp > *newest_) return Order::Next;
    if (stamp == *newest_) return Order::Repeated;
    const int late = late_before > 0 && stamp >= last_late_ ? late_before + 1 : 1;
    if (late >= max_late || *newest_ - stamp > max_lateness || elapsed(newest_came_, arrival) > max_silence)
        return Order::Restarted;
    last_late_ = stamp;
    late_ = late;
    return Order::Late;
}

void SenderClock::follow(Time delay, Time arrival) {
    const Time excess = delay - offset_;
    if (excess <= max_lag)
        doubted_since_.reset();
    else if (!doubted_since_)
        doubted_since_ = arrival;
    const bool is_wrong = doubted_since_ && arrival - *doubted_since_ > max_doubt;
    if (excess < Time{} || is_wrong) {
        offset_ = delay;
        doubted_since_.reset();
    } else if (!doubted_since_) {
        constexpr int64_t share = 256;  // number of messages in which the offset follows a drifting clock
        offset_ = offset_ + Time{excess.microseconds / share};
    }
}

SenderClock::Reading SenderClock::read(Time stamp, Time arrival) {
    const Order order = findOrder(stamp, arrival);
    if (order == Order::Repeated || order == Order::Late) return {order, time_};
    const bool ours_went_back = newest_ && arrival < newest_came_;
    const Time delay = arrival - stamp;
    if (!newest_ || order == Order::Restarted || elapsed(newest_came_, arrival) > max_silence) {
        offset_ = delay;
        doubted_since_.reset();
    } else {
        follow(delay, arrival);
    }
    newest_ = stamp;
    newest_came_ = arrival;
    const Time time = stamp + offset_;
    time_ = ours_went_back ? time : std::max(time, time_ + Time{1});
    return {order, time_};
}

}  // namespace insonify::types
