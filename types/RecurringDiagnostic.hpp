#pragma once

namespace insonify::types {

/** Decides when to report wrong samples: the first, and another only after a series of right samples. */
class RecurringDiagnostic {
public:
    static constexpr int well_after = 10;  ///< Consecutive right samples before the next report [1].

    /** Returns whether to report this sample. */
    bool isDue(bool wrong) {
        const bool due = wrong && right_ >= well_after;
        right_ = wrong ? 0 : right_ + (right_ < well_after ? 1 : 0);
        return due;
    }

private:
    int right_ = well_after;
};

}  // namespace insonify::types
