// insonify study multipath
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "components/console/Console.hpp"
#include "components/console/Json.hpp"
#include "components/console/OutputFolder.hpp"
#include "components/study/MultipathStudy.hpp"
#include "components/study/commands/StudyCommand.hpp"

namespace insonify::study {
namespace {

using console::Json;

Json toJson(const MultipathResult& result) {
    Json json{{"curves", Json::array()}, {"verdicts", Json::array()}};
    for (const EchoCurve& curve : result.curves) {
        Json points = Json::array();
        for (const EchoPoint& point : curve.points)
            points.push_back({{"x", point.x}, {"heard", point.received}, {"expected", point.expected}});
        json["curves"].push_back({{"name", curve.name},
                                  {"title", curve.title},
                                  {"x", curve.x_label},
                                  {"y", curve.y_label},
                                  {"worst", curve.worst()},
                                  {"points", std::move(points)}});
    }
    json["verdicts"] = verdictsOf(result.claims);
    return json;
}

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    if (!(file << text).flush()) throw std::runtime_error(path.string() + " cannot be written");
}

int runStudy(const std::string& out) {
    const MultipathResult result = studyMultipath();
    console::OutputFolder folder(out, "study_multipath");
    folder.keep();
    write(folder.path() / "multipath.csv", csv(result));
    console::write(toJson(result), (folder.path() / "multipath.json").string());
    for (const Claim& claim : result.claims)
        console::printResult("{}  {}: {:.3g}, at most {:.3g}\n", claim.verdict(), claim.text, claim.measured,
                             claim.bound);
    console::printResult("report in {}\n", folder.path().string());
    return std::ranges::any_of(result.claims, &Claim::fails) ? 1 : 0;
}

}  // namespace

void addMultipathStudy(CLI::App& study, console::Action& action) {
    const auto out = std::make_shared<std::string>();
    CLI::App* command = study.add_subcommand("multipath", "Echoes by way of mirrors against closed forms");
    command->add_option("--out", *out, "folder of the report");
    command->callback([out, &action] { action = [out] { return runStudy(*out); }; });
}

}  // namespace insonify::study
