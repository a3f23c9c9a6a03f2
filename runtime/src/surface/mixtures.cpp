// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/mixtures.h"

#include <algorithm>
#include <cstring>

namespace thaw {
namespace {

constexpr int kTogether = 16; // spans

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

// Of a vertex and its neighbours.
SurfaceMesh::Mixture meanOf(const MeshCorners& mesh, const SurfaceMesh::Mixture* from, uint32_t v) {
    const SurfaceMesh::Mixture own = from[v];
    bool even = own.share[0] == 255;
    for (uint32_t c = mesh.begins[v]; c < mesh.begins[v + 1]; ++c) even = even && same(from[mesh.next[c]], own);
    if (even) return own;
    Kinds kinds; // of whole numbers, so that their order does not count
    const auto add = [&](const SurfaceMesh::Mixture& m) {
        for (int k = 0; k < 4 && m.share[k] > 0; ++k) kinds.add(m.material[k], m.share[k]);
    };
    add(own);
    for (uint32_t c = mesh.begins[v]; c < mesh.begins[v + 1]; ++c) add(from[mesh.next[c]]);
    SurfaceMesh::Mixture mean;
    kinds.mix(mean);
    return mean;
}

} // namespace

void mixOf(const Origins& origins, const uint8_t* materials, SurfaceMesh::Mixture& out) {
    Kinds kinds;
    for (int k = 0; k < Origins::kMost; ++k) kinds.add(materials[origins.row[k]], origins.share[k]);
    kinds.mix(out);
}

void MixtureBlender::blend(const MeshCorners& mesh, const Array<Mixture>& mixtures, const Array<MeshSpan>& spans,
                           Tasks& tasks) {
    const Mixture* from = mixtures.data();
    for (Array<Mixture>& pass : passes_) {
        pass.resizeRaw(mixtures.size());
        Mixture* to = pass.data();
        tasks.forBlocks(int(spans.size()), kTogether, [&](int begin, int end, int, int) {
            for (int s = begin; s < end; ++s)
                for (uint32_t v = spans[s].vertexBegin; v < spans[s].vertexEnd; ++v) to[v] = meanOf(mesh, from, v);
        });
        from = to;
    }
}

} // namespace thaw
