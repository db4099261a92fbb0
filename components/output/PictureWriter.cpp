#include "components/output/PictureWriter.hpp"

namespace insonify::output {

PictureWriter::PictureWriter(PictureFiles files) : files_(std::move(files)), thread_([this] { loop(); }) {}

PictureWriter::~PictureWriter() { end(); }

void PictureWriter::write(types::ImagePtr picture) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return count_ < waiting_.size() || error_; });
    if (error_) std::rethrow_exception(error_);
    waiting_[(first_ + count_++) % waiting_.size()] = std::move(picture);
    changed_.notify_all();
}

void PictureWriter::skip() {
    std::lock_guard lock(mutex_);
    files_.skip();
}

void PictureWriter::close() {
    end();
    if (error_) std::rethrow_exception(error_);
}

void PictureWriter::end() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void PictureWriter::loop() try {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return count_ > 0 || ending_; });
        if (count_ == 0) break;
        const types::ImagePtr picture = std::move(waiting_[first_]);
        first_ = (first_ + 1) % waiting_.size();
        --count_;
        lock.unlock();
        changed_.notify_all();
        files_.write(*picture);
        lock.lock();
    }
    lock.unlock();
    files_.close();
} catch (...) {
    std::lock_guard lock(mutex_);
    error_ = std::current_exception();
    changed_.notify_all();
}

}  // namespace insonify::output
