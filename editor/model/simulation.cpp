// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/simulation.h"

#include "model/history.h"

#include <algorithm>
#include <cmath>

namespace thaw::editor {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Simulation::Worker {
    Worker(Simulation& of, int threads) : out(of), live(threads) {}

    Simulation& out;
    LiveWorld live;
    MeshStore store;
    Orders orders;
    uint64_t revision = 0, resets = 0, steps = 0, seeks = 0; // carried out
    History history;
    int64_t frame = 0;
    int64_t goal = -1;    // frame that is gone to through what was run; -1: none
    bool stale = false;   // what was changed at the start went into the world as it stood: it is not what a new one is
    bool changed = false; // since the last frame was sent
    double due = 0;       // when the next step is
    std::string error;
    Last<StepSample, 480> samples;
    Last<Span, 512> spans;

    template <class F> auto timed(SpanKind kind, F&& f) {
        const double start = now();
        const auto add = [&] { spans.add({start, now(), kind}); };
        try {
            if constexpr (std::is_void_v<decltype(f())>) {
                f(), add();
            } else {
                auto result = f();
                add();
                return result;
            }
        } catch (...) {
            add();
            throw;
        }
    }

    void build() {
        timed(SpanKind::build, [&] {
            error.clear(), changed = true, stale = false;
            frame = 0, goal = -1;
            samples.clear(), history.clear();
            if (!orders.scene) return live.clear();
            try {
                live.build(orders.scene, store.load(*orders.scene));
                history.begin(live);
            } catch (const std::exception& e) {
                live.clear();
                error = e.what();
            }
        });
    }

    /// The newest scene into the world.
    void follow() {
        revision = orders.revision, changed = true;
        if (!orders.scene || !live.world()) return build();
        const Changes changes = changesBetween(*live.scene(), *orders.scene);
        // At the start a body is cheap to have anew, and then all is as if it had been loaded.
        const bool bodies = changes.bodies.size() != live.scene()->bodies.size() ||
                            std::any_of(changes.bodies.begin(), changes.bodies.end(),
                                        [](const KeptBody& b) { return b.changed || b.was < 0; });
        if (changes.capacity || (frame == 0 && bodies)) return build();
        bring(orders.scene, orders.playing && frame > 0);
        if (changes.any()) {
            // What was run beyond this was run with another scene.
            history.cut(frame);
            stale = stale || frame == 0;
        }
    }

    /// Changes the world as it stands into this scene.
    void bring(const std::shared_ptr<const scene::Scene>& scene, bool driven) {
        if (live.scene() == scene) return;
        try {
            error.clear();
            auto meshes = store.load(*scene);
            timed(SpanKind::build, [&] { live.follow(scene, std::move(meshes), driven); });
        } catch (const std::exception& e) {
            error = e.what();
        }
    }

    /// Back to the start, as the scene is now.
    void rewind() {
        changed = true;
        try {
            if (!stale && live.world() && live.scene() && !history.empty() && orders.scene &&
                !changesBetween(*startScene(), *orders.scene).any() && store.load(*orders.scene) == live.meshes()) {
                timed(SpanKind::rewind, [&] { frame = history.restore(0, live); });
                if (frame == 0) return bring(orders.scene, false);
            }
        } catch (const std::exception&) {
            // What is wrong with the scene is told by building it.
        }
        build();
    }

    std::shared_ptr<const scene::Scene> startScene() const {
        return history.newest() > 0 ? history.step(1).scene : live.scene();
    }

    void step() {
        if (frame == 0 && stale) build();
        if (!live.world()) return;
        bring(orders.scene, orders.playing);
        advance(orders.budget);
        history.add(frame, {samples.newest().work, live.scene(), orders.playing}, live);
        if (orders.loopAt > 0 && orders.playing && double(frame) / 60 >= double(orders.loopAt)) rewind();
    }

    /// A step of those that were done before, with the same bits.
    void replay() {
        const History::Step& step = history.step(frame + 1);
        bring(step.scene, step.driven);
        thawBudget budget;
        thawInitBudget(&budget);
        budget.mode = thawBudget_work, budget.work = step.work;
        timed(SpanKind::rewind, [&] { live.step(budget); });
        ++frame;
    }

    void seek(int64_t to) {
        goal = -1;
        if (!live.world()) return;
        to = std::clamp<int64_t>(to, 0, history.newest());
        if (to < frame || history.imageBefore(to) > frame) {
            const int64_t at = timed(SpanKind::rewind, [&] { return history.restore(to, live); });
            if (at < 0) return;
            frame = at;
        }
        goal = to, changed = true;
    }

    void advance(const thawBudget& budget) {
        StepSample sample;
        sample.status = timed(SpanKind::step, [&] { return live.step(budget); });
        sample.frame = ++frame;
        sample.budgetMs = budget.mode == thawBudget_milliseconds ? budget.milliseconds : 0;
        thawWorld_GetProfile(live.world(), &sample.profile);
        thawPlan plan;
        thawWorld_GetPlan(live.world(), &plan);
        sample.work = plan.work;
        thawCounters counters;
        thawWorld_GetCounters(live.world(), &counters);
        std::copy_n(counters.levels, 4, sample.levels.begin());
        sample.melted = counters.meltedFraction;
        double mass = 0, heat = 0;
        for (const thawBodyId id : live.ids().bodies) {
            thawBodyState state;
            if (thawBody_GetState(live.world(), id, &state) != thawResult_ok) continue;
            mass += double(state.mass), heat += double(state.mass) * double(state.meanTemperature);
        }
        sample.meanTemperature = mass > 0 ? float(heat / mass) : 0;
        samples.add(sample);
        changed = true;
    }

