#include "components/pocolog/Info.hpp"

namespace insonify::pocolog {

LogInfo info(const Reader& log) {
    LogInfo result{log.bytes(), log.complete(), {}};
    for (const Stream& stream : log.streams()) {
        const double span = (stream.last - stream.first).seconds();
        const double rate = span > 0 ? static_cast<double>(stream.count - 1) / span : 0;
        result.streams.push_back(
            {stream.name, stream.type, stream.count, stream.first.seconds(), stream.last.seconds(), rate});
    }
    return result;
}

}  // namespace insonify::pocolog
