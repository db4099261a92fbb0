#pragma once
#include <cstdint>
#include <memory>
#include <optional>
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

/** A DDS domain that this process is in, one for all its tasks. */
class Domain {
public:
    /** Joins the domain, or shares it. Its settings are ours and, over them, those of CYCLONEDDS_URI. Throws
     *  types::ConfigError with Cyclone's words where that cannot be: no such network interface, a fault in the
     *  settings, no port free. */
    static std::shared_ptr<Domain> join(uint32_t id);
    uint32_t id() const { return id_; }

private:
    explicit Domain(uint32_t id);

    uint32_t id_;
    Entity entity_;
};

/** `given`, else ROS_DOMAIN_ID, else 0. Throws types::ConfigError for a ROS_DOMAIN_ID that is no number up to 232. */
uint32_t domainId(std::optional<uint32_t> given);

/** The highest domain for which UDP has ports. */
inline constexpr uint32_t highest_domain = 232;

}  // namespace insonify::dds
