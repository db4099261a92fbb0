#include "components/deployer/PictureExport.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "components/deployer/StreamMeaning.hpp"
#include "components/log/Reader.hpp"
#include "components/output/FanImage.hpp"
#include "components/output/PictureFiles.hpp"
#include "types/Image.hpp"

namespace insonify::deployer {

output::DisplayConfig displayFor(const log::Reader& log, const log::Stream& stream, const types::Sonar& ping) {
    output::DisplayConfig display;
    const Json meaning = meaningOf(log, stream);
    if (meaning.value("output", Json()) == "code") {
        display.scale = output::BinScale::Code;
        if (meaning["code"].is_object()) display.code_bits = meaning["code"].value("bits", display.code_bits);
        return display;
    }
    const bool levels = std::any_of(ping.bins.begin(), ping.bins.end(), [](float bin) { return bin < 0; });
    if (levels) display.scale = output::BinScale::Decibel;
    return display;
}

namespace {

/** Turns the samples of one stream into pictures. */
class Pictures {
public:
    Pictures(log::Reader& log, const log::Stream& stream)
        : log_(log), stream_(stream), logged_(stream.holds<types::Image>()) {
        if (!logged_ && !holdsPings(stream))
            throw types::ConfigError(
                log.path(), stream.name,
                fmt::format("holds {}; pictures are made of pings, beams, scans and frames", stream.type));
    }
    const types::Image& of(const log::SampleRef& at) {
        if (logged_)
            log_.read(at, picture_);
        else
            paint(at);
        return picture_;
    }

private:
    void paint(const log::SampleRef& at) {
        readPing(log_, at, ping_);
        if (!fan_) fan_.emplace(displayFor(log_, stream_, ping_));
        fan_->paint(ping_, picture_);
    }

    log::Reader& log_;
    const log::Stream& stream_;
    const bool logged_;  ///< They are pictures already.
    std::optional<output::FanImage> fan_;
    types::Sonar ping_;
    types::Image picture_;
};

}  // namespace

std::vector<std::filesystem::path> exportPictures(log::Reader& log, const std::string& stream,
                                                  const std::filesystem::path& path) {
    Pictures pictures(log, log.streams()[log.indexOf(stream)]);
    std::vector<std::filesystem::path> files;
    log.forEachRef(stream, [&](const log::SampleRef& at) {
        const types::Image& picture = pictures.of(at);
        files.push_back(path.parent_path() / fmt::format("{}_{:06}.png", path.stem().string(), files.size()));
        output::writePng(files.back(), picture);
    });
    return files;
}

}  // namespace insonify::deployer
