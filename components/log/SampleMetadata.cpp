#include "components/log/SampleMetadata.hpp"

#include <fmt/format.h>

#include <charconv>
#include <type_traits>

namespace insonify::log {
namespace {

/** Returns a text in quotes, as in JSON. */
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text)
        if (c == '"' || c == '\\')
            result += {'\\', c};
        else
            result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    return result + '"';
}

/** Returns a number of the metadata; 0: there is none. */
double numberAt(const Metadata& metadata, const char* key) {
    double number = 0;
    if (const auto found = metadata.find(key); found != metadata.end())
        std::from_chars(found->second.data(), found->second.data() + found->second.size(), number);
    return number;
}

template <class T>
constexpr bool has_bins = std::is_base_of_v<types::RangeBins, T>;

}  // namespace

void addSampleMetadata(types::SampleView first, Metadata& metadata) {
    const auto add = [&]<class T>(const T* sample) {
        if constexpr (types::NamesObjects<T>) {
            std::string names;
            for (const std::string& name : sample->objects) names += (names.empty() ? "" : ", ") + quoted(name);
            metadata[objects_key] = "[" + names + "]";
        }
        if constexpr (has_bins<T>)
            if (sample->bin_width > 0 && sample->writtenSpeed() != sample->speed_of_sound) {
                metadata[bin_width_key] = fmt::format("{}", sample->bin_width);
                metadata[speed_of_sound_key] = fmt::format("{}", sample->speed_of_sound);
            }
    };
    std::visit(add, first);
}

void restoreBins(const Metadata& metadata, types::SampleRoom sample) {
    const auto restore = [&]<class T>(T* held) {
        if constexpr (has_bins<T>)
            if (const double width = numberAt(metadata, bin_width_key), speed = numberAt(metadata, speed_of_sound_key);
                width > 0 && speed > 0)
                held->restore(width, static_cast<float>(speed));
    };
    std::visit(restore, sample);
}

}  // namespace insonify::log
