#include "components/replay/ReplayTask.hpp"

#include <algorithm>

#include "components/framework/Activity.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/pocolog/SampleTypes.hpp"

namespace insonify::replay {

class ReplayTask::Outlet {
public:
    virtual ~Outlet() = default;
    virtual framework::OutputPortBase& port() = 0;
    virtual void publish(pocolog::Reader& log, const pocolog::SampleRef& at) = 0;
};

template <class T>
class ReplayTask::TypedOutlet final : public Outlet {
public:
    TypedOutlet(ReplayTask* owner, const std::string& stream)
        : port_(owner, stream, "stream " + stream + " of the log") {}
    framework::OutputPortBase& port() override { return port_; }
    void publish(pocolog::Reader& log, const pocolog::SampleRef& at) override {
        if constexpr (std::is_same_v<T, pocolog::Carried<T>>) {
            log.read(at, sample_);
            port_.write(sample_);
        } else {
            const std::shared_ptr<T> sample = pool_.take();
            log.read(at, *sample);
            port_.write(sample);
        }
    }

private:
    framework::OutputPort<pocolog::Carried<T>> port_;
    framework::SamplePool<T> pool_;  ///< For what travels by reference.
    T sample_{};                     ///< For what travels by value.
};

ReplayTask::ReplayTask(std::string name) : TaskContext(std::move(name)) {}
ReplayTask::~ReplayTask() = default;

void ReplayTask::open() {
    if (log_) return;
    log_.emplace(inputPath(config->file));
    outlets_.resize(log_->streams().size());
}

framework::OutputPortBase* ReplayTask::makeOutput(const std::string& stream) {
    open();
    const size_t index = log_->indexOf(stream);
    pocolog::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (log_->streams()[index].holds<T>()) outlets_[index] = std::make_unique<TypedOutlet<T>>(this, stream);
    });
    rewind();
    return outlets_[index] ? &outlets_[index]->port() : nullptr;
}

void ReplayTask::check(types::Problems& problems) const {
    try {
        pocolog::Reader reader(inputPath(config->file));
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& fault : error.diagnostics()) problems.push_back({"file", fault.text()});
    }
}

std::vector<std::string> ReplayTask::notices() const {
    if (!log_) return {};
    std::vector<std::string> notices;
    if (!log_->complete()) notices.push_back(log_->path().string() + ": " + log_->fault() + "; played up to there");
    for (size_t i = 0; i < outlets_.size(); ++i) {
        const pocolog::Stream& stream = log_->streams()[i];
        if (!outlets_[i]) notices.push_back("stream " + stream.name + " (" + stream.type + ") is not replayed");
    }
    return notices;
}

std::optional<types::Time> ReplayTask::nextTime() const {
    if (log_ && next_ == log_->samples().size()) return std::nullopt;  // unread, it is not known to have none
    return next_time_;
}

void ReplayTask::settle() {
    const auto& samples = log_->samples();
    while (next_ < samples.size() && !outlets_[samples[next_].stream]) ++next_;
    finished_ = next_ == samples.size();
    if (!finished_) next_time_ = std::max(next_time_, samples[next_].time);
}

void ReplayTask::rewind() {
    next_ = 0;
    next_time_ = {};
    settle();
    first_time_ = next_time_;
}

bool ReplayTask::configureHook() {
    open();
    // Lockstep asks for nextTime(); the wall clock knows only periods.
    if (!environment().lockstep && !activity().settings().periodic())
        activity().configure({.period = 0.001, .trigger = {}});
    return true;
}

bool ReplayTask::startHook() {
    rewind();
    started_ = now();
    return true;
}

types::Time ReplayTask::due() {
    if (environment().lockstep) return now();
    if (config->pace == 0) return next_time_;
    return first_time_ + types::Time::fromSeconds(config->pace * (now() - started_).seconds());
}

void ReplayTask::updateHook() {
    const types::Time until = due();
    while (!finished_ && next_time_ <= until) {
        const pocolog::SampleRef& at = log_->samples()[next_];
        outlets_[at.stream]->publish(*log_, at);
        ++next_;
        settle();
    }
}

}  // namespace insonify::replay
