#include "components/dataset/Annotate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "types/Check.hpp"

namespace insonify::dataset {
namespace {

constexpr int32_t none = types::SonarTruth::no_object;

/** Annotates one ping. */
class Annotator {
public:
    Annotator(const types::Sonar& ping, const types::SonarTruth& truth, const output::PlainPicture& picture,
              const Classes& classes, const Instances& instances, const AnnotationConfig& config,
              output::BinScale scale, std::span<const float> ranges, std::span<const int32_t> hiders)
        : ping_(ping),
          truth_(truth),
          picture_(picture),
          instances_(instances),
          ghost_(classes.ghost()),
          first_shadow_(static_cast<int32_t>(truth.objects.size())),
          config_(config),
          decibel_(scale == output::BinScale::Decibel),
          bin_width_(ping.binWidth()),
          ranges_(ranges),
          hiders_(hiders) {
        if (truth.beam_count != ping.beam_count || truth.bin_count != ping.bin_count)
            throw std::runtime_error("a ping has other beams or bins than its truth");
    }

    Annotated annotated() {
        labelCells();
        addPixels();
        Annotated all;
        std::map<int32_t, uint16_t> number_of;
        for (auto& [object, annotation] : found_) {
            if (annotation.area < config_.min_pixels) continue;
            number_of[object] = static_cast<uint16_t>(all.annotations.size() + 1);
            all.annotations.push_back(std::move(annotation));
        }
        label(all, number_of);
        return all;
    }

private:
    double intensity(size_t bin) const {
        const auto value = static_cast<double>(ping_.bins[bin]);
        return decibel_ ? std::pow(10, value / 10) : value;
    }
    /** Returns the instance of a bin; none if the bin's object is not part of the scene file, such as the floor of a
     *  survey. */
    int32_t instanceAt(size_t bin) const {
        const int32_t object = directAt(bin);
        return object < 0 || static_cast<size_t>(object) >= instances_.objectCount() ? none : instances_.of(object);
    }
    bool isGhost(size_t bin) const { return !truth_.path.empty() && truth_.isByMirror(bin); }
    /** Returns the object whose direct echo is in a bin. */
    int32_t directAt(size_t bin) const { return isGhost(bin) ? none : truth_.object[bin]; }
    bool counts(size_t bin) const {
        const int32_t instance = instanceAt(bin);
        return instance != none && instances_.category(instance) != 0 && !isGhost(bin) &&
               static_cast<double>(truth_.share[bin]) >= config_.min_share && intensity(bin) > 0;
    }

    /** Returns the number of the shadow in a bin. */
    int32_t getShadow(size_t bin) const {
        return hiders_.empty() || hiders_[bin] == none ? none : hiders_[bin] + first_shadow_;
    }

    void labelCells() {
        const uint32_t cells = picture_.cellsPerBeam(), step = picture_.binsPerCell();
        object_of_.assign(size_t{ping_.beam_count} * cells, none);
        if (ghost_ != 0) findGhosts();
        for (uint32_t beam = 0; beam < ping_.beam_count; ++beam) {
            if (ping_.bearings[beam].isUnknown()) continue;
            for (uint32_t cell = 0; cell < cells; ++cell) {
                const size_t at = size_t{beam} * cells + cell;
                const uint32_t last = std::min((cell + 1) * step, ping_.bin_count);
                if (object_of_[at] == none && picture_.levels()[at] >= config_.min_level)
                    labelCell(beam, cell * step, last, object_of_[at]);
                if (object_of_[at] == none) object_of_[at] = getShadow(size_t{beam} * ping_.bin_count + cell * step);
                if (object_of_[at] != none) addCell(beam, cell, cell * step, last, object_of_[at]);
            }
        }
    }

    /** Labels the cells of ghosts. Their numbers follow those of shadows. */
    void findGhosts() {
        const uint32_t cells = picture_.cellsPerBeam(), step = picture_.binsPerCell();
        std::vector<uint8_t> are_ghosts;
        for (uint32_t beam = 0; beam < ping_.beam_count; ++beam)
            for (uint32_t cell = 0; cell < cells; ++cell) {
                const size_t start = size_t{beam} * ping_.bin_count, first = start + size_t{cell} * step;
                bool is_ghost = picture_.levels()[are_ghosts.size()] >= config_.min_level;
                for (size_t bin = first; bin < std::min(first + step, start + ping_.bin_count) && is_ghost; ++bin)
                    is_ghost = isGhost(bin);
                are_ghosts.push_back(is_ghost);
            }
        const std::vector<int32_t> groups = picture_.groupBy(are_ghosts);
        for (size_t at = 0; at < groups.size(); ++at)
            if (groups[at] > 0) object_of_[at] = 2 * first_shadow_ + groups[at] - 1;
    }

