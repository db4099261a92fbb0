#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace insonify::types {

/** "did you mean range? " for a name that is close to one of `known`, else empty: at most a third of its letters are
 *  missing, added, changed or swapped with a neighbour, whatever their case, or it is a part of one name alone. Of a
 *  name with a namespace the last part is enough. */
std::string didYouMean(std::string_view wrong, const std::vector<std::string>& known);

}  // namespace insonify::types
