#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "components/log/Stream.hpp"

namespace insonify::log::pocolog {

/** The flat map of scalars that Rock's readers accept, as YAML: one `key: "value"` a line; line breaks and control
 *  characters escaped. */
std::string toYaml(const Metadata& metadata);

/** The scalars of a YAML map; empty for what is no such map. */
Metadata metadataFromYaml(std::string_view yaml);

/** Where YAML begins to be something else than a flat map of scalars [byte]; nothing when it is one, or empty. */
std::optional<size_t> findNotFlat(std::string_view yaml);

}  // namespace insonify::log::pocolog
