#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace insonify::dds {

/** Owns an entity of Cyclone DDS; deletes it together with its children. */
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

/** Returns a participant of a DDS domain, with the settings of CYCLONEDDS_URI. `user_data` is announced with it. Throws
 *  types::ConfigError with Cyclone's message if the domain cannot be joined: no such network interface, an error in the
 *  settings, no free port. */
Entity joinDomain(uint32_t id, std::string_view user_data);

/** Returns `given`, else ROS_DOMAIN_ID, else 0. Throws types::ConfigError if ROS_DOMAIN_ID is not a number up to
 *  232. */
uint32_t domainId(std::optional<uint32_t> given);

/** The highest domain for which UDP has ports. */
inline constexpr uint32_t highest_domain = 232;

}  // namespace insonify::dds
