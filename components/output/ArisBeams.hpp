#pragma once
#include <cstdint>
#include <span>

namespace insonify::output {

/** Models of the ARIS, by their numbers in the file. */
enum class ArisModel : uint32_t { Aris1800 = 0, Aris3000 = 1, Aris1200 = 2 };

/** Returns the bearings of the beams in the order of the samples, from starboard to port; positive to port [deg]. The
 *  lens spaces the beams unevenly. The bearings are averages of several lenses, published by Sound Metrics (ARIS File
 *  SDK, beam-width-metrics, 2018). Empty for a model without such beams or lens. */
std::span<const double> arisBearings(ArisModel model, uint32_t beams, bool is_telephoto);

}  // namespace insonify::output
