#include "components/sonar/BinDeposit.hpp"

#include <algorithm>
#include <limits>

namespace insonify::sonar {

std::vector<double> inverseEdges(const BinGrid& bins) {
    const double nearest = bins.range_min > 0 ? 1 / bins.range_min : std::numeric_limits<double>::max();
    std::vector<double> edges;
    for (int k = 0; k <= bins.bin_count; ++k) edges.push_back(k == 0 ? nearest : std::min(nearest, 1 / bins.edge(k)));
    return edges;
}

}  // namespace insonify::sonar
