#include "components/dds/Domain.hpp"

#include <dds/dds.h>

#include <charconv>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>

#include "types/ConfigError.hpp"

namespace insonify::dds {
namespace {

/** Keeps what Cyclone logs instead of printing it. One instance at a time. */
class LoggedErrors {
public:
    LoggedErrors() { dds_set_log_sink(&LoggedErrors::keep, this); }
    ~LoggedErrors() { dds_set_log_sink(nullptr, nullptr); }
    std::string text() const {
        const size_t last = logged_.find_last_not_of(" \n");
        return last == std::string::npos ? "" : ": " + logged_.substr(0, last + 1);
    }

private:
    /** Runs on any thread: other participants log here as well. */
    static void keep(void* to, const dds_log_data_t* data) {
        if (!(data->priority & (DDS_LC_ERROR | DDS_LC_WARNING | DDS_LC_FATAL | DDS_LC_CONFIG))) return;
        auto& logged_errors = *static_cast<LoggedErrors*>(to);
        std::lock_guard lock(logged_errors.mutex_);
        logged_errors.logged_.append(data->message, data->size);
    }
    std::mutex mutex_;
    std::string logged_;
};

}  // namespace

Entity& Entity::operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
}

Entity::~Entity() {
    if (handle_ > 0) dds_delete(handle_);
}

Entity joinDomain(uint32_t id, std::string_view user_data) {
    static std::mutex one_at_a_time;
    std::lock_guard lock(one_at_a_time);
    const LoggedErrors logged_errors;
    const std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)> qos(dds_create_qos(), dds_delete_qos);
    dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
    const dds_entity_t joined = dds_create_participant(id, qos.get(), nullptr);
    if (joined > 0) return Entity(joined);
    throw types::ConfigError("", "domain",
                             "DDS domain " + std::to_string(id) + " cannot be joined: " + dds_strretcode(joined) +
                                 logged_errors.text() + "; see CYCLONEDDS_URI and ROS_DOMAIN_ID");
}

uint32_t domainId(std::optional<uint32_t> given) {
    if (given) return *given;
    const char* text = std::getenv("ROS_DOMAIN_ID");
    if (!text || !*text) return 0;
    const std::string_view digits(text);
    uint32_t id = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), id);
    if (error != std::errc() || end != digits.data() + digits.size() || id > highest_domain)
        throw types::ConfigError("", "domain",
                                 "ROS_DOMAIN_ID is " + std::string(digits) + "; must be a whole number from 0 to 232");
    return id;
}

}  // namespace insonify::dds
