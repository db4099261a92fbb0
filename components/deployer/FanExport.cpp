#include "components/deployer/FanExport.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "components/output/FanImage.hpp"
#include "components/output/PictureFiles.hpp"
#include "types/Image.hpp"

namespace insonify::deployer {

output::DisplayConfig displayFor(const types::Sonar& ping) {
    output::DisplayConfig display;
    const bool levels = std::any_of(ping.bins.begin(), ping.bins.end(), [](float bin) { return bin < 0; });
    if (levels) display.scale = output::BinScale::Decibel;
    return display;
}

std::vector<std::filesystem::path> exportFans(pocolog::Reader& log, const std::string& stream,
                                              const std::filesystem::path& path) {
    if (const auto& found = log.streams()[log.indexOf(stream)]; !found.holds<types::Sonar>())
        throw types::ConfigError(log.path(), stream, fmt::format("holds {}; pictures are made of pings", found.type));
    std::vector<std::filesystem::path> files;
    std::optional<output::FanImage> fan;
    types::Image picture;
    log.forEach<types::Sonar>(stream, [&](const types::Sonar& ping, const pocolog::SampleRef&) {
        if (!fan) fan.emplace(displayFor(ping));
        fan->paint(ping, picture);
        files.push_back(path.parent_path() / fmt::format("{}_{:06}.png", path.stem().string(), files.size()));
        output::writePng(files.back(), picture);
    });
    return files;
}

}  // namespace insonify::deployer
