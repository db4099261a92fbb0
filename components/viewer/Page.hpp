#pragma once
#include <optional>
#include <string_view>

#include "components/viewer/Server.hpp"

namespace insonify::viewer {

/** A file of the page, all of which are in the program; "/" is the page itself. */
std::optional<PageFile> pageFile(std::string_view path);

}  // namespace insonify::viewer
