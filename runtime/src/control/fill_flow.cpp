// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "control/fill_flow.h"

#include "base/math.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace thaw {
namespace {

constexpr float kCell = 2;           // spacings: about eight particles, so that their places are no noise
constexpr size_t kMostCells = 32768; // larger regions have larger cells
constexpr int kParts = 4;            // a cell is looked at so often along each axis
constexpr float kTime = 0.2f;        // s in which what is missing shall come
constexpr float kRest = 0.15f;       // of what a cell should have: as much more or less is none of our business
constexpr float kSettled = 0.03f;    // of all that there should be: when less is missing, nothing is led
constexpr float kOutside = 0.05f;    // how well melt is led through what it shall not fill
constexpr float kSolid = 0.02f, kWall = 1e-3f;
constexpr float kAround = 6; // spacings around the region that have cells
constexpr int kSweeps = 4;
constexpr float kOver = 1.7f;                          // over-relaxation
constexpr int kLayers = 64;                            // in which a mesh is filled
constexpr float kBelongs = 0.3f;                       // of a cell inside, which then belongs to the region
constexpr float kLeakFrom = 0.15f, kLeakUntil = 0.03f; // of what an island should have, above that
constexpr double kOpen = 0.95;                         // of its room: what was full takes up more when it is emptier
constexpr float kStay = 0.4f, kGoOn = 0.9f; // of its target: from which a cell passes melt on, and passes on all
constexpr float kCovered = 0.8f;            // spacings of depth that count as covered
constexpr float kFilled = 0.85f;
constexpr float kLeast = 1.3f; // spacings of depth: what is less does not stay whole

} // namespace

void FillFlow::make(const Region& region, float reach, float spacing) {
    flat_ = region.flat();
    Box box = region.bounds();
    const Vec3 extent = box.upper - box.lower;
    const float around = std::min(reach, kAround * spacing);
    const auto room = [&](float length, float cell) {
        return static_cast<int>(std::ceil((length + 2 * around) / cell)) + 3;
    };
    for (cell_ = kCell * spacing;; cell_ *= 1.1f) {
        nx_ = room(extent.x, cell_), ny_ = room(extent.y, cell_), nz_ = flat_ ? 1 : room(extent.z, cell_);
        if (static_cast<double>(nx_) * ny_ * nz_ <= static_cast<double>(kMostCells)) break;
    }
    unit_ = flat_ ? cell_ * cell_ : cell_ * cell_ * cell_;
    const Vec3 middle = 0.5f * (box.lower + box.upper);
    const auto start = [&](float m, int n) { return m - 0.5f * static_cast<float>(n - 1) * cell_; };
    origin_ = {start(middle.x, nx_), start(middle.y, ny_), flat_ ? 0 : start(middle.z, nz_)};
    const size_t n = at(0, 0, nz_);
    share_.assign(n, 0), liquid_.assign(n, 0), set_.assign(n, 0), solid_.assign(n, 0), target_.assign(n, 0),
        potential_.assign(n, 0);
    conduct_.assign(n, 0), lack_.assign(n, 0), face_.assign(n, {}), velocity_.assign(n, {}), blocked_.assign(n, 0),
        layer_.assign(n, 0);

    // Spread over cells as melt is. Where the parts miss it, it is thinner than they are: then by how near it is.
    const float part = cell_ / kParts, volume = unit_ / (kParts * kParts * (flat_ ? 1 : kParts));
    const auto spread = [&](float blur) {
        for (int z = 0; z < (flat_ ? 1 : kParts * nz_); ++z)
            for (int y = 0; y < kParts * ny_; ++y)
                for (int x = 0; x < kParts * nx_; ++x) {
                    const auto place = [&](float from, int k) {
                        return from + (static_cast<float>(k) + 0.5f) * part - 0.5f * cell_;
                    };
                    const Vec3 p{place(origin_.x, x), place(origin_.y, y), flat_ ? 0 : place(origin_.z, z)};
                    Vec3 outward;
                    const float d = region.distance(p, outward);
                    if (d < blur) add(share_, p, blur > 0 ? volume * std::min(1.0f, 1 - d / blur) : volume, nullptr);
                }
        double all = 0;
        for (const float s : share_) all += static_cast<double>(s);
        return static_cast<float>(all) * unit_;
    };
    if (spread(0) < 0.5f * region.size()) {
        std::fill(share_.begin(), share_.end(), 0.0f);
        if (const float all = spread(part); all > 0)
            for (float& s : share_) s *= region.size() / all;
    }
    findIslands();
}

