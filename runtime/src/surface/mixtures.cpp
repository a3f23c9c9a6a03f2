// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/mixtures.h"

#include <algorithm>
#include <cstring>

namespace thaw {
namespace {

constexpr int kTogether = 1024;

// Materials with their sums, a few of them.
struct Kinds {
    static constexpr int kMost = 16; // of more, those that come last are left out
    uint8_t material[kMost];
    float sum[kMost];
    int count = 0;

    void add(uint8_t which, float amount) {
        int n = 0;
        while (n < count && material[n] != which) ++n;
        if (n == kMost) return;
        if (n == count) material[count] = which, sum[count++] = 0;
        sum[n] += amount;
    }
    void mix(SurfaceMesh::Mixture& out) {
        out = {};
        const int used = std::min(count, 4);
        float all = 0;
        for (int k = 0; k < used; ++k) {
            for (int n = k + 1; n < count; ++n)
                if (sum[n] > sum[k] || (sum[n] == sum[k] && material[n] < material[k]))
                    std::swap(sum[n], sum[k]), std::swap(material[n], material[k]);
            all += sum[k];
        }
        int left = 255;
        for (int k = used - 1; k >= 0; --k) {
            // Rounded down, so that the first has no less than those that are as much.
            const int share = k == 0 ? left : std::min(left, int(255 * sum[k] / all));
            if (share > 0) out.material[k] = material[k], out.share[k] = uint8_t(share), left -= share;
        }
    }
};

bool same(const SurfaceMesh::Mixture& a, const SurfaceMesh::Mixture& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

} // namespace

void mixOf(const Origins& origins, const uint8_t* materials, SurfaceMesh::Mixture& out) {
    Kinds kinds;
    for (int k = 0; k < Origins::kMost; ++k) kinds.add(materials[origins.row[k]], origins.share[k]);
    kinds.mix(out);
}

void blendMixtures(const MeshCorners& mesh, Array<SurfaceMesh::Mixture>& mixtures, Array<SurfaceMesh::Mixture>& scratch,
                   int passes, Tasks& tasks) {
    const bool one = std::all_of(mixtures.begin(), mixtures.end(), [&](const SurfaceMesh::Mixture& m) {
        return m.share[0] == 255 && m.material[0] == mixtures[0].material[0];
    });
    if (one) return;
    scratch.resizeRaw(mixtures.size());
    for (int pass = 0; pass < passes; ++pass) {
        tasks.forBlocks(int(mixtures.size()), kTogether, [&](int begin, int end, int, int) {
            for (int v = begin; v < end; ++v) {
                const SurfaceMesh::Mixture& own = mixtures[v];
                bool even = own.share[0] == 255;
                for (uint32_t c = mesh.begins[v]; c < mesh.begins[v + 1]; ++c)
                    even = even && same(mixtures[mesh.next[c]], own);
                scratch[v] = own;
                if (even) continue;
                Kinds kinds; // of whole numbers, so that their order does not count
                const auto add = [&](const SurfaceMesh::Mixture& m) {
                    for (int k = 0; k < 4 && m.share[k] > 0; ++k) kinds.add(m.material[k], m.share[k]);
                };
                add(own);
                for (uint32_t c = mesh.begins[v]; c < mesh.begins[v + 1]; ++c) add(mixtures[mesh.next[c]]);
                kinds.mix(scratch[v]);
            }
        });
        mixtures.swap(scratch);
    }
}

} // namespace thaw
