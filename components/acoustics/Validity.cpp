#include "components/acoustics/Validity.hpp"

#include <fmt/format.h>

namespace insonify::acoustics {

std::string outside(std::initializer_list<Limit> limits) {
    std::string text;
    for (const Limit& limit : limits)
        if (!(limit.value >= limit.min && limit.value <= limit.max))
            text += fmt::format("{}{:.6g} {} ({:g} to {:g})", text.empty() ? "" : ", ", limit.value, limit.unit,
                                limit.min, limit.max);
    return text;
}

}  // namespace insonify::acoustics
