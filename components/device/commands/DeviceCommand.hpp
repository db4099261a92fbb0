#pragma once
#include <filesystem>
#include <string>

#include "components/console/Action.hpp"
#include "components/log/Reader.hpp"

namespace insonify::device {

/** Adds the command `device` with its options to `app`; parsing it sets `action`. */
void addCommand(CLI::App& app, console::Action& action);

/** See deployer::exportOculus. */
void exportOculus(log::Reader& log, const std::string& stream, const std::filesystem::path& to);

}  // namespace insonify::device
