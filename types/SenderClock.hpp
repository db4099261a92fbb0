#pragma once
#include <optional>

#include "types/Time.hpp"

namespace insonify::types {

/** Converts the stamps of a sender's clock, which counts since its boot or in its simulation, to our clock.
 *
 *  Our time of a stamp is the stamp plus the minimum of the recent delays from stamp to arrival. It therefore excludes
 *  extra delays of single messages, and is never after the arrival. When the sender's clock is slower than ours, as
 *  that of a simulation may be, our time lags by more than `max_lag` for at most `max_doubt`. Each newer stamp has a
 *  later time, by 1 us or more, also if several arrive at one instant. Our times decrease only when our clock does. */
class SenderClock {
public:
    static constexpr Time max_lag{100'000};
    static constexpr Time max_doubt{500'000};
    static constexpr Time max_silence{1'000'000};  ///< After this silence any stamp before the newest is a restart.
    static constexpr int max_late = 5;             ///< As many late stamps in a row, in their order, are a restart [1].

    /** The relation of a stamp to the newest stamp. */
    enum class Order {
        Next,
        Repeated,  ///< Equal stamp: the sender has paused, or the message arrived by two ways.
        Late,      ///< Earlier stamp, out of order or from another sender: not to be used.
        Restarted  ///< The sender has restarted: its earlier messages are obsolete.
    };
    struct Reading {
        Order order;
        Time time;  ///< On our clock; for Repeated and Late that of the newest stamp.
    };

    Reading read(Time stamp, Time arrival);

private:
    Order findOrder(Time stamp, Time arrival);
    void follow(Time delay, Time arrival);

    std::optional<Time> newest_;  ///< The newest stamp.
    Time newest_came_, offset_, time_;
    std::optional<Time> doubted_since_;  ///< Since when all messages have arrived later than by `offset_`.
    Time last_late_;                     ///< The stamp of the last late message.
    int late_ = 0;                       ///< Late messages in a row [1].
};

}  // namespace insonify::types
