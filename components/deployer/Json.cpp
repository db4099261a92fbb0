#include "components/deployer/Json.hpp"

#include <fmt/core.h>

#include <cmath>

namespace insonify::deployer {

Json toJson(const types::Diagnostic& diagnostic) {
    return {{"file", diagnostic.file},
            {"line", diagnostic.line},
            {"column", diagnostic.column},
            {"path", diagnostic.path},
            {"message", diagnostic.message}};
}

Json toJson(const std::vector<types::Omission>& omitted) {
    Json list = Json::array();
    for (const types::Omission& omission : omitted)
        list.push_back({{"name", omission.name}, {"reason", omission.reason}});
    return list;
}

Json toJson(const YAML::Node& node) {
    if (!node.IsDefined() || node.IsNull()) return nullptr;
    if (node.IsMap()) {
        Json block = Json::object();
        for (const auto& entry : node) block[entry.first.Scalar()] = toJson(entry.second);
        return block;
    }
    if (node.IsSequence()) {
        Json list = Json::array();
        for (const auto& element : node) list.push_back(toJson(element));
        return list;
    }
    const bool is_quoted = node.Tag() == "!";
    const Json value = is_quoted ? Json() : console::readJson(node.Scalar());
    if (value.is_number() || value.is_boolean()) return value;
    double number = 0;  // as in YAML: .5, +3
    const bool is_number = !is_quoted && YAML::convert<double>::decode(node, number) && std::isfinite(number);
    return is_number ? Json(number) : Json(node.Scalar());
}

std::string qualityText(const types::Plan& plan) {
    const std::string error =
        plan.predicted_error >= 0 ? fmt::format(", predicted error {:.2g}", plan.predicted_error) : "";
    const std::string frusta = plan.slabs > 0 ? fmt::format(", {} frusta", plan.slabs) : "";  // none with rays
    const std::string device =
        plan.device.empty() ? "" : fmt::format(", {} {}", plan.slabs > 0 ? "on" : "by", plan.device);
    return fmt::format("quality: {} rows, {} columns per beam{}{}{}", plan.rows, plan.columns_per_beam, frusta, error,
                       device);
}

Json toJson(const types::Plan& plan) {
    return {{"features", plan.features},
            {"passes", plan.passes},
            {"omitted", toJson(plan.omitted)},
            {"quality",
             {{"rows", plan.rows},
              {"columns_per_beam", plan.columns_per_beam},
              {"slabs", plan.slabs},
              {"predicted_error", plan.predicted_error}}},
            {"device", plan.device},
            {"notices", types::lines(plan.notices)}};
}

}  // namespace insonify::deployer
