#include "components/console/Shard.hpp"

#include <fmt/core.h>

#include <charconv>
#include <optional>
#include <string_view>

#include "types/text/ConfigError.hpp"

namespace insonify::console {
namespace {

std::optional<uint64_t> number(std::string_view digits) {
    uint64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    return value;
}

/** Parses a text that may be invalid; sets `why` to the reason. */
Shard shardIn(std::string_view text, std::string& why) {
    const size_t slash = text.find('/');
    const auto index = number(text.substr(0, slash));
    const auto count = number(slash == text.npos ? "" : text.substr(slash + 1));
    if (!index || !count)
        why = fmt::format("is '{}'; it must be i/N, whole numbers, as in 0/16", text);
    else if (*count == 0 || *count > Shard::maximum)
        why = fmt::format("is {}; N must be from 1 to {}", text, Shard::maximum);
    else if (*index >= *count)
        why = fmt::format("is {}; of {} shards i may be from 0 to {}", text, *count, *count - 1);
    return {index.value_or(0), count.value_or(1)};
}

}  // namespace

Shard Shard::read(const std::string& text, const std::string& option) {
    std::string why;
    const Shard shard = shardIn(text, why);
    if (!why.empty()) throw types::ConfigError("", option, why);
    return shard;
}

std::string Shard::refuse(const std::string& text) {
    std::string why;
    shardIn(text, why);
    return why;
}

std::string Shard::text() const { return fmt::format("{}/{}", index, count); }

std::string Shard::fileText() const {
    return fmt::format("{:0{}}_of_{}", index, fmt::formatted_size("{}", count - 1), count);
}

Shard::Block Shard::block(uint64_t total) const {
    // Equals total * index / count, without overflow.
    const auto edge = [&](uint64_t i) { return total / count * i + total % count * i / count; };
    return {edge(index), edge(index + 1)};
}

}  // namespace insonify::console
