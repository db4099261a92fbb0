#include "components/log/Copy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <utility>

#include "components/log/Files.hpp"

namespace insonify::log {
namespace {

using Readers = std::vector<std::unique_ptr<Reader>>;

bool takes(const Selection& selection, const Stream& stream) {
    return selection.streams.empty() || selection.streams.contains(stream.name);
}

/** Returns the deployment in a log's metadata, which belongs to the whole log. */
Metadata ofTheWholeLog(const Reader& log) {
    const std::string deployment = log.metadatum("insonify_deployment");
    return deployment.empty() ? Metadata{} : Metadata{{"insonify_deployment", deployment}};
}

class Copier {
public:
    Copier(const CopyOptions& options, const std::filesystem::path& to)
        : selection_(options.selection),
          anew_(options.anew.has_value()),
          needs_samples_(options.needs_samples),
          out_(createLog(to, options.anew.value_or(McapConfig{}))) {}

    /** Copies the selected part of a log; its streams are merged with those of the same names. */
    void add(Reader& log) {
        for (const Gap& gap : log.gaps())
            lose(fmt::format("{}: bytes {} to {} ({} in all): {}", log.path().string(), gap.from, gap.to,
                             gap.to - gap.from, gap.what));
        std::vector<std::optional<size_t>> numbers;
        for (size_t i = 0; i < log.streams().size(); ++i) numbers.push_back(getNumber(log, i));
        for (const SampleRef& at : log.samples())
            if (numbers[at.stream] && wanted(at)) take(log, at, *numbers[at.stream]);
    }

    Copied close() {
        if (copied_.samples > 0 || !needs_samples_) out_->close();
        return std::move(copied_);
    }

private:
    std::optional<size_t> getNumber(const Reader& log, size_t index) {
        const Stream& stream = log.streams()[index];
        if (!takes(selection_, stream)) return {};
        const auto known = numbers_.find(stream.name);
        if (known != numbers_.end()) return known->second;
        try {
            const bool as_it_is = !anew_ || !stream.sample;
            Metadata all = stream.metadata;
            const Metadata more = std::exchange(has_stream_, true) ? Metadata{} : ofTheWholeLog(log);
            all.insert(more.begin(), more.end());
            const size_t number =
                as_it_is ? out_->addLike(log, index, more) : out_->add(*stream.sample, stream.name, all);
            return numbers_[stream.name] = number;
        } catch (const types::ConfigError& error) {
            if (!selection_.streams.empty()) throw;
            lose(error.what());
            return numbers_[stream.name] = {};
        }
    }

    bool wanted(const SampleRef& at) {
        const size_t place = place_++;
        return place >= selection_.first && place < selection_.last && at.time >= selection_.from &&
               at.time < selection_.until;
    }

    void take(Reader& log, const SampleRef& at, size_t number) {
        try {
            log.verify(at);
        } catch (const types::ConfigError& error) {
            return lose(error.what());
        }
        if (anew_ && log.streams()[at.stream].sample)
            out_->put(number, at.received, at.time, log.sampleAt(at));
        else
            out_->copy(number, log, at);
        ++copied_.samples;
    }

    void lose(std::string what) { copied_.lost.push_back(std::move(what)); }

    const Selection& selection_;
    const bool anew_, needs_samples_;
    std::unique_ptr<Writer> out_;
    bool has_stream_ = false;
    std::map<std::string, std::optional<size_t>> numbers_;  ///< Stream numbers in the new log; none: its format has no
                                                            ///< such type.
    size_t place_ = 0;                                      ///< Samples seen of these streams.
    Copied copied_;
};

void refuse(const Readers& logs, const Selection& selection) {
    for (const std::string& name : selection.streams)
        if (std::ranges::none_of(logs, [&](const auto& log) { return log->find(name); }))
            logs.front()->findIndex(name);  // throws, with the existing names
    for (const auto& log : logs)
        if (log->streams().empty()) throw types::ConfigError(log->path(), "", "holds no stream");
}

/** Returns the streams' own names, for names or topics. */
std::set<std::string> getNames(const Readers& logs, const std::set<std::string>& given) {
    std::set<std::string> names;
    for (const std::string& name : given)
        for (const auto& log : logs)
            if (const Stream* stream = log->find(name)) names.insert(stream->name);
    return names;
}

/** Checks that streams of one name, which become one stream in the copy, have the same type and layout. */
void refuseOtherTypes(const Readers& logs, const Selection& selection) {
    struct Known {
        std::string type, layout;
    };
    std::map<std::string, Known> known;
    for (const auto& log : logs)
        for (size_t i = 0; i < log->streams().size(); ++i) {
            const Stream& stream = log->streams()[i];
            if (!takes(selection, stream)) continue;
            const Known& before = known.try_emplace(stream.name, Known{stream.type, log->layout(i)}).first->second;
            if (stream.type == before.type && log->layout(i) == before.layout) continue;
            const char* layout = stream.type == before.type ? " of another layout" : "";
            throw types::ConfigError(
                log->path(), stream.name,
                fmt::format("is {}{}; in the previous log it was {}", stream.type, layout, before.type));
        }
}

std::string bytesOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

Copied copyLog(const std::vector<std::filesystem::path>& logs, const std::filesystem::path& to,
               const CopyOptions& options) {
    Readers readers;
    for (const auto& log : logs) readers.push_back(openLog(log, options.at_damage));
    refuse(readers, options.selection);
    CopyOptions named = options;
    named.selection.streams = getNames(readers, options.selection.streams);
    refuseOtherTypes(readers, named.selection);
    Copier copier(named, to);
    for (const auto& log : readers) copier.add(*log);
    return copier.close();
}

std::string copyProperties(const std::filesystem::path& log, const std::filesystem::path& to) {
    const auto properties = propertyLog(*openLog(log, AtDamage::Skip));
    if (!properties) return "";
    const std::filesystem::path copied = to.parent_path() / properties->filename();
    if (!std::filesystem::exists(copied)) {
        copyLog({*properties}, copied, {.at_damage = AtDamage::Skip});
        return fmt::format("{} is copied with it", copied.string());
    }
    if (bytesOf(copied) == bytesOf(*properties)) return "";
    const std::filesystem::path fresh = to.parent_path() / "properties.new.0.log";
    copyLog({*properties}, fresh, {.at_damage = AtDamage::Skip});
    const bool is_same = bytesOf(fresh) == bytesOf(copied);
    removeLog(fresh);
    if (is_same) return "";
    return fmt::format(
        "{} is of another run: {} is not copied next to {}; give that a folder of its own, or replays of "
        "it take wrong properties",
        copied.string(), properties->string(), to.string());
}

}  // namespace insonify::log