void FillFlow::findIslands() {
    constexpr uint16_t kNone = 0xffff;
    island_.assign(cells(), kNone), islands_.clear();
    std::vector<size_t> queue, next;
    const auto spread = [&](size_t k, uint16_t label, bool inside) {
        const size_t nx = static_cast<size_t>(nx_), ny = static_cast<size_t>(ny_), nz = static_cast<size_t>(nz_);
        const size_t x = k % nx, y = k / nx % ny, z = k / (nx * ny);
        const auto offer = [&](bool there, size_t j) {
            if (there && island_[j] == kNone && (!inside || share_[j] > kBelongs))
                island_[j] = label, queue.push_back(j);
        };
        offer(x > 0, k - 1), offer(x + 1 < nx, k + 1), offer(y > 0, k - nx), offer(y + 1 < ny, k + nx);
        offer(z > 0, k - nx * ny), offer(z + 1 < nz, k + nx * ny);
    };
    for (size_t k = 0; k < cells(); ++k) {
        if (!(share_[k] > kBelongs) || island_[k] != kNone || islands_.size() + 1 >= kNone) continue;
        const uint16_t label = static_cast<uint16_t>(islands_.size());
        islands_.push_back({});
        queue.assign(1, k), island_[k] = label;
        while (!queue.empty()) {
            const size_t j = queue.back();
            queue.pop_back();
            spread(j, label, true);
        }
    }
    if (islands_.size() < 2) {
        island_.clear(), islands_.clear();
        return;
    }
    // All else belongs to the one that gets there first.
    for (size_t k = 0; k < cells(); ++k)
        if (island_[k] != kNone) next.push_back(k);
    while (!next.empty()) {
        queue.clear();
        for (const size_t k : next) spread(k, island_[k], false);
        next.swap(queue);
    }
}

void FillFlow::findLeaks() {
    for (Island& i : islands_) i.has = i.lacks = 0;
    float lack = 0;
    for (size_t k = 0; k < cells(); ++k)
        islands_[island_[k]].has += liquid_[k], islands_[island_[k]].lacks += target_[k];
    for (Island& i : islands_) i.lacks -= i.has, lack = std::max(lack, i.lacks / (i.has + i.lacks + 1e-20f));
    for (Island& i : islands_) {
        const float limit = i.leaks ? kLeakUntil : kLeakFrom;
        i.leaks = -i.lacks > limit * (i.has + i.lacks) && lack > limit;
    }
}

bool FillFlow::leak() const {
    return std::any_of(islands_.begin(), islands_.end(), [](const Island& i) { return i.leaks; });
}

bool FillFlow::leaks(Vec3 p) const {
    if (islands_.empty()) return false;
    const Vec3 c = (1 / cell_) * (p - origin_);
    const auto index = [](float v, int n) { return std::clamp(static_cast<int>(std::lround(v)), 0, n - 1); };
    return islands_[island_[at(index(c.x, nx_), index(c.y, ny_), flat_ ? 0 : index(c.z, nz_))]].leaks;
}

Vec3 FillFlow::middleOf(size_t cell) const {
    const size_t nx = static_cast<size_t>(nx_), ny = static_cast<size_t>(ny_);
    return origin_ + cell_ * Vec3{static_cast<float>(cell % nx), static_cast<float>(cell / nx % ny),
                                  static_cast<float>(cell / (nx * ny))};
}

bool FillFlow::locate(Vec3 p, Spot& spot) const {
    const float inverse = 1 / cell_;
    const Vec3 c = inverse * (p - origin_);
    const int x = static_cast<int>(std::floor(c.x)), y = static_cast<int>(std::floor(c.y)),
              z = flat_ ? 0 : static_cast<int>(std::floor(c.z));
    if (!(x >= 0 && y >= 0 && z >= 0 && x + 1 < nx_ && y + 1 < ny_ && (flat_ || z + 1 < nz_))) return false;
    spot = {at(x, y, z), c.x - static_cast<float>(x), c.y - static_cast<float>(y),
            flat_ ? 0 : c.z - static_cast<float>(z)};
    return true;
}

