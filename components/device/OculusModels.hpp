#pragma once
// What the models of the Blueprint Subsea Oculus can do, by the maker's data sheets.
#include <cstdint>
#include <optional>
#include <string_view>

#include "types/Describe.hpp"

namespace insonify::device {

enum class OculusModel { M370s, M750d, M1200d, M3000d };

/** One of the two frequencies of a model. */
struct OculusMode {
    double frequency_khz = 0;
    double shortest_range = 0, longest_range = 0;  ///< [m]
    double field_of_view_deg = 0, beam_height_deg = 0;
    double finest_bin = 0;  ///< [m]
};

struct OculusCapabilities {
    uint16_t part = 0;  ///< Part number, as on the wire.
    OculusMode low;
    std::optional<OculusMode> high;

    /** Of the mode of a fire message: 2 is high, where there is one, and everything else is low. */
    const OculusMode& mode(uint8_t number) const { return number == 2 && high ? *high : low; }
};

const OculusCapabilities& capabilitiesOf(OculusModel model);
/** The model of a part number; none: not one of these. */
std::optional<OculusModel> oculusModelOf(uint16_t part);

}  // namespace insonify::device

template <>
struct insonify::types::EnumNames<insonify::device::OculusModel> {
    static constexpr std::string_view names[] = {"m370s", "m750d", "m1200d", "m3000d"};
};
