#include "components/dds/Domain.hpp"

#include <dds/dds.h>

#include <charconv>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>

#include "types/ConfigError.hpp"

namespace insonify::dds {
namespace {

// A writer waits for its readers' acknowledgements once so much is unacknowledged; with 500 kB, the default, a reader
// that hangs would hold up every ping. What is kept is bounded by the writers' depth.
constexpr const char* own_settings =
    "<CycloneDDS><Domain Id=\"any\"><Internal><Watermarks><WhcHigh>1GB</WhcHigh><WhcHighInit>1GB</WhcHighInit>"
    "</Watermarks></Internal></Domain></CycloneDDS>";

std::string settings() {
    const char* users = std::getenv("CYCLONEDDS_URI");
    return own_settings + (users && *users ? std::string(",") + users : "");
}

/** While it lives, what Cyclone logs is kept here and not printed. One at a time. */
class Complaints {
public:
    Complaints() { dds_set_log_sink(&Complaints::keep, &logged_); }
    ~Complaints() { dds_set_log_sink(nullptr, nullptr); }
    std::string text() const {
        const size_t last = logged_.find_last_not_of(" \n");
        return last == std::string::npos ? "" : ": " + logged_.substr(0, last + 1);
    }

private:
    static void keep(void* text, const dds_log_data_t* data) {
        if (data->priority & (DDS_LC_ERROR | DDS_LC_WARNING | DDS_LC_FATAL | DDS_LC_CONFIG))
            static_cast<std::string*>(text)->append(data->message, data->size);
    }
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

std::shared_ptr<Domain> Domain::join(uint32_t id) {
    static std::mutex mutex;
    static std::map<uint32_t, std::weak_ptr<Domain>> joined;
    std::lock_guard lock(mutex);
    std::shared_ptr<Domain> domain = joined[id].lock();
    if (!domain) joined[id] = domain = std::shared_ptr<Domain>(new Domain(id));
    return domain;
}

Domain::Domain(uint32_t id) : id_(id) {
    const Complaints complaints;
    const dds_entity_t made = dds_create_domain(id, settings().c_str());
    const dds_entity_t tried = made > 0 ? dds_create_participant(id, nullptr, nullptr) : made;
    if (made > 0) entity_ = Entity(made);
    if (tried <= 0)
        throw types::ConfigError("", "domain",
                                 "DDS domain " + std::to_string(id) + " cannot be joined: " + dds_strretcode(tried) +
                                     complaints.text() + "; see CYCLONEDDS_URI and ROS_DOMAIN_ID");
    dds_delete(tried);
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
