// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Images of a world: a head, forms where they are asked for, the state. See docs/snapshot.md.
#include "world/world.h"

#include <algorithm>
#include <cstring>

namespace thaw {
namespace {

constexpr uint32_t kFormat = 1; // to be raised when what follows the head has another meaning

struct Head {
    char magic[8];
    uint32_t format, full;
    uint64_t layout;   // of the fields and the parts
    uint64_t size;     // bytes in all
    uint64_t checksum; // of all that follows the head, and of the head with 0 in this place
    uint64_t save;     // which image of its world this is
    float spacing;     // m
    uint32_t particles;
};
constexpr char kMagic[8] = {'t', 'h', 'a', 'w', 's', 'n', 'a', 'p'};

uint64_t layoutOf() {
    uint64_t h = kFormat;
    const auto text = [&](const char* s) {
        for (; *s; ++s) h = hashCombine(h, static_cast<uint64_t>(*s));
    };
#define X(type, name) text(#type " " #name), h = hashCombine(h, sizeof(type));
    THAW_PARTICLE_FIELDS(X)
#undef X
    for (const size_t size : {sizeof(thawMaterialDef), sizeof(thawWork), sizeof(thawCounters), sizeof(RigidPiece),
                              sizeof(HeatSource), sizeof(Shape), sizeof(Path), sizeof(Head)})
        h = hashCombine(h, size);
    return hashCombine(h, 0x0102030405060708ULL >> 8 * (*reinterpret_cast<const uint8_t*>(&kFormat) & 1)); // byte order
}

uint64_t sumOf(const void* image, size_t size) {
    Head head;
    std::memcpy(&head, image, sizeof head);
    head.checksum = 0;
    const unsigned char* rest = static_cast<const unsigned char*>(image) + sizeof head;
    return hashCombine(checksum(&head, sizeof head), checksum(rest, size - sizeof head));
}

} // namespace

void World::pruneForms() {
    const uint64_t saves = saves_;
    colliderForms_.prune(saves, oldestSave_, [&](const ColliderForm& f) {
        return heat_.names(f.key) || std::any_of(colliders.begin(), colliders.end(), [&](const Collider& c) {
                   return c.alive && c.mesh && c.form == f.key;
               });
    });
    shapeForms_.prune(saves, oldestSave_, [&](const ShapeForm& f) {
        const std::vector<Shape>& all = control_.shapes();
        return std::any_of(all.begin(), all.end(),
                           [&](const Shape& s) { return s.alive && s.made && s.made->key == f.key; });
    });
}

// Those in use, for a world that does not have them.
void World::formState(StateIo& io, bool full) {
    if (!full) return;
    if (io.restores()) {
        io.look(stage_.formsEnd - io.at());
        return;
    }
    const auto forms = [&](auto& shelf, size_t most, auto&& used) {
        using Form = std::remove_cvref_t<decltype(*used()[0])>;
        const auto all = io.reads() ? decltype(used()){} : used();
        const size_t n = io.count(all.size(), most);
        for (size_t k = 0; k < n && io.good(); ++k) {
            if (!io.reads()) {
                const_cast<Form&>(*all[k]).state(io); // which only looks
                continue;
            }
            // The first time they are there for good: a form that nobody uses changes nothing.
            const auto form = std::make_shared<Form>();
            StateIo::Trial trial(io);
            form->state(io);
            if (io.good()) shelf.add(form, saves_);
        }
    };
    forms(colliderForms_, io.limits.colliders, [&] {
        std::vector<std::shared_ptr<const ColliderForm>> used;
        for (const Collider& c : colliders)
            if (c.alive && c.mesh) used.push_back(colliderForms_.find(c.form));
        return used;
    });
    forms(shapeForms_, io.limits.shapes, [&] {
        std::vector<std::shared_ptr<const ShapeForm>> used;
        for (const Shape& s : control_.shapes())
            if (s.alive) used.push_back(s.made);
        return used;
    });
    if (io.checks()) stage_.formsEnd = io.at();
}

size_t World::snapshotSize(bool full) const {
    StateIo io(static_cast<void*>(nullptr), ~size_t{0});
    io.limits = limits();
    io.room(sizeof(Head));
    World& self = const_cast<World&>(*this); // of which it is only told
    self.formState(io, full);
    self.state(io);
    return io.at();
}

size_t World::save(void* buffer, size_t capacity, bool full) const {
    Head head{};
    if (capacity < sizeof head) return 0;
    StateIo io(buffer, capacity);
    io.limits = limits();
    io.room(sizeof head);
    World& self = const_cast<World&>(*this); // of which it is only told
    self.formState(io, full);
    self.state(io);
    if (!io.good()) return 0;
    std::memcpy(head.magic, kMagic, sizeof kMagic);
    head.format = kFormat, head.full = full, head.layout = layoutOf(), head.size = io.at();
    head.save = ++saves_, head.spacing = def.particleSpacing, head.particles = static_cast<uint32_t>(particles.count);
    std::memcpy(buffer, &head, sizeof head);
    head.checksum = sumOf(buffer, io.at());
    std::memcpy(buffer, &head, sizeof head);
    return io.at();
}

thawResult World::restore(const void* image, size_t size, std::string& message) {
    Head head;
    const auto refuse = [&](thawResult result, const std::string& why) {
        message = "image: " + why;
        return result;
    };
    if (size < sizeof head) return refuse(thawResult_badImage, "it ends too early");
    std::memcpy(&head, image, sizeof head);
    if (std::memcmp(head.magic, kMagic, sizeof kMagic) != 0)
        return refuse(thawResult_badImage, "is none of this library");
    if (head.format != kFormat || head.layout != layoutOf())
        return refuse(thawResult_badImage, "is of another version of the library");
    if (head.size != size) return refuse(thawResult_badImage, "it has another length than it says");
    if (head.checksum != sumOf(image, size)) return refuse(thawResult_badImage, "it is damaged");
    if (head.spacing != def.particleSpacing)
        return refuse(thawResult_badImage, "particleSpacing: it has " + std::to_string(head.spacing) +
                                               " m, the world " + std::to_string(def.particleSpacing));
    if (head.particles > static_cast<uint32_t>(def.maxParticles))
        return refuse(thawResult_capacity, "maxParticles: it has " + std::to_string(head.particles) + " particles");
    for (const bool check : {true, false}) {
        StateIo io(image, size, check);
        io.limits = check ? limits() : imageLimits_;
        io.look(sizeof head);
        formState(io, head.full);
        state(io);
        if (check && io.good() && io.at() != size) io.fail("it is longer than it should be");
        if (!io.good()) {
            pruneForms();
            return refuse(check ? thawResult_badImage : thawResult_internal, io.why());
        }
        if (check) imageLimits_ = io.limits;
    }
    listsGone_ = true;
    mouldOn_.assign(control_.shapes().size(), 0);
    spots_.reserve(control_.paths().size());
    control_.expectColliders(colliders.size());
    pruneForms();
    return thawResult_ok;
}

bool World::forgetSnapshots(const void* oldest, size_t size, std::string& message) {
    Head head{};
    head.save = saves_ + 1;
    if (oldest) {
        if (size >= sizeof head) std::memcpy(&head, oldest, sizeof head);
        if (size < sizeof head || std::memcmp(head.magic, kMagic, sizeof kMagic) != 0) {
            message = "oldest: is no image";
            return false;
        }
    }
    oldestSave_ = std::max(oldestSave_, head.save);
    pruneForms();
    return true;
}

// The lists of the rows that were read: those that the world had when they were saved, unless the step makes new ones
// anyway.
void World::ensureLists() {
    if (!listsGone_) return;
    listsGone_ = false;
    if (listsStale_) return;
    const uint64_t version = surfaceVersion_;
    refreshNeighbors();
    surfaceVersion_ = version;
}

} // namespace thaw