void FillFlow::add(std::vector<float>& to, Vec3 p, float volume, double* beyond) {
    Spot spot;
    if (!locate(p, spot)) {
        if (beyond) *beyond += static_cast<double>(volume);
        return;
    }
    const float fx = spot.x, fy = spot.y, v = volume / unit_;
    const size_t row = static_cast<size_t>(nx_);
    const auto layer = [&](size_t k, float w) {
        to[k] += w * (1 - fx) * (1 - fy), to[k + 1] += w * fx * (1 - fy);
        to[k + row] += w * (1 - fx) * fy, to[k + row + 1] += w * fx * fy;
    };
    if (flat_) return layer(spot.first, v);
    layer(spot.first, v * (1 - spot.z)), layer(spot.first + at(0, 0, 1), v * spot.z);
}

void FillFlow::clear() {
    std::fill(liquid_.begin(), liquid_.end(), 0.0f), std::fill(set_.begin(), set_.end(), 0.0f);
    std::fill(solid_.begin(), solid_.end(), 0.0f);
    beyond_ = 0;
}

// How much more goes in, of what there is room for in all.
void FillFlow::limit(double most, double melt) {
    full_ = most <= melt, open_ = !full_ && (open_ || kOpen * most > melt);
    room_ = unit_ * static_cast<float>(std::max(0.0, most - melt));
}

void FillFlow::setTargets(Vec3 down, float thickness, float least) {
    double melt = beyond_ / static_cast<double>(unit_);
    for (const float l : liquid_) melt += static_cast<double>(l);
    melts_ = melt > 0;
    const size_t n = cells();
    level_ = 0;
    const auto room = [&](size_t k, float depth) {
        return blocked_[k] ? 0.0f : std::max(0.0f, depth * share_[k] - set_[k] - solid_[k]);
    };
    if (flat_) {
        const auto held = [&](float depth) {
            double sum = 0;
            for (size_t k = 0; k < n; ++k) sum += static_cast<double>(room(k, depth));
            return sum;
        };
        double area = 0, sum = melt;
        for (const float s : share_) area += static_cast<double>(s);
        for (size_t k = 0; k < n; ++k) sum += static_cast<double>(set_[k] + solid_[k]);
        float low = 0, high = thickness > 0 ? thickness : static_cast<float>(2 * sum / std::max(area, 1e-9));
        if (thickness == 0) {
            full_ = false, open_ = true, room_ = INFINITY;
        } else {
            limit(held(thickness), melt);
        }
        for (int k = 0; k < 16 && !full_; ++k) (held(0.5f * (low + high)) < melt ? low : high) = 0.5f * (low + high);
        sum = 0;
        for (size_t k = 0; k < n; ++k) sum += static_cast<double>(set_[k]);
        level_ = melt > 0 ? high : static_cast<float>(sum / std::max(area, 1e-9));
        // Less than covers it fills it from where it comes.
        const float depth = std::max(level_, least);
        for (size_t k = 0; k < n; ++k) target_[k] = room(k, depth);
        return;
    }
    // From the bottom up.
    if (down.x != down_.x || down.y != down_.y || down.z != down_.z) findLayers(down);
    double layers[kLayers] = {}, all = 0;
    for (size_t k = 0; k < n; ++k)
        if (share_[k] > 0) layers[layer_[k]] += static_cast<double>(room(k, 1));
    for (const double l : layers) all += l;
    limit(all, melt);
    float filled[kLayers];
    for (int l = 0; l < kLayers; ++l) {
        const double take = std::min(melt, layers[l]);
        filled[l] = layers[l] > 0 ? static_cast<float>(take / layers[l]) : 1;
        melt -= take;
    }
    for (size_t k = 0; k < n; ++k) target_[k] = share_[k] > 0 ? filled[layer_[k]] * room(k, 1) : 0;
}

