#include "components/sonar/raster/PictureDeposit.hpp"

#include <algorithm>
#include <limits>

namespace insonify::sonar {
namespace {

/** Returns the first and end column of the frustum that any beam of [first, last) touches. */
std::array<int, 2> touched(const ColumnShares& shares, uint first, uint last) {
    std::array<int, 2> range{std::numeric_limits<int>::max(), 0};
    for (const ShareRecord& share : shares.shares)
        if (share.beam >= first && share.beam < last) {
            const int column = static_cast<int>(share.column);
            range = {std::min(range[0], column), std::max(range[1], column + 1)};
        }
    return range;
}

}  // namespace

PictureDeposit::PictureDeposit(DepositSetup setup, const SurfacePass& surface, const gpu::EglContext& context,
                               ThreadPool& threads)
    : setup_(std::move(setup)),
      context_(context),
      threads_(threads),
      planes_(surface.scene().planes()),
      facets_(surface.scene().facets()),
      columns_(static_cast<size_t>(threads.size()), std::vector<std::array<int, 2>>(setup_.shares.size())),
      pictures_(setup_.frusta.size()),
      sums_(setup_.sumCount()) {
    for (size_t i = 0; i < pictures_.size(); ++i) {
        const VisibilityBuffer& rasterised = surface.picture(i);
        pictures_[i].view.channels = static_cast<size_t>(rasterised.channels());
        pictures_[i].words = gpu::ReadBack(rasterised.bytes());
        pictures_[i].view.ranges.reserve(surface.lists().drawLimit());
    }
    touchColumns();
}

void PictureDeposit::begin(const WaterView& water) {
    for (Taken& picture : pictures_) picture.taken = false;
    water_ = water;
}

void PictureDeposit::take(size_t frustum, const SurfacePass& surface) {
    Taken& picture = pictures_[frustum];
    surface.picture(frustum).read(picture.words);
    picture.taken = true;
    picture.view.ranges.clear();
    picture.view.objects.clear();
    for (const CommandRecord& command : surface.lists().commands(frustum)) {
        if (truth_) picture.view.objects.push_back(command.object);
        const FacetRecord* facets = facets_.empty() ? nullptr : facets_.data() + command.first_triangle;
        picture.view.ranges.push_back(placedRun(surface.objects()[command.object], command, setup_.rules,
                                                planes_.data() + command.first_triangle, facets, nullptr));
    }
}

std::span<const uint64_t> PictureDeposit::finish() {
    {
        const auto alone = context_.transferring();
        for (Taken& picture : pictures_)
            if (picture.taken) picture.view.pixels = static_cast<const uint32_t*>(picture.words.wait());
    }
    threads_.run([&](int part, int) { depositPart(static_cast<size_t>(part)); });
    return sums_;
}

void PictureDeposit::prepareTruth(std::vector<int32_t> beams) {
    truth_beams_ = std::move(beams);
    one_beam_.assign(columns_.size(), std::vector<uint64_t>(setup_.rules.sumCount()));
    for (Taken& picture : pictures_) picture.view.objects.reserve(picture.view.ranges.capacity());
    touchColumns();
}

void PictureDeposit::touchColumns() {
    for (size_t part = 0; part < columns_.size(); ++part)
        for (size_t i = 0; i < setup_.shares.size(); ++i)
            columns_[part][i] = touched(setup_.shares[i], firstBeam(part), firstBeam(part + 1));
}

void PictureDeposit::depositPart(size_t part) {
    const uint first = firstBeam(part), last = firstBeam(part + 1);
    const size_t stride = setup_.rules.sumCount();
    std::fill(sums_.begin() + static_cast<ptrdiff_t>(first * stride),
              sums_.begin() + static_cast<ptrdiff_t>(last * stride), 0);
    for (size_t i = 0; i < setup_.frusta.size(); ++i) {
        const Taken& taken = pictures_[i];
        if (!taken.taken) continue;
        const PicturePart frustum{setup_.rules, setup_.frusta[i], setup_.shares[i], taken.view, water_, first,
                                  last,         columns_[part][i]};
        if (!truth_) {
            depositPicture(frustum, {0, sums_.data()});
            continue;
        }
        const TruthSink truth{*truth_, truth_beams_, one_beam_[part]};
        depositPicture(frustum, {0, sums_.data(), &truth});
    }
}

uint32_t PictureDeposit::firstBeam(size_t part) const {
    auto first = static_cast<uint32_t>(setup_.beam_count * part / static_cast<size_t>(threads_.size()));
    // The beams of one beam of the truth stay with one thread.
    while (!truth_beams_.empty() && first > 0 && first < setup_.beam_count &&
           truth_beams_[first] == truth_beams_[first - 1])
        ++first;
    return first;
}

}  // namespace insonify::sonar
