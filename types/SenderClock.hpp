#pragma once
#include <cstdint>
#include <limits>
#include <optional>

#include "types/Time.hpp"

namespace insonify::types {

/** How long ago something was by our clock; for ever where the clock has been set back since. */
constexpr Time elapsed(Time since, Time now) {
    return now < since ? Time{std::numeric_limits<int64_t>::max()} : now - since;
}

/** Carries the stamps of a sender's own clock, which counts since its boot or in its simulation, over to ours.
 *
 *  Our time of a stamp is the stamp plus the least that its like have taken of late from being stamped to arriving:
 * what single messages are delayed beyond that is not in it, and it never lies after the arrival. Where the sender's
 * clock is slower than ours, as that of a simulation may be, it lags behind by `max_lag` for at most `max_doubt`. Our
 * times go back only where our clock does. */
class SenderClock {
public:
    static constexpr Time max_lag{100'000};
    static constexpr Time max_doubt{500'000};
    static constexpr Time max_lateness{1'000'000};  ///< A stamp that lies further back begins anew.
    static constexpr Time max_silence{1'000'000};   ///< After it any stamp that lies back begins anew.

    /** How a stamp follows on the newest. */
    enum class Order {
        Next,
        Repeated,  ///< The same again: a sender that has paused, or a message that came by two ways.
        Late,      ///< Overtaken on the way, or of another sender: not to be used.
        Restarted  ///< The sender has begun anew: what it said before is of another life.
    };
    struct Reading {
        Order order;
        Time time;  ///< Ours; of Repeated and Late that of the newest.
    };

    Reading read(Time stamp, Time arrival);

private:
    Order orderOf(Time stamp, Time arrival) const;
    void follow(Time delay, Time arrival);

    std::optional<Time> newest_;  ///< Stamp.
    Time newest_came_, offset_, time_;
    std::optional<Time> doubted_since_;  ///< The offset, as all came later than it says.
};

}  // namespace insonify::types
