#include "components/sonar/base/BoxTree.hpp"

#include <algorithm>
#include <numeric>

namespace insonify::sonar {

BoxTree::BoxTree(std::span<const Box> boxes) {
    if (boxes.empty()) return;
    std::vector<uint32_t> items(boxes.size());
    std::iota(items.begin(), items.end(), 0u);
    nodes_.reserve(2 * boxes.size() - 1);
    split(items, boxes);
    refit(boxes);
}

/** Halves at the median of the longest axis. */
void BoxTree::split(std::span<uint32_t> items, std::span<const Box> boxes) {
    const size_t node = nodes_.size();
    nodes_.push_back({{}, 0, items.front()});
    if (items.size() > 1) {
        Box centres;
        for (const uint32_t item : items) centres.add(boxes[item].centre());
        const glm::dvec3 size = centres.high - centres.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const size_t half = items.size() / 2;
        std::ranges::nth_element(items, items.begin() + static_cast<std::ptrdiff_t>(half), {},
                                 [&](uint32_t item) { return boxes[item].low[axis] + boxes[item].high[axis]; });
        split(items.first(half), boxes);
        split(items.subspan(half), boxes);
    }
    nodes_[node].next = static_cast<uint32_t>(nodes_.size());
}

void BoxTree::refit(std::span<const Box> boxes) {
    for (size_t i = nodes_.size(); i-- > 0;) {
        Node& node = nodes_[i];
        if (node.next == i + 1) {
            node.box = boxes[node.item];
            continue;
        }
        node.box = nodes_[i + 1].box;
        node.box.add(nodes_[nodes_[i + 1].next].box);
    }
}

}  // namespace insonify::sonar
