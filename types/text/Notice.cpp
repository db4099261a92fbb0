#include "types/text/Notice.hpp"

namespace insonify::types {
namespace {

constexpr size_t max_reasons = 32;  ///< Limits the memory of runs that last for days.

}  // namespace

void ThrottledWarning::add(const std::string& reason, const std::string& detail, uint64_t count) {
    std::lock_guard lock(mutex_);
    const bool is_known = by_reason_.contains(reason) || by_reason_.size() < max_reasons;
    by_reason_[is_known ? reason : "other reasons"] += count;
    count_ += count;
    last_ = reason + detail;
}

void ThrottledWarning::reset() {
    std::lock_guard lock(mutex_);
    by_reason_.clear();
    last_.clear();
    count_ = reported_ = 0;
}

uint64_t ThrottledWarning::count() const {
    std::lock_guard lock(mutex_);
    return count_;
}

std::string ThrottledWarning::last() const {
    std::lock_guard lock(mutex_);
    return last_;
}

std::map<std::string, uint64_t> ThrottledWarning::byReason() const {
    std::lock_guard lock(mutex_);
    return by_reason_;
}

std::string ThrottledWarning::consumeWarning(Clock::time_point now) {
    std::lock_guard lock(mutex_);
    if (count_ == reported_ || (reported_ > 0 && now < reported_at_ + interval)) return "";
    reported_ = count_;
    reported_at_ = now;
    return counted(count_) + "; the last: " + last_;
}

std::vector<std::string> ThrottledWarning::summary() const {
    std::lock_guard lock(mutex_);
    std::vector<std::string> lines;
    for (const auto& [reason, count] : by_reason_) lines.push_back(counted(count) + ": " + reason);
    return lines;
}

std::string ThrottledWarning::counted(uint64_t count) const {
    return std::to_string(count) + " " + noun_ + (count == 1 ? " " : "s ") + participle_;
}

}  // namespace insonify::types
