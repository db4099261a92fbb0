#include "components/sonar/surfaces/EchoTrain.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::sonar {

void EchoTrain::append(const Echo& echo, double resolution) {
    const bool is_close = size_ > 0 && echo.late - echoes_[size_ - 1].late < resolution;
    if (is_close || size_ == max_echoes)
        echoes_[size_ - 1].weight += echo.weight;
    else
        echoes_[size_++] = echo;
}

EchoTrain EchoTrain::then(const Returns& returns, double spacing, double resolution) const {
    std::array<Echo, max_echoes * max_echoes> all;
    size_t count = 0;
    for (size_t i = 0; i < size_; ++i)
        for (size_t k = 0; k < std::min(returns.size(), max_echoes); ++k)
            all[count++] = {echoes_[i].late + static_cast<double>(k) * spacing,
                            echoes_[i].weight * static_cast<double>(returns[k])};
    if (size_ > 1)
        std::stable_sort(all.begin(), all.begin() + count,
                         [](const Echo& a, const Echo& b) { return a.late < b.late; });
    EchoTrain train;
    train.size_ = 0;
    for (size_t i = 0; i < count; ++i) train.append(all[i], resolution);
    return train;
}

double EchoTrain::passOnce(const WallLaw& wall, double sine, double resolution) {
    if (wall.rings()) {
        *this = then(wall.once, wall.spacing(sine), resolution);
        moveAway(0.5 * wall.delay(sine));
    }
    return wall.passedOnceAt(std::sqrt(std::max(1 - sine * sine, 0.0)));
}

}  // namespace insonify::sonar
