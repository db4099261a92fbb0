#pragma once
#include "components/pocolog/Reader.hpp"
#include "components/pocolog/SampleTypes.hpp"

namespace insonify::pocolog {

/** Decodes samples, of the types that this program knows, to see whether they are whole. */
class SampleCheck {
public:
    /** Throws WireError for a sample that cannot be decoded to its last byte, and for a ping whose lists are not as
     * long as its counts say. */
    void operator()(const Stream& stream, std::span<const char> bytes) {
        forEachSampleType([&]<class T>(std::type_identity<T>) {
            if (!stream.holds<T>()) return;
            T& sample = std::get<T>(samples_);
            unmarshal(bytes, sample);
            if constexpr (std::is_same_v<T, types::Sonar>)
                if (!sample.wellShaped()) throw WireError(0, "has other numbers of bins or bearings than it says");
        });
    }

private:
    SampleTypes samples_;  ///< Room to decode into.
};

}  // namespace insonify::pocolog