    void labelCell(uint32_t beam, uint32_t first, uint32_t last, int32_t& object) const {
        double strongest = 0;
        for (uint32_t k = first; k < last; ++k) {
            const size_t bin = size_t{beam} * ping_.bin_count + k;
            if (!counts(bin)) continue;
            const double energy = intensity(bin) * static_cast<double>(truth_.share[bin]);
            if (energy <= strongest) continue;
            strongest = energy;
            object = instanceAt(bin);
        }
    }
    /** Returns whether a bin shows the label of its cell. */
    bool shows(size_t bin, int32_t object) const {
        if (object >= 2 * first_shadow_) return isGhost(bin);
        return object >= first_shadow_ ? getShadow(bin) == object : instanceAt(bin) == object && !isGhost(bin);
    }

    void addCell(uint32_t beam, uint32_t cell, uint32_t first, uint32_t last, int32_t object) {
        const double bearing = picture_.bearing(beam);
        const double near = ranges_.empty() ? first * bin_width_ : static_cast<double>(ranges_[beam]);
        const double far = ranges_.empty() ? last * bin_width_ : near;
        Annotation& annotation = findAnnotation(object, bearing, near);
        annotation.bearing_min = std::min(annotation.bearing_min, bearing);
        annotation.bearing_max = std::max(annotation.bearing_max, bearing);
        annotation.range_min = std::min(annotation.range_min, near);
        annotation.range_max = std::max(annotation.range_max, far);
        for (uint32_t k = first; k < last; ++k) {
            const size_t bin = size_t{beam} * ping_.bin_count + k;
            if (!shows(bin, object)) continue;
            ++annotation.bins;
            if (annotation.is_shadow) continue;
            annotation.energy += intensity(bin) * (annotation.object < 0 ? 1 : static_cast<double>(truth_.share[bin]));
        }
        const cv::Point at = picture_.findPixel(beam, cell);
        widen(annotation.box, at.x, at.y);
    }

    Annotation& findAnnotation(int32_t object, double bearing, double range) {
        const auto [at, is_new] = found_.try_emplace(object);
        Annotation& annotation = at->second;
        if (!is_new) return annotation;
        annotation.bearing_min = annotation.bearing_max = bearing;
        annotation.range_min = annotation.range_max = range;
        if (object >= 2 * first_shadow_) {
            annotation.object = none;
            annotation.name = "ghost";
            annotation.category = ghost_;
            return annotation;
        }
        annotation.is_shadow = object >= first_shadow_;
        annotation.object = object % first_shadow_;
        annotation.parts = instances_.parts(annotation.object);
        annotation.name = instances_.name(annotation.object);
        annotation.category =
            annotation.is_shadow ? instances_.shadow(annotation.object) : instances_.category(annotation.object);
        return annotation;
    }

    static void widen(Box& box, int x, int y) {
        if (box.width == 0) {
            box = {x, y, 1, 1};
            return;
        }
        const int right = std::max(box.x + box.width, x + 1), bottom = std::max(box.y + box.height, y + 1);
        box.x = std::min(box.x, x), box.y = std::min(box.y, y);
        box.width = right - box.x, box.height = bottom - box.y;
    }

    int32_t objectAt(size_t pixel) const {
        const int32_t cell = picture_.cells()[pixel];
        return cell < 0 ? none : object_of_[static_cast<size_t>(cell)];
    }

    void addPixels() {
        for (uint32_t y = 0; y < picture_.height(); ++y)
            for (uint32_t x = 0; x < picture_.width(); ++x) {
                const int32_t object = objectAt(size_t{y} * picture_.width() + x);
                if (object == none) continue;
                Annotation& annotation = found_.at(object);
                ++annotation.area;
                widen(annotation.box, static_cast<int>(x), static_cast<int>(y));
            }
    }

