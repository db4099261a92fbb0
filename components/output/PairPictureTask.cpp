#include "components/output/PairPictureTask.hpp"

#include <fmt/format.h>

namespace insonify::output {

void PairConfig::check(types::Diagnostics& diagnostics) const {
    PictureConfig::check(diagnostics);
    if (width < 512)
        diagnostics.push_back({"width", fmt::format("is {} px; two pictures side by side take 512", width)});
}

}  // namespace insonify::output
