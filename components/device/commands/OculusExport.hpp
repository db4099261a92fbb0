#pragma once
#include <filesystem>
#include <string>

#include "components/log/Reader.hpp"

namespace insonify::device {

/** See deployer::exportOculus. */
void exportOculus(log::Reader& log, const std::string& stream, const std::filesystem::path& to);

}  // namespace insonify::device