    /** Writes labels and runs, column by column. */
    void label(Annotated& all, const std::map<int32_t, uint16_t>& number_of) const {
        all.labels.assign(picture_.cells().size(), 0);
        std::vector<uint32_t> end(all.annotations.size(), 0);  // end of the last run, in pixels from the start
        uint32_t place = 0;
        for (uint32_t x = 0; x < picture_.width(); ++x)
            for (uint32_t y = 0; y < picture_.height(); ++y, ++place) {
                const size_t pixel = size_t{y} * picture_.width() + x;
                const auto number = number_of.find(objectAt(pixel));
                if (number == number_of.end()) continue;
                all.labels[pixel] = number->second;
                const size_t i = number->second - 1u;
                std::vector<uint32_t>& runs = all.annotations[i].runs;
                if (runs.empty() || end[i] < place) runs.insert(runs.end(), {place - end[i], 0});
                ++runs.back();
                end[i] = place + 1;
            }
        for (size_t i = 0; i < end.size(); ++i)
            if (end[i] < place) all.annotations[i].runs.push_back(place - end[i]);
    }

    const types::Sonar& ping_;
    const types::SonarTruth& truth_;
    const output::PlainPicture& picture_;
    const Instances& instances_;
    const uint32_t ghost_;        ///< Class of ghosts; 0: none.
    const int32_t first_shadow_;  ///< Number of objects of the truth.
    const AnnotationConfig& config_;
    const bool decibel_;
    const double bin_width_;                 ///< [m]
    const std::span<const float> ranges_;    ///< Range of each beam of a range image [m].
    const std::span<const int32_t> hiders_;  ///< The instance that hides each bin; empty: shadows have no annotation.
    /** The label of each cell: an instance; from first_shadow_ on the shadow of an instance; from 2 * first_shadow_ on
     *  a ghost. */
    std::vector<int32_t> object_of_;
    std::map<int32_t, Annotation> found_;
};

}  // namespace

Instances::Instances(const Classes& classes, const std::vector<Lineage>& objects) {
    std::map<std::string, int32_t> first_of;
    for (const Lineage& names : objects) {
        const auto hasClass = [&](const std::string& name) { return classes.of(name) != 0; };
        const auto nearest = std::ranges::find_if(names, hasClass);
        const uint32_t category = nearest == names.end() ? 0 : classes.of(*nearest);
        std::string name = names.front();
        for (auto above = nearest; above != names.end(); ++above)
            if (classes.of(*above) == category) name = *above;
        const auto object = static_cast<int32_t>(instances_.size());
        const int32_t first = category == 0 ? object : first_of.try_emplace(name, object).first->second;
        instances_.push_back({first, std::move(name), category, classes.shadow(category)});
    }
}

std::vector<int32_t> Instances::parts(int32_t instance) const {
    std::vector<int32_t> all;
    for (size_t i = 0; i < instances_.size(); ++i)
        if (instances_[i].first == instance) all.push_back(static_cast<int32_t>(i));
    return all;
}

namespace {

/** Returns whether a bin has an echo of a surface. */
bool isLit(const types::SonarTruth& truth, size_t bin) {
    return truth.object[bin] != types::SonarTruth::no_object || truth.hits[bin] > 0;
}

}  // namespace

void addShadow(const types::SonarTruth& with, const types::SonarTruth& without, int32_t instance,
               std::span<int32_t> hiders) {
    INSONIFY_CHECK(with.object.size() == without.object.size() && hiders.size() == with.object.size(),
                   with.object.size(), without.object.size(), hiders.size());
    for (size_t bin = 0; bin < hiders.size(); ++bin)
        if (hiders[bin] == none && !isLit(with, bin) && isLit(without, bin) && !without.isByMirror(bin))
            hiders[bin] = instance;
}

Annotated annotate(const types::Sonar& ping, const types::SonarTruth& truth, const output::PlainPicture& picture,
                   const Classes& classes, const Instances& instances, const AnnotationConfig& config,
                   output::BinScale scale, std::span<const float> ranges, std::span<const int32_t> hiders) {
    return Annotator(ping, truth, picture, classes, instances, config, scale, ranges, hiders).annotated();
}

}  // namespace insonify::dataset
