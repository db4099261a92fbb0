#include "components/pocolog/Inflate.hpp"

#include <zlib.h>

#include <algorithm>

#include "components/pocolog/Wire.hpp"

namespace insonify::pocolog {
namespace {

struct Inflation {
    z_stream stream{};
    Inflation() {
        if (inflateInit(&stream) != Z_OK) throw WireError(0, "cannot be decompressed: no memory");
    }
    ~Inflation() { inflateEnd(&stream); }
};

}  // namespace

void inflateTo(std::vector<char>& out, std::vector<char>& in) {
    Inflation inflation;
    z_stream& z = inflation.stream;
    z.next_in = reinterpret_cast<Bytef*>(in.data());
    z.avail_in = static_cast<uInt>(in.size());
    out.clear();
    for (int status = Z_OK; status != Z_STREAM_END;) {
        const size_t before = out.size();
        out.resize(std::min<size_t>(std::max<size_t>(2 * before, 4 * in.size() + 64), uint32_t(-1)));
        z.next_out = reinterpret_cast<Bytef*>(out.data()) + before;
        z.avail_out = static_cast<uInt>(out.size() - before);
        status = inflate(&z, Z_NO_FLUSH);
        if (status != Z_STREAM_END && (status != Z_OK || (z.avail_in == 0 && z.avail_out > 0)))
            throw WireError(0, "is compressed and damaged");
        out.resize(out.size() - z.avail_out);
    }
}

}  // namespace insonify::pocolog
