#pragma once
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

namespace insonify::sonar {

/** A box along the axes. It is empty until something is added [m]. */
struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

    void add(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    void add(const Box& box) {
        low = glm::min(low, box.low);
        high = glm::max(high, box.high);
    }
    glm::dvec3 centre() const { return (low + high) / 2.0; }
    glm::dvec3 half() const { return (high - low) / 2.0; }
};

/** A binary tree over the boxes of items 0, 1, 2 and so on. */
class BoxTree {
public:
    BoxTree() = default;
    explicit BoxTree(std::span<const Box> boxes);

    /** Takes new boxes of the same items. The tree keeps its shape. Allocates nothing. */
    void refit(std::span<const Box> boxes);

    /** Calls `use(item)` for each item whose box, and the boxes around it, `mayMeet(box)` accepts. Ends when `use`
     *  returns true, and returns that. */
    template <class MayMeet, class Use>
    bool any(const MayMeet& mayMeet, const Use& use) const {
        for (size_t i = 0; i < nodes_.size();) {
            const Node& node = nodes_[i];
            if (!mayMeet(node.box))
                i = node.next;
            else if (++i == node.next && use(size_t{node.item}))
                return true;
        }
        return false;
    }

private:
    /** A part of the tree. The parts of a node follow it directly; a leaf has none. */
    struct Node {
        Box box;
        uint32_t next = 0;  ///< The first node that is not a part of this one.
        uint32_t item = 0;  ///< Item of a leaf.
    };
    void split(std::span<uint32_t> items, std::span<const Box> boxes);

    std::vector<Node> nodes_;
};

}  // namespace insonify::sonar
