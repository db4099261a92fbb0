#include "components/mcap/Export.hpp"

#include <functional>

#include "components/mcap/SampleWriter.hpp"

namespace insonify::mcap {
namespace {

/** Copies samples of a stream; null for a type that is not known. */
using Copy = std::function<void(const pocolog::SampleRef&)>;

Copy copyOf(pocolog::Reader& log, const pocolog::Stream& stream, SampleWriter& out) {
    Copy copy;
    pocolog::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (copy || !stream.holds<T>()) return;
        const size_t number = out.addStream<T>(stream.name, stream.metadata);
        copy = [&log, &out, number, sample = T{}](const pocolog::SampleRef& at) mutable {
            log.read(at, sample);
            out.write(number, at.received, sample);
        };
    });
    return copy;
}

}  // namespace

size_t exportLog(pocolog::Reader& log, const std::string& stream, const std::filesystem::path& to,
                 const McapConfig& config) {
    const size_t only = stream.empty() ? log.streams().size() : log.indexOf(stream);
    if (std::filesystem::exists(to) && std::filesystem::equivalent(log.path(), to))
        throw types::ConfigError(to, "--to", "is the log itself; it must be another file");
    SampleWriter out(to, config);
    std::vector<Copy> copies(log.streams().size());
    for (size_t i = 0; i < copies.size(); ++i)
        if (stream.empty() || i == only) copies[i] = copyOf(log, log.streams()[i], out);
    if (!stream.empty() && !copies[only])
        throw types::ConfigError(log.path(), stream, "holds " + log.streams()[only].type + ", which has no message");
    size_t messages = 0;
    for (const pocolog::SampleRef& at : log.samples())
        if (copies[at.stream]) {
            copies[at.stream](at);
            ++messages;
        }
    out.close();
    return messages;
}

}  // namespace insonify::mcap
