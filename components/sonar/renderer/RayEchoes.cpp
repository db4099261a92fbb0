#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include "components/sonar/base/ThreadPool.hpp"
#include "components/sonar/bins/Accumulator.hpp"
#include "components/sonar/bins/Truth.hpp"
#include "components/sonar/multipath/Mirrors.hpp"
#include "components/sonar/multipath/WallRays.hpp"
#include "components/sonar/plan/EchoRenderer.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/rays/RayPaths.hpp"
#include "components/sonar/rays/SceneTrees.hpp"
#include "components/sonar/rays/SurfaceMapping.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "components/sonar/surfaces/DeformedMeshes.hpp"
#include "components/sonar/surfaces/FacetLobes.hpp"
#include "components/sonar/surfaces/ObjectPlacements.hpp"
#include "types/Check.hpp"

namespace insonify::sonar {
namespace {

using Clock = std::chrono::steady_clock;

/** Max samples of a part: they fit a thread's cache, and divide one beam with very many samples [1]. */
constexpr int part_samples = 8192;

/** Share of the energy below which a ray behind walls ends: 60 dB [1]. */
constexpr auto min_passed = static_cast<float>(WallRays::min_passed);

/** Max triangles of deforming meshes up to which facets of smooth bodies are computed anew in each ping [1]. */
constexpr size_t max_bent = 10'000;

/** Work that one thread takes at a time: some rows of neighbouring beams, enough to fill a tile's columns. */
struct Part {
    int first_beam, beams, first_row, rows;
    size_t strip;
};

/** All parts of the same beams. */
struct Strip {
    int parts = 0;
    int left = 0;                ///< Parts that are still to be gathered in this ping.
    std::vector<uint64_t> sums;  ///< Sums of several parts.
    std::mutex mutex;
};

class RayEchoes final : public EchoRenderer {
public:
    RayEchoes(const RenderPlan& plan, types::GeometryPtr geometry, PingEffects& effects);
    void updateQuality() override;
    bool setScene(types::GeometryPtr geometry, bool same_plan) override;
    bool changePlan() override;
    void deform(DeformedMeshes* meshes, types::GeometryPtr geometry) override;
    void updateShapes(const types::Snapshot& snapshot) override;
    void follow(const types::Snapshot& snapshot) override;
    void render(const types::Snapshot& snapshot, types::Sonar& ping, Stages& stages) override;
    bool forget() override;
    void setTruth(types::SonarTruth* truth) override { truth_ = truth; }
    Accumulator& accumulator() override { return *accumulator_; }
    const RayPaths* bent() const override { return ray_paths_ && !ray_paths_->areStraight() ? &*ray_paths_ : nullptr; }
    bool hasEchoes() const override { return received_; }
    const std::string& device() const override { return device_; }

private:
    /** Buffers of one thread. */
    struct Worker {
        std::vector<TracedTile> tiles;
        std::vector<TileHits> hits;                           ///< Hits of each tile.
        std::vector<std::array<float, tile_samples>> passed;  ///< Shares of each tile's samples, where there are walls.
        MappedTiles mapped;
        std::vector<uint64_t> sums;
        std::optional<TruthTable> shown;   ///< Truth of the sums, where it is recorded.
        std::vector<uint64_t> one_beam;    ///< For TruthSink.
        std::vector<uint64_t> truth_sums;  ///< Sums of energies, where the truth of fields is recorded.
        size_t number = 0;
        Stages stages{};
        Clock::time_point last;
        bool received = false;

