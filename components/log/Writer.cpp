#include "components/log/Writer.hpp"

#include "components/log/mcap/SampleWriter.hpp"
#include "components/log/pocolog/Writer.hpp"

namespace insonify::log {

std::unique_ptr<Writer> createLog(const std::filesystem::path& path, const McapConfig& mcap) {
    if (isMcap(path)) return std::make_unique<mcap::SampleWriter>(path, mcap);
    return std::make_unique<pocolog::Writer>(path);
}

}  // namespace insonify::log
