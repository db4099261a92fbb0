#include "components/logger/Rotation.hpp"

namespace insonify::logger {

Rotation::Rotation(const LoggerConfig& config, pocolog::Writer& log)
    : log_(log), max_size_(config.max_file_size), max_duration_(config.max_file_duration) {
    if (!max_size_ && !max_duration_) return;
    std::error_code not_there;
    for (auto old = nextInSequence(log.path()); std::filesystem::remove(old, not_there); old = nextInSequence(old))
        std::filesystem::remove(pocolog::indexPath(old), not_there);
}

bool Rotation::due(types::Time now) const {
    return (max_size_ && static_cast<double>(log_.size()) >= *max_size_) ||
           (max_duration_ && (now - *began_).seconds() >= *max_duration_);
}

void Rotation::before(types::Time now) {
    if (!began_) began_ = now;
    if (!due(now)) return;
    log_.next(nextInSequence(log_.path()));
    began_ = now;
}

}  // namespace insonify::logger
