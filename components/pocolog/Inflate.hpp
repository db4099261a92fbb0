#pragma once
#include <vector>

namespace insonify::pocolog {

/** Decompresses a zlib stream; throws WireError when it is damaged or grows beyond 4 GiB. */
void inflateTo(std::vector<char>& out, std::vector<char>& in);

}  // namespace insonify::pocolog
