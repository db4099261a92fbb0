#pragma once
#include <memory>

#include "components/mcap/Config.hpp"
#include "components/mcap/Contents.hpp"
#include "components/pocolog/Check.hpp"
#include "components/pocolog/Reader.hpp"

namespace insonify::mcap {

/** Whether a file is read as MCAP: by its name, *.mcap. */
bool isMcap(const std::filesystem::path& path);

/** A log of either format. Of an MCAP file, messages of known types in CDR are samples; other channels are streams of a
 *  type that is not known. Streams are named as they were written, or topic /a/b is stream a.b; images and poses of
 *  others are taken as ours by default, poses as ENU (REP 103). Throws ConfigError for what is no log. */
std::unique_ptr<pocolog::Reader> openLog(const std::filesystem::path& path);

/** pocolog::check for a log of either format: of an MCAP file each record, checksum, index and message. */
pocolog::Verdict checkLog(const std::filesystem::path& path);

}  // namespace insonify::mcap
