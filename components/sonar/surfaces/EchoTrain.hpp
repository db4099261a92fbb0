#pragma once
#include <array>
#include <cstddef>

#include "components/sonar/surfaces/WallLaws.hpp"

namespace insonify::sonar {

/** Successive echoes of one surface or point, because sound rings in walls. */
class EchoTrain {
public:
    static constexpr size_t max_echoes = WallLaw::max_returns;  ///< [1]

    struct Echo {
        double late;    ///< Slant range beyond that of the surface [m].
        double weight;  ///< Share of the energy [1].
    };

    /** Makes a train of one echo without delay. */
    EchoTrain() { echoes_[0] = {0, 1}; }
    size_t size() const { return size_; }
    /** Returns whether it is other than one echo without delay. */
    bool isDelayed() const { return size_ > 1 || echoes_[0].late != 0; }
    const Echo& operator[](size_t i) const { return echoes_[i]; }
    /** Returns the train of a wall whose returns follow each echo of this train at a spacing [m]. Echoes closer than
     *  `resolution` [m] merge, at the range of the first. Echoes beyond max_echoes are added to the last. The sum of
     *  the weights becomes the product of the sums. */
    EchoTrain then(const Returns& returns, double spacing, double resolution) const;
    /** Passes a wall once at a sine of incidence in water. Its delays are half of those out and back. Returns the share
     * of the energy that passes [1]. */
    double passOnce(const WallLaw& wall, double sine, double resolution);
    void moveAway(double range) {
        for (size_t i = 0; i < size_; ++i) echoes_[i].late += range;
    }
    /** Subtracts from the first echo. */
    void take(double weight) { echoes_[0].weight -= weight; }
    void scale(double by) {
        for (size_t i = 0; i < size_; ++i) echoes_[i].weight *= by;
    }

private:
    void append(const Echo& echo, double resolution);

    size_t size_ = 1;
    std::array<Echo, max_echoes> echoes_;
};

}  // namespace insonify::sonar
