#include "components/device/OculusModels.hpp"

namespace insonify::device {

const OculusCapabilities& capabilitiesOf(OculusModel model) {
    static const OculusCapabilities all[] = {
        {1041, {375, 0.2, 200, 130, 20, 8e-3}, std::nullopt},
        {1032, {750, 0.1, 120, 130, 20, 4e-3}, OculusMode{1200, 0.1, 40, 70, 12, 2.5e-3}},
        {1042, {1200, 0.1, 40, 130, 20, 2.5e-3}, OculusMode{2100, 0.1, 10, 60, 12, 2.5e-3}},
        {2203, {1200, 0.1, 30, 130, 20, 2.5e-3}, OculusMode{3000, 0.1, 5, 40, 20, 2e-3}},
    };
    return all[static_cast<size_t>(model)];
}

std::optional<OculusModel> oculusModelOf(uint16_t part) {
    for (const OculusModel model : {OculusModel::M370s, OculusModel::M750d, OculusModel::M1200d, OculusModel::M3000d})
        if (capabilitiesOf(model).part == part) return model;
    return std::nullopt;
}

}  // namespace insonify::device
