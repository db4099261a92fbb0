#pragma once
#include <optional>
#include <string>

#include "types/Time.hpp"

namespace insonify::device {

/** A moment as ISO 8601 writes it in UTC: 2026-11-23T03:10:05.250000Z. */
std::string isoText(types::Time time);
/** With a zone, Z or +01:00, and any digits of a second; none where it is no such text. */
std::optional<types::Time> isoTime(const std::string& text);

}  // namespace insonify::device
