#include "components/sonar/surfaces/WallLaws.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "components/acoustics/Plate.hpp"
#include "components/sonar/beams/BinGrid.hpp"

namespace insonify::sonar {
namespace {

constexpr size_t narrow_cells = 4096, mean_cells = 512;  ///< Of tables of one frequency, and of means over a resonance.
constexpr double min_first = 1e-4;  ///< Min share of the first return, to which the others are relative [1].

/** A wall between the sonar's water and the fluid behind it. */
class Wall {
public:
    Wall(const types::Shell& shell, const SonarConfig& config)
        : plate_(acoustics::makePlate(shell)),
          water_{water_density, config.speedOfSound()},
          behind_(acoustics::getFluidBehind(shell, water_)),
          frequency_(1000 * *config.frequency_khz),
          has_fluid_(shell.fill_density > 0) {}

    double reflected() const { return std::norm(at(frequency_, 1).reflected); }
    /** Returns the share of the energy that passes a number of times at a cosine: the mean over `bands` frequencies
     *  within the width of a resonance [1]. */
    double passed(double cosine, int times, int bands) const {
        if (!(cosine > 0)) return 0;
        cosine = std::min(cosine, 1.0);
        const double width = plate_.sound_speed / (2 * plate_.thickness), fluid = fluids(cosine);
        double sum = 0;
        for (int k = 0; k < bands; ++k) {
            const double off = bands == 1 ? 0 : width / inPlate(cosine) * ((k + 0.5) / bands - 0.5);
            sum += std::pow(std::norm(at(frequency_ + off, cosine).transmitted) * fluid, times);
        }
        return sum / bands;
    }
    double reflectedWithin() const {
        return std::norm(acoustics::plateResponse(plate_, behind_, water_, frequency_, 1).reflected);
    }
    /** Returns whether returns are far enough apart to be separate in a ping, and each has at least half a period. */
    bool rings(const SonarConfig& config) const {
        const double spacing = plate_.thickness * water_.sound_speed / plate_.sound_speed;
        return spacing > rangeCell(config) / 2 && frequency_ * plate_.thickness > plate_.sound_speed / 4;
    }
    acoustics::PlateReturns returns(bool from_within) const {
        return acoustics::plateReturns(plate_, from_within ? behind_ : water_, from_within ? water_ : behind_,
                                       frequency_, WallLaw::max_returns);
    }

private:
    acoustics::PlateResponse at(double frequency, double cosine) const {
        return acoustics::plateResponse(plate_, water_, behind_, frequency, cosine);
    }

    /** Returns the cosine of the angle of the sound in the wall; 1 beyond the critical angle [1]. */
    double inPlate(double cosine) const {
        const double square = 1 - (1 - cosine * cosine) * std::pow(plate_.sound_speed / water_.sound_speed, 2);
        return square > 0 ? std::sqrt(std::max(square, 0.01)) : 1;
    }

    /** Returns the impedance of the water relative to that of the fluid behind, both along the normal: |T|^2 times this
     *  ratio is a share of energy; 0 where all is reflected [1]. */
    double fluids(double cosine) const {
        if (!has_fluid_) return 1;
        const double sine_squared = (1 - cosine * cosine) * std::pow(behind_.sound_speed / water_.sound_speed, 2);
        if (!(sine_squared < 1)) return 0;
        return water_.density * water_.sound_speed * std::sqrt(1 - sine_squared) /
               (behind_.density * behind_.sound_speed * cosine);
    }

    acoustics::Plate plate_;
    acoustics::Fluid water_, behind_;
    double frequency_;
    bool has_fluid_;
};

double computeSum(const std::vector<double>& energies) {
    return std::accumulate(energies.begin(), energies.end(), 0.0);
}

Returns relative(const std::vector<double>& energies) {
    const double sum = computeSum(energies);
    if (!(sum > 0)) return {1};
    const double first = std::max(energies.front(), min_first * sum), all = sum + first - energies.front();
    Returns returns;
    for (const double energy : energies) returns.push_back(static_cast<float>(energy / all));
    returns.front() = static_cast<float>(first / all);
    return returns;
}

WallFill getFill(const types::Shell& shell, const SonarConfig& config, const WallLaw& law, const Wall& wall) {
    constexpr double no_reflection = 1e-9;
    const double within = law.rings() ? computeSum(wall.returns(true).reflected) : wall.reflectedWithin();
    const double number = 2 * std::numbers::pi * 1000 * *config.frequency_khz / shell.fill_speed;  // [1/m]
    return {.speed_ratio = shell.fill_speed / config.speedOfSound(),
            .attenuation = 2 * number * shell.fill_loss,
            .within = law.reflected > no_reflection ? within / law.reflected : 1};
}

}  // namespace

double WallLaw::spacing(double sine) const {
    const double in_wall = sine * speed_ratio;
    return in_wall < 1 ? thickness / speed_ratio * std::sqrt(1 - in_wall * in_wall) : 0;
}

double WallLaw::delay(double sine) const {
    const double time = rings() ? spacing(sine) : 0;
    return time > 0 ? time - thickness * std::sqrt(std::max(1 - sine * sine, 0.0)) : 0;
}

WallLaw makeWallLaw(const types::Material& material, const SonarConfig& config) {
    WallLaw law;
    if (!material.shell || !config.frequency_khz) return law;
    const Wall wall(*material.shell, config);
    law.thickness = material.shell->thickness;
    law.speed_ratio = material.shell->sound_speed / config.speedOfSound();
    law.reflected = wall.reflected();
    constexpr int bands_of_resonance = 16;
    int bands = 1;
    const acoustics::PlateReturns outside = wall.returns(false);
    if (wall.rings(config) && (outside.reflected.size() > 1 || outside.passed.size() > 1)) {
        law.reflected = computeSum(outside.reflected);
        law.outside = relative(outside.reflected);
        law.inside = relative(wall.returns(true).reflected);
        law.behind = relative(outside.passed);
        law.once = relative(outside.passed_once);
        bands = bands_of_resonance;
    }
    if (!material.shell->has_air) {
        law.exactly_once = [wall, bands](double cosine) { return wall.passed(cosine, 1, bands); };
        law.exactly = [wall, bands](double cosine) { return wall.passed(cosine, 2, bands); };
        const size_t cells = bands == 1 ? narrow_cells : mean_cells;
        law.passed_once = acoustics::AdaptiveTable(law.exactly_once, 0, 1, {0.0115, 1e-5}, cells);
        if (bands > 1) law.passed = acoustics::AdaptiveTable(law.exactly, 0, 1, {0.023, 1e-7}, cells);
    }
    if (material.shell->fill_density > 0) law.fill = getFill(*material.shell, config, law, wall);
    return law;
}

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
