#include "types/SonarTruth.hpp"

namespace insonify::types {

void SonarTruth::takeGrid(const Sonar& ping) {
    time = ping.time;
    bin_duration = ping.bin_duration;
    speed_of_sound = ping.speed_of_sound;
    bin_count = ping.bin_count;
    beam_count = ping.beam_count;
    bearings = ping.bearings;
    forEachArray(*this,
                 [count = size_t{beam_count} * bin_count](const char*, auto& numbers, auto) { numbers.resize(count); });
}

const char* SonarTruth::diagnostic() const {
    const uint64_t count = uint64_t{beam_count} * bin_count;
    bool fits = bearings.size() == beam_count;
    forEachArray(*this, [&](const char*, const auto& numbers, auto) { fits = fits && numbers.size() == count; });
    if (!fits) return "has other numbers of bins or bearings than it says";
    for (const int32_t index : object)
        if (index < no_object || index >= static_cast<int64_t>(objects.size())) return "has an object without a name";
    return nullptr;
}

}  // namespace insonify::types
