#pragma once

namespace insonify::types {

/** When to tell of what is wrong with samples: when it begins, and again only after it has been right for a while. */
class RecurringDiagnostic {
public:
    static constexpr int well_after = 10;  ///< Samples that are right, one after the other [1].

    /** Whether it is to be told of this sample. */
    bool isDue(bool wrong) {
        const bool due = wrong && right_ >= well_after;
        right_ = wrong ? 0 : right_ + (right_ < well_after ? 1 : 0);
        return due;
    }

private:
    int right_ = well_after;
};

}  // namespace insonify::types
