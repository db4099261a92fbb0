#include "components/pocolog/Copy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <map>
#include <optional>

#include "components/pocolog/SampleCheck.hpp"
#include "components/pocolog/Writer.hpp"

namespace insonify::pocolog {
namespace {

bool takes(const Selection& selection, const Stream& stream) {
    return selection.streams.empty() || selection.streams.contains(stream.name);
}

class Copier {
public:
    Copier(const Selection& selection, const std::filesystem::path& to) : selection_(selection), out_(to) {}

    /** Takes what is wanted of a log; its streams join those of the same names. */
    void add(Reader& log) {
        for (const Gap& gap : log.gaps())
            lose(fmt::format("{}: bytes {} to {} ({} in all): {}", log.path().string(), gap.from, gap.to,
                             gap.to - gap.from, gap.what));
        std::vector<std::optional<size_t>> numbers;
        for (const Stream& stream : log.streams()) numbers.push_back(numberOf(stream));
        for (const SampleRef& at : log.samples())
            if (numbers[at.stream] && wanted(at)) take(log, at, *numbers[at.stream]);
    }

    Copied close() {
        out_.close();
        return std::move(copied_);
    }

private:
    std::optional<size_t> numberOf(const Stream& stream) {
        if (!takes(selection_, stream)) return std::nullopt;
        const auto known = numbers_.find(stream.name);
        if (known != numbers_.end()) return known->second;
        return numbers_[stream.name] = out_.declare(stream.name, stream.type, stream.registry, stream.metadata);
    }

    bool wanted(const SampleRef& at) {
        const size_t place = place_++;
        return place >= selection_.first && place < selection_.last && at.time >= selection_.from &&
               at.time < selection_.until;
    }

    void take(Reader& log, const SampleRef& at, size_t number) {
        const Stream& stream = log.streams()[at.stream];
        std::span<const char> bytes;
        try {
            bytes = log.bytesOf(at);
            check_(stream, bytes);
        } catch (const types::ConfigError& error) {
            return lose(error.what());
        } catch (const WireError& error) {
            return lose(fmt::format("{}: the sample of {} at byte {} {}", log.path().string(), stream.name, at.position,
                                    error.what()));
        }
        out_.write(number, at.received, at.time, bytes);
        ++copied_.samples;
    }

    void lose(std::string what) { copied_.lost.push_back(std::move(what)); }

    const Selection& selection_;
    Writer out_;
    std::map<std::string, size_t> numbers_;  ///< Of the streams in the new log.
    size_t place_ = 0;                       ///< Samples seen of these streams.
    SampleCheck check_;
    Copied copied_;
};

void refuse(const std::list<Reader>& logs, const Selection& selection, const std::filesystem::path& to) {
    for (const std::string& name : selection.streams)
        if (std::none_of(logs.begin(), logs.end(), [&](const Reader& log) { return log.find(name); }))
            logs.front().indexOf(name);  // throws, with the names that there are
    for (const Reader& log : logs) {
        if (log.streams().empty()) throw types::ConfigError(log.path(), "", "holds no stream");
        std::error_code not_there;
        if (std::filesystem::equivalent(log.path(), to, not_there))
            throw types::ConfigError(to, "", "is the log itself: the copy must be another file");
    }
}

/** Streams of one name become one in the copy: they must be of one type, of the same layout. */
void refuseOtherTypes(const std::list<Reader>& logs, const Selection& selection) {
    std::map<std::string, const Stream*> known;
    for (const Reader& log : logs)
        for (const Stream& stream : log.streams()) {
            if (!takes(selection, stream)) continue;
            const Stream& before = *known.emplace(stream.name, &stream).first->second;
            if (stream.type == before.type && stream.registry == before.registry) continue;
            const char* layout = stream.type == before.type ? " of another layout" : "";
            throw types::ConfigError(
                log.path(), stream.name,
                fmt::format("is {}{}; in the log before it was {}", stream.type, layout, before.type));
        }
}

}  // namespace

Copied copy(const std::vector<std::filesystem::path>& logs, AtDamage at_damage, const Selection& selection,
            const std::filesystem::path& to) {
    std::list<Reader> readers;
    for (const auto& log : logs) readers.emplace_back(log, at_damage);
    refuse(readers, selection, to);
    refuseOtherTypes(readers, selection);
    Copier copier(selection, to);
    for (Reader& log : readers) copier.add(log);
    return copier.close();
}

}  // namespace insonify::pocolog
