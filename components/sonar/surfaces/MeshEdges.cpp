#include "components/sonar/surfaces/MeshEdges.hpp"

#include <algorithm>
#include <array>

#include "types/Weld.hpp"

namespace insonify::sonar {

std::vector<uint32_t> weld(const types::Mesh& mesh) { return types::weldedPlaces(mesh.positions, mesh.indices); }

std::vector<Edge> edgesOf(const types::Mesh& mesh) {
    const std::vector<uint32_t> first = weld(mesh);
    std::vector<Edge> edges;
    edges.reserve(mesh.indices.size());
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::array corners{first[mesh.indices[i]], first[mesh.indices[i + 1]], first[mesh.indices[i + 2]]};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = corners[k], b = corners[(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), static_cast<uint32_t>(i / 3)});
        }
    }
    std::ranges::sort(edges);
    return edges;
}

}  // namespace insonify::sonar