void FillFlow::findLayers(Vec3 down) {
    down_ = down;
    float low = INFINITY, high = -INFINITY;
    const auto height = [&](size_t k) { return -dot(middleOf(k), down); };
    for (size_t k = 0; k < cells(); ++k)
        if (share_[k] > 0) low = std::min(low, height(k)), high = std::max(high, height(k));
    const float scale = high > low ? kLayers / (high - low) : 0;
    for (size_t k = 0; k < cells(); ++k)
        if (share_[k] > 0)
            layer_[k] = static_cast<uint8_t>(std::clamp(static_cast<int>((height(k) - low) * scale), 0, kLayers - 1));
}

// Conductances of the faces to the next cells, harmonic, and over-relaxed one over their sums.
void FillFlow::joinCells() {
    const size_t row = static_cast<size_t>(nx_), layer = flat_ ? 0 : at(0, 0, 1), n = cells();
    const auto face = [&](size_t k, size_t j) {
        return j < n ? conduct_[k] * conduct_[j] / (conduct_[k] + conduct_[j]) : 0.0f;
    };
    for (size_t k = 0; k < n; ++k) face_[k] = {face(k, k + 1), face(k, k + row), layer ? face(k, k + layer) : 0.0f, 0};
    forInner([&](size_t k) {
        float sum = face_[k].x + face_[k - 1].x + face_[k].y + face_[k - row].y;
        if (layer) sum += face_[k].z + face_[k - layer].z;
        face_[k].w = kOver / sum;
    });
}

// Sweeps of successive over-relaxation, warm.
void FillFlow::relax() {
    const size_t row = static_cast<size_t>(nx_), layer = flat_ ? 0 : at(0, 0, 1);
    // Between islands every bit counts.
    const float rest = leak() ? 0 : kRest * largest_, scale = 0.5f * cell_ * cell_ / kTime;
    float all = 0, whole = 0, strongest = 0;
    forInner([&](size_t k) {
        // Outside, melt is drawn by what is missing inside; it does not push itself apart.
        float lack = share_[k] > 0 ? target_[k] - liquid_[k] : 0;
        lack = lack > rest ? lack - rest : lack < -rest ? lack + rest : 0;
        lack_[k] = scale * lack;
        all += std::abs(lack_[k]), whole += target_[k];
        strongest = std::max(strongest, std::abs(potential_[k]));
    });
    if (all < (leak() ? 0 : kSettled) * scale * whole) {
        if (strongest > 0) std::fill(potential_.begin(), potential_.end(), 0.0f);
        return;
    }
    // In two colours: no cell waits for the one before it.
    const int last = flat_ ? 1 : nz_ - 1;
    for (int half = 0; half < 2 * kSweeps; ++half)
        for (int z = flat_ ? 0 : 1; z < last; ++z)
            for (int y = 1; y < ny_ - 1; ++y)
                for (size_t k = at(1 + ((y + z + half) & 1), y, z), end = at(nx_ - 1, y, z); k < end; k += 2) {
                    const Vec4 &f = face_[k], &x = face_[k - 1], &v = face_[k - row];
                    float sum = f.x * potential_[k + 1] + x.x * potential_[k - 1] + f.y * potential_[k + row] +
                                v.y * potential_[k - row] - lack_[k];
                    if (layer) sum += f.z * potential_[k + layer] + face_[k - layer].z * potential_[k - layer];
                    potential_[k] = (1 - kOver) * potential_[k] + f.w * sum;
                }
}

void FillFlow::setVelocities(float least) {
    const size_t row = static_cast<size_t>(nx_), layer = flat_ ? 0 : at(0, 0, 1);
    forInner([&](size_t k) {
        const auto flux = [&](size_t step, float ahead, float behind) {
            return ahead * (potential_[k + step] - potential_[k]) + behind * (potential_[k] - potential_[k - step]);
        };
        const Vec3 f{flux(1, face_[k].x, face_[k - 1].x), flux(row, face_[k].y, face_[k - row].y),
                     layer ? flux(layer, face_[k].z, face_[k - layer].z) : 0};
        // What is not yet full fills before melt goes on through it: else it arrives in drops all over.
        const float full = share_[k] > 0 && target_[k] > 0 ? liquid_[k] / target_[k] : 1;
        const float on = std::clamp((full - kStay) / (kGoOn - kStay), 0.0f, 1.0f);
        velocity_[k] = (-on / (cell_ * std::max(liquid_[k], least))) * f;
    });
}

