#include "components/sonar/echo/MeshEdges.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace insonify::sonar {

std::vector<uint32_t> weld(const std::vector<glm::vec3>& positions) {
    std::vector<uint32_t> order(positions.size()), first(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](uint32_t i) { return std::tuple(positions[i].x, positions[i].y, positions[i].z, i); };
    std::ranges::sort(order, {}, key);
    for (size_t k = 0; k < order.size(); ++k) {
        const bool same = k > 0 && positions[order[k]] == positions[order[k - 1]];
        first[order[k]] = same ? first[order[k - 1]] : order[k];
    }
    return first;
}

std::vector<Edge> edgesOf(const types::Mesh& mesh) {
    const std::vector<uint32_t> first = weld(mesh.positions);
    std::vector<Edge> edges;
    edges.reserve(mesh.indices.size());
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = first[mesh.indices[i + k]], b = first[mesh.indices[i + (k + 1) % 3]];
            edges.push_back({std::min(a, b), std::max(a, b), static_cast<uint32_t>(i / 3)});
        }
    std::ranges::sort(edges);
    return edges;
}

}  // namespace insonify::sonar
