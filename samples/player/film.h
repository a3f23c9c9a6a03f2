// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "pictures.h"

namespace thaw::player {

// Pictures at even steps of time, as numbered files or in one file that plays them.
struct Film {
    std::string folder;    // for frame_0000.png and so on; empty: no such files
    std::string animation; // a file of view::animationKind; empty: none
    int framesPerSecond = 30;
    double seconds = 0; // 0: what the scene says
    double hold = 1;    // s that the last frame of an animation stays
    PictureView view = PictureView::shaded;
    PictureSize size;
    int threads = 1;
    bool cut = false, quiet = false;
};

// What is wrong with a film's numbers and file names, before anything is read or made. Throws InputError.
void checkFilm(const Film& film);
// Runs the scene with this budget, takes the film, says so. Throws InputError and RunError; what cannot be written is
// found out before the first step.
void shoot(const Film& film, const scene::Scene& scene, const thawBudget& budget);

} // namespace thaw::player
