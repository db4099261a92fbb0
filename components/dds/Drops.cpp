#include "components/dds/Drops.hpp"

namespace insonify::dds {
namespace {

constexpr size_t most_reasons = 32;  ///< Runs may last for days.
constexpr std::chrono::seconds between_warnings(10);

}  // namespace

void Drops::add(const std::string& reason, const std::string& detail, uint64_t count) {
    const bool is_known = by_reason_.contains(reason) || by_reason_.size() < most_reasons;
    by_reason_[is_known ? reason : "other reasons"] += count;
    count_ += count;
    last_ = reason + detail;
}

std::string Drops::untold() {
    if (count_ == told_ || (told_ > 0 && Clock::now() < told_at_ + between_warnings)) return "";
    told_ = count_;
    told_at_ = Clock::now();
    return std::to_string(count_) + " messages dropped; the last: " + last_;
}

std::vector<std::string> Drops::notices() const {
    std::vector<std::string> notices;
    for (const auto& [reason, count] : by_reason_)
        notices.push_back(std::to_string(count) + " messages dropped: " + reason);
    return notices;
}

}  // namespace insonify::dds