void FillFlow::solve(Vec3 down, float thickness, float spacing) {
    setTargets(down, thickness, kLeast * spacing);
    double covered = 0, whole = 0;
    largest_ = 0;
    // Layers of particles are no even depth: a cell that has nearly all of its share counts as filled.
    const float enough = !flat_ ? 1 : thickness > 0 ? kFilled * thickness : kCovered * spacing;
    for (size_t k = 0; k < cells(); ++k) {
        const bool solid = set_[k] + solid_[k] > (flat_ ? std::max(level_, spacing) : 0.6f);
        const float conducts = blocked_[k] ? kWall : solid ? kSolid : share_[k] > kBelongs ? 1 : kOutside;
        facesStale_ |= conducts != conduct_[k];
        conduct_[k] = conducts;
        largest_ = std::max(largest_, target_[k]);
        if (blocked_[k]) continue;
        const float most = enough * share_[k];
        covered += static_cast<double>(std::min(most, liquid_[k] + set_[k])), whole += static_cast<double>(most);
    }
    fill_ = whole > 0 ? static_cast<float>(covered / whole) : 0;
    if (!(largest_ > 0) || !melts_) return std::fill(velocity_.begin(), velocity_.end(), Vec3{});
    if (facesStale_) joinCells(), facesStale_ = false;
    if (!islands_.empty()) findLeaks();
    relax();
    setVelocities(0.3f * (flat_ ? std::max(level_, spacing) : 1));
}

Vec3 FillFlow::velocity(Vec3 p) const {
    Spot spot;
    if (!locate(p, spot)) return {};
    const float fx = spot.x, fy = spot.y;
    const size_t row = static_cast<size_t>(nx_);
    const auto layer = [&](size_t k) {
        return (1 - fy) * ((1 - fx) * velocity_[k] + fx * velocity_[k + 1]) +
               fy * ((1 - fx) * velocity_[k + row] + fx * velocity_[k + row + 1]);
    };
    if (flat_) return layer(spot.first);
    return (1 - spot.z) * layer(spot.first) + spot.z * layer(spot.first + at(0, 0, 1));
}

void FillFlow::state(StateIo& io) {
    io(room_, full_, open_, fill_, level_);
    for (Island& i : islands_) io(i.leaks);
    for (float& p : potential_) io(p);
    for (uint8_t& b : blocked_) io(b);
    // The rest follows from these when it is solved the next time.
    if (io.restores()) facesStale_ = true, down_ = {INFINITY, 0, 0};
}

void FillFlow::formState(StateIo& io) {
    io(flat_, nx_, ny_, nz_, cell_, unit_, origin_);
    io.block(share_, kMostCells), io.block(island_, kMostCells);
    size_t islands = io.count(islands_.size(), 0xffff);
    if (!io.restores()) return;
    const auto side = [](int n) { return n > 2 && n <= static_cast<int>(kMostCells); };
    if (!side(nx_) || !side(ny_) || !(flat_ ? nz_ == 1 : side(nz_)) || !(cell_ > 0) || !(unit_ > 0) ||
        static_cast<double>(nx_) * ny_ * nz_ != static_cast<double>(share_.size()))
        return io.fail("a flow of another size");
    if (!island_.empty() && island_.size() != share_.size()) return io.fail("islands of another size");
    for (const uint16_t i : island_)
        if (i >= islands) return io.fail("an island that there is not");
    islands_.assign(islands, {});
    const size_t n = share_.size();
    liquid_.assign(n, 0), set_.assign(n, 0), solid_.assign(n, 0), target_.assign(n, 0), potential_.assign(n, 0);
    conduct_.assign(n, 0), lack_.assign(n, 0), face_.assign(n, {}), velocity_.assign(n, {}), blocked_.assign(n, 0);
    layer_.assign(n, 0);
}

} // namespace thaw