        void lap(StageOf stage) {
            const Clock::time_point now = Clock::now();
            stages[stage].seconds += std::chrono::duration<double>(now - last).count();
            last = now;
        }
    };
    /** Computes what depends on scene and plan, such as the facets of materials with a specular lobe. */
    void updateLaws();
    void updatePlan();
    void shareOut();
    int beamsTogether() const {
        return std::min(view_.cells.beams, (3 + view_.cells.beam_columns) / view_.cells.beam_columns);
    }
    void place(const types::Snapshot& snapshot);
    void placeRuns();
    void makeTruth();
    PlacedScene scene() const {
        return {surface_maps_ ? surface_maps_->commands() : visibility_.commands(),
                runs_,
                places_->records(),
                *normal_maps_,
                water_,
                bent(),
                surface_maps_ ? &*surface_maps_ : nullptr};
    }
    TracedPing tracedPing() {
        return {rules_, accumulator_->levels(), view_, visibility_, scene(), truth_ ? truth_grid_->water() : nullptr};
    }
    void addEnergies();
    void depositPart(const Part& part, std::span<TracedTile> tiles, Worker& worker);
    /** Deposits tiles. `behind_walls`: without the water in front of the hits. */
    void deposit(std::span<const TracedTile> tiles, bool behind_walls, int first_beam, Worker& worker) const;
    /** Deposits tiles whose surface maps have been looked up. */
    void depositAsMet(std::span<const TracedTile> tiles, bool behind_walls, int first_beam, Worker& worker) const;
    /** Follows rays through the walls that they have hit. Returns whether there are any. */
    bool traceThrough(std::span<TracedTile> tiles, Worker& worker) const;
    bool traceThrough(TracedTile& tile) const;
    /** Follows rays through walls that ring or have a fill, and between walls; deposits their echoes. */
    void followWalls(std::span<const TracedTile> tiles, int first_beam, Worker& worker) const;
    void work(Worker& worker);
    void workOn(const Part& part, Worker& worker);
    std::span<TracedTile> trace(const Part& part, Worker& worker) const;
    /** Fills the bins of a cell from its sums. Returns whether it has any echo. */
    bool fill(size_t cell, const Worker& worker, const uint64_t* sums);
    /** Adds a part's sums to its strip's. Returns whether these are now complete, and in the worker. */
    bool gather(const Part& part, Worker& worker);

