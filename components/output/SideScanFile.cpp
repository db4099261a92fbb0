#include "components/output/SideScanFile.hpp"

#include "components/output/JsfFile.hpp"
#include "components/output/XtfFile.hpp"

namespace insonify::output {

std::unique_ptr<SideScanFile> openSideScan(const std::filesystem::path& path) {
    if (XtfFile::isOne(path)) return std::make_unique<XtfFile>(path);
    if (JsfFile::isOne(path)) return std::make_unique<JsfFile>(path);
    return nullptr;
}

}  // namespace insonify::output
