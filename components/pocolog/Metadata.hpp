#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace insonify::pocolog {

/** Metadata of a stream: the flat map of scalars that Rock's readers accept. */
using Metadata = std::map<std::string, std::string>;

/** As YAML, one `key: "value"` a line; line breaks and control characters escaped. */
std::string toYaml(const Metadata& metadata);

/** Reads a flat YAML map of plain, single- or double-quoted scalars; lines that are none are passed over. */
Metadata metadataFromYaml(std::string_view yaml);

/** Where YAML begins to be something else than a flat map of scalars [byte]; nothing when it is one. Scalars may go on
 *  over indented lines, as Ruby folds long ones. */
std::optional<size_t> findNotFlat(std::string_view yaml);

}  // namespace insonify::pocolog
