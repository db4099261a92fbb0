#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace insonify::dds {

/** Something of Cyclone's, deleted with all that belongs to it. */
class Entity {
public:
    Entity() = default;
    explicit Entity(int32_t handle) : handle_(handle) {}
    Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
    Entity& operator=(Entity&& other) noexcept;
    ~Entity();
    int32_t handle() const { return handle_; }

private:
    int32_t handle_ = 0;
};

/** A participant of a DDS domain, with the settings of CYCLONEDDS_URI; `user_data` is what it tells of itself. Throws
 *  types::ConfigError with Cyclone's words where the domain cannot be joined: no such network interface, an error in
 *  the settings, no port free. */
Entity joinDomain(uint32_t id, std::string_view user_data);

/** `given`, else ROS_DOMAIN_ID, else 0. Throws types::ConfigError for a ROS_DOMAIN_ID that is no number up to 232. */
uint32_t domainId(std::optional<uint32_t> given);

/** The highest domain for which UDP has ports. */
inline constexpr uint32_t highest_domain = 232;

}  // namespace insonify::dds
