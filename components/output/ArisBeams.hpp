#pragma once
#include <cstdint>
#include <span>

namespace insonify::output {

/** Models of the ARIS, as their files number them. */
enum class ArisModel : uint32_t { Aris1800 = 0, Aris3000 = 1, Aris1200 = 2 };

/** Bearings of the beams in the order of the samples, which is from starboard to port; positive to port [deg]. The
 *  lens spaces the beams unevenly: these are the averages of several lenses that Sound Metrics publishes (ARIS File
 *  SDK, beam-width-metrics, 2018). Empty for a model that has no such beams or lens. */
std::span<const double> arisBearings(ArisModel model, uint32_t beams, bool is_telephoto);

}  // namespace insonify::output
