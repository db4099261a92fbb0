#include "components/pocolog/Copy.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/pocolog/SampleCheck.hpp"
#include "components/pocolog/Writer.hpp"

namespace insonify::pocolog {
namespace {

class Copier {
public:
    Copier(Reader& log, const Selection& selection, const std::filesystem::path& to)
        : log_(log), selection_(selection), out_(to) {
        for (const Stream& stream : log.streams())
            numbers_.push_back(wanted(stream) ? out_.declare(stream.name, stream.type, stream.registry, stream.metadata)
                                              : none);
    }

    Copied run() {
        for (const Gap& gap : log_.gaps())
            lose(fmt::format("bytes {} to {} ({} in all): {}", gap.from, gap.to, gap.to - gap.from, gap.what));
        size_t number = 0;
        for (const SampleRef& at : log_.samples()) {
            if (numbers_[at.stream] == none) continue;
            const size_t place = number++;
            if (place >= selection_.first && place < selection_.last && at.time >= selection_.from &&
                at.time < selection_.until)
                take(at);
        }
        out_.close();
        return std::move(copied_);
    }

private:
    static constexpr size_t none = std::numeric_limits<size_t>::max();

    bool wanted(const Stream& stream) const {
        return selection_.streams.empty() || selection_.streams.contains(stream.name);
    }

    void take(const SampleRef& at) {
        const Stream& stream = log_.streams()[at.stream];
        std::span<const char> bytes;
        try {
            bytes = log_.bytesOf(at);
            check_(stream, bytes);
        } catch (const types::ConfigError& error) {
            return lose(error.what());
        } catch (const WireError& error) {
            return lose(fmt::format("the sample of {} at byte {} {}", stream.name, at.position, error.what()));
        }
        out_.write(numbers_[at.stream], at.received, at.time, bytes);
        ++copied_.samples;
    }

    void lose(std::string what) { copied_.lost.push_back(std::move(what)); }

    Reader& log_;
    const Selection& selection_;
    Writer out_;
    std::vector<size_t> numbers_;  ///< In the new log, for each stream of the old one.
    SampleCheck check_;
    Copied copied_;
};

}  // namespace

Copied copy(Reader& log, const Selection& selection, const std::filesystem::path& to) {
    for (const std::string& stream : selection.streams) log.indexOf(stream);
    std::error_code not_there;
    if (std::filesystem::equivalent(log.path(), to, not_there))
        throw types::ConfigError(to, "", "is the log itself: the copy must be another file");
    return Copier(log, selection, to).run();
}

}  // namespace insonify::pocolog
