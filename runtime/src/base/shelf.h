// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace thaw {

// Forms (with a `key` of what they were made from) that images of a world name instead of holding: those in use, and
// those that an image may still name.
template <class Form> class Shelf {
public:
    std::shared_ptr<const Form> find(uint64_t key) const {
        for (const Entry& e : entries_)
            if (e.form->key == key) return e.form;
        return nullptr;
    }
    // saves: images that were made so far.
    void add(std::shared_ptr<const Form> form, uint64_t saves) {
        if (!find(form->key)) entries_.push_back({std::move(form), saves});
    }
    // After what is in use may have changed: lets go of what is not and was never in an image, or in none from number
    // `oldest` on.
    template <class F> void prune(uint64_t saves, uint64_t oldest, F&& inUse) {
        std::erase_if(entries_, [&](Entry& e) {
            const bool used = inUse(*e.form);
            if (used && !e.used) e.since = saves;
            if (e.used && !used && saves > e.since) e.last = saves;
            e.used = used;
            return !used && (e.last == 0 || e.last < oldest);
        });
    }

private:
    struct Entry {
        std::shared_ptr<const Form> form;
        uint64_t since;    // images that there were when it came into use
        uint64_t last = 0; // image that may name it, of those that were made before it went out of use; 0: none
        bool used = true;
    };
    std::vector<Entry> entries_;
};

} // namespace thaw
