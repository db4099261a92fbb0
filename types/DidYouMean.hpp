#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace insonify::types {

/** Returns a text such as "did you mean range? " for a name that is close to a name in `known`, else empty. A name is
 *  close if at most a third of its letters are missing, added, changed or swapped with a neighbour, ignoring case; a
 * name of three letters or fewer must also begin with the same letter. A part of exactly one known name is close, too.
 * The last part of a known name with a namespace is enough, also without "Task". */
std::string didYouMean(std::string_view wrong, const std::vector<std::string>& known);

/** Returns the choices as a message lists them: ".a, .b or .c". */
std::string alternatives(const std::vector<std::string_view>& choices);

}  // namespace insonify::types
