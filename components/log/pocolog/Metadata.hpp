#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "components/log/Stream.hpp"

namespace insonify::log::pocolog {

/** Returns the flat map of scalars that Rock's readers accept, as YAML: one `key: "value"` per line; line breaks and
 *  control characters escaped. */
std::string toYaml(const Metadata& metadata);

/** Returns the scalars of a YAML map; empty for other texts. */
Metadata metadataFromYaml(std::string_view yaml);

/** Returns where YAML stops being a flat map of scalars [byte]; none when it is one, or empty. */
std::optional<size_t> findNotFlat(std::string_view yaml);

}  // namespace insonify::log::pocolog
