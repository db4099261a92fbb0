#pragma once
// A second base, as those of Offers.hpp.

namespace insonify::framework {

/** A task that may be in error only because nobody sends it anything: a run that ends so has not failed. */
class Waits {
public:
    virtual ~Waits() = default;

    /** Whether it is so now, having heard of somebody before. From any thread. */
    virtual bool waits() const = 0;
};

}  // namespace insonify::framework
