// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/changes.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <initializer_list>
#include <string>

namespace thaw::editor {

namespace {

using nlohmann::json;

struct Item {
    std::string name;
    json content; // without names of its own and of others
};

std::vector<Item> itemsOf(const json& scene, const char* list, std::initializer_list<const char*> without) {
    std::vector<Item> out;
    const auto found = scene.find(list);
    if (found == scene.end()) return out;
    for (const json& each : *found) {
        Item& item = out.emplace_back(Item{each.value("name", std::string()), each});
        item.content.erase("name");
        for (const char* key : without) item.content.erase(key);
        if (const auto parts = item.content.find("parts"); parts != item.content.end())
            for (json& part : *parts) part.erase("material");
    }
    return out;
}

/// Index before of each item after, -1 for new ones.
std::vector<int> matched(const std::vector<Item>& before, const std::vector<Item>& after) {
    const auto same = [](const Item& a, const Item& b) { return a.name == b.name && a.content == b.content; };
    const size_t n = before.size(), m = after.size(), least = std::min(n, m);
    size_t first = 0, last = 0;
    while (first < least && same(before[first], after[first])) ++first;
    while (last < least - first && same(before[n - 1 - last], after[m - 1 - last])) ++last;
    std::vector<int> out(m, -1);
    for (size_t i = 0; i < first; ++i) out[i] = int(i);
    for (size_t i = 0; i < last; ++i) out[m - 1 - i] = int(n - 1 - i);
    if (n == m) {
        for (size_t i = first; i < m - last; ++i) out[i] = int(i);
        return out;
    }
    std::vector<bool> used(n, false);
    for (size_t i = first; i < m - last; ++i)
        for (size_t k = first; k < n - last && out[i] < 0; ++k)
            if (!used[k] && before[k].name == after[i].name) out[i] = int(k), used[k] = true;
    return out;
}

bool sameKeys(const json& a, const json& b, std::initializer_list<const char*> keys) {
    return std::all_of(keys.begin(), keys.end(), [&](const char* key) {
        const auto x = a.find(key), y = b.find(key);
        return x == a.end() ? y == b.end() : y != b.end() && *x == *y;
    });
}

json without(json content, std::initializer_list<const char*> keys) {
    for (const char* key : keys) content.erase(key);
    return content;
}

constexpr std::initializer_list<const char*> kPlace{"position", "rotation"},
    kSurface{"adhesive", "occluder", "slipLength", "friction"}, kHeat{"temperature", "contactConductance"},
    kLooks{"visible", "color"};

std::vector<Kept> keptOf(const std::vector<Item>& before, const std::vector<Item>& after) {
    std::vector<Kept> out;
    for (const int was : matched(before, after)) {
        const size_t i = out.size();
        out.push_back({was, was >= 0 && before[size_t(was)].content != after[i].content});
    }
    return out;
}

bool lost(const std::vector<Item>& before, size_t kept) { return before.size() != kept; }

} // namespace

Changes changesBetween(const scene::Scene& before, const scene::Scene& after) {
    const json a = json::parse(scene::writeScene(before)), b = json::parse(scene::writeScene(after));
    Changes out;
    out.capacity = !sameKeys(a["world"], b["world"], {"particleSpacing", "maxParticles"});
    out.world = a["world"] != b["world"];

    const auto materials = std::pair{itemsOf(a, "materials", {"preset"}), itemsOf(b, "materials", {"preset"})};
    out.materials = keptOf(materials.first, materials.second);
    // A preset stands for all that the material does not say itself.
    for (size_t i = 0; i < out.materials.size(); ++i)
        if (const int was = out.materials[i].was; was >= 0)
            out.materials[i].changed |= before.materials[size_t(was)].preset != after.materials[i].preset;
    const auto sameMaterial = [&](int was, int is) { return out.materials[size_t(is)].was == was; };

    const auto bodies = std::pair{itemsOf(a, "bodies", {"material"}), itemsOf(b, "bodies", {"material"})};
    for (const int was : matched(bodies.first, bodies.second)) {
        const size_t i = out.bodies.size();
        KeptBody& kept = out.bodies.emplace_back();
        kept.was = was;
        if (was < 0) continue;
        const scene::Body &old = before.bodies[size_t(was)], &now = after.bodies[i];
        const json &x = bodies.first[size_t(was)].content, &y = bodies.second[i].content;
        kept.changed = without(x, {"paint"}) != without(y, {"paint"}) || !sameMaterial(old.material, now.material);
        for (size_t k = 0; k < now.parts.size() && !kept.changed; ++k)
            kept.changed = !sameMaterial(old.parts[k].material, now.parts[k].material);
        const json had = x.value("paint", json::array()), has = y.value("paint", json::array());
        if (had.size() > has.size() || !std::equal(had.begin(), had.end(), has.begin())) kept.changed = true;
        kept.paintFrom = int(had.size());
        out.any_ |= had.size() != has.size();
    }

    const auto colliders = std::pair{itemsOf(a, "colliders", {}), itemsOf(b, "colliders", {})};
    for (const int was : matched(colliders.first, colliders.second)) {
        KeptCollider& kept = out.colliders.emplace_back();
        kept.was = was;
        if (was < 0) continue;
        const json &x = colliders.first[size_t(was)].content, &y = colliders.second[out.colliders.size() - 1].content;
        kept.moved = !sameKeys(x, y, kPlace), kept.surface = !sameKeys(x, y, kSurface);
        kept.heat = !sameKeys(x, y, kHeat);
        const auto form = [](const json& c) {
            return without(without(without(without(c, kPlace), kSurface), kHeat), kLooks);
        };
        kept.changed = form(x) != form(y);
        out.any_ |= kept.moved || kept.surface || kept.heat;
    }
    const auto sameCollider = [&](int was, int is) { // one that stays what it is
        return is < 0 ? was < 0 : out.colliders[size_t(is)].was == was && !out.colliders[size_t(is)].changed;
    };

    const auto sources = std::pair{itemsOf(a, "heatSources", {"visual"}), itemsOf(b, "heatSources", {"visual"})};
    out.heatSources = keptOf(sources.first, sources.second);
    const auto paths = std::pair{itemsOf(a, "paths", {"collider"}), itemsOf(b, "paths", {"collider"})};
    out.paths = keptOf(paths.first, paths.second);
    for (size_t i = 0; i < out.paths.size(); ++i)
        if (const int was = out.paths[i].was; was >= 0)
            out.paths[i].changed |= !sameCollider(before.paths[size_t(was)].collider, after.paths[i].collider);
    const auto shapes = std::pair{itemsOf(a, "shapes", {"collider"}), itemsOf(b, "shapes", {"collider"})};
    out.shapes = keptOf(shapes.first, shapes.second);
    for (size_t i = 0; i < out.shapes.size(); ++i)
        if (const int was = out.shapes[i].was; was >= 0)
            out.shapes[i].changed |= !sameCollider(before.shapes[size_t(was)].collider, after.shapes[i].collider);

    out.any_ |= out.world;
    const auto look = [&](const auto& list, const std::vector<Item>& had) {
        for (const Kept& kept : list) out.any_ |= kept.changed || kept.was < 0;
        out.any_ |= lost(had, list.size());
    };
    look(out.materials, materials.first), look(out.bodies, bodies.first), look(out.colliders, colliders.first);
    look(out.heatSources, sources.first), look(out.paths, paths.first), look(out.shapes, shapes.first);
    return out;
}

} // namespace thaw::editor
