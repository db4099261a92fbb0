#include "components/deployer/RunFiles.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <vector>

#include "components/console/Console.hpp"
#include "components/framework/config/StreamNames.hpp"
#include "components/log/Reader.hpp"
#include "components/output/PictureFiles.hpp"
#include "types/samples/Sonar.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::deployer {
namespace fs = std::filesystem;
namespace {

using Files = std::vector<fs::path>;

/** Returns a name without the number at its end: fan_.png for fan_000012.png. */
std::string getKind(const fs::path& file) {
    std::string stem = file.stem().string();
    while (!stem.empty() && types::isDigit(stem.back())) stem.pop_back();
    return (file.parent_path() / (stem + file.extension().string())).string();
}

/** Returns the last picture of the first series, or else a video: scanning sonars and waterfalls fill their pictures.
 */
fs::path firstPicture(const std::map<std::string, Files>& kinds) {
    for (const auto& [kind, files] : kinds)
        if (output::findFileFormat(files.back(), output::FileContent::Picture)) return files.back();
    for (const auto& [kind, files] : kinds)
        if (output::findFileFormat(files.back(), output::FileContent::Video)) return files.back();
    return {};
}

/** Returns the last stream of pings that a logger records; empty: there is none. */
std::string loggedPings(const framework::Deployment& deployment) {
    std::string stream;
    for (const framework::Connection& connection : deployment.connections()) {
        const framework::TaskSpec* const reader = deployment.spec().task(connection.to->owner().name());
        if (reader && reader->type == "logger::LoggerTask" &&
            connection.from->typeName() == framework::typeName<types::Sonar>() && connection.from->written() > 0)
            stream = framework::streamName(*connection.from).path();
    }
    return stream;
}

/** Returns the command that draws the pings of the run's log; empty: it has none. */
std::string drawingCommand(const fs::path& folder, const Files& files, const framework::Deployment& deployment) {
    const std::string pings = loggedPings(deployment);
    const auto log = std::ranges::find_if(
        files, [](const fs::path& file) { return log::findLogFormat(file) && file.filename() != "properties.0.log"; });
    if (pings.empty() || log == files.end()) return {};
    return fmt::format("insonify log export {} --stream {} --to {}", console::shellWord((folder / *log).string()),
                       pings, console::shellWord((folder / "ping.png").string()));
}

}  // namespace

FolderListing listFolder(const fs::path& folder) {
    FolderListing listing;
    std::error_code failed;
    fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, failed);
    for (; entry != fs::recursive_directory_iterator() && !failed; entry.increment(failed)) {
        std::error_code gone;  // a file that another program removes meanwhile
        if (entry->is_regular_file(gone))
            listing[entry->path().lexically_relative(folder)] = {entry->file_size(gone), entry->last_write_time(gone)};
    }
    return listing;
}

std::vector<fs::path> writtenSince(const FolderListing& before, const fs::path& folder) {
    Files files;
    for (const auto& [file, state] : listFolder(folder)) {
        const auto was = before.find(file);
        if (file.extension() != ".idx" && (was == before.end() || was->second != state)) files.push_back(file);
    }
    return files;
}

std::string filesText(const fs::path& folder, const FolderListing& before, const framework::Deployment& deployment) {
    constexpr size_t shown = 10;
    const Files files = writtenSince(before, folder);
    std::map<std::string, Files> kinds;
    for (const fs::path& file : files) kinds[getKind(file)].push_back(file);
    std::string text = fmt::format("files in {}{}\n", folder.string(), files.empty() ? ": none" : "");
    size_t lines = 0;
    for (const auto& [kind, of_kind] : kinds) {
        if (lines++ == shown) {
            text += "  and others\n";
            break;
        }
        const std::string last = of_kind.size() > 1
                                     ? fmt::format(" to {}, {} files", of_kind.back().string(), of_kind.size())
                                     : std::string();
        text += fmt::format("  {}{}\n", of_kind.front().string(), last);
    }
    if (const fs::path picture = firstPicture(kinds); !picture.empty())
        return text + fmt::format("open first: {}\n", (folder / picture).string());
    const std::string drawing = drawingCommand(folder, files, deployment);
    return drawing.empty() ? text : text + "no pictures; this draws the pings: " + drawing + "\n";
}

}  // namespace insonify::deployer
