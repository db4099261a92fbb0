#include "components/recordings/SideScanFile.hpp"

#include "components/recordings/JsfFile.hpp"
#include "components/recordings/XtfFile.hpp"

namespace insonify::recordings {

std::unique_ptr<SideScanFile> openSideScan(const std::filesystem::path& path) {
    if (XtfFile::isOne(path)) return std::make_unique<XtfFile>(path);
    if (JsfFile::isOne(path)) return std::make_unique<JsfFile>(path);
    return nullptr;
}

}  // namespace insonify::recordings