    void show(Frame& f) {
        f.frame = frame, f.revision = revision, f.resets = resets, f.error = error;
        f.built = live.world() != nullptr;
        f.scene = live.scene() ? live.scene() : orders.scene, f.meshes = live.meshes();
        f.particles.clear();
        f.bodyOfIndex.clear(), f.materialOfIndex.clear(), f.bodies.clear(), f.colliders.clear(), f.bodyReports.clear();
        f.paths.clear(), f.shapes.clear();
        f.counters = {}, f.plan = {}, f.ledger = {};
        f.time = 0;
        if (thawWorld* w = live.world()) {
            thawSurfaceDef def;
            thawInitSurfaceDef(&def);
            thawSurfaceView surface{};
            const double start = now();
            timed(SpanKind::surface, [&] {
                if (thawWorld_ExtractSurface(w, &def, &surface) != thawResult_ok && error.empty())
                    f.error = error = thawWorld_GetLastError(w);
            });
            const float ms = float(1000 * (now() - start));
            timed(SpanKind::copy, [&] { copy(w, surface, f); });
            if (samples.size() && samples.newest().frame == frame) {
                StepSample sample = samples.newest();
                sample.surfaceMs = ms;
                samples.replaceNewest(sample);
            }
        } else {
            f.mesh.copy({});
        }
        f.oldest = 0, f.newest = std::max(frame, history.newest());
        f.working = goal >= 0;
        f.snapshotBytes = history.bytes();
        f.steps = samples, f.spans = spans;
    }

    void copy(thawWorld* w, const thawSurfaceView& surface, Frame& f) {
        f.mesh.copy(surface);
        if (orders.particles || orders.featureSizes || orders.splats) {
            const float* sizes = nullptr;
            if (orders.featureSizes && thawWorld_GetFeatureSizes(w, &sizes) != thawResult_ok) sizes = nullptr;
            thawParticleView particles{};
            thawWorld_GetParticles(w, &particles);
            f.particles.copy(particles, sizes);
            thawSplatView splats{};
            if (orders.splats && thawWorld_GetSplats(w, &splats) == thawResult_ok) f.particles.copySplats(splats);
        }
        const scene::SceneWorld& ids = live.ids();
        const auto index = [](std::vector<int>& of, uint32_t index1, size_t i) {
            if (index1 == 0) return;
            if (of.size() < index1) of.resize(index1, -1);
            of[index1 - 1] = int(i);
        };
        for (size_t i = 0; i < ids.bodies.size(); ++i) {
            index(f.bodyOfIndex, ids.bodies[i].index1, i);
            thawBodyState state{};
            thawBody_GetState(w, ids.bodies[i], &state);
            f.bodies.push_back(state);
        }
        f.bodyReports = ids.bodyReports;
        for (size_t i = 0; i < ids.materials.size(); ++i) index(f.materialOfIndex, ids.materials[i].index1, i);
        for (size_t i = 0; i < ids.colliders.size(); ++i) f.colliders.push_back(live.placementOf(i));
        for (const thawPathId id : ids.paths) {
            thawPathState state{};
            thawPath_GetState(w, id, &state);
            f.paths.push_back(state);
        }
        for (const thawShapeId id : ids.shapes) {
            thawShapeState state{};
            thawShape_GetState(w, id, &state);
            f.shapes.push_back(state);
        }
        thawWorld_GetCounters(w, &f.counters), thawWorld_GetPlan(w, &f.plan), thawWorld_GetLedger(w, &f.ledger);
        f.time = f.counters.time;
    }

    void send() {
        show(out.frames_.writing());
        out.frames_.send();
        changed = false;
    }

    /// Seconds until there is something to do; negative: until there are other orders.
    double work() {
        if (out.orders_.take()) {
            const bool was = orders.playing;
            const Orders& next = out.orders_.reading();
            changed = changed || next.particles != orders.particles || next.featureSizes != orders.featureSizes ||
                      next.splats != orders.splats;
            orders = next;
            if (orders.resets != resets) {
                resets = orders.resets;
                // Another scene starts anew in any case.
                if (orders.revision != revision)
                    revision = orders.revision, build();
                else
                    rewind();
            } else if (orders.revision != revision) {
                follow();
            }
            if (orders.seeks != seeks) seeks = orders.seeks, seek(orders.seekTo);
            if (orders.playing && !was) due = now();
        }
        if (goal >= 0) {
            if (frame < goal) replay();
            if (frame >= goal) goal = -1, changed = true;
        } else if (steps != orders.steps) {
            ++steps, step();
        } else if (orders.playing && live.world()) {
            const double wait = due - now();
            if (wait <= 0) {
                step();
                // What could not be kept up with is not made up for.
                due = std::max(due + 1 / (60.0 * double(std::clamp(orders.speed, 0.01f, 1.0f))), now());
            }
        }
        if (changed && out.frames_.taken()) send();
        if (goal >= 0 || steps != orders.steps) return 0;
        if (orders.playing && live.world()) return std::max(0.0, due - now());
        return changed ? 0.002 : -1;
    }

    void run() {
        while (!out.quit_.load()) {
            const uint32_t seen = out.wake_.load();
            const double wait = work();
            if (wait < 0)
                out.wake_.wait(seen);
            else if (wait > 0)
                std::this_thread::sleep_for(std::chrono::duration<double>(std::min(wait, 0.016)));
        }
    }
};

Simulation::Simulation(int threads) : worker_(std::make_unique<Worker>(*this, threads)) {
    thread_ = std::thread([this] { worker_->run(); });
}

Simulation::~Simulation() {
    quit_ = true;
    ++wake_;
    wake_.notify_one();
    thread_.join();
}

void Simulation::send(const Orders& orders) {
    orders_.writing() = orders;
    orders_.send();
    ++wake_;
    wake_.notify_one();
}

} // namespace thaw::editor