    const RenderPlan& plan_;
    types::GeometryPtr geometry_;
    PingEffects& effects_;
    EchoRules rules_;
    std::optional<EchoRules> energy_rules_;  ///< For the truth, where fields are summed.
    TracedView view_;
    TileDirections directions_;
    WaterView water_;      ///< Water view of this ping.
    WaterMirror surface_;  ///< Ends rays that have passed walls.
    std::unique_ptr<Accumulator> accumulator_;
    std::unique_ptr<ObjectPlacements> places_;
    RayVisibility visibility_;
    std::optional<RayPaths> ray_paths_;      ///< None where rays are straight.
    std::vector<MeshFacts::Planes> planes_;  ///< One for each mesh.
    std::vector<MeshFacts::Facets> facets_;  ///< One for each mesh.
    std::vector<MeshFacts::Curves> curves_;  ///< One for each mesh.
    Reverberation reverberation_;
    std::unique_ptr<NormalMapping> normal_maps_;
    std::optional<SurfaceMapping> surface_maps_;  ///< None if the plan has none.
    DeformedMeshes* deformed_ = nullptr;          ///< Null: no mesh deforms.
    bool bends_ = true;                           ///< Whether facets of deforming meshes have curvature.
    MeshesAhead ahead_;
    std::vector<PlacedRun> runs_;  ///< Runs of the visibility's commands, placed in this ping.
    ThreadPool threads_;
    std::vector<Worker> workers_;
    std::vector<Part> parts_;
    std::vector<Strip> strips_;
    std::atomic<size_t> next_ = 0;
    std::string device_ = "rays on the processor";
    bool received_ = false;
    types::SonarTruth* truth_ = nullptr;   ///< Truth to be filled; null: none.
    std::optional<TruthGrid> truth_grid_;  ///< Made at the first ping with truth.
};

RayEchoes::RayEchoes(const RenderPlan& plan, types::GeometryPtr geometry, PingEffects& effects)
    : plan_(plan),
      geometry_(std::move(geometry)),
      effects_(effects),
      rules_(makeEchoRules(plan, effects)),
      surface_(plan.config),
      visibility_(*geometry_),
      threads_(plan.options.threads, ThreadPool::Threads::Shared),
      workers_(static_cast<size_t>(threads_.size())) {
    for (size_t i = 0; i < workers_.size(); ++i) workers_[i].number = i;
    setScene(geometry_, false);
}

void RayEchoes::deform(DeformedMeshes* meshes, types::GeometryPtr geometry) {
    deformed_ = meshes;
    setScene(std::move(geometry), true);
    if (!meshes) return;
    size_t triangles = 0;
    for (const uint32_t object : meshes->objects())
        triangles += geometry_->meshes[static_cast<size_t>(geometry_->objects[object].mesh)].indices.size() / 3;
    bends_ = triangles <= max_bent;
}

void RayEchoes::updateShapes(const types::Snapshot& snapshot) {
    visibility_.updateShapes();
    threads_.run([&](int part, int parts) {
        deformed_->take(snapshot, static_cast<size_t>(part), static_cast<size_t>(parts));
        const std::vector<uint32_t>& objects = deformed_->objects();
        for (size_t i = static_cast<size_t>(part); i < objects.size(); i += static_cast<size_t>(parts)) {
            const auto number = static_cast<size_t>(geometry_->objects[objects[i]].mesh);
            const types::Mesh& mesh = geometry_->meshes[number];
            const glm::dmat3 world_from_mesh = worldFromMesh(*geometry_, number);
            if (facets_[number]) facets_[number] = MeshFacts::facetsNow(mesh, world_from_mesh, plan_.laws);
            if (bends_)
                curves_[number] = std::make_shared<const std::vector<CurveRecord>>(facetCurves(mesh, world_from_mesh));
        }
    });
}

void RayEchoes::follow(const types::Snapshot& snapshot) {
    visibility_.place(snapshot);
    if (ray_paths_) ray_paths_->place(snapshot);
}

bool RayEchoes::setScene(types::GeometryPtr geometry, bool same_plan) {
    const types::GeometryPtr before = std::exchange(geometry_, std::move(geometry));  // kept until unused
    if (before != geometry_)
        visibility_.setScene(*geometry_,
                             deformed_ ? std::span<const uint32_t>(deformed_->objects()) : std::span<const uint32_t>());
    normal_maps_ = std::make_unique<NormalMapping>(*geometry_);
    std::vector<MeshFacts::Planes> planes;
    std::vector<MeshFacts::Curves> curves;
    std::vector<bool> deforms(geometry_->meshes.size());
    if (deformed_)
        for (const uint32_t object : deformed_->objects())
            deforms[static_cast<size_t>(geometry_->objects[object].mesh)] = true;
    const auto flat = std::make_shared<const std::vector<CurveRecord>>();  // until the shape of the ping is there
    for (size_t i = 0; i < geometry_->meshes.size(); ++i) {
        const auto facts = MeshFacts::of(geometry_->meshes.shared(i));
        planes.push_back(facts->planes());
        curves.push_back(deforms[i] ? flat : facts->curves(worldFromMesh(*geometry_, i)));
    }
    planes_ = std::move(planes);  // shared data is kept, because the predecessors are destroyed after the new are made
    curves_ = std::move(curves);
    updateLaws();
    if (ray_paths_) ray_paths_->setScene(*geometry_);
    if (!same_plan) updatePlan();
    return true;
}

void RayEchoes::updateLaws() {
    places_ = std::make_unique<ObjectPlacements>(*geometry_, reach(plan_), true);
    std::vector<MeshFacts::Facets> facets;
    for (size_t i = 0; i < geometry_->meshes.size(); ++i)
        facets.push_back(MeshFacts::of(geometry_->meshes.shared(i))->facets(worldFromMesh(*geometry_, i), plan_.laws));
    facets_ = std::move(facets);
    reverberation_ = Reverberation(plan_, *geometry_, facets_);
    surface_maps_.reset();
    if (plan_.has(Pass::SurfaceMaps)) surface_maps_.emplace(*geometry_, visibility_.commands());
    runs_.reserve(scene().commands.size());
}

bool RayEchoes::changePlan() {
    ray_paths_.reset();
    accumulator_.reset();
    updateLaws();
    updatePlan();
    return true;
}

bool RayEchoes::forget() {
    if (ray_paths_) return false;
    visibility_.forget();
    rules_ = makeEchoRules(plan_, effects_);
    if (energy_rules_) energy_rules_ = makeEnergyRules(plan_, effects_);
    return true;
}

void RayEchoes::updatePlan() {
    surface_ = WaterMirror(plan_.config);
    if (plan_.profile || plan_.config.motion_in_ping) {
        if (!ray_paths_) ray_paths_.emplace(plan_, *geometry_);
    } else {
        ray_paths_.reset();
    }
    updateQuality();
}

void RayEchoes::updateQuality() {
    rules_ = makeEchoRules(plan_, effects_);
    view_.cells = makeAngularView(plan_);
    energy_rules_.reset();
    if (plan_.sumsFields()) energy_rules_ = makeEnergyRules(plan_, effects_);
    if (accumulator_)
        accumulator_->setQuality(plan_);
    else
        accumulator_ = makeAccumulator(plan_, threads_.size());
    shareOut();
    truth_grid_.reset();
}

void RayEchoes::shareOut() {
    const int beam_columns = view_.cells.beam_columns, beams = view_.cells.beams, together = beamsTogether();
    view_.shape = TileShape(view_.cells, rules_.bins, together);
    directions_ = TileDirections(view_, together * beam_columns);
    const int wanted = std::max(1, part_samples / (together * beam_columns)), up = view_.shape.all.rows;
    const int rows = std::min((wanted + up - 1) / up * up, (view_.cells.rows + up - 1) / up * up);
    parts_.clear();
    strips_ = std::vector<Strip>(static_cast<size_t>((beams + together - 1) / together));
    for (size_t strip = 0; strip < strips_.size(); ++strip) {
        const int first = static_cast<int>(strip) * together;
        for (int row = 0; row < view_.cells.rows; row += rows, ++strips_[strip].parts)
            parts_.push_back(
                {first, std::min(together, beams - first), row, std::min(rows, view_.cells.rows - row), strip});
        if (strips_[strip].parts > 1) strips_[strip].sums.resize(static_cast<size_t>(together) * rules_.sumCount());
    }
    const int across = (together * beam_columns + view_.shape.all.columns - 1) / view_.shape.all.columns;
    for (Worker& worker : workers_) {
        worker.hits.resize(static_cast<size_t>(across * (rows / up)));
        worker.tiles.resize(worker.hits.size());
        if (plan_.has(Pass::Walls)) worker.passed.resize(worker.hits.size());
        worker.sums.resize(static_cast<size_t>(together) * rules_.sumCount());
    }
}

void RayEchoes::makeTruth() {
    const bool whole = std::ranges::all_of(strips_, [](const Strip& strip) { return strip.parts == 1; });
    truth_grid_.emplace(plan_, rules_, whole, threads_.size());
    for (Worker& worker : workers_) {
        worker.shown.emplace(static_cast<size_t>(beamsTogether()), static_cast<size_t>(plan_.grid.bin_count));
        worker.one_beam.assign((energy_rules_ ? *energy_rules_ : rules_).sumCount(), 0);
        if (energy_rules_)
            worker.truth_sums.assign(static_cast<size_t>(beamsTogether()) * energy_rules_->sumCount(), 0);
    }
}

void RayEchoes::place(const types::Snapshot& snapshot) {
    water_ = waterView(snapshot);
    surface_.place(snapshot, plan_.grid.range_max);
    places_->place(snapshot);
    visibility_.place(snapshot);
    if (visibility_.needsFitting()) {
        threads_.run([this](int part, int parts) {
            visibility_.fitDeforming(static_cast<size_t>(part), static_cast<size_t>(parts));
        });
        visibility_.joinDeforming();
    }
    if (ray_paths_) ray_paths_->place(snapshot);
    placeRuns();
    INSONIFY_CHECK(runs_.size() == scene().commands.size(), runs_.size(), scene().commands.size());
    ahead_.take(snapshot.ahead, plan_.laws);
}

void RayEchoes::placeRuns() {
    runs_.clear();
    for (const CommandRecord& command : scene().commands) {
        const auto mesh = static_cast<size_t>(geometry_->objects[command.object].mesh);
        const FacetRecord* facets = facets_[mesh] ? facets_[mesh]->data() : nullptr;
        const CurveRecord* curves = curves_[mesh]->empty() ? nullptr : curves_[mesh]->data();
        runs_.push_back(
            placedRun(places_->records()[command.object], command, rules_, planes_[mesh]->data(), facets, curves));
    }
}

std::span<TracedTile> RayEchoes::trace(const Part& part, Worker& worker) const {
    const int begin = part.first_beam * view_.cells.beam_columns, end = begin + part.beams * view_.cells.beam_columns;
    std::array<TileRays, RayVisibility::tiles_at_once> rays;
    size_t count = 0, waiting = 0;
    const auto traceWaiting = [&] {
        TileHits* const hits = &worker.hits[count - waiting];
        if (!bent()) visibility_.trace({rays.data(), waiting}, {hits, waiting});
        for (size_t i = 0; bent() && i < waiting; ++i) visibility_.traceAlong(*ray_paths_, rays[i], hits[i]);
        waiting = 0;
    };
    for (int column = begin; column < end; column += view_.shape.all.columns)
        for (int row = part.first_row; row < part.first_row + part.rows; row += view_.shape.all.rows) {
            INSONIFY_CHECK(count < worker.tiles.size(), count, worker.tiles.size());
            TracedTile& tile = worker.tiles[count];
            tile = {column, row, end, &worker.hits[count]};
            ++count;
            rays[waiting++] = directions_.rays(view_.cells, column, row);
            if (waiting == rays.size()) traceWaiting();
        }
    if (waiting > 0) traceWaiting();
    return {worker.tiles.data(), count};
}

bool RayEchoes::gather(const Part& part, Worker& worker) {
    Strip& strip = strips_[part.strip];
    if (strip.parts == 1) return true;
    const std::lock_guard alone(strip.mutex);
    INSONIFY_CHECK(strip.left > 0 && strip.sums.size() == worker.sums.size(), strip.left, strip.sums.size());
    for (size_t i = 0; i < strip.sums.size(); ++i) strip.sums[i] += worker.sums[i];
    if (--strip.left > 0) return false;
    std::copy(strip.sums.begin(), strip.sums.end(), worker.sums.begin());
    return true;
}

bool RayEchoes::traceThrough(TracedTile& tile) const {
    const TileRays straight = directions_.rays(view_.cells, tile.first_column, tile.first_row);
    PathRays on{};
    on.towards = straight;
    on.towards.active = 0;
    for (int i = 0; i < tile_samples; ++i) {
        on.nearest[i] = 1;  // ray that ends
        if (!(straight.active >> i & 1) || tile.hits->command[i] == TileHits::nothing) continue;
        const PlacedRun& run = runs_[tile.hits->command[i]];
        const glm::dvec3 direction(straight.x[i], straight.y[i], straight.z[i]),
            normal = turned(run, run.planes[tile.hits->triangle[i]].normal);
        const double length = glm::length(direction),
                     cosine = std::abs(glm::dot(normal, direction)) / (glm::length(normal) * length);
        tile.passed[i] *= static_cast<float>(rules_.laws.walls[run.material].passedAt(cosine));
        const float begin =
            tile.hits->distance[i] * (1 + 1e-5f) + static_cast<float>(RayVisibility::nearest / 10 / length);
        const auto end =
            static_cast<float>(std::min(rules_.bins.range_max / length, surface_.distance(glm::dvec3(0), direction)));
        if (!(tile.passed[i] >= min_passed) || !(begin < end)) continue;
        on.nearest[i] = begin;
        on.farthest[i] = end;
        on.towards.active |= 1u << i;
    }
    count(Counter::WallsPassed, std::popcount(on.towards.active));
    if (on.towards.active) visibility_.trace(on, *tile.hits);
    return on.towards.active;
}

bool RayEchoes::traceThrough(std::span<TracedTile> tiles, Worker& worker) const {
    bool any = false;
    for (size_t i = 0; i < tiles.size(); ++i) {
        if (!tiles[i].passed) worker.passed[i].fill(1);
        tiles[i].passed = worker.passed[i].data();
        tiles[i].path = behind_walls;
        if (traceThrough(tiles[i]))
            any = true;
        else
            std::fill_n(tiles[i].hits->command, tile_samples, TileHits::nothing);
    }
    return any;
}

void RayEchoes::followWalls(std::span<const TracedTile> tiles, int first_beam, Worker& worker) const {
    const PlacedScene scene = this->scene();
    WallRays rays(rules_, view_, visibility_, scene, surface_, reverberation_, plan_.config.max_walls,
                  accumulator_->levels().lossOfWater());
    for (const TracedTile& tile : tiles)
        if (rays.begin(tile, directions_.rays(view_.cells, tile.first_column, tile.first_row)))
            while (const TracedTile* echoes = rays.next()) deposit({echoes, 1}, true, first_beam, worker);
}

void RayEchoes::deposit(std::span<const TracedTile> tiles, bool behind_walls, int first_beam, Worker& worker) const {
    if (!surface_maps_) return depositAsMet(tiles, behind_walls, first_beam, worker);
    worker.mapped.take(view_, scene(), tiles, plan_.sumsFields());
    depositAsMet(worker.mapped.whole(), behind_walls, first_beam, worker);
    depositAsMet(worker.mapped.rest(), true, first_beam, worker);
}

void RayEchoes::depositAsMet(std::span<const TracedTile> tiles, bool behind_walls, int first_beam,
                             Worker& worker) const {
    EchoSums sums{first_beam, worker.sums.data(), nullptr, behind_walls};
    if (energy_rules_) depositPatches(rules_, view_, scene(), tiles, sums);
    if (energy_rules_ && !truth_) return;
    std::optional<TruthSink> truth;
    if (truth_) sums.truth = &truth.emplace(TruthSink{*worker.shown, {}, worker.one_beam});
    if (energy_rules_) sums.sums = worker.truth_sums.data();
    depositTiles(energy_rules_ ? *energy_rules_ : rules_, view_, scene(), tiles, sums);
}

void RayEchoes::depositPart(const Part& part, std::span<TracedTile> tiles, Worker& worker) {
    std::fill(worker.sums.begin(), worker.sums.end(), 0);
    if (truth_) worker.shown->clear();
    deposit(tiles, false, part.first_beam, worker);
    const bool apart = plan_.has(Pass::Walls) && (rules_.laws.hasReturns() || reverberation_.is_there);
    if (apart) followWalls(tiles, part.first_beam, worker);
    const int walls = plan_.has(Pass::Walls) && !apart ? plan_.config.max_walls : 0;
    for (int wall = 0; wall < walls && traceThrough(tiles, worker); ++wall)
        deposit(tiles, true, part.first_beam, worker);
}

void RayEchoes::workOn(const Part& part, Worker& worker) {
    INSONIFY_CHECK(part.first_beam + part.beams <= view_.cells.beams, part.first_beam, part.beams, view_.cells.beams);
    const std::span<TracedTile> tiles = trace(part, worker);
    worker.lap(DrawStage);
    effects_.followRays(tracedPing(), tiles);
    depositPart(part, tiles, worker);
    worker.lap(DepositStage);
    if (gather(part, worker))
        for (int beam = 0; beam < part.beams; ++beam)
            worker.received |= fill(static_cast<size_t>(part.first_beam + beam), worker,
                                    &worker.sums[static_cast<size_t>(beam) * rules_.sumCount()]);
    for (int beam = 0; truth_ && beam < part.beams; ++beam)
        truth_grid_->take(static_cast<size_t>(part.first_beam + beam), *worker.shown, static_cast<size_t>(beam),
                          *truth_);
    worker.lap(BeamStage);
}

bool RayEchoes::fill(size_t cell, const Worker& worker, const uint64_t* sums) {
    if (truth_ && truth_grid_->water())
        truth_grid_->water()->take(rules_, sums, cell, view_.cells.cell(), worker.number);
    count(Counter::Bins, static_cast<uint64_t>(rules_.bins.bin_count));
    return accumulator_->fill(cell, rules_, sums, view_.cells.cell(), worker.number);
}

void RayEchoes::addEnergies() {
    const TracedPing traced = tracedPing();
    threads_.run([&](int part, int parts) {
        for (int cell = part; cell < view_.cells.beams; cell += parts) {
            const auto i = static_cast<size_t>(cell);
            const auto thread = static_cast<size_t>(part);
            if (!effects_.addEnergies(traced, i, accumulator_->energies(i, thread))) continue;
            accumulator_->addEnergies(i, thread);
            workers_[thread].received = true;
        }
    });
}

void RayEchoes::work(Worker& worker) {
    worker.last = Clock::now();
    for (size_t i = next_++; i < parts_.size(); i = next_++) workOn(parts_[i], worker);
}

void RayEchoes::render(const types::Snapshot& snapshot, types::Sonar& ping, Stages& stages) {
    Worker& own = workers_.front();
    own.last = Clock::now();
    place(snapshot);
    accumulator_->begin(snapshot, ping);
    if (truth_ && !truth_grid_) makeTruth();
    if (truth_) truth_grid_->begin();
    stages[CullStage].seconds += std::chrono::duration<double>(Clock::now() - own.last).count();
    next_ = 0;
    for (Worker& worker : workers_) {
        worker.received = false;
        for (Stage& stage : worker.stages) stage.seconds = 0;
    }
    for (Strip& strip : strips_) {
        strip.left = strip.parts;
        std::fill(strip.sums.begin(), strip.sums.end(), 0);
    }
    const bool alone = parts_.size() == 1;
    if (alone)
        work(own);
    else
        threads_.share([&](int part, int) { work(workers_[static_cast<size_t>(part)]); });
    own.last = Clock::now();
    if (effects_.followsRays()) addEnergies();
    accumulator_->finish(threads_);
    if (truth_) truth_grid_->finish(*truth_, threads_);
    if (truth_) effects_.addToTruth(tracedPing(), *truth_);
    stages[BeamStage].seconds += std::chrono::duration<double>(Clock::now() - own.last).count();
    received_ = false;
    for (const Worker& worker : workers_) {
        for (size_t i = 0; i < stages.size(); ++i)
            stages[i].seconds += worker.stages[i].seconds / static_cast<double>(alone ? 1 : workers_.size());
        received_ = received_ || worker.received;
    }
}

}  // namespace

std::unique_ptr<EchoRenderer> makeRayEchoes(const RenderPlan& plan, types::GeometryPtr geometry, PingEffects& effects) {
    return std::make_unique<RayEchoes>(plan, std::move(geometry), effects);
}

}  // namespace insonify::sonar
